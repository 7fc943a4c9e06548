#include "studio/packed_scene.h"

#include <Imath/half.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "mesh/unit.h"
#include "render/camera.h"
#include "render/page_stage.h"
#include "render/scene.h"
#include "render/scene_effects.h"
#include "render/trim.h"
#include "studio/studio.h"

namespace goniochrome::studio {

namespace {

// The disc of the lamp that a page has beside the environment, as wide as a softbox some way off.
constexpr double kLampRadius_rad = 2 * kDegree;

// The rows of weights: the design, the second paint, and then the kinds of trim.
constexpr std::size_t kFirstTrimRow = 2;

// The first view of a page, which is that of render-osmesa.
constexpr double kAzimuth_deg = 35, kElevation_deg = 12, kFov_deg = 30;

// Halves reach to 65504: brighter maps are scaled down, and the page scales them up again into floats.
Json cube_json(const render::PageCube& cube, PackedNumbers& numbers) {
  constexpr float kMost = 60000;
  float most = 0;
  for (const float value : cube.texels) most = std::max(most, std::abs(value));
  int exponent = 0;
  const bool is_power = std::frexp(most / kMost, &exponent) == 0.5F;
  const float scale = most > kMost ? std::ldexp(1.0F, is_power ? exponent - 1 : exponent) : 1.0F;
  std::vector<std::uint16_t> halves;
  halves.reserve(cube.texels.size());
  for (const float value : cube.texels) halves.push_back(Imath::half(value / scale).bits());
  return {{"sampler", cube.sampler}, {"size", cube.size}, {"scale", scale}, {"texels", numbers.add_smooth(halves)}};
}

Json programs_json(const render::PageShading& programs) {
  return {{"shading", programs.shading},
          {"brushed_shading", programs.brushed_shading},
          {"gathering", programs.gathering},
          {"brushed_gathering", programs.brushed_gathering},
          {"sparkle", programs.sparkle}};
}

// Where most of the light comes from: the brightest spot, or, without spots, the brightest side.
Json brightest_json(const envmap::PrefilteredEnvironment& env) {
  const auto luminance = [](const envmap::Spot& spot) { return color::luminance(spot.white); };
  const auto spot = std::ranges::max_element(env.spots, {}, luminance);
  if (spot == env.spots.end()) return {{"direction", render::diffuse_white(&env, {}).direction}, {"extent", 0}};
  return {{"direction", spot->direction}, {"extent", 2 * spot->radius_rad / kDegree}};
}

}  // namespace

Json packed_mesh(const mesh::Mesh& mesh, PackedNumbers& numbers) {
  const mesh::Box box = mesh::bounding_box(mesh);
  const Vec3 size = box.size();
  std::vector<std::uint16_t> positions;
  std::vector<std::int16_t> normals;
  for (const Vec3& p : mesh.positions)
    for (int c = 0; c < 3; ++c)
      positions.push_back(
          static_cast<std::uint16_t>(size[c] > 0 ? std::lround((p[c] - box.low[c]) / size[c] * 65535) : 0));
  for (const Vec3& n : mesh.normals)
    for (int c = 0; c < 3; ++c)
      normals.push_back(static_cast<std::int16_t>(std::lround(std::clamp(n[c], -1.0, 1.0) * 32767)));
  std::vector<std::uint32_t> corners;
  for (const auto& triangle : mesh.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
  Json parts = Json::array();
  for (const mesh::MeshPart& part : mesh.parts) {
    const auto kind = render::trim_kind(part);
    const std::size_t row = kind ? kFirstTrimRow + static_cast<std::size_t>(*kind) : 0;
    parts.push_back({{"name", shown(part.name)}, {"first", part.first}, {"count", part.count}, {"row", row}});
  }
  const render::Ground ground = render::ground_below(mesh);
  const render::Camera camera = render::Camera::orbit(mesh, kAzimuth_deg, kElevation_deg, 1, kFov_deg, 16.0 / 9);
  const Vec3 origin = mesh::float_origin(box);  // the page computes in floats
  return {{"low", box.low - origin},
          {"high", box.high - origin},
          {"positions", numbers.add(positions)},
          {"normals", numbers.add(normals)},
          {"corners", numbers.add(corners)},
          {"parts", std::move(parts)},
          {"unit_m", mesh::length_unit(mesh).meters},
          {"ground", {{"seen_from", ground.probe_eye - origin}, {"drop", ground.probe_eye.y - ground.height}}},
          {"view",
           {{"azimuth", kAzimuth_deg},
            {"elevation", kElevation_deg},
            {"fov", kFov_deg},
            {"target", camera.target - origin},
            {"distance", length(camera.eye - camera.target)}}}};
}

Result<Json> packed_environment(const std::string& name, const envmap::PrefilteredEnvironment& env,
                                const formats::Basis& basis, PackedNumbers& numbers) {
  const render::Effects effects = page_effects(basis.exponents, basis.mirror, env.spots.size());
  GONIO_ASSIGN(const render::PageLight light, render::page_light(env, effects, page_operator()));
  const Vec3 toward = render::orbit_direction(kAzimuth_deg, kElevation_deg);
  const render::PageMovableLamp lamp = render::page_movable_lamp(effects, page_operator(), kLampRadius_rad);
  Json json = {{"name", name},
               {"programs", programs_json(light.programs)},
               {"white", render::metered_white(&env, {}, toward)},
               {"cubes", Json::array()},
               {"lamp_programs", programs_json(lamp.programs)},
               {"brightest", brightest_json(env)},
               {"lamps", Json::array()}};
  for (const render::PageCube& cube : light.cubes) json["cubes"].push_back(cube_json(cube, numbers));
  for (const render::PageLamp& spot : light.lamps)
    json["lamps"].push_back({{"direction", spot.direction}, {"white", spot.white}, {"disc", spot.disc}});
  if (!light.discs.empty()) json["discs"] = {{"texels", numbers.add(light.discs)}};
  return Result(std::move(json));
}

Json packed_lamp(const formats::Basis& basis, PackedNumbers& numbers) {
  const render::Effects effects = page_effects(basis.exponents, basis.mirror, 0);
  const render::PageMovableLamp lamp = render::page_movable_lamp(effects, page_operator(), kLampRadius_rad);
  const std::size_t rows = basis.exponents.size() + 1;
  return {{"extent", 2 * kLampRadius_rad / kDegree},
          {"disc", lamp.disc},
          {"columns", lamp.discs.size() / (4 * rows)},
          {"discs", numbers.add(lamp.discs)}};
}

Json packed_layers(const formats::Basis& basis) {
  const render::PageLayers all = render::page_layers(page_effects(basis.exponents, basis.mirror, 0), page_operator());
  Json list = Json::array();
  for (const render::LightLayer& layer : all.layers)
    list.push_back({{"slot", layer.slot},
                    {"lamps", layer.of_lamps},
                    {"sampler", layer.sampler},
                    {"shift", layer.shift_slot < 0 ? Json() : Json::array({layer.shift_slot, layer.shift_channel})}});
  return {{"program", all.layers_fragment},   {"list", std::move(list)},        {"light_slot", all.light_slot},
          {"at_once", render::kLayersAtOnce}, {"beside", render::kBesideLayer}, {"none", render::kNoLayer}};
}

Json packed_finishes(const formats::Basis& basis, PackedNumbers& numbers) {
  const render::Effects effects = page_effects(basis.exponents, basis.mirror, 0);
  render::Scene scene;
  scene.paints = {{}};  // in the place of the second paint, which is black until there is one
  for (const render::TrimKind kind : render::kTrimKinds)
    scene.paints.push_back(render::trim_finish(kind, basis.mirror));
  scene.reflection = page_operator();
  const render::WeightTable slots = render::slots_of(effects);
  return {{"columns", 2 * slots.slots * slots.segments},
          {"slots", slots.slots},
          {"rows", scene.paints.size()},
          {"texels", numbers.add(render::weight_table(scene, effects).rgba)}};
}

}  // namespace goniochrome::studio
