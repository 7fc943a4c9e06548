#include "render/path/open_residual.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "render/internal/coat_stretch.h"
#include "render/internal/wear.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

// The part of the tolerance that the blocks of a sum take.
constexpr double kOfSums = 0.2;
// Beyond so many sums those of other views are forgotten, and beyond so many surfaces those of other paints.
constexpr std::size_t kMostSums = std::size_t{1} << 19, kMostSurfaces = 64;

bool is_narrow(const paint::Lobe& lobe) {
  return !(lobe.exponent <= kWidestShared);
}

// Calls visit(diffuse, lobes) for the weights of a paint, and for those at each of its views.
template <class Visit>
void for_weights(paint::LobeFit& paint, const Visit& visit) {
  visit(paint.diffuse, paint.lobes);
  for (paint::ViewLobes& view : paint.views) visit(view.diffuse, view.lobes);
}

// The part of a paint that is summed.
paint::LobeFit summed(const Scene& scene, const Effects& effects, std::size_t part, bool brushed, bool stretched) {
  const bool covered = scene.layer != nullptr &&
                       (!scene.layer->surface(static_cast<int>(part)).textures.empty() || is_mapped(scene, part));
  if (brushed || covered || !scene.paints[part].tilts.empty()) return {};
  paint::LobeFit paint = with_effects(scene.paints[part], effects);
  const auto strip = [&](std::vector<paint::Lobe>& lobes) {
    std::erase_if(lobes, is_narrow);
    for (paint::Lobe& lobe : lobes)
      if (stretched) lobe.gloss = {};
  };
  strip(paint.lobes);
  for (paint::ViewLobes& view : paint.views) strip(view.lobes);
  return paint;
}

}  // namespace

const OpenResidual::Wear* OpenResidual::wear_of(int part) const {
  const std::int32_t wear = part < 0 ? kNone : wear_of_part_[static_cast<std::size_t>(part)];
  return wear == kNone ? nullptr : &wears_[static_cast<std::size_t>(wear)];
}

std::size_t OpenResidual::surface_of(double coat_index) {
  const auto found = std::ranges::find(surfaces_, coat_index, &Surface::coat_index);
  if (found != surfaces_.end()) return static_cast<std::size_t>(found - surfaces_.begin());
  surfaces_.push_back({coat_index, std::make_unique<NodeValues>(grid_, floats())});
  return surfaces_.size() - 1;
}

Result<void> OpenResidual::load(const Scene& scene, const Effects& effects, const CpuEngine* loaded) {
  LobeColumns columns;
  for (const envmap::PrefilteredLobe& lobe : scene.env->lobes)
    if (lobe.exponent <= kWidestShared) columns.exponents.push_back(lobe.exponent);
  if (effects.tolerance_de00 != tolerance_de00_ || columns != columns_) {
    tolerance_de00_ = effects.tolerance_de00, columns_ = columns;
    grid_ = ViewGrid::within(tolerance_de00_);
    light_ = std::make_unique<SummedLight>(*tree_, kOfSums * tolerance_de00_, columns_);
    surfaces_.clear();
  }
  loaded_ = effects_ = effects;
  effects_.mirror = effects_.satin = effects_.stretch = effects_.extent = effects_.placed = effects_.panes = false;
  effects_.texture = effects_.texture_filter = effects_.maps = effects_.image_maps = false;
  effects_.tilt_level = 0, effects_.lights = 0, effects_.background = Background::kNone, effects_.rays = {};
  GONIO_TRY(set_paints(scene));
  if (loaded != nullptr) engine_.share_maps(*loaded);
  return engine_.load(scene_, effects_);
}

Result<void> OpenResidual::load_paints(const Scene& scene) {
  GONIO_TRY(set_paints(scene));
  engine_.load_paints(scene_, effects_);
  return {};
}

Result<void> OpenResidual::set_paints(const Scene& scene) {
  const std::vector<bool> stretched = stretched_parts(scene, loaded_);
  const auto tilts = tilts_of(scene, loaded_);
  scene_ = scene;
  scene_.lights.clear(), scene_.layer = nullptr, scene_.panes.clear();
  for (std::size_t part = 0; part < scene.paints.size(); ++part)
    scene_.paints[part] = summed(scene, effects_, part, effects_.anisotropy && tilts[part].size() > 1, stretched[part]);
  wears_.clear(), wear_of_part_.clear();
  if (surfaces_.size() > kMostSurfaces) surfaces_.clear();
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    const paint::LobeFit& paint = scene_.paints[part];
    wear_of_part_.push_back(kNone);
    if (paint.diffuse == color::Rgb{} && paint.lobes.empty() && paint.views.empty()) continue;
    const auto same = std::ranges::find_if(
        wears_, [&](const Wear& wear) { return same_wear(scene_, static_cast<std::size_t>(wear.part), part); });
    wear_of_part_.back() = static_cast<std::int32_t>(same - wears_.begin());
    if (same != wears_.end()) continue;
    GONIO_ASSIGN(TransportPaint weights, transport_paint(columns_, paint, gloss_deg_of(scene, part)));
    wears_.push_back({surface_of(paint.coat_index), static_cast<int>(part), std::move(weights),
                      std::make_unique<NodeValues>(grid_, 3)});
  }
  return {};
}

std::size_t OpenResidual::count() const {
  std::size_t count = 0;
  for (const Surface& surface : surfaces_) count += surface.sums->found();
  return count;
}

void OpenResidual::forget() {
  if (count() <= kMostSums) return;
  for (Surface& surface : surfaces_) surface.sums = std::make_unique<NodeValues>(grid_, floats());
  for (Wear& wear : wears_) wear.residual = std::make_unique<NodeValues>(grid_, 3);
}

void OpenResidual::sum(const Surface& surface, const ViewGrid::Facing& at, float* sums) const {
  const LobeAxis mirrored{2 * dot(at.normal, at.to_viewer) * at.normal - at.to_viewer, 1};
  std::vector<color::Rgb> light(columns_.count());
  light_->at(at.normal, at.to_viewer, {mirrored}, surface.coat_index, light.data());
  for (std::size_t k = 0; k < floats(); ++k) sums[k] = static_cast<float>(light[k / 3][static_cast<int>(k % 3)]);
}

// The light of sums, in the weights that the paint has at this view.
color::Rgb OpenResidual::shown(const TransportPaint& paint, const float* sums, double cos_o) const {
  const double view_deg = std::acos(std::clamp(cos_o, 0.0, 1.0)) / kDegree;
  const auto above = std::ranges::upper_bound(paint.view_deg, view_deg) - paint.view_deg.begin();
  const auto high = std::min(static_cast<std::size_t>(above), paint.weights.size() - 1);
  const std::size_t low = high > 0 && above > 0 ? static_cast<std::size_t>(above) - 1 : 0;
  const double from = paint.view_deg[low], to = paint.view_deg[high];
  const double share = to > from ? (view_deg - from) / (to - from) : 0;
  color::Rgb radiance;
  for (std::size_t k = 0; k < floats() / 3; ++k) {
    const color::Rgb weight = paint.weights[low][k] + share * (paint.weights[high][k] - paint.weights[low][k]);
    const color::Rgb light = vec3(sums + 3 * k);
    radiance += effects_.reflection ? color::reflected(scene_.reflection, weight, light) : weight * light;
  }
  return radiance;
}

color::Rgb OpenResidual::told(const Wear& wear, const Vec3& normal, const Vec3& to_viewer) const {
  const Surface& surface = surfaces_[wear.surface];
  const ViewGrid::Place place = grid_.place(normal, to_viewer);
  float residual[3] = {};
  wear.residual->add(
      place,
      [&](const ViewGrid::Node& node, float* numbers) {
        const ViewGrid::Facing at = grid_.facing(node);
        const float* sums = surface.sums->at(node, [&](const ViewGrid::Node&, float* of) { sum(surface, at, of); });
        const color::Rgb missed =
            shown(wear.paint, sums, dot(at.normal, at.to_viewer)) -
            engine_.colors({{.normal = at.normal, .to_viewer = at.to_viewer, .part = wear.part}})[0];
        for (int c = 0; c < 3; ++c) numbers[c] = static_cast<float>(missed[c]);
      },
      residual);
  return vec3(residual);
}

void OpenResidual::add(const Gbuffer& seen, float gain, image::Image& picture) {
  forget();
  for_pixels(seen.width, seen.height, [&](int x, int y) {
    const Wear* wear = wear_of(seen.part(x, y));
    if (wear == nullptr || !seen.wants(x, y)) return;
    const color::Rgb more = told(*wear, seen.normal(x, y), seen.to_viewer(x, y));
    for (int c = 0; c < 3; ++c) picture.pixel(x, y)[c] += gain * static_cast<float>(more[c]);
  });
}

std::vector<color::Rgb> OpenResidual::at(const std::vector<VisiblePoint>& points) {
  forget();
  std::vector<color::Rgb> residual(points.size());
  parallel_each(points.size(), 16, [&](std::size_t i) {
    if (const Wear* wear = wear_of(points[i].part); wear != nullptr)
      residual[i] = told(*wear, points[i].normal, points[i].to_viewer);
  });
  return residual;
}

}  // namespace goniochrome::render
