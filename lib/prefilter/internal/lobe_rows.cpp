#include "prefilter/internal/lobe_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prefilter/internal/lobe_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>
// After highway.h:
#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace goniochrome::prefilter::rows {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;

// max(0,t)^E; t is rounded at 1e-16, so the power at E 1e-16, 1e-10 for the sharpest lobe of 1e6. Below e^-600 there is
// nothing to add, and exp() need not meet subnormals.
template <class Tag>
HWY_INLINE hn::Vec<Tag> power(Tag d, hn::Vec<Tag> t, double exponent) {
  const auto above = hn::Gt(t, hn::Zero(d));
  if (exponent == 0) return hn::IfThenElseZero(above, hn::Set(d, 1.0));
  if (exponent == 1) return hn::IfThenElseZero(above, t);
  const auto clipped = hn::Min(hn::Max(t, hn::Set(d, 1e-300)), hn::Set(d, 1.0));
  const auto x = hn::Max(hn::Mul(hn::Set(d, exponent), hn::Log(d, clipped)), hn::Set(d, -600.0));
  return hn::IfThenElseZero(hn::And(above, hn::Gt(x, hn::Set(d, -600.0))), hn::Exp(d, x));
}

// Adds a row to `sum`; `kernel(d, j)` gives the weights of texels j, j+1, ... Step 1: as many texels at a time as a
// vector has lanes, each channel in a vector of its own. Step 2: the lanes are added up. Step 3: the texels left over,
// one by one.
template <class Kernel>
HWY_INLINE void add_row(const float* rgb, std::size_t columns, const Kernel& kernel, double sum[3]) {
  const D d;
  const hn::Rebind<float, D> df;
  const std::size_t lanes = hn::Lanes(d);
  V red = hn::Zero(d), green = red, blue = red;
  std::size_t j = 0;
  for (; j + lanes <= columns; j += lanes) {
    hn::Vec<decltype(df)> r, g, b;
    hn::LoadInterleaved3(df, rgb + 3 * j, r, g, b);
    const V k = kernel(d, j);
    red = hn::MulAdd(k, hn::PromoteTo(d, r), red);
    green = hn::MulAdd(k, hn::PromoteTo(d, g), green);
    blue = hn::MulAdd(k, hn::PromoteTo(d, b), blue);
  }
  sum[0] += hn::GetLane(hn::SumOfLanes(d, red));
  sum[1] += hn::GetLane(hn::SumOfLanes(d, green));
  sum[2] += hn::GetLane(hn::SumOfLanes(d, blue));
  for (; j < columns; ++j) {
    const double k = hn::GetLane(kernel(hn::CappedTag<double, 1>(), j));
    for (int c = 0; c < 3; ++c) sum[c] += k * static_cast<double>(rgb[3 * j + c]);
  }
}

void LatLongRow(const float* rgb, std::size_t columns, const double* sine, const double* cosine, double a, double b,
                double c, double exponent, double sum[3]) {
  add_row(
      rgb, columns,
      [&](auto d, std::size_t j) HWY_ATTR {
        const auto t = hn::MulAdd(hn::Set(d, b), hn::LoadU(d, sine + j),
                                  hn::MulAdd(hn::Set(d, c), hn::LoadU(d, cosine + j), hn::Set(d, a)));
        return power(d, t, exponent);
      },
      sum);
}

void CubeRow(const float* rgb, std::size_t columns, const double* s, const double* weight, double p, double q, double m,
             double exponent, double sum[3]) {
  add_row(
      rgb, columns,
      [&](auto d, std::size_t j) HWY_ATTR {
        const auto x = hn::LoadU(d, s + j);
        const auto norm2 = hn::MulAdd(x, x, hn::Set(d, m));
        const auto norm = hn::Sqrt(norm2);
        const auto t = hn::Div(hn::MulAdd(hn::Set(d, q), x, hn::Set(d, p)), norm);
        return hn::Mul(power(d, t, exponent), hn::Div(hn::LoadU(d, weight + j), hn::Mul(norm, norm2)));
      },
      sum);
}

void Points(const float* rgb, std::size_t points, const double* x, const double* y, const double* z,
            const double direction[3], double exponent, double sum[3]) {
  add_row(
      rgb, points,
      [&](auto d, std::size_t j) HWY_ATTR {
        const auto t = hn::MulAdd(hn::Set(d, direction[0]), hn::LoadU(d, x + j),
                                  hn::MulAdd(hn::Set(d, direction[1]), hn::LoadU(d, y + j),
                                             hn::Mul(hn::Set(d, direction[2]), hn::LoadU(d, z + j))));
        return power(d, t, exponent);
      },
      sum);
}

// Step 1: a vector of points at a time, which mostly has none near. Step 2: those of a vector that has, one by one.
// Step 3: the last points, by a vector that reaches back, or one by one where they do not fill a vector.
std::size_t Near(std::size_t points, const double* x, const double* y, const double* z, const double direction[3],
                 double cosine, double margin, std::size_t* found) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  std::size_t count = 0;
  const auto dx = hn::Set(d, direction[0]), dy = hn::Set(d, direction[1]), dz = hn::Set(d, direction[2]);
  const auto middle = hn::Set(d, cosine);
  std::size_t j = 0;
  for (; j < points; j += lanes) {
    // The last vector reaches back over points that were looked at.
    const std::size_t at = j + lanes <= points || points < lanes ? j : points - lanes;
    if (points < lanes) break;
    const auto t = hn::MulAdd(dx, hn::LoadU(d, x + at),
                              hn::MulAdd(dy, hn::LoadU(d, y + at), hn::MulSub(dz, hn::LoadU(d, z + at), middle)));
    const auto near = hn::Le(hn::Abs(t), hn::Set(d, margin));
    if (hn::AllFalse(d, near)) continue;
    for (std::size_t i = j; i < at + lanes; ++i) {
      const double one = direction[0] * x[i] + (direction[1] * y[i] + direction[2] * z[i]) - cosine;
      if (std::fabs(one) <= margin) found[count++] = i;
    }
  }
  for (; j < points && points < lanes; ++j) {
    const double one = direction[0] * x[j] + (direction[1] * y[j] + direction[2] * z[j]) - cosine;
    if (std::fabs(one) <= margin) found[count++] = j;
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::prefilter::rows
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::prefilter::rows {

HWY_EXPORT(LatLongRow);
HWY_EXPORT(CubeRow);
HWY_EXPORT(Points);
HWY_EXPORT(Near);

void add_lat_long_row(const float* rgb, std::size_t columns, const double* sine, const double* cosine, double a,
                      double b, double c, double exponent, double sum[3]) {
  HWY_DYNAMIC_DISPATCH(LatLongRow)(rgb, columns, sine, cosine, a, b, c, exponent, sum);
}

void add_cube_row(const float* rgb, std::size_t columns, const double* s, const double* weight, double p, double q,
                  double m, double exponent, double sum[3]) {
  HWY_DYNAMIC_DISPATCH(CubeRow)(rgb, columns, s, weight, p, q, m, exponent, sum);
}

void add_points(const float* rgb, std::size_t points, const double* x, const double* y, const double* z,
                const double d[3], double exponent, double sum[3]) {
  HWY_DYNAMIC_DISPATCH(Points)(rgb, points, x, y, z, d, exponent, sum);
}

std::size_t points_near(std::size_t points, const double* x, const double* y, const double* z, const double d[3],
                        double cosine, double margin, std::size_t* found) {
  return HWY_DYNAMIC_DISPATCH(Near)(points, x, y, z, d, cosine, margin, found);
}

}  // namespace goniochrome::prefilter::rows
#endif
