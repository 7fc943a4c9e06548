// Advice of the styling guidelines of [Shimizu2009] 4.5 about a paint on a seam, with figures.
#pragma once

#include <string>
#include <vector>

#include "panels/seam.h"
#include "tool.h"

namespace goniochrome::tool {

// Returns one line for each of the five guidelines that can be judged: whether it applies, and why. `de` has the
// difference for every view.
std::vector<std::string> advice(const paint::Paint& paint, const SeamRequest& request, const mesh::Seam& seam,
                                const std::vector<panels::SeamView>& views, const std::vector<double>& de);

}  // namespace goniochrome::tool
