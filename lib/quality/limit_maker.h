// Limits from panels that were accepted.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "quality/limits.h"

namespace goniochrome::quality {

// Makes limits of accepted panels: mean +- k standard deviations of each quantity at each geometry; of dE, which is
// never negative, the upper one alone. A quantity that some panels lack has no limit.
class LimitMaker {
 public:
  static constexpr std::size_t kFewestPanels = 3;

  void add(const Comparison& comparison, const CompareOptions& options);
  // Geometries, and single quantities elsewhere, that have no limit since a panel lacks them: "45as110", "gloss60".
  std::vector<std::string> dropped() const;
  // Error: fewer than kFewestPanels were added.
  Result<std::vector<Limit>> by_spread(double k) const;
  // With the least k by which at least `share` (0..1) of the panels keep all limits at once.
  Result<std::vector<Limit>> by_share(double share) const;

 private:
  using Key = std::pair<std::string, std::string>;  // at, quantity
  struct Column {
    std::size_t place = 0;  // among the columns, in the order of first appearance
    std::vector<double> values;
  };
  struct Spread {
    Key key;
    const std::vector<double>* values;
    double mean, deviation;
    bool one_sided;
  };
  Result<std::vector<Spread>> spreads() const;

  std::size_t panels_ = 0;
  std::map<Key, Column> columns_;
};

}  // namespace goniochrome::quality
