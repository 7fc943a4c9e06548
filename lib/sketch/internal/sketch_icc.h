// Internal to lib/fit: embedded ICC profiles of the kind that cameras and editors write for RGB and gray.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "base/result.h"
#include "color/color.h"

namespace goniochrome::sketch {

// A matrix profile: each channel through its curve, then a matrix. Gray has three equal curves.
struct IccProfile {
  // One curve: device 0..1 to linear 0..1, evenly spaced.
  std::array<std::vector<float>, 3> curves;
  std::array<color::Rgb, 3> columns;  // the working-space color of each channel's full signal
  bool gray = false;

  color::Rgb rgb(float r, float g, float b) const;
};

// `name` is what errors call the image. Error: CMYK and table profiles, with the remedy, and cut or forged bytes.
Result<IccProfile> parse_icc(const std::string& bytes, const std::string& name);

}  // namespace goniochrome::sketch
