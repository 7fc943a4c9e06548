// A kernel that ends or bends at the horizon is parted in two: a smooth one of few harmonics, and the rest, which is
// almost nothing but beside the horizon. goniochrome-prefiltering(7), "Horizon bands".
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec3.h"
#include "prefilter/internal/kernel.h"

namespace goniochrome::prefilter {

// The second antiderivative F of a function of the cosine, as a cubic in each of many equal intervals: c0 + z (c1 +
// z (c2 + z c3)) with z = 0..1 across the interval. The first and the last interval are straight lines that continue
// for ever, so the function itself is zero beyond `reach` on either side of 0, and everywhere where that is 0.
struct SecondIntegral {
  std::vector<double> coefficients;  // four to an interval
  double begin = 0, per_unit = 1;    // the cosine at which the first interval begins; intervals per unit of the cosine
  double reach = 0;

  // About the mean over a texel that the horizon does not cut, whose directions have the variance v in the cosine:
  // m0 + (v - variance) m1 is linear in each interval, of which m0, its change, m1, its change are kept. They serve
  // where the cosine in the middle is beyond `cut`.
  std::vector<double> means;
  double means_begin = 0, variance = 0, cut = 0;

  double at(double cosine) const;
  // The mean of the function over a parallelogram on which the cosine is linear: `middle` in its middle, changing by
  // `along` and `down`, which are not 0, from side to side.
  double mean(double middle, double along, double down) const;
  // The mean by the table of means.
  double far_mean(double middle, double along, double down) const;
  // Makes the table for texels about `side_rad` wide and high.
  void make_means(double side_rad);
};

// max(0, cos)^E for exponents from 0 on, in two parts.
class HorizonParts {
 public:
  // The smooth part has harmonics up to the degree of the table `rms_beyond`, which says for each degree l the root
  // mean square of what a map holds above l, by channel. The band of the other part is the narrowest that leaves out no
  // more than `allowed` of the filtered map, as a root mean square over all directions, or the widest one. Texels are
  // about `side_rad` wide.
  HorizonParts(const CosineKernel& kernel, const std::vector<Vec3>& rms_beyond, const Vec3& allowed, double side_rad);

  const std::vector<double>& multipliers() const { return multipliers_; }  // of the smooth part
  const SecondIntegral& band() const { return band_; }                     // of the other part
  const Vec3& left_out() const { return left_out_; }

 private:
  std::vector<double> multipliers_;
  SecondIntegral band_;
  Vec3 left_out_;
};

}  // namespace goniochrome::prefilter
