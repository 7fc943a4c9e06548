#include "plane.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

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

std::string grid(const Frame& frame) {
  std::string out;
  const std::vector<double> chromas = report::ticks(0, frame.range, false, 4);
  for (const double chroma : chromas) {
    if (chroma <= 0 || chroma > 0.95 * frame.range) continue;
    const double radius = frame.radius * chroma / frame.range;
    out += fmt::format(
        "<circle cx=\"{0:.1f}\" cy=\"{1:.1f}\" r=\"{2:.1f}\" fill=\"none\" stroke=\"#dddddd\"/>\n"
        "<text x=\"{3:.1f}\" y=\"{4:.1f}\" style=\"font-size:10px;fill:#777777\">{5}</text>\n",
        frame.middle_x, frame.middle_y, radius, frame.middle_x + 0.71 * radius + 2, frame.middle_y + 0.71 * radius + 8,
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

// The unit direction of the way at an angle, in px, from places that are at least `least_px` apart; none where the
// color stays within these.
std::optional<std::pair<double, double>> direction(const Frame& frame, const paint::TargetCurve& curve, double at_deg,
                                                   double least_px) {
  for (double reach = 1; reach <= kLast_deg - kFirst_deg; reach += 1) {
    const color::Lab from = curve.at(std::max(kFirst_deg, at_deg - reach)),
                     to = curve.at(std::min(kLast_deg, at_deg + reach));
    const double dx = frame.x(to.a) - frame.x(from.a), dy = frame.y(to.b) - frame.y(from.b);
    const double distance = std::hypot(dx, dy);
    if (distance >= least_px) return std::pair{dx / distance, dy / distance};
  }
  return std::nullopt;
}

// An arrow head behind the dot of the last reading.
std::string arrow(const Frame& frame, const paint::TargetCurve& curve) {
  constexpr double kBeyond = 6, kLength = 14, kHalfWidth = 7, kLeastWay = 8;  // px
  const auto along = direction(frame, curve, kLast_deg, kLeastWay);
  if (!along) return "";
  const auto [ux, uy] = *along;
  const color::Lab end = curve.at(kLast_deg);
  const double x = frame.x(end.a) + kBeyond * ux, y = frame.y(end.b) + kBeyond * uy;
  return fmt::format("<polygon fill=\"#333333\" points=\"{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f}\"/>\n",
                     x + kLength * ux, y + kLength * uy, x - kHalfWidth * uy, y + kHalfWidth * ux, x + kHalfWidth * uy,
                     y - kHalfWidth * ux);
}

std::string readings(const Frame& frame, const paint::Paint& paint, const paint::TargetCurve& curve,
                     const color::Xyz& white) {
  constexpr double kBeside = 17, kApart = 14, kLeastWay = 2;  // px
  std::string dots, names;
  if (!paint.measurement) return "";
  double last_x = -100, last_y = -100;
  for (const paint::LabReading& row : paint.measurement->rows) {
    if (row.geometry.out_of_plane) continue;
    const double x = frame.x(row.lab.a), y = frame.y(row.lab.b);
    dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\" stroke=\"#000000\"/>\n", x, y,
                        css(row.lab, white));
    // Names stand beside the way, and not on it. Those that would lie on one another are left out.
    const auto [ux, uy] =
        direction(frame, curve, paint::aspecular_angle_deg(row.geometry), kLeastWay).value_or(std::pair{0.0, 1.0});
    const double name_x = x + kBeside * uy, name_y = y - kBeside * ux + 4;
    if (std::hypot(name_x - last_x, name_y - last_y) < kApart) continue;
    names += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n", name_x, name_y,
                         shortest(row.geometry.aspecular_deg));
    last_x = name_x, last_y = name_y;
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
  return {width, height,
          "<text class=\"title\" x=\"12\" y=\"20\">a*b* plane, 15 to 110 deg</text>\n" + hue_ring(frame, white) +
              grid(frame) + way(frame, curve, white) + arrow(frame, curve) + readings(frame, paint, curve, white)};
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
