#include "render/cpu/cpu_kernel.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/cpu/cpu_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h:
#include "brdf/lobe_model.h"
#include "render/cpu/cube_lookup-inl.h"
#include "render/cpu/lamps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

using Block = Pack<8>;  // one texel's block: two maps, R G B 0 each
HWY_INLINE Block load(const float* from) {
  return Block::load(from);
}
HWY_INLINE Block filled(float value) {
  return Block::filled(value);
}

// Four texels and the share of each.
struct Corners {
  const float *upper, *lower;
  std::size_t right;
  Block share[4];
};

// The four corners of point i, their shares times `scale`.
HWY_INLINE Corners corners_of(const InterleavedMaps& maps, const Taps& taps, int i, float scale = 1) {
  const std::size_t texel = static_cast<std::size_t>(maps.texel_floats);
  const float* upper = maps.texels + static_cast<std::size_t>(taps.offset[i]) * texel;
  const float u = taps.across[i], lower = scale * taps.down[i], upper_share = scale - lower;
  return {upper,
          upper + static_cast<std::size_t>(maps.size + 2) * texel,
          texel,
          {filled((1 - u) * upper_share), filled(u * upper_share), filled((1 - u) * lower), filled(u * lower)}};
}

// Adds one block of a texel, between the four, to `sum`.
HWY_INLINE Block add_between(const Corners& c, std::size_t at, const Block& sum) {
  const Block upper = mul_add(c.share[0], load(c.upper + at), mul_add(c.share[1], load(c.upper + c.right + at), sum));
  return mul_add(c.share[2], load(c.lower + at), mul_add(c.share[3], load(c.lower + c.right + at), upper));
}

// The view of every point, and where its weights are.
struct Frame {
  HWY_ALIGN float cos_o[kPointsAtOnce];
  HWY_ALIGN float rx[kPointsAtOnce], ry[kPointsAtOnce], rz[kPointsAtOnce];
  HWY_ALIGN float t[kPointsAtOnce];
  HWY_ALIGN std::int32_t segment[kPointsAtOnce];

  Direction r(std::size_t i) const {
    const D f;
    return {hn::Load(f, rx + i), hn::Load(f, ry + i), hn::Load(f, rz + i)};
  }
  const float* weights(const CpuShading& s, const PointArrays& points, int i) const {
    return s.weights + static_cast<std::size_t>(points.part[i] * s.segments + segment[i]) * s.segment_floats;
  }
};

HWY_INLINE Direction normal_of(const PointArrays& p, std::size_t i) {
  const D f;
  return {hn::LoadU(f, p.nx + i), hn::LoadU(f, p.ny + i), hn::LoadU(f, p.nz + i)};
}
HWY_INLINE Direction viewer_of(const PointArrays& p, std::size_t i) {
  const D f;
  return {hn::LoadU(f, p.vx + i), hn::LoadU(f, p.vy + i), hn::LoadU(f, p.vz + i)};
}

// Makes the directions to the viewer unit, mirrors them, and finds the segments of the weights.
HWY_INLINE void set_up(const CpuShading& s, PointArrays& points, Frame& frame) {
  const D f;
  const hn::RebindToSigned<D> whole;
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    Direction v = viewer_of(points, i);
    const V scale = hn::Div(hn::Set(f, 1.0F), hn::Sqrt(dot(v, v)));
    v = {hn::Mul(v.x, scale), hn::Mul(v.y, scale), hn::Mul(v.z, scale)};
    hn::StoreU(v.x, f, points.vx + i), hn::StoreU(v.y, f, points.vy + i), hn::StoreU(v.z, f, points.vz + i);
    const Direction n = normal_of(points, i);
    const V c = dot(n, v), two_c = hn::Add(c, c);
    hn::Store(c, f, frame.cos_o + i);
    hn::Store(hn::MulSub(two_c, n.x, v.x), f, frame.rx + i);
    hn::Store(hn::MulSub(two_c, n.y, v.y), f, frame.ry + i);
    hn::Store(hn::MulSub(two_c, n.z, v.z), f, frame.rz + i);
    V t = c;
    auto segment = hn::Zero(whole);
    if (s.segments > 1) {
      const V x = hn::Mul(hn::Set(f, static_cast<float>(s.segments)), hn::Sqrt(hn::Max(c, hn::Zero(f))));
      segment = hn::Min(hn::ConvertTo(whole, x), hn::Set(whole, s.segments - 1));
      t = hn::Sub(x, hn::ConvertTo(f, segment));
    }
    hn::Store(t, f, frame.t + i);
    hn::Store(segment, whole, frame.segment + i);
  }
}

// Where class k looks instead of `r`.
struct Shifts {
  HWY_ALIGN float shift[kPointsAtOnce];

  HWY_INLINE void set(const CpuShading& s, const PointArrays& points, const Frame& frame, int k) {
    for (int i = 0; i < kPointsAtOnce; ++i) {
      const float* ends = frame.weights(s, points, i) + s.shift_offset + 2 * k;
      shift[i] = ends[0] + frame.t[i] * ends[1];
    }
  }
  HWY_INLINE Direction of(const Direction& r, const Direction& n, std::size_t i) const {
    const D f;
    const V by = hn::Load(f, shift + i);
    return {hn::MulAdd(by, n.x, r.x), hn::MulAdd(by, n.y, r.y), hn::MulAdd(by, n.z, r.z)};
  }
};

// The color that the forms' products stand for.
HWY_INLINE void store_color(const CpuShading& s, const Block& products, float* rgba) {
  float lanes[8];
  products.store(lanes);
  if (s.map_floats == 4) {
    for (int c = 0; c < 4; ++c) lanes[c] += lanes[4 + c];
  }
  Quad color = Quad::filled(0);
  for (int c = 0; c < s.map_floats; ++c) {
    color = mul_add(Quad::filled(lanes[c]), Quad::load(s.colors_of_forms + 4 * c), color);
  }
  color.store(rgba);
}

// Adds what one block of the maps shows to `sum`, and steps to the weights of the next.
HWY_INLINE Block add_weighted(const Block& t, const Block& maps, const float*& weight, Block sum) {
  sum = mul_add(mul_add(t, load(weight + 8), load(weight)), maps, sum);
  weight += 16;
  return sum;
}

// The tilted normals of every point, one at a time.
struct Tilted {
  HWY_ALIGN float rx[kPointsAtOnce], ry[kPointsAtOnce], rz[kPointsAtOnce];
  HWY_ALIGN float share[kPointsAtOnce];  // 0 where a point has no such tilt, or sees nothing by it

  Direction r(std::size_t i) const {
    const D f;
    return {hn::Load(f, rx + i), hn::Load(f, ry + i), hn::Load(f, rz + i)};
  }
};

// The tangent runs level around the vertical axis; on a level surface along +X.
HWY_INLINE void tilt(const CpuShading& s, const PointArrays& points, int which, Tilted& tilted) {
  const D f;
  HWY_ALIGN float tx[kPointsAtOnce], ty[kPointsAtOnce], tz[kPointsAtOnce];
  for (int i = 0; i < kPointsAtOnce; ++i) {
    const int first = s.first_tilt[points.part[i]], count = s.first_tilt[points.part[i] + 1] - first;
    const float* t = s.tilts + 4 * (first + (which < count ? which : 0));
    tx[i] = t[0], ty[i] = t[1], tz[i] = t[2];
    tilted.share[i] = which < count ? t[3] : 0;
  }
  const V zero = hn::Zero(f), one = hn::Set(f, 1.0F);
  // Each tilted normal m = a x + b y + c n is taken into the world, the viewer is mirrored about it, and tilts that
  // turn away from the viewer or mirror below the surface get no share.
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    const Direction n = normal_of(points, i), v = viewer_of(points, i);
    const V level2 = hn::MulAdd(n.x, n.x, hn::Mul(n.z, n.z));
    const auto steep = hn::Gt(level2, hn::Set(f, 1e-12F));
    const V scale = hn::Div(one, hn::Sqrt(hn::IfThenElse(steep, level2, one)));
    const Direction x = {hn::IfThenElse(steep, hn::Mul(n.z, scale), one), zero,
                         hn::IfThenElse(steep, hn::Neg(hn::Mul(n.x, scale)), zero)};
    const Direction y = {hn::Mul(n.y, x.z), hn::MulSub(n.z, x.x, hn::Mul(n.x, x.z)), hn::Neg(hn::Mul(n.y, x.x))};
    const V a = hn::Load(f, tx + i), b = hn::Load(f, ty + i), c = hn::Load(f, tz + i);
    const Direction m = {hn::MulAdd(a, x.x, hn::MulAdd(b, y.x, hn::Mul(c, n.x))), hn::MulAdd(b, y.y, hn::Mul(c, n.y)),
                         hn::MulAdd(a, x.z, hn::MulAdd(b, y.z, hn::Mul(c, n.z)))};
    const V cos_m = dot(m, v), two = hn::Add(cos_m, cos_m);
    const Direction r = {hn::MulSub(two, m.x, v.x), hn::MulSub(two, m.y, v.y), hn::MulSub(two, m.z, v.z)};
    hn::Store(r.x, f, tilted.rx + i), hn::Store(r.y, f, tilted.ry + i), hn::Store(r.z, f, tilted.rz + i);
    const auto seen = hn::And(hn::Gt(cos_m, zero), hn::Gt(dot(r, n), zero));
    hn::Store(hn::IfThenElseZero(seen, hn::Load(f, tilted.share + i)), f, tilted.share + i);
  }
}

// The blocks of all tilted classes, side by side, between their texels and averaged over the tilts.
HWY_INLINE void gather_tilted(const CpuShading& s, const PointArrays& points, const Frame& frame, int count,
                              float* gathered) {
  const D f;
  Tilted tilted;
  Taps taps;
  Shifts shifts[kMostClasses];
  for (int k = 0; k < s.classes; ++k) {
    if (s.use[k] == MapUse::kTilted) shifts[k].set(s, points, frame, k);
  }
  for (int which = 0; which < s.most_tilts; ++which) {
    tilt(s, points, which, tilted);
    int first = 0;
    for (int k = 0; k < s.classes; ++k) {
      if (s.use[k] != MapUse::kTilted) continue;
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f))
        address(shifts[k].of(tilted.r(i), normal_of(points, i), i), s.maps[k].size, i, taps);
      for (int i = 0; i < count; ++i) {
        if (which > 0 && tilted.share[i] == 0) continue;
        const Corners corners = corners_of(s.maps[k], taps, i, tilted.share[i]);
        float* sums = gathered + (i * kMostBlocks + first) * 8;
        for (int block = 0; block < s.maps[k].blocks; ++block, sums += 8) {
          const Block before = which > 0 ? load(sums) : filled(0);
          add_between(corners, static_cast<std::size_t>(block) * 8, before).store(sums);
        }
      }
      first += s.maps[k].blocks;
    }
  }
}

HWY_INLINE void add_environment(const CpuShading& s, const PointArrays& points, const Frame& frame, int count,
                                float* rgba) {
  const D f;
  Taps taps[kMostClasses];
  HWY_ALIGN float gathered[kPointsAtOnce * kMostBlocks * 8];
  // 1. Brushed parts: their maps are averaged over the tilted normals first.
  if (s.tilts != nullptr) gather_tilted(s, points, frame, count, gathered);
  // 2. The addresses of all points in every other class of maps, side by side.
  for (int k = 0; k < s.classes; ++k) {
    if (s.use[k] == MapUse::kTilted && s.tilts != nullptr) continue;
    Shifts shifts;
    if (s.shifted[k]) shifts.set(s, points, frame, k);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
      const Direction n = normal_of(points, i);
      const Direction d = s.use[k] == MapUse::kNormal ? n : s.shifted[k] ? shifts.of(frame.r(i), n, i) : frame.r(i);
      address(d, s.maps[k].size, i, taps[k]);
    }
  }
  // 3. Point by point, each block of texels is interpolated and weighed, and the sum is turned into a color.
  for (int i = 0; i < count; ++i) {
    const float* weight = frame.weights(s, points, i);
    const Block t = filled(frame.t[i]);
    const float* tilted = gathered + i * kMostBlocks * 8;
    Block sum = filled(0);
    for (int k = 0; k < s.classes; ++k) {
      if (s.use[k] == MapUse::kTilted && s.tilts != nullptr) {
        for (int block = 0; block < s.maps[k].blocks; ++block, tilted += 8) {
          sum = add_weighted(t, load(tilted), weight, sum);
        }
        continue;
      }
      const Corners corners = corners_of(s.maps[k], taps[k], i);
      for (int block = 0; block < s.maps[k].blocks; ++block) {
        const Block maps = add_between(corners, static_cast<std::size_t>(block) * 8, filled(0));
        sum = add_weighted(t, maps, weight, sum);
      }
    }
    store_color(s, sum, rgba + 4 * i);
  }
}

// brdf's fresnel_dielectric() with the refracted cosine g/n written in c: r_s = (c-g)/(c+g), r_p = (n^2 c-g)/(n^2 c+g).
HWY_INLINE V fresnel_of(V c) {
  const D f;
  const V n2 = hn::Set(f, static_cast<float>(brdf::kCoatIndex * brdf::kCoatIndex));
  const V g = hn::Sqrt(hn::MulAdd(c, c, hn::Set(f, static_cast<float>(brdf::kCoatIndex * brdf::kCoatIndex - 1))));
  const V s = hn::Div(hn::Sub(c, g), hn::Add(c, g)), p = hn::Div(hn::MulSub(n2, c, g), hn::MulAdd(n2, c, g));
  return hn::Mul(hn::Set(f, 0.5F), hn::MulAdd(s, s, hn::Mul(p, p)));
}

// What a coat lets in, by brdf's form of the Fresnel reflectance; `index2` is the square of its index, 1 without a
// coat, where the amplitudes would be 0/0 at c = 0.
HWY_INLINE float let_in(float c, float index2) {
  if (index2 <= 1) return 1;
  const float contrast = index2 - 1, g = std::sqrt(contrast + c * c), s = c + g, p = index2 * c + g;
  const float r_s = contrast / (s * s), r_p = contrast * ((index2 + 1) * c * c - 1) / (p * p);
  return 1 - 0.5F * (r_s * r_s + r_p * r_p);
}

// What every lobe sends from a light to the viewer, cos^E of the angle to the mirror direction, mean over the tilts.
HWY_INLINE void lobe_powers(const CpuShading& s, const LampSeen& lamp, const PointArrays& points, const Frame& frame,
                            const float* cos_i, float* powers) {
  const D f;
  Tilted tilted;
  for (int which = 0; which < s.most_tilts; ++which) {
    if (s.tilts != nullptr) tilt(s, points, which, tilted);
    for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
      const Direction r = s.tilts != nullptr ? tilted.r(i) : frame.r(i), l = lamp.toward(i);
      const Direction apart = {hn::Sub(r.x, l.x), hn::Sub(r.y, l.y), hn::Sub(r.z, l.z)};
      const V versine = hn::Mul(hn::Set(f, 0.5F), dot(apart, apart)), log_cos = log_cos_of(versine);
      const auto lit = hn::And(hn::Lt(versine, hn::Set(f, 1.0F)), hn::Gt(hn::Load(f, cos_i + i), hn::Zero(f)));
      const V share = s.tilts != nullptr ? hn::Load(f, tilted.share + i) : hn::Set(f, 1.0F);
      for (int j = 0; j < s.lobes; ++j) {
        float* power = powers + j * kPointsAtOnce + i;
        const V x = hn::Mul(hn::Set(f, s.exponents[j]), log_cos);
        const auto seen = hn::And(lit, hn::Gt(x, hn::Set(f, -80.0F)));
        const V here = hn::IfThenElseZero(seen, hn::Mul(share, hn::Exp(f, hn::Max(x, hn::Set(f, -80.0F)))));
        hn::Store(which > 0 ? hn::Add(here, hn::Load(f, power)) : here, f, power);
      }
    }
  }
}

// The exact BRDF times cos_i, so that the gloss term's 1/cos_i is gone.
HWY_INLINE void add_light(const CpuShading& s, int number, const PointArrays& points, const Frame& frame, int count,
                          float* rgba) {
  const D f;
  const float* light = s.light + 16 * number;
  HWY_ALIGN float cos_i[kPointsAtOnce], fresnel[kPointsAtOnce];
  HWY_ALIGN float powers[kMostLobes * kPointsAtOnce];
  LampSeen lamp;
  see_lamp(light, s.placed != nullptr ? s.placed + number : nullptr, points, lamp);
  // 1. The cosine at the surface and the Fresnel reflectance at half the angle between light and viewer.
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    const Direction l = lamp.toward(i);
    hn::Store(hn::Max(dot(normal_of(points, i), l), hn::Zero(f)), f, cos_i + i);
    const V half = hn::Set(f, 0.5F), cos_half2 = hn::MulAdd(half, dot(viewer_of(points, i), l), half);
    hn::Store(s.fresnel ? fresnel_of(hn::Sqrt(hn::Max(cos_half2, hn::Zero(f)))) : hn::Set(f, 1.0F), f, fresnel + i);
  }
  // 2. What each lobe sends to the viewer.
  lobe_powers(s, lamp, points, frame, cos_i, powers);
  // 3. Point by point, the weighted sum of diffuse part and lobes, times the light through the product's matrix.
  for (int i = 0; i < count; ++i) {
    if (!(cos_i[i] > 0)) continue;
    const float* weight = frame.weights(s, points, i) + s.light_offset;
    const Quad t = Quad::filled(frame.t[i]);
    Quad reflected = Quad::filled(0);
    const auto add = [&](float share) HWY_ATTR {
      reflected = mul_add(Quad::filled(share), mul_add(t, Quad::load(weight + 4), Quad::load(weight)), reflected);
      weight += 8;
    };
    const float base = s.coat ? cos_i[i] * let_in(cos_i[i], weight[3]) : cos_i[i];
    add(s.lit_diffuse ? base : 0);
    for (int j = 0; j < s.lobes; ++j) {
      const float power = powers[j * kPointsAtOnce + i];
      if (power == 0) {
        weight += 16;
        continue;
      }
      add(base * power);
      add(fresnel[i] * power);
    }
    float k[4];
    reflected.store(k);
    float* pixel = rgba + 4 * i;
    Quad sum = Quad::load(pixel);
    for (int c = 0; c < 3; ++c)
      sum = mul_add(Quad::filled(lamp.strength[i] * k[c]), Quad::load(light + 4 + 4 * c), sum);
    sum.store(pixel);
  }
}

// What every lobe sends of a disc to the viewer: with its flake weight, and with its gloss weight.
struct DiscSums {
  HWY_ALIGN float flake[kMostLobes * kPointsAtOnce];
  HWY_ALIGN float gloss[kMostLobes * kPointsAtOnce];
};

// The disc above the horizon of each point: its irradiance as the coat lets it in, and its part times the coat's
// reflectance in its middle; and the square of the coat's index.
struct DiscView {
  HWY_ALIGN float irradiance[kPointsAtOnce];
  HWY_ALIGN float above[kPointsAtOnce];
  HWY_ALIGN float index2[kPointsAtOnce];
};

// Each lobe is looked up by the chord between the mirror direction and the middle of the disc. Of what it gathers, one
// part counts with cosine and coat at the disc and the other with those at the mirror direction. Mean over the tilts.
HWY_INLINE void gather_disc(const CpuShading& s, int light, const LampSeen& lamp, const PointArrays& points,
                            const Frame& frame, const DiscView& view, int count, DiscSums& sums) {
  const D f;
  const V half = hn::Set(f, 0.5F), zero = hn::Zero(f);
  HWY_ALIGN float chord[kPointsAtOnce], cos_r[kPointsAtOnce], coat_r[kPointsAtOnce];
  std::fill_n(sums.flake, s.lobes * kPointsAtOnce, 0.0F), std::fill_n(sums.gloss, s.lobes * kPointsAtOnce, 0.0F);
  Tilted tilted;
  for (int which = 0; which < s.most_tilts; ++which) {
    if (s.tilts != nullptr) tilt(s, points, which, tilted);
    for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
      const Direction r = s.tilts != nullptr ? tilted.r(i) : frame.r(i), l = lamp.toward(i);
      const Direction apart = {hn::Sub(r.x, l.x), hn::Sub(r.y, l.y), hn::Sub(r.z, l.z)};
      hn::Store(hn::Sqrt(dot(apart, apart)), f, chord + i);
      hn::Store(hn::Max(dot(normal_of(points, i), r), zero), f, cos_r + i);
      const V cos_half2 = hn::MulAdd(half, dot(viewer_of(points, i), r), half);
      hn::Store(s.fresnel ? fresnel_of(hn::Sqrt(hn::Max(cos_half2, zero))) : hn::Set(f, 1.0F), f, coat_r + i);
    }
    for (int i = 0; s.coat && i < count; ++i) cos_r[i] *= let_in(cos_r[i], view.index2[i]);
    for (int j = 0; j < s.lobes; ++j) {
      const brdf::DiscLobeTable& table = *s.disc_lobes[light * s.lobes + j];
      const auto first = static_cast<float>(table.first_chord), scale = static_cast<float>(table.nodes_per_chord);
      float *flake = sums.flake + j * kPointsAtOnce, *gloss = sums.gloss + j * kPointsAtOnce;
      for (int i = 0; i < count; ++i) {
        const float x = (chord[i] - first) * scale, share = s.tilts != nullptr ? tilted.share[i] : 1.0F;
        if (!(x < brdf::DiscLobeTable::kNodes - 1) || share == 0) continue;
        const float from = x > 0 ? x : 0.0F;
        const auto node = static_cast<int>(from);
        const brdf::DiscLobeTable::Node* at = table.nodes.data() + node;
        const float t = share * (from - static_cast<float>(node)), rest = share - t;
        flake[i] += (rest * at->cosine[0] + t * at[1].cosine[0]) * view.irradiance[i] +
                    (rest * at->cosine[1] + t * at[1].cosine[1]) * cos_r[i];
        gloss[i] += (rest * at->plain[0] + t * at[1].plain[0]) * view.above[i] +
                    (rest * at->plain[1] + t * at[1].plain[1]) * coat_r[i];
      }
    }
  }
}

// As add_light() for a disc, with its mirror image.
HWY_INLINE void add_disc(const CpuShading& s, int light, const PointArrays& points, const Frame& frame, int count,
                         float* rgba) {
  const D f;
  const float* from = s.light + 16 * light;
  const CpuShading::Disc& disc = s.discs[light];
  LampSeen lamp;
  see_lamp(from, s.placed != nullptr ? s.placed + light : nullptr, points, lamp);
  const V half = hn::Set(f, 0.5F), zero = hn::Zero(f);
  // 1. How much of the disc stands above the horizon of each point, and the coat's reflectance at its middle.
  DiscView view;
  HWY_ALIGN float cosine[kPointsAtOnce], apart[kPointsAtOnce];
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    const Direction l = lamp.toward(i);
    hn::Store(dot(normal_of(points, i), l), f, cosine + i);
    const V cos_half2 = hn::MulAdd(half, dot(viewer_of(points, i), l), half);
    hn::Store(s.fresnel ? fresnel_of(hn::Sqrt(hn::Max(cos_half2, zero))) : hn::Set(f, 1.0F), f, view.above + i);
    const Direction r = frame.r(i), to_disc = {hn::Sub(r.x, l.x), hn::Sub(r.y, l.y), hn::Sub(r.z, l.z)};
    hn::Store(hn::Sqrt(dot(to_disc, to_disc)), f, apart + i);
  }
  if (std::none_of(cosine, cosine + count, [&](float c) { return c > -disc.sine; })) return;
  for (int i = 0; i < count; ++i) {
    view.irradiance[i] = cosine[i];
    float part = 1;
    if (cosine[i] < disc.sine) {
      const auto [irradiance, above] = disc.horizon->at(std::max(-1.0F, cosine[i] / disc.sine));
      view.irradiance[i] = irradiance;
      part = above;
      view.above[i] *= part;
    }
    if (!s.coat) continue;
    view.index2[i] = (frame.weights(s, points, i) + s.light_offset)[3];
    // At the mean cosine of what is seen of the disc.
    if (part > 0) view.irradiance[i] *= let_in(std::min(view.irradiance[i] / part, 1.0F), view.index2[i]);
  }
  // 2. What each lobe gathers.
  DiscSums sums;
  gather_disc(s, light, lamp, points, frame, view, count, sums);
  // 3. Point by point, the weighted sum of diffuse part, lobes and mirror, times the light through the product's
  // matrix.
  for (int i = 0; i < count; ++i) {
    if (!(cosine[i] > -disc.sine)) continue;
    const float* weight = frame.weights(s, points, i) + s.light_offset;
    const Quad t = Quad::filled(frame.t[i]);
    Quad reflected = Quad::filled(0);
    const auto add = [&](float share) HWY_ATTR {
      if (share != 0)
        reflected = mul_add(Quad::filled(share), mul_add(t, Quad::load(weight + 4), Quad::load(weight)), reflected);
      weight += 8;
    };
    add(s.lit_diffuse ? view.irradiance[i] : 0);
    for (int j = 0; j < s.lobes; ++j) {
      add(sums.flake[j * kPointsAtOnce + i]);
      add(sums.gloss[j * kPointsAtOnce + i]);
    }
    add(apart[i] <= disc.chord ? disc.mirrored : 0);
    float k[4];
    reflected.store(k);
    float* pixel = rgba + 4 * i;
    Quad sum = Quad::load(pixel);
    for (int c = 0; c < 3; ++c) sum = mul_add(Quad::filled(lamp.strength[i] * k[c]), Quad::load(from + 4 + 4 * c), sum);
    sum.store(pixel);
  }
}

// A point's view and segment of weights; the environment by prefiltered maps; then the lights, one by one.
void ShadePoints(const CpuShading& s, PointArrays& points, int count, float* rgba) {
  Frame frame;
  set_up(s, points, frame);
  add_environment(s, points, frame, count, rgba);
  for (int i = 0; i < s.lights; ++i) {
    if (s.discs != nullptr) {
      add_disc(s, i, points, frame, count, rgba);
    } else {
      add_light(s, i, points, frame, count, rgba);
    }
  }
}

void LookUpBackground(const InterleavedMaps& map, PointArrays& points, int count, float* rgba) {
  const D f;
  Taps taps;
  for (std::size_t i = 0; i < kPointsAtOnce; i += hn::Lanes(f)) {
    const Direction v = viewer_of(points, i);
    address({hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)}, map.size, i, taps);
  }
  for (int i = 0; i < count; ++i) {
    float lanes[8];
    add_between(corners_of(map, taps, i), 0, filled(0)).store(lanes);
    std::copy_n(lanes, 4, rgba + 4 * i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::render {

HWY_EXPORT(ShadePoints);
HWY_EXPORT(LookUpBackground);

void shade_points(const CpuShading& shading, PointArrays& points, int count, float* rgba) {
  HWY_DYNAMIC_DISPATCH(ShadePoints)(shading, points, count, rgba);
}

void look_up_background(const InterleavedMaps& map, PointArrays& points, int count, float* rgba) {
  HWY_DYNAMIC_DISPATCH(LookUpBackground)(map, points, count, rgba);
}

}  // namespace goniochrome::render
#endif
