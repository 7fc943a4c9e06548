#include "math/legendre.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "math/legendre.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"

// P_l = a_l x P_(l-1) - b_l P_(l-2), a_l^2 = (4 l^2 - 1)/(l^2 - m^2), b_l = a_l / a_(l-1): the recursion upward in l is
// stable. P_mm = sqrt((2m+1)/(4 pi) (1 - 1/2)(1 - 1/4)...(1 - 1/2m)) sin^m; where that is below 1e-280 every P_lm of a
// degree up to 1000 is negligible, because l sin t stays far below m, and is taken as zero.
//
// The libraries for such sums are no faster. For three maps, sums and values take 3.4 and 5.5 ms here at degree 255,
// and 21 and 40 ms at degree 511. libsharp 1.0, which Debian 12 has, takes 5.4 and 6.6 ms, and 29 and 37 ms, its
// transforms along the rings included; its static library does not link, because it asks for functions that glibc has
// dropped. ducc0 0.42, which Debian 12 does not have, takes 5.7 and 7.9 ms, and 26 and 38 ms.

#ifndef GONIOCHROME_LEGENDRE_STEPS
#define GONIOCHROME_LEGENDRE_STEPS
namespace goniochrome::math::legendre {
struct Steps {
  std::vector<double> a, b;   // by l - m
  std::vector<double> start;  // P_mm on the rings
};
}  // namespace goniochrome::math::legendre
#endif

HWY_BEFORE_NAMESPACE();
namespace goniochrome::math {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Calls body(l, i, P_l) for every degree and every vector of rings, with P_l kept for the next two degrees.
template <class Body>
HWY_INLINE void ForEachDegree(const Rings& rings, const legendre::Steps& steps, std::size_t degrees,
                              std::vector<double>& previous, std::vector<double>& current, const Body& body) {
  const hn::ScalableTag<double> d;
  for (std::size_t k = 0; k < degrees; ++k) {
    double *p0 = previous.data(), *p1 = current.data();
    const auto a = hn::Set(d, steps.a[k]), b = hn::Set(d, steps.b[k]);
    body(k, [&](std::size_t i) HWY_ATTR {
      if (k == 0) return hn::LoadU(d, p1 + i);
      const auto x = hn::LoadU(d, rings.cosine.data() + i);
      const auto last = hn::LoadU(d, p1 + i);
      const auto next = hn::MulSub(hn::Mul(a, x), last, hn::Mul(b, hn::LoadU(d, p0 + i)));
      hn::StoreU(next, d, p0 + i);
      return next;
    });
    if (k > 0) std::swap(previous, current);
  }
}

// For every degree: six sums over the rings, in registers, of what the recursion yields vector by vector.
void Sums(const Rings& rings, const legendre::Steps& steps, std::size_t degrees, const double* even, const double* odd,
          double* out) {
  const hn::ScalableTag<double> d;
  const std::size_t n = rings.count, step = hn::Lanes(d);
  std::vector<double> previous(n, 0.0), current = steps.start;
  ForEachDegree(rings, steps, degrees, previous, current, [&](std::size_t k, const auto& value) HWY_ATTR {
    const double* h = k % 2 == 0 ? even : odd;
    auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0;
    for (std::size_t i = 0; i < n; i += step) {
      const auto p = value(i);
      s0 = hn::MulAdd(p, hn::LoadU(d, h + i), s0);
      s1 = hn::MulAdd(p, hn::LoadU(d, h + n + i), s1);
      s2 = hn::MulAdd(p, hn::LoadU(d, h + 2 * n + i), s2);
      s3 = hn::MulAdd(p, hn::LoadU(d, h + 3 * n + i), s3);
      s4 = hn::MulAdd(p, hn::LoadU(d, h + 4 * n + i), s4);
      s5 = hn::MulAdd(p, hn::LoadU(d, h + 5 * n + i), s5);
    }
    double* a = out + 6 * k;
    a[0] = hn::GetLane(hn::SumOfLanes(d, s0));
    a[1] = hn::GetLane(hn::SumOfLanes(d, s1));
    a[2] = hn::GetLane(hn::SumOfLanes(d, s2));
    a[3] = hn::GetLane(hn::SumOfLanes(d, s3));
    a[4] = hn::GetLane(hn::SumOfLanes(d, s4));
    a[5] = hn::GetLane(hn::SumOfLanes(d, s5));
  });
}

// For every degree: what the recursion yields, times the six coefficients, added to the values on the rings.
void Values(const Rings& rings, const legendre::Steps& steps, std::size_t degrees, const double* in, double* even,
            double* odd) {
  const hn::ScalableTag<double> d;
  const std::size_t n = rings.count, step = hn::Lanes(d);
  std::fill(even, even + 6 * n, 0.0);
  std::fill(odd, odd + 6 * n, 0.0);
  std::vector<double> previous(n, 0.0), current = steps.start;
  ForEachDegree(rings, steps, degrees, previous, current, [&](std::size_t k, const auto& value) HWY_ATTR {
    double* h = k % 2 == 0 ? even : odd;
    const double* a = in + 6 * k;
    for (std::size_t i = 0; i < n; i += step) {
      const auto p = value(i);
      for (std::size_t c = 0; c < 6; ++c)
        hn::StoreU(hn::MulAdd(p, hn::Set(d, a[c]), hn::LoadU(d, h + c * n + i)), d, h + c * n + i);
    }
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::math
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::math {

HWY_EXPORT(Sums);
HWY_EXPORT(Values);

namespace {

constexpr std::size_t kPadding = 8;
constexpr double kSmallestLog = -644.0;  // ln 1e-280

// The factors of the recursion for one order, and P_mm by its logarithm, since sin^m leaves the range of doubles.
legendre::Steps steps_of(const Rings& rings, int m, int degree) {
  legendre::Steps steps;
  const double mm = static_cast<double>(m) * m;
  const auto a = [mm](double l) { return std::sqrt((4 * l * l - 1) / (l * l - mm)); };
  for (int l = m; l <= degree; ++l) {
    steps.a.push_back(l > m ? a(l) : 0);
    steps.b.push_back(l > m + 1 ? a(l) / a(l - 1) : 0);
  }
  double log_scale = 0.5 * std::log((2.0 * m + 1) / (4 * kPi));
  for (int k = 1; k <= m; ++k) log_scale += 0.5 * std::log1p(-0.5 / k);
  steps.start.resize(rings.count);
  for (std::size_t i = 0; i < rings.count; ++i) {
    const double log_value = log_scale + (m > 0 ? m * rings.log_sine[i] : 0);
    steps.start[i] = log_value > kSmallestLog ? std::exp(log_value) : 0;
  }
  return steps;
}

}  // namespace

Rings::Rings(const std::vector<double>& theta) : count((theta.size() + kPadding - 1) / kPadding * kPadding) {
  cosine.assign(count, 0.0);
  log_sine.assign(count, 0.0);
  for (std::size_t i = 0; i < theta.size(); ++i) {
    cosine[i] = std::cos(theta[i]);
    log_sine[i] = std::log(std::sin(theta[i]));
  }
}

void legendre_sums(const Rings& rings, int m, int degree, const double* even, const double* odd, double* a) {
  const legendre::Steps steps = steps_of(rings, m, degree);
  HWY_DYNAMIC_DISPATCH(Sums)(rings, steps, steps.a.size(), even, odd, a);
}

void legendre_values(const Rings& rings, int m, int degree, const double* a, double* even, double* odd) {
  const legendre::Steps steps = steps_of(rings, m, degree);
  HWY_DYNAMIC_DISPATCH(Values)(rings, steps, steps.a.size(), a, even, odd);
}

}  // namespace goniochrome::math
#endif
