#include "render/path/open_light.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/text.h"
#include "brdf/lobe_model.h"
#include "render/internal/seen.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

namespace {

// Light off the coat has its reflectance in it, relative to nothing.
void add_unit_paints(const LobeColumns& columns, double coat_index, bool mirror, std::vector<paint::LobeFit>& paints) {
  const color::Rgb one{1, 1, 1};
  const double reflectance = brdf::fresnel_dielectric(std::cos(brdf::kGlossIncidence_deg * kDegree), brdf::kCoatIndex);
  paint::LobeFit blank;
  blank.coat_index = coat_index;
  for (const double exponent : columns.exponents) blank.lobes.push_back({exponent, {}, {}});
  if (mirror) blank.lobes.push_back({paint::kMirrorExponent, {}, {}});
  const std::size_t first = paints.size();
  paints.resize(first + columns.count(), blank);
  paints[first].diffuse = one;
  for (std::size_t j = 0; j < columns.exponents.size(); ++j) {
    paints[first + LobeColumns::flake(j)].lobes[j].directional_diffuse = one;
    paints[first + LobeColumns::gloss(j)].lobes[j].gloss = reflectance * one;
  }
  if (mirror) paints.back().lobes.back().gloss = one;
}

Result<void> has_maps(const envmap::PrefilteredEnvironment& env, const LobeColumns& columns, bool mirror) {
  for (const double exponent : columns.exponents)
    if (env.lobe(exponent) == nullptr)
      return input_error("the environment has no lobe of exponent {}, which a transport of this basis needs",
                         shortest(exponent));
  if (env.diffuse.map.size == 0 || (mirror && env.mirror.map.size == 0))
    return input_error(
        "the environment has no {} part, which a transport needs: make it with a basis that holds "
        "<mirror/>, by prefilter-envmap",
        env.diffuse.map.size == 0 ? "diffuse" : "mirror");
  return {};
}

}  // namespace

Result<OpenLight> OpenLight::create(const Scene& scene, const LobeColumns& columns, const std::vector<double>& coats,
                                    const OpenEffects& effects) {
  if (scene.env != nullptr) GONIO_TRY(has_maps(*scene.env, columns, effects.mirror));
  OpenLight open;
  open.columns_ = columns;
  open.surfaces_.emplace_back();
  for (std::size_t part = 0; part < std::max(coats.size(), scene.anisotropy.size()); ++part) {
    Surface surface;
    if (part < coats.size()) surface.coat_index = coats[part];
    if (part < scene.anisotropy.size()) surface.brushed = scene.anisotropy[part];
    const auto same = std::ranges::find_if(open.surfaces_, [&](const Surface& other) {
      return other.coat_index == surface.coat_index && other.brushed == surface.brushed;
    });
    open.of_parts_.push_back(static_cast<std::size_t>(same - open.surfaces_.begin()));
    if (same == open.surfaces_.end()) open.surfaces_.push_back(surface);
  }
  Scene units;
  units.env = scene.env, units.lights = scene.lights;
  for (Light& lamp : units.lights) lamp.mirrored = false;
  units.tilt_error = scene.tilt_error, units.most_tilts = scene.most_tilts;
  for (const Surface& surface : open.surfaces_) {
    add_unit_paints(columns, surface.coat_index, effects.mirror, units.paints);
    units.anisotropy.resize(units.paints.size(), surface.brushed);
  }
  units.gloss_deg.assign(units.paints.size(), brdf::kGlossIncidence_deg);
  Effects drawn = effects_of(units);
  drawn.fresnel = effects.fresnel, drawn.horizon = drawn.environment && effects.horizon;
  if (!effects.spots) drawn.spots = 0;
  open.engine_ = std::make_shared<CpuEngine>();
  GONIO_TRY(open.engine_->load(units, drawn));
  for (std::size_t s = 0; s < open.surfaces_.size(); ++s)
    open.surfaces_[s].tilts = tilts_of(units, drawn, s * columns.count()).tilts;
  return open;
}

void OpenLight::sum(const envmap::BlockTree& tree, double tolerance_de00) {
  summed_.emplace(tree, tolerance_de00, columns_);
  grid_ = ViewGrid::within(2 * tolerance_de00);  // Between nodes as much may be added as blocks err by.
  for (Surface& surface : surfaces_)
    if (surface.tilts.size() <= 1) surface.missed = std::make_shared<const NodeValues>(grid_, 3 * summed_->count());
}

std::size_t OpenLight::surface_of(int part) const {
  const auto p = static_cast<std::size_t>(part);
  return p < of_parts_.size() ? of_parts_[p] : 0;
}

// A brushed surface gathers the mean over its tilted normals, as the engines have it.
std::vector<LobeAxis> OpenLight::axes(const OpenView& view, const Surface& surface) {
  const auto& [n, to_viewer] = view;
  if (surface.tilts.size() <= 1) return {{2 * dot(n, to_viewer) * n - to_viewer, 1}};
  const double level2 = n.x * n.x + n.z * n.z;
  const Vec3 x = level2 > 1e-12 ? normalized({n.z, 0, -n.x}) : Vec3{1, 0, 0}, y = cross(n, x);
  std::vector<LobeAxis> axes;
  for (const brdf::Tilt& tilt : surface.tilts) {
    const Vec3 m = tilt.normal.x * x + tilt.normal.y * y + tilt.normal.z * n;
    const Vec3 r = 2 * dot(m, to_viewer) * m - to_viewer;
    if (dot(m, to_viewer) > 0 && dot(r, n) > 0) axes.push_back({r, tilt.weight});
  }
  return axes;
}

void OpenLight::look_up(const std::vector<VisiblePoint>& points, color::Rgb* light) const {
  const std::size_t count = columns_.count();
  std::vector<VisiblePoint> units;
  for (const VisiblePoint& point : points)
    units.push_back({.normal = point.normal,
                     .to_viewer = point.to_viewer,
                     .part = static_cast<int>(surface_of(point.part) * count)});
  const std::vector<color::Rgb> seen = engine_->colors(units, count);
  for (std::size_t i = 0; i < seen.size(); ++i) light[i % points.size() * count + i / points.size()] = seen[i];
}

std::vector<color::Rgb> OpenLight::mean(const std::vector<OpenView>& views, int part, color::Rgb* light) const {
  std::vector<VisiblePoint> points;
  for (const OpenView& view : views)
    points.push_back({.normal = view.normal, .to_viewer = view.to_viewer, .part = part});
  const std::size_t count = columns_.count();
  std::vector<color::Rgb> seen(views.size() * count), mirrors;
  look_up(points, seen.data());
  std::fill_n(light, count, color::Rgb{});
  for (std::size_t i = 0; i < seen.size(); ++i) light[i % count] += (1.0 / static_cast<double>(views.size())) * seen[i];
  for (std::size_t view = 0; view < views.size(); ++view) mirrors.push_back(seen[view * count + columns_.mirror()]);
  return mirrors;
}

void OpenLight::find_missed(const OpenView& view, int part, color::Rgb* light) const {
  const Surface& surface = surfaces_[surface_of(part)];
  std::vector<color::Rgb> seen(columns_.count());
  mean({view}, part, seen.data());
  std::ranges::copy(seen, light);
  summed_->at(view.normal, view.to_viewer, axes(view, surface), surface.coat_index, light);
  for (std::size_t k = 0; k < seen.size(); ++k) light[k] += -1.0 * seen[k];
}

void OpenLight::add_sums(const OpenView& view, int part, color::Rgb* light) const {
  if (!summed_) return;
  std::vector<color::Rgb> missed(columns_.count());
  const NodeValues* nodes = surfaces_[surface_of(part)].missed.get();
  if (nodes == nullptr) {
    find_missed(view, part, missed.data());
  } else {
    std::vector<float> sum(3 * summed_->count());
    nodes->add(
        grid_.place(view.normal, view.to_viewer),
        [&](const ViewGrid::Node& node, float* numbers) {
          const ViewGrid::Facing at = grid_.facing(node);
          std::vector<color::Rgb> found(columns_.count());
          find_missed({at.normal, at.to_viewer}, part, found.data());
          for (std::size_t k = 0; k < sum.size(); ++k)
            numbers[k] = static_cast<float>(found[k / 3][static_cast<int>(k % 3)]);
        },
        sum.data());
    for (std::size_t k = 0; k < summed_->count(); ++k) missed[k] = vec3(&sum[3 * k]);
  }
  for (std::size_t k = 0; k < missed.size(); ++k) light[k] += missed[k];
}

// Each column in the gray paint that its noise is judged by.
double open_difference_de00(const OpenLight& a, const OpenLight& b, const LobeColumns& columns,
                            const std::vector<VisiblePoint>& points, double white_luminance) {
  std::vector<double> worst(points.size());
  parallel_each(points.size(), 4, [&](std::size_t i) {
    std::vector<color::Rgb> of_a(columns.count()), of_b(columns.count());
    const VisiblePoint& point = points[i];
    a.at(point.normal, point.to_viewer, point.part, of_a.data());
    b.at(point.normal, point.to_viewer, point.part, of_b.data());
    for (std::size_t k = 0; k < columns.count(); ++k) {
      const double weight = nominal_weight(columns, k), gray = columns.is_gloss(k) ? kNominalGray / kPi : 0;
      worst[i] = std::max(worst[i], seen_difference(weight * of_a[k] + gray * of_a[0],
                                                    weight * of_b[k] + gray * of_b[0], white_luminance));
    }
  });
  return percentile_95(std::move(worst));
}

}  // namespace goniochrome::render
