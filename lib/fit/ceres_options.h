// Ceres as the rooms that solve by it want it: small dense problems on one thread, and nothing on standard error.
#pragma once

#include <ceres/ceres.h>

namespace goniochrome::fit {

// Options of such a problem. Ceres logs to standard error through glog whatever its options say; this function turns
// that off for the whole process.
ceres::Solver::Options quiet_solver_options();

}  // namespace goniochrome::fit
