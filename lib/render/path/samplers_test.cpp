// Chi-square tests of every sampler: what is drawn falls into bins as the density that the sampler states.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/path/chi_square_for_test.h"
#include "render/path/emitters.h"
#include "render/path/environment_table.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/path/traced_paint.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::samplers_test {
namespace {

using rays::Float3;
using rays::float3;

color::Rgb uneven(int x, int y) {
  const double sun = x == 5 && y == 3 ? 4 : 0;
  return {0.2 + 0.1 * x + sun, y == 7 ? 0.0 : 0.3, 0.05 * ((x * 7 + y * 3) % 11) + sun};
}

double excess_of(const envmap::Environment& environment, double wrong_factor = 1) {
  const EnvironmentTable table(environment);
  const SphereBins bins({0, 1, 0}, 16, 32);
  return excess(
      bins, 400000,
      [&](double, double u, double v) -> std::optional<Vec3> {
        const LightSample light = table.drawn(u, v);
        if (!(light.pdf > 0)) return std::nullopt;
        return rays::vec3(light.direction);
      },
      [&](const Vec3& d) {
        const double pdf = table.at(float3(d)).pdf;
        return d.y > 0 ? wrong_factor * pdf : pdf;
      },
      3600);
}

TEST(Samplers, TheEnvironmentIsDrawnAsItsDensitySays) {
  EXPECT_LT(excess_of(environment_of(32, 16, uneven)), 5);
  EXPECT_GT(excess_of(environment_of(32, 16, uneven), 1.05), 5);  // control
  const envmap::CubeMap cube =
      cube_of(8, [](const Vec3& d) { return Vec3{1.1 + d.x, d.y > 0.5 ? 5.0 : 0.2, 1 + d.z * d.z}; });
  EXPECT_LT(excess_of(envmap::Environment::from_cube(cube, "cube")), 5);
  image::Image disc{24, 24, 3, std::vector<float>(24 * 24 * 3, 0.5F), {}};
  for (std::size_t i = 0; i < disc.data.size(); i += 7) disc.data[i] = 2;
  EXPECT_LT(excess_of(envmap::Environment::from_angular(disc, envmap::Environment::BadPixels::kError, "disc").value()),
            5);
}

TEST(Samplers, TheEnvironmentsDensityAgreesWithWhatIsDrawn) {
  const envmap::Environment environment = environment_of(64, 32, uneven);
  const EnvironmentTable table(environment);
  TestNumbers next(3);
  int neighbors = 0;
  double integral = 0;
  constexpr int kCount = 20000;
  for (int i = 0; i < kCount; ++i) {
    const LightSample light = table.drawn(next(), next());
    const LightSample again = table.at(light.direction);
    // A direction in floats may fall across the edge of a texel.
    if (again.radiance != light.radiance) {
      ++neighbors;
    } else {
      EXPECT_NEAR(again.pdf / light.pdf, 1, 1e-4);
    }
    integral += light.radiance.x / light.pdf / kCount;
  }
  EXPECT_LT(neighbors, kCount / 1000);
  EXPECT_NEAR(integral / environment.flux().x, 1, 0.02);  // relative spread of the ratio .7: five deviations are .025
}

// The density of a cube's texels is that of their grid at every direction: of cubes whose texels lie on the edges of
// faces too, whose outer cells are half as wide. The control takes all cells to be of one size.
TEST(Samplers, TheDensityOnACubeIsThatOfItsGrid) {
  const auto value = [](const Vec3& d) { return Vec3{1.1 + d.x, d.y > 0.5 ? 5.0 : 0.2, 1 + d.z * d.z}; };
  const envmap::CubeMap map = cube_of(8, value);
  image::Image strip{8, 48, 3, map.texels, {}};
  const auto edges = envmap::Environment::from_cube_edges(strip, envmap::Environment::BadPixels::kError, "edges");
  ASSERT_TRUE(edges.ok());
  TestNumbers next(11);
  double control = 0;
  for (const envmap::Environment& environment : {envmap::Environment::from_cube(map, "cube"), *edges}) {
    const EnvironmentTable table(environment);
    const Vec3 flux = environment.flux();
    const double total = (flux.x + flux.y + flux.z) / 3;
    for (int i = 0; i < 2000; ++i) {
      const LightSample drawn = table.drawn(next(), next());
      const envmap::GridPosition at = environment.grid().position(rays::vec3(drawn.direction));
      const int column = static_cast<int>(at.column), row = static_cast<int>(at.row);
      const float* rgb = environment.radiance(column, row);
      const double mean = (static_cast<double>(rgb[0]) + rgb[1] + rgb[2]) / 3,
                   of_texel = mean * environment.solid_angle(column, row) / total,
                   density = environment.solid_angle_density(at.column, at.row), size = environment.width();
      if (std::abs(at.column - std::round(at.column)) < 1e-3 || std::abs(at.row - std::round(at.row)) < 1e-3) continue;
      // Shares are cumulated in floats.
      EXPECT_NEAR(table.at(drawn.direction).pdf, of_texel / density, 1e-4 * of_texel / density);
      EXPECT_NEAR(drawn.pdf, of_texel / density, 1e-4 * of_texel / density);
      const Vec3 d = rays::vec3(drawn.direction);
      const double along = std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)});
      control = std::max(control, std::abs(4 / (size * size) * along * along * along / density - 1));
    }
  }
  EXPECT_GT(control, 0.1);
}

paint::LobeFit glossy() {
  paint::LobeFit paint;
  paint.diffuse = {0.1, 0.05, 0.02};
  paint.lobes = {{2, {0.05, 0.1, 0.1}, {}}, {30, {0.3, 0.2, 0.1}, {0.5, 0.5, 0.5}}, {900, {}, {20, 20, 20}}};
  return paint;
}

double excess_of(const paint::LobeFit& paint, double view_deg, std::vector<brdf::Tilt> tilts = {},
                 double wrong_exponent = 1) {
  const auto traced = TracedPaint::create(paint, 45, std::move(tilts));
  paint::LobeFit other = paint;
  for (paint::Lobe& lobe : other.lobes) lobe.exponent *= wrong_exponent;
  const auto stated = TracedPaint::create(other, 45, {});
  const Vec3 normal = normalized({0.2, 0.9, -0.3}), side = normalized(cross(normal, {1, 0, 0}));
  const double t = view_deg * kDegree;
  const Vec3 viewer = std::cos(t) * normal + std::sin(t) * side;
  const PaintedPoint point(*traced, float3(normal), float3(viewer));
  const PaintedPoint told(wrong_exponent == 1 ? *traced : *stated, float3(normal), float3(viewer));
  // The bins are fine enough for the sharpest lobe.
  return excess_of_draws(point, 400, 12, [&](const Vec3& d) { return told.at(float3(d)).pdf; });
}

TEST(Samplers, LobesAreDrawnAsTheirDensitySays) {
  for (const double view_deg : {0.0, 30.0, 75.0, 88.0}) EXPECT_LT(excess_of(glossy(), view_deg), 5) << view_deg;
  EXPECT_LT(excess_of(matt({0.5, 0.4, 0.3}), 40), 5);
  EXPECT_GT(excess_of(glossy(), 30, {}, 1.3), 5);  // control
}

TEST(Samplers, BrushedLobesAreDrawnAsTheirDensitySays) {
  const brdf::TiltSet set = brdf::ward_tilts({0.1, 0.4}, 0.1, 0.01).value();
  ASSERT_GT(set.tilts.size(), 3U);
  for (const double view_deg : {10.0, 60.0}) EXPECT_LT(excess_of(glossy(), view_deg, set.tilts), 5);
}

// A dim and a bright panel: from afar, from so near that they fill most of the sphere, and where the horizon of the
// surface cuts them.
TEST(Samplers, EmittersAreDrawnAsTheirDensitySays) {
  const mesh::Mesh mesh = panels_mesh(2);
  const auto scene = rays::RayScene::create(mesh);
  ASSERT_TRUE(scene.ok());
  const auto emitters = Emitters::create(*scene, {{1, 1, 1}, {2, 5, 2}});
  ASSERT_TRUE(emitters.ok());
  struct Case {
    Vec3 from, normal;
  };
  for (const auto& [from, normal] : {Case{{0.3, 0.2, 4}, {0, 0, -1}}, Case{{0.3, 0.2, 0.6}, {0, 0, -1}},
                                     Case{{-0.2, 0.1, 0.05}, {0, 0, -1}}, Case{{0.3, 0.2, 0.6}, {-1, 0, 0}}}) {
    const LitPoint at{scene->local(from), float3(normal)};
    for (const double wrong : {1.0, 1.05}) {
      const double found = excess(
          SphereBins({0, 0, -1}, 60, 12), 400000,
          [&](double choice, double u, double v) -> std::optional<Vec3> {
            const EmitterSample drawn = emitters->drawn(at, choice, u, v);
            if (!(drawn.pdf > 0)) return std::nullopt;
            return rays::vec3(drawn.direction);
          },
          [&](const Vec3& d) {
            const rays::Hit hit = scene->closest(at.position, float3(d));
            const double pdf = hit.any() ? emitters->pdf(at, hit.triangle, float3(d), hit.distance) : 0.0;
            return d.x > 0 ? wrong * pdf : pdf;
          },
          1600);
      if (wrong == 1) {
        EXPECT_LT(found, 5) << from.z << ' ' << normal.x;
      } else {
        EXPECT_GT(found, 5) << from.z << ' ' << normal.x;  // control
      }
    }
  }
}

// The density of what is drawn is that of a ray in the same direction, and the ray is as long.
TEST(Samplers, WhatIsDrawnFromEmittersIsWhatRaysMeet) {
  const mesh::Mesh mesh = panels_mesh(3);
  const auto scene = rays::RayScene::create(mesh);
  ASSERT_TRUE(scene.ok());
  const auto emitters = Emitters::create(*scene, {{1, 1, 1}, {}, {2, 5, 2}});
  ASSERT_TRUE(emitters.ok());
  TestNumbers next(8);
  int astray = 0;
  constexpr int kCount = 4000;
  for (int i = 0; i < kCount; ++i) {
    const LitPoint at{scene->local({4 * next() - 2, 2 * next() - 1, 0.01 + 2 * next() * next()}), {0, 0, -1}};
    const EmitterSample drawn = emitters->drawn(at, next(), next(), next());
    ASSERT_GT(drawn.pdf, 0);
    const rays::Hit hit = scene->closest(at.position, drawn.direction);
    // A direction in floats may fall past the edge of its triangle.
    if (!hit.any() || scene->part(hit.triangle) != drawn.part) {
      ++astray;
      continue;
    }
    EXPECT_NEAR(hit.distance / drawn.distance, 1, 1e-4);
    if (std::abs(hit.u * hit.v * (1 - hit.u - hit.v)) < 1e-6) continue;
    EXPECT_NEAR(emitters->pdf(at, hit.triangle, drawn.direction, hit.distance) / drawn.pdf, 1, 1e-3);
  }
  EXPECT_LT(astray, kCount / 500);
}

// A strip 2 long and 1/16 wide, 1/8 before a surface, whose irradiance for a radiance of 1 is known in closed form: pi
// F of a parallel rectangle with a corner on the normal. Drawn evenly by area, the control, this light has a relative
// variance of 11 a sample; by what the strip sends to the point it has 0.95, of which the choice between its two
// triangles is the most.
TEST(Samplers, AStripNearASurfaceHasLittleNoise) {
  mesh::Mesh mesh;
  constexpr double kLong = 2, kWide = 1.0 / 16, kHigh = 1.0 / 8;
  mesh.positions = {{0, 0, 0}, {kLong, 0, 0}, {kLong, kWide, 0}, {0, kWide, 0}};
  mesh.normals.assign(4, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.parts = {{"strip", "", 0, 2}};
  const auto scene = rays::RayScene::create(mesh);
  ASSERT_TRUE(scene.ok());
  const auto emitters = Emitters::create(*scene, {{1, 1, 1}});
  ASSERT_TRUE(emitters.ok());
  const double a = kLong / kHigh, b = kWide / kHigh, root_a = std::sqrt(1 + a * a), root_b = std::sqrt(1 + b * b);
  const double irradiance = 0.5 * (a / root_a * std::atan(b / root_a) + b / root_b * std::atan(a / root_b));
  const LitPoint at{scene->local({0, 0, kHigh}), {0, 0, -1}};
  double sum = 0, squares = 0, by_area = 0;
  constexpr int kCount = 40000;
  TestNumbers next(6);
  for (int i = 0; i < kCount; ++i) {
    const EmitterSample drawn = emitters->drawn(at, next(), next(), next());
    const double value = drawn.pdf > 0 ? -drawn.direction.z / drawn.pdf : 0.0;
    sum += value / kCount, squares += value * value / kCount;
    const double x = kLong * next(), y = kWide * next(), square = x * x + y * y + kHigh * kHigh,
                 even = kLong * kWide * kHigh * kHigh / (square * square);
    by_area += even * even / kCount;
  }
  const double variance = squares / (irradiance * irradiance) - 1;
  EXPECT_NEAR(sum / irradiance, 1, 5 * std::sqrt(variance / kCount));
  EXPECT_LT(variance, 2);
  EXPECT_GT(by_area / (irradiance * irradiance) - 1, 5);  // control
}

TEST(Samplers, EmittersWithoutAreaOrWithoutAnEndAreRefused) {
  mesh::Mesh mesh = panels_mesh(2);
  mesh.positions[4] = mesh.positions[5] = mesh.positions[2];
  mesh.positions[3] = mesh.positions[2];  // the second panel is a point
  const auto scene = rays::RayScene::create(mesh);
  ASSERT_TRUE(scene.ok());
  const auto flat = Emitters::create(*scene, {{0, 0, 0}, {1, 1, 1}});
  ASSERT_FALSE(flat.ok());
  EXPECT_NE(flat.error().message.find("no area"), std::string::npos);
  EXPECT_FALSE(Emitters::create(*scene, {{-1, 0, 0}}).ok());
  EXPECT_FALSE(Emitters::create(*scene, {{std::numeric_limits<double>::infinity(), 0, 0}}).ok());
}

// The model in floats is the model that the reference integrator has in doubles.
TEST(TracedPaint, IsTheModelOfTheReference) {
  paint::LobeFit paint = glossy();
  paint.views = {{15, paint.diffuse, paint.lobes}, {60, {0.2, 0.1, 0.1}, {{30, {1, 2, 3}, {}}, {200, {}, {4, 4, 5}}}}};
  const auto traced = TracedPaint::create(paint, 60, {});
  ASSERT_TRUE(traced.ok());
  TestNumbers next(9);
  const auto direction = [&] {
    const double z = 0.02 + 0.98 * next(), p = 2 * kPi * next(), s = std::sqrt(1 - z * z);
    return Vec3{s * std::cos(p), s * std::sin(p), z};
  };
  for (int i = 0; i < 2000; ++i) {
    const Vec3 viewer = direction(), mirrored{-viewer.x, -viewer.y, viewer.z};
    const Vec3 light = i % 2 == 0 ? direction() : normalized(mirrored + 0.05 * direction());
    const color::Rgb expected = light.z * brdf::coated_brdf(paint, light, viewer, {0, 0, 1}, 60);
    const PaintedPoint point(*traced, {0, 0, 1}, float3(viewer));
    const color::Rgb f = rays::vec3(point.at(float3(light)).f_cos);
    const PaintedPoint::Parts parts = point.parts(float3(light));
    const color::Rgb sum = rays::vec3(parts.diffuse + parts.lobes);
    // A float direction is off by 6e-8, which the sharpest lobe (E = 900) at its flank makes 40 sqrt(900) times more.
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(f[c], expected[c], 1e-4 * expected[c] + 1e-9);
      EXPECT_NEAR(f[c], sum[c], 1e-5 * expected[c] + 1e-9);
    }
  }
}

}  // namespace
}  // namespace goniochrome::render::samplers_test
