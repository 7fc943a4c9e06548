// The figures of a run, gathered paint by paint.
#pragma once

#include <string>

#include "cli/tool.h"
#include "fit/paint_fit.h"
#include "options.h"

namespace goniochrome {

class Tally {
 public:
  Tally(const Options& options, cli::Session& session);

  void add(const Paint& paint, const PaintFit& fit);
  void add_failure(const Paint& paint, const std::string& where, const std::string& message);
  void add_time(double seconds) { fit_s_ += seconds; }
  std::size_t done() const { return fitted_ + failed_; }

  // The summary line and the totals.
  cli::Verdict finish();

 private:
  const Options& options_;
  cli::Session& session_;
  std::size_t fitted_ = 0, failed_ = 0, not_converged_ = 0, stopped_ = 0, measured_ = 0;
  double sum_mean_ = 0, worst_de00_ = 0, fit_s_ = 0, sum_relative_ = 0, sum_gain_ = 0;
  std::string worst_;
};

}  // namespace goniochrome
