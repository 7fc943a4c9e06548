#include "sketch/dropper.h"

#include <algorithm>

#include "display/paint_view.h"
#include "math/elementary.h"
#include "math/statistics.h"

namespace goniochrome::sketch {

namespace {

constexpr double kFullContrast = 0.5;  // of brightness, for 100 gloss units

double light_of_signal(double v) {  // IEC 61966-2-1
  return v <= 0.04045 ? v / 12.92 : math::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace

double contrast_gloss(std::vector<double>& brightness) {
  if (brightness.size() < 2) return 0;
  const std::size_t tenth = std::max<std::size_t>(1, brightness.size() / 10);
  const auto split = [&](std::size_t at) {
    std::nth_element(brightness.begin(), brightness.begin() + static_cast<std::ptrdiff_t>(at), brightness.end());
  };
  split(tenth);
  const double darkest = math::mean({brightness.data(), tenth});
  split(brightness.size() - tenth);
  const double brightest = math::mean({brightness.data() + brightness.size() - tenth, tenth});
  return std::min(100.0, 100 * (brightest - darkest) / kFullContrast);
}

DropperColor dropper_color(const std::vector<color::Rgb>& lights) {
  color::Rgb sum;
  std::vector<double> brightness;
  for (const color::Rgb& light : lights) {
    sum += light;
    brightness.push_back(display::srgb_signal(color::luminance(light)));
  }
  DropperColor result;
  result.mean = (1.0 / static_cast<double>(lights.size())) * sum;
  result.lab = color::lab_from_rgb(result.mean, *color::white_point({}));
  result.gloss = contrast_gloss(brightness);
  return result;
}

color::Rgb light_of_srgb(double r, double g, double b) {
  return color::rec2020_from_rec709({light_of_signal(r), light_of_signal(g), light_of_signal(b)});
}

}  // namespace goniochrome::sketch
