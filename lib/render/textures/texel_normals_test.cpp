// Maps whose texels have normals of their own, beside meshes whose vertices have these normals.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "base/random_for_test.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/scene_effects.h"
#include "render/textures/texture_filter.h"
#include "render/textures/textured_scene_for_test.h"

namespace goniochrome::render::texel_normals_test {
namespace {

// The normals of a surface of this slope along x.
Vec3 of_slope(double slope) {
  return normalized({-slope, 0, 1});
}

void put_normal(brdf::SbrdfTexture& texture, const Vec3& normal) {
  for (int c = 0; c < 3; ++c) texture.normals.push_back(static_cast<float>(normal[c]));
}

// A flat square from -1 to 1 that faces +Z. `across` and `up` say how u and v run.
mesh::Mesh square(int cells, double across = 1, double up = 1) {
  mesh::Mesh mesh;
  for (int j = 0; j <= cells; ++j) {
    for (int i = 0; i <= cells; ++i) {
      const double x = 2.0 * i / cells - 1, y = 2.0 * j / cells - 1;
      mesh.positions.push_back({x, y, 0}), mesh.normals.push_back({0, 0, 1});
      mesh.texture.push_back({static_cast<float>(0.5 + 0.5 * across * x), static_cast<float>(0.5 + 0.5 * up * y)});
    }
  }
  for (int j = 0; j < cells; ++j) {
    for (int i = 0; i < cells; ++i) {
      const auto a = static_cast<std::uint32_t>(j * (cells + 1) + i), b = a + static_cast<std::uint32_t>(cells) + 1;
      mesh.triangles.push_back({a, a + 1, b + 1}), mesh.triangles.push_back({a, b + 1, b});
    }
  }
  mesh.parts = {{"square", "", 0, mesh.triangles.size()}};
  return mesh;
}

class TexelNormals : public TexturedScene {
 protected:
  TexelNormals() : source_(sloping_source()), blocks_(source_) {
    scene.lights = {{normalized({0.4, 0.5, 1}), {1, 0.8, 0.6}}, {normalized({-1, 0.3, 0.6}), {0.3, 0.3, 0.5}}};
    look_from({0.6, 0.5, 3});
  }
  void look_from(const Vec3& eye) { view = {{eye, {0, 0, 0}, {0, 1, 0}, 40}, 48, 48, 1, true}; }
  // Paths see lamps alone and do not bounce, which leaves no noise.
  Frame picture(const char* engine, const brdf::SbrdfTexture& map, const mesh::Mesh& on) {
    mesh = on, texture = map;
    scene.env = engine == std::string("path") ? nullptr : &env;
    scene.texels = engine == std::string("integral") ? &blocks_ : nullptr;
    layer =
        std::make_unique<SurfaceLayer>(scene, std::vector<PartSurface>{{{{&texture, 1}}}}, brdf::CriticalAngle::kSlide);
    scene.layer = layer.get();
    return drawn(engine, effects_of(scene), 0);
  }
  static double worst(const Frame& a, const Frame& b) {
    double most = 0;
    for (std::size_t i = 0; i < a.picture.data.size(); ++i)
      if (i % 4 != 3) most = std::max<double>(most, std::abs(a.picture.data[i] - b.picture.data[i]));
    return most;
  }

 private:
  envmap::Environment source_;
  envmap::BlockTree blocks_;
};

// The texture is brushed in many directions, so that tangents count as well. The map without normals is the control.
TEST_F(TexelNormals, ATiltedMapIsASurfaceWithThatNormal) {
  const Vec3 own = normalized({0.3, -0.2, 1});
  const brdf::SbrdfTexture flat = brushed_texture();
  brdf::SbrdfTexture tilted = flat;
  for (int i = 0; i < flat.width * flat.height; ++i) put_normal(tilted, own);
  mesh::Mesh turned = square(2);
  turned.normals.assign(turned.normals.size(), own);
  for (const char* engine : {"cpu", "gl", "integral", "path"}) {
    scene.lights[0].radius_rad = engine == std::string("path") ? 0 : 0.02;
    const Frame wanted = picture(engine, flat, turned), shown = picture(engine, tilted, square(2)),
                control = picture(engine, flat, square(2));
    EXPECT_LT(worst(shown, wanted), 4e-4) << engine;  // of 0 to 3, in floats; the integral ends at 1e-4
    EXPECT_GT(worst(control, wanted), 0.1) << engine;
  }
}

// u or v that run backward, and the back of the square: the relief turns with them. The control is the relief that does
// not.
TEST_F(TexelNormals, MirroredCoordinatesMirrorTheRelief) {
  brdf::SbrdfTexture map{1, 1, 1, {0.2F, 0.1F, 0.05F, 1, 0, 0.5F, 0.4F, 0.3F, -1, -1, 1, 16}}, flat = map;
  const Vec3 own = normalized({0.4, 0.25, 1});
  put_normal(map, own);
  for (const char* engine : {"cpu", "path"}) {
    for (const double side : {1.0, -1.0}) {
      look_from({0.6, 0.5, 3 * side});
      for (Light& light : scene.lights) light.direction.z = side * std::abs(light.direction.z);
      for (const auto& [across, up] : {std::pair{1.0, 1.0}, {-1.0, 1.0}, {1.0, -1.0}, {-1.0, -1.0}}) {
        mesh::Mesh turned = square(2);
        turned.normals.assign(turned.normals.size(), side * Vec3{across * own.x, up * own.y, side * own.z});
        const Frame wanted = picture(engine, flat, turned), shown = picture(engine, map, square(2, across, up));
        EXPECT_LT(worst(shown, wanted), 1e-4) << engine << side << across << up;
        const Frame control = picture(engine, map, square(2, -across, up));
        EXPECT_GT(worst(control, wanted), 0.05) << engine << side << across << up;
      }
    }
  }
}

// Left of a seam u runs to the left, as on a body whose halves share a texture. Tangents of both sides at the vertices
// of the seam would cancel out.
TEST_F(TexelNormals, TangentsOfMirroredHalvesAreNotMixed) {
  mesh::Mesh seam = square(2);
  for (auto& uv : seam.texture) uv[0] = std::abs(uv[0] - 0.5F);
  const TextureLayout layout(seam, {true});
  int mirrored = 0;
  for (std::uint32_t triangle = 0; triangle < seam.triangles.size(); ++triangle) {
    MeshPoint point;
    point.triangle = triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      point.shares = {0.05, 0.05, 0.05}, point.shares[k] = 0.9;
      const TexturePlace place = layout.place(0, point, false);
      EXPECT_NEAR(place.tangent[0], place.mirrored ? -1 : 1, 1e-6) << triangle;
      mirrored += place.mirrored;
    }
  }
  EXPECT_EQ(mirrored, 12);
}

// Coordinates that are the same everywhere have no tangent, and a normal may lie along one.
TEST_F(TexelNormals, DegenerateTangentsAreDrawn) {
  brdf::SbrdfTexture map{1, 1, 1, {0.2F, 0.1F, 0.05F, 1, 0, 0.5F, 0.4F, 0.3F, -1, -0.5F, 1, 16}};
  put_normal(map, normalized({1, 0, 1e-4}));
  mesh::Mesh nowhere = square(1);
  for (auto& uv : nowhere.texture) uv = {0.5F, 0.5F};
  for (const char* engine : {"cpu", "integral", "path"})
    for (const mesh::Mesh& plate : {nowhere, square(1)})
      for (const float value : picture(engine, map, plate).picture.data)
        EXPECT_TRUE(std::isfinite(value) && value >= 0) << engine;
}

// Waves as fine as the cells of the mesh: colors are interpolated here and normals there.
TEST_F(TexelNormals, WavesAreThoseOfAMeshWithTheseNormals) {
  constexpr int kTexels = 128;
  const auto normal = [](double u) { return of_slope(0.4 * std::sin(2 * kPi * u)); };
  brdf::SbrdfTexture flat{kTexels, 1, 1, {}};
  for (int i = 0; i < kTexels; ++i)
    for (const float value : {0.1F, 0.1F, 0.1F, 1.0F, 0.0F, 0.5F, 0.5F, 0.5F, -1.0F, -1.0F, 1.0F, 16.0F})
      flat.values.push_back(value);
  brdf::SbrdfTexture waves = flat;
  for (int i = 0; i < kTexels; ++i) put_normal(waves, normal((i + 0.5) / kTexels));
  mesh::Mesh turned = square(kTexels);
  for (std::size_t i = 0; i < turned.normals.size(); ++i) turned.normals[i] = normal(turned.texture[i][0]);
  for (const char* engine : {"cpu", "path"}) {
    const Frame wanted = picture(engine, flat, turned), shown = picture(engine, waves, square(2)),
                control = picture(engine, flat, square(2));
    EXPECT_LT(difference(shown, wanted), 0.1) << engine;
    EXPECT_GT(difference(control, wanted), 5) << engine;
  }
}

// In even light a matt surface is as bright as that light wherever its normals look, and in any light lobes change
// little where a normal comes to look away from the viewer.
TEST_F(TexelNormals, HardCase_NormalsThatLookAwayHaveNoFringe) {
  env = constant_env({1, 1, 1}, {4, 16, 64, 256});
  brdf::SbrdfTexture matt{32, 32, 0, {}};
  TestNumbers random(5);
  for (int i = 0; i < 32 * 32; ++i) {
    const double tilt = 1.5 * std::sqrt(random()), turn = 2 * kPi * random();
    for (const double value : {1 / kPi, 1 / kPi, 1 / kPi, 1.0, 0.0}) matt.values.push_back(static_cast<float>(value));
    put_normal(matt, {std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt)});
  }
  scene.lights.clear();
  look_from({2.9, 0.3, 0.4});
  const Frame white = picture("cpu", matt, square(1));
  int seen = 0;
  double ours = 0, textbook = 0;  // which shows nothing of a texel that looks away
  for (int y = 0; y < 48; ++y) {
    for (int x = 0; x < 48; ++x) {
      if (white.gbuffer->part(x, y) != 0) continue;
      ours = worst_of(ours, std::abs(white.picture.pixel(x, y)[1] - 1.0));
      const auto texel = static_cast<std::size_t>(seen++);
      textbook = worst_of(textbook, dot(matt.normal(texel), white.gbuffer->to_viewer(x, y)) > 0 ? 0 : 1);
    }
  }
  EXPECT_GT(seen, 50);
  hard_case("normal-away", {"a white map in even light, of normals up to 86 deg", textbook, ours, 1e-4, "radiance"});
  // Below the surface a texel sees the surface, which bounces that light: without bounces it is dark there.
  const envmap::Environment source = environment_of(16, 8, [](int, int) { return color::Rgb{1, 1, 1}; });
  const envmap::BlockTree blocks(source);
  scene.env = nullptr, scene.texels = &blocks;
  const auto mean_by_paths = [&](int bounces) {
    const Frame frame = drawn("path", effects_of(scene), bounces);
    double sum = 0;
    for (int i = 0; i < 48 * 48; ++i)
      if (frame.gbuffer->part(i % 48, i / 48) == 0) sum += frame.picture.pixel(i % 48, i / 48)[1] / seen;
    return sum;
  };
  EXPECT_NEAR(mean_by_paths(8), 1, 0.02);
  EXPECT_LT(mean_by_paths(0), 0.95);

  const Vec3 viewer = normalized({0.95, 0, 0.3}), up = {0, 0, 1}, tangent = {1, 0, 0};
  const auto turned = [&](double tilt) {
    return brdf::texel_normal({std::sin(tilt), 0, std::cos(tilt)}, up, tangent, viewer);
  };
  Vec3 before = turned(-1.5);
  for (double tilt = -1.5; tilt < 1.5; tilt += 0.001) {
    const Vec3 n = turned(tilt);
    EXPECT_NEAR(length(n), 1, 1e-12);
    EXPECT_GT(dot(n, viewer), 1e-4) << tilt;
    EXPECT_LT(length(n - before), 0.002) << tilt;
    before = n;
  }
}

// The coarsest level of a rough map, which is one texel, beside the mean over all texels. The control is a lobe that
// keeps its width.
TEST_F(TexelNormals, AMeanTexelIsAsWideAsItsNormalsVary) {
  constexpr int kTexels = 32;
  TestNumbers random(7);
  for (const double slope : {0.1, 0.25}) {
    brdf::SbrdfTexture rough{kTexels, kTexels, 1, {}};
    const auto put = [](brdf::SbrdfTexture& to) {
      for (const float value : {0.05F, 0.05F, 0.05F, 1.0F, 0.0F, 5.0F, 5.0F, 5.0F, -1.0F, -1.0F, 1.0F, 64.0F})
        to.values.push_back(value);
    };
    for (int row = 0; row < kTexels; ++row) {
      for (int column = 0; column < kTexels; ++column) {
        put(rough);
        const double away = slope * std::sqrt(-2 * std::log(1 - random())), turn = 2 * kPi * random();
        put_normal(rough, normalized({away * std::cos(turn), away * std::sin(turn), 1}));
      }
    }
    brdf::SbrdfTexture narrow{1, 1, 1, {}};
    put(narrow);
    const SbrdfShader shader(nullptr, nullptr, {&rough, &narrow});
    const Vec3 viewer = normalized({0.5, 0, 1});
    double off = 0, control = 0, all = 0;
    for (int k = 0; k < 40; ++k) {
      const double angle = (2.2 * k - 40) * kDegree;
      const SbrdfLight light{false, {{normalized({-std::sin(angle), 0.1, std::cos(angle)}), {1, 1, 1}}}};
      std::vector<VisiblePoint> points;
      for (int row = 0; row < kTexels; ++row)
        for (int column = 0; column < kTexels; ++column) {
          VisiblePoint& point = points.emplace_back(VisiblePoint{{0, 0, 1}, viewer, 0, true});
          point.place.u = static_cast<float>((column + 0.5) / kTexels);
          point.place.v = static_cast<float>((row + 0.5) / kTexels);
          point.place.tangent[0] = 1;
        }
      double mean = 0;
      for (const color::Rgb& color : shader.shade(0, light, points)) mean += color.y / (kTexels * kTexels);
      points.resize(1);
      off += std::abs(shader.shade(0, light, points, 5)[0].y - mean);
      control += std::abs(shader.shade(1, light, points)[0].y - mean);
      all += mean;
    }
    EXPECT_LT(off, (slope < 0.2 ? 0.05 : 0.2) * all) << slope;
    EXPECT_GT(control, 10 * off) << slope;
  }
}

}  // namespace
}  // namespace goniochrome::render::texel_normals_test
