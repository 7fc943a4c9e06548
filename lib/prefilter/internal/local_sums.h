// A lobe that reaches few texels is summed over those around each direction. goniochrome-prefiltering(7), "Local sums".
#pragma once

#include <vector>

#include "prefilter/internal/kernel.h"
#include "prefilter/internal/strip_map.h"

namespace goniochrome::prefilter {

class LocalSums {
 public:
  // True if it is a power of the cosine so sharp, on a lat-long map so coarse, that this is faster than a tree of
  // blocks. Sums are good to a part of 1e-6.
  static bool serve(const envmap::Environment& env, const ZonalKernel& kernel, double tolerance);
  // About how many texels a sum takes in away from the poles.
  static double texels_within(const envmap::Environment& env, double exponent);

  // Sums over a lat-long map, which must outlive this.
  explicit LocalSums(const envmap::Environment& env) : env_(env), map_(env, {}) {}

  // P_E(d) of each direction. Texels beyond the circle are left out outside which that share of the lobe lies.
  std::vector<Vec3> lobe(const std::vector<Vec3>& directions, const CosineKernel& kernel, double left_out) const;

 private:
  void weigh(const StripMap::Seat& seat, double exponent, double left_out, Strips& strips) const;

  const envmap::Environment& env_;
  StripMap map_;
};

}  // namespace goniochrome::prefilter
