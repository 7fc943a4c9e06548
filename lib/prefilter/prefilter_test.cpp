#include "prefilter/prefilter.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>

#include "base/angles.h"
#include "base/parallel.h"
#include "math/cosine_power.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/internal/bright_texels.h"
#include "prefilter/internal/mirror.h"

namespace goniochrome::prefilter::prefilter_test {
namespace {

using BadPixels = envmap::Environment::BadPixels;
using Layout = envmap::SphereGrid::Layout;

envmap::Environment lat_long(int height, const std::function<Vec3(int, int, const Vec3&)>& value) {
  image::Image image = {2 * height, height, 3, std::vector<float>(static_cast<std::size_t>(height) * height * 6), {}};
  const envmap::Environment frame = envmap::Environment::from_lat_long(image, BadPixels::kError, "frame").value();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 2 * height; ++x) {
      const Vec3 rgb = value(x, y, frame.direction(x, y));
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>(rgb[c]);
    }
  return envmap::Environment::from_lat_long(image, BadPixels::kError, "test").value();
}

// The scene as an angular probe.
envmap::Environment probe(int n) {
  image::Image image = {n, n, 3, std::vector<float>(static_cast<std::size_t>(n) * n * 3), {}};
  const envmap::SphereGrid grid(envmap::SphereGrid::Layout::kAngular, n, n);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const float v = static_cast<float>(1 + 0.9 * grid.direction(x, y).y) + (x == n / 3 && y == n / 4 ? 40.0F : 0.0F);
      std::fill_n(image.pixel(x, y), 3, v);
    }
  return envmap::Environment::from_angular(image, BadPixels::kError, "probe").value();
}

// A sky, a dark ground, noise, and a sun of two texels.
envmap::Environment outdoors(int height) {
  auto random = std::make_shared<std::mt19937>(4);
  return lat_long(height, [random, height](int x, int y, const Vec3& d) {
    std::uniform_real_distribution<double> unit(0.5, 1.5);
    if (y == height / 3 && (x == height / 2 || x == height / 2 + 1)) return Vec3{4e4, 3.5e4, 2e4};
    const double v = unit(*random) * (d.y > 0 ? 1 + d.y : 0.05);
    return Vec3{0.6 * v, 0.8 * v, v};
  });
}

envmap::PrefilteredEnvironment run(const envmap::Environment& env, const PrefilterRequest& request) {
  return prefiltered(env, request, prefilter_plan(env, request), [](const envmap::PrefilteredLobe&, double) {});
}

std::vector<const envmap::PrefilteredLobe*> all_of(const envmap::PrefilteredEnvironment& env) {
  std::vector<const envmap::PrefilteredLobe*> lobes = {&env.diffuse};
  for (const envmap::PrefilteredLobe& lobe : env.lobes) lobes.push_back(&lobe);
  if (env.mirror.map.size > 0) lobes.push_back(&env.mirror);
  return lobes;
}

template <class Body>
void each_texel(const envmap::CubeMap& map, const Body& body) {
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < map.size; ++row)
      for (int column = 0; column < map.size; ++column)
        body(envmap::cube_direction(face, column + 0.5, row + 0.5, map.size), map.at(face, row, column));
}

TEST(HardCase, PrefilterSeamAConstantMapStaysItself) {
  const envmap::Environment env = lat_long(64, [](int, int, const Vec3&) { return Vec3{1, 2, 0.25}; });
  // The textbook weighs every texel of the image alike: the poles count too much.
  double even = 0, all = 0;
  for (int y = 0; y < 64; ++y) {
    const double k = std::max(0.0, env.direction(0, y).y);
    even += k * k, all += 1;
  }
  EXPECT_GT(std::fabs(even / all / (1.0 / 6) - 1), 0.1);  // the mean of max(0,y)^2 over the sphere is 1/6
  const envmap::PrefilteredEnvironment result = run(env, {{0, 1.3, 6, 70, 900, 1e5}, true, 3, 1e-6});
  for (const envmap::PrefilteredLobe* lobe : all_of(result))
    each_texel(lobe->map, [&](const Vec3&, const float* rgb) {
      EXPECT_NEAR(rgb[0], 1, 1e-6) << lobe->exponent;
      EXPECT_NEAR(rgb[1], 2, 2e-6) << lobe->exponent;
      EXPECT_NEAR(rgb[2], 0.25, 0.25e-6) << lobe->exponent;
    });
}

TEST(Prefilter, OfOneTexelIsTheCosinePower) {
  const envmap::Environment env = lat_long(180, [](int x, int y, const Vec3&) {
    return x == 77 && y == 50 ? Vec3{3, 3, 3} : Vec3{};
  });
  const Vec3 texel = env.direction(77, 50);
  const double flux = 3 * env.solid_angle(77, 50), mean = flux / (4 * kPi);
  const envmap::PrefilteredEnvironment result = run(env, {{2, 6, 20}, false, 16, 1e-4});
  for (const envmap::PrefilteredLobe* lobe : all_of(result))
    each_texel(lobe->map, [&](const Vec3& d, const float* rgb) {
      const double e = lobe->exponent, t = dot(d, texel);
      const double want = flux * (e + 1) / (2 * kPi) * math::cosine_power(t, e);
      // A patch of 1 deg against its center: E h^2/24 (1 + E tan^2) two ways; at the horizon half a texel of flank.
      const double h = kDegree, bend = t > 0.1 ? e * h * h / 12 * (1 + e * (1 - t * t) / (t * t)) : 0;
      const double flank = t > -h && t <= 0.1 ? flux * (e + 1) / (2 * kPi) * std::pow(0.1 + h, e) * h * e : 0;
      EXPECT_NEAR(rgb[1], want, (1e-4 + bend) * std::max(want, 1e-3 * mean) + flank) << e;
    });
}

TEST(Prefilter, OfAHalfSphereIsThePublishedIntegral) {
  const envmap::Environment env = lat_long(64, [](int, int, const Vec3& d) {
    return d.x > 0 ? Vec3{1, 1, 1} : Vec3{};
  });
  for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
    const envmap::PrefilteredEnvironment result = run(env, {{0}, false, 8, tolerance});
    each_texel(result.diffuse.map, [&](const Vec3& d, const float* rgb) {
      const double want = (1 + d.x) / 2;
      EXPECT_NEAR(rgb[0], want, tolerance * std::max(want, 0.5e-3));
    });
    each_texel(result.lobes[0].map, [&](const Vec3& d, const float* rgb) {
      const double want = 1 - std::acos(d.x) / kPi;
      EXPECT_NEAR(rgb[0], want, tolerance * std::max(want, 0.5e-3));
    });
  }
}

TEST(HardCase, PrefilterSunKeepsItsEnergyAndSpoilsNothing) {
  const auto lonely = [](float value) {
    return lat_long(64, [value](int x, int y, const Vec3&) {
      return x == 40 && y == 20 ? Vec3{value, value, value} : Vec3{};
    });
  };
  for (const envmap::Environment& env : {lonely(1e9F), outdoors(64)}) {
    const PrefilterRequest request = {{6, 20, 70}, true, 64, 1e-3};
    const envmap::PrefilteredEnvironment result = run(env, request);
    for (const envmap::PrefilteredLobe* lobe : all_of(result)) {
      for (const float v : lobe->map.texels) ASSERT_TRUE(std::isfinite(v));
      EXPECT_NEAR(energy_ratio(env.flux(), *lobe), 1, lobe->exponent > 1 ? 1e-4 : 3e-4) << lobe->exponent;
      EXPECT_LE(lobe_error(env, *lobe, 10, 5, 1).max, request.tolerance) << lobe->exponent;
    }
  }
}

// The textbook averages the source down to the size of the output first, which moves the sun.
TEST(HardCase, PrefilterSunTheTextbookFormFails) {
  const envmap::Environment env = lat_long(64, [](int x, int y, const Vec3&) {
    return x == 40 && y == 20 ? Vec3{1e9, 1e9, 1e9} : Vec3{};
  });
  const envmap::Environment small = lat_long(16, [](int x, int y, const Vec3&) {
    return x == 10 && y == 5 ? Vec3{1e9 / 16, 1e9 / 16, 1e9 / 16} : Vec3{};
  });
  const Vec3 d = normalized(env.direction(40, 20) + Vec3{0.1, 0, 0});
  const double want = reference_lobe(env, d, 64).x, got = reference_lobe(small, d, 64).x;
  EXPECT_GT(std::fabs(got / want - 1), 1e-2);
  EXPECT_GT(1e9F, 65504.0F);  // and stores halves
}

void expect_every_lobe_within(double tolerance) {
  const envmap::Environment env = outdoors(80);
  const envmap::PrefilteredEnvironment result =
      run(env, {{0, 0.3, 1.3, 2, 3.5, 6, 250, 3000, 1e5}, true, 4, tolerance});
  for (const envmap::PrefilteredLobe* lobe : all_of(result))
    EXPECT_LE(lobe_error(env, *lobe, 15, 5, 1).max, tolerance) << lobe->exponent;
}

TEST(HardCase, PrefilterExponentEveryLobeKeepsALooseTolerance) {
  expect_every_lobe_within(1e-2);
}

TEST(HardCase, PrefilterExponentEveryLobeKeepsATightTolerance) {
  expect_every_lobe_within(1e-4);
}

// Exponents below 1 have a step or a vertical slope at the horizon, which harmonics do not reach.
TEST(HardCase, PrefilterExponentFlatLobesKeepATightTolerance) {
  const envmap::Environment flat = outdoors(128);
  envmap::CubeMap map(48);
  map.texels = mirror_values(flat, envmap::map_grid(Layout::kCube, 48), {});
  for (const envmap::Environment& env : {flat, envmap::Environment::from_cube(map, "cube")}) {
    const PrefilterRequest request = {{0, 0.3, 0.5, 0.9}, false, 8, 1e-5, Layout::kCube, {}, {}, false};
    const std::vector<LobePlan> plan = prefilter_plan(env, request);
    for (const LobePlan& lobe : plan) EXPECT_EQ(lobe.method, LobePlan::Method::kHorizon) << lobe.exponent;
    const envmap::PrefilteredEnvironment result = run(env, request);
    for (const envmap::PrefilteredLobe& lobe : result.lobes)
      EXPECT_LE(lobe_error(env, lobe, 6, 3, 1).max, request.tolerance) << lobe.exponent << " " << int(env.layout());
  }
}

// Texels of 11 degrees, one of them a sun: a wide lobe bends at the horizon within them.
TEST(HardCase, PrefilterExponentCoarseProbesKeepTheTolerance) {
  const envmap::Environment flat = outdoors(16);
  envmap::CubeMap map(10);
  map.texels = mirror_values(flat, envmap::map_grid(Layout::kCube, 10), {});
  image::Image strip = {10, 60, 3, map.texels, {}};
  for (const envmap::Environment& env :
       {flat, envmap::Environment::from_cube(map, "cube"),
        envmap::Environment::from_cube_edges(strip, BadPixels::kError, "edges").value(), probe(24)}) {
    const PrefilterRequest request = {{1.3, 6, 19}, false, 8, 1e-4};
    const envmap::PrefilteredEnvironment result = run(env, request);
    for (const envmap::PrefilteredLobe* lobe : all_of(result))
      EXPECT_LE(lobe_error(env, *lobe, 4, 2, 1).max, request.tolerance) << lobe->exponent << " " << int(env.layout());
  }
}

// Centers of texels in place of patches: 15 % and more off for a sharp lobe.
TEST(HardCase, PrefilterExponentTheCenterRuleFails) {
  const envmap::Environment env = outdoors(80);
  double worst = 0;
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 20; ++i) {
    const Vec3 d = normalized({normal(random), normal(random), normal(random)});
    double sum = 0, norm = 0;
    for (int y = 0; y < env.height(); ++y)
      for (int x = 0; x < env.width(); ++x) {
        const double k = env.solid_angle(x, y) * math::cosine_power(dot(d, env.direction(x, y)), 1e4);
        sum += k * env.radiance(x, y)[0], norm += k;
      }
    worst = std::max(worst, std::fabs(sum / norm / reference_lobe(env, d, 1e4).x - 1));
  }
  EXPECT_GT(worst, 0.05);
}

// A quarter turn of the map is a quarter turn of the result: the four side faces change places.
TEST(Prefilter, TurnsWithTheMap) {
  const envmap::Environment env = outdoors(64);
  const envmap::Environment turned = lat_long(64, [&](int x, int y, const Vec3&) {
    const float* rgb = env.radiance((x + 32) % 128, y);
    return Vec3{rgb[0], rgb[1], rgb[2]};
  });
  const PrefilterRequest request = {{6, 250}, true, 8, 1e-5};
  const envmap::PrefilteredEnvironment a = run(env, request), b = run(turned, request);
  // Column 0 looks along -Z and column 32 along +X: what was in +X is now in -Z, and so on around.
  const int from[] = {4, 5, -1, -1, 1, 0};
  for (std::size_t i = 0; i < all_of(a).size(); ++i)
    for (int face = 0; face < 6; ++face) {
      if (from[face] < 0) continue;
      for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 8; ++column)
          EXPECT_NEAR(all_of(b)[i]->map.at(face, row, column)[0] / all_of(a)[i]->map.at(from[face], row, column)[0], 1,
                      3e-5);
    }
}

TEST(HardCase, ThreadsBitsDoNotDependOnTheirNumber) {
  const envmap::Environment env = outdoors(64);
  const PrefilterRequest request = {{0.3, 1.3, 70, 1e5}, true, 2, 1e-3};
  set_threads(1);
  const envmap::PrefilteredEnvironment one = run(env, request);
  for (const int threads : {2, 7}) {
    set_threads(threads);
    const envmap::PrefilteredEnvironment many = run(env, request);
    for (std::size_t i = 0; i < all_of(one).size(); ++i)
      EXPECT_EQ(all_of(one)[i]->map.texels, all_of(many)[i]->map.texels) << threads;
  }
  set_threads(0);
  // The textbook adds into one sum as threads come: the order changes the last bits.
  float forward = 0, backward = 0;
  for (int i = 0; i < 1000; ++i)
    forward += env.radiance(i % 128, i / 128)[0], backward += env.radiance((999 - i) % 128, (999 - i) / 128)[0];
  EXPECT_NE(forward, backward);
}

// A turned probe is a turned scene, whatever its layout and whatever the maps' layout.
TEST(Prefilter, TurnsByAnyAngleAndIntoAnyLayout) {
  const envmap::Environment flat = outdoors(64);
  envmap::CubeMap map(24);
  map.texels = mirror_values(flat, envmap::map_grid(Layout::kCube, 24), {});
  const envmap::Environment cube = envmap::Environment::from_cube(map, "cube");
  for (const envmap::Environment& env : {flat, cube, probe(128)})
    for (const Layout layout : {Layout::kCube, Layout::kCubeEdges, Layout::kLatLong}) {
      const PrefilterRequest request = {{250}, true, 4, 1e-4, layout, envmap::Rotation::about_axes(0.7, -0.4, 2.1),
                                        {},    false};
      const envmap::PrefilteredEnvironment result = run(env, request);
      for (const envmap::PrefilteredLobe* lobe : {&result.lobes[0], &result.mirror}) {
        EXPECT_EQ(lobe->layout, layout);
        const bool mirror = lobe->is_mirror();
        // The search for the mirror's mean takes edges as straight over 1/128 of a texel, and the overlaps of a probe
        // take the density as even over a texel (h^2 pi^2/24 = 1e-4); that counts by the contrast of 40.
        EXPECT_LE(lobe_error(env, *lobe, 3, 1, 1, request.turn).max, mirror ? 4e-3 : request.tolerance)
            << lobe->exponent << " from " << int(env.layout()) << " to " << int(layout);
        if (mirror) {
          EXPECT_NEAR(energy_ratio(env.flux(), *lobe), 1, env.layout() == Layout::kAngular ? 1e-3 : 1e-4)
              << int(env.layout()) << " to " << int(layout);
        }
      }
      // Left as it was, it is another scene.
      EXPECT_GT(lobe_error(env, result.lobes[0], 6, 2, 1).max, 0.01);
    }
}

// Vectors of every width the machine has give the same sums but for their order: 1e-12 in double precision, then
// rounded to a float.
TEST(Prefilter, VectorsOfAnyWidthAgree) {
  const envmap::Environment env = outdoors(64);
  const PrefilterRequest request = {{20, 250, 1e4}, true, 2, 1e-4, Layout::kCube, {}, {}, false};
  const BrightTexels bright(env, 2);
  ASSERT_EQ(bright.count(), 2U);
  const auto everything = [&] {
    const envmap::PrefilteredEnvironment maps = run(env, request);
    std::vector<double> values;
    for (const envmap::PrefilteredLobe& lobe : maps.lobes)
      values.insert(values.end(), lobe.map.texels.begin(), lobe.map.texels.end());
    for (int row = 0; row < env.height(); ++row)
      for (const double exponent : {1.0, 1.3})
        values.push_back(1 + bright.lobe(env.direction(row, row), CosineKernel(exponent)).x);
    values.push_back(reference_lobe(env, {0, 0, 1}, 6).y);
    return values;
  };
  const std::vector<double> widest = everything();
  const std::int64_t all = hwy::SupportedTargets();
  for (const std::int64_t target :
       {std::int64_t{HWY_STATIC_TARGET}, std::int64_t{HWY_SSE4}, std::int64_t{HWY_AVX2}, std::int64_t{HWY_AVX3}}) {
    if (target != HWY_STATIC_TARGET && (all & target) == 0) continue;
    hwy::SetSupportedTargetsForTest(target | HWY_STATIC_TARGET);
    const std::vector<double> other = everything();
    ASSERT_EQ(other.size(), widest.size());
    for (std::size_t i = 0; i < other.size(); ++i)
      ASSERT_NEAR(other[i] / widest[i], 1, 2e-6) << hwy::TargetName(target) << " " << i;
  }
  hwy::SetSupportedTargetsForTest(0);
}

// Cubes go the same way, whichever convention they came in.
TEST(HardCase, PrefilterConventionOneSceneInThreeLayouts) {
  const auto scene = [](const Vec3& d) { return Vec3{1 + 0.5 * d.x, 1 + 0.3 * d.y * d.z, 1 - 0.4 * d.z}; };
  const envmap::Environment flat = lat_long(128, [&](int, int, const Vec3& d) { return scene(d); });
  constexpr int kSize = 64;
  envmap::CubeMap map(kSize);
  image::Image edges = {kSize, 6 * kSize, 3, {}, {}};
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < kSize; ++row)
      for (int column = 0; column < kSize; ++column) {
        const Vec3 center = scene(envmap::cube_direction(face, column + 0.5, row + 0.5, kSize));
        const Vec3 edge = scene(envmap::cube_direction(face, 2.0 * column / (kSize - 1), 2.0 * row / (kSize - 1), 2));
        for (int c = 0; c < 3; ++c) {
          map.at(face, row, column)[c] = static_cast<float>(center[c]);
          edges.data.push_back(static_cast<float>(edge[c]));
        }
      }
  const PrefilterRequest request = {{6, 70}, false, 8, 1e-5};
  const envmap::PrefilteredEnvironment a = run(flat, request),
                                       b = run(envmap::Environment::from_cube(map, "cube"), request);
  const envmap::PrefilteredEnvironment c =
      run(envmap::Environment::from_cube_edges(edges, BadPixels::kError, "edges").value(), request);
  for (std::size_t i = 0; i < all_of(a).size(); ++i)
    for (std::size_t k = 0; k < all_of(a)[i]->map.texels.size(); ++k) {
      // The scene is sampled at centers: h^2/24 of its curvature.
      EXPECT_NEAR(all_of(b)[i]->map.texels[k], all_of(a)[i]->map.texels[k], 3e-4);
      EXPECT_NEAR(all_of(c)[i]->map.texels[k], all_of(a)[i]->map.texels[k], 1e-3);
    }
}

// Measured light, one probe with a sun of 8e4.
TEST(Prefilter, ProbesKeepToleranceAndEnergyRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (!data) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  for (const char* name : {"rooitou_park_1k", "uffizi"}) {
    const auto env = envmap::Environment::read(std::string(data) + "/probes/" + name + ".hdr", BadPixels::kError);
    ASSERT_TRUE(env.ok()) << env.error().message;
    const PrefilterRequest request = {{6, 250, 3000}, false, 64, 1e-4};
    const envmap::PrefilteredEnvironment result = run(*env, request);
    for (const envmap::PrefilteredLobe* lobe : all_of(result)) {
      EXPECT_LE(lobe_error(*env, *lobe, 8, 4, 1).max, request.tolerance) << name << " " << lobe->exponent;
      // The sum over texel centers errs by h^2/24 of a lobe's curvature; a lobe of 3000 on 64 texels is past that.
      if (lobe->exponent < 1000) {
        EXPECT_NEAR(energy_ratio(env->flux(), *lobe), 1, 1e-4) << name << " " << lobe->exponent;
      }
    }
  }
}

}  // namespace
}  // namespace goniochrome::prefilter::prefilter_test
