#include "render/cpu/cpu_engine.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "base/large_pages.h"
#include "base/parallel.h"
#include "render/internal/coat_stretch.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

namespace {

constexpr std::size_t kBlock = 8;  // floats of a texel: two maps

UnsetArray<float> interleaved(const std::vector<envmap::MapPointer>& maps, int size, std::size_t stride) {
  const std::size_t texels = bordered_texels(size);
  UnsetArray<float> data(texels * stride + kBlock);  // the last texel is read by the block
  // Floats that hold no map have the weight 0, and must be numbers for that.
  std::fill_n(&data[texels * stride], kBlock, 0.0F);
  for (std::size_t i = 0; stride > 4 * maps.size() && i < texels; ++i)
    std::fill_n(&data[i * stride + 4 * maps.size()], 4, 0.0F);
  parallel_each(maps.size(), 1,
                [&](std::size_t map) { put_bordered(*at_size(maps[map], size), stride, &data[4 * map]); });
  return data;
}

// Points that are gathered until there are enough for the kernel, and where their colors go.
class Batch {
 public:
  Batch(const CpuShading& shading, const TiltShading& tilted) : shading_(shading), tilted_(tilted) {
    std::ranges::fill(points_.nz, 1.0F), std::ranges::fill(points_.vz, 1.0F);
  }

  bool full() const { return count_ == kPointsAtOnce; }
  int count() const { return count_; }
  std::size_t index(int i) const { return index_[i]; }
  const float* rgba(int i) const { return rgba_ + 4 * i; }

  void add(std::size_t index, const float* normal, const std::array<float, 3>& to_viewer, int part,
           const std::array<float, 3>& position = {}) {
    PointArrays& p = points_;
    p.nx[count_] = normal[0], p.ny[count_] = normal[1], p.nz[count_] = normal[2];
    p.vx[count_] = to_viewer[0], p.vy[count_] = to_viewer[1], p.vz[count_] = to_viewer[2];
    p.part[count_] = part;
    p.px[count_] = position[0], p.py[count_] = position[1], p.pz[count_] = position[2];
    index_[count_++] = index;
  }
  void add(std::size_t index, const VisiblePoint& point, const Vec3& origin) {
    add(index, floats(point.normal).data(), floats(point.to_viewer), point.part, floats(point.position - origin));
  }
  // The colors in the paints of so many parts: 4 * kPointsAtOnce floats a paint.
  void shade(int paints, float* rgba) { shade_paints(shading_, points_, count_, paints, rgba); }
  void shade() {
    shade_points(shading_, points_, count_, rgba_);
    if (tilted_.segments > 0) add_tilted(tilted_, points_, count_, rgba_);
  }
  void look_up(const InterleavedMaps& map) { look_up_background(map, points_, count_, rgba_); }
  void clear() { count_ = 0; }

 private:
  const CpuShading& shading_;
  const TiltShading& tilted_;
  PointArrays points_{};
  std::size_t index_[kPointsAtOnce];
  int count_ = 0;
  alignas(64) float rgba_[4 * kPointsAtOnce];
};

}  // namespace

const EngineInfo CpuEngine::kInfo = {
    .name = "cpu",
    .sentence = "shades by prefiltered maps on the processor, and reads all lobes of a texel at once",
    .is_planned = true,
    .draws_placed_lamps = true,
    .make = [](Sight&) -> std::unique_ptr<Engine> { return std::make_unique<CpuEngine>(); }};

InterleavedMaps CpuEngine::Stack::maps() const {
  return {shape.size, blocks, texel_floats, texels != nullptr ? texels->data() : nullptr};
}

CpuEngine::Stack CpuEngine::interleaved(const MapClass& maps, MapUse use) {
  const std::size_t blocks = (maps.maps.size() + 1) / 2, stride = maps.maps.size() == 1 ? kBlock / 2 : blocks * kBlock;
  return {maps, use, static_cast<int>(blocks), static_cast<int>(stride),
          std::make_shared<const UnsetArray<float>>(render::interleaved(maps.maps, maps.size, stride))};
}

// The maps of a scene that can be loaded, for the effects that were loaded; those that are known already are shared.
void CpuEngine::stack(const SceneMaps& maps, const std::vector<Stack>& known) {
  stacks_.clear();
  const auto add = [&](const MapClass& of, MapUse use) {
    if (of.size == 0) return;
    const auto same = std::ranges::find_if(
        known, [&](const Stack& other) { return other.use == use && other.shape.maps == of.maps; });
    stacks_.push_back(same != known.end() ? *same : interleaved(of, use));
    stacks_.back().shape = of;  // lobes may have other numbers
  };
  add(maps.diffuse, MapUse::kNormal);
  for (const MapClass& lobes : maps.lobes) add(lobes, MapUse::kTilted);
  if (effects_.mirror) add(maps.mirror, MapUse::kMirror);
}

// Which spots are taken out of the maps is seen in the maps; those of before are kept, as plans try both.
void CpuEngine::take_out_spots(const Scene& scene, std::size_t spots) {
  if (spots == effects_.spots) return;
  effects_.spots = spots;
  std::swap(stacks_, other_stacks_);
  if (stacks_.empty()) {
    const Result<SceneMaps> maps = scene_maps(scene, effects_);
    if (maps.ok()) stack(*maps, other_stacks_);
  }
  for (std::size_t k = 0; k < stacks_.size(); ++k) shading_.maps[k] = stacks_[k].maps();
}

Result<void> CpuEngine::load(const Scene& scene, const Effects& effects) {
  GONIO_ASSIGN(const SceneMaps maps, scene_maps(scene, effects));
  effects_ = effects;
  background_map_ = {};
  stack(maps, std::exchange(shared_, {}));
  other_stacks_.clear();
  if (effects.background == Background::kEnvironment) {
    background_map_ = effects.mirror ? stacks_.back() : interleaved(maps.mirror, MapUse::kMirror);
  }
  int tilted_blocks = 0;
  for (const Stack& stack : stacks_) tilted_blocks += stack.use == MapUse::kTilted ? stack.blocks : 0;
  if (stacks_.size() > kMostClasses || tilted_blocks > kMostBlocks || effects.lobes.size() > kMostLobes) {
    return input_error("the paints use {} lobes of {} very different face sizes: fit them to one common basis",
                       effects.lobes.size(), stacks_.size());
  }
  shading_ = {};
  for (const Stack& stack : stacks_) {
    shading_.use[shading_.classes] = stack.use;
    shading_.shifted[shading_.classes] = stack.shape.shifted;
    shading_.maps[shading_.classes++] = stack.maps();
  }
  tilt_store_ = {};
  if (scene.env != nullptr) tilt_store_.load(*scene.env, tilt_exponents(scene, effects));
  load_paints(scene, effects);
  return {};
}

void CpuEngine::load_paints(const Scene& scene, const Effects& effects) {
  take_out_spots(scene, effects.spots);
  const WeightTable table = weight_table(scene, effects, stretched_parts(scene, effects));
  std::size_t blocks = 0;
  for (const Stack& stack : stacks_) blocks += static_cast<std::size_t>(stack.blocks);
  const int light_slots = effects.single_lights() > 0 ? table.shift_slot(0) - table.light_slot() : 0;
  shading_.segments = table.segments;
  shading_.light_offset = 2 * kBlock * blocks;
  shading_.shift_offset = shading_.light_offset + 8 * static_cast<std::size_t>(light_slots > 0 ? light_slots + 1 : 0);
  const std::size_t shift_floats = (2 * stacks_.size() + kBlock - 1) / kBlock * kBlock;
  shading_.segment_floats = shading_.shift_offset + shift_floats;
  weights_.assign(shading_.segment_floats * static_cast<std::size_t>(table.segments * table.row_count()), 0.0F);
  std::vector<std::uint64_t> shown(static_cast<std::size_t>(table.row_count())), lit(shown.size());
  float* to = weights_.data();
  for (int segment = 0; segment < table.row_count() * table.segments; ++segment) {
    const auto row = static_cast<std::size_t>(segment / table.segments);
    const auto texel = [&](int slot) { return table.at(static_cast<int>(row), segment % table.segments, slot); };
    for (const Stack& stack : stacks_) {
      for (std::size_t i = 0; i < stack.shape.slots.size(); ++i) {
        float* ends = to + 2 * kBlock * (i / 2) + 4 * (i % 2);
        for (const std::size_t end : {0, 1}) std::copy_n(texel(stack.shape.slots[i]) + 4 * end, 4, ends + kBlock * end);
      }
      to += 2 * kBlock * static_cast<std::size_t>(stack.blocks);
    }
    for (std::size_t block = 0; block < blocks; ++block) {
      const float* of = to - 2 * kBlock * (blocks - block);
      if (std::any_of(of, of + 2 * kBlock, [](float weight) { return weight != 0; }))
        shown[row] |= std::uint64_t{1} << block;
    }
    for (int slot = 0; slot < light_slots; ++slot, to += 8) std::copy_n(texel(table.light_slot() + slot), 8, to);
    if (light_slots > 0) std::copy_n(texel(table.lamp_mirror_slot()), 8, to), to += 8;
    for (std::size_t k = 0; k < stacks_.size(); ++k) {
      if (!stacks_[k].shape.shifted) continue;
      const auto lobe = static_cast<std::size_t>(stacks_[k].shape.slots.front() - WeightTable::lobe_slot(0));
      const float* shift = texel(table.shift_slot(lobe)) + lobe % 4;
      to[2 * k] = shift[0], to[2 * k + 1] = shift[4];
    }
    to += shift_floats;
    for (std::size_t j = 0; light_slots > 0 && j < effects.lobes.size(); ++j)
      for (const int slot : {table.directional_diffuse_slot(j), table.gloss_slot(j)})
        if (std::any_of(texel(slot), texel(slot) + 8, [](float weight) { return weight != 0; }))
          lit[row] |= std::uint64_t{1} << j;
  }
  rows_ = table.rows;
  shown_blocks_.clear(), lit_lobes_.clear();
  for (const int row : rows_) {
    shown_blocks_.push_back(shown[static_cast<std::size_t>(row)]);
    lit_lobes_.push_back(lit[static_cast<std::size_t>(row)]);
  }
  shading_.weights = weights_.data(), shading_.rows = rows_.data();
  shading_.shown_blocks = shown_blocks_.data(), shading_.lit_lobes = lit_lobes_.data();
  bare_.clear();
  for (const paint::LobeFit& paint : scene.paints) {
    bare_.push_back(paint.diffuse == color::Rgb{} && paint.lobes.empty() && paint.views.empty() && paint.tilts.empty());
  }
  set_lights(scene, effects);
  set_tilts(scene, effects);
  tilt_store_.load_paints(scene, effects);
  tilt_shading_ = tilt_store_.shading(product_.data());
  background_ = effects.background;
  background_color_ = scene.background_color;
}

void CpuEngine::set_lights(const Scene& scene, const Effects& effects) {
  lights_.clear(), exponents_.clear();
  const std::vector<Light> lights = single_lights(scene, effects);
  for (const Light& light : lights) {
    for (const Vec3& value : {light.direction, kPi * light.white}) {
      for (int c = 0; c < 3; ++c) lights_.push_back(static_cast<float>(value[c]));
      lights_.push_back(0);
    }
  }
  product_ = product_columns(effects.reflection ? scene.reflection : color::component_wise());
  shading_.product = product_.data();
  for (const Effects::LobeUse& lobe : effects.lobes) exponents_.push_back(static_cast<float>(lobe.exponent));
  shading_.lights = static_cast<int>(lights_.size() / 8);
  shading_.light = lights_.data();
  shading_.lobes = static_cast<int>(exponents_.size());
  shading_.exponents = exponents_.data();
  shading_.lit_diffuse = effects.diffuse;
  shading_.fresnel = effects.fresnel;
  shading_.coat = effects.coat;
  mesh_ = effects.placed ? scene.mesh : nullptr;
  origin_ = mesh_ != nullptr ? origin_of(*mesh_) : Vec3{};
  placed_ = placed_lamps(lights, origin_);
  shading_.placed = placed_.empty() ? nullptr : placed_.data();
  set_discs(lights, effects);
}

void CpuEngine::set_discs(const std::vector<Light>& lights, const Effects& effects) {
  discs_.clear(), disc_tables_.clear(), disc_lobes_.clear(), disc_horizons_.clear();
  shading_.discs = nullptr;
  if (!effects.discs() || lights.empty()) return;
  for (const Light& light : lights) {
    CpuShading::Disc disc;
    disc_horizons_.push_back(brdf::disc_horizon_table(light.radius_rad));
    disc.horizon = disc_horizons_.back().get();
    disc.radius_rad = static_cast<float>(light.radius_rad);
    disc.sine = static_cast<float>(std::sin(light.radius_rad));
    disc.chord = light.radius_rad > 0 ? static_cast<float>(2 * std::sin(0.5 * light.radius_rad)) : -1;
    if (light.radius_rad > 0 && light.mirrored)
      disc.mirrored = static_cast<float>(brdf::disc_radiance(light.radius_rad));
    discs_.push_back(disc);
    for (const Effects::LobeUse& lobe : effects.lobes)
      disc_tables_.push_back(brdf::disc_lobe_table(lobe.exponent, light.radius_rad));
  }
  for (const auto& table : disc_tables_) disc_lobes_.push_back(table.get());
  shading_.discs = discs_.data();
  shading_.disc_lobes = disc_lobes_.data();
}

void CpuEngine::set_tilts(const Scene& scene, const Effects& effects) {
  tilts_.clear(), first_tilt_ = {0};
  shading_.tilts = nullptr, shading_.most_tilts = 1;
  if (!effects.anisotropy) return;
  for (const std::vector<brdf::Tilt>& tilts : tilts_of(scene, effects)) {
    for (const brdf::Tilt& tilt : tilts) {
      for (int c = 0; c < 3; ++c) tilts_.push_back(static_cast<float>(tilt.normal[c]));
      tilts_.push_back(static_cast<float>(tilt.weight));
    }
    first_tilt_.push_back(first_tilt_.back() + static_cast<int>(tilts.size()));
    shading_.most_tilts = std::max(shading_.most_tilts, static_cast<int>(tilts.size()));
  }
  shading_.tilts = tilts_.data();
  shading_.first_tilt = first_tilt_.data();
}

std::array<float, 3> CpuEngine::position(const Gbuffer& gbuffer, int x, int y) const {
  if (mesh_ == nullptr) return {};
  return floats(mesh_point(*mesh_, gbuffer, x, y).position - origin_);
}

void CpuEngine::shade_row(const Gbuffer& gbuffer, int y, float gain, bool add, float* rgba) const {
  const auto put = [&](std::size_t x, const float* color, float alpha) {
    float* pixel = rgba + 4 * x;
    for (int c = 0; c < 3; ++c) pixel[c] = gain * color[c] + (add ? pixel[c] : 0);
    pixel[3] = gain * alpha + (add ? pixel[3] : 0);
  };
  Batch seen(shading_, tilt_shading_), missed(shading_, tilt_shading_);
  const InterleavedMaps sky = background_map_.maps();
  const auto flush = [&](Batch& batch) {
    if (batch.count() == 0) return;
    if (&batch == &seen) {
      batch.shade();
    } else {
      batch.look_up(sky);
    }
    for (int i = 0; i < batch.count(); ++i) put(batch.index(i), batch.rgba(i), 1);
    batch.clear();
  };
  const Rays& rays = gbuffer.rays;
  const Vec3 first = rays.corner + (y + 0.5) * rays.down;
  const float plain[4] = {static_cast<float>(background_color_.x), static_cast<float>(background_color_.y),
                          static_cast<float>(background_color_.z), 0};
  const float nothing[4] = {0, 0, 0, 0};
  for (int x = 0; x < gbuffer.width; ++x) {
    if (!gbuffer.wants(x, y)) continue;
    const float* point = gbuffer.at(x, y);
    if (point[3] == 0 && background_ != Background::kEnvironment) {
      const bool colored = background_ == Background::kColor;
      put(static_cast<std::size_t>(x), colored ? plain : nothing, colored ? 1 : 0);
      continue;
    }
    if (point[3] != 0 && bare_[static_cast<std::size_t>(std::abs(point[3])) - 1]) {
      put(static_cast<std::size_t>(x), nothing, 1);
      continue;
    }
    Batch& batch = point[3] == 0 ? missed : seen;
    batch.add(static_cast<std::size_t>(x), point, floats(-(first + (x + 0.5) * rays.right)),
              std::max(0, static_cast<int>(std::abs(point[3])) - 1),
              point[3] == 0 ? std::array<float, 3>{} : position(gbuffer, x, y));
    if (batch.full()) flush(batch);
  }
  flush(seen), flush(missed);
}

void CpuEngine::shade(const Gbuffer& gbuffer, float gain, bool add, image::Image& rgba) const {
  rgba.width = gbuffer.width, rgba.height = gbuffer.height, rgba.channels = 4;
  resize_on_large_pages(rgba.data,
                        static_cast<std::size_t>(gbuffer.width) * static_cast<std::size_t>(gbuffer.height) * 4);
  parallel_each(static_cast<std::size_t>(gbuffer.height), 8, [&](std::size_t y) {
    shade_row(gbuffer, static_cast<int>(y), gain, add, rgba.pixel(0, static_cast<int>(y)));
  });
}

Result<void> CpuEngine::shade(Sight& sight, int sample, float gain, bool add, image::Image& rgba) {
  shade(*sight.gbuffer(sample), gain, add, rgba);
  return {};
}

std::vector<color::Rgb> CpuEngine::colors(const std::vector<VisiblePoint>& points) const {
  std::vector<color::Rgb> colors(points.size());
  parallel_for(points.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    Batch batch(shading_, tilt_shading_);
    for (std::size_t i = begin; i < end; ++i) batch.add(i, points[i], origin_);
    batch.shade();
    for (int i = 0; i < batch.count(); ++i) colors[batch.index(i)] = vec3(batch.rgba(i));
  });
  return colors;
}

std::vector<color::Rgb> CpuEngine::colors(const std::vector<VisiblePoint>& points, std::size_t paints) const {
  std::vector<color::Rgb> colors(points.size() * paints);
  parallel_for(points.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    Batch batch(shading_, tilt_shading_);
    for (std::size_t i = begin; i < end; ++i) batch.add(i, points[i], origin_);
    std::vector<float> rgba(4 * kPointsAtOnce * paints);
    batch.shade(static_cast<int>(paints), rgba.data());
    for (std::size_t paint = 0; paint < paints; ++paint)
      for (std::size_t i = begin; i < end; ++i)
        colors[paint * points.size() + i] = vec3(&rgba[4 * (kPointsAtOnce * paint + i - begin)]);
  });
  return colors;
}

}  // namespace goniochrome::render
