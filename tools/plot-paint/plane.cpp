#include "plane.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/angles.h"
#include "base/text.h"
#include "display/paint_view.h"

namespace goniochrome::tool {

namespace {

constexpr double kFirst_deg = 15, kLast_deg = 110;

}  // namespace

std::string css(const color::Lab& lab, const color::Xyz& white) {
  const color::Rgb rgb = color::rec709_from_rec2020(color::rgb_from_lab(lab, white));
  std::string text = "#";
  for (int c = 0; c < 3; ++c)
    text += fmt::format(
        "{:02x}",
        static_cast<int>(std::lround(255 * std::clamp(display::srgb_signal(std::max(rgb[c], 0.0)), 0.0, 1.0))));
  return text;
}

namespace {

// Where a* and b* stand in the drawing.
struct Frame {
  double middle_x, middle_y, radius, range;  // px, px, px; the chroma at that radius

  double x(double a) const { return middle_x + radius * a / range; }
  double y(double b) const { return middle_y - radius * b / range; }
};

std::string hue_ring(const Frame& frame, const color::Xyz& white) {
  constexpr int kSegments = 120;
  constexpr double kWidth = 12, kL = 65, kChroma = 45;
  std::string out;
  for (int i = 0; i < kSegments; ++i) {
    const auto corner = [&](int at, double radius) {
      const double hue = 2 * kPi * at / kSegments;
      return fmt::format("{:.1f},{:.1f}", frame.middle_x + radius * std::cos(hue),
                         frame.middle_y - radius * std::sin(hue));
    };
    const double hue = 2 * kPi * (i + 0.5) / kSegments, inner = frame.radius + 4, outer = inner + kWidth;
    out += fmt::format("<polygon points=\"{} {} {} {}\" fill=\"{}\"/>\n", corner(i, inner), corner(i + 1, inner),
                       corner(i + 1, outer), corner(i, outer),
                       css({kL, kChroma * std::cos(hue), kChroma * std::sin(hue)}, white));
  }
  return out;
}

using Point = std::pair<double, double>;  // px

// The unit direction of the way at an angle, in px, from places that are at least `least_px` apart; none where the
// color stays within these.
std::optional<Point> direction(const Frame& frame, const paint::TargetCurve& curve, double at_deg, double least_px) {
  for (double reach = 1; reach <= kLast_deg - kFirst_deg; reach += 1) {
    const color::Lab from = curve.at(std::max(kFirst_deg, at_deg - reach)),
                     to = curve.at(std::min(kLast_deg, at_deg + reach));
    const double dx = frame.x(to.a) - frame.x(from.a), dy = frame.y(to.b) - frame.y(from.b);
    const double distance = std::hypot(dx, dy);
    if (distance >= least_px) return Point{dx / distance, dy / distance};
  }
  return std::nullopt;
}

// The tip and the other corners of an arrow head behind the dot of the last reading; nothing where the color stays.
std::vector<Point> arrow_head(const Frame& frame, const paint::TargetCurve& curve) {
  constexpr double kBeyond = 6, kLength = 14, kHalfWidth = 7, kLeastWay = 8;  // px
  const auto along = direction(frame, curve, kLast_deg, kLeastWay);
  if (!along) return {};
  const auto [ux, uy] = *along;
  const color::Lab end = curve.at(kLast_deg);
  const double x = frame.x(end.a) + kBeyond * ux, y = frame.y(end.b) + kBeyond * uy;
  return {{x + kLength * ux, y + kLength * uy},
          {x - kHalfWidth * uy, y + kHalfWidth * ux},
          {x + kHalfWidth * uy, y - kHalfWidth * ux}};
}

std::string arrow(const Frame& frame, const paint::TargetCurve& curve) {
  std::string corners;
  for (const auto& [x, y] : arrow_head(frame, curve)) corners += fmt::format("{:.1f},{:.1f} ", x, y);
  return corners.empty() ? "" : fmt::format("<polygon fill=\"#333333\" points=\"{}\"/>\n", trimmed(corners));
}

// The area of the curve, its arrow and the readings, as points that stand close together.
using Covered = std::vector<Point>;

Covered covered(const Frame& frame, const paint::Paint& paint, const paint::TargetCurve& curve) {
  Covered points;
  for (double t = kFirst_deg; t <= kLast_deg; t += 0.5) {
    const color::Lab lab = curve.at(t);
    points.emplace_back(frame.x(lab.a), frame.y(lab.b));
  }
  const std::vector<Point> head = arrow_head(frame, curve);
  points.insert(points.end(), head.begin(), head.end());
  if (!paint.measurement) return points;
  for (const paint::LabReading& row : paint.measurement->rows)
    if (!row.geometry.out_of_plane) points.emplace_back(frame.x(row.lab.a), frame.y(row.lab.b));
  return points;
}

// The names of the chromas stand along the diagonal that leads farthest past what is covered, or at the lower right
// where they do not touch it.
std::string grid(const Frame& frame, const Covered& points) {
  constexpr double kFree = 24;  // px
  std::vector<double> chromas = report::ticks(0, frame.range, false, 4);
  std::erase_if(chromas, [&](double chroma) { return chroma <= 0 || chroma > 0.95 * frame.range; });
  const auto name_at = [&](double chroma, double right, double down) {
    const double along = 0.71 * frame.radius * chroma / frame.range;
    return Point{frame.middle_x + right * (along + 2), frame.middle_y + down * (along + 4) + 4};
  };
  Point diagonal = {1, 1};
  double freest = -1;
  for (const auto& [right, down] : {Point{1, 1}, {-1, 1}, {1, -1}, {-1, -1}}) {
    double nearest = kFree;
    for (const double chroma : chromas) {
      const auto [x, y] = name_at(chroma, right, down);
      for (const auto& [to_x, to_y] : points) nearest = std::min(nearest, std::hypot(to_x - x, to_y - y));
    }
    if (nearest > freest) freest = nearest, diagonal = {right, down};
  }
  std::string out;
  for (const double chroma : chromas) {
    const auto [x, y] = name_at(chroma, diagonal.first, diagonal.second);
    out += fmt::format(
        "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" fill=\"none\" stroke=\"#dddddd\"/>\n"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" style=\"font-size:10px;fill:#777777\">{}</text>\n",
        frame.middle_x, frame.middle_y, frame.radius * chroma / frame.range, x, y, diagonal.first > 0 ? "start" : "end",
        shortest(chroma));
  }
  return out + fmt::format(
                   "<path d=\"M{:.1f} {:.1f}H{:.1f}M{:.1f} {:.1f}V{:.1f}\" stroke=\"#aaaaaa\" fill=\"none\"/>\n"
                   "<text x=\"{:.1f}\" y=\"{:.1f}\">a*</text>\n<text x=\"{:.1f}\" y=\"{:.1f}\">b*</text>\n",
                   frame.middle_x - frame.radius, frame.middle_y, frame.middle_x + frame.radius, frame.middle_x,
                   frame.middle_y - frame.radius, frame.middle_y + frame.radius, frame.middle_x + frame.radius - 16,
                   frame.middle_y - 4, frame.middle_x + 4, frame.middle_y - frame.radius + 12);
}

// The curve in its own colors on a dark edge, which keeps light colors visible.
std::string way(const Frame& frame, const paint::TargetCurve& curve, const color::Xyz& white) {
  std::string edge = "<polyline fill=\"none\" stroke=\"#333333\" stroke-width=\"7\" stroke-linecap=\"round\" points=\"";
  std::string colors;
  for (double t = kFirst_deg; t <= kLast_deg; t += 1) {
    const color::Lab from = curve.at(t), to = curve.at(std::min(kLast_deg, t + 1)), middle = curve.at(t + 0.5);
    edge += fmt::format("{:.2f},{:.2f} ", frame.x(from.a), frame.y(from.b));
    colors += fmt::format(
        "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" stroke=\"{}\" stroke-width=\"5\" "
        "stroke-linecap=\"round\"/>\n",
        frame.x(from.a), frame.y(from.b), frame.x(to.a), frame.y(to.b), css(middle, white));
  }
  return edge + "\"/>\n" + colors;
}

// The rectangle that a name covers, in px.
struct NameBox {
  double x, y, half_width;  // of its middle
  static constexpr double kHalfHeight = 6;

  bool meets(const NameBox& other) const {
    return std::fabs(x - other.x) < half_width + other.half_width && std::fabs(y - other.y) < 2 * kHalfHeight;
  }
  bool holds(double at_x, double at_y, double margin) const {
    return std::fabs(x - at_x) < half_width + margin && std::fabs(y - at_y) < kHalfHeight + margin;
  }
};

// Names stand beside the way, on the side and as near as there is room for them. A name without room is left out.
std::string readings(const Frame& frame, const paint::Paint& paint, const paint::TargetCurve& curve,
                     const Covered& points, const color::Xyz& white) {
  constexpr double kLeastWay = 2, kCharacter = 7.5, kMargin = 4;  // px
  constexpr double kBeside[] = {15, -15, 21, -21, 28, -28};       // px, to the right of the way
  std::string dots, names;
  if (!paint.measurement) return "";
  std::vector<NameBox> taken;
  for (const paint::LabReading& row : paint.measurement->rows) {
    if (row.geometry.out_of_plane) continue;
    const double x = frame.x(row.lab.a), y = frame.y(row.lab.b);
    dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\" stroke=\"#000000\"/>\n", x, y,
                        css(row.lab, white));
    const auto [ux, uy] =
        direction(frame, curve, paint::aspecular_angle_deg(row.geometry), kLeastWay).value_or(Point{0, 1});
    const std::string name = shortest(row.geometry.aspecular_deg);
    for (const double beside : kBeside) {
      const NameBox box = {x + beside * uy, y - beside * ux, kCharacter * static_cast<double>(name.size()) / 2};
      const bool has_room = std::ranges::none_of(taken, [&](const NameBox& other) { return box.meets(other); }) &&
                            std::ranges::none_of(points, [&](const Point& point) {
                              return box.holds(point.first, point.second, kMargin);
                            });
      if (!has_room) continue;
      names += fmt::format("<text class=\"angle\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", box.x,
                           box.y + 4, name);
      taken.push_back(box);
      break;
    }
  }
  return dots + names;
}

}  // namespace

report::Drawing plane_drawing(const paint::Paint& paint, const paint::TargetCurve& curve, const color::Xyz& white,
                              int width, int height) {
  double most = 10;
  for (double t = kFirst_deg; t <= kLast_deg; t += 1) most = std::max(most, color::chroma(curve.at(t)));
  if (paint.measurement)
    for (const paint::LabReading& row : paint.measurement->rows) most = std::max(most, color::chroma(row.lab));
  const double top = 30;
  const Frame frame{0.5 * width, 0.5 * (height + top), 0.5 * std::min<double>(width, height - top) - 20,
                    10 * std::ceil(1.1 * most / 10)};
  const Covered points = covered(frame, paint, curve);
  return {width, height,
          "<text class=\"title\" x=\"12\" y=\"20\">a*b* plane, 15 to 110 deg</text>\n" + hue_ring(frame, white) +
              grid(frame, points) + way(frame, curve, white) + arrow(frame, curve) +
              readings(frame, paint, curve, points, white)};
}

report::Drawing travel_bar(const paint::TargetCurve& curve, const color::Xyz& white, int width, int height) {
  constexpr double kStep_deg = 0.5, kSide = 12, kTop = 30, kBottom = 26;
  const double bar_width = width - 2 * kSide;
  const auto x_of = [&](double t) { return kSide + bar_width * (t - kFirst_deg) / (kLast_deg - kFirst_deg); };
  std::string out = "<text class=\"title\" x=\"12\" y=\"20\">Color over the aspecular angle (deg)</text>\n";
  // Each reaches to the end, and the next one covers it from its own angle on, so that rounding leaves no gaps.
  for (double t = kFirst_deg; t < kLast_deg; t += kStep_deg)
    out += fmt::format(
        "<rect x=\"{:.2f}\" y=\"{}\" width=\"{:.2f}\" height=\"{}\" fill=\"{}\" shape-rendering=\"crispEdges\"/>\n",
        x_of(t), kTop, x_of(kLast_deg) - x_of(t), height - kTop - kBottom, css(curve.at(t + kStep_deg / 2), white));
  for (const double t : paint::kExportAngles_deg)
    out += fmt::format(
        "<path d=\"M{0:.1f} {1}v5\" stroke=\"#333333\"/>\n<text x=\"{0:.1f}\" y=\"{2}\" "
        "text-anchor=\"{3}\">{4}</text>\n",
        x_of(t), height - kBottom, height - 8,
        t == kFirst_deg  ? "start"
        : t == kLast_deg ? "end"
                         : "middle",
        shortest(t));
  return {width, height, out};
}

}  // namespace goniochrome::tool
