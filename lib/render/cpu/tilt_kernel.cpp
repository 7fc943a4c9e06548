#include "render/cpu/tilt_kernel.h"

#include <algorithm>
#include <array>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "render/cpu/tilt_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// After highway.h:
#include "render/cpu/cube_lookup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace goniochrome::render {
namespace HWY_NAMESPACE {

// One point: what it sees by, and where it is in its row.
struct TiltPoint {
  float r[3], n[3], q[3];  // mirror direction, normal, n x o
  float t;
  std::size_t first, end;  // look-ups
};

HWY_INLINE TiltPoint tilt_point(const TiltShading& s, const PointArrays& p, int i) {
  TiltPoint point;
  const float n[3] = {p.nx[i], p.ny[i], p.nz[i]}, v[3] = {p.vx[i], p.vy[i], p.vz[i]};
  const float c = n[0] * v[0] + n[1] * v[1] + n[2] * v[2];
  for (int k = 0; k < 3; ++k) {
    const int x = (k + 1) % 3, y = (k + 2) % 3;
    point.n[k] = n[k];
    point.r[k] = 2 * c * n[k] - v[k];
    point.q[k] = n[x] * v[y] - n[y] * v[x];
  }
  const float at = static_cast<float>(s.segments) * std::sqrt(c > 0 ? c : 0);
  const int segment = std::min(static_cast<int>(at), s.segments - 1);
  point.t = at - static_cast<float>(segment);
  const std::uint32_t* row = s.rows + s.groups[p.part[i]] * s.segments + segment;
  point.first = row[0], point.end = row[1];
  return point;
}

// The texels of the look-ups of one group, for the lanes from `lane` on.
HWY_INLINE void tilt_address(const TiltShading& s, const TiltPoint& p, std::size_t group, std::size_t lane,
                             Taps& taps) {
  const D f;
  const hn::RebindToSigned<D> whole;
  const float* axes = s.axes + 6 * group + lane;
  const V t = hn::Set(f, p.t);
  const auto axis = [&](std::size_t which) HWY_ATTR {
    return hn::MulAdd(t, hn::LoadU(f, axes + (which + 3) * kTiltLanes), hn::LoadU(f, axes + which * kTiltLanes));
  };
  const V a = axis(0), b = axis(1), c = axis(2);
  const auto along = [&](int k) HWY_ATTR {
    return hn::MulAdd(a, hn::Set(f, p.r[k]), hn::MulAdd(b, hn::Set(f, p.n[k]), hn::Mul(c, hn::Set(f, p.q[k]))));
  };
  const Direction d = {along(0), along(1), along(2)};
  const std::int32_t* places = s.places + 2 * group + lane;
  address(on_face(d), hn::LoadU(whole, places), lane, taps);
  const auto first = hn::LoadU(whole, places + kTiltLanes);
  hn::Store(hn::Add(hn::Load(whole, taps.offset + lane), first), whole, taps.offset + lane);
}

HWY_INLINE void add_point(const TiltShading& s, const TiltPoint& p, float* rgba) {
  const D f;
  Taps taps;
  Products<4> sums;
  const Quad t = Quad::filled(p.t);
  for (std::size_t group = p.first; group < p.end; group += kTiltLanes) {
    for (std::size_t lane = 0; lane < kTiltLanes; lane += hn::Lanes(f)) tilt_address(s, p, group, lane, taps);
    for (std::size_t lane = 0; lane < kTiltLanes; ++lane) {
      const std::int32_t size = s.places[2 * group + lane];
      if (size == 0) break;  // the rest is padding
      const float* weight = s.weights + 8 * (group + lane);
      const Quad light = fetched({size, s.texels}, taps, static_cast<int>(lane));
      sums.add(light, mul_add(t, Quad::load(weight + 4), Quad::load(weight)));
    }
  }
  sums.on(Quad::load(rgba), s.product).store(rgba);
}

void AddTilted(const TiltShading& s, const PointArrays& points, int count, float* rgba) {
  for (int i = 0; i < count; ++i) {
    const TiltPoint point = tilt_point(s, points, i);
    if (point.first != point.end) add_point(s, point, rgba + 4 * i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::render
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::render {

HWY_EXPORT(AddTilted);

void add_tilted(const TiltShading& shading, const PointArrays& points, int count, float* rgba) {
  HWY_DYNAMIC_DISPATCH(AddTilted)(shading, points, count, rgba);
}

void TiltStore::load(const envmap::PrefilteredEnvironment& env, const std::vector<double>& exponents) {
  exponents_ = exponents;
  sizes_.clear(), firsts_.clear(), texels_.clear();
  for (const double exponent : exponents) {
    const envmap::CubeMap& map = env.lobe(exponent)->map;
    sizes_.push_back(map.size);
    firsts_.push_back(static_cast<std::int32_t>(texels_.size() / 4));
    const std::size_t from = texels_.size();
    texels_.resize(from + 4 * bordered_texels(map.size));
    put_bordered(map, 4, &texels_[from]);
  }
}

void TiltStore::load_paints(const Scene& scene, const Effects& effects) {
  axes_.clear(), weights_.clear(), places_.clear(), rows_ = {0};
  any_ = false;
  if (exponents_.empty()) return;
  const TiltTable table = tilt_table(scene, effects, exponents_);
  groups_.assign(table.group_of_part.begin(), table.group_of_part.end());
  for (const std::vector<TiltLookup>& row : table.rows) {
    const std::size_t first = rows_.back(), end = first + (row.size() + kTiltLanes - 1) / kTiltLanes * kTiltLanes;
    axes_.resize(6 * end, 0.0F), places_.resize(2 * end, 0), weights_.resize(8 * end, 0.0F);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const TiltLookup& of = row[i];
      const std::size_t at = first + i, group = at / kTiltLanes * kTiltLanes, lane = at % kTiltLanes;
      for (std::size_t k = 0; k < 3; ++k) {
        axes_[6 * group + k * kTiltLanes + lane] = of.axis[k];
        axes_[6 * group + (k + 3) * kTiltLanes + lane] = of.axis_step[k];
      }
      places_[2 * group + lane] = sizes_[of.map];
      places_[2 * group + kTiltLanes + lane] = firsts_[of.map];
      std::ranges::copy(of.weight, &weights_[8 * at]), std::ranges::copy(of.weight_step, &weights_[8 * at + 4]);
    }
    any_ = any_ || !row.empty();
    rows_.push_back(static_cast<std::uint32_t>(end));
  }
}

TiltShading TiltStore::shading(const float* product) const {
  if (!any_) return {};
  return {kViewSegments,  groups_.data(),  rows_.data(),   axes_.data(),
          places_.data(), weights_.data(), texels_.data(), product};
}

}  // namespace goniochrome::render
#endif
