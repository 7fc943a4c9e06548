// Internal to lib/fit: Ceres, silent.
#pragma once

#include <ceres/ceres.h>

namespace goniochrome::fit {

// Options of a small dense problem on one thread. Ceres logs to standard error through glog whatever its options say;
// this turns that off, in the one place where it is done.
ceres::Solver::Options quiet_solver_options();

}  // namespace goniochrome::fit
