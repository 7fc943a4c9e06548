// Mip-mapped cubes in the files that real-time engines load: KTX2, whose metadata tells the exponent of every level,
// and DDS, which is older and holds no metadata. goniochrome-prefiltering(7), "Mip-mapped lobes".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "envmap/prefiltered.h"

namespace goniochrome::envmap {

// The levels in linear Rec.709, which is what engines take such files for. Colors beyond Rec.709 have negative channels
// there; these are set to zero, and `clipped` counts their texels.
struct Rec709Levels {
  std::vector<PrefilteredLobe> levels;
  std::size_t clipped = 0;
};
Rec709Levels in_rec709(std::vector<PrefilteredLobe> levels);

// Writes the levels, which are cubes of halving sizes in linear Rec.709, as RGBA with an alpha of 1: in half floats,
// or in floats where a value of any level needs them. Faces are +X -X +Y -Y +Z -Z in OpenGL's orientation, which is
// that of both formats. Error: the file cannot be written.
//
// KTX 2.0: the keys goniochrome:exponents, goniochrome:maxErrors and goniochrome:lookupErrors have one number for each
// level, the largest level first; goniochrome:tolerance, goniochrome:source and goniochrome:command are those of
// .env.exr files.
Result<void> write_ktx2(const std::string& path, const std::vector<PrefilteredLobe>& levels, const std::string& source,
                        const std::string& command);
// DirectDraw Surface with the four-character codes of Direct3D 9, 113 for half floats and 116 for floats.
Result<void> write_dds(const std::string& path, const std::vector<PrefilteredLobe>& levels);

}  // namespace goniochrome::envmap
