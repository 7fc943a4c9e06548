#include "render/path/transport_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/path/transport_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, kTransportLanes>;
using V = hn::Vec<D>;
using H = hn::Rebind<hwy::float16_t, D>;

HWY_INLINE V load(const std::uint16_t* from) {
  return hn::PromoteTo(D(), hn::LoadU(H(), reinterpret_cast<const hwy::float16_t*>(from)));
}

void ShadeTransport(const TransportBlock& block, const TransportWeights& w, float* rgb) {
  const D d;
  const std::uint16_t *direct = block.direct, *bounced = block.bounced, *classes = block.classes;
  for (std::size_t i = 0; i < kTransportLanes; i += hn::Lanes(d)) {
    V factor[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    if (bounced != nullptr) {
      // The mean factor of the classes by what each shows; 1 where nothing is shown.
      for (std::size_t c = 0; c < 3; ++c) {
        V all = hn::Zero(d), weighted = hn::Zero(d);
        for (std::size_t k = 0; k < w.classes; ++k) {
          const V shown = load(classes + (3 * k + c) * kTransportLanes + i);
          all = hn::Add(all, shown);
          weighted = hn::MulAdd(hn::Set(d, w.factors[3 * k + c]), shown, weighted);
        }
        const auto lit = hn::Gt(all, hn::Zero(d));
        factor[c] =
            hn::IfThenElse(lit, hn::Div(weighted, hn::IfThenElse(lit, all, hn::Set(d, 1.0F))), hn::Set(d, 1.0F));
        factor[c] = hn::Max(factor[c], hn::Zero(d));
      }
    }
    V sum[3] = {hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    for (std::size_t k = 0; k < w.columns; ++k) {
      if (w.dark[k] != 0) continue;
      V light[3];
      for (std::size_t c = 0; c < 3; ++c) {
        light[c] = load(direct + (3 * k + c) * kTransportLanes + i);
        if (bounced != nullptr)
          light[c] = hn::MulAdd(factor[c], load(bounced + (3 * k + c) * kTransportLanes + i), light[c]);
      }
      const float* m = w.matrices + 9 * k;
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t e = 0; e < 3; ++e) sum[c] = hn::MulAdd(hn::Set(d, m[3 * c + e]), light[e], sum[c]);
    }
    for (std::size_t c = 0; c < 3; ++c) hn::StoreU(sum[c], d, rgb + c * kTransportLanes + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::render {

HWY_EXPORT(ShadeTransport);

void shade_transport(const TransportBlock& block, const TransportWeights& weights, float* rgb) {
  HWY_DYNAMIC_DISPATCH(ShadeTransport)(block, weights, rgb);
}

}  // namespace goniochrome::render
#endif
