// Lamps for many points side by side. The kernels include this file once for each instruction set.
#if defined(GONIOCHROME_RENDER_LAMPS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIOCHROME_RENDER_LAMPS_INL_H_
#undef GONIOCHROME_RENDER_LAMPS_INL_H_
#else
#define GONIOCHROME_RENDER_LAMPS_INL_H_
#endif

#include "render/cpu/cube_lookup-inl.h"
#include "render/internal/placed_lamps.h"

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

// A lamp as it is seen from a number of points: where it is, unit; its light relative to that of the scene; and the
// distance squared, no less than that within which it grows no brighter.
struct LampSeen {
  HWY_ALIGN float x[kPointsAtOnce], y[kPointsAtOnce], z[kPointsAtOnce];
  HWY_ALIGN float strength[kPointsAtOnce];
  HWY_ALIGN float distance2[kPointsAtOnce];

  HWY_INLINE Direction toward(std::size_t i) const { return loaded(x, y, z, i); }
};

// Light as light_at() has it. `direction` is that of a lamp that is far away; `placed` may be null. `points` has px,
// py, pz; the first `count` of them are seen, with those that fill the last vector.
template <class Points>
HWY_INLINE void see_lamp(const float* direction, const PlacedLamp* placed, const Points& points, int count,
                         LampSeen& seen) {
  const D f;
  const bool far = placed == nullptr || placed->reach2 == 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
    if (far) {
      store({hn::Set(f, direction[0]), hn::Set(f, direction[1]), hn::Set(f, direction[2])}, seen.x, seen.y, seen.z, i);
      hn::Store(hn::Set(f, 1.0F), f, seen.strength + i), hn::Store(hn::Set(f, 1.0F), f, seen.distance2 + i);
      continue;
    }
    const auto& at = placed->position;
    const Direction to =
        minus({hn::Set(f, at[0]), hn::Set(f, at[1]), hn::Set(f, at[2])}, loaded(points.px, points.py, points.pz, i));
    const V squared = dot(to, to), unit = hn::Div(hn::Set(f, 1.0F), hn::Sqrt(hn::Max(squared, hn::Set(f, 1e-30F))));
    store(scaled(unit, to), seen.x, seen.y, seen.z, i);
    const V distance2 = hn::Max(squared, hn::Set(f, placed->least2));
    hn::Store(distance2, f, seen.distance2 + i);
    hn::Store(hn::Div(hn::Set(f, placed->reach2), distance2), f, seen.strength + i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#endif  // GONIOCHROME_RENDER_LAMPS_INL_H_
