#include "prefilter/exact_lobe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "base/angles.h"
#include "math/cosine_power.h"
#include "prefilter/internal/lobe_patch.h"

namespace goniochrome::prefilter::exact_lobe_test {
namespace {

using BadPixels = envmap::Environment::BadPixels;

envmap::Environment lat_long(int height, const std::function<Vec3(const Vec3&)>& value, int width = 0) {
  if (width == 0) width = 2 * height;
  image::Image image = {width, height, 3, std::vector<float>(static_cast<std::size_t>(width) * height * 3), {}};
  const envmap::Environment frame = envmap::Environment::from_lat_long(image, BadPixels::kError, "frame").value();
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const Vec3 rgb = value(frame.direction(x, y));
      for (int c = 0; c < 3; ++c) image.pixel(x, y)[c] = static_cast<float>(rgb[c]);
    }
  return envmap::Environment::from_lat_long(image, BadPixels::kError, "test").value();
}

envmap::Environment cube_edges(int n) {
  return envmap::Environment::from_cube_edges(
             {n, 6 * n, 3, std::vector<float>(static_cast<std::size_t>(n) * n * 18, 1.0F), {}}, BadPixels::kError, "e")
      .value();
}

envmap::Environment cube(int n, float value) {
  envmap::CubeMap map(n);
  for (float& v : map.texels) v = value;
  return envmap::Environment::from_cube(map, "cube");
}

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return normalized({normal(random), normal(random), normal(random)});
}

// A constant map stays itself, for every exponent and layout; only the pieces along the horizon are not exact.
TEST(ExactLobe, OfAConstantMapIsOne) {
  std::vector<envmap::Environment> all;
  for (const int height : {1, 3, 64}) all.push_back(lat_long(height, [](const Vec3&) { return Vec3{1, 1, 1}; }));
  all.push_back(lat_long(
      3,
      [](const Vec3&) {
        return Vec3{1, 1, 1};
      },
      7));
  all.push_back(cube(1, 1));
  all.push_back(cube(16, 1));
  all.push_back(cube_edges(2));
  all.push_back(cube_edges(9));
  std::mt19937_64 random(1);
  for (const envmap::Environment& env : all)
    for (const double exponent : {0.0, 0.3, 1.0, 6.0, 70.0, 3000.0, 1e5}) {
      const Vec3 d = random_direction(random);
      EXPECT_NEAR(reference_lobe(env, d, exponent).x, 1, exponent < 1 ? 1e-6 : 1e-7)
          << "width " << env.width() << " exponent " << exponent;
    }
}

// The rows of many texels at a time against the recursion, texel by texel.
TEST(ExactLobe, RowsEqualTheRecursionTexelByTexel) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  const envmap::Environment flat = lat_long(64, [&](const Vec3&) {
    return Vec3{unit(random), unit(random), unit(random)};
  });
  envmap::CubeMap map(48);
  for (float& v : map.texels) v = static_cast<float>(unit(random));
  const envmap::Environment box = envmap::Environment::from_cube(map, "box");
  for (const envmap::Environment* env : {&flat, &box})
    for (const double exponent : {0.0, 0.3, 1.0, 1.3, 2.0, 6.0, 70.0, 900.0, 3e4}) {
      const Vec3 d = random_direction(random);
      Vec3 sum;
      for (int row = 0; row < env->height(); ++row)
        for (int column = 0; column < env->width(); ++column) {
          const float* rgb = env->radiance(column, row);
          const envmap::Cell cell = {double(column), double(row), column + 1.0, row + 1.0};
          sum += lobe_over_cell(*env, cell, d, CosineKernel(exponent), 1e-8, 1e-5) * Vec3{rgb[0], rgb[1], rgb[2]};
        }
      sum = (exponent + 1) / (2 * kPi) * sum;
      const Vec3 got = reference_lobe(*env, d, exponent);
      // Texels of 2.8 deg and 2.4 deg, the largest that the rows take.
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / sum[c], 1, 2e-6) << env->width() << " " << exponent;
    }
}

// One texel far from the middle of the lobe is its solid angle times (E+1)/2pi cos^E.
TEST(ExactLobe, OfOneTexelIsTheCosinePower) {
  image::Image image = {360, 180, 3, std::vector<float>(360 * 180 * 3), {}};
  for (int c = 0; c < 3; ++c) image.pixel(100, 60)[c] = 5;
  const envmap::Environment env = envmap::Environment::from_lat_long(image, BadPixels::kError, "one").value();
  const Vec3 texel = env.direction(100, 60);
  std::mt19937_64 random(3);
  for (const double exponent : {0.0, 1.0, 2.5, 20.0, 900.0}) {
    for (int i = 0; i < 20; ++i) {
      const Vec3 d = normalized(texel + (i * 0.02) * random_direction(random));
      const double want =
          5 * env.solid_angle(100, 60) * (exponent + 1) / (2 * kPi) * math::cosine_power(dot(d, texel), exponent);
      const double angle = envmap::angle_between(d, texel);
      // The patch against its center: E h^2/24 (1 + E tan^2) with h = 1 deg, two ways.
      const double h = kDegree, spread = exponent * h * h / 6 * (1 + exponent * std::pow(std::tan(angle), 2)) + 1e-4;
      if (spread < 0.5) {
        EXPECT_NEAR(reference_lobe(env, d, exponent).y / want, 1, spread) << exponent << " " << i;
      }
    }
  }
}

// Light from z > 0 alone, closed forms: E = 0: 1 - angle/pi; E = 1: (1 + cos)/2; E = 2: for a half-space, by parts.
TEST(ExactLobe, OfAHalfSphereIsThePublishedIntegral) {
  const envmap::Environment env = lat_long(90, [](const Vec3& d) { return d.x > 0 ? Vec3{1, 1, 1} : Vec3{0, 0, 0}; });
  for (double angle = 0; angle <= kPi + 1e-9; angle += kPi / 12) {
    const Vec3 d = {std::cos(angle), std::sin(angle), 0};
    EXPECT_NEAR(reference_lobe(env, d, 0).x, 1 - angle / kPi, 1e-6);
    EXPECT_NEAR(reference_lobe(env, d, 1).x, (1 + std::cos(angle)) / 2, 1e-7);
  }
}

// Convergence: what the recursion answers at a coarse and at a fine setting agrees; cells of 15 deg.
TEST(ExactLobe, RecursionConverges) {
  const envmap::Environment env = lat_long(12, [](const Vec3&) { return Vec3{1, 1, 1}; });
  std::mt19937_64 random(4);
  for (const double exponent : {0.0, 0.3, 1.0, 6.0, 300.0, 1e5})
    for (int i = 0; i < 30; ++i) {
      const envmap::Cell cell = {double(i % 24), double(i % 12), i % 24 + 1.0, i % 12 + 1.0};
      const Vec3 d = normalized(env.direction(i % 24, i % 12) + 0.3 * random_direction(random));
      const double fine = lobe_over_cell(env, cell, d, CosineKernel(exponent), 1e-12, 1e-6);
      const double area = env.solid_angle(i % 24, i % 12);
      EXPECT_NEAR(lobe_over_cell(env, cell, d, CosineKernel(exponent), 1e-8, 1e-4), fine, 1e-4 * area / (exponent + 1))
          << exponent;
    }
}

}  // namespace
}  // namespace goniochrome::prefilter::exact_lobe_test
