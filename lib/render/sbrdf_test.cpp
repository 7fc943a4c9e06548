#include "render/sbrdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brdf/lobe_model.h"
#include "render/scenes_for_test.h"
#include "render/texture_places.h"

namespace goniochrome {
namespace {

// P_n of radiance 1 + d.y for any n: the lobe pulls d.y toward 0 by (n+1)/(n+2).
PrefilteredEnvironment slope_environment(const std::vector<double>& exponents, int size) {
  const auto filtered = [size](double n) {
    return cube_of(size, [n](const Vec3& d) { return (1 + (n + 1) / (n + 2) * d.y) * Vec3{1, 1, 1}; });
  };
  PrefilteredEnvironment env;
  env.diffuse.map = filtered(1);
  for (const double n : exponents) {
    PrefilteredLobe lobe;
    lobe.exponent = n;
    lobe.map = filtered(n);
    env.lobes.push_back(std::move(lobe));
  }
  return env;
}

SbrdfTexel phong_texel(double exponent) {
  return {{{0.1, 0.05, 0.02}, {{{0.3, 0.2, 0.1}, {-1, -1, 1}, exponent}}}, 1, 0};
}

const Vec3 kNormal = normalized({0.2, 0.9, 0.3}), kTangent = {1, 0, 0}, kViewer = normalized({-0.3, 0.8, 0.6});

TEST(SbrdfShader, PhongLobesAreThoseOfTheLobeModel) {
  const PrefilteredEnvironment env = slope_environment({4, 16, 64}, 32);
  const SbrdfShader shader(&env, nullptr, {});
  const Vec3 mirror = 2 * dot(kNormal, kViewer) * kNormal - kViewer;
  for (const double n : {4.0, 16.0, 64.0}) {
    const Rgb got = shader.shade(phong_texel(n), kNormal, kTangent, kViewer);
    const double lobe = 2 * std::numbers::pi / (n + 1) * dot(kNormal, mirror) * (1 + (n + 1) / (n + 2) * mirror.y);
    // Bilinear fetches of a slope on 32 texels a face err by about h^2/8 of it, h = 0.05.
    EXPECT_NEAR(got.x, 0.1 * std::numbers::pi * (1 + 2.0 / 3 * kNormal.y) + 0.3 * lobe, 2e-3) << n;
  }
}

TEST(SbrdfShader, BlendsNeighborsInTheLogarithmOfTheExponent) {
  const PrefilteredEnvironment env = slope_environment({4, 16, 64}, 32);
  const SbrdfShader shader(&env, nullptr, {});
  const auto mip = mip_cube(env);
  ASSERT_TRUE(mip.ok()) << mip.error().message;
  ASSERT_EQ(mip->levels.size(), 4u);
  EXPECT_EQ(mip->levels[3].size, 4);
  const SbrdfShader by_levels(&env, &*mip, {});
  double apart = 0;
  for (double n = 0.5; n < 200; n *= 1.3) {
    const double got = shader.shade(phong_texel(n), kNormal, kTangent, kViewer).x;
    const double level = by_levels.shade(phong_texel(n), kNormal, kTangent, kViewer).x;
    apart = std::max(apart, std::abs(level / got - 1));
    if (n < 1 || n > 64) continue;
    const Vec3 mirror = 2 * dot(kNormal, kViewer) * kNormal - kViewer;
    const double exact = 0.1 * std::numbers::pi * (1 + 2.0 / 3 * kNormal.y) + 0.3 * 2 * std::numbers::pi / (n + 1) *
                                                                                  dot(kNormal, mirror) *
                                                                                  (1 + (n + 1) / (n + 2) * mirror.y);
    EXPECT_NEAR(got / exact, 1, 0.02) << n;
  }
  // Coarse levels hold the same lobes on fewer texels.
  EXPECT_LT(apart, 0.03);
  EXPECT_FALSE(mip_cube(slope_environment({4, 20, 64}, 4)).ok());
}

TEST(SbrdfShader, LightsAreExactAndFramesTurn) {
  SbrdfTexel texel = phong_texel(20);
  texel.surface.lobes[0].axes = {-1, -0.5, 0.9};
  const Light light{normalized({0.5, 1, 0.2}), {2, 1, 1}};
  const SbrdfShader shader(nullptr, nullptr, {light});
  const Vec3 x = normalized(kTangent - dot(kTangent, kNormal) * kNormal), y = cross(kNormal, x);
  const auto local = [&](const Vec3& d) { return Vec3{dot(d, x), dot(d, y), dot(d, kNormal)}; };
  const Rgb f = brdf(texel.surface, local(light.direction), local(kViewer));
  EXPECT_NEAR(shader.shade(texel, kNormal, kTangent, kViewer).x,
              2 * std::numbers::pi * dot(kNormal, light.direction) * f.x, 1e-14);
  // A texel turned by 30 deg is the texel on a surface whose tangent is turned by 30 deg.
  const double turn = std::numbers::pi / 6;
  SbrdfTexel turned = texel;
  turned.x_tangent = std::cos(turn), turned.x_bitangent = std::sin(turn);
  EXPECT_NEAR(shader.shade(turned, kNormal, kTangent, kViewer).y,
              shader.shade(texel, kNormal, std::cos(turn) * x + std::sin(turn) * y, kViewer).y, 1e-14);
  EXPECT_NE(shader.shade(turned, kNormal, kTangent, kViewer).y, shader.shade(texel, kNormal, kTangent, kViewer).y);
  // From below, and with a tangent that says nothing.
  EXPECT_EQ(shader.shade(texel, kNormal, kTangent, -kViewer), Rgb{});
  EXPECT_TRUE(std::isfinite(shader.shade(texel, kNormal, kNormal, kViewer).x));
}

TEST(SbrdfShader, ColoredLightGoesThroughTheOperator) {
  const PrefilteredEnvironment env = slope_environment({4, 16}, 8);
  const ReflectionOperator iso = iso_rgb_operator();
  // The environment is white: nothing changes there. A cyan light keeps some red.
  const Light cyan{normalized({0.5, 1, 0.2}), {0, 1, 1}};
  const Rgb plain = SbrdfShader(&env, nullptr, {}).shade(phong_texel(9), kNormal, kTangent, kViewer);
  const Rgb same = SbrdfShader(&env, nullptr, {}, iso).shade(phong_texel(9), kNormal, kTangent, kViewer);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(same[c], plain[c], 1e-12);
  EXPECT_EQ(SbrdfShader(nullptr, nullptr, {cyan}).shade(phong_texel(9), kNormal, kTangent, kViewer).x, 0);
  EXPECT_GT(SbrdfShader(nullptr, nullptr, {cyan}, iso).shade(phong_texel(9), kNormal, kTangent, kViewer).x, 0.05);
}

TEST(SbrdfShader, ATextureIsItsTexelsShadedAndBlended) {
  const SbrdfTexture texture = {
      2, 1, 1, {0, 0, 0, 1, 0, 1, 1, 1, -1, -1, 1, 400, 0, 0, 0, 1, 0, 1, 1, 1, 0.8F, 0.8F, 0.6F, 400}};
  const SbrdfShader shader(nullptr, nullptr, {{normalized({0, 1, 0.2}), {1, 1, 1}}});
  const Vec3 n = {0, 1, 0}, viewer = normalized({0, 1, -0.2});
  const Rgb left = shader.shade(sbrdf_texel(texture, 0, 0), n, kTangent, viewer);
  const Rgb right = shader.shade(sbrdf_texel(texture, 1, 0), n, kTangent, viewer);
  EXPECT_NEAR(shader.shade(texture, 0.5, 0.5, n, kTangent, viewer).x, 0.5 * (left.x + right.x), 1e-12);
  EXPECT_NEAR(shader.shade(texture, 0.25, 0.5, n, kTangent, viewer).x, left.x, 1e-12);
  // The control, the mean of the parameters, has lost the highlight.
  SbrdfTexel mean = sbrdf_texel(texture, 0, 0);
  mean.surface.lobes[0].axes = {-0.1, -0.1, 0.8};
  EXPECT_LT(shader.shade(mean, n, kTangent, viewer).x, 1e-3 * left.x);
}

TEST(TexturePlaces, OwnCoordinatesAndThoseMadeAroundTheAxis) {
  Mesh mesh = sphere_mesh(64);
  Camera camera;
  camera.eye = {0, 0, 6};
  const auto pixels = rays(camera, 64, 64);
  ASSERT_TRUE(pixels.ok());
  const auto made = texture_places(mesh, *pixels, camera.eye, 64, 64, 1);
  const TexturePlace& middle = made[32 * 64 + 32];  // half a pixel right and down of the middle
  EXPECT_NEAR(middle.u, 0, 0.02);
  EXPECT_NEAR(middle.v, 1 / (2 * std::numbers::pi), 0.02);
  EXPECT_NEAR(middle.tangent[0], 1, 0.05);
  EXPECT_NEAR(middle.tangent[1], 0, 0.05);
  // Across the sphere u runs through a half turn, its own coordinates likewise.
  EXPECT_NEAR(made[32 * 64 + 40].u, std::asin((8.5 / 32) * std::tan(15 * M_PI / 180) * 5 / 1) / (2 * M_PI), 0.02);
  for (const Vec3& p : mesh.positions) mesh.texture.push_back({static_cast<float>(p.x), static_cast<float>(p.y)});
  const auto own = texture_places(mesh, *pixels, camera.eye, 64, 64, 3);
  EXPECT_NEAR(own[32 * 64 + 32].u, 0, 0.15);
  EXPECT_NEAR(own[20 * 64 + 40].tangent[0], 1, 0.4);
  EXPECT_GT(own[20 * 64 + 40].u, 0.3);
  EXPECT_GT(own[20 * 64 + 40].v, 0.3);
}

}  // namespace
}  // namespace goniochrome
