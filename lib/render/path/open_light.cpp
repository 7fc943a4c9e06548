#include "render/path/open_light.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/lobe_model.h"
#include "render/spots.h"

namespace goniochrome::render {

namespace {

// Light off the coat has its reflectance in it, relative to nothing.
std::vector<paint::LobeFit> unit_paints(const LobeColumns& columns, double coat_index) {
  const color::Rgb one{1, 1, 1};
  const double reflectance = brdf::fresnel_dielectric(std::cos(brdf::kGlossIncidence_deg * kDegree), brdf::kCoatIndex);
  paint::LobeFit blank;
  blank.coat_index = coat_index;
  for (const double exponent : columns.exponents) blank.lobes.push_back({exponent, {}, {}});
  blank.lobes.push_back({paint::kMirrorExponent, {}, {}});
  std::vector<paint::LobeFit> paints(columns.count(), blank);
  paints.front().diffuse = one;
  for (std::size_t j = 0; j < columns.exponents.size(); ++j) {
    paints[LobeColumns::flake(j)].lobes[j].directional_diffuse = one;
    paints[LobeColumns::gloss(j)].lobes[j].gloss = reflectance * one;
  }
  paints.back().lobes.back().gloss = one;
  return paints;
}

}  // namespace

Result<OpenLight> OpenLight::create(const envmap::PrefilteredEnvironment& env, const LobeColumns& columns,
                                    std::vector<std::vector<brdf::Tilt>> tilts, std::vector<double> coats) {
  OpenLight open;
  open.env_ = &env, open.columns_ = columns, open.tilts_ = std::move(tilts), open.coats_ = std::move(coats);
  for (const double exponent : columns.exponents) {
    const envmap::PrefilteredLobe* lobe = env.lobe(exponent);
    if (lobe == nullptr)
      return input_error("the environment has no lobe of exponent {}, which a transport of this basis needs",
                         shortest(exponent));
    open.lobes_.push_back(envmap::open_map(env, *lobe, env.spots.size()));
  }
  if (env.diffuse.map.size == 0 || env.mirror.map.size == 0)
    return input_error(
        "the environment has no {} part, which a transport needs: make it with a basis that holds "
        "<mirror/>, by prefilter-envmap",
        env.diffuse.map.size == 0 ? "diffuse" : "mirror");
  std::vector<double> different = open.coats_;
  different.push_back(paint::kNoCoat);
  for (const double coat_index : different) {
    if (open.weights_.contains(coat_index)) continue;
    Scene scene;
    scene.paints = unit_paints(columns, coat_index);
    scene.env = &env;
    scene.gloss_deg.assign(scene.paints.size(), brdf::kGlossIncidence_deg);
    Effects effects = effects_of(scene);
    effects.fresnel = effects.horizon = effects.mirror = true;
    open.weights_.emplace(coat_index, UnitWeights(scene, effects, columns.exponents, coat_index));
  }
  open.diffuse_ = envmap::open_diffuse_map(env, env.spots.size());
  if (open.weights_.size() > 1) open.coat_diffuse_ = envmap::open_coat_diffuse_map(env, env.spots.size());
  for (const envmap::Spot& spot : env.spots) open.spots_.push_back(open.weights_.begin()->second.disc(light_of(spot)));
  return open;
}

// A brushed surface gathers the mean over its tilted normals, as the engines have it.
void OpenLight::at(const Vec3& n, const Vec3& to_viewer, int part, color::Rgb* light) const {
  const double cos_o = std::clamp(dot(n, to_viewer), 0.0, 1.0);
  const auto p = static_cast<std::size_t>(part);
  const UnitWeights& weights = weights_.at(p < coats_.size() ? coats_[p] : paint::kNoCoat);
  const WeightTable& table = weights.table();
  std::fill_n(light, columns_.count(), color::Rgb{});
  const bool bare = &weights == &weights_.at(paint::kNoCoat);
  light[0] = weights.at(0, weights.diffuse_slot(), cos_o) * envmap::bilinear(bare ? *diffuse_ : *coat_diffuse_, n);
  for (const UnitWeights::Disc& spot : spots_) weights.add_diffuse(spot, n, cos_o, 1, light);
  const auto add_lobes = [&](const Vec3& mirrored, double share) {
    for (std::size_t k = 1; k < columns_.mirror(); ++k) {
      const std::size_t lobe = (k - 1) / 2;
      const double shift = weights.at(k, table.shift_slot(lobe), cos_o, static_cast<int>(lobe % 4));
      light[k] += share * weights.at(k, WeightTable::lobe_slot(lobe), cos_o) *
                  envmap::bilinear(*lobes_[lobe], mirrored + shift * n);
    }
    for (const UnitWeights::Disc& spot : spots_) weights.add_lobes(spot, n, to_viewer, mirrored, share, light);
  };
  const Vec3 mirrored = 2 * dot(n, to_viewer) * n - to_viewer;
  if (p >= tilts_.size() || tilts_[p].size() <= 1) {
    add_lobes(mirrored, 1);
  } else {
    const double level2 = n.x * n.x + n.z * n.z;
    const Vec3 x = level2 > 1e-12 ? normalized({n.z, 0, -n.x}) : Vec3{1, 0, 0}, y = cross(n, x);
    for (const brdf::Tilt& tilt : tilts_[p]) {
      const Vec3 m = tilt.normal.x * x + tilt.normal.y * y + tilt.normal.z * n;
      const Vec3 r = 2 * dot(m, to_viewer) * m - to_viewer;
      if (dot(m, to_viewer) > 0 && dot(r, n) > 0) add_lobes(r, tilt.weight);
    }
  }
  const std::size_t last = columns_.mirror();
  light[last] = weights.at(last, table.mirror_slot(), cos_o) * envmap::bilinear(env_->mirror.map, mirrored);
}

}  // namespace goniochrome::render
