#include "prefilter/internal/lobe_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prefilter/internal/lobe_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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

double SumOfPowers(const double* weight, const double* level, std::size_t count, double a, double b, double exponent) {
  const hn::CappedTag<double, kPadding> d;
  auto sum = hn::Zero(d);
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    const auto t = hn::MulAdd(hn::Set(d, b), hn::LoadU(d, level + i), hn::Set(d, a));
    sum = hn::MulAdd(hn::LoadU(d, weight + i), power(d, t, exponent), sum);
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

// The four numbers from each index on. Four vectors are loaded and transposed where vectors have four lanes, since that
// took a third of the time of four gathers on a Zen 3.
template <class Tag, class Index>
HWY_INLINE void four_of_each(Tag d, const double* from, Index index, hn::Vec<Tag>& c0, hn::Vec<Tag>& c1,
                             hn::Vec<Tag>& c2, hn::Vec<Tag>& c3) {
#if HWY_TARGET == HWY_AVX2
  alignas(16) std::int32_t at[4];
  hn::Store(index, hn::Rebind<std::int32_t, Tag>(), at);
  const auto r0 = hn::LoadU(d, from + at[0]), r1 = hn::LoadU(d, from + at[1]);
  const auto r2 = hn::LoadU(d, from + at[2]), r3 = hn::LoadU(d, from + at[3]);
  const auto even01 = hn::InterleaveLower(d, r0, r1), odd01 = hn::InterleaveUpper(d, r0, r1);
  const auto even23 = hn::InterleaveLower(d, r2, r3), odd23 = hn::InterleaveUpper(d, r2, r3);
  c0 = hn::ConcatLowerLower(d, even23, even01), c1 = hn::ConcatLowerLower(d, odd23, odd01);
  c2 = hn::ConcatUpperUpper(d, even23, even01), c3 = hn::ConcatUpperUpper(d, odd23, odd01);
#else
  const auto wide = hn::PromoteTo(hn::RebindToSigned<Tag>(), index);
  c0 = hn::GatherIndex(d, from, wide), c1 = hn::GatherIndex(d, from + 1, wide);
  c2 = hn::GatherIndex(d, from + 2, wide), c3 = hn::GatherIndex(d, from + 3, wide);
#endif
}

// F at x: the interval, and the cubic in it. The end intervals are lines and serve all beyond.
template <class Tag>
HWY_INLINE hn::Vec<Tag> antiderivative(Tag d, const SecondIntegral& band, hn::Vec<Tag> x) {
  const hn::Rebind<std::int32_t, Tag> di;
  const double last = static_cast<double>(band.coefficients.size() / 4 - 1);
  const auto y = hn::Mul(hn::Sub(x, hn::Set(d, band.begin)), hn::Set(d, band.per_unit));
  const auto interval = hn::Min(hn::Max(hn::Floor(y), hn::Zero(d)), hn::Set(d, last));
  const auto z = hn::Sub(y, interval);
  const auto index = hn::ShiftLeft<2>(hn::DemoteTo(di, interval));
  hn::Vec<Tag> c0, c1, c2, c3;
  four_of_each(d, band.coefficients.data(), index, c0, c1, c2, c3);
  return hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, z, c2), z, c1), z, c0);
}

// The mean as of SecondIntegral::mean().
template <class Tag>
HWY_INLINE hn::Vec<Tag> cut_mean(Tag d, const SecondIntegral& band, hn::Vec<Tag> middle, hn::Vec<Tag> along,
                                 hn::Vec<Tag> down) {
  const auto half = hn::Set(d, 0.5);
  const auto wide = hn::Mul(half, hn::Add(along, down)), narrow = hn::Mul(half, hn::Sub(along, down));
  const auto outer =
      hn::Add(antiderivative(d, band, hn::Add(middle, wide)), antiderivative(d, band, hn::Sub(middle, wide)));
  const auto inner =
      hn::Add(antiderivative(d, band, hn::Add(middle, narrow)), antiderivative(d, band, hn::Sub(middle, narrow)));
  return hn::Div(hn::Sub(outer, inner), hn::Mul(along, down));
}

// The mean as of SecondIntegral::far_mean().
template <class Tag>
HWY_INLINE hn::Vec<Tag> far_mean(Tag d, const SecondIntegral& band, hn::Vec<Tag> middle, hn::Vec<Tag> along,
                                 hn::Vec<Tag> down) {
  const hn::Rebind<std::int32_t, Tag> di;
  const double last = static_cast<double>(band.means.size() / 4 - 1);
  const auto y =
      hn::Min(hn::Max(hn::Mul(hn::Sub(middle, hn::Set(d, band.means_begin)), hn::Set(d, band.per_unit)), hn::Zero(d)),
              hn::Set(d, last));
  const auto interval = hn::Floor(y), z = hn::Sub(y, interval);
  hn::Vec<Tag> m0, change0, m1, change1;
  four_of_each(d, band.means.data(), hn::ShiftLeft<2>(hn::DemoteTo(di, interval)), m0, change0, m1, change1);
  const auto square = hn::MulAdd(along, along, hn::Mul(down, down));
  const auto more = hn::MulSub(square, hn::Set(d, 1.0 / 12), hn::Set(d, band.variance));
  return hn::MulAdd(more, hn::MulAdd(change1, z, m1), hn::MulAdd(change0, z, m0));
}

template <class Tag>
HWY_INLINE hn::Vec<Tag> mean_of_band(Tag d, const SecondIntegral& band, hn::Vec<Tag> middle, hn::Vec<Tag> along,
                                     hn::Vec<Tag> down, double least) {
  along = hn::Max(hn::Abs(along), hn::Set(d, least));
  down = hn::Max(hn::Abs(down), hn::Set(d, least));
  if (hn::AllTrue(d, hn::Gt(hn::Abs(middle), hn::Set(d, band.cut)))) return far_mean(d, band, middle, along, down);
  return cut_mean(d, band, middle, along, down);
}

using Padded = hn::CappedTag<double, kPadding>;
using Lanes = hn::Vec<Padded>;

// Adds a row to the lanes of three sums. kPadding more texels may be read: they do not count.
template <class Kernel>
HWY_INLINE void add_padded(const float* rgb, std::size_t columns, const Kernel& kernel, Lanes& red, Lanes& green,
                           Lanes& blue) {
  const Padded d;
  const hn::Rebind<float, Padded> df;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t j = 0; j < columns; j += lanes) {
    hn::Vec<decltype(df)> r, g, b;
    hn::LoadInterleaved3(df, rgb + 3 * j, r, g, b);
    const auto k = hn::IfThenElseZero(hn::FirstN(d, columns - j), kernel(d, j));
    red = hn::MulAdd(k, hn::PromoteTo(d, r), red);
    green = hn::MulAdd(k, hn::PromoteTo(d, g), green);
    blue = hn::MulAdd(k, hn::PromoteTo(d, b), blue);
  }
}

HWY_INLINE void add_lanes(Lanes red, Lanes green, Lanes blue, double sum[3]) {
  const Padded d;
  sum[0] += hn::GetLane(hn::SumOfLanes(d, red));
  sum[1] += hn::GetLane(hn::SumOfLanes(d, green));
  sum[2] += hn::GetLane(hn::SumOfLanes(d, blue));
}

// Texels that need no corners take a quarter of the time of the others: these are put aside, so that a vector has
// texels of one kind.
void LatLongBandWeights(const double* sine, const double* cosine, const LatLongBand& at, const SecondIntegral& band,
                        float* weights, std::size_t from, CutTexels& cut) {
  const Padded d;
  const hn::Rebind<float, Padded> df;
  const auto least = hn::Set(d, at.least), area = hn::Set(d, at.area);
  for (std::size_t j = 0; j < at.columns; j += hn::Lanes(d)) {
    const auto s = hn::LoadU(d, sine + j), c = hn::LoadU(d, cosine + j);
    const auto middle = hn::MulAdd(hn::Set(d, at.b), s, hn::MulAdd(hn::Set(d, at.c), c, hn::Set(d, at.a)));
    const auto along = hn::Max(
        hn::Abs(hn::Mul(hn::Set(d, at.width), hn::MulSub(hn::Set(d, at.b), c, hn::Mul(hn::Set(d, at.c), s)))), least);
    const auto down =
        hn::Max(hn::Abs(hn::MulAdd(hn::Set(d, at.f), s, hn::MulAdd(hn::Set(d, at.g), c, hn::Set(d, at.e)))), least);
    if (!band.means.empty())
      hn::StoreU(hn::DemoteTo(df, hn::Mul(area, far_mean(d, band, middle, along, down))), df, weights + from + j);
    const auto is_cut = hn::And(hn::Le(hn::Abs(middle), hn::Set(d, band.cut)), hn::FirstN(d, at.columns - j));
    if (hn::AllFalse(d, is_cut)) continue;
    const std::size_t n = cut.count;
    hn::CompressStore(middle, is_cut, d, &cut.middle[n]);
    hn::CompressStore(along, is_cut, d, &cut.along[n]);
    hn::CompressStore(down, is_cut, d, &cut.down[n]);
    hn::CompressStore(area, is_cut, d, &cut.area[n]);
    alignas(64) double places[kPadding];
    cut.count += hn::CompressStore(hn::Iota(d, static_cast<double>(from + j)), is_cut, d, places);
    for (std::size_t i = n; i < cut.count; ++i) cut.at[i] = static_cast<std::size_t>(places[i - n]);
  }
}

void CutBandWeights(const CutTexels& cut, const SecondIntegral& band, float* weights) {
  const Padded d;
  alignas(64) double result[kPadding];
  for (std::size_t i = 0; i < cut.count; i += hn::Lanes(d)) {
    const auto mean =
        cut_mean(d, band, hn::LoadU(d, &cut.middle[i]), hn::LoadU(d, &cut.along[i]), hn::LoadU(d, &cut.down[i]));
    hn::Store(hn::Mul(hn::LoadU(d, &cut.area[i]), mean), d, result);
    for (std::size_t k = i; k < std::min(cut.count, i + hn::Lanes(d)); ++k)
      weights[cut.at[k]] = static_cast<float>(result[k - i]);
  }
}

// A lane holds one channel in every third vector. The weights of a vector of texels are spread over three vectors of
// their channels. Floats add up kStripsAsFloats strips, which rounds by some 1e-7 of what these have; doubles add up
// the rest.
void Strips(const float* rgb, const int* at, const float* weights, std::size_t strips, double sum[3]) {
  constexpr std::size_t kStripsAsFloats = 16;
  const hn::CappedTag<float, kStrip> d;
  const std::size_t lanes = hn::Lanes(d);
  alignas(64) std::int32_t texel[3 * kStrip];
  for (std::size_t i = 0; i < 3 * lanes; ++i) texel[i] = static_cast<std::int32_t>(i / 3);
  const auto to_first = hn::SetTableIndices(d, texel), to_second = hn::SetTableIndices(d, texel + lanes),
             to_third = hn::SetTableIndices(d, texel + 2 * lanes);
  double exact[3 * kStrip] = {};
  for (std::size_t begin = 0; begin < strips; begin += kStripsAsFloats) {
    auto first = hn::Zero(d), second = first, third = first;
    for (std::size_t i = begin; i < std::min(strips, begin + kStripsAsFloats); ++i)
      for (std::size_t v = 0; v < kStrip; v += lanes) {
        const auto weight = hn::LoadU(d, weights + kStrip * i + v);
        const float* from = rgb + 3 * (static_cast<std::size_t>(at[i]) + v);
        first = hn::MulAdd(hn::TableLookupLanes(weight, to_first), hn::LoadU(d, from), first);
        second = hn::MulAdd(hn::TableLookupLanes(weight, to_second), hn::LoadU(d, from + lanes), second);
        third = hn::MulAdd(hn::TableLookupLanes(weight, to_third), hn::LoadU(d, from + 2 * lanes), third);
      }
    alignas(64) float part[3 * kStrip];
    hn::StoreU(first, d, part), hn::StoreU(second, d, part + lanes), hn::StoreU(third, d, part + 2 * lanes);
    for (std::size_t i = 0; i < 3 * lanes; ++i) exact[i] += static_cast<double>(part[i]);
  }
  for (std::size_t i = 0; i < 3 * lanes; ++i) sum[i % 3] += exact[i];
}

void CubeBandRow(const float* rgb, std::size_t columns, const double* s, const double* width, const CubeBand& at,
                 const SecondIntegral& band, double sum[3]) {
  const Padded lanes;
  Lanes red = hn::Zero(lanes), green = red, blue = red;
  add_padded(
      rgb, columns,
      [&](auto d, std::size_t j) HWY_ATTR {
        const auto x = hn::LoadU(d, s + j), w = hn::LoadU(d, width + j);
        const auto norm2 = hn::MulAdd(x, x, hn::Set(d, at.m));
        const auto inverse = hn::Div(hn::Set(d, 1.0), hn::Sqrt(norm2)), inverse2 = hn::Mul(inverse, inverse);
        const auto middle = hn::Mul(hn::MulAdd(hn::Set(d, at.q), x, hn::Set(d, at.p)), inverse);
        const auto slope = hn::Mul(middle, inverse2);
        const auto along = hn::Mul(w, hn::MulSub(hn::Set(d, at.q), inverse, hn::Mul(slope, x)));
        const auto down =
            hn::Mul(hn::Set(d, at.down), hn::MulSub(hn::Set(d, at.r), inverse, hn::Mul(slope, hn::Set(d, at.t))));
        const auto area = hn::Mul(hn::Mul(w, hn::Set(d, at.down)), hn::Mul(inverse, inverse2));
        return hn::Mul(area, mean_of_band(d, band, middle, along, down, at.least));
      },
      red, green, blue);
  add_lanes(red, green, blue, sum);
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
HWY_EXPORT(SumOfPowers);
HWY_EXPORT(LatLongBandWeights);
HWY_EXPORT(CutBandWeights);
HWY_EXPORT(Strips);
HWY_EXPORT(CubeBandRow);

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

double sum_of_powers(const double* weight, const double* level, std::size_t count, double a, double b,
                     double exponent) {
  return HWY_DYNAMIC_DISPATCH(SumOfPowers)(weight, level, count, a, b, exponent);
}

void lat_long_band_weights(const double* sine, const double* cosine, const LatLongBand& part,
                           const SecondIntegral& band, float* weights, std::size_t from, CutTexels& cut) {
  for (std::vector<double>* values : {&cut.middle, &cut.along, &cut.down, &cut.area})
    if (values->size() < cut.count + part.columns + kPadding) values->resize(2 * (cut.count + part.columns + kPadding));
  cut.at.resize(cut.middle.size());
  HWY_DYNAMIC_DISPATCH(LatLongBandWeights)(sine, cosine, part, band, weights, from, cut);
}

void cut_band_weights(const CutTexels& cut, const SecondIntegral& band, float* weights) {
  HWY_DYNAMIC_DISPATCH(CutBandWeights)(cut, band, weights);
}

void add_strips(const float* rgb, const int* at, const float* weights, std::size_t strips, double sum[3]) {
  HWY_DYNAMIC_DISPATCH(Strips)(rgb, at, weights, strips, sum);
}

void add_cube_band(const float* rgb, std::size_t columns, const double* s, const double* width, const CubeBand& at,
                   const SecondIntegral& band, double sum[3]) {
  HWY_DYNAMIC_DISPATCH(CubeBandRow)(rgb, columns, s, width, at, band, sum);
}

}  // namespace goniochrome::prefilter::rows
#endif
