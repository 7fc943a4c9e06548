// The basis that stands in where none is named.
#pragma once

#include <string>

#include "base/result.h"
#include "formats/basis.h"

namespace goniochrome::formats {

// Seven exponents from 1.3 to 3000, some 3.5 times apart, and the mirror.
Basis default_basis();

// The basis of a file, or the default where `path` is empty.
Result<Basis> basis_or_default(const std::string& path);

}  // namespace goniochrome::formats
