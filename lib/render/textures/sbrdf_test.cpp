#include "render/textures/sbrdf.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::sbrdf_test {
namespace {

// P_n of radiance 1 + d.y for any n: the lobe pulls d.y toward 0 by (n+1)/(n+2).
envmap::PrefilteredEnvironment slope_environment(const std::vector<double>& exponents, int size) {
  const auto filtered = [size](double n) {
    return cube_of(size, [n](const Vec3& d) { return (1 + (n + 1) / (n + 2) * d.y) * Vec3{1, 1, 1}; });
  };
  envmap::PrefilteredEnvironment env;
  env.diffuse.map = filtered(1);
  for (const double n : exponents) {
    envmap::PrefilteredLobe lobe;
    lobe.exponent = n;
    lobe.map = filtered(n);
    env.lobes.push_back(std::move(lobe));
  }
  return env;
}

brdf::SbrdfTexel phong_texel(double exponent) {
  return {{{0.1, 0.05, 0.02}, {{{0.3, 0.2, 0.1}, {-1, -1, 1}, exponent}}}, 1, 0};
}

const Vec3 kNormal = normalized({0.2, 0.9, 0.3}), kTangent = {1, 0, 0}, kViewer = normalized({-0.3, 0.8, 0.6});

brdf::SbrdfTexture texture_of(const std::vector<brdf::SbrdfTexel>& row) {
  brdf::SbrdfTexture texture{static_cast<int>(row.size()), 1, static_cast<int>(row.front().surface.lobes.size()), {}};
  const auto put = [&](double value) { texture.values.push_back(static_cast<float>(value)); };
  for (const brdf::SbrdfTexel& texel : row) {
    for (int c = 0; c < 3; ++c) put(texel.surface.diffuse[c]);
    put(texel.x_tangent * texel.x_tangent - texel.x_bitangent * texel.x_bitangent);
    put(2 * texel.x_tangent * texel.x_bitangent);
    for (const brdf::LafortuneLobe& lobe : texel.surface.lobes) {
      for (int c = 0; c < 3; ++c) put(lobe.albedo[c]);
      for (int c = 0; c < 3; ++c) put(lobe.axes[c]);
      put(lobe.exponent);
    }
  }
  return texture;
}

VisiblePoint point(const Vec3& normal, const Vec3& tangent, const Vec3& to_viewer, double u = 0.5) {
  VisiblePoint p{normal, to_viewer, 0, true, {}};
  p.place.u = static_cast<float>(u), p.place.v = 0.5F;
  for (int c = 0; c < 3; ++c) p.place.tangent[c] = static_cast<float>(tangent[c]);
  return p;
}

// One point on a surface of one texel.
color::Rgb shade(const brdf::SbrdfTexel& texel, const envmap::PrefilteredEnvironment* env, const SbrdfLight& light = {},
                 const MipCube* mip = nullptr, const VisiblePoint& at = point(kNormal, kTangent, kViewer)) {
  const brdf::SbrdfTexture texture = texture_of({texel});
  return SbrdfShader(env, mip, {&texture}).shade(0, light, {at}).front();
}

SbrdfLight lights_alone(const std::vector<Light>& lights) {
  SbrdfLight light;
  light.environment = false, light.lights = lights;
  return light;
}

SbrdfLight without_horizon() {
  SbrdfLight light;
  light.horizon = false;
  return light;
}

TEST(SbrdfShader, PhongLobesAreThoseOfTheLobeModel) {
  const envmap::PrefilteredEnvironment env = slope_environment({4, 16, 64}, 32);
  const Vec3 mirror = 2 * dot(kNormal, kViewer) * kNormal - kViewer;
  for (const double n : {4.0, 16.0, 64.0}) {
    const color::Rgb got = shade(phong_texel(n), &env, without_horizon());
    const double lobe = 2 * kPi / (n + 1) * dot(kNormal, mirror) * (1 + (n + 1) / (n + 2) * mirror.y);
    // Bilinear fetches of a slope on 32 texels a face err by about h^2/8 of it, h = 0.05.
    EXPECT_NEAR(got.x, 0.1 * kPi * (1 + 2.0 / 3 * kNormal.y) + 0.3 * lobe, 2e-3) << n;
  }
}

TEST(SbrdfShader, BlendsNeighborsInTheLogarithmOfTheExponent) {
  const envmap::PrefilteredEnvironment env = slope_environment({4, 16, 64}, 32);
  const auto mip = mip_cube(env);
  ASSERT_TRUE(mip.ok()) << mip.error().message;
  ASSERT_EQ(mip->levels.size(), 4u);
  EXPECT_EQ(mip->levels[3].size, 4);
  double apart = 0;
  for (double n = 0.5; n < 200; n *= 1.3) {
    const double got = shade(phong_texel(n), &env, without_horizon()).x;
    const double level = shade(phong_texel(n), &env, without_horizon(), &*mip).x;
    apart = std::max(apart, std::abs(level / got - 1));
    if (n < 1 || n > 64) continue;
    const Vec3 mirror = 2 * dot(kNormal, kViewer) * kNormal - kViewer;
    const double exact = 0.1 * kPi * (1 + 2.0 / 3 * kNormal.y) +
                         0.3 * 2 * kPi / (n + 1) * dot(kNormal, mirror) * (1 + (n + 1) / (n + 2) * mirror.y);
    EXPECT_NEAR(got / exact, 1, 0.02) << n;
  }
  // Coarse levels hold the same lobes on fewer texels.
  EXPECT_LT(apart, 0.03);
  EXPECT_FALSE(mip_cube(slope_environment({4, 20, 64}, 4)).ok());
}

TEST(SbrdfShader, MissesMapsOfLobesBeyondTheEnvironment) {
  envmap::PrefilteredEnvironment env = slope_environment({4, 16, 64}, 8);
  env.source = "hall.hdr";
  const auto told = [&](double exponent, const MipCube* mip = nullptr) -> std::string {
    const brdf::SbrdfTexture texture = texture_of({phong_texel(10), phong_texel(exponent)});
    const Result<void> all = SbrdfShader(&env, mip, {&texture}).has_all_maps();
    return all.ok() ? "" : all.error().message;
  };
  // The diffuse map is the lobe of exponent 1.
  for (const double exponent : {1.0, 3.0, 64.0}) EXPECT_EQ(told(exponent), "") << exponent;
  EXPECT_NE(told(100).find("`prefilter-envmap hall.hdr --exponents 1,4,16,64,100 "), std::string::npos) << told(100);
  EXPECT_NE(told(0.5).find("--exponents 0.5,1,4,16,64 "), std::string::npos) << told(0.5);
  const auto mip = mip_cube(env);
  ASSERT_TRUE(mip.ok());
  EXPECT_NE(told(100, &*mip).find("--exponents 4,16,64,256 "), std::string::npos) << told(100, &*mip);
  EXPECT_NE(told(0.5, &*mip).find("--exponents 0.5,1,4,16,64 "), std::string::npos) << told(0.5, &*mip);
  EXPECT_NE(told(0.5, &*mip).find("in cubes"), std::string::npos) << told(0.5, &*mip);
  // A lobe that reflects nothing needs no map, nor does one that is lit by lamps alone.
  brdf::SbrdfTexel dark = phong_texel(100);
  dark.surface.lobes[0].albedo = {};
  const brdf::SbrdfTexture texture = texture_of({phong_texel(10), dark}), sharp = texture_of({phong_texel(5000)});
  EXPECT_TRUE(SbrdfShader(&env, nullptr, {&texture}).has_all_maps().ok());
  EXPECT_TRUE(SbrdfShader(nullptr, nullptr, {&sharp}).has_all_maps().ok());
}

// Single precision, some tens of operations: a few 1e-6.
constexpr double kFloat = 1e-5;

TEST(SbrdfShader, LightsAreExactAndFramesTurn) {
  brdf::SbrdfTexel texel = phong_texel(20);
  texel.surface.lobes[0].axes = {-1, -0.5, 0.9};
  const Light light{normalized({0.5, 1, 0.2}), {2, 1, 1}};
  const SbrdfLight lit = lights_alone({light});
  const brdf::SurfaceFrame frame = brdf::surface_frame(texel, kNormal, kTangent);
  const color::Rgb f = brdf::brdf(texel.surface, frame.local(light.direction), frame.local(kViewer));
  const double wanted = 2 * kPi * dot(kNormal, light.direction) * f.x;
  EXPECT_NEAR(shade(texel, nullptr, lit).x / wanted, 1, kFloat);
  // A texel turned by 30 deg is the texel on a surface whose tangent is turned by 30 deg.
  const double turn = kPi / 6;
  brdf::SbrdfTexel turned = texel;
  turned.x_tangent = std::cos(turn), turned.x_bitangent = std::sin(turn);
  const double got = shade(turned, nullptr, lit).y;
  const VisiblePoint other = point(kNormal, std::cos(turn) * frame.x + std::sin(turn) * frame.y, kViewer);
  EXPECT_NEAR(shade(texel, nullptr, lit, nullptr, other).y / got, 1, kFloat);
  EXPECT_GT(std::abs(shade(texel, nullptr, lit).y / got - 1), 0.01);
  // From below, and with a tangent that says nothing.
  EXPECT_EQ(shade(texel, nullptr, lit, nullptr, point(kNormal, kTangent, -kViewer)), color::Rgb{});
  EXPECT_TRUE(std::isfinite(shade(texel, nullptr, lit, nullptr, point(kNormal, kNormal, kViewer)).x));
}

// lafortune-power in single precision: the textbook form, rho pow(|p|, n), is the control.
TEST(SbrdfShader, LafortunePower) {
  const Vec3 n = {0, 1, 0}, viewer = normalized({0.4, 1, 0});
  for (const auto& [axes, exponent, albedo] : {std::tuple{Vec3{-3, -3, 3}, 120.0, 1e-30},
                                               {Vec3{-0.2, -0.2, 0.2}, 80.0, 1e30},
                                               {Vec3{-1, -1, 1}, 0.2, 1.0},
                                               {Vec3{-1, -1, 1}, 2e5, 1e4},
                                               {Vec3{1, 1, -1}, 5.0, 1.0},
                                               {Vec3{0, 0, 0}, 3.0, 1.0}}) {
    brdf::SbrdfTexel texel;
    texel.surface.lobes = {{albedo * color::Rgb{1, 0.5, 0.25}, axes, exponent}};
    const brdf::SurfaceFrame frame = brdf::surface_frame(texel, n, kTangent);
    const Vec3 p = frame.world(axes * frame.local(viewer));
    const Vec3 light = length(p) > 0 && p.y > 0 ? normalized(p) : n;
    const double wanted = kPi * light.y * brdf::brdf(texel.surface, frame.local(light), frame.local(viewer)).x;
    const double got = shade(texel, nullptr, lights_alone({{light, {1, 1, 1}}}), nullptr, point(n, kTangent, viewer)).x;
    // n times the rounding of the direction, squared, at most.
    EXPECT_NEAR(got, wanted, std::max(1e-4 * wanted, 1e-30)) << exponent;
    EXPECT_TRUE(std::isfinite(got));
  }
  const float size = 3, exponent = 120, tiny = 1e-30F;
  EXPECT_TRUE(std::isinf(std::pow(size, exponent) * tiny)) << "the control";
}

TEST(SbrdfShader, ColoredLightGoesThroughTheOperator) {
  const envmap::PrefilteredEnvironment env = slope_environment({4, 16}, 8);
  SbrdfLight iso;
  iso.reflection = color::iso_rgb_operator();
  // The environment is white: nothing changes there. A cyan light keeps some red.
  const color::Rgb plain = shade(phong_texel(9), &env), same = shade(phong_texel(9), &env, iso);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(same[c] / plain[c], 1, kFloat);
  SbrdfLight cyan = lights_alone({{normalized({0.5, 1, 0.2}), {0, 1, 1}}});
  EXPECT_EQ(shade(phong_texel(9), nullptr, cyan).x, 0);
  cyan.reflection = color::iso_rgb_operator();
  const color::Rgb got = shade(phong_texel(9), nullptr, cyan);
  EXPECT_GT(got.x, 0.05);
  const Vec3 x = normalized(kTangent - dot(kTangent, kNormal) * kNormal), y = cross(kNormal, x);
  const auto local = [&](const Vec3& d) { return Vec3{dot(d, x), dot(d, y), dot(d, kNormal)}; };
  const Light& light = cyan.lights[0];
  const color::Rgb f = brdf::brdf(phong_texel(9).surface, local(light.direction), local(kViewer));
  const color::Rgb wanted = kPi * dot(kNormal, light.direction) * color::reflected(cyan.reflection, light.white, f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / wanted[c], 1, kFloat);
}

// A constant environment shows the albedo: the integral of f cos_i above the surface. Without the horizon, a wide lobe
// at a grazing view is far from it.
TEST(SbrdfShader, LobesEndAtTheHorizon) {
  const envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {4, 16, 64});
  const Vec3 n = {0, 1, 0};
  for (const double cos_o : {0.9, 0.5, 0.15}) {
    const Vec3 viewer = {std::sqrt(1 - cos_o * cos_o), cos_o, 0}, mirror = {-viewer.x, viewer.y, 0};
    brdf::SbrdfTexel texel;
    texel.surface.lobes = {{{1, 1, 1}, {-1, -1, 1}, 9}};
    double exact = 0;
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < 2 * kSteps; ++j) {
        const double y = (i + 0.5) / kSteps, a = kPi * (j + 0.5) / kSteps, r = std::sqrt(1 - y * y);
        const double cosine = dot(mirror, {r * std::cos(a), y, r * std::sin(a)});
        if (cosine > 0) exact += y * std::pow(cosine, 9) * kPi / (kSteps * kSteps);
      }
    }
    const VisiblePoint at = point(n, kTangent, viewer);
    EXPECT_NEAR(shade(texel, &env, {}, nullptr, at).x / exact, 1, 5e-3) << cos_o;  // 3e-3 of the curves, and their grid
    if (cos_o > 0.3) continue;
    EXPECT_GT(std::abs(shade(texel, &env, without_horizon(), nullptr, at).x / exact - 1), 0.1) << "the control";
  }
}

TEST(SbrdfShader, LobesThatAreOffAreMissing) {
  brdf::SbrdfTexel texel = phong_texel(20);
  texel.surface.lobes.push_back({{1, 2, 3}, {-1, -1, 1}, 5});
  SbrdfLight both = lights_alone({{kNormal, {1, 1, 1}}}), first = both, second = both, none = both;
  first.lobes = 1, second.lobes = 2, none.lobes = 0;
  const double diffuse = shade(texel, nullptr, none).x;
  EXPECT_NEAR(diffuse, kPi * 0.1, 1e-6);
  EXPECT_NEAR(shade(texel, nullptr, first).x + shade(texel, nullptr, second).x - diffuse, shade(texel, nullptr, both).x,
              1e-5);
  EXPECT_GT(shade(texel, nullptr, first).x, diffuse);
}

TEST(SbrdfShader, ATextureIsItsTexelsShadedAndBlended) {
  brdf::SbrdfTexel one, other;
  one.surface.lobes = {{{1, 1, 1}, {-1, -1, 1}, 400}}, other.surface.lobes = {{{1, 1, 1}, {0.8, 0.8, 0.6}, 400}};
  const brdf::SbrdfTexture texture = texture_of({one, other});
  const SbrdfShader shader(nullptr, nullptr, {&texture});
  const SbrdfLight lit = lights_alone({{normalized({0, 1, 0.2}), {1, 1, 1}}});
  const Vec3 n = {0, 1, 0}, viewer = normalized({0, 1, -0.2});
  const auto at = [&](double u) { return shader.shade(0, lit, {point(n, kTangent, viewer, u)}).front().x; };
  EXPECT_NEAR(at(0.5), 0.5 * (at(0.25) + at(0.75)), kFloat * at(0.25));
  EXPECT_GT(at(0.25), 1);
  // The control, the mean of the parameters, has lost the highlight.
  brdf::SbrdfTexel mean = one;
  mean.surface.lobes[0].axes = {-0.1, -0.1, 0.8};
  EXPECT_LT(shade(mean, nullptr, lit, nullptr, point(n, kTangent, viewer)).x, 1e-3 * at(0.25));
}

// Lobes with frames of their own are the sum of two surfaces that have one each; beside a texel that differs from it
// only in these frames, each keeps its own. One frame for all is the control.
TEST(SbrdfShader, LobesAreDrawnInFramesOfTheirOwn) {
  const brdf::LafortuneLobe wide{{0.5, 0.4, 0.3}, {-1, -0.3, 1}, 20}, narrow{{0.2, 0.4, 0.3}, {-1, -0.5, 1}, 60};
  brdf::SbrdfTexel both, first, second;
  both.surface.lobes = {wide, narrow}, first.surface.lobes = {wide}, second.surface.lobes = {narrow};
  first.x_tangent = std::cos(0.3), first.x_bitangent = std::sin(0.3);
  second.x_tangent = std::cos(1.1), second.x_bitangent = std::sin(1.1);
  brdf::SbrdfTexture texture = texture_of({both, both});
  for (const brdf::SbrdfTexel* of : {&first, &second, &second, &first}) {
    const std::vector<float> values = texture_of({*of}).values;
    texture.turns.insert(texture.turns.end(), values.begin() + 3, values.begin() + 5);
  }
  const SbrdfLight lit = lights_alone({{normalized({0.5, 1, -0.4}), {1, 1, 1}}});
  const auto at = [&](const brdf::SbrdfTexture& of, double u) {
    return SbrdfShader(nullptr, nullptr, {&of}).shade(0, lit, {point(kNormal, kTangent, kViewer, u)}).front();
  };
  const double sum = shade(first, nullptr, lit).x + shade(second, nullptr, lit).x;
  EXPECT_NEAR(at(texture, 0.25).x / sum, 1, kFloat);
  EXPECT_NEAR(at(texture, 0.5).x / (0.5 * (at(texture, 0.25).x + at(texture, 0.75).x)), 1, kFloat);
  EXPECT_GT(std::abs(at(texture, 0.75).x / sum - 1), 0.05);
  texture.turns.clear();
  EXPECT_GT(std::abs(at(texture, 0.25).x / sum - 1), 0.05);
}

TEST(SbrdfShader, TheSameInAnyCompany) {
  const envmap::PrefilteredEnvironment env = slope_environment({4, 16, 64}, 16);
  const brdf::SbrdfTexture texture = texture_of({phong_texel(20), phong_texel(50), phong_texel(5)});
  const SbrdfShader shader(&env, nullptr, {&texture});
  TestNumbers number(3);
  std::vector<VisiblePoint> points;
  for (int i = 0; i < 150; ++i)
    points.push_back(point(normalized({number() - 0.5, 1, number()}), kTangent, {0, 1, 0}, number()));
  const std::vector<color::Rgb> together = shader.shade(0, {}, points);
  for (std::size_t i = 0; i < points.size(); i += 7) EXPECT_EQ(shader.shade(0, {}, {points[i]}).front(), together[i]);
}

TEST(SbrdfShader, AMeanTexelKeepsEnergyAndTheCommonDirection) {
  brdf::SbrdfTexel a, b;
  a.surface.lobes = {{{0.2, 0.1, 0.1}, {-1, -0.6, 1}, 9}}, b.surface.lobes = {{{0.4, 0.2, 0.2}, {-1, -0.6, 1}, 9}};
  a.surface.diffuse = {0.1, 0, 0}, b.surface.diffuse = {0.3, 0, 0};
  for (const double turn : {0.0, 0.5 * kPi}) {
    b.x_tangent = std::cos(turn), b.x_bitangent = std::sin(turn);
    const brdf::SbrdfTexel mean = brdf::sbrdf_texel(brdf::mean_texture(texture_of({a, b})), 0, 0);
    const brdf::LafortuneLobe& lobe = mean.surface.lobes[0];
    EXPECT_NEAR(mean.surface.diffuse.x, 0.2, 1e-7);
    EXPECT_NEAR(lobe.albedo.x, 0.3, 1e-6);
    EXPECT_NEAR(lobe.exponent, 9, 1e-5);
    // Across each other, the stronger third of the energy is left of the difference.
    const double odd = turn == 0 ? 0.2 : 0.2 / 3;
    EXPECT_NEAR(std::abs(lobe.axes.x - lobe.axes.y), 2 * odd, 1e-6);
    EXPECT_NEAR(lobe.axes.x + lobe.axes.y, -1.6, 1e-6);
    EXPECT_NEAR(lobe.axes.z, 1, 1e-7);
  }
  // Alike texels shine as their mean, which may name the axes the other way round.
  const brdf::SbrdfTexel mean = brdf::sbrdf_texel(brdf::mean_texture(texture_of({a, a, a})), 0, 0);
  const SbrdfLight lit = lights_alone({{normalized({0.5, 1, 0.2}), {1, 1, 1}}});
  EXPECT_NEAR(shade(mean, nullptr, lit).x / shade(a, nullptr, lit).x, 1, kFloat);
}

}  // namespace
}  // namespace goniochrome::render::sbrdf_test
