#include "render/path/ground_kernel.h"

#include "brdf/lobe_model.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/path/ground_kernel.cpp"
#include <hwy/foreach_target.h>

#include "render/cpu/cube_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

HWY_INLINE Direction same(const rays::Float3& a) {
  const D f;
  return {hn::Set(f, a.x), hn::Set(f, a.y), hn::Set(f, a.z)};
}
HWY_INLINE Direction loaded(const Places& from, std::size_t i) {
  return loaded(from[0].data(), from[1].data(), from[2].data(), i);
}
HWY_INLINE rays::Float3 sum(const Direction& a) {
  const D f;
  const auto lanes = [&](V v) HWY_ATTR { return hn::GetLane(hn::SumOfLanes(f, v)); };
  return {lanes(a.x), lanes(a.y), lanes(a.z)};
}

struct Point {
  Direction normal, to_viewer, mirrored;
};
struct Columns {
  Direction diffuse, flakes[GroundReceiver::kMostLobes], gloss[GroundReceiver::kMostLobes];
};

// The logarithm of a power of which a lobe shows nothing: 1e-7.
constexpr float kDarkest = -16.1F;
// Parts are summed in place of blocks in tiles with a block that is seen larger than this, or with this cosine to the
// mirror direction. In a test 95 of 100 points are within .8 % then, and within 6 % by whole blocks.
constexpr float kLargest_sr = 0.05F, kInLobes = 0.9F;

// Adds the light that comes along these directions.
HWY_INLINE void Gather(const GroundReceiver& receiver, const Point& point, const Direction& direction,
                       const Direction& light, Columns& sums) {
  const D d;
  const V one = hn::Set(d, 1.0F), cosine = dot(point.normal, direction);
  const auto above = hn::Gt(cosine, hn::Zero(d));
  if (hn::AllFalse(d, above)) return;
  V base = hn::IfThenElseZero(above, cosine);
  if (receiver.coat_index > 1)
    base = hn::Mul(base, hn::Sub(one, fresnel_of(base, receiver.coat_index * receiver.coat_index)));
  sums.diffuse = mul_add(base, light, sums.diffuse);
  if (receiver.lobes == 0) return;
  const V toward = hn::Min(dot(point.mirrored, direction), one), least = hn::Set(d, 1e-6F);
  const auto in_lobe = hn::And(above, hn::Gt(toward, least));
  if (hn::AllFalse(d, in_lobe)) return;
  const V log = hn::Log(d, hn::Max(toward, least));
  // |l + v|^2 / 4 = (1 + l v) / 2
  const V half = hn::Set(d, 0.5F), cos_half2 = hn::MulAdd(half, dot(point.to_viewer, direction), half);
  constexpr auto kCoat2 = static_cast<float>(brdf::kCoatIndex * brdf::kCoatIndex);
  const V fresnel = fresnel_of(hn::Sqrt(hn::Min(hn::Max(cos_half2, hn::Zero(d)), one)), kCoat2);
  for (std::size_t j = 0; j < receiver.lobes; ++j) {
    const V exponent = hn::Mul(hn::Set(d, receiver.exponents[j]), log);
    const auto seen = hn::And(in_lobe, hn::Gt(exponent, hn::Set(d, kDarkest)));
    if (hn::AllFalse(d, seen)) continue;
    const V power = hn::IfThenElseZero(seen, hn::Exp(d, exponent));
    sums.flakes[j] = mul_add(hn::Mul(power, base), light, sums.flakes[j]);
    sums.gloss[j] = mul_add(hn::Mul(power, fresnel), light, sums.gloss[j]);
  }
}

// Blocks of floor as a point sees them.
struct SeenBlocks {
  Direction direction;
  V extent_sr;  // for each unit of area
};
HWY_INLINE SeenBlocks Seen(const Direction& from, const FloorBlocks& blocks, std::size_t i) {
  const D d;
  const Direction way = minus(loaded(blocks.place, i), from);
  const V inverse2 = hn::Div(hn::Set(d, 1.0F), dot(way, way));
  const Direction direction = scaled(hn::Sqrt(inverse2), way);
  // The floor's own cosine, seen from above.
  return {direction, hn::Mul(hn::Max(hn::Neg(direction.y), hn::Zero(d)), inverse2)};
}

GroundColumns SumGround(const GroundBlocks& blocks, const GroundReceiver& receiver) {
  const D d;
  constexpr std::size_t kTile = GroundBlocks::kTile, kParts = GroundBlocks::kParts;
  const Point point{same(receiver.normal), same(receiver.to_viewer), same(receiver.mirrored)};
  const Direction from = same(receiver.position);
  const Direction none = same({});
  Columns sums;
  sums.diffuse = none;
  for (std::size_t j = 0; j < receiver.lobes; ++j) sums.flakes[j] = sums.gloss[j] = none;
  for (std::size_t tile = 0; tile < blocks.area.size(); tile += kTile) {
    bool is_near = false;
    for (std::size_t i = tile; i < tile + kTile; i += hn::Lanes(d)) {
      const SeenBlocks seen = Seen(from, blocks.whole, i);
      const V seen_sr = hn::Mul(seen.extent_sr, hn::LoadU(d, &blocks.area[i]));
      const auto large = hn::Gt(seen_sr, hn::Set(d, kLargest_sr)),
                 in_lobes = hn::Gt(dot(point.mirrored, seen.direction), hn::Set(d, kInLobes));
      is_near = is_near || !hn::AllFalse(d, large) || (receiver.lobes > 0 && !hn::AllFalse(d, in_lobes));
    }
    const FloorBlocks& taken = is_near ? blocks.parts : blocks.whole;
    const std::size_t parts = is_near ? kParts : 1;
    for (std::size_t i = parts * tile; i < parts * (tile + kTile); i += hn::Lanes(d)) {
      const SeenBlocks seen = Seen(from, taken, i);
      Gather(receiver, point, seen.direction, scaled(seen.extent_sr, loaded(taken.sent, i)), sums);
      Gather(receiver, point, loaded(taken.toward, i), scaled(hn::Set(d, -1.0F), loaded(taken.hidden, i)), sums);
    }
  }
  GroundColumns columns;
  columns.diffuse = sum(sums.diffuse);
  for (std::size_t j = 0; j < receiver.lobes; ++j)
    columns.flakes[j] = sum(sums.flakes[j]), columns.gloss[j] = sum(sums.gloss[j]);
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

}  // namespace goniochrome::render
#endif
