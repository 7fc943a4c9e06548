// The time that prefiltering takes is predicted from a few measured constants times the counts of each step.
// goniochrome-prefiltering(7), "Costs".
#pragma once

#include <vector>

#include "prefilter/prefilter.h"

namespace goniochrome::prefilter {

// Sets predicted_time_s of every lobe of a plan, methods, degrees and sizes known. The first lobe that needs a table
// pays for it. Seconds on the threads in force; constants are those of a server core of 2023.
void predict_times(const envmap::Environment& env, const PrefilterRequest& request, std::vector<LobePlan>& plan);

}  // namespace goniochrome::prefilter
