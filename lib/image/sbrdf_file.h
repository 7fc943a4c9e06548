// Textures of spatially varying surfaces as EXR files (`*.sbrdf.exr`).
#pragma once

#include <string>

#include "base/result.h"
#include "brdf/sbrdf.h"

namespace goniochrome::image {

// Reads, from one part or several of one size, the channels diffuse.R .G .B; for each lobe k from 0, lobe<k>.R .G .B
// (albedo), .x .y .z (axes) and .n (exponent); and, where lobes turn, frame.c and frame.s. Colors are linear working
// space, in 1/sr. Error: the channel that is missing or not known, or a texel with a negative albedo or exponent or a
// value that is not finite.
Result<brdf::SbrdfTexture> read_sbrdf(const std::string& path);

}  // namespace goniochrome::image
