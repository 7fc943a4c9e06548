// What the command line asks of the fit.
#pragma once

#include <string>

#include "base/result.h"
#include "fit/paint_fit.h"
#include "tool.h"

namespace goniochrome::tool {

// Error: a gloss or a list of views that makes no sense.
Result<fit::FitOptions> fit_options(const Options& options);

// The text of --explain: what will be done, what is left out, and what it costs.
std::string plan(const Options& options, const fit::FitOptions& fit, const formats::Basis& basis);

}  // namespace goniochrome::tool
