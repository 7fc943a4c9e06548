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

// Between nodes the residual is off by the square of their distance: so many cells at a tolerance of kUsual, by the
// figures of goniochrome-rendering(7), "Sums".
constexpr double kUsual_de00 = 0.5;
constexpr int kViews = 13, kNormals = 23;
// The part of the tolerance that the blocks of a sum take.
constexpr double kOfSums = 0.2;
// Beyond so many sums those of other views are forgotten, and beyond so many surfaces those of other paints.
constexpr std::size_t kMostSums = std::size_t{1} << 19, kMostSurfaces = 64;

int finer(int cells, double tolerance_de00) {
  const double scale = std::clamp(std::sqrt(kUsual_de00 / tolerance_de00), 0.5, 1.5);
  return static_cast<int>(std::lround(cells * scale));
}

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

template <class Value>
void keep_once(std::vector<Value>& values) {
  std::ranges::sort(values);
  values.erase(std::ranges::unique(values).begin(), values.end());
}

}  // namespace

std::int32_t& OpenResidual::Surface::slot_to_fill(const ViewGrid::Node& node, std::size_t normals) {
  auto& of_view = slots[node.view];
  if (of_view == nullptr) of_view = std::make_unique<std::vector<std::int32_t>>(normals, kNone);
  return (*of_view)[node.normal];
}

const OpenResidual::Wear* OpenResidual::wear_of(int part) const {
  const std::int32_t wear = part < 0 ? kNone : wear_of_part_[static_cast<std::size_t>(part)];
  return wear == kNone ? nullptr : &wears_[static_cast<std::size_t>(wear)];
}

std::size_t OpenResidual::surface_of(double coat_index) {
  const auto found = std::ranges::find(surfaces_, coat_index, &Surface::coat_index);
  if (found != surfaces_.end()) return static_cast<std::size_t>(found - surfaces_.begin());
  surfaces_.emplace_back(coat_index).slots.resize(grid_.view_count());
  return surfaces_.size() - 1;
}

Result<void> OpenResidual::load(const Scene& scene, const Effects& effects) {
  LobeColumns columns;
  for (const envmap::PrefilteredLobe& lobe : scene.env->lobes)
    if (lobe.exponent <= kWidestShared) columns.exponents.push_back(lobe.exponent);
  if (effects.tolerance_de00 != tolerance_de00_ || columns != columns_) {
    tolerance_de00_ = effects.tolerance_de00, columns_ = columns;
    grid_ = ViewGrid(finer(kViews, tolerance_de00_), finer(kNormals, tolerance_de00_));
    light_ = std::make_unique<SummedLight>(*tree_, kOfSums * tolerance_de00_, columns_);
    surfaces_.clear();
  }
  loaded_ = effects_ = effects;
  effects_.mirror = effects_.satin = effects_.stretch = effects_.extent = effects_.placed = effects_.panes = false;
  effects_.texture = effects_.texture_filter = effects_.maps = effects_.image_maps = false;
  effects_.tilt_level = 0, effects_.lights = 0, effects_.background = Background::kNone, effects_.rays = {};
  GONIO_TRY(set_paints(scene));
  GONIO_TRY(engine_.load(scene_, effects_));
  return {};
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
    wears_.push_back({surface_of(paint.coat_index), static_cast<int>(part), std::move(weights), {}});
  }
  return {};
}

std::size_t OpenResidual::count() const {
  std::size_t count = 0;
  for (const Surface& surface : surfaces_) count += surface.nodes.size();
  return count;
}

// Each cell that a pixel lies in, once, in ascending order.
std::vector<OpenResidual::Cell> OpenResidual::cells_of(const Gbuffer& seen) const {
  std::vector<std::vector<Cell>> rows(static_cast<std::size_t>(seen.height));
  parallel_each(rows.size(), 8, [&](std::size_t row) {
    std::vector<Cell>& cells = rows[row];
    const int y = static_cast<int>(row);
    for (int x = 0; x < seen.width; ++x) {
      const Wear* wear = wear_of(seen.part(x, y));
      if (wear == nullptr) continue;
      const Cell cell{static_cast<std::int32_t>(wear->surface),
                      grid_.place(seen.normal(x, y), seen.to_viewer(x, y)).node};
      if (cells.empty() || cells.back() != cell) cells.push_back(cell);
    }
    keep_once(cells);
  });
  std::vector<Cell> all;
  for (const std::vector<Cell>& cells : rows) all.insert(all.end(), cells.begin(), cells.end());
  keep_once(all);
  return all;
}

void OpenResidual::fill(const std::vector<Cell>& cells) {
  if (count() > kMostSums) {
    for (Surface& surface : surfaces_) {
      surface = Surface(surface.coat_index);
      surface.slots.resize(grid_.view_count());
    }
    for (Wear& wear : wears_) wear.residual.clear();
  }
  for (const Cell& cell : cells) {
    Surface& surface = surfaces_[static_cast<std::size_t>(cell.surface)];
    for (const ViewGrid::Node& node : grid_.corners(cell.node)) {
      std::int32_t& slot = surface.slot_to_fill(node, grid_.normal_count());
      if (slot != kNone) continue;
      slot = static_cast<std::int32_t>(surface.nodes.size());
      surface.nodes.push_back(node);
    }
  }
  for (Surface& surface : surfaces_) sum(surface);
  complete();
}

void OpenResidual::sum(Surface& surface) const {
  const std::size_t first = surface.sums.size() / floats();
  surface.sums.resize(surface.nodes.size() * floats());
  parallel_each(surface.nodes.size() - first, 16, [&](std::size_t i) {
    const std::size_t slot = first + i;
    const auto [normal, to_viewer] = grid_.facing(surface.nodes[slot]);
    const LobeAxis mirrored{2 * dot(normal, to_viewer) * normal - to_viewer, 1};
    std::vector<color::Rgb> light(columns_.count());
    light_->at(normal, to_viewer, {mirrored}, surface.coat_index, light.data());
    float* to = &surface.sums[slot * floats()];
    for (std::size_t k = 0; k < floats(); ++k) to[k] = static_cast<float>(light[k / 3][static_cast<int>(k % 3)]);
  });
}

void OpenResidual::complete() {
  std::vector<VisiblePoint> points;
  for (const Wear& wear : wears_) {
    const Surface& surface = surfaces_[wear.surface];
    for (std::size_t slot = wear.residual.size() / 3; slot < surface.nodes.size(); ++slot) {
      const auto [normal, to_viewer] = grid_.facing(surface.nodes[slot]);
      points.push_back({.normal = normal, .to_viewer = to_viewer, .part = wear.part});
    }
  }
  if (points.empty()) return;
  const std::vector<color::Rgb> by_maps = engine_.colors(points);
  std::size_t point = 0;
  for (Wear& wear : wears_) {
    const Surface& surface = surfaces_[wear.surface];
    for (std::size_t slot = wear.residual.size() / 3; slot < surface.nodes.size(); ++slot, ++point) {
      const double cos_o = dot(points[point].normal, points[point].to_viewer);
      const color::Rgb residual = shown(wear.paint, &surface.sums[slot * floats()], cos_o) - by_maps[point];
      for (int c = 0; c < 3; ++c) wear.residual.push_back(static_cast<float>(residual[c]));
    }
  }
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

color::Rgb OpenResidual::told(const Wear& wear, const ViewGrid::Place& place) const {
  const Surface& surface = surfaces_[wear.surface];
  const std::array<ViewGrid::Node, ViewGrid::kCorners> corners = grid_.corners(place.node);
  const std::array<float, ViewGrid::kCorners> weights = ViewGrid::weights(place);
  color::Rgb told;
  for (std::size_t c = 0; c < corners.size(); ++c)
    told +=
        static_cast<double>(weights[c]) * vec3(&wear.residual[3 * static_cast<std::size_t>(surface.slot(corners[c]))]);
  return told;
}

void OpenResidual::add(const Gbuffer& seen, float gain, image::Image& picture) {
  fill(cells_of(seen));
  for_pixels(seen.width, seen.height, [&](int x, int y) {
    const Wear* wear = wear_of(seen.part(x, y));
    if (wear == nullptr) return;
    const color::Rgb more = told(*wear, grid_.place(seen.normal(x, y), seen.to_viewer(x, y)));
    for (int c = 0; c < 3; ++c) picture.pixel(x, y)[c] += gain * static_cast<float>(more[c]);
  });
}

std::vector<color::Rgb> OpenResidual::at(const std::vector<VisiblePoint>& points) {
  std::vector<Cell> cells;
  for (const VisiblePoint& point : points)
    if (const Wear* wear = wear_of(point.part); wear != nullptr)
      cells.push_back({static_cast<std::int32_t>(wear->surface), grid_.place(point.normal, point.to_viewer).node});
  keep_once(cells);
  fill(cells);
  std::vector<color::Rgb> residual(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    if (const Wear* wear = wear_of(points[i].part); wear != nullptr)
      residual[i] = told(*wear, grid_.place(points[i].normal, points[i].to_viewer));
  return residual;
}

}  // namespace goniochrome::render
