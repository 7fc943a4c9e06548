// How a fit ended.
#pragma once

namespace goniochrome::fit {

enum class FitStatus {
  kOptimal,
  kNotConverged,  // a solver gave up: the best weights found
  kTimeLimit      // the paint's time was up: the best weights found until then
};

// "optimal" | "not_converged" | "time_limit"
const char* fit_status_name(FitStatus status);

}  // namespace goniochrome::fit
