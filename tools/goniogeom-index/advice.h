// What the styling guidelines say of a paint on a seam, with figures. [Shimizu2009] 4.5
#pragma once

#include <string>
#include <vector>

#include "fit/goniogeom_seam.h"
#include "options.h"

namespace goniochrome {

// One line for each of the five guidelines: whether it applies, and why. `de` has the difference for every view.
std::vector<std::string> advice(const Paint& paint, const SeamRequest& request, const Seam& seam,
                                const std::vector<SeamView>& views, const std::vector<double>& de);

}  // namespace goniochrome
