// Which lobes are asked for: by a basis, by a list or by the paints that reflect by them.
#pragma once

#include <vector>

#include "base/result.h"
#include "prefilter/prefilter.h"
#include "tool.h"

namespace goniochrome::tool {

// An exponent that paints name but do not need.
struct LeftOut {
  double exponent = 0;
  double share = 0;  // the largest part of any paint's reflectance
};

struct Wanted {
  prefilter::PrefilterRequest request;
  std::vector<LeftOut> left_out;
  int paints = 0;
};

// True if --layout asks for one mip-mapped cube in the place of a map for each lobe.
bool has_levels(const Options& options);

// The request that the options make. Errors: usage, or the basis or the paints.
Result<Wanted> wanted_lobes(const Options& options);

}  // namespace goniochrome::tool
