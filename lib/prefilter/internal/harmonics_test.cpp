#include "prefilter/internal/harmonics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "prefilter/exact_lobe.h"
#include "prefilter/internal/harmonic_grid.h"

namespace goniochrome::prefilter::harmonics_test {
namespace {

envmap::Environment random_environment(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  image::Image image = {width, height, 3, {}, {}};
  for (int i = 0; i < width * height * 3; ++i) image.data.push_back(unit(random));
  return envmap::Environment::from_lat_long(image, envmap::Environment::BadPixels::kError, "random").value();
}

envmap::SphereGrid cube(int n) {
  return envmap::map_grid(envmap::SphereGrid::Layout::kCube, n);
}

TEST(Harmonics, TruncationBoundHoldsAtTheWorstPoint) {
  // At the axis of the lobe and opposite to it every term of the tail counts in full.
  for (const double exponent : {6.0, 20.0, 250.0}) {
    const int degree = sufficient_degree(CosineKernel(exponent), 1e-6, 1000);
    ASSERT_GT(degree, 0);
    EXPECT_LE(truncation_bound(CosineKernel(exponent), degree), 1e-6);
    EXPECT_GT(truncation_bound(CosineKernel(exponent), degree - 1), 1e-6);
    const std::vector<double> k = CosineKernel(exponent).multipliers(degree);
    for (const double angle : {0.0, 0.3, 1.0, 1.5, 1.7, 3.0}) {
      double sum = 0;
      for (int l = 0; l <= degree; ++l)
        sum += (2 * l + 1) * k[l] * std::legendre(static_cast<unsigned>(l), std::cos(angle));
      const double kernel = 2 * (exponent + 1) * std::pow(std::max(0.0, std::cos(angle)), exponent);
      EXPECT_NEAR(sum, kernel, 1e-6 + 1e-11 * kernel);
    }
  }
  EXPECT_EQ(sufficient_degree(CosineKernel(0), 1e-3, 600), -1);
}

// The whole chain against the reference, for square and odd maps, and for the poles.
TEST(Harmonics, LobeMapEqualsTheExactSums) {
  for (const auto& [width, height] : {std::pair{128, 64}, {151, 75}, {150, 75}}) {
    const envmap::Environment env = random_environment(width, height, 5);
    for (const double exponent : {6.0, 70.0, 900.0}) {
      const int degree = sufficient_degree(CosineKernel(exponent), 1e-8, 600);
      const Harmonics harmonics = harmonics_of(env, CosineKernel(exponent).multipliers(degree));
      const GridAngles angles(cube(9), {});
      envmap::PrefilteredLobe lobe;
      lobe.exponent = exponent;
      lobe.map.size = 9;
      lobe.map.texels = lobe_values(harmonics, CosineKernel(exponent).multipliers(degree), angles, 12);
      // Floats round at 6e-8.
      EXPECT_LT(lobe_error(env, lobe, 40, 3, 1).max, 3e-7) << width << " " << exponent;
    }
  }
}

TEST(Harmonics, LobeMapOfACubeEqualsTheExactSums) {
  std::mt19937 random(12);
  std::uniform_real_distribution<float> unit(0, 1);
  image::Image strip = {44, 264, 3, {}, {}};
  for (int i = 0; i < 44 * 264 * 3; ++i) strip.data.push_back(unit(random));
  envmap::CubeMap map(44);
  map.texels = strip.data;
  std::vector<envmap::Environment> all = {envmap::Environment::from_cube(map, "cube")};
  all.push_back(envmap::Environment::from_cube_edges(strip, envmap::Environment::BadPixels::kError, "edges").value());
  for (const envmap::Environment& env : all)
    for (const double exponent : {6.0, 70.0, 900.0}) {
      const int degree = sufficient_degree(CosineKernel(exponent), 1e-8, 600);
      const Harmonics harmonics = harmonics_of(env, CosineKernel(exponent).multipliers(degree));
      envmap::PrefilteredLobe lobe;
      lobe.exponent = exponent;
      lobe.map.size = 9;
      lobe.map.texels = lobe_values(harmonics, CosineKernel(exponent).multipliers(degree), GridAngles(cube(9), {}), 13);
      EXPECT_LT(lobe_error(env, lobe, 15, 3, 1).max, 2e-6) << exponent;
    }
}

TEST(Harmonics, TapsKeepTheirError) {
  const envmap::Environment env = random_environment(64, 32, 6);
  const double exponent = 50;
  const int degree = sufficient_degree(CosineKernel(exponent), 1e-10, 600);
  const Harmonics harmonics = harmonics_of(env, CosineKernel(exponent).multipliers(degree));
  const std::vector<double> k = CosineKernel(exponent).multipliers(degree);
  const GridAngles angles(cube(16), {});
  const std::vector<float> best = lobe_values(harmonics, k, angles, 14);
  for (const double error : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    const std::vector<float> map = lobe_values(harmonics, k, angles, taps_for(error));
    double worst = 0;
    for (std::size_t i = 0; i < map.size(); ++i) worst = std::max(worst, std::fabs(double(map[i]) - best[i]));
    EXPECT_LT(worst, error);
  }
}

}  // namespace
}  // namespace goniochrome::prefilter::harmonics_test
