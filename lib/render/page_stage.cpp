#include "render/page_stage.h"

#include <utility>

#include "brdf/flakes.h"
#include "math/elementary.h"
#include "render/gl/disc_texture.h"
#include "render/gl/gbuffer_shader.h"
#include "render/gl/shader.h"
#include "render/gl/shader_parts.h"
#include "render/gl/sparkle_shader.h"
#include "render/internal/maps.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

PagePrograms page_programs() {
  return {for_opengl_es(gbuffer_vertex_shader()), for_opengl_es(gbuffer_fragment_shader()),
          for_opengl_es(shading_vertex_shader()), for_opengl_es(sparkle_vertex_shader())};
}

namespace {

PageShading shading_programs(Effects effects, const color::ReflectionOperator& op) {
  PageShading programs;
  programs.shading = for_opengl_es(shading_fragment_shader(effects, op, true));
  programs.gathering = for_opengl_es(gathering_fragment_shader(effects, true));
  if (effects.single_lights() > 0) programs.sparkle = for_opengl_es(sparkle_fragment_shader(effects, op));
  effects.anisotropy = true;
  programs.brushed_shading = for_opengl_es(shading_fragment_shader(effects, op, true));
  programs.brushed_gathering = for_opengl_es(gathering_fragment_shader(effects, true));
  return programs;
}

}  // namespace

PageLayers page_layers(Effects effects, const color::ReflectionOperator& op) {
  effects.lights = 1;
  effects.extent = true;
  return {for_opengl_es(layers_fragment_shader(effects, op)), light_layers(effects), slots_of(effects).light_slot()};
}

Result<PageLight> page_light(const envmap::PrefilteredEnvironment& env, const Effects& effects,
                             const color::ReflectionOperator& op) {
  if (effects.lobes.size() > kMostPageLobes)
    return input_error("the basis has {} lobes, but a page can show {}: take a basis of fewer lobes",
                       effects.lobes.size(), kMostPageLobes);
  Scene scene;
  scene.env = &env;
  scene.background = effects.background;
  scene.reflection = op;
  GONIO_ASSIGN(SceneMaps maps, scene_maps(scene, effects));
  PageLight light;
  light.programs = shading_programs(effects, op);
  const auto add = [&](std::string sampler, const envmap::CubeMap& map) {
    light.cubes.push_back({std::move(sampler), map.size, map.texels});
  };
  add("diffuse", *maps.diffuse.maps[0]);
  if (maps.diffuse.maps.size() > 1) add("coat_diffuse", *maps.diffuse.maps[1]);
  // The page looks each lobe up by itself, so that it keeps the size that its file has.
  for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
    const double exponent = effects.lobes[j].exponent;
    add(fmt::format("lobe_{}", j), *envmap::open_map(env, *env.lobe(exponent), effects.spots));
  }
  if (maps.mirror.size > 0) add("mirror", *maps.mirror.maps[0]);
  const std::vector<Light> lamps = single_lights(scene, effects);
  for (const Light& lamp : lamps) light.lamps.push_back({lamp.direction, lamp.white, disc_uniform(lamp)});
  if (lamps.empty()) return Result(std::move(light));
  FloatTexture discs = disc_texture(lamps, effects);
  light.disc_columns = discs.columns, light.disc_rows = discs.rows, light.discs = std::move(discs.rgba);
  return Result(std::move(light));
}

PageMovableLamp page_movable_lamp(Effects effects, const color::ReflectionOperator& op, double radius_rad) {
  Light lamp;
  lamp.radius_rad = radius_rad;
  const FloatTexture discs = disc_texture({lamp}, effects);
  effects.lights = 1;
  effects.extent = true;
  return {shading_programs(effects, op), disc_uniform(lamp), discs.rgba};
}

PageFlakes page_flakes(const paint::LobeFit& fit, const paint::Flakes& flakes, const std::vector<double>& lamps_rad) {
  PageFlakes page;
  const std::vector<double> shares = brdf::flake_shares(fit);
  std::vector<brdf::FlakeLamp::Lobe> lobes;
  for (std::size_t j = 0; j < shares.size(); ++j)
    if (shares[j] > 0) lobes.push_back({fit.lobes[j].exponent, shares[j], nullptr, nullptr});
  if (lobes.empty()) return page;
  page.per_m2 = flakes.per_m2();
  for (const double radius_rad : lamps_rad) {
    const brdf::FlakeLamp lamp(lobes, radius_rad, flakes.spread_deg);
    page.most.push_back(lamp.part_that_shows(0));
    for (int i = 0; i < kFlakeNodes; ++i) {
      const double chord = kMostFlakeChord * i / (kFlakeNodes - 1), cosine = 1 - 0.5 * chord * chord;
      double beyond = 0;
      for (const brdf::FlakeLamp::Lobe& lobe : lobes)
        if (cosine > 0) beyond += lobe.share * math::pow(cosine, lobe.exponent + 1);
      for (const double number : {lamp.part_that_shows(chord), beyond, lamp.shown_rad, 0.0})
        page.texels.push_back(static_cast<float>(number));
    }
  }
  return page;
}

}  // namespace goniochrome::render
