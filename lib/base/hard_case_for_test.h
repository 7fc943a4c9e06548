// For tests: one figure of a hard case, which is our error, the error of the textbook form, and a bound between the
// two.
#pragma once

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string_view>

namespace goniochrome {

struct HardCaseFigure {
  std::string_view what;  // the quantity, as a heading
  double textbook;        // its worst error in the textbook form, on the same inputs; NaN and infinity are errors too
  double ours;
  double bound;
  std::string_view unit;  // one word: ulp, relative, deg, dE00, bytes ...
};

// The larger of two errors, where one that is not a number is infinite: std::max would pass over it.
inline double worst_of(double so_far, double error) {
  if (std::isnan(error)) return std::numeric_limits<double>::infinity();
  return so_far < error ? error : so_far;
}

// Checks that our error is within the bound and the textbook's is beyond it, and prints the line that
// scripts/hard-cases gathers. `key` is one of scripts/hard_cases/cases.tsv.
inline void hard_case(std::string_view key, const HardCaseFigure& figure) {
  fmt::print("hard: {} {:.2g} {:.2g} {:.2g} {} {}\n", key, std::abs(figure.textbook), figure.ours, figure.bound,
             figure.unit, figure.what);
  std::fflush(stdout);
  EXPECT_LE(figure.ours, figure.bound) << key << ": " << figure.what;
  EXPECT_FALSE(figure.textbook <= figure.bound) << key << ": " << figure.what << ": the control holds too";
}

}  // namespace goniochrome
