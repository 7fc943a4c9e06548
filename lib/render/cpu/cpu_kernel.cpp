#include "render/cpu/cpu_kernel.h"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/cpu/cpu_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h:
#include "brdf/lobe_model.h"
#include "math/elementary.h"
#include "render/cpu/cube_lookup-inl.h"
#include "render/cpu/lamps-inl.h"

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

using Block = Pack<8>;  // one texel's block: two maps, R G B 0 each

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
  const auto share = [&](int corner) HWY_ATTR { return Block::filled(scale * taps.share[corner][i]); };
  const float* lower = upper + static_cast<std::size_t>(maps.size + 2) * texel;
  return {upper, lower, texel, {share(0), share(1), share(2), share(3)}};
}

// Adds one block of a texel, between the four, to `sum`.
HWY_INLINE Block add_between(const Corners& c, std::size_t at, const Block& sum) {
  const auto add = [&](int corner, const float* texel, const Block& to)
                       HWY_ATTR { return mul_add(c.share[corner], Block::load(texel + at), to); };
  return add(2, c.lower, add(3, c.lower + c.right, add(0, c.upper, add(1, c.upper + c.right, sum))));
}

// The view of every point, and where its weights are.
struct Frame {
  HWY_ALIGN float rx[kPointsAtOnce], ry[kPointsAtOnce], rz[kPointsAtOnce];
  HWY_ALIGN float t[kPointsAtOnce];
  HWY_ALIGN std::int32_t segment[kPointsAtOnce];

  HWY_INLINE Direction r(std::size_t i) const { return loaded(rx, ry, rz, i); }
  const float* weights(const CpuShading& s, const PointArrays& points, int i) const {
    return s.weights + static_cast<std::size_t>(s.rows[points.part[i]] * s.segments + segment[i]) * s.segment_floats;
  }
};

HWY_INLINE Direction normal_of(const PointArrays& p, std::size_t i) {
  return loaded(p.nx, p.ny, p.nz, i);
}
HWY_INLINE Direction viewer_of(const PointArrays& p, std::size_t i) {
  return loaded(p.vx, p.vy, p.vz, i);
}

// The number of points with those that fill up the last vector, which the kernel computes with as well.
HWY_INLINE std::size_t whole_vectors(int count) {
  const std::size_t lanes = hn::Lanes(D());
  return (static_cast<std::size_t>(count) + lanes - 1) / lanes * lanes;
}

// Makes the directions to the viewer unit, mirrors them, and finds the segments of the weights.
HWY_INLINE void set_up(const CpuShading& s, PointArrays& points, int count, Frame& frame) {
  const D f;
  const hn::RebindToSigned<D> whole;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
    Direction v = viewer_of(points, i);
    v = scaled(hn::Div(hn::Set(f, 1.0F), hn::Sqrt(dot(v, v))), v);
    store(v, points.vx, points.vy, points.vz, i);
    const Direction n = normal_of(points, i);
    const V c = dot(n, v);
    store(mirrored(c, n, v), frame.rx, frame.ry, frame.rz, i);
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

  HWY_INLINE void set(const CpuShading& s, const PointArrays& points, const Frame& frame, int count, int k) {
    std::fill_n(shift, whole_vectors(count), 0.0F);
    for (int i = 0; i < count; ++i) {
      const float* ends = frame.weights(s, points, i) + s.shift_offset + 2 * k;
      shift[i] = ends[0] + frame.t[i] * ends[1];
    }
  }
  HWY_INLINE Direction of(const Direction& r, const Direction& n, std::size_t i) const {
    const D f;
    return mul_add(hn::Load(f, shift + i), n, r);
  }
};

// Adds what one block of the maps shows, and steps to the weights of the next.
HWY_INLINE void add_weighted(const Block& t, const Block& maps, const float* weight, Products<8>& sums) {
  sums.add(maps, mul_add(t, Block::load(weight + 8), Block::load(weight)));
}

// The tilted normals of every point, one at a time.
struct Tilted {
  HWY_ALIGN float rx[kPointsAtOnce], ry[kPointsAtOnce], rz[kPointsAtOnce];
  HWY_ALIGN float share[kPointsAtOnce];  // 0 where a point has no such tilt, or sees nothing by it

  HWY_INLINE Direction r(std::size_t i) const { return loaded(rx, ry, rz, i); }
};

// The tangent runs level around the vertical axis; on a level surface along +X.
HWY_INLINE void tilt(const CpuShading& s, const PointArrays& points, int count, int which, Tilted& tilted) {
  const D f;
  HWY_ALIGN float tx[kPointsAtOnce], ty[kPointsAtOnce], tz[kPointsAtOnce];
  const auto end = static_cast<int>(whole_vectors(count));
  for (int i = 0; i < end; ++i) {
    const int first = s.first_tilt[points.part[i]], tilts = s.first_tilt[points.part[i] + 1] - first;
    const float* t = s.tilts + 4 * (first + (which < tilts ? which : 0));
    tx[i] = t[0], ty[i] = t[1], tz[i] = t[2];
    tilted.share[i] = which < tilts ? t[3] : 0;
  }
  const V zero = hn::Zero(f), one = hn::Set(f, 1.0F);
  // Each tilted normal m = a x + b y + c n is taken into the world, the viewer is mirrored about it, and tilts that
  // turn away from the viewer or mirror below the surface get no share.
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
    const Direction n = normal_of(points, i), v = viewer_of(points, i);
    const V level2 = hn::MulAdd(n.x, n.x, hn::Mul(n.z, n.z));
    const auto steep = hn::Gt(level2, hn::Set(f, 1e-12F));
    const V scale = hn::Div(one, hn::Sqrt(hn::IfThenElse(steep, level2, one)));
    const Direction x = {hn::IfThenElse(steep, hn::Mul(n.z, scale), one), zero,
                         hn::IfThenElse(steep, hn::Neg(hn::Mul(n.x, scale)), zero)};
    const Direction y = {hn::Mul(n.y, x.z), hn::MulSub(n.z, x.x, hn::Mul(n.x, x.z)), hn::Neg(hn::Mul(n.y, x.x))};
    const V a = hn::Load(f, tx + i), b = hn::Load(f, ty + i), c = hn::Load(f, tz + i);
    const Direction m = mul_add(a, x, mul_add(b, y, scaled(c, n)));
    const V cos_m = dot(m, v);
    const Direction r = mirrored(cos_m, m, v);
    store(r, tilted.rx, tilted.ry, tilted.rz, i);
    const auto seen = hn::And(hn::Gt(cos_m, zero), hn::Gt(dot(r, n), zero));
    hn::Store(hn::IfThenElseZero(seen, hn::Load(f, tilted.share + i)), f, tilted.share + i);
  }
}

// Blocks that were looked up beforehand.
struct Gathered {
  static constexpr int kMost = kMostBlocks + 2;  // the diffuse maps and the mirror beside those that lobes meet
  HWY_ALIGN float blocks[8 * kPointsAtOnce * kMost];
  bool has[kMostClasses] = {};

  Gathered() {}  // `blocks` are left as they are
  // A block of a point, by its number among those of all classes.
  float* at(int i, int block) { return blocks + 8 * (i * kMost + block); }
  const float* at(int i, int block) const { return blocks + 8 * (i * kMost + block); }
};

// The blocks of all tilted classes, between their texels and averaged over the tilts.
HWY_INLINE void gather_tilted(const CpuShading& s, const PointArrays& points, const Frame& frame, int count,
                              Gathered& gathered) {
  const D f;
  Tilted tilted;
  Taps taps;
  Shifts shifts[kMostClasses];
  for (int k = 0; k < s.classes; ++k) {
    gathered.has[k] = s.use[k] == MapUse::kTilted;
    if (gathered.has[k]) shifts[k].set(s, points, frame, count, k);
  }
  for (int which = 0; which < s.most_tilts; ++which) {
    tilt(s, points, count, which, tilted);
    int first = 0;
    for (int k = 0; k < s.classes; first += s.maps[k++].blocks) {
      if (!gathered.has[k]) continue;
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f))
        address(shifts[k].of(tilted.r(i), normal_of(points, i), i), s.maps[k].size, i, taps);
      for (int i = 0; i < count; ++i) {
        if (which > 0 && tilted.share[i] == 0) continue;
        const Corners corners = corners_of(s.maps[k], taps, i, tilted.share[i]);
        float* sums = gathered.at(i, first);
        for (int block = 0; block < s.maps[k].blocks; ++block, sums += 8) {
          const Block before = which > 0 ? Block::load(sums) : Block::filled(0);
          add_between(corners, static_cast<std::size_t>(block) * 8, before).store(sums);
        }
      }
    }
  }
}

// The blocks of all classes that every paint meets in the same direction; nothing is tilted.
HWY_INLINE void gather_alike(const CpuShading& s, const PointArrays& points, const Frame& frame, int count,
                             Gathered& gathered) {
  const D f;
  Taps taps;
  int first = 0;
  for (int k = 0; k < s.classes; first += s.maps[k++].blocks) {
    gathered.has[k] = !s.shifted[k];
    if (s.shifted[k]) continue;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f))
      address(s.use[k] == MapUse::kNormal ? normal_of(points, i) : frame.r(i), s.maps[k].size, i, taps);
    for (int i = 0; i < count; ++i) {
      const Corners corners = corners_of(s.maps[k], taps, i);
      for (int block = 0; block < s.maps[k].blocks; ++block)
        add_between(corners, static_cast<std::size_t>(block) * 8, Block::filled(0))
            .store(gathered.at(i, first + block));
    }
  }
}

HWY_INLINE std::uint64_t bits_of(int first, int blocks) {
  return ((std::uint64_t{1} << blocks) - 1) << first;
}

HWY_INLINE void add_environment(const CpuShading& s, const PointArrays& points, const Frame& frame, int count,
                                const Gathered& gathered, float* rgba) {
  const D f;
  Taps taps[kMostClasses];
  std::uint64_t shown_by_any = 0;
  for (int i = 0; i < count; ++i) shown_by_any |= s.shown_blocks[points.part[i]];
  // 1. The addresses of all points in every class of maps that is not gathered, side by side.
  int first = 0;
  for (int k = 0; k < s.classes; first += s.maps[k++].blocks) {
    if (gathered.has[k] || (shown_by_any & bits_of(first, s.maps[k].blocks)) == 0) continue;
    Shifts shifts;
    if (s.shifted[k]) shifts.set(s, points, frame, count, k);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
      const Direction n = normal_of(points, i);
      const Direction d = s.use[k] == MapUse::kNormal ? n : s.shifted[k] ? shifts.of(frame.r(i), n, i) : frame.r(i);
      address(d, s.maps[k].size, i, taps[k]);
    }
  }
  // 2. Point by point, each block of texels is interpolated and weighed, and the sum is turned into a color.
  for (int i = 0; i < count; ++i) {
    const float* weights = frame.weights(s, points, i);
    const Block t = Block::filled(frame.t[i]);
    Products<8> sums;
    const std::uint64_t all_shown = s.shown_blocks[points.part[i]];
    first = 0;
    for (int k = 0; k < s.classes; first += s.maps[k++].blocks) {
      std::uint64_t shown = all_shown & bits_of(first, s.maps[k].blocks);
      if (gathered.has[k]) {
        for (; shown != 0; shown &= shown - 1) {
          const int block = std::countr_zero(shown);
          add_weighted(t, Block::load(gathered.at(i, block)), weights + 16 * block, sums);
        }
      } else if (shown != 0) {
        const Corners corners = corners_of(s.maps[k], taps[k], i);
        for (; shown != 0; shown &= shown - 1) {
          const int block = std::countr_zero(shown);
          const Block between = add_between(corners, 8 * static_cast<std::size_t>(block - first), Block::filled(0));
          add_weighted(t, between, weights + 16 * block, sums);
        }
      }
    }
    sums.on(Quad::filled(0), s.product).store(rgba + 4 * i);
  }
}

constexpr auto kCoat2 = static_cast<float>(brdf::kCoatIndex * brdf::kCoatIndex);

// The transmission of a coat, by brdf's form of the Fresnel reflectance; `index2` is the square of its index, 1 without
// a coat, where the amplitudes would be 0/0 at c = 0.
HWY_INLINE float let_in(float c, float index2) {
  if (index2 <= 1) return 1;
  const float contrast = index2 - 1, g = std::sqrt(contrast + c * c), s = c + g, p = index2 * c + g;
  const float r_s = contrast / (s * s), r_p = contrast * ((index2 + 1) * c * c - 1) / (p * p);
  return 1 - 0.5F * (r_s * r_s + r_p * r_p);
}

// The light that each slot of the weights meets, of all lamps together: slot by slot, channel by channel, of each
// point. A lamp then costs what its lobes gather, and the weights are fetched once.
class Lit {
 public:
  // `lobes`: bits, of those that any of the points shows.
  HWY_INLINE Lit(const CpuShading& s, std::uint64_t lobes, int count) : lobes_(lobes) {
    for_slots(s, lobes, [&](int slot) HWY_ATTR {
      for (int c = 0; c < 3; ++c) std::fill_n(light_ + (3 * slot + c) * kPointsAtOnce, whole_vectors(count), 0.0F);
    });
  }

  static int flake(int lobe) { return 1 + 2 * lobe; }
  static int gloss(int lobe) { return 2 + 2 * lobe; }
  static int mirror(const CpuShading& s) { return 1 + 2 * s.lobes; }
  std::uint64_t lobes() const { return lobes_; }

  // `share` of the light of a lamp, for points from i on.
  HWY_INLINE void add(int slot, std::size_t i, V share, const float* white) {
    const D f;
    for (int c = 0; c < 3; ++c) {
      float* at = light_ + (3 * slot + c) * kPointsAtOnce + i;
      hn::Store(hn::MulAdd(share, hn::Set(f, white[c]), hn::Load(f, at)), f, at);
    }
  }

  // Adds what the points, which show none but these lobes, show of it.
  HWY_INLINE void show(const CpuShading& s, std::uint64_t lobes, const PointArrays& points, const Frame& frame,
                       int count, float* rgba) const {
    for (int i = 0; i < count; ++i) {
      const float* weights = frame.weights(s, points, i) + s.light_offset;
      const Quad t = Quad::filled(frame.t[i]);
      Products<4> sums;
      for_slots(s, lobes, [&](int slot) HWY_ATTR {
        const float *weight = weights + 8 * slot, *light = light_ + 3 * slot * kPointsAtOnce + i;
        const Quad shown = mul_add(t, Quad::load(weight + 4), Quad::load(weight));
        for (int c = 0; c < 3; ++c) sums.of[c] = mul_add(Quad::filled(light[c * kPointsAtOnce]), shown, sums.of[c]);
      });
      sums.on(Quad::load(rgba + 4 * i), s.product).store(rgba + 4 * i);
    }
  }

 private:
  static constexpr int kMostSlots = 2 * kMostLobes + 2;
  template <class Visit>
  static HWY_INLINE void for_slots(const CpuShading& s, std::uint64_t lobes, const Visit& visit) {
    visit(0);
    for (; lobes != 0; lobes &= lobes - 1) visit(flake(std::countr_zero(lobes))), visit(gloss(std::countr_zero(lobes)));
    visit(mirror(s));
  }

  std::uint64_t lobes_;
  HWY_ALIGN float light_[3 * kMostSlots * kPointsAtOnce];
};

// The square of the index of each point's coat.
HWY_INLINE void coat_indices(const CpuShading& s, const PointArrays& points, const Frame& frame, int count,
                             float* index2) {
  std::fill_n(index2, whole_vectors(count), 1.0F);
  for (int i = 0; s.coat && i < count; ++i) index2[i] = (frame.weights(s, points, i) + s.light_offset)[3];
}

// The exact BRDF of a point lamp times cos_i, so that the gloss term's 1/cos_i is gone: cos^E of the angle to the
// mirror direction for every lobe, mean over the tilts.
HWY_INLINE void add_light(const CpuShading& s, int number, const PointArrays& points, const Frame& frame, int count,
                          const float* index2, Lit& lit) {
  const D f;
  const float* light = s.light + 8 * number;
  HWY_ALIGN float base[kPointsAtOnce], fresnel[kPointsAtOnce];
  LampSeen lamp;
  see_lamp(light, s.placed != nullptr ? s.placed + number : nullptr, points, count, lamp);
  // 1. The cosine at the surface, as the coat lets light in, and the Fresnel reflectance at half the angle between
  // light and viewer; the first is 0 below the horizon.
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
    const Direction l = lamp.toward(i);
    hn::Store(hn::Max(dot(normal_of(points, i), l), hn::Zero(f)), f, base + i);
    const V half = hn::Set(f, 0.5F), cos_half2 = hn::MulAdd(half, dot(viewer_of(points, i), l), half);
    hn::Store(s.fresnel ? fresnel_of(hn::Sqrt(hn::Max(cos_half2, hn::Zero(f))), kCoat2) : hn::Set(f, 1.0F), f,
              fresnel + i);
  }
  for (int i = 0; s.coat && i < count; ++i) base[i] *= let_in(base[i], index2[i]);
  // 2. What the diffuse part meets, and each lobe.
  Tilted tilted;
  for (int which = 0; which < s.most_tilts; ++which) {
    if (s.tilts != nullptr) tilt(s, points, count, which, tilted);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
      const V strength = hn::Load(f, lamp.strength + i), by_cosine = hn::Mul(strength, hn::Load(f, base + i)),
              by_coat = hn::Mul(strength, hn::Load(f, fresnel + i));
      if (which == 0 && s.lit_diffuse) lit.add(0, i, by_cosine, light + 4);
      const Direction r = s.tilts != nullptr ? tilted.r(i) : frame.r(i), l = lamp.toward(i);
      const Direction apart = minus(r, l);
      const V versine = hn::Mul(hn::Set(f, 0.5F), dot(apart, apart)), log_cos = log_beside_one(hn::Neg(versine));
      const auto reached = hn::And(hn::Lt(versine, hn::Set(f, 1.0F)), hn::Gt(hn::Load(f, base + i), hn::Zero(f)));
      const V share = s.tilts != nullptr ? hn::Load(f, tilted.share + i) : hn::Set(f, 1.0F);
      for (std::uint64_t left = lit.lobes(); left != 0; left &= left - 1) {
        const int j = std::countr_zero(left);
        const V x = hn::Mul(hn::Set(f, s.exponents[j]), log_cos);
        const auto seen = hn::And(reached, hn::Gt(x, hn::Set(f, -80.0F)));
        if (hn::AllFalse(f, seen)) continue;
        const V power = hn::IfThenElseZero(seen, hn::Mul(share, hn::Exp(f, hn::Max(x, hn::Set(f, -80.0F)))));
        lit.add(Lit::flake(j), i, hn::Mul(power, by_cosine), light + 4);
        lit.add(Lit::gloss(j), i, hn::Mul(power, by_coat), light + 4);
      }
    }
  }
}

constexpr int kNodeFloats = 4;  // cosine, cosine, plain, plain
static_assert(sizeof(brdf::DiscLobeTable::Node) == kNodeFloats * sizeof(float));

// Returns the elevation of a disc's middle, whose sine is given, relative to the disc's radius: -1 or more.
HWY_INLINE float elevation_of(float sine, const CpuShading::Disc& disc) {
  return std::max(-1.0F, static_cast<float>(math::asin(std::max(-1.0F, sine))) / disc.radius_rad);
}

// Adds the light of a disc and of its mirror image. Each lobe is looked up by the chord between the mirror direction
// and the middle of the disc. Of what it gathers, one part counts with cosine and coat at the disc and the other with
// those at the mirror direction.
HWY_INLINE void add_disc(const CpuShading& s, int number, const PointArrays& points, const Frame& frame, int count,
                         const float* index2, Lit& lit) {
  const D f;
  const hn::RebindToSigned<D> whole;
  constexpr std::size_t kMostLanes = hn::MaxLanes(D());
  const float* light = s.light + 8 * number;
  const CpuShading::Disc& disc = s.discs[number];
  LampSeen lamp;
  see_lamp(light, s.placed != nullptr ? s.placed + number : nullptr, points, count, lamp);
  const V half = hn::Set(f, 0.5F), zero = hn::Zero(f), one = hn::Set(f, 1.0F);
  // 1. How much of the disc stands above the horizon of each point: its irradiance as the coat lets it in, and its part
  // times the coat's reflectance in its middle.
  HWY_ALIGN float irradiance[kPointsAtOnce], above[kPointsAtOnce], seen[kPointsAtOnce];
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
    const Direction l = lamp.toward(i);
    const V cosine = dot(normal_of(points, i), l), cos_half2 = hn::MulAdd(half, dot(viewer_of(points, i), l), half);
    hn::Store(cosine, f, irradiance + i);
    hn::Store(s.fresnel ? fresnel_of(hn::Sqrt(hn::Max(cos_half2, zero)), kCoat2) : one, f, above + i);
    hn::Store(hn::IfThenElseZero(hn::Gt(cosine, hn::Set(f, -disc.sine)), hn::Load(f, lamp.strength + i)), f, seen + i);
  }
  if (std::none_of(seen, seen + count, [](float strength) { return strength > 0; })) return;
  for (int i = 0; i < count; ++i) {
    float part = 1;
    if (irradiance[i] < disc.sine) {
      const auto [cut, shown] = disc.horizon->at(elevation_of(irradiance[i], disc));
      irradiance[i] = cut, part = shown;
      above[i] *= part;
    }
    // At the mean cosine of what is seen of the disc.
    if (s.coat && part > 0) irradiance[i] *= let_in(std::min(irradiance[i] / part, 1.0F), index2[i]);
  }
  // 2. What the diffuse part meets, the mirror, and each lobe.
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
    const V strength = hn::Load(f, seen + i);
    if (s.lit_diffuse) lit.add(0, i, hn::Mul(strength, hn::Load(f, irradiance + i)), light + 4);
    const Direction r = frame.r(i), l = lamp.toward(i);
    const Direction apart = minus(r, l);
    const auto within = hn::Le(hn::Sqrt(dot(apart, apart)), hn::Set(f, disc.chord));
    if (!hn::AllFalse(f, within))
      lit.add(Lit::mirror(s), i, hn::IfThenElseZero(within, hn::Mul(strength, hn::Set(f, disc.mirrored))), light + 4);
  }
  Tilted tilted;
  HWY_ALIGN float chord[kPointsAtOnce], cos_r[kPointsAtOnce], coat_r[kPointsAtOnce];
  HWY_ALIGN float by_node[kNodeFloats * kPointsAtOnce];
  for (int which = 0; which < s.most_tilts; ++which) {
    if (s.tilts != nullptr) tilt(s, points, count, which, tilted);
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
      const Direction r = s.tilts != nullptr ? tilted.r(i) : frame.r(i), l = lamp.toward(i);
      const Direction apart = minus(r, l);
      hn::Store(hn::Sqrt(dot(apart, apart)), f, chord + i);
      hn::Store(hn::Max(dot(normal_of(points, i), r), zero), f, cos_r + i);
      const V cos_half2 = hn::MulAdd(half, dot(viewer_of(points, i), r), half);
      hn::Store(s.fresnel ? fresnel_of(hn::Sqrt(hn::Max(cos_half2, zero)), kCoat2) : one, f, coat_r + i);
    }
    for (int i = 0; i < count; ++i) {
      if (s.coat) cos_r[i] *= let_in(cos_r[i], index2[i]);
      float* of_node = by_node + kNodeFloats * i;
      of_node[0] = irradiance[i], of_node[1] = cos_r[i], of_node[2] = above[i], of_node[3] = coat_r[i];
    }
    for (std::uint64_t left = lit.lobes(); left != 0; left &= left - 1) {
      const int j = std::countr_zero(left);
      const brdf::DiscLobeTable& table = *s.disc_lobes[number * s.lobes + j];
      const V first = hn::Set(f, static_cast<float>(table.first_chord)),
              scale = hn::Set(f, static_cast<float>(table.nodes_per_chord)),
              last = hn::Set(f, static_cast<float>(brdf::DiscLobeTable::kNodes - 1));
      const float* nodes = table.nodes.front().cosine;
      for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
        const V x = hn::Max(hn::Mul(hn::Sub(hn::Load(f, chord + i), first), scale), zero);
        const auto meets = hn::Lt(x, last);
        if (hn::AllFalse(f, meets)) continue;
        // Point by point: processors gather slowly, and a node is four floats side by side.
        const V from = hn::IfThenElseZero(meets, x);
        const auto node = hn::ConvertTo(whole, from);
        HWY_ALIGN std::int32_t at[kMostLanes];
        HWY_ALIGN float part[kMostLanes], by_cosine[kMostLanes] = {}, by_coat[kMostLanes] = {};
        hn::Store(node, whole, at);
        hn::Store(hn::Sub(from, hn::ConvertTo(f, node)), f, part);
        for (std::size_t k = 0; k < std::min(hn::Lanes(f), static_cast<std::size_t>(count) - i); ++k) {
          const float* here = nodes + kNodeFloats * at[k];
          const Quad zero4 = Quad::filled(0), by = Quad::load(by_node + kNodeFloats * (i + k)),
                     low = mul_add(Quad::filled(1 - part[k]), Quad::load(here), zero4);
          float sent[kNodeFloats];
          mul_add(by, mul_add(Quad::filled(part[k]), Quad::load(here + kNodeFloats), low), zero4).store(sent);
          by_cosine[k] = sent[0] + sent[1], by_coat[k] = sent[2] + sent[3];
        }
        const V strength = hn::IfThenElseZero(meets, hn::Load(f, seen + i));
        const V share = s.tilts != nullptr ? hn::Mul(strength, hn::Load(f, tilted.share + i)) : strength;
        lit.add(Lit::flake(j), i, hn::Mul(share, hn::Load(f, by_cosine)), light + 4);
        lit.add(Lit::gloss(j), i, hn::Mul(share, hn::Load(f, by_coat)), light + 4);
      }
    }
  }
}

HWY_INLINE std::uint64_t lit_lobes(const CpuShading& s, const PointArrays& points, int count) {
  std::uint64_t lobes = 0;
  for (int i = 0; i < count; ++i) lobes |= s.lit_lobes[points.part[i]];
  return lobes;
}

HWY_INLINE void add_lights(const CpuShading& s, const PointArrays& points, const Frame& frame, int count, Lit& lit) {
  HWY_ALIGN float index2[kPointsAtOnce];
  coat_indices(s, points, frame, count, index2);
  for (int i = 0; i < s.lights; ++i) {
    if (s.discs != nullptr) {
      add_disc(s, i, points, frame, count, index2, lit);
    } else {
      add_light(s, i, points, frame, count, index2, lit);
    }
  }
}

// A point's view and segment of weights; the environment by prefiltered maps; then the lights.
void ShadePoints(const CpuShading& s, PointArrays& points, int count, float* rgba) {
  Frame frame;
  set_up(s, points, count, frame);
  Gathered gathered;
  if (s.tilts != nullptr) gather_tilted(s, points, frame, count, gathered);
  add_environment(s, points, frame, count, gathered, rgba);
  if (s.lights == 0) return;
  Lit lit(s, lit_lobes(s, points, count), count);
  add_lights(s, points, frame, count, lit);
  lit.show(s, lit.lobes(), points, frame, count, rgba);
}

HWY_INLINE void to_next_part(PointArrays& points, int count) {
  for (int i = 0; i < count; ++i) ++points.part[i];
}

void ShadePaints(const CpuShading& s, PointArrays& points, int count, int paints, float* rgba) {
  if (s.tilts != nullptr) {
    for (int paint = 0; paint < paints; ++paint, rgba += 4 * kPointsAtOnce, to_next_part(points, count))
      ShadePoints(s, points, count, rgba);
    return;
  }
  Frame frame;
  set_up(s, points, count, frame);
  Gathered gathered;
  gather_alike(s, points, frame, count, gathered);
  std::uint64_t lobes = 0;
  for (int i = 0; i < count; ++i)
    for (int paint = 0; paint < paints; ++paint) lobes |= s.lit_lobes[points.part[i] + paint];
  Lit lit(s, lobes, count);
  add_lights(s, points, frame, count, lit);
  for (int paint = 0; paint < paints; ++paint, rgba += 4 * kPointsAtOnce, to_next_part(points, count)) {
    add_environment(s, points, frame, count, gathered, rgba);
    if (s.lights > 0) lit.show(s, lit_lobes(s, points, count), points, frame, count, rgba);
  }
}

void LookUpBackground(const InterleavedMaps& map, PointArrays& points, int count, float* rgba) {
  const D f;
  Taps taps;
  for (std::size_t i = 0; i < static_cast<std::size_t>(count); i += hn::Lanes(f)) {
    const Direction v = viewer_of(points, i);
    address({hn::Neg(v.x), hn::Neg(v.y), hn::Neg(v.z)}, map.size, i, taps);
  }
  for (int i = 0; i < count; ++i) fetched({map.size, map.texels}, taps, i).store(rgba + 4 * i);
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::render {

HWY_EXPORT(ShadePoints);
HWY_EXPORT(ShadePaints);
HWY_EXPORT(LookUpBackground);

void shade_points(const CpuShading& shading, PointArrays& points, int count, float* rgba) {
  HWY_DYNAMIC_DISPATCH(ShadePoints)(shading, points, count, rgba);
}

void shade_paints(const CpuShading& shading, PointArrays& points, int count, int paints, float* rgba) {
  HWY_DYNAMIC_DISPATCH(ShadePaints)(shading, points, count, paints, rgba);
}

void look_up_background(const InterleavedMaps& map, PointArrays& points, int count, float* rgba) {
  HWY_DYNAMIC_DISPATCH(LookUpBackground)(map, points, count, rgba);
}

}  // namespace goniochrome::render
#endif
