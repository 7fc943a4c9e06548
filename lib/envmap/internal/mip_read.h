// Reads what write_mip() writes. [McAllister2002] 6.2; goniochrome-theory(7), PREFILTERING, Mip-mapped lobes.
#pragma once

#include <string>

#include "base/result.h"
#include "envmap/prefiltered.h"

namespace goniochrome::envmap {

// The levels as lobes, those of exponent 0 apart; the level of exponent 1 is the diffuse map as well. Error: the file
// is no mip-mapped cube, its attributes do not fit its levels, or none has the exponent 1, with what makes one.
Result<PrefilteredEnvironment> read_mip(const std::string& path);

}  // namespace goniochrome::envmap
