#include "render/path/regression_kernel.h"

#include <algorithm>

#include "base/parallel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/path/regression_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, SurfaceImage::kLanes>;
using V = hn::Vec<D>;

// The part of the weight that is added to the square of each slope: where a window tells nothing of a slope, it is 0.
constexpr float kRidge = 2e-3F;
// Place of the product of features k >= l among the products.
constexpr std::size_t product(std::size_t k, std::size_t l) {
  return k * (k + 1) / 2 + l;
}

struct Frame {
  V normal[3], first[3], second[3], position[3], shift[2], part;
};

// The tangents of rays::frame_about(), [Duff2017].
HWY_INLINE void SetTangents(Frame& f) {
  const D d;
  const V one = hn::Set(d, 1.0F), sign = hn::CopySign(one, f.normal[2]);
  const V a = hn::Div(hn::Set(d, -1.0F), hn::Add(sign, f.normal[2]));
  const V b = hn::Mul(hn::Mul(f.normal[0], f.normal[1]), a);
  f.first[0] = hn::MulAdd(hn::Mul(hn::Mul(sign, f.normal[0]), f.normal[0]), a, one);
  f.first[1] = hn::Mul(sign, b), f.first[2] = hn::Neg(hn::Mul(sign, f.normal[0]));
  f.second[0] = b, f.second[1] = hn::MulAdd(hn::Mul(f.normal[1], f.normal[1]), a, sign);
  f.second[2] = hn::Neg(f.normal[1]);
}

HWY_INLINE V Dot(const V (&a)[3], const V (&b)[3]) {
  return hn::MulAdd(a[0], b[0], hn::MulAdd(a[1], b[1], hn::Mul(a[2], b[2])));
}

// Solves the normal equations by Cholesky's decomposition; products are overwritten.
template <std::size_t kFeatures, std::size_t kChannels>
HWY_INLINE void Solve(V* m, V* r) {
  const D d;
  const V tiny = hn::Set(d, 1e-20F);
  const V ridge = hn::Mul(hn::Set(d, kRidge), m[0]);
  for (std::size_t k = 1; k < kFeatures; ++k) m[product(k, k)] = hn::Add(m[product(k, k)], ridge);
  V inverse[kFeatures];
  for (std::size_t k = 0; k < kFeatures; ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      V sum = m[product(k, l)];
      for (std::size_t j = 0; j < l; ++j) sum = hn::NegMulAdd(m[product(k, j)], m[product(l, j)], sum);
      m[product(k, l)] = l < k ? hn::Mul(sum, inverse[l]) : hn::Sqrt(hn::Max(sum, tiny));
    }
    inverse[k] = hn::Div(hn::Set(d, 1.0F), m[product(k, k)]);
  }
  for (std::size_t c = 0; c < kChannels; ++c) {
    for (std::size_t k = 0; k < kFeatures; ++k) {
      V sum = r[k * kChannels + c];
      for (std::size_t j = 0; j < k; ++j) sum = hn::NegMulAdd(m[product(k, j)], r[j * kChannels + c], sum);
      r[k * kChannels + c] = hn::Mul(sum, inverse[k]);
    }
    for (std::size_t k = kFeatures; k-- > 0;) {
      V sum = r[k * kChannels + c];
      for (std::size_t j = k + 1; j < kFeatures; ++j) sum = hn::NegMulAdd(m[product(j, k)], r[j * kChannels + c], sum);
      r[k * kChannels + c] = hn::Mul(sum, inverse[k]);
    }
  }
}

template <std::size_t kFeatures, std::size_t kChannels>
HWY_INLINE void Fit(const SurfaceImage& image, const RegressionWindow& window, int y, float* coefficients) {
  constexpr std::size_t kProducts = kFeatures * (kFeatures + 1) / 2, kCoefficients = kFeatures * kChannels;
  const D d;
  const V one = hn::Set(d, 1.0F), zero = hn::Zero(d);
  const float scale = 1.0F / (static_cast<float>(window.reach) + 0.5F);
  const V per_reach = hn::Set(d, scale), per_normal = hn::Set(d, 1 / window.normal),
          per_plane = hn::Set(d, 1 / (window.plane * window.plane));
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float fitted[kCoefficients * SurfaceImage::kLanes];
  for (int x = 0; x < image.width; x += static_cast<int>(lanes)) {
    const std::size_t i = image.at(x, y);
    if (hn::AllFalse(d, hn::Gt(hn::LoadU(d, image.weight + i), zero))) continue;
    V m[kProducts], r[kCoefficients];
    for (V& v : m) v = zero;
    for (V& v : r) v = zero;
    Frame f;
    for (std::size_t k = 0; k < 3; ++k)
      f.normal[k] = hn::LoadU(d, image.normal[k] + i), f.position[k] = hn::LoadU(d, image.position[k] + i);
    for (std::size_t k = 0; k < 2; ++k) f.shift[k] = hn::LoadU(d, image.shift[k] + i);
    f.part = hn::LoadU(d, image.part + i);
    if constexpr (kFeatures > 1) SetTangents(f);
    for (int v = -window.reach; v <= window.reach; ++v) {
      for (int u = -window.reach; u <= window.reach; ++u) {
        const std::size_t j = i + static_cast<std::size_t>(v * static_cast<std::ptrdiff_t>(image.stride) + u);
        V weight = hn::LoadU(d, image.weight + j);
        const auto same = hn::And(hn::Gt(weight, zero), hn::Eq(hn::LoadU(d, image.part + j), f.part));
        if (hn::AllFalse(d, same)) continue;
        V turned[3], way[3];
        for (std::size_t k = 0; k < 3; ++k) {
          turned[k] = hn::Sub(hn::LoadU(d, image.normal[k] + j), f.normal[k]);
          way[k] = hn::Sub(hn::LoadU(d, image.position[k] + j), f.position[k]);
        }
        const V right = hn::Mul(per_reach, hn::Add(hn::Set(d, static_cast<float>(u)),
                                                   hn::Sub(hn::LoadU(d, image.shift[0] + j), f.shift[0])));
        const V down = hn::Mul(per_reach, hn::Add(hn::Set(d, static_cast<float>(v)),
                                                  hn::Sub(hn::LoadU(d, image.shift[1] + j), f.shift[1])));
        const V off = Dot(way, f.normal), length = hn::Add(Dot(way, way), hn::Set(d, 1e-20F));
        V far = hn::MulAdd(right, right, hn::Mul(down, down));
        far = hn::MulAdd(hn::Mul(per_normal, per_normal), Dot(turned, turned), far);
        far = hn::MulAdd(per_plane, hn::Div(hn::Mul(off, off), length), far);
        const V near = hn::Max(zero, hn::Sub(one, far));
        weight = hn::IfThenElseZero(same, hn::Mul(weight, hn::Mul(near, near)));
        V feature[kFeatures] = {one};
        if constexpr (kFeatures > 1) {
          feature[1] = right, feature[2] = down;
          feature[3] = hn::Mul(per_normal, Dot(turned, f.first));
          feature[4] = hn::Mul(per_normal, Dot(turned, f.second));
        }
        V value[kChannels];
        for (std::size_t c = 0; c < kChannels; ++c) value[c] = hn::LoadU(d, image.value[c] + j);
        for (std::size_t k = 0; k < kFeatures; ++k) {
          const V weighed = hn::Mul(weight, feature[k]);
          for (std::size_t l = 0; l <= k; ++l) m[product(k, l)] = hn::MulAdd(weighed, feature[l], m[product(k, l)]);
          for (std::size_t c = 0; c < kChannels; ++c)
            r[k * kChannels + c] = hn::MulAdd(weighed, value[c], r[k * kChannels + c]);
        }
      }
    }
    Solve<kFeatures, kChannels>(m, r);
    for (std::size_t k = 0; k < kCoefficients; ++k) hn::Store(r[k], d, fitted + k * lanes);
    for (std::size_t lane = 0; lane < lanes && x + static_cast<int>(lane) < image.width; ++lane) {
      if (!(image.weight[i + lane] > 0)) continue;
      float* to = coefficients + kCoefficients * (static_cast<std::size_t>(x) + lane);
      for (std::size_t k = 0; k < kCoefficients; ++k) to[k] = fitted[k * lanes + lane];
    }
  }
}

void FitRow(const SurfaceImage& image, const RegressionWindow& window, int y, float* coefficients) {
  Fit<kSurfaceFeatures, kHalvesChannels>(image, window, y, coefficients);
}
void MeanRow(const SurfaceImage& image, const RegressionWindow& window, int y, float* means) {
  Fit<1, 2 * kHalvesChannels>(image, window, y, means);
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::render {

HWY_EXPORT(FitRow);
HWY_EXPORT(MeanRow);

SurfaceImage::SurfaceImage(int w, int h, std::size_t channels)
    : width(w),
      height(h),
      stride((static_cast<std::size_t>(w) + kLanes - 1) / kLanes * kLanes + 2 * kBorder + kLanes),
      value(channels) {
  constexpr std::size_t kOthers = 10;
  const std::size_t rows = static_cast<std::size_t>(h) + 2 * kBorder, size = stride * rows;
  planes_ = UnsetArray<float>((kOthers + channels) * size);
  parallel_each((kOthers + channels) * rows, 64,
                [&](std::size_t row) { std::fill_n(planes_.data() + row * stride, stride, 0.0F); });
  float* next = planes_.data();
  const auto place = [&](float*& plane) { plane = next, next += size; };
  place(weight), place(part);
  std::ranges::for_each(shift, place), std::ranges::for_each(normal, place), std::ranges::for_each(position, place);
  std::ranges::for_each(value, place);
}

void fit_row(const SurfaceImage& image, const RegressionWindow& window, int y, float* coefficients) {
  HWY_DYNAMIC_DISPATCH(FitRow)(image, window, y, coefficients);
}
void mean_row(const SurfaceImage& image, const RegressionWindow& window, int y, float* means) {
  HWY_DYNAMIC_DISPATCH(MeanRow)(image, window, y, means);
}

}  // namespace goniochrome::render
#endif
