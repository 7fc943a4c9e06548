#include "render/textures/sbrdf_kernel.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/textures/sbrdf_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h:
#include "render/cpu/cube_lookup-inl.h"
#include "render/cpu/lamps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

// The frames of all points, and the viewer in them.
struct SurfaceFrames {
  HWY_ALIGN float tx[kPointsAtOnce], ty[kPointsAtOnce], tz[kPointsAtOnce];
  HWY_ALIGN float bx[kPointsAtOnce], by[kPointsAtOnce], bz[kPointsAtOnce];
  HWY_ALIGN float vt[kPointsAtOnce], vb[kPointsAtOnce], vn[kPointsAtOnce];
};

HWY_INLINE Direction cross_product(const Direction& a, const Direction& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}

// The tangent made perpendicular to the normal and unit. One along the normal says nothing: any direction in the
// surface will do.
HWY_INLINE Direction level_tangent(const Direction& n, const Direction& t) {
  const D f;
  const auto level = [&](const Direction& d) HWY_ATTR { return mul_add(hn::Neg(dot(d, n)), n, d); };
  const V zero = hn::Zero(f), one = hn::Set(f, 1.0F);
  const auto on_x = hn::Lt(hn::Abs(n.x), hn::Set(f, 0.7F));
  const Direction other = level({hn::IfThenElse(on_x, one, zero), hn::IfThenElse(on_x, zero, one), zero});
  Direction x = level(t);
  const auto none = hn::Lt(dot(x, x), hn::Set(f, 1e-12F));
  x = {hn::IfThenElse(none, other.x, x.x), hn::IfThenElse(none, other.y, x.y), hn::IfThenElse(none, other.z, x.z)};
  return scaled(hn::Div(one, hn::Sqrt(dot(x, x))), x);
}

HWY_INLINE void set_up_frames(const SbrdfPoints& p, SurfaceFrames& frames) {
  const D f;
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    const Direction n = loaded(p.nx, p.ny, p.nz, i), toward = loaded(p.vx, p.vy, p.vz, i);
    const Direction v = scaled(hn::Div(hn::Set(f, 1.0F), hn::Sqrt(dot(toward, toward))), toward);
    const Direction t = level_tangent(n, loaded(p.tx, p.ty, p.tz, i)), b = cross_product(n, t);
    store(t, frames.tx, frames.ty, frames.tz, i), store(b, frames.bx, frames.by, frames.bz, i);
    hn::Store(dot(v, t), f, frames.vt + i), hn::Store(dot(v, b), f, frames.vb + i);
    hn::Store(dot(v, n), f, frames.vn + i);
  }
}

// A lamp in the frames of all points: its direction there, its light relative to that of the scene, and the variance of
// its disc.
struct LampInFrames {
  HWY_ALIGN float t[kPointsAtOnce], b[kPointsAtOnce], n[kPointsAtOnce];
  HWY_ALIGN float strength[kPointsAtOnce], variance[kPointsAtOnce];
};

HWY_INLINE void find_lamp(const SbrdfShading& s, int number, const SbrdfPoints& p, const SurfaceFrames& frames,
                          LampInFrames& lamp) {
  const D f;
  const float* light = s.light + 8 * number;
  const PlacedLamp* placed = s.placed != nullptr ? s.placed + number : nullptr;
  LampSeen seen;
  see_lamp(light, placed, p, kPointsAtOnce, seen);
  const bool sphere = placed != nullptr && placed->radius2 > 0;
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    const Direction to = seen.toward(i);
    hn::Store(dot(to, loaded(frames.tx, frames.ty, frames.tz, i)), f, lamp.t + i);
    hn::Store(dot(to, loaded(frames.bx, frames.by, frames.bz, i)), f, lamp.b + i);
    hn::Store(dot(to, loaded(p.nx, p.ny, p.nz, i)), f, lamp.n + i);
    hn::Store(hn::Load(f, seen.strength + i), f, lamp.strength + i);
    V variance = hn::Set(f, light[3]);
    if (sphere) {
      const V sine2 = hn::Div(hn::Set(f, placed->radius2), hn::Load(f, seen.distance2 + i)), one = hn::Set(f, 1.0F);
      const V radius = hn::Asin(f, hn::Sqrt(hn::Min(sine2, one)));
      variance = hn::Mul(hn::Set(f, 0.25F), hn::Mul(radius, radius));
    }
    hn::Store(variance, f, lamp.variance + i);
  }
}

// One lobe of each point, its values side by side.
struct LobeValues {
  HWY_ALIGN float cos_x[kPointsAtOnce], sin_x[kPointsAtOnce];  // of the lobe's frame
  HWY_ALIGN float ax[kPointsAtOnce], ay[kPointsAtOnce], az[kPointsAtOnce], exponent[kPointsAtOnce];
  HWY_ALIGN float energy[kPointsAtOnce], albedo[kPointsAtOnce];  // logarithms
  HWY_ALIGN float color[4 * kPointsAtOnce];                      // of all texels, times their shares
  const float* lobe[kPointsAtOnce];
};

// The sum of one color of these texels, times their shares: number 0 is the diffuse part, then come the lobes.
HWY_INLINE Quad color_of(const SbrdfShading& s, std::span<const TexelShare> texels, int number) {
  const float* from = s.colors + 4 * static_cast<std::size_t>(number);
  const std::size_t stride = 4 * (1 + static_cast<std::size_t>(s.lobes));
  Quad sum = Quad::filled(0);
  for (const TexelShare& one : texels)
    sum = mul_add(Quad::filled(one.share), Quad::load(from + stride * one.texel), sum);
  return sum;
}

HWY_INLINE void gather_lobe(const SbrdfShading& s, const SbrdfPoints& p, int lobe, int count, LobeValues& values) {
  const std::size_t at = kShapeFloats * static_cast<std::size_t>(lobe);
  for (int i = 0; i < kPointsAtOnce; ++i) {
    const float* l = p.shape[i] + at;
    values.cos_x[i] = l[kLobeTurn], values.sin_x[i] = l[kLobeTurn + 1];
    values.ax[i] = l[kLobeAxes], values.ay[i] = l[kLobeAxes + 1], values.az[i] = l[kLobeAxes + 2];
    values.exponent[i] = l[kLobeExponent];
    values.energy[i] = l[kLobeEnergy], values.albedo[i] = l[kLobeAlbedo];
    values.lobe[i] = l;
  }
  for (int i = 0; i < count; ++i) color_of(s, p.lobed[i], 1 + lobe).store(values.color + 4 * i);
}

// The middle of each lobe, p/|p| of p = C wo, in the texel's frame, and log |p|^n.
struct LobeMiddles {
  HWY_ALIGN float x[kPointsAtOnce], y[kPointsAtOnce], z[kPointsAtOnce];
  HWY_ALIGN float log_power[kPointsAtOnce];
  bool any[kPointsAtOnce];  // whether a lobe of the points from there on is lit and seen; else the others are not set
};

// |p|^2 - 1 is taken from the axes, (C^2 - 1) wo^2 summed, which is exact where a lobe mirrors.
HWY_INLINE void find_middles(const SurfaceFrames& frames, const float* lit, const LobeValues& l, LobeMiddles& middles) {
  const D f;
  const V one = hn::Set(f, 1.0F);
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    const auto there = hn::Gt(hn::Load(f, l.energy + i), hn::Set(f, kNoLobe));
    middles.any[i] = !hn::AllFalse(f, hn::And(there, hn::Gt(hn::Load(f, lit + i), hn::Zero(f))));
    if (!middles.any[i]) continue;
    const V c = hn::Load(f, l.cos_x + i), s = hn::Load(f, l.sin_x + i);
    const V vt = hn::Load(f, frames.vt + i), vb = hn::Load(f, frames.vb + i);
    const Direction v = {hn::MulAdd(c, vt, hn::Mul(s, vb)), hn::MulSub(c, vb, hn::Mul(s, vt)),
                         hn::Load(f, frames.vn + i)};
    const Direction axes = loaded(l.ax, l.ay, l.az, i);
    const Direction p = {hn::Mul(axes.x, v.x), hn::Mul(axes.y, v.y), hn::Mul(axes.z, v.z)};
    const auto beyond_one = [&](V axis, V cosine) HWY_ATTR {
      return hn::Mul(hn::Mul(hn::Sub(axis, one), hn::Add(axis, one)), hn::Mul(cosine, cosine));
    };
    const V excess = hn::Add(beyond_one(axes.x, v.x), hn::Add(beyond_one(axes.y, v.y), beyond_one(axes.z, v.z)));
    const V size2 = hn::Max(dot(p, p), hn::Set(f, 1e-30F)), half = hn::Set(f, 0.5F);
    const V log_size2 = log_beside_one(excess);
    store(scaled(hn::Div(one, hn::Sqrt(size2)), p), middles.x, middles.y, middles.z, i);
    hn::Store(hn::Mul(hn::Mul(half, hn::Load(f, l.exponent + i)), log_size2), f, middles.log_power + i);
  }
}

// exp, within what a float holds; 0 instead of numbers below the normal ones, which processors take long for.
HWY_INLINE V bounded_exp(V x) {
  const D f;
  const V least = hn::Set(f, -80.0F);
  return hn::IfThenElseZero(hn::Gt(x, least), hn::Exp(f, hn::Min(hn::Max(x, least), hn::Set(f, 87.0F))));
}

// The cosine of a lobe's middle, or the mean cosine of what lies above the surface and the shift of the direction.
struct Seen {
  float cosine, shift;
};
HWY_INLINE Seen seen_of(const SbrdfShading& s, const float* lobe, float cosine) {
  if (s.horizon == nullptr || !(cosine > 0)) return {cosine, 0};
  const float x = std::sqrt(std::min(cosine, 1.0F)) * static_cast<float>(s.horizon_segments);
  const int at = std::min(static_cast<int>(x), s.horizon_segments - 1);
  const float t = x - static_cast<float>(at), share = lobe[kLobeHorizon + 1];
  const std::size_t wide = 2 * static_cast<std::size_t>(s.horizon_segments + 1);
  const float* row = s.horizon + static_cast<std::size_t>(lobe[kLobeHorizon]) * wide + 2 * at;
  const float* next = share > 0 ? row + wide : row;
  const auto between = [&](int k) {
    return (1 - share) * ((1 - t) * row[k] + t * row[2 + k]) + share * ((1 - t) * next[k] + t * next[2 + k]);
  };
  return {between(0), between(1)};
}

// Adds what one lobe shows of the environment.
HWY_INLINE void add_filtered(const SbrdfShading& s, const SbrdfPoints& p, const SurfaceFrames& frames,
                             const LobeValues& l, const LobeMiddles& middles, int count, Products<4>* sums) {
  const D f;
  const hn::RebindToSigned<D> whole;
  HWY_ALIGN std::int32_t sizes[2][kPointsAtOnce];
  HWY_ALIGN float weight[kPointsAtOnce], cosine[kPointsAtOnce], shift[kPointsAtOnce];
  // 1. The cosine and shift that the horizon gives each lobe, and the sizes of the two maps around its exponent.
  for (int i = 0; i < kPointsAtOnce; ++i) {
    if (!middles.any[i - i % static_cast<int>(hn::Lanes(f))]) continue;
    const Seen seen = seen_of(s, l.lobe[i], middles.z[i]);
    cosine[i] = seen.cosine, shift[i] = seen.shift;
    const auto map = static_cast<std::size_t>(l.lobe[i][kLobeMap]);
    sizes[0][i] = s.maps[map].size;
    sizes[1][i] = l.lobe[i][kLobeMap + 1] > 0 ? s.maps[map + 1].size : sizes[0][i];
  }
  Taps taps[2];
  // 2. The middle of each lobe in the world, its addresses in both maps, and its weight.
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
    if (!middles.any[i]) {
      hn::Store(hn::Zero(f), f, weight + i);
      continue;
    }
    const V c = hn::Load(f, l.cos_x + i), q = hn::Load(f, l.sin_x + i);
    const Direction m = loaded(middles.x, middles.y, middles.z, i);
    const V along_t = hn::MulSub(c, m.x, hn::Mul(q, m.y)), along_b = hn::MulAdd(q, m.x, hn::Mul(c, m.y));
    const V along_n = hn::Add(m.z, hn::Load(f, shift + i));
    const auto turned = [&](const float* t, const float* b, const float* n) HWY_ATTR {
      return hn::MulAdd(along_t, hn::Load(f, t + i),
                        hn::MulAdd(along_b, hn::Load(f, b + i), hn::Mul(along_n, hn::LoadU(f, n + i))));
    };
    const OnFace face = on_face(
        {turned(frames.tx, frames.bx, p.nx), turned(frames.ty, frames.by, p.ny), turned(frames.tz, frames.bz, p.nz)});
    for (const int k : {0, 1}) address(face, hn::Load(whole, sizes[k] + i), i, taps[k]);
    const V power = bounded_exp(hn::Add(hn::Load(f, l.energy + i), hn::Load(f, middles.log_power + i)));
    const auto seen = hn::And(hn::Gt(m.z, hn::Zero(f)), hn::Gt(hn::Load(f, frames.vn + i), hn::Zero(f)));
    hn::Store(hn::IfThenElseZero(seen, hn::Mul(power, hn::Load(f, cosine + i))), f, weight + i);
  }
  // 3. Point by point, the light from both maps, blended, times the color of the lobe.
  for (int i = 0; i < count; ++i) {
    const float* lobe = l.lobe[i];
    const float w = weight[i];
    if (!(w > 0)) continue;
    const auto map = static_cast<std::size_t>(lobe[kLobeMap]);
    const float upper = lobe[kLobeMap + 1];
    Quad light = fetched(s.maps[map], taps[0], i);
    if (upper > 0) {
      light = mul_add(Quad::filled(1 - upper), light,
                      mul_add(Quad::filled(upper), fetched(s.maps[map + 1], taps[1], i), Quad::filled(0)));
    }
    sums[i].add(light, mul_add(Quad::filled(w), Quad::load(l.color + 4 * i), Quad::filled(0)));
  }
}

// Adds what one lobe sends of a light to the viewer: the exact BRDF. With m the middle of the lobe,
// (p.wi)^n = |p|^n (m.wi)^n, the second from 1 - m.wi = |m - wi|^2/2. The disc of a lamp is taken as a Gaussian of the
// same variance, which makes the lobe wider and lower by one factor.
HWY_INLINE void add_lit(const float* light, const LampInFrames& lamp, const SurfaceFrames& frames, const LobeValues& l,
                        const LobeMiddles& middles, int count, Products<4>* sums) {
  const D f;
  HWY_ALIGN float weight[kPointsAtOnce];
  const V zero = hn::Zero(f), half = hn::Set(f, 0.5F), one = hn::Set(f, 1.0F);
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    hn::Store(zero, f, weight + i);
    if (!middles.any[i]) continue;
    const V lt = hn::Load(f, lamp.t + i), lb = hn::Load(f, lamp.b + i), cos_i = hn::Load(f, lamp.n + i);
    const V c = hn::Load(f, l.cos_x + i), q = hn::Load(f, l.sin_x + i);
    const Direction m = loaded(middles.x, middles.y, middles.z, i);
    const Direction apart = minus(m, {hn::MulAdd(c, lt, hn::Mul(q, lb)), hn::MulSub(c, lb, hn::Mul(q, lt)), cos_i});
    const V versine = hn::Mul(half, dot(apart, apart));
    const auto seen =
        hn::And(hn::And(hn::Gt(cos_i, zero), hn::Gt(hn::Load(f, frames.vn + i), zero)), hn::Lt(versine, one));
    if (hn::AllFalse(f, seen)) continue;
    const V exponent = hn::Load(f, l.exponent + i);
    const V lowered = hn::Div(one, hn::MulAdd(exponent, hn::Load(f, lamp.variance + i), one));
    const V log_lobe =
        hn::MulAdd(hn::Mul(lowered, exponent), log_beside_one(hn::Neg(versine)), hn::Load(f, middles.log_power + i));
    const V power = hn::Mul(lowered, bounded_exp(hn::Add(log_lobe, hn::Load(f, l.albedo + i))));
    hn::Store(hn::IfThenElseZero(seen, hn::Mul(power, hn::Mul(cos_i, hn::Load(f, lamp.strength + i)))), f, weight + i);
  }
  for (int i = 0; i < count; ++i) {
    if (!(weight[i] > 0)) continue;
    sums[i].add(Quad::load(light + 4), mul_add(Quad::filled(weight[i]), Quad::load(l.color + 4 * i), Quad::filled(0)));
  }
}

// So many lamps are found at once: their directions stay in the first cache.
constexpr int kLampsAtOnce = 4;
struct Lamps {
  int first = 0, count = 0;
  LampInFrames seen[kLampsAtOnce];
};

// The diffuse part: the texels' colors blended, in the irradiance and in these lamps.
HWY_INLINE void add_diffuse(const SbrdfShading& s, const SbrdfPoints& p, const SurfaceFrames& frames,
                            bool with_environment, const Lamps& lamps, int count, Products<4>* sums) {
  const D f;
  Taps taps;
  if (with_environment) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f))
      address(loaded(p.nx, p.ny, p.nz, i), s.diffuse.size, i, taps);
  }
  for (int i = 0; i < count; ++i) {
    if (p.diffuse[i].empty() || !(frames.vn[i] > 0)) continue;
    const Quad color = color_of(s, p.diffuse[i], 0);
    Quad light = Quad::filled(0);
    if (with_environment) light = mul_add(Quad::filled(std::numbers::pi_v<float>), fetched(s.diffuse, taps, i), light);
    for (int k = 0; k < lamps.count; ++k) {
      const float cos_i = lamps.seen[k].n[i] * lamps.seen[k].strength[i];
      if (cos_i > 0) light = mul_add(Quad::filled(cos_i), Quad::load(s.light + 8 * (lamps.first + k) + 4), light);
    }
    sums[i].add(light, color);
  }
}

// Above 0 where a point shows lobes at all.
HWY_INLINE void find_lit(const SurfaceFrames& frames, bool with_environment, const Lamps& lamps, float* lit) {
  const D f;
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    V highest = hn::Set(f, with_environment ? 1.0F : 0.0F);
    for (int k = 0; k < lamps.count; ++k) highest = hn::Max(highest, hn::Load(f, lamps.seen[k].n + i));
    hn::Store(hn::Min(highest, hn::Load(f, frames.vn + i)), f, lit + i);
  }
}

// The diffuse part, and then each lobe under the environment and under the lights.
HWY_INLINE void add_all(const SbrdfShading& s, const SbrdfPoints& p, int count, Products<4>* sums) {
  SurfaceFrames frames;
  LobeValues values;
  LobeMiddles middles;
  Lamps lamps;
  HWY_ALIGN float lit[kPointsAtOnce];
  set_up_frames(p, frames);
  for (; lamps.first == 0 || lamps.first < s.lights; lamps.first += kLampsAtOnce) {
    const bool with_environment = s.diffuse.texels != nullptr && lamps.first == 0;
    lamps.count = std::min(kLampsAtOnce, s.lights - lamps.first);
    for (int k = 0; k < lamps.count; ++k) find_lamp(s, lamps.first + k, p, frames, lamps.seen[k]);
    add_diffuse(s, p, frames, with_environment, lamps, count, sums);
    find_lit(frames, with_environment, lamps, lit);
    for (int lobe = 0; lobe < s.lobes; ++lobe) {
      if ((s.lobes_on >> lobe & 1U) == 0) continue;
      gather_lobe(s, p, lobe, count, values);
      find_middles(frames, lit, values, middles);
      if (with_environment) add_filtered(s, p, frames, values, middles, count, sums);
      for (int k = 0; k < lamps.count; ++k)
        add_lit(s.light + 8 * (lamps.first + k), lamps.seen[k], frames, values, middles, count, sums);
    }
  }
}

void ShadeTexels(const SbrdfShading& s, const SbrdfPoints& p, int count, float* rgba) {
  Products<4> sums[kPointsAtOnce];
  add_all(s, p, count, sums);
  for (int i = 0; i < count; ++i) sums[i].on(Quad::filled(0), s.product).store(rgba + 4 * i);
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::render {

HWY_EXPORT(ShadeTexels);

void shade_texels(const SbrdfShading& shading, const SbrdfPoints& points, int count, float* rgba) {
  HWY_DYNAMIC_DISPATCH(ShadeTexels)(shading, points, count, rgba);
}

}  // namespace goniochrome::render
#endif
