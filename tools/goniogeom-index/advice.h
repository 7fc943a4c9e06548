// What the styling guidelines say of a paint on a seam, with figures. [Shimizu2009] 4.5
#pragma once

#include <string>
#include <vector>

#include "options.h"
#include "panels/seam.h"

namespace goniochrome::tool {

// One line for each of the five guidelines: whether it applies, and why. `de` has the difference for every view.
std::vector<std::string> advice(const paint::Paint& paint, const SeamRequest& request, const mesh::Seam& seam,
                                const std::vector<panels::SeamView>& views, const std::vector<double>& de);

}  // namespace goniochrome::tool
