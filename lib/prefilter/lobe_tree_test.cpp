#include "prefilter/lobe_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/internal/mirror.h"

namespace goniochrome::prefilter {
namespace {

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return normalized({normal(random), normal(random), normal(random)});
}

std::vector<envmap::Environment> environments() {
  std::mt19937 random(8);
  std::lognormal_distribution<float> contrast(0, 1.5F);
  image::Image image = {160, 80, 3, {}, {}};
  for (int i = 0; i < 160 * 80 * 3; ++i) image.data.push_back(contrast(random));
  image.pixel(40, 20)[0] = image.pixel(40, 20)[1] = 1e5F;
  std::vector<envmap::Environment> all;
  all.push_back(envmap::Environment::from_lat_long(image, envmap::Environment::BadPixels::kError, "flat").value());
  envmap::CubeMap map(45);
  for (float& v : map.texels) v = contrast(random);
  all.push_back(envmap::Environment::from_cube(map, "cube"));
  return all;
}

// The textbook truncates the support where cos^E < 1e-3 and takes texel centers: nothing is left of a narrow lobe, and
// E = 0 and 0.3 lose their flanks.
double truncated_error(const envmap::Environment& env, double exponent) {
  std::mt19937_64 random(10);
  double worst = 0;
  for (int i = 0; i < 5; ++i) {
    const Vec3 d = random_direction(random);
    double sum = 0, norm = 0;
    for (int row = 0; row < env.height(); ++row)
      for (int column = 0; column < env.width(); ++column) {
        const double k = std::pow(std::max(0.0, dot(d, env.direction(column, row))), exponent);
        if (k < 1e-3) continue;
        norm += k * env.solid_angle(column, row);
        sum += k * env.solid_angle(column, row) * env.radiance(column, row)[2];
      }
    const double got = norm > 0 ? sum / norm : 0, want = reference_lobe(env, d, exponent).z;
    worst = std::max(worst, std::fabs(got - want) / want);
  }
  return worst;
}

TEST(LobeTree, HardCase_prefilter_exponent_every_exponent_is_within_its_tolerance) {
  double ours = 0, textbook = INFINITY;
  std::mt19937_64 random(9);
  for (const envmap::Environment& env : environments()) {
    const LobeTree tree(env);
    const Vec3 mean = (1 / (4 * kPi)) * env.flux();
    for (const double exponent : {0.0, 0.3, 1.0, 1.3, 6.0, 250.0, 1e5})
      for (const double tolerance : {1e-2, 1e-4})
        for (int i = 0; i < 3; ++i) {
          const Vec3 d = random_direction(random);
          const Vec3 want = reference_lobe(env, d, exponent), got = tree.lobe(d, exponent, tolerance);
          for (int c = 0; c < 3; ++c)
            ours = worst_of(ours, std::fabs(got[c] - want[c]) / std::max(want[c], 1e-3 * mean[c]) / tolerance);
        }
  }
  const envmap::Environment flat = environments().front();
  for (const double exponent : {0.0, 0.3, 1e5}) textbook = std::min(textbook, truncated_error(flat, exponent) / 1e-4);
  hard_case("prefilter-exponent", {.what = "error over the tolerance asked for, E from 0 to 1e5",
                                   .textbook = textbook,
                                   .ours = ours,
                                   .bound = 1,
                                   .unit = "ratio"});
}

envmap::CubeMap mirror_map(const envmap::Environment& env, int n) {
  envmap::CubeMap map(n);
  map.texels = mirror_values(env, envmap::map_grid(envmap::SphereGrid::Layout::kCube, n), {});
  return map;
}

TEST(Mirror, keeps_flux_and_constants_and_copies_an_equal_cube) {
  for (const envmap::Environment& env : environments())
    for (const int n : {1, 2, 7, 16, 45}) {
      const envmap::Environment mirror = envmap::Environment::from_cube(mirror_map(env, n), "mirror");
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(mirror.flux()[c] / env.flux()[c], 1, 1e-4) << n;
    }
  const envmap::Environment cube = environments().back();
  const envmap::CubeMap same = mirror_map(cube, 45);
  for (int row = 0; row < 6 * 45; ++row)
    for (int column = 0; column < 45; ++column)
      EXPECT_FLOAT_EQ(same.at(row / 45, row % 45, column)[1], cube.radiance(column, row)[1]);
  image::Image one = {33, 16, 3, std::vector<float>(33 * 16 * 3, 2.5F), {}};
  const envmap::Environment constant =
      envmap::Environment::from_lat_long(one, envmap::Environment::BadPixels::kError, "one").value();
  for (const float v : mirror_map(constant, 9).texels) EXPECT_FLOAT_EQ(v, 2.5F);
}

TEST(Mirror, equals_a_search_along_the_edges) {
  for (const envmap::Environment& env : environments()) {
    envmap::PrefilteredLobe lobe;
    lobe.exponent = envmap::kMirrorExponent;
    lobe.map = mirror_map(env, 12);
    const LobeError error = lobe_error(env, lobe, 24, 3, 3);
    // The search takes edges as straight over 1/128 of a texel, and a sun outshines the rest of its texel by 1e5.
    EXPECT_LT(error.max, 1e-3);
    EXPECT_LT(error.mean, 2e-5);
  }
}

}  // namespace
}  // namespace goniochrome::prefilter
