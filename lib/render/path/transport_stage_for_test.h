// A ball in a cup under a soft lamp, whose light is traced by lobes, for the tests of transports.
#pragma once

#include <cmath>
#include <optional>
#include <random>

#include "brdf/lobe_model.h"
#include "prefilter/prefilter.h"
#include "render/path/lobe_transport.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::transport_stage {

inline const std::vector<double> kExponents = {3, 20, 200};

// A soft lamp in an uneven sky; its maps, to 1e-3.
inline envmap::Environment sky() {
  return environment_of(64, 32, [](int x, int y) {
    const double dx = (x - 24) / 5.0, dy = (y - 9) / 4.0, lamp = 12 * std::exp(-dx * dx - dy * dy);
    return color::Rgb{0.5 + lamp, 0.4 + 0.02 * y + lamp, 0.7 + 0.8 * lamp};
  });
}
inline Scene scene_under(const envmap::PrefilteredEnvironment& env) {
  Scene scene;
  scene.env = &env;
  return scene;
}

inline const envmap::PrefilteredEnvironment& maps() {
  static const envmap::PrefilteredEnvironment made = [] {
    const envmap::Environment env = sky();
    prefilter::PrefilterRequest request;
    request.exponents = kExponents;
    return prefilter::prefiltered(env, request, prefilter::prefilter_plan(env, request),
                                  [](const envmap::PrefilteredLobe&, double) {});
  }();
  return made;
}

inline paint::LobeFit random_paint(std::mt19937_64& random) {
  const auto in = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); };
  const auto any = [&](double most) { return color::Rgb{in(0, most), in(0, most), in(0, most)}; };
  paint::LobeFit paint;
  paint.diffuse = any(0.2);
  for (const double exponent : kExponents) {
    const double gloss = 0.04 * in(0, 0.1) * (exponent + 1);
    paint.lobes.push_back({exponent, any(0.03 * (exponent + 2)), {gloss, gloss, gloss}});
  }
  const double mirror = in(0, 1);
  paint.lobes.push_back({paint::kMirrorExponent, {}, {mirror, mirror, mirror}});
  return paint;
}

// A ball in a cup under that sky.
struct Stage {
  PathStage path;
  Gbuffer surface;
  LobeColumns columns{kExponents};
  std::optional<OpenLight> open;
  WornPaints worn;

  Stage(const paint::LobeFit& cup, const paint::LobeFit& ball, int width, int height)
      : path(ball_in_cup(), {cup}), size{width, height} {
    path.scene.paints.back() = ball;
    path.environment = sky();
    path.scene.env = &maps();
    open = *OpenLight::create(path.scene, columns);
    dress(cup, ball);
  }
  static mesh::Mesh ball_in_cup() {
    mesh::Mesh mesh = box_mesh(false);
    add_mesh(mesh, sphere_mesh(32), 0.5, {0.1, -0.5, 0});
    return mesh;
  }
  void dress(const paint::LobeFit& cup, const paint::LobeFit& ball) {
    std::ranges::fill(path.scene.paints, cup);
    path.scene.paints.back() = ball;
    path.build();
    Camera camera;
    camera.eye = {0.5, 4, 2};
    camera.fov_deg = 36;
    surface = visible_surface(path.transport->rays(), *rays(camera, size[0], size[1]), size[0], size[1]);
    PathScene scene;
    scene.scene = &path.scene;
    worn = *worn_paints(columns, scene);
  }
  TracedLobes traced(const LobeTransportRequest& request, bool with_maps = true) const {
    return traced_lobes(*path.transport, surface, columns, worn, with_maps ? &*open : nullptr, request);
  }
  int size[2];
};

inline color::Rgb shown(const LobeTransport& t, std::size_t point, const std::vector<color::Rgb>& weights,
                        bool bounced) {
  color::Rgb sum;
  for (std::size_t k = 0; k < weights.size(); ++k) sum += weights[k] * t.light(point, k, bounced);
  return sum;
}
inline std::vector<color::Rgb> weights_of(const LobeColumns& columns, const paint::LobeFit& paint) {
  return *column_weights(columns, paint.diffuse, paint.lobes, brdf::kGlossIncidence_deg);
}

}  // namespace goniochrome::render::transport_stage
