// The settings of the fit from the command line.
#pragma once

#include <string>

#include "base/result.h"
#include "fit/paint_fit.h"
#include "tool.h"

namespace goniochrome::tool {

// Error: a gloss or a list of views that makes no sense.
Result<fit::FitOptions> fit_options(const Options& options);

// The text of --explain: the work, the parts that are left out, and the cost.
std::string plan(const Options& options, const fit::FitOptions& fit, const formats::Basis& basis);

}  // namespace goniochrome::tool
