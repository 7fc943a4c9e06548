// All ways of laying a texture on a mesh, drawn by both engines.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "render/scene_effects.h"
#include "render/textures/textured_scene_for_test.h"

namespace goniochrome::render::layings_test {
namespace {

struct Way {
  const char* name;
  TextureLaying laying;
  bool facets = false;  // all three, blended
  bool alpha = false;   // of the texture, that ends where a decal ends
};

std::vector<Way> all_ways() {
  std::vector<Way> ways;
  const auto add = [&](const char* name, Projection projection) -> Way& {
    Way way{name, {}};
    way.laying.projection = projection, way.laying.width = 0.7, way.laying.aspect = 0.5, way.laying.turn_rad = 0.3;
    return ways.emplace_back(way);
  };
  add("uv", Projection::kOwn);
  add("planar", Projection::kPlanar).laying.axis = normalized({0.3, 0.2, 1});
  add("box", Projection::kBox);
  add("triplanar", Projection::kFacet).facets = true;
  add("cylinder", Projection::kCylinder).laying.around = 3;
  add("sphere", Projection::kSphere).laying.around = 3;
  for (const bool alpha : {false, true}) {
    Way& decal = add(alpha ? "decal with alpha" : "decal", Projection::kDecal);
    decal.laying.axis = normalized({0.4, 0.3, 1}), decal.laying.width = 0.9;
    decal.laying.half_texel_u = 1.0 / 16, decal.laying.half_texel_v = 1.0 / 8;
    decal.laying.ends = decal.alpha = alpha;
  }
  return ways;
}

// The largest difference of all pixels, edges of triangles and of the mesh among them.
double worst_of(const Frame& a, const Frame& b) {
  double worst = 0;
  for (std::size_t i = 0; i < a.picture.data.size(); i += 4) {
    const float *p = &a.picture.data[i], *q = &b.picture.data[i];
    worst = std::max(worst, seen_difference({p[0], p[1], p[2]}, {q[0], q[1], q[2]}, 1));
  }
  return worst;
}

// The control is the same picture without one lobe.
TEST_F(TexturedScene, EnginesAgreeOverAllLayings) {
  mesh.texture.clear();
  for (const Vec3& p : mesh.positions)
    mesh.texture.push_back({static_cast<float>(2 * p.x + 0.3 * p.y), static_cast<float>(p.y - 0.2 * p.z)});
  scene.paints[0].diffuse = {0.1, 0.2, 0.3};
  const std::vector<Light> lamp = {{normalized({0.4, 0.5, 1}), {1, 0.8, 0.6}}};
  const brdf::SbrdfTexture whole = texture;
  for (const Way& way : all_ways()) {
    texture = whole;
    if (way.alpha) {
      for (int i = 0; i < texture.width * texture.height; ++i) texture.alpha.push_back(i % 3 == 0 ? 1.0F : 0.4F);
      for (std::size_t i = 0; i < texture.values.size(); ++i) {
        const std::size_t value = i % static_cast<std::size_t>(texture.stride()), lobe = (value - 5) % 7;
        if (value < 3 || (value >= 5 && lobe < 3))
          texture.values[i] *= texture.alpha[i / static_cast<std::size_t>(texture.stride())];
      }
    }
    PartSurface surface{{{&texture, way.laying.projection == Projection::kOwn ? 1.5 : 1, way.laying}}};
    for (int facet = 1; way.facets && facet < 3; ++facet) {
      LaidTexture laid{&texture, 1, way.laying, true};
      laid.laying.facet = facet;
      surface.textures.push_back(laid);
    }
    for (const bool lit : {true, false}) {
      scene.env = lit ? nullptr : &env;
      scene.lights = lit ? lamp : std::vector<Light>();
      layer = std::make_unique<SurfaceLayer>(scene, std::vector<PartSurface>{surface}, brdf::CriticalAngle::kSlide);
      scene.layer = layer.get();
      for (const bool filter : {true, false}) {
        const std::string name =
            std::string(way.name) + (lit ? ", lamp" : ", environment") + (filter ? ", filter" : "");
        Effects effects = effects_of(scene);
        effects.texture_filter = filter;
        const Frame gl = drawn("gl", effects), cpu = drawn("cpu", effects);
        EXPECT_LT(worst_of(gl, cpu), 0.05) << name;
        effects.texture_lobes = 2;
        EXPECT_GT(worst_of(gl, drawn("cpu", effects)), 1) << name;
      }
    }
  }
}

}  // namespace
}  // namespace goniochrome::render::layings_test
