#include "fit/internal/fit_limit.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::fit {

namespace {

// The color lost because the working space has no negative channels.
double gamut_loss(const color::Lab& lab, const color::Xyz& white) {
  color::Rgb rgb = color::rgb_from_lab(lab, white);
  for (int c = 0; c < 3; ++c) rgb[c] = std::max(rgb[c], 0.0);
  return color::delta_e_2000(lab, color::lab_from_rgb(rgb, white));
}

// The channel that grows most from a smaller aspecular angle to that of `at` or from there to a larger one, by how
// much in parts; sums of lobes never do.
std::pair<int, double> steepest_rise(const std::vector<paint::LabReading>& readings, const paint::LabReading& at,
                                     const color::Xyz& white) {
  std::pair<int, double> most = {0, 0};
  const double angle = paint::aspecular_angle_deg(at.geometry);
  const color::Rgb here = color::rgb_from_lab(at.lab, white);
  for (const paint::LabReading& other : readings) {
    const double step = paint::aspecular_angle_deg(other.geometry) - angle;
    const color::Rgb there = color::rgb_from_lab(other.lab, white);
    for (int c = 0; c < 3; ++c) {
      const double low = step > 0 ? here[c] : there[c], high = step > 0 ? there[c] : here[c];
      if (std::abs(step) > 0.5 && low > 0 && high / low - 1 > most.second) most = {c, high / low - 1};
    }
  }
  return most;
}

}  // namespace

std::string fit_limit(const std::vector<paint::LabReading>& readings, const std::vector<GeometryError>& errors,
                      const color::Xyz& white, bool by_view) {
  const auto worst = std::ranges::max_element(errors, {}, &GeometryError::de00) - errors.begin();
  const paint::LabReading& reading = readings[static_cast<std::size_t>(worst)];
  const double error = errors[static_cast<std::size_t>(worst)].de00,
               angle = paint::aspecular_angle_deg(reading.geometry);
  const double outside = gamut_loss(reading.lab, white);
  if (outside >= error / 2) return fmt::format("outside the working space by dE00 {:.2f}", outside);
  double apart = 0;
  for (const paint::LabReading& other : readings)
    if (std::abs(paint::aspecular_angle_deg(other.geometry) - angle) < 0.5)
      apart = std::max(apart, color::delta_e_2000(other.lab, reading.lab));
  if (!by_view && apart >= error) return fmt::format("its two sides of specular differ by dE00 {:.2f}", apart);
  constexpr double kClearRise = 0.02;
  const auto [channel, rise] = steepest_rise(readings, reading, white);
  constexpr const char* kChannels[] = {"red", "green", "blue"};
  if (rise > kClearRise)
    return fmt::format("its {} grows by {:.0f} % away from specular, which no lobes do", kChannels[channel],
                       100 * rise);
  return "its curve is not one of the basis's lobes";
}

}  // namespace goniochrome::fit
