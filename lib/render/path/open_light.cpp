#include "render/path/open_light.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/text.h"
#include "brdf/lobe_model.h"
#include "render/internal/seen.h"
#include "render/scene_effects.h"
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
    open.maps_.push_back(open.lobes_.back().get());
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

void OpenLight::sum(const envmap::BlockTree& tree, double tolerance_de00) {
  summed_.emplace(tree, tolerance_de00, columns_);
}

// A brushed surface gathers the mean over its tilted normals, as the engines have it.
std::vector<LobeAxis> OpenLight::axes(const OpenView& view, int part) const {
  const auto& [n, to_viewer] = view;
  const auto p = static_cast<std::size_t>(part);
  if (p >= tilts_.size() || tilts_[p].size() <= 1) return {{2 * dot(n, to_viewer) * n - to_viewer, 1}};
  const double level2 = n.x * n.x + n.z * n.z;
  const Vec3 x = level2 > 1e-12 ? normalized({n.z, 0, -n.x}) : Vec3{1, 0, 0}, y = cross(n, x);
  std::vector<LobeAxis> axes;
  for (const brdf::Tilt& tilt : tilts_[p]) {
    const Vec3 m = tilt.normal.x * x + tilt.normal.y * y + tilt.normal.z * n;
    const Vec3 r = 2 * dot(m, to_viewer) * m - to_viewer;
    if (dot(m, to_viewer) > 0 && dot(r, n) > 0) axes.push_back({r, tilt.weight});
  }
  return axes;
}

double OpenLight::coat_of(int part) const {
  const auto p = static_cast<std::size_t>(part);
  return p < coats_.size() ? coats_[p] : paint::kNoCoat;
}

// By the maps and the bright spots, whatever is summed.
void OpenLight::look_up(const OpenView& view, int part, color::Rgb* light) const {
  const auto& [n, to_viewer] = view;
  const double cos_o = std::clamp(dot(n, to_viewer), 0.0, 1.0), coat_index = coat_of(part);
  const UnitWeights& weights = weights_.at(coat_index);
  std::fill_n(light, columns_.count(), color::Rgb{});
  const color::Rgb at_normal = envmap::bilinear(coat_index == paint::kNoCoat ? *diffuse_ : *coat_diffuse_, n);
  weights.add_diffuse(at_normal, cos_o, 1, light);
  for (const UnitWeights::Disc& spot : spots_) weights.add_diffuse(spot, n, cos_o, 1, light);
  for (const LobeAxis& axis : axes(view, part)) {
    weights.add_lobes(maps_, at_normal, n, axis.direction, cos_o, axis.share, light);
    for (const UnitWeights::Disc& spot : spots_)
      weights.add_lobes(spot, n, to_viewer, axis.direction, axis.share, light);
  }
  light[columns_.mirror()] = mirror(view, part);
}

color::Rgb OpenLight::mirror(const OpenView& view, int part) const {
  const auto& [n, to_viewer] = view;
  const UnitWeights& weights = weights_.at(coat_of(part));
  return weights.at(columns_.mirror(), weights.table().mirror_slot(), std::clamp(dot(n, to_viewer), 0.0, 1.0)) *
         envmap::bilinear(env_->mirror.map, 2 * dot(n, to_viewer) * n - to_viewer);
}

void OpenLight::at(const Vec3& n, const Vec3& to_viewer, int part, color::Rgb* light) const {
  look_up({n, to_viewer}, part, light);
  if (summed_) summed_->at(n, to_viewer, axes({n, to_viewer}, part), coat_of(part), light);
}

void OpenLight::mean(const std::vector<OpenView>& views, int part, color::Rgb* light) const {
  std::fill_n(light, columns_.count(), color::Rgb{});
  std::vector<color::Rgb> here(columns_.count()), summed;
  for (const OpenView& view : views) {
    look_up(view, part, here.data());
    if (summed_ && summed.empty()) {
      summed = here;
      summed_->at(view.normal, view.to_viewer, axes(view, part), coat_of(part), summed.data());
      for (std::size_t k = 0; k < here.size(); ++k) light[k] += summed[k] - here[k];
    }
    for (std::size_t k = 0; k < here.size(); ++k) light[k] += (1.0 / static_cast<double>(views.size())) * here[k];
  }
}

// Each column in the gray paint that its noise is judged by.
double open_difference_de00(const OpenLight& a, const OpenLight& b, const LobeColumns& columns,
                            const std::vector<VisiblePoint>& points, double white_luminance) {
  std::vector<double> worst(points.size());
  parallel_for(points.size(), 4, [&](std::size_t begin, std::size_t end) {
    std::vector<color::Rgb> of_a(columns.count()), of_b(columns.count());
    for (std::size_t i = begin; i < end; ++i) {
      const VisiblePoint& point = points[i];
      a.at(point.normal, point.to_viewer, point.part, of_a.data());
      b.at(point.normal, point.to_viewer, point.part, of_b.data());
      for (std::size_t k = 0; k < columns.count(); ++k) {
        const double weight = nominal_weight(columns, k), gray = columns.is_gloss(k) ? kNominalGray / kPi : 0;
        worst[i] = std::max(worst[i], seen_difference(weight * of_a[k] + gray * of_a[0],
                                                      weight * of_b[k] + gray * of_b[0], white_luminance));
      }
    }
  });
  return percentile_95(std::move(worst));
}

}  // namespace goniochrome::render
