#include "render/exact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "base/parallel.h"
#include "render/integral/block_sums.h"
#include "render/integral/gatherer.h"
#include "render/internal/seen.h"
#include "render/internal/wear.h"
#include "render/panes.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

namespace {

// In the reference, the tilted normals of an anisotropic lobe reproduce it to this share of its peak.
constexpr double kTiltTolerance = 1e-3;

// The direction of a texel costs more than a lobe. It is therefore computed once for so many points.
constexpr std::size_t kPointsTogether = 16;

template <class AnyGatherer>
void gather_texels(const envmap::Environment& env, std::vector<AnyGatherer>& points) {
  for (int row = 0; row < env.height(); ++row) {
    for (int column = 0; column < env.width(); ++column) {
      const color::Rgb radiance = env.texel(column, row);
      if (radiance == color::Rgb{}) continue;
      const Patch whole{env.direction(column, row), env.solid_angle(column, row)};
      for (AnyGatherer& point : points) gather_texel(env, column, row, whole, radiance, point);
    }
  }
}

// Sums the light at each point, whose gatherer is made by make(point, texel_rad).
template <class Point, class Make>
std::vector<color::Rgb> gathered(const std::vector<Point>& points, const Surroundings& around,
                                 const std::vector<Light>& lights, const Make& make) {
  std::vector<color::Rgb> radiance(points.size());
  const envmap::Environment* env = around.texels;
  const double texel_rad = env != nullptr ? env->largest_texel_rad() : 0;
  parallel_for(points.size(), kPointsTogether, [&](std::size_t begin, std::size_t end) {
    std::vector<decltype(make(points[0], texel_rad))> gatherers;
    for (std::size_t i = begin; i < end; ++i) gatherers.push_back(make(points[i], texel_rad));
    if (around.blocks != nullptr) {
      for (auto& gatherer : gatherers) gather_blocks(*around.blocks, gatherer);
    } else if (env != nullptr) {
      gather_texels(*env, gatherers);
    }
    for (std::size_t i = begin; i < end; ++i) {
      auto& gatherer = gatherers[i - begin];
      for (const Light& light : lights) gatherer.add_light(light_at(light, points[i].position));
      if constexpr (std::is_same_v<Point, SurfacePoint>)
        if (env != nullptr) gatherer.add_mirror(env->blended(gatherer.reflected()));
      radiance[i] = gatherer.sum();
    }
  });
  return radiance;
}

}  // namespace

std::vector<color::Rgb> reference_radiance(const std::vector<SurfacePoint>& points, const Surroundings& around,
                                           const std::vector<Light>& lights) {
  return gathered(points, around, lights, [&](const SurfacePoint& point, double texel_rad) {
    return Gatherer(point, texel_rad, around.most_spread);
  });
}

std::vector<color::Rgb> textured_radiance(const std::vector<TexturedPoint>& points, const Surroundings& around,
                                          const std::vector<Light>& lights,
                                          const color::ReflectionOperator* reflection) {
  return gathered(points, around, lights, [&](const TexturedPoint& point, double texel_rad) {
    return TextureGatherer(point, reflection, texel_rad, around.most_spread);
  });
}

namespace {

// The facets of a rough coat in the place of the gloss lobes and the mirror of a paint.
void put_coat(paint::LobeFit& paint, ExactModel& model) {
  const std::optional<brdf::RoughCoat> coat = brdf::coat_of_lobes(paint, model.gloss_deg);
  if (!coat) return;
  model.coat.emplace(*coat, brdf::mirror_index(paint.coat_index));
  const auto bare = [](std::vector<paint::Lobe>& lobes) {
    for (paint::Lobe& lobe : lobes) lobe.gloss = {};
  };
  bare(paint.lobes);
  for (paint::ViewLobes& view : paint.views) bare(view.lobes);
}

// No light from all around, summed as finely.
Surroundings darkness(const Surroundings& around) {
  Surroundings none(nullptr);
  none.most_spread = around.most_spread;
  return none;
}

// The textured ones of these points get their colors, and keep of what is there the part that is not covered.
void put_textured(const Scene& scene, const std::vector<VisiblePoint>& points, const Effects& effects,
                  const Surroundings& around, std::vector<color::Rgb>& colors) {
  std::vector<TexturedPoint> textured;  // those of a point have different normals
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const VisiblePoint& point = points[i];
    if (scene.layer == nullptr || scene.layer->surface(point.part).textures.empty()) continue;
    SurfaceLayer::Place place = scene.layer->place(point, i, effects);
    colors[i] = place.bare * colors[i];
    const std::size_t first = textured.size();
    for (SurfaceLayer::Piece& piece : place.pieces) {
      const Vec3 normal = piece.normal(point.normal, point.to_viewer);
      auto same = std::find_if(textured.begin() + static_cast<std::ptrdiff_t>(first), textured.end(),
                               [&](const TexturedPoint& one) { return one.normal == normal; });
      if (same == textured.end()) {
        same = textured.insert(same, {normal, point.to_viewer, {}, point.position});
        numbers.push_back(i);
      }
      same->pieces.push_back(std::move(piece));
    }
  }
  const std::vector<color::Rgb> shown =
      textured_radiance(textured, effects.environment ? around : darkness(around), lights_of(scene, effects),
                        effects.reflection ? &scene.reflection : nullptr);
  for (std::size_t i = 0; i < shown.size(); ++i) colors[numbers[i]] += shown[i];
}

}  // namespace

std::vector<color::Rgb> exact_radiance(const std::vector<VisiblePoint>& points, const Scene& scene,
                                       const Effects& effects, const Surroundings& around) {
  std::vector<paint::LobeFit> paints;
  std::vector<ExactModel> models(scene.paints.size());
  Effects dense = effects;
  if (around.blocks == nullptr) dense.tilt_tolerance = kTiltTolerance, dense.most_tilts = brdf::kMostTilts;
  const auto tilts =
      effects.anisotropy ? tilts_of(scene, dense) : std::vector<std::vector<brdf::Tilt>>(scene.paints.size());
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    paints.push_back(with_effects(scene.paints[part], effects));
    ExactModel& model = models[part];
    model.fresnel = effects.fresnel;
    model.gloss_deg = gloss_deg_of(scene, part);
    model.horizon = effects.horizon || effects.lobes.empty() || !effects.environment;
    if (tilts[part].size() > 1) model.tilts = tilts[part];
    if (effects.reflection) model.reflection = &scene.reflection;
    if (effects.satin && wears_rough_coat(scene, part)) {
      if (part > 0 && models[part - 1].coat && same_wear(scene, part, part - 1)) {
        paints[part] = paints[part - 1], model.coat = models[part - 1].coat;
      } else {
        put_coat(paints[part], model);
      }
    }
    if (!is_mapped(scene, part) || !(effects.maps || effects.image_maps)) continue;
    model.map = scene.layer->surface(static_cast<int>(part)).color_map;
    model.treatment = scene.layer->treatment();
    model.map_in_image = effects.image_maps, model.map_under_lights = effects.maps;
  }
  std::vector<SurfacePoint> surface;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto part = static_cast<std::size_t>(points[i].part);
    if (scene.layer != nullptr && scene.layer->surface(points[i].part).hides_paint()) continue;
    surface.push_back({points[i].normal, points[i].to_viewer, &paints[part], &models[part], points[i].position});
    numbers.push_back(i);
  }
  const std::vector<color::Rgb> plain =
      reference_radiance(surface, effects.environment ? around : darkness(around), lights_of(scene, effects));
  std::vector<color::Rgb> colors(points.size());
  for (std::size_t i = 0; i < plain.size(); ++i) colors[numbers[i]] = plain[i];
  put_textured(scene, points, effects, around, colors);
  return colors;
}

}  // namespace goniochrome::render
