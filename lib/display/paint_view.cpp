#include "display/paint_view.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "math/elementary.h"

namespace goniochrome::display {

namespace {

double least_channel(const color::Rgb& c) {
  return std::min({c.x, c.y, c.z});
}

double largest_channel(const color::Rgb& c) {
  return std::max({c.x, c.y, c.z});
}

// A color with a negative channel, mixed with the gray of its luminance until that channel is 0.
color::Rgb mixed_with_gray(const color::Rgb& rec709, double luminance) {
  const double gray = std::max(0.0, luminance);
  const double keep = gray / (gray - least_channel(rec709));
  return keep * rec709 + (1 - keep) * color::Rgb{gray, gray, gray};
}

// Where a value lies beyond the knee, as a multiple of what the display has left there.
double beyond_knee(double value) {
  return (value - kKnee) / (1 - kKnee);
}

}  // namespace

// The shoulder k + (1-k) x/(1+x), x = (m-k)/(1-k), leaves the line with slope 1 and ends at white.
color::Rgb paint_view(const color::Rgb& rec709) {
  color::Rgb c = rec709;
  if (least_channel(c) < 0) c = mixed_with_gray(c, color::luminance(color::rec2020_from_rec709(c)));
  const double m = largest_channel(c);
  if (m <= kKnee) return c;
  const double x = beyond_knee(m);
  return ((kKnee + (1 - kKnee) * x / (1 + x)) / m) * c;
}

// The shoulder solved for m.
color::Rgb paint_view_undone(const color::Rgb& rec709) {
  const double s = largest_channel(rec709);
  if (s <= kKnee) return rec709;
  const double y = std::min(beyond_knee(s), 0.999);
  return ((kKnee + (1 - kKnee) * y / (1 - y)) / s) * rec709;
}

color::Rgb in_display_gamut(const color::Rgb& rgb) {
  const color::Rgb c = color::rec709_from_rec2020(rgb);
  if (least_channel(c) >= 0) return rgb;
  return color::rec2020_from_rec709(mixed_with_gray(c, color::luminance(rgb)));
}

double srgb_signal(double light) {
  const double v = std::clamp(light, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * math::pow(v, 1 / 2.4) - 0.055;
}

double screen_chroma(double lightness, double hue_deg, const color::Xyz& white) {
  const double a = math::cos(hue_deg * kDegree), b = math::sin(hue_deg * kDegree);
  double inside = 0, outside = 200;
  for (int step = 0; step < 24; ++step) {
    const double chroma = 0.5 * (inside + outside);
    const color::Rgb rgb = color::rgb_from_lab({lightness, chroma * a, chroma * b}, white);
    (least_channel(color::rec709_from_rec2020(rgb)) >= 0 ? inside : outside) = chroma;
  }
  return inside;
}

std::array<int, 3> screen_color(const color::Lab& lab, const color::Xyz& white) {
  const color::Rgb shown = paint_view(color::rec709_from_rec2020(color::rgb_from_lab(lab, white)));
  std::array<int, 3> codes{};
  for (int c = 0; c < 3; ++c)
    codes[static_cast<std::size_t>(c)] = static_cast<int>(std::lround(255 * srgb_signal(shown[c])));
  return codes;
}

std::string css_color(const color::Lab& lab, const color::Xyz& white) {
  const std::array<int, 3> rgb = screen_color(lab, white);
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

// dv/dcode of v = ((c + .055)/1.055)^2.4 is below 2.3 sqrt(v) for v in 0..1; the line near black adds the constant. The
// shoulder flattens by 1/(1+x)^2.
double code_width(double light, double brightest) {
  const double x = std::max(brightest - kKnee, 0.0) / (1 - kKnee);
  return 5.0 / 255 * (2.3 * std::sqrt(std::max(light, 0.0)) + 0.08) * (1 + x) * (1 + x);
}

}  // namespace goniochrome::display
