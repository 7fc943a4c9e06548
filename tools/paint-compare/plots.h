// The plots of a page of charts.
#pragma once

#include <string>
#include <vector>

#include "judgement.h"
#include "report/plot.h"

namespace goniochrome::tool {

// The a*b* plane at an angle, as differences from the standard: the sample, and the tolerance, where the difference by
// the first formula reaches its limit, or 1 where it has none.
report::Plot plane_plot(const Judgement& judgement, const quality::AngleDifference& angle,
                        const quality::CompareOptions& compare, bool small);

// dE by the first formula over the aspecular angle, with its limits.
report::Plot angle_plot(const Judgement& judgement, const quality::CompareOptions& compare);

// dL at a geometry in the order of the samples, with its mean, one to three sigma and limits; and the moving ranges.
// `times_s` are the dates of the samples, ascending, in seconds after the beginning of 1970; without them the samples
// are counted.
std::vector<report::Plot> control_plots(const std::vector<const Judgement*>& judgements, std::size_t angle,
                                        const std::vector<double>& times_s);

}  // namespace goniochrome::tool
