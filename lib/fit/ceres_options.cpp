#include "fit/ceres_options.h"

#include <glog/logging.h>

namespace goniochrome::fit {

ceres::Solver::Options quiet_solver_options() {
  static const bool silenced = [] {
    FLAGS_minloglevel = google::GLOG_FATAL;
    return true;
  }();
  (void)silenced;
  ceres::Solver::Options options;
  options.logging_type = ceres::SILENT;
  options.linear_solver_type = ceres::DENSE_QR;
  options.num_threads = 1;
  return options;
}

}  // namespace goniochrome::fit
