// These sums and values of associated Legendre functions run over many polar angles at once. The functions are
// normalized so that the integral of |P_lm(cos t) exp(i m p)|^2 over the sphere is 1.
// goniochrome-prefiltering(7), "Zonal harmonics".
#pragma once

#include <cstddef>
#include <vector>

namespace goniochrome::math {

// The rings of the northern hemisphere, padded with zeros to a multiple of 8. A function whose degree and order differ
// by an even number is the same on the mirrored southern ring, else its negative.
struct Rings {
  std::size_t count = 0;  // padded
  std::vector<double> cosine, log_sine;

  explicit Rings(const std::vector<double>& theta);
};

// For one order m and every degree l = m..degree, six real series (re R G B, im R G B).
// Sums over the rings: a[6 (l-m) + c] = sum of P_lm h, h = even[c] or odd[c] as l - m is; `even` and `odd` hold 6
// arrays of rings.count values.
void legendre_sums(const Rings& rings, int m, int degree, const double* even, const double* odd, double* a);

// Values on the rings: even[c] (and odd[c]) = sum over even (odd) l - m of a[6 (l-m) + c] P_lm.
void legendre_values(const Rings& rings, int m, int degree, const double* a, double* even, double* odd);

}  // namespace goniochrome::math
