#include "report/lobe_drawings.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"

namespace goniochrome::report {

namespace {

std::string title_text(const std::string& title) {
  return fmt::format("<text class=\"title\" x=\"12\" y=\"20\">{}</text>\n", xml_escaped(title, ""));
}

int channel_byte(double value) {
  return static_cast<int>(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

std::string hex(const Vec3& color) {
  return fmt::format("#{:02x}{:02x}{:02x}", channel_byte(color.x), channel_byte(color.y), channel_byte(color.z));
}

// The color "#rrggbb" made darker by the factor `light`.
std::string shaded(const std::string& color, double light) {
  Vec3 rgb;
  for (int c = 0; c < 3; ++c) rgb[c] = light * std::stoi(color.substr(1 + 2 * c, 2), nullptr, 16) / 255.0;
  return hex(rgb);
}

}  // namespace

Drawing polar_drawing(const std::string& title, const std::vector<PolarSeries>& series, int width, int height) {
  double largest = 0;
  for (const PolarSeries& s : series)
    for (const double r : s.radius)
      if (std::isfinite(r)) largest = std::max(largest, r);
  if (largest <= 0) largest = 1;
  const double scale = std::min((width - 40) / 2.0, height - 80.0) / largest;
  const double x0 = width / 2.0, y0 = height - 36.0;
  std::string out = title_text(title);
  for (const double r : ticks(0, largest, false, 4)) {
    if (r <= 0) continue;
    out += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}A{:.1f} {:.1f} 0 0 1 {:.1f} {:.1f}\"/>\n",
                       x0 - r * scale, y0, r * scale, r * scale, x0 + r * scale, y0);
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{:.3g}</text>\n", x0 + r * scale,
                       y0 + 14, r);
  }
  for (int angle = -90; angle <= 90; angle += 30)
    out +=
        fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", x0, y0,
                    x0 + largest * scale * std::sin(angle * kDegree), y0 - largest * scale * std::cos(angle * kDegree));
  double line = 40;
  for (const PolarSeries& s : series) {
    std::string path;
    for (std::size_t i = 0; i < s.radius.size(); ++i) {
      if (!std::isfinite(s.radius[i])) continue;
      const double x = x0 + scale * s.radius[i] * std::sin(s.angle_deg[i] * kDegree);
      const double y = y0 - scale * s.radius[i] * std::cos(s.angle_deg[i] * kDegree);
      if (s.points)
        out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\"/>", x, y, s.color);
      else
        path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", x, y);
    }
    if (!path.empty()) out += fmt::format("<path class=\"curve\" stroke=\"{}\" d=\"{}\"/>\n", s.color, path);
    if (s.label.empty()) continue;
    out += fmt::format("<text x=\"12\" y=\"{:.0f}\" style=\"fill:{}\">{}</text>\n", line, s.color,
                       xml_escaped(s.label, ""));
    line += 15;
  }
  return {width, height, out};
}

Drawing surface_drawing(const std::string& title, const std::string& color,
                        const std::function<double(const Vec3&)>& radius, const Vec3& arrow, int width, int height) {
  constexpr int kRings = 24, kSpokes = 48;
  std::array<std::array<Vec3, kSpokes + 1>, kRings + 1> grid;
  double largest = 0;
  for (int i = 0; i <= kRings; ++i)
    for (int j = 0; j <= kSpokes; ++j) {
      const double t = 0.5 * kPi * i / kRings, p = 2 * kPi * j / kSpokes;
      const Vec3 w = {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
      const double r = std::max(0.0, radius(w));
      grid[i][j] = r * w;
      largest = std::max(largest, r);
    }
  if (largest <= 0) largest = 1;
  const double tilt = 25 * kDegree;
  const double scale = std::min(width / 2.0 - 16, (height - 52.0) / (std::cos(tilt) + std::sin(tilt))) / largest;
  const double x0 = width / 2.0, y0 = height - 14 - scale * largest * std::sin(tilt);
  // The projection is parallel, from the side of negative y and 25 deg above; `depth` grows away from the eye.
  const auto screen = [&](const Vec3& v) {
    return std::pair{x0 + scale * v.x, y0 - scale * (v.z * std::cos(tilt) + v.y * std::sin(tilt))};
  };
  const auto depth = [&](const Vec3& v) { return v.y * std::cos(tilt) - v.z * std::sin(tilt); };
  struct Face {
    std::array<Vec3, 4> corner;
    double depth;
  };
  std::vector<Face> faces;
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kSpokes; ++j) {
      const Face face{{grid[i][j], grid[i + 1][j], grid[i + 1][j + 1], grid[i][j + 1]}, 0};
      faces.push_back(face);
      for (const Vec3& v : face.corner) faces.back().depth += depth(v) / 4;
    }
  std::ranges::stable_sort(faces, std::greater<>(), &Face::depth);
  std::string out = title_text(title);
  const double rim = largest * scale;
  out += fmt::format("<ellipse class=\"grid\" cx=\"{:.1f}\" cy=\"{:.1f}\" rx=\"{:.1f}\" ry=\"{:.1f}\"/>\n", x0, y0, rim,
                     rim * std::sin(tilt));
  const Vec3 lamp = normalized({-0.5, -0.7, 0.6});
  for (const Face& face : faces) {
    const Vec3 normal = cross(face.corner[2] - face.corner[0], face.corner[3] - face.corner[1]);
    if (length(normal) < 1e-9 * largest * largest) continue;
    std::string path;
    for (const Vec3& v : face.corner) {
      const auto [x, y] = screen(v);
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
    }
    const std::string fill = shaded(color, 0.55 + 0.45 * std::abs(dot(normalized(normal), lamp)));
    out += fmt::format("<path fill=\"{0}\" stroke=\"{0}\" stroke-width=\"0.4\" d=\"{1}Z\"/>\n", fill, path);
  }
  const auto [ax, ay] = screen(largest * arrow);
  out +=
      fmt::format("<path stroke=\"#e69f00\" stroke-width=\"2\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>\n", ax, ay, x0, y0);
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">light</text>\n", ax + 4, ay - 4);
  return {width, height, out};
}

Drawing square_drawing(const std::string& title, int n, const std::function<Vec3(double x, double y)>& color, int width,
                       int height) {
  const double size = std::min(width - 16.0, height - 34.0) / n, left = (width - n * size) / 2, top = 28;
  std::string out = fmt::format("<text x=\"{:.1f}\" y=\"20\" text-anchor=\"middle\">{}</text>\n", width / 2.0,
                                xml_escaped(title, ""));
  for (int row = 0; row < n; ++row) {
    // Neighbors of one color make one rectangle.
    int begin = 0;
    std::string current;
    for (int column = 0; column <= n; ++column) {
      const std::string next =
          column < n ? hex(color((2 * column + 1.0) / n - 1, 1 - (2 * row + 1.0) / n)) : std::string();
      if (next == current) continue;
      if (column > 0)
        out += fmt::format(
            "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\" "
            "shape-rendering=\"crispEdges\"/>\n",
            left + begin * size, top + row * size, (column - begin) * size, size, current);
      begin = column, current = next;
    }
  }
  out += fmt::format("<rect class=\"frame\" x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>\n", left,
                     top, n * size, n * size);
  return {width, height, out};
}

// [ShirleyChiu1997]: in the quadrant about the positive x axis the radius is x and the azimuth (pi/4) y/x. The disc of
// radius r goes to the hemisphere by z = 1 - r^2, which keeps areas.
Vec3 hemisphere_direction(double x, double y) {
  double r = 0, azimuth = 0;
  if (x != 0 || y != 0) {
    if (std::abs(x) > std::abs(y))
      r = x, azimuth = kPi / 4 * (y / x);
    else
      r = y, azimuth = kPi / 2 - kPi / 4 * (x / y);
  }
  const double z = 1 - r * r, sine = r * std::sqrt(std::max(0.0, 2 - r * r));
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), z};
}

}  // namespace goniochrome::report
