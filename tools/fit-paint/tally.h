// The figures of a run, gathered paint by paint.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"
#include "fit/paint_fit.h"
#include "tool.h"

namespace goniochrome::tool {

// The distribution of color differences in steps of 0.01, which takes constant memory.
class Spread {
 public:
  void add(double de00);
  std::size_t count() const { return count_; }
  double mean() const { return count_ > 0 ? sum_ / static_cast<double>(count_) : 0; }
  // The difference that no more than `most` values exceed, rounded down to a step.
  double all_but(double most) const;

 private:
  std::vector<std::size_t> steps_;
  std::size_t count_ = 0;
  double sum_ = 0;
};

class Tally {
 public:
  Tally(const Options& options, cli::Session& session);

  void add(const paint::Paint& paint, const fit::PaintFit& fit);
  void add_failure(const paint::Paint& paint, const std::string& where, const std::string& message);
  void add_time(double seconds) { fit_s_ += seconds; }
  std::size_t done() const { return fitted_ + failed_; }

  // The summary line and the totals.
  cli::Verdict finish();

 private:
  struct Bad {
    std::string name, geometry, limit;
    double de00 = 0;
  };

  void add_worst(const paint::Paint& paint, const fit::PaintFitReport& report);
  void add_range(const paint::Paint& paint, const brdf::CoatRange& range);
  std::string summary() const;
  std::string floor() const;

  const Options& options_;
  cli::Session& session_;
  std::size_t fitted_ = 0, failed_ = 0, not_converged_ = 0, stalled_ = 0, stopped_ = 0, measured_ = 0, predicted_ = 0;
  std::size_t resolved_ = 0;  // measured BRDFs with an albedo_error()
  double fit_s_ = 0, sum_relative_ = 0, sum_misplaced_ = 0, sum_five_ = 0, sum_gain_ = 0;
  Spread errors_;                  // of all readings
  std::size_t contradicting_ = 0;  // paints
  std::size_t lost_to_coat_ = 0;   // readings
  double largest_lost_ = 0;        // dE00 of these
  std::size_t by_views_ = 0;       // paints with views so that none are lost
  double sum_floor_ = 0;           // over all readings
  Spread floors_;                  // of the worse readings at shared angles
  std::vector<Bad> worst_;         // the worst paints, worst first
  std::size_t open_coats_ = 0;     // paints whose gloss readings leave a range of coats
  brdf::CoatRange widest_;         // of these
  std::string widest_name_;
};

}  // namespace goniochrome::tool
