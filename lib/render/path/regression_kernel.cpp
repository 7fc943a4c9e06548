#include "render/path/regression_kernel.h"

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

constexpr std::size_t kProducts = kSurfaceFeatures * (kSurfaceFeatures + 1) / 2;
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
HWY_INLINE void Solve(float of_weight, V* m, V* r) {
  const D d;
  const V tiny = hn::Set(d, 1e-20F);
  const V ridge = hn::Mul(hn::Set(d, of_weight), m[0]);
  for (std::size_t k = 1; k < kSurfaceFeatures; ++k) m[product(k, k)] = hn::Add(m[product(k, k)], ridge);
  V inverse[kSurfaceFeatures];
  for (std::size_t k = 0; k < kSurfaceFeatures; ++k) {
    for (std::size_t l = 0; l <= k; ++l) {
      V sum = m[product(k, l)];
      for (std::size_t j = 0; j < l; ++j) sum = hn::NegMulAdd(m[product(k, j)], m[product(l, j)], sum);
      m[product(k, l)] = l < k ? hn::Mul(sum, inverse[l]) : hn::Sqrt(hn::Max(sum, tiny));
    }
    inverse[k] = hn::Div(hn::Set(d, 1.0F), m[product(k, k)]);
  }
  for (std::size_t c = 0; c < kHalvesChannels; ++c) {
    for (std::size_t k = 0; k < kSurfaceFeatures; ++k) {
      V sum = r[k * kHalvesChannels + c];
      for (std::size_t j = 0; j < k; ++j) sum = hn::NegMulAdd(m[product(k, j)], r[j * kHalvesChannels + c], sum);
      r[k * kHalvesChannels + c] = hn::Mul(sum, inverse[k]);
    }
    for (std::size_t k = kSurfaceFeatures; k-- > 0;) {
      V sum = r[k * kHalvesChannels + c];
      for (std::size_t j = k + 1; j < kSurfaceFeatures; ++j)
        sum = hn::NegMulAdd(m[product(j, k)], r[j * kHalvesChannels + c], sum);
      r[k * kHalvesChannels + c] = hn::Mul(sum, inverse[k]);
    }
  }
}

void FitRow(const SurfaceImage& image, const RegressionWindow& window, int y, float* const* coefficients) {
  const D d;
  const V one = hn::Set(d, 1.0F), zero = hn::Zero(d);
  const float scale = 1.0F / (static_cast<float>(window.reach) + 0.5F);
  const V per_reach = hn::Set(d, scale), per_normal = hn::Set(d, 1 / window.normal),
          per_plane = hn::Set(d, 1 / (window.plane * window.plane));
  for (int x = 0; x < image.width; x += static_cast<int>(hn::Lanes(d))) {
    const std::size_t i = image.at(x, y);
    const V own = hn::LoadU(d, &image.weight[i]);
    V m[kProducts], r[kSurfaceFeatures * kHalvesChannels];
    for (V& v : m) v = zero;
    for (V& v : r) v = zero;
    if (!hn::AllFalse(d, hn::Gt(own, zero))) {
      Frame f;
      for (std::size_t k = 0; k < 3; ++k)
        f.normal[k] = hn::LoadU(d, &image.normal[k][i]), f.position[k] = hn::LoadU(d, &image.position[k][i]);
      for (std::size_t k = 0; k < 2; ++k) f.shift[k] = hn::LoadU(d, &image.shift[k][i]);
      f.part = hn::LoadU(d, &image.part[i]);
      SetTangents(f);
      for (int v = -window.reach; v <= window.reach; ++v) {
        for (int u = -window.reach; u <= window.reach; ++u) {
          const std::size_t j = i + static_cast<std::size_t>(v * static_cast<std::ptrdiff_t>(image.stride) + u);
          V weight = hn::LoadU(d, &image.weight[j]);
          const auto same = hn::And(hn::Gt(weight, zero), hn::Eq(hn::LoadU(d, &image.part[j]), f.part));
          if (hn::AllFalse(d, same)) continue;
          V turned[3], way[3];
          for (std::size_t k = 0; k < 3; ++k) {
            turned[k] = hn::Sub(hn::LoadU(d, &image.normal[k][j]), f.normal[k]);
            way[k] = hn::Sub(hn::LoadU(d, &image.position[k][j]), f.position[k]);
          }
          const V right = hn::Mul(per_reach, hn::Add(hn::Set(d, static_cast<float>(u)),
                                                     hn::Sub(hn::LoadU(d, &image.shift[0][j]), f.shift[0])));
          const V down = hn::Mul(per_reach, hn::Add(hn::Set(d, static_cast<float>(v)),
                                                    hn::Sub(hn::LoadU(d, &image.shift[1][j]), f.shift[1])));
          const V off = Dot(way, f.normal), length = hn::Add(Dot(way, way), hn::Set(d, 1e-20F));
          V far = hn::MulAdd(right, right, hn::Mul(down, down));
          far = hn::MulAdd(hn::Mul(per_normal, per_normal), Dot(turned, turned), far);
          far = hn::MulAdd(per_plane, hn::Div(hn::Mul(off, off), length), far);
          const V near = hn::Max(zero, hn::Sub(one, far));
          weight = hn::IfThenElseZero(same, hn::Mul(weight, hn::Mul(near, near)));
          V feature[kSurfaceFeatures] = {one, right, down, hn::Mul(per_normal, Dot(turned, f.first)),
                                         hn::Mul(per_normal, Dot(turned, f.second))};
          V value[kHalvesChannels];
          for (std::size_t c = 0; c < kHalvesChannels; ++c) value[c] = hn::LoadU(d, &image.value[c][j]);
          for (std::size_t k = 0; k < kSurfaceFeatures; ++k) {
            const V weighed = hn::Mul(weight, feature[k]);
            for (std::size_t l = 0; l <= k; ++l) m[product(k, l)] = hn::MulAdd(weighed, feature[l], m[product(k, l)]);
            for (std::size_t c = 0; c < kHalvesChannels; ++c)
              r[k * kHalvesChannels + c] = hn::MulAdd(weighed, value[c], r[k * kHalvesChannels + c]);
          }
        }
      }
      Solve(window.ridge, m, r);
    }
    for (std::size_t k = 0; k < kSurfaceFeatures * kHalvesChannels; ++k) hn::StoreU(r[k], d, coefficients[k] + x);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::render {

HWY_EXPORT(FitRow);

SurfaceImage::SurfaceImage(int w, int h)
    : width(w), height(h), stride((static_cast<std::size_t>(w) + kLanes - 1) / kLanes * kLanes + 2 * kBorder + kLanes) {
  const std::size_t size = stride * (static_cast<std::size_t>(h) + 2 * kBorder);
  weight.assign(size, 0), part.assign(size, -1);
  for (auto& plane : shift) plane.assign(size, 0);
  for (auto& plane : normal) plane.assign(size, 0);
  for (auto& plane : position) plane.assign(size, 0);
  for (auto& plane : value) plane.assign(size, 0);
}

void fit_row(const SurfaceImage& image, const RegressionWindow& window, int y, float* const* coefficients) {
  HWY_DYNAMIC_DISPATCH(FitRow)(image, window, y, coefficients);
}

}  // namespace goniochrome::render
#endif
