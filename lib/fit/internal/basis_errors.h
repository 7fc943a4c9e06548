// The errors of many targets with the lobes of one basis, for a search that asks for them thousands of times.
// goniochrome-lobes(7), "CHOOSING THE BASIS".
#pragma once

#include <cstddef>
#include <vector>

#include "fit/basis_search.h"

namespace goniochrome::fit {

// The data of the targets that do not depend on the exponents. Many threads may share one. The targets must outlive it.
class BasisErrors {
 public:
  explicit BasisErrors(const std::vector<BasisTarget>& targets);

  std::size_t size() const { return targets_.size(); }

  // The squared error of each target, see basis_error(), and on request its gradient by log E_j.
  std::vector<SquaredError> at(const std::vector<double>& exponents, bool with_gradient) const;

 private:
  // The lobes at a list of angles, which many targets share.
  struct Shape {
    std::vector<double> angles_deg, log_cos;
  };
  struct CoatShape;

  SquaredError squared_error(std::size_t i, const std::vector<double>& exponents,
                             const std::vector<double>& lobes_at_angles, bool with_gradient) const;
  void add_coat_error(std::size_t i, const std::vector<double>& exponents, const CoatShape& shape, bool with_gradient,
                      SquaredError& result) const;

  const std::vector<BasisTarget>& targets_;
  std::vector<Shape> shapes_;
  std::vector<std::size_t> shape_of_;                     // by target
  std::vector<std::vector<std::vector<double>>> wanted_;  // by target and view, what the rings of its coat hold; empty
                                                          // where there are too many targets to keep it
};

}  // namespace goniochrome::fit
