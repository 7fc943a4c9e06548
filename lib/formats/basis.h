// The basis: the shared exponents of a whole paint library. [ShimizuMeyer] 3.2; format in goniochrome-paint(5).
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace goniochrome::formats {

// How well a basis of so many lobes fits the library it was made from.
struct BasisSet {
  int lobes = 0;
  double max_error = 0, mean_error = 0, objective = 0;
};

struct Basis {
  std::string name;
  std::vector<double> exponents;  // ascending, finite, >= 0
  bool mirror = false;
  std::vector<BasisSet> sets = {};  // the error table it was chosen from, may be empty
};

// Errors name file and line. "-" is standard input or output.
Result<Basis> read_basis(const std::string& path);
Result<void> write_basis(const std::string& path, const Basis& basis);

}  // namespace goniochrome::formats
