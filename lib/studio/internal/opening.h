// Files that are opened on a page, by the readers of the tools.
#pragma once

#include <functional>
#include <string>

#include "base/json.h"
#include "base/result.h"
#include "formats/basis.h"
#include "studio/packed_numbers.h"

namespace goniochrome::studio {

// Members: kind, and
//   paints  list[], format, and remarks[] with what was not read
//   mesh    mesh{} as packed_mesh() has it, triangles and remarks[]
//   basis   basis{name, exponents[], mirror}
//   light   nothing more: filtered_light() reads it
// The content tells the kind, but for meshes, whose ending does. Error: the file and what is wrong with it.
Result<Json> opened(const std::string& path, PackedNumbers& numbers);

// Light from all around, filtered for the lobes of a basis: environment{} as packed_environment() has it, and
// remarks[]. `progress` hears which part of the work is done, from 0 to 1.
Result<Json> filtered_light(const std::string& path, const formats::Basis& basis, PackedNumbers& numbers,
                            const std::function<void(double)>& progress);

}  // namespace goniochrome::studio
