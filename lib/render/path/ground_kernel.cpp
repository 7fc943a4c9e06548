#include "render/path/ground_kernel.h"

#include "brdf/lobe_model.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/path/ground_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, GroundBlocks::kLanes>;
using V = hn::Vec<D>;

struct V3 {
  V x, y, z;
};

HWY_INLINE V3 Same(const rays::Float3& a) {
  const D d;
  return {hn::Set(d, a.x), hn::Set(d, a.y), hn::Set(d, a.z)};
}
HWY_INLINE V3 Load(const GroundBlocks::Places& from, std::size_t i) {
  const D d;
  return {hn::LoadU(d, &from[0][i]), hn::LoadU(d, &from[1][i]), hn::LoadU(d, &from[2][i])};
}
HWY_INLINE V Dot(const V3& a, const V3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
HWY_INLINE V3 Times(V s, const V3& a) {
  return {hn::Mul(s, a.x), hn::Mul(s, a.y), hn::Mul(s, a.z)};
}
HWY_INLINE void Add(V s, const V3& a, V3& sum) {
  sum = {hn::MulAdd(s, a.x, sum.x), hn::MulAdd(s, a.y, sum.y), hn::MulAdd(s, a.z, sum.z)};
}
HWY_INLINE rays::Float3 Sum(const V3& a) {
  const D d;
  return {hn::GetLane(hn::SumOfLanes(d, a.x)), hn::GetLane(hn::SumOfLanes(d, a.y)),
          hn::GetLane(hn::SumOfLanes(d, a.z))};
}

// Fresnel reflectance of a dielectric of this squared index for unpolarized light.
HWY_INLINE V Fresnel(V cosine, float n2) {
  const D d;
  const V one = hn::Set(d, 1.0F), contrast = hn::Set(d, n2 - 1), c2 = hn::Mul(cosine, cosine);
  const V g = hn::Sqrt(hn::Add(contrast, c2));
  const V s = hn::Add(cosine, g), p = hn::MulAdd(hn::Set(d, n2), cosine, g);
  const V r_s = hn::Div(contrast, hn::Mul(s, s));
  const V r_p = hn::Div(hn::Mul(contrast, hn::MulSub(hn::Set(d, n2 + 1), c2, one)), hn::Mul(p, p));
  return hn::Mul(hn::Set(d, 0.5F), hn::MulAdd(r_s, r_s, hn::Mul(r_p, r_p)));
}

struct Point {
  V3 normal, to_viewer, mirrored;
};
struct Columns {
  V3 diffuse, flakes[GroundReceiver::kMostLobes], gloss[GroundReceiver::kMostLobes];
};

// Adds the light that comes along these directions.
HWY_INLINE void Gather(const GroundReceiver& receiver, const Point& point, const V3& direction, const V3& light,
                       Columns& sums) {
  const D d;
  const V one = hn::Set(d, 1.0F), cosine = Dot(point.normal, direction);
  const auto above = hn::Gt(cosine, hn::Zero(d));
  if (hn::AllFalse(d, above)) return;
  V base = hn::IfThenElseZero(above, cosine);
  if (receiver.coat_index > 1)
    base = hn::Mul(base, hn::Sub(one, Fresnel(base, receiver.coat_index * receiver.coat_index)));
  Add(base, light, sums.diffuse);
  if (receiver.lobes == 0) return;
  const V toward = hn::Min(Dot(point.mirrored, direction), one);
  const auto in_lobe = hn::And(above, hn::Gt(toward, hn::Set(d, 1e-6F)));
  if (hn::AllFalse(d, in_lobe)) return;
  const V log = hn::Log(d, hn::Max(toward, hn::Set(d, 1e-6F)));
  // |l + v|^2 = 2 + 2 l v
  const V half = hn::Mul(
      hn::Set(d, 0.5F),
      hn::Sqrt(hn::Max(hn::Zero(d), hn::MulAdd(hn::Set(d, 2.0F), Dot(point.to_viewer, direction), hn::Set(d, 2.0F)))));
  constexpr auto kN2 = static_cast<float>(brdf::kCoatIndex * brdf::kCoatIndex);
  const V fresnel = Fresnel(hn::Min(half, one), kN2);
  for (std::size_t j = 0; j < receiver.lobes; ++j) {
    const V power = hn::IfThenElseZero(
        in_lobe, hn::Exp(d, hn::Max(hn::Mul(hn::Set(d, receiver.exponents[j]), log), hn::Set(d, -80.0F))));
    Add(hn::Mul(power, base), light, sums.flakes[j]);
    Add(hn::Mul(power, fresnel), light, sums.gloss[j]);
  }
}

GroundColumns SumGround(const GroundBlocks& blocks, const GroundReceiver& receiver) {
  const D d;
  const Point point{Same(receiver.normal), Same(receiver.to_viewer), Same(receiver.mirrored)};
  const V3 from = Same(receiver.position);
  const V3 none = Same({});
  Columns sums;
  sums.diffuse = none;
  for (std::size_t j = 0; j < receiver.lobes; ++j) sums.flakes[j] = sums.gloss[j] = none;
  for (std::size_t i = 0; i < blocks.place[0].size(); i += hn::Lanes(d)) {
    const V3 place = Load(blocks.place, i);
    const V3 way{hn::Sub(place.x, from.x), hn::Sub(place.y, from.y), hn::Sub(place.z, from.z)};
    const V inverse2 = hn::Div(hn::Set(d, 1.0F), Dot(way, way)), inverse = hn::Sqrt(inverse2);
    const V3 direction = Times(inverse, way);
    // The floor's own cosine, seen from above.
    const V extent = hn::Mul(hn::Max(hn::Neg(direction.y), hn::Zero(d)), inverse2);
    Gather(receiver, point, direction, Times(extent, Load(blocks.sent, i)), sums);
    const V3 hidden = Load(blocks.hidden, i);
    Gather(receiver, point, Load(blocks.toward, i), {hn::Neg(hidden.x), hn::Neg(hidden.y), hn::Neg(hidden.z)}, sums);
  }
  GroundColumns columns;
  columns.diffuse = Sum(sums.diffuse);
  for (std::size_t j = 0; j < receiver.lobes; ++j)
    columns.flakes[j] = Sum(sums.flakes[j]), columns.gloss[j] = Sum(sums.gloss[j]);
  return columns;
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::render {

HWY_EXPORT(SumGround);

GroundColumns sum_ground(const GroundBlocks& blocks, const GroundReceiver& point) {
  return HWY_DYNAMIC_DISPATCH(SumGround)(blocks, point);
}

namespace {

void push(const rays::Float3& a, GroundBlocks::Places& to) {
  to[0].push_back(a.x), to[1].push_back(a.y), to[2].push_back(a.z);
}

}  // namespace

void GroundBlocks::add(const rays::Float3& at, const rays::Float3& light, const rays::Float3& direction,
                       const rays::Float3& behind) {
  push(at, place), push(light, sent), push(direction, toward), push(behind, hidden);
}

void GroundBlocks::fill() {
  while (place[0].size() % kLanes != 0) add({0, -1e6F, 0}, {}, {0, -1, 0}, {});
}

}  // namespace goniochrome::render
#endif
