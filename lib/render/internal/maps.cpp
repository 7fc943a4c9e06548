#include "render/internal/maps.h"

#include <algorithm>
#include <set>

#include "base/text.h"
#include "render/internal/tilt_table.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

// A class holds maps down to this share of its face size.
constexpr double kSmallest = 0.4;

// Checks that the lobe is there; else an error has the command that adds it.
Result<void> check_lobe(const envmap::PrefilteredEnvironment& env, double exponent, const Effects& effects) {
  if (env.lobe(exponent) != nullptr) return {};
  std::set<double> exponents = {exponent};
  for (const Effects::LobeUse& use : effects.lobes) exponents.insert(use.exponent);
  return input_error(
      "the environment has no lobe of exponent {}, which a paint needs: make it with `prefilter-envmap {} --exponents "
      "{} -o ENV.env.exr`, or fit the paints to the basis it was made for",
      shortest(exponent), env.source.empty() ? "SOURCE" : env.source, joined(exponents, ",", shortest));
}

MapClass single(int slot, envmap::MapPointer map) {
  const int size = map->size;
  return {size, {slot}, {std::move(map)}, false};
}

}  // namespace

std::vector<LobeClass> lobe_classes(const envmap::PrefilteredEnvironment& env, const Effects& effects) {
  std::vector<LobeClass> shifted, shared;
  std::vector<std::size_t> members;
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    if (env.lobe(effects.lobes[j].exponent) == nullptr) continue;
    if (is_shifted(effects, effects.lobes[j].exponent)) {
      shifted.push_back({{j}, true});
    } else {
      members.push_back(j);
    }
  }
  const auto size = [&](std::size_t j) { return env.lobe(effects.lobes[j].exponent)->map.size; };
  std::ranges::stable_sort(members, [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
  for (const std::size_t j : members) {
    if (shared.empty() || size(j) < kSmallest * size(shared.back().lobes.front())) shared.push_back({{}, false});
    shared.back().lobes.push_back(j);
  }
  std::ranges::reverse(shared);
  shifted.insert(shifted.end(), shared.begin(), shared.end());
  return shifted;
}

envmap::MapPointer at_size(envmap::MapPointer map, int size) {
  return map->size == size ? map : std::make_shared<const envmap::CubeMap>(envmap::resized(*map, size));
}

Result<SceneMaps> scene_maps(const Scene& scene, const Effects& effects) {
  SceneMaps maps;
  if (!effects.environment) return maps;
  const envmap::PrefilteredEnvironment& env = *scene.env;
  if (scene.layer != nullptr && scene.layer->textured()) GONIO_TRY(scene.layer->shader()->has_all_maps());
  if (effects.diffuse) maps.diffuse = single(WeightTable::diffuse_slot(), envmap::open_diffuse_map(env, effects.spots));
  if (effects.diffuse && effects.coat) {
    maps.diffuse.slots.push_back(slots_of(effects).coat_diffuse_slot());
    maps.diffuse.maps.push_back(envmap::open_coat_diffuse_map(env, effects.spots));
  }
  for (const Effects::LobeUse& use : effects.lobes) GONIO_TRY(check_lobe(env, use.exponent, effects));
  for (const double exponent : tilt_exponents(scene, effects)) GONIO_TRY(check_lobe(env, exponent, effects));
  for (const LobeClass& of : lobe_classes(env, effects)) {
    MapClass into{env.lobe(effects.lobes[of.lobes.front()].exponent)->map.size, {}, {}, of.shifted};
    for (const std::size_t j : of.lobes) {
      into.slots.push_back(WeightTable::lobe_slot(j));
      const double exponent = effects.lobes[j].exponent;
      into.maps.push_back(envmap::open_map(env, *env.lobe(exponent), effects.spots));
    }
    maps.lobes.push_back(std::move(into));
  }
  if (effects.mirror || effects.background == Background::kEnvironment) {
    if (env.mirror.map.size == 0) {
      return input_error(
          "the environment has no mirror part, which {} needs: make it with a basis that holds <mirror/>",
          effects.mirror ? "a paint with a mirror lobe" : "--background env");
    }
    maps.mirror = single(1 + static_cast<int>(effects.lobes.size()), envmap::plain_map(env.mirror));
  }
  return maps;
}

}  // namespace goniochrome::render
