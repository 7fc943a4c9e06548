// In spherical harmonics a filter is a product: each coefficient of the environment times the multiplier of its degree.
// goniochrome-prefiltering(7), "Zonal harmonics".
#pragma once

#include <cstddef>
#include <vector>

#include "envmap/environment.h"
#include "prefilter/internal/kernel.h"

namespace goniochrome::prefilter {

// Coefficients of a real function of three channels up to a degree: for each order m = 0..degree, each l = m..degree:
// re R G B, im R G B.
struct Harmonics {
  int degree = 0;
  std::vector<double> values;

  explicit Harmonics(int l_max)
      : degree(l_max), values(3 * static_cast<std::size_t>(l_max + 1) * static_cast<std::size_t>(l_max + 2), 0.0) {}
  double* order(int m) { return values.data() + 6 * offset(m); }
  const double* order(int m) const { return values.data() + 6 * offset(m); }

 private:
  std::size_t offset(int m) const {
    return static_cast<std::size_t>(m) * static_cast<std::size_t>(degree + 1) -
           static_cast<std::size_t>(m) * static_cast<std::size_t>(m - 1) / 2;
  }
};

// The coefficients of an environment's constant patches, of what `clip` leaves of them, up to degree k.size() - 1:
// exact for a lat-long map; for a cube exact to 1e-7 once degree l is multiplied by k[l], the largest multiplier that
// it will meet. Azimuth runs with the columns of a lat-long map: x = sin t sin p, y = cos t, z = -sin t cos p.
Harmonics harmonics_of(const envmap::Environment& env, const std::vector<double>& k, const envmap::Clip& clip = {});

// The largest relative error (to the mean of the map, for any non-negative environment) that leaving out the degrees
// above `degree` can make: the sum over l > degree of (2l+1) |k_l|.
double truncation_bound(const ZonalKernel& kernel, int degree);

// The smallest degree whose truncation_bound() is at most `error`, or -1 where none up to `most` is.
int sufficient_degree(const ZonalKernel& kernel, double error, int most);

}  // namespace goniochrome::prefilter
