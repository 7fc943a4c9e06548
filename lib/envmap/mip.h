// These files hold one mip-mapped cube with a lobe in every level. They serve paints whose exponent varies from point
// to point. [McAllister2002] 6.2; goniochrome-prefiltering(7), "Mip-mapped lobes".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "envmap/prefiltered.h"

namespace goniochrome::envmap {

// The exponent of every level of a cube of `size` (a power of two) down to one texel a face: the given ones, sharpest
// first, then each a quarter of the one before, as wide for its texels; below 1/4 it is 0. Error: more exponents than
// levels, or a size that is no power of two.
Result<std::vector<double>> mip_exponents(std::vector<double> given, int size);

// Writes the levels (cubes of halving sizes) as one tiled EXR; attributes say exponent, error and texels of each.
Result<void> write_mip(const std::string& path, const std::vector<PrefilteredLobe>& levels, const std::string& source,
                       const std::string& command);

// Reads what write_mip() writes, the bytes of a file that errors call `name`: the levels as lobes, without those of
// exponent 0; the level of exponent 1 is the diffuse map as well. Error: the file is no mip-mapped cube, its attributes
// do not fit its levels, or none has the exponent 1, with what makes one.
Result<PrefilteredEnvironment> read_mip(const std::string& content, const std::string& name);

}  // namespace goniochrome::envmap
