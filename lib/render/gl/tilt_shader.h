// The part of the shading program that looks tilted lobes up, and the layout of the texture that it reads them from.
// goniochrome-interference(7), "TILTED LOBES".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/effects.h"
#include "render/internal/tilt_table.h"

namespace goniochrome::render {

// The texture "tilted", texel by texel in rows of kTiltTexels: first, for each part, where the rows of its paint begin.
// Then a row for each paint and segment of the view: for each map the number of its first look-up, and one more for the
// end; then four texels for each look-up, which are the axis (a, s, c), its step, the weight, and its step.
constexpr std::size_t kTiltTexels = 4096;
struct TiltTexture {
  std::size_t stride = 0;   // texels of a row
  std::vector<float> rgba;  // of whole rows of kTiltTexels
};
TiltTexture tilt_texture(const TiltTable& table, std::size_t maps);

// The sampler of the map of one of the exponents. Lobes that are drawn anyhow share theirs.
std::string tilt_sampler(const Effects& effects, const std::vector<double>& exponents, double exponent);

// The uniforms, and the function `tilted_lobes(r, n, wo)` that sums the look-ups of this point. Both are empty where
// there are no exponents.
std::string tilt_uniforms(const Effects& effects, const std::vector<double>& exponents);
std::string tilt_function(const Effects& effects, const std::vector<double>& exponents);

}  // namespace goniochrome::render
