#include "math/fft.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace goniochrome::math::fft_test {
namespace {

TEST(Fft, OfEveryLengthEqualsTheSum) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const std::size_t n : {1, 2, 3, 4, 5, 6, 7, 8, 12, 15, 16, 22, 49, 60, 64, 97, 120}) {
    constexpr std::size_t kLanes = 8;
    std::vector<double> re(n * kLanes), im(n * kLanes), sr(n * kLanes), si(n * kLanes);
    for (double& v : re) v = normal(random);
    for (double& v : im) v = normal(random);
    for (const int sign : {-1, 1}) {
      auto fr = re, fi = im;
      Fft(n).transform(sign, kLanes, fr.data(), fi.data(), sr.data(), si.data());
      for (std::size_t k = 0; k < n; ++k) {
        long double wr = 0, wi = 0;
        for (std::size_t j = 0; j < n; ++j) {
          const long double a = 2 * acosl(-1) * static_cast<long double>(j * k % n) / n;
          const long double c = cosl(a), s = sign * sinl(a);
          wr += re[j * kLanes + 3] * c - im[j * kLanes + 3] * s;
          wi += re[j * kLanes + 3] * s + im[j * kLanes + 3] * c;
        }
        // n terms of order 1, each within a few ulps
        EXPECT_NEAR(fr[k * kLanes + 3], static_cast<double>(wr), 4e-16 * n + 4e-15) << n;
        EXPECT_NEAR(fi[k * kLanes + 3], static_cast<double>(wi), 4e-16 * n + 4e-15) << n;
      }
    }
  }
}

}  // namespace
}  // namespace goniochrome::math::fft_test
