#include "render/path/transport_kernel.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/path/transport_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
// Shades as many points from `first` on as D has lanes.
template <class D>
HWY_INLINE void Shade(D d, const TransportPoints& points, const TransportWeights& w, std::size_t first, float* rgb) {
  using V = hn::Vec<D>;
  V factor[3] = {}, sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
  if (points.bounced != nullptr && w.classes == 0) {
    for (std::size_t c = 0; c < 3; ++c) factor[c] = hn::Set(d, w.factors[c]);
  } else if (points.bounced != nullptr) {
    // The mean factor of the classes by what each shows; 1 where nothing is shown.
    V all[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)}, weighted[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t k = 0; k < w.classes; ++k) {
      V shown[3];
      hn::LoadInterleaved3(d, points.classes[k] + 3 * first, shown[0], shown[1], shown[2]);
      for (std::size_t c = 0; c < 3; ++c) {
        all[c] = hn::Add(all[c], shown[c]);
        weighted[c] = hn::MulAdd(hn::Set(d, w.factors[3 * k + c]), shown[c], weighted[c]);
      }
    }
    for (std::size_t c = 0; c < 3; ++c) {
      const auto lit = hn::Gt(all[c], hn::Zero(d));
      factor[c] =
          hn::IfThenElse(lit, hn::Div(weighted[c], hn::IfThenElse(lit, all[c], hn::Set(d, 1.0F))), hn::Set(d, 1.0F));
      factor[c] = hn::Max(factor[c], hn::Zero(d));
    }
  }
  for (std::size_t k = 0; k < w.columns; ++k) {
    if (w.dark[k] != 0) continue;
    V light[3], bounced[3];
    hn::LoadInterleaved3(d, points.direct[k] + 3 * first, light[0], light[1], light[2]);
    if (points.bounced != nullptr) {
      hn::LoadInterleaved3(d, points.bounced[k] + 3 * first, bounced[0], bounced[1], bounced[2]);
      for (std::size_t c = 0; c < 3; ++c) light[c] = hn::MulAdd(factor[c], bounced[c], light[c]);
    }
    const float* m = w.matrices + 9 * k;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t e = 0; e < 3; ++e) sum[c] = hn::MulAdd(hn::Set(d, m[3 * c + e]), light[e], sum[c]);
  }
  hn::StoreInterleaved3(sum[0], sum[1], sum[2], d, rgb + 3 * first);
}

// Fewer points than a vector has lanes take shorter ones. Else the last vector begins within the one before it.
template <std::size_t kLanes>
HWY_INLINE void ShadeAll(const TransportPoints& points, const TransportWeights& w, float* rgb) {
  const hn::CappedTag<float, kLanes> d;
  const std::size_t lanes = hn::Lanes(d);
  if constexpr (kLanes > 1)
    if (points.count < lanes) return ShadeAll<kLanes / 4>(points, w, rgb);
  for (std::size_t i = 0; i < points.count; i += lanes) Shade(d, points, w, std::min(i, points.count - lanes), rgb);
}

void ShadeTransport(const TransportPoints& points, const TransportWeights& w, float* rgb) {
  ShadeAll<16>(points, w, rgb);
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::render {

HWY_EXPORT(ShadeTransport);

void shade_transport(const TransportPoints& points, const TransportWeights& weights, float* rgb) {
  HWY_DYNAMIC_DISPATCH(ShadeTransport)(points, weights, rgb);
}

}  // namespace goniochrome::render
#endif
