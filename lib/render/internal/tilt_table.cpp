#include "render/internal/tilt_table.h"

#include <algorithm>
#include <set>

#include "base/angles.h"
#include "brdf/tilted_lobes.h"
#include "math/elementary.h"
#include "render/internal/coat_stretch.h"
#include "render/internal/wear.h"

namespace goniochrome::render {

namespace {

// A set at one view.
struct Node {
  paint::TiltedView view;
  std::vector<brdf::AxisSum> axes;
};
Node node_at(const paint::TiltedLobes& set, double cos_o) {
  const double view_deg = math::acos(std::clamp(cos_o, 0.0, 1.0)) / kDegree;
  Node node{brdf::at_view(set, view_deg), {}};
  for (const paint::TiltedLobe& lobe : set.lobes) node.axes.push_back(brdf::axis_sum(lobe, view_deg));
  return node;
}

// The look-up of a lobe between two views, on one side of the plane of incidence, with a share of its weight.
TiltLookup lookup_of(std::size_t map, const Node& low, const Node& high, std::size_t lobe, double side, double share) {
  const auto axis = [&](const Node& node) {
    const brdf::AxisSum& sum = node.axes[lobe];
    return Vec3{sum.a, sum.s, side * sum.c};
  };
  const Vec3 from = axis(low), to = axis(high);
  const color::Rgb weight = share * low.view.weights[lobe], last = share * high.view.weights[lobe];
  return {map, floats(from), floats(to - from), floats(weight), floats(last - weight)};
}

std::vector<TiltLookup> row_of(const paint::TiltedLobes& set, const std::vector<double>& exponents, const Node& low,
                               const Node& high) {
  std::vector<TiltLookup> row;
  for (std::size_t lobe = 0; lobe < set.lobes.size(); ++lobe) {
    if (low.view.weights[lobe] == color::Rgb{} && high.view.weights[lobe] == color::Rgb{}) continue;
    const auto found = std::ranges::find(exponents, set.lobes[lobe].exponent);
    if (found == exponents.end()) continue;
    const auto map = static_cast<std::size_t>(found - exponents.begin());
    const bool pair = set.lobes[lobe].out_deg != 0;
    row.push_back(lookup_of(map, low, high, lobe, 1, pair ? 0.5 : 1));
    if (pair) row.push_back(lookup_of(map, low, high, lobe, -1, 0.5));
  }
  std::ranges::stable_sort(row, {}, &TiltLookup::map);
  return row;
}

const paint::TiltedLobes* set_of(const paint::LobeFit& paint, int level) {
  if (level <= 0 || paint.tilts.empty()) return nullptr;
  return &paint.tilts[std::min(paint.tilts.size(), static_cast<std::size_t>(level)) - 1];
}

}  // namespace

const paint::TiltedLobes* drawn_tilts(const paint::LobeFit& paint, const Effects& effects) {
  return effects.environment ? set_of(paint, effects.tilt_level) : nullptr;
}

std::vector<double> tilt_exponents(const Scene& scene, const Effects& effects) {
  std::set<double> exponents;
  if (!effects.environment) return {};
  // Any paint that is loaded later may have a rough coat of the same lobes.
  for (const Effects::LobeUse& use : effects.lobes)
    if (effects.stretch && use.gloss) exponents.insert(use.exponent);
  if (effects.tilt_level <= 0) return {exponents.begin(), exponents.end()};
  for (const paint::LobeFit& paint : scene.paints) {
    for (const paint::TiltedLobes& set : paint.tilts)
      for (const paint::TiltedLobe& lobe : set.lobes) exponents.insert(lobe.exponent);
  }
  return {exponents.begin(), exponents.end()};
}

// The ends of the segments are even in the root of the cosine, as those of the table of weights.
TiltTable tilt_table(const Scene& scene, const Effects& effects, const std::vector<double>& exponents) {
  TiltTable table;
  std::vector<std::size_t> first;  // part of each group
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    const auto same = std::ranges::find_if(first, [&](std::size_t other) { return same_wear(scene, other, part); });
    table.group_of_part.push_back(static_cast<int>(same - first.begin()));
    if (same != first.end()) continue;
    first.push_back(part);
    const auto stretch = drawn_stretch(scene, effects, part);
    const paint::TiltedLobes* set = stretch ? stretch.get() : drawn_tilts(scene.paints[part], effects);
    if (set == nullptr) {
      table.rows.resize(table.rows.size() + std::size_t{kViewSegments});
      continue;
    }
    Node low = node_at(*set, 0);
    for (int segment = 0; segment < kViewSegments; ++segment) {
      const double x = (segment + 1.0) / kViewSegments;
      Node high = node_at(*set, x * x);
      table.rows.push_back(row_of(*set, exponents, low, high));
      low = std::move(high);
    }
  }
  return table;
}

void leave_to_tilts(const Scene& scene, Effects& effects) {
  if (effects.tilt_level <= 0 || !effects.environment || effects.lights > 0) return;
  for (Effects::LobeUse& use : effects.lobes) {
    use.directional_diffuse =
        use.directional_diffuse && std::ranges::any_of(scene.paints, [&](const paint::LobeFit& paint) {
          return wears_lobe(paint, use.exponent, LobeWeight::kDirectionalDiffuse) &&
                 drawn_tilts(paint, effects) == nullptr;
        });
  }
  std::erase_if(effects.lobes, [](const Effects::LobeUse& use) { return !use.directional_diffuse && !use.gloss; });
  effects.horizon = effects.horizon && !effects.lobes.empty();
  if (!effects.horizon) effects.spots = 0;
  effects.anisotropy = effects.anisotropy && !effects.lobes.empty();
}

}  // namespace goniochrome::render
