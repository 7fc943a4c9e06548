// Lookups in cube maps for many points side by side. The kernels include this file once for each instruction set.
#if defined(GONIOCHROME_RENDER_CUBE_LOOKUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef GONIOCHROME_RENDER_CUBE_LOOKUP_INL_H_
#undef GONIOCHROME_RENDER_CUBE_LOOKUP_INL_H_
#else
#define GONIOCHROME_RENDER_CUBE_LOOKUP_INL_H_
#endif

#include <hwy/highway.h>
// After highway.h:
#include <hwy/contrib/math/math-inl.h>

#include "render/cpu/interleaved_maps.h"

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::CappedTag<float, 16>;  // points side by side
using V = hn::Vec<D>;

struct Direction {
  V x, y, z;
};

HWY_INLINE Direction loaded(const float* x, const float* y, const float* z, std::size_t i) {
  const D f;
  return {hn::LoadU(f, x + i), hn::LoadU(f, y + i), hn::LoadU(f, z + i)};
}
HWY_INLINE void store(const Direction& d, float* x, float* y, float* z, std::size_t i) {
  const D f;
  hn::StoreU(d.x, f, x + i), hn::StoreU(d.y, f, y + i), hn::StoreU(d.z, f, z + i);
}
HWY_INLINE Direction scaled(V s, const Direction& d) {
  return {hn::Mul(s, d.x), hn::Mul(s, d.y), hn::Mul(s, d.z)};
}
HWY_INLINE Direction minus(const Direction& a, const Direction& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
// s a + b
HWY_INLINE Direction mul_add(V s, const Direction& a, const Direction& b) {
  return {hn::MulAdd(s, a.x, b.x), hn::MulAdd(s, a.y, b.y), hn::MulAdd(s, a.z, b.z)};
}
HWY_INLINE V dot(const Direction& a, const Direction& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}

// Four texels and their shares, for each point.
struct Taps {
  HWY_ALIGN std::int32_t offset[kPointsAtOnce];  // of the upper left texel, in texels
  HWY_ALIGN float share[4][kPointsAtOnce];       // upper left and right, lower left and right
};

// The face that a direction meets, its coordinates s and t there, and the length of the direction's largest component:
// s and t over it go from -1 to 1. OpenGL 4.5, table 8.19.
struct OnFace {
  V face, s, t, axis;
};
HWY_INLINE OnFace on_face(const Direction& d) {
  const D f;
  const V x = hn::Abs(d.x), y = hn::Abs(d.y), z = hn::Abs(d.z), zero = hn::Zero(f);
  const auto on_x = hn::And(hn::Ge(x, y), hn::Ge(x, z));
  const auto on_y = hn::AndNot(on_x, hn::Ge(y, z));
  const V axis = hn::IfThenElse(on_x, d.x, hn::IfThenElse(on_y, d.y, d.z));
  const auto back = hn::Lt(axis, zero);
  const V s_of_z = hn::IfThenElse(back, hn::Neg(d.x), d.x);
  const V s_of_x = hn::IfThenElse(back, d.z, hn::Neg(d.z));
  const V t_of_y = hn::IfThenElse(back, hn::Neg(d.z), d.z);
  const V s = hn::IfThenElse(on_x, s_of_x, hn::IfThenElse(on_y, d.x, s_of_z));
  const V t = hn::IfThenElse(on_y, t_of_y, hn::Neg(d.y));
  const V face = hn::Add(hn::IfThenElse(on_x, zero, hn::IfThenElse(on_y, hn::Set(f, 2.0F), hn::Set(f, 4.0F))),
                         hn::IfThenElse(back, hn::Set(f, 1.0F), zero));
  return {face, s, t, hn::Abs(axis)};
}

// The four texels there in maps with so many texels along a face, for the points from i on.
HWY_INLINE void address(const OnFace& at, hn::Vec<hn::RebindToSigned<D>> size, std::size_t i, Taps& taps) {
  const D f;
  const hn::RebindToSigned<D> n;
  const V texels = hn::ConvertTo(f, size), half = hn::Mul(hn::Set(f, 0.5F), texels);
  const V scale = hn::Div(half, at.axis);
  // In texels of the face with its border; centers are at whole numbers.
  const V middle = hn::Add(half, hn::Set(f, 0.5F));
  const V most = hn::Add(texels, hn::Set(f, 0.999F)), zero = hn::Zero(f);
  const V column = hn::Min(hn::Max(hn::MulAdd(at.s, scale, middle), zero), most);
  const V row = hn::Min(hn::Max(hn::MulAdd(at.t, scale, middle), zero), most);
  const auto i_column = hn::ConvertTo(n, column), i_row = hn::ConvertTo(n, row);
  const auto wide = hn::Add(size, hn::Set(n, 2));
  const auto offset = hn::Add(hn::Mul(hn::Add(hn::Mul(hn::ConvertTo(n, at.face), wide), i_row), wide), i_column);
  hn::Store(offset, n, taps.offset + i);
  const V right = hn::Sub(column, hn::ConvertTo(f, i_column)), lower = hn::Sub(row, hn::ConvertTo(f, i_row));
  const V left = hn::Sub(hn::Set(f, 1.0F), right), both = hn::Mul(right, lower), lower_left = hn::Mul(left, lower);
  hn::Store(hn::Sub(left, lower_left), f, taps.share[0] + i), hn::Store(hn::Sub(right, both), f, taps.share[1] + i);
  hn::Store(lower_left, f, taps.share[2] + i), hn::Store(both, f, taps.share[3] + i);
}
HWY_INLINE void address(const Direction& d, int size, std::size_t i, Taps& taps) {
  address(on_face(d), hn::Set(hn::RebindToSigned<D>(), size), i, taps);
}

// n floats, fours of R G B 0, in as many registers as they need.
template <std::size_t n>
struct Pack {
  using Tag = hn::CappedTag<float, n>;
  static constexpr std::size_t kLanes = hn::MaxLanes(Tag()), kRegisters = n / kLanes;
  hn::Vec<Tag> v[kRegisters];

  static HWY_INLINE Pack load(const float* from) {
    Pack pack;
    for (std::size_t i = 0; i < kRegisters; ++i) pack.v[i] = hn::LoadU(Tag(), from + i * kLanes);
    return pack;
  }
  static HWY_INLINE Pack filled(float value) {
    Pack pack;
    for (std::size_t i = 0; i < kRegisters; ++i) pack.v[i] = hn::Set(Tag(), value);
    return pack;
  }
  HWY_INLINE void store(float* to) const {
    for (std::size_t i = 0; i < kRegisters; ++i) hn::StoreU(v[i], Tag(), to + i * kLanes);
  }
  // One channel of each four, in all of it.
  template <int c>
  HWY_INLINE Pack channel() const {
    Pack pack;
    for (std::size_t i = 0; i < kRegisters; ++i) {
      if constexpr (kLanes > 1) {
        pack.v[i] = hn::Broadcast<c>(v[i]);
      } else {
        pack.v[i] = v[i / 4 * 4 + c];
      }
    }
    return pack;
  }
};
template <std::size_t n>
HWY_INLINE Pack<n> mul_add(const Pack<n>& a, const Pack<n>& b, const Pack<n>& c) {
  Pack<n> pack;
  for (std::size_t i = 0; i < Pack<n>::kRegisters; ++i) pack.v[i] = hn::MulAdd(a.v[i], b.v[i], c.v[i]);
  return pack;
}

// The mirror image of v about n, where c = n.v.
HWY_INLINE Direction mirrored(V c, const Direction& n, const Direction& v) {
  const V two = hn::Add(c, c);
  return {hn::MulSub(two, n.x, v.x), hn::MulSub(two, n.y, v.y), hn::MulSub(two, n.z, v.z)};
}

// brdf's fresnel_dielectric() with the refracted cosine g/n written in c: r_s = (c-g)/(c+g), r_p = (n^2 c-g)/(n^2 c+g).
// `index2` is n^2, above 1.
HWY_INLINE V fresnel_of(V c, float index2) {
  const D f;
  const V n2 = hn::Set(f, index2), g = hn::Sqrt(hn::MulAdd(c, c, hn::Set(f, index2 - 1)));
  const V s = hn::Div(hn::Sub(c, g), hn::Add(c, g)), p = hn::Div(hn::MulSub(n2, c, g), hn::MulAdd(n2, c, g));
  return hn::Mul(hn::Set(f, 0.5F), hn::MulAdd(s, s, hn::Mul(p, p)));
}

using Quad = Pack<4>;  // one R G B 0

// The light of one map at point i, between its four texels.
HWY_INLINE Quad fetched(const SingleMap& map, const Taps& taps, int i) {
  const float* upper = map.texels + 4 * static_cast<std::size_t>(taps.offset[i]);
  const float* lower = upper + 4 * static_cast<std::size_t>(map.size + 2);
  Quad light = mul_add(Quad::filled(taps.share[0][i]), Quad::load(upper), Quad::filled(0));
  light = mul_add(Quad::filled(taps.share[1][i]), Quad::load(upper + 4), light);
  light = mul_add(Quad::filled(taps.share[2][i]), Quad::load(lower), light);
  return mul_add(Quad::filled(taps.share[3][i]), Quad::load(lower + 4), light);
}

// Sums of light times weights. Each channel of the light multiplies by a matrix of its own, which is left for the end.
template <std::size_t n>
struct Products {
  Pack<n> of[3];

  HWY_INLINE Products() {
    for (Pack<n>& sums : of) sums = Pack<n>::filled(0);
  }
  HWY_INLINE void add(const Pack<n>& light, const Pack<n>& weight) {
    of[0] = mul_add(light.template channel<0>(), weight, of[0]);
    of[1] = mul_add(light.template channel<1>(), weight, of[1]);
    of[2] = mul_add(light.template channel<2>(), weight, of[2]);
  }
  // `color` and the color of the sums, by product_columns().
  HWY_INLINE Quad on(Quad color, const float* columns) const {
    for (const Pack<n>& sums : of) {
      float fours[n];
      sums.store(fours);
      Quad sum = Quad::load(fours);
      if constexpr (n > 4) sum = mul_add(Quad::filled(1), Quad::load(fours + 4), sum);
      color = mul_add(sum.template channel<0>(), Quad::load(columns), color);
      color = mul_add(sum.template channel<1>(), Quad::load(columns + 4), color);
      color = mul_add(sum.template channel<2>(), Quad::load(columns + 8), color);
      columns += 12;
    }
    return color;
  }
};

// log(1 + x), from x itself near 0.
HWY_INLINE V log_beside_one(V x) {
  const D f;
  const V one = hn::Set(f, 1.0F);
  const V series = hn::Mul(
      x, hn::NegMulAdd(
             x, hn::NegMulAdd(x, hn::NegMulAdd(x, hn::Set(f, 0.25F), hn::Set(f, 0.33333333F)), hn::Set(f, 0.5F)), one));
  const V direct = hn::Log(f, hn::Max(hn::Add(one, x), hn::Set(f, 1e-30F)));
  return hn::IfThenElse(hn::Lt(hn::Abs(x), hn::Set(f, 0.02F)), series, direct);
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#endif  // GONIOCHROME_RENDER_CUBE_LOOKUP_INL_H_
