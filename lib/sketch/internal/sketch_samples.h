// What a search for a picture's paint looks at. Internal to lib/fit. goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <optional>
#include <vector>

#include "color/color.h"
#include "color/reflection.h"

namespace goniochrome::sketch {

// What was seen, and the light of each part of the lobe model with weight 1 (1/sr) there, all relative to white.
struct SearchSamples {
  std::size_t columns = 0;  // K_D, then K_DD and K_G of every lobe of the basis, then the mirror
  std::vector<Vec3> light;  // `columns` for each sample
  std::vector<color::Rgb> seen;
  std::vector<double> importance;                            // of each sample; more than 0
  std::optional<color::ReflectionOperator> reflection = {};  // as that of a SketchLight
  bool display = false;  // seen on an sRGB display, whose gamut is then part of the picture

  std::size_t size() const { return seen.size(); }
  const Vec3* columns_of(std::size_t sample) const { return &light[sample * columns]; }
  // The light of a sample as the picture could show it.
  color::Lab shown(const color::Rgb& rgb) const;
};

// The light that weights make of one sample's columns.
color::Rgb shown_light(const Vec3* columns, const std::vector<color::Rgb>& weights,
                       const std::optional<color::ReflectionOperator>& reflection);

// Writes, for each sample, the difference in Lab of what these weights show from `target`.
void differences(const SearchSamples& samples, const std::vector<color::Lab>& target,
                 const std::vector<color::Rgb>& weights, std::vector<double>& out);

}  // namespace goniochrome::sketch
