#include "display/paint_view.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "math/elementary.h"

namespace goniochrome::display {

namespace {

// Display P3 from XYZ under D65. [CSS Color Module Level 4, 10.4 and its sample code]
constexpr double kP3FromXyz[3][3] = {{2.493496911941425, -0.9313836179191239, -0.40271078445071684},
                                     {-0.8294889695615747, 1.7626640603183463, 0.023624685841943577},
                                     {0.03584583024378447, -0.07617238926804182, 0.9568845240076872}};

double least_channel(const color::Rgb& c) {
  return std::min({c.x, c.y, c.z});
}

double largest_channel(const color::Rgb& c) {
  return std::max({c.x, c.y, c.z});
}

// A color mixed with the gray of its luminance until a channel `least`, which is negative, is 0.
color::Rgb mixed_with_gray(const color::Rgb& c, double luminance, double least) {
  const double gray = std::max(0.0, luminance);
  const double keep = gray / (gray - least);
  return keep * c + (1 - keep) * color::Rgb{gray, gray, gray};
}

// Where a value lies beyond the knee, as a multiple of what the display has left there.
double beyond_knee(double value) {
  return (value - kKnee) / (1 - kKnee);
}

// The shoulder k + (1-k) x/(1+x), x = (m-k)/(1-k), leaves the line with slope 1 and ends at white.
color::Rgb below_white(const color::Rgb& c) {
  const double m = largest_channel(c);
  if (m <= kKnee) return c;
  const double x = beyond_knee(m);
  return ((kKnee + (1 - kKnee) * x / (1 + x)) / m) * c;
}

// The signals of a color on a screen.
color::Rgb signals(const color::Lab& lab, const color::Xyz& white, Screen screen) {
  const color::Rgb shown = below_white(screen_light(in_display_gamut(color::rgb_from_lab(lab, white), screen), screen));
  return {srgb_signal(shown.x), srgb_signal(shown.y), srgb_signal(shown.z)};
}

}  // namespace

color::Rgb screen_light(const color::Rgb& rgb, Screen screen) {
  if (screen == Screen::kSrgb) return color::rec709_from_rec2020(rgb);
  const color::Xyz xyz = color::xyz_d65_from_rgb(rgb);
  const auto channel = [&](const double(&row)[3]) { return row[0] * xyz.X + row[1] * xyz.Y + row[2] * xyz.Z; };
  return {channel(kP3FromXyz[0]), channel(kP3FromXyz[1]), channel(kP3FromXyz[2])};
}

color::Rgb paint_view(const color::Rgb& rec709) {
  const double least = least_channel(rec709);
  if (least >= 0) return below_white(rec709);
  return below_white(mixed_with_gray(rec709, color::luminance(color::rec2020_from_rec709(rec709)), least));
}

// The shoulder solved for m.
color::Rgb paint_view_undone(const color::Rgb& rec709) {
  const double s = largest_channel(rec709);
  if (s <= kKnee) return rec709;
  const double y = std::min(beyond_knee(s), 0.999);
  return ((kKnee + (1 - kKnee) * y / (1 - y)) / s) * rec709;
}

// White has the same channels in all primaries, so that gray is mixed in the working space.
color::Rgb in_display_gamut(const color::Rgb& rgb, Screen screen) {
  const double least = least_channel(screen_light(rgb, screen));
  return least >= 0 ? rgb : mixed_with_gray(rgb, color::luminance(rgb), least);
}

double srgb_signal(double light) {
  const double v = std::clamp(light, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * math::pow(v, 1 / 2.4) - 0.055;
}

double screen_chroma(double lightness, double hue_deg, const color::Xyz& white, Screen screen) {
  const double a = math::cos(hue_deg * kDegree), b = math::sin(hue_deg * kDegree);
  double inside = 0, outside = 200;
  for (int step = 0; step < 24; ++step) {
    const double chroma = 0.5 * (inside + outside);
    const color::Rgb rgb = color::rgb_from_lab({lightness, chroma * a, chroma * b}, white);
    (least_channel(screen_light(rgb, screen)) >= 0 ? inside : outside) = chroma;
  }
  return inside;
}

std::array<int, 3> screen_color(const color::Lab& lab, const color::Xyz& white, Screen screen) {
  const color::Rgb shown = signals(lab, white, screen);
  std::array<int, 3> codes{};
  for (int c = 0; c < 3; ++c) codes[static_cast<std::size_t>(c)] = static_cast<int>(std::lround(255 * shown[c]));
  return codes;
}

std::string css_color(const color::Lab& lab, const color::Xyz& white, Screen screen) {
  if (screen == Screen::kDisplayP3) {
    const color::Rgb shown = signals(lab, white, screen);
    return fmt::format("color(display-p3 {:.4f} {:.4f} {:.4f})", shown.x, shown.y, shown.z);
  }
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
