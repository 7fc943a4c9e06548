// The basis of a paint library, which is the list of exponents that all its paints are fitted with, and the file that
// keeps it. [ShimizuMeyer] 3.2; goniochrome-paint(5) describes the format.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace goniochrome::formats {

// How well a basis of so many lobes fits the library that it was made from.
struct BasisSet {
  int lobes = 0;
  double max_error = 0, mean_error = 0, objective = 0;
};

struct Basis {
  std::string name;
  std::vector<double> exponents;  // ascending, finite, >= 0
  bool mirror = false;
  std::vector<BasisSet> sets = {};  // the table of errors that it was chosen from; may be empty
};

// "-" is standard input or output. Errors name file and line.
Result<Basis> read_basis(const std::string& path);
Result<void> write_basis(const std::string& path, const Basis& basis);

}  // namespace goniochrome::formats
