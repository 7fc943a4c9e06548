// Lamps that are discs: every engine against a brute-force integral over the disc.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "brdf/disc_light.h"
#include "brdf/lobe_model.h"
#include "math/statistics.h"
#include "render/cpu/cpu_engine.h"
#include "render/exact.h"
#include "render/glints.h"
#include "render/path/path_estimate_for_test.h"
#include "render/path/path_tracer.h"
#include "render/path/transport.h"
#include "render/scene.h"
#include "render/scene_effects.h"

namespace goniochrome::render::disc_lamps_test {
namespace {

paint::LobeFit glossy(double exponent) {
  paint::LobeFit paint;
  paint.diffuse = {0.1, 0.05, 0.02};
  const double gloss = 0.04 * (exponent + 1) / (2 * kPi);
  paint.lobes = {{6, {0.1, 0.1, 0.15}, {}}, {exponent, {}, {gloss, gloss, gloss}}};
  return paint;
}

VisiblePoint seen_at(double view_deg) {
  return {{0, 1, 0}, {-std::sin(view_deg * kDegree), std::cos(view_deg * kDegree), 0}, 0};
}

Light lamp(double elevation_from_normal_deg, double azimuth_deg, double extent_deg) {
  const double t = elevation_from_normal_deg * kDegree, p = azimuth_deg * kDegree;
  Light light;
  light.direction = {std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p)};
  light.radius_rad = 0.5 * extent_deg * kDegree;
  return light;
}

// The sum over `rings` times 4 rings small lamps that fill the disc evenly, each a point: the brute-force integral.
color::Rgb by_points(const paint::LobeFit& paint, const VisiblePoint& point, const Light& disc, int rings) {
  const Vec3 x = normalized(cross(disc.direction, {0.3, 0.2, 0.9})), y = cross(disc.direction, x);
  const double half = std::sin(0.5 * disc.radius_rad), sine = std::sin(disc.radius_rad);
  color::Rgb sum;
  for (int i = 0; i < rings; ++i) {
    const double versine = 2 * half * half * (i + 0.5) / rings, across = std::sqrt(versine * (2 - versine));
    for (int k = 0; k < 4 * rings; ++k) {
      const double phi = 2 * kPi * (k + 0.5) / (4 * rings);
      const Vec3 w = (1 - versine) * disc.direction + across * std::cos(phi) * x + across * std::sin(phi) * y;
      const double cos_i = dot(point.normal, w);
      if (cos_i <= 0) continue;
      const double weight = 4 * half * half / (sine * sine) / (4.0 * rings * rings);
      sum += (weight * kPi * cos_i) * brdf::coated_brdf(paint, w, point.to_viewer, point.normal) * disc.white;
    }
  }
  return sum;
}

Scene lit(const paint::LobeFit& paint, const Light& light) {
  Scene scene;
  scene.paints = {paint};
  scene.lights = {light};
  return scene;
}

double apart(const color::Rgb& a, const color::Rgb& b) {
  return std::max({std::abs(a.x - b.x), std::abs(a.y - b.y), std::abs(a.z - b.z)});
}

struct Lamp {
  double from_normal_deg, azimuth_deg, extent_deg;
};

TEST(DiscLamps, EnginesShowTheIntegralOverTheDisc) {
  double worst_exact = 0, worst_cpu = 0, textbook = 0;
  for (const double exponent : {60.0, 900.0, 20000.0}) {
    for (const Lamp l : {Lamp{40, 0, 0.53}, {40, 0.3, 4}, {30, 20, 40}, {10, 0, 90}}) {
      const paint::LobeFit paint = glossy(exponent);
      const Scene scene = lit(paint, lamp(l.from_normal_deg, l.azimuth_deg, l.extent_deg));
      const VisiblePoint point = seen_at(40);
      const Effects effects = effects_of(scene);
      // The widest of these lobes falls by 60 R^2/4 = 3e-4 under the narrowest lamp, which may be a point to it.
      EXPECT_EQ(effects.extent, exponent > 60 || l.extent_deg > 1);
      const color::Rgb truth = by_points(paint, point, scene.lights[0], 600);
      const color::Rgb exact = exact_radiance({point}, scene, effects, Surroundings(nullptr))[0];
      worst_exact = std::max(worst_exact, apart(exact, truth) / truth.x);
      CpuEngine cpu;
      ASSERT_TRUE(cpu.load(scene, effects).ok());
      worst_cpu = std::max(worst_cpu, apart(cpu.colors({point})[0], truth) / truth.x);
      Light point_lamp = scene.lights[0];
      point_lamp.radius_rad = 0;
      const Scene textbook_scene = lit(paint, point_lamp);
      const color::Rgb wrong =
          exact_radiance({point}, textbook_scene, effects_of(textbook_scene), Surroundings(nullptr))[0];
      textbook = std::max(textbook, apart(wrong, truth) / truth.x);
    }
  }
  // The brute force has 600 rings over a disc of 150 standard deviations of the sharpest lobe.
  EXPECT_LT(worst_exact, 1e-3);
  // The kernel takes the coat's reflectance from the middle of the disc and from the mirror direction, in shares.
  EXPECT_LT(worst_cpu, 5e-3);
  EXPECT_GT(textbook, 2);  // the point lamp that textbooks have
  RecordProperty("worst_exact", std::to_string(worst_exact));
  RecordProperty("worst_cpu", std::to_string(worst_cpu));
}

TEST(DiscLamps, HorizonCutsTheDisc) {
  const color::Rgb high = by_points(glossy(300), seen_at(60), lamp(60, 0, 20), 400);
  for (const double from_normal_deg : {80.0, 88.0, 90.0, 94.0}) {
    const paint::LobeFit paint = glossy(300);
    const Scene scene = lit(paint, lamp(from_normal_deg, 0, 20));
    const VisiblePoint point = seen_at(60);
    const color::Rgb truth = by_points(paint, point, scene.lights[0], 400);
    const Effects effects = effects_of(scene);
    const color::Rgb exact = exact_radiance({point}, scene, effects, Surroundings(nullptr))[0];
    EXPECT_LT(apart(exact, truth), 5e-3 * truth.x) << from_normal_deg;
    CpuEngine cpu;
    ASSERT_TRUE(cpu.load(scene, effects).ok());
    // The kernel cuts the disc at the horizon, but not the part of a lobe that it counts at the mirror direction.
    EXPECT_LT(apart(cpu.colors({point})[0], truth), 0.02 * high.x) << from_normal_deg;
  }
}

// Below the horizon there is nothing, and two lamps in one place add.
TEST(HardCase, LampExtentBelowTheHorizonAndTwice) {
  const paint::LobeFit paint = glossy(900);
  const VisiblePoint point = seen_at(40);
  const auto shown = [&](const Scene& scene) {
    CpuEngine cpu;
    EXPECT_TRUE(cpu.load(scene, effects_of(scene)).ok());
    return cpu.colors({point})[0];
  };
  EXPECT_EQ(shown(lit(paint, lamp(96, 0, 10))), color::Rgb{});
  Scene twice = lit(paint, lamp(40, 0, 0.53));
  const color::Rgb once = shown(twice);
  twice.lights.push_back(twice.lights[0]);
  EXPECT_LT(apart(shown(twice), 2 * once), 1e-6 * once.x);
  for (const double extent_deg : {1e-4, 1e-3, 0.53, 30.0, 180.0}) {
    const color::Rgb color = shown(lit(paint, lamp(40, 0, extent_deg)));
    EXPECT_TRUE(std::isfinite(color.x) && color.x > 0) << extent_deg;
  }
}

// Irradiance over solid angle, exactly within the disc and nothing outside.
TEST(DiscLamps, MirrorShowsTheDisc) {
  paint::LobeFit paint;
  paint.lobes = {{paint::kMirrorExponent, {}, {1, 1, 1}}};
  const Scene scene = lit(paint, lamp(40, 0, 2));
  const Effects effects = effects_of(scene);
  EXPECT_TRUE(effects.mirror);
  CpuEngine cpu;
  ASSERT_TRUE(cpu.load(scene, effects).ok());
  for (const double view_deg : {38.0, 38.9, 39.1, 40.0, 40.9, 41.1, 45.0}) {
    const bool inside = std::abs(view_deg - 40) < 1;
    const double wanted =
        inside ? brdf::fresnel_dielectric(std::cos(view_deg * kDegree), 1.5) / std::pow(std::sin(1 * kDegree), 2) : 0;
    // The kernel reads Fresnel's reflectance at 64 segments of the view.
    EXPECT_NEAR(cpu.colors({seen_at(view_deg)})[0].x, wanted, 1e-3 * wanted) << view_deg;
    EXPECT_NEAR(exact_radiance({seen_at(view_deg)}, scene, effects, Surroundings(nullptr))[0].x, wanted,
                1e-12 * wanted);
  }
}

// The image of a small lamp keeps its light, whatever the samples see.
TEST(DiscLamps, GlintsKeepTheirLight) {
  const Light sun = lamp(0, 0, 0.53);
  for (const double spread_deg : {0.01, 0.1, 0.5, 2.0}) {
    double sum = 0;
    constexpr int kSteps = 4000;
    for (int i = 0; i < kSteps; ++i) {
      const double t = 10 * kDegree * (i + 0.5) / kSteps;
      sum += 2 * kPi * std::sin(t) * (10 * kDegree / kSteps) *
             mirrored_share(sun, {std::sin(t), std::cos(t), 0}, spread_deg * kDegree);
    }
    // A step of the sum is a hundredth of the radius.
    EXPECT_NEAR(sum / (2 * kPi * (1 - std::cos(sun.radius_rad))), 1, 0.03) << spread_deg;
  }
}

// Irradiance on a diffuser that faces the lamp does not depend on its extent.
TEST(DiscLamps, ExtentKeepsTheIrradiance) {
  for (const double extent_deg : {0.0, 1e-4, 0.53, 30.0, 180.0}) {
    EXPECT_NEAR(facing_white(nullptr, {lamp(0, 0, extent_deg)}, {0, 1, 0}),
                facing_white(nullptr, {lamp(0, 0, 0)}, {0, 1, 0}), 1e-12);
  }
}

TEST(DiscLamps, LampAtAPlaceFallsWithTheSquareOfTheDistance) {
  Light light = lamp(0, 0, 2);
  light.place = {{0, 10, 0}, 10};
  const Light near = light_at(light, {0, 5, 0}), side = light_at(light, {10, 10, 0});
  EXPECT_NEAR(near.white.x, 4, 1e-12);
  EXPECT_NEAR(std::sin(near.radius_rad), 2 * std::sin(light.radius_rad), 1e-12);
  EXPECT_NEAR(length(near.radiance() - light.radiance()), 0, 1e-9 * light.radiance().x);
  EXPECT_NEAR(side.direction.x, -1, 1e-12);
  EXPECT_TRUE(has_placed_lamps(lit(glossy(6), light)));
}

mesh::Mesh floor_and_edge() {
  mesh::Mesh mesh;
  // A level square, and an upright one beside it that hides half of a lamp.
  mesh.positions = {{-10, 0, -10}, {-10, 0, 10}, {10, 0, 10}, {10, 0, -10},
                    {2, 0, -40},   {2, 2, -40},  {2, 2, 40},  {2, 0, 40}};
  mesh.normals = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {-1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}, {-1, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  mesh.parts = {{"all", "", 0, 4}};
  return mesh;
}

// Gloss that is narrower than a lamp, of which a little more than half is hidden. The truth is the sum over the disc
// above the edge of F/F_45 K_G cos^E times the lamp's radiance; the control is the spread that places on the disc alone
// would have.
TEST(DiscLamps, GlossBesideAWideLampIsFreeOfSpecks) {
  constexpr double kExponent = 3000, kSeen_deg = 43.5, kRadius_deg = 5, kPlace = 0.05;
  constexpr int kBatches = 16, kSamples = 16 * kBatches, kSeeds = 60;
  const mesh::Mesh mesh = floor_and_edge();
  paint::LobeFit paint;
  paint.lobes = {{kExponent, {}, {5, 5, 5}}};
  Scene scene = lit(paint, lamp(45, 0, 2 * kRadius_deg));
  scene.mesh = &mesh;
  PathScene paths;
  paths.scene = &scene;
  const auto transport = Transport::create(paths);
  ASSERT_TRUE(transport.ok());
  PathOptions options;
  options.bounces = 0;
  const rays::Float3 eye = transport->rays().local({kPlace, 1.5, 0.1}), down = {0, -1, 0};
  const rays::Spot spot = transport->rays().spot(transport->rays().closest(eye, down), eye, down);
  // The mirror direction is as far from the normal as the viewer, on the side of the lamp and above the edge.
  const Vec3 light = scene.lights[0].direction, level = normalized(Vec3{light.x, 0, light.z});
  const double view = kSeen_deg * kDegree;
  const Vec3 mirrored = std::sin(view) * level + Vec3{0, std::cos(view), 0};
  const Vec3 viewer = -std::sin(view) * level + Vec3{0, std::cos(view), 0};
  std::vector<double> shown;
  for (int seed = 1; seed <= kSeeds; ++seed)
    shown.push_back(
        path_estimate(*transport, options, spot, viewer, kBatches, static_cast<std::uint64_t>(seed)).radiance.x);
  const double mean = math::mean(shown);
  double spread = 0;
  for (const double value : shown) spread += (value - mean) * (value - mean) / (kSeeds - 1);
  spread = std::sqrt(spread);

  // Rings and spokes of equal solid angle.
  constexpr int kRings = 400, kSpokes = 720;
  const rays::Frame frame = rays::frame_about(rays::float3(light));
  const double versine = 1 - std::cos(kRadius_deg * kDegree), extent_sr = 2 * kPi * versine;
  const double radiance = scene.lights[0].radiance().x;
  const double coat_45 = brdf::fresnel_dielectric(std::cos(45 * kDegree), 1.5);
  double first = 0, second = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double v = versine * (ring + 0.5) / kRings, sine = std::sqrt(v * (2 - v));
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double phi = 2 * kPi * (spoke + 0.5) / kSpokes;
      const Vec3 d =
          (1 - v) * light + sine * std::cos(phi) * rays::vec3(frame.x) + sine * std::sin(phi) * rays::vec3(frame.y);
      if (d.y * (2 - kPlace) < 2 * dot(d, level)) continue;  // behind the wall, which is 2 high
      const double coat = brdf::fresnel_dielectric(0.5 * length(d + viewer), 1.5) / coat_45;
      const double value = 5 * coat * std::pow(std::max(0.0, dot(d, mirrored)), kExponent) * radiance * extent_sr;
      first += value / (kRings * kSpokes), second += value * value / (kRings * kSpokes);
    }
  }
  const double by_places = std::sqrt((second - first * first) / kSamples);
  EXPECT_NEAR(mean, first, 4 * spread / std::sqrt(kSeeds) + 0.01 * first);  // the grid has steps of a hundredth
  EXPECT_LT(spread, 0.5 * by_places);
  EXPECT_GT(by_places, 0.05 * first);
}

// A wall whose upper edge meets the middle of the disc hides half of it: the diffuse part is halved, softly.
TEST(DiscLamps, PathsDrawSoftShadows) {
  const mesh::Mesh mesh = floor_and_edge();
  paint::LobeFit paint;
  paint.diffuse = {0.2, 0.2, 0.2};
  Scene scene = lit(paint, lamp(45, 0, 10));
  scene.mesh = &mesh;
  PathScene paths;
  paths.scene = &scene;
  const auto transport = Transport::create(paths);
  ASSERT_TRUE(transport.ok());
  PathOptions options;
  options.bounces = 0;
  const auto shown = [&](double x) {
    const rays::Float3 eye = transport->rays().local({x, 1.5, 0.1}), down = {0, -1, 0};
    const rays::Spot spot = transport->rays().spot(transport->rays().closest(eye, down), eye, down);
    return path_estimate(*transport, options, spot, {0, 1, 0}, 400, 7).radiance.x;
  };
  const double open = shown(-8), half = shown(0), dark = shown(1.8);
  const double whole = kPi * 0.2 * std::cos(45 * kDegree);
  EXPECT_NEAR(open, whole, 1e-6 * whole);
  EXPECT_NEAR(dark, 0, 1e-6);
  // The half of the disc above its middle: its mean cosine is a little larger. 6400 samples, three sigma.
  const double cap = 4 * std::sin(5 * kDegree) / (3 * kPi) * std::sin(45 * kDegree);
  EXPECT_NEAR(half, kPi * 0.2 * (0.5 * std::cos(45 * kDegree) + 0.5 * cap), 0.02 * whole);
}

// Eight fixed rays decide whether samples estimate the hidden or the free part of a disc, and this must not show: all
// along the border of a shadow the light is that of the part of the disc above the wall's edge, summed on a grid. The
// control is the light that these few rays would tell by themselves.
TEST(DiscLamps, SoftShadowsAreUnbiasedAllAlong) {
  const mesh::Mesh mesh = floor_and_edge();
  paint::LobeFit paint;
  paint.diffuse = {0.2, 0.2, 0.2};
  Scene scene = lit(paint, lamp(45, 0, 10));
  scene.mesh = &mesh;
  PathScene paths;
  paths.scene = &scene;
  const auto transport = Transport::create(paths);
  ASSERT_TRUE(transport.ok());
  PathOptions options;
  options.bounces = 0;
  const Light& light = scene.lights[0];
  const Vec3 level = normalized(Vec3{light.direction.x, 0, light.direction.z});
  const double whole = kPi * 0.2 * std::cos(45 * kDegree);
  constexpr int kGrid = 200, kBatches = 1000;
  double worst_of_few = 0;
  for (const double x : {-0.35, -0.25, -0.12, -0.04, 0.06, 0.13, 0.22, 0.3}) {
    double above = 0, all = 0, few = 0, of_few = 0;
    const auto free = [&](const Vec3& d) { return d.y * (2 - x) >= 2 * dot(d, level); };
    for (int i = 0; i < kGrid; ++i) {
      for (int j = 0; j < kGrid; ++j) {
        const Vec3 d = disc_direction(light, (i + 0.5) / kGrid, (j + 0.5) / kGrid);
        all += d.y, above += free(d) ? d.y : 0;
      }
    }
    for (int j = 0; j < 8; ++j) {
      const Vec3 d = disc_direction(light, 0.5, (j + 0.5) / 8);
      of_few += d.y, few += free(d) ? d.y : 0;
    }
    const rays::Float3 eye = transport->rays().local({x, 1.5, 0.1}), down = {0, -1, 0};
    const rays::Spot spot = transport->rays().spot(transport->rays().closest(eye, down), eye, down);
    const PathEstimate shown = path_estimate(*transport, options, spot, {0, 1, 0}, kBatches, 7);
    // Four standard deviations, and what the grid leaves of an edge that cuts one cell in each of its rows.
    EXPECT_NEAR(shown.radiance.x, whole * above / all, 4 * std::sqrt(shown.covariance[0]) + 0.003 * whole) << x;
    worst_of_few = std::max(worst_of_few, std::abs(few / of_few - above / all));
  }
  EXPECT_GT(worst_of_few, 0.05);
}

}  // namespace
}  // namespace goniochrome::render::disc_lamps_test
