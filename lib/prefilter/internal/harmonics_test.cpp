#include "prefilter/internal/harmonics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "math/fft.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/internal/harmonic_grid.h"

namespace goniochrome::prefilter {
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

TEST(Fft, every_length_equals_the_sum) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const std::size_t n : {1, 2, 3, 4, 5, 6, 7, 8, 12, 15, 16, 22, 49, 60, 64, 97, 120}) {
    constexpr std::size_t kLanes = 8;
    std::vector<double> re(n * kLanes), im(n * kLanes), sr(n * kLanes), si(n * kLanes);
    for (double& v : re) v = normal(random);
    for (double& v : im) v = normal(random);
    for (const int sign : {-1, 1}) {
      auto fr = re, fi = im;
      math::Fft(n).transform(sign, kLanes, fr.data(), fi.data(), sr.data(), si.data());
      for (std::size_t k = 0; k < n; ++k) {
        long double wr = 0, wi = 0;
        for (std::size_t j = 0; j < n; ++j) {
          const long double a = 2 * acosl(-1) * static_cast<long double>(j * k % n) / n;
          const long double c = cosl(a), s = sign * sinl(a);
          wr += re[j * kLanes + 3] * c - im[j * kLanes + 3] * s;
          wi += re[j * kLanes + 3] * s + im[j * kLanes + 3] * c;
        }
        // n terms of order 1, each within a few ulps
        EXPECT_NEAR(fr[k * kLanes + 3], static_cast<double>(wr), 4e-16 * n + 4e-15) << n;
        EXPECT_NEAR(fi[k * kLanes + 3], static_cast<double>(wi), 4e-16 * n + 4e-15) << n;
      }
    }
  }
}

// k_l is the integral of (E+1) t^E P_l(t) over 0..1.
TEST(ZonalMultipliers, equal_the_integral) {
  for (const double exponent : {0.0, 0.3, 1.0, 6.0, 70.0}) {
    const std::vector<double> k = zonal_multipliers(exponent, 12);
    for (int l = 0; l <= 12; ++l) {
      double sum = 0;
      constexpr int kSteps = 200000;
      for (int i = 0; i < kSteps; ++i) {
        const double s = (i + 0.5) / kSteps, t = std::pow(s, 4);  // finer near 0, where t^0.3 bends
        sum += (exponent + 1) * std::pow(t, exponent) * std::legendre(static_cast<unsigned>(l), t) * 4 * s * s * s /
               kSteps;
      }
      EXPECT_NEAR(k[l], sum, 2e-7) << exponent << " " << l;
    }
  }
}

TEST(ZonalMultipliers, truncation_bound_holds_at_the_worst_point) {
  // At the axis of the lobe and opposite to it every term of the tail counts in full.
  for (const double exponent : {6.0, 20.0, 250.0}) {
    const int degree = sufficient_degree(exponent, 1e-6, 1000);
    ASSERT_GT(degree, 0);
    EXPECT_LE(truncation_bound(exponent, degree), 1e-6);
    EXPECT_GT(truncation_bound(exponent, degree - 1), 1e-6);
    const std::vector<double> k = zonal_multipliers(exponent, degree);
    for (const double angle : {0.0, 0.3, 1.0, 1.5, 1.7, 3.0}) {
      double sum = 0;
      for (int l = 0; l <= degree; ++l)
        sum += (2 * l + 1) * k[l] * std::legendre(static_cast<unsigned>(l), std::cos(angle));
      const double kernel = 2 * (exponent + 1) * std::pow(std::max(0.0, std::cos(angle)), exponent);
      EXPECT_NEAR(sum, kernel, 1e-6 + 1e-11 * kernel);
    }
  }
  EXPECT_EQ(sufficient_degree(0, 1e-3, 600), -1);
}

// The whole chain against the reference, for square and odd maps, and for the poles.
TEST(Harmonics, lobe_map_equals_the_reference) {
  for (const auto& [width, height] : {std::pair{128, 64}, {151, 75}, {150, 75}}) {
    const envmap::Environment env = random_environment(width, height, 5);
    for (const double exponent : {6.0, 70.0, 900.0}) {
      const int degree = sufficient_degree(exponent, 1e-8, 600);
      const Harmonics harmonics = harmonics_of(env, zonal_multipliers(exponent, degree));
      const GridAngles angles(cube(9), {});
      envmap::PrefilteredLobe lobe;
      lobe.exponent = exponent;
      lobe.map.size = 9;
      lobe.map.texels = lobe_values(harmonics, zonal_multipliers(exponent, degree), angles, 12);
      // Floats round at 6e-8.
      EXPECT_LT(lobe_error(env, lobe, 40, 3, 1).max, 3e-7) << width << " " << exponent;
    }
  }
}

TEST(Harmonics, lobe_map_of_a_cube_equals_the_reference) {
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
      const int degree = sufficient_degree(exponent, 1e-8, 600);
      const Harmonics harmonics = harmonics_of(env, zonal_multipliers(exponent, degree));
      envmap::PrefilteredLobe lobe;
      lobe.exponent = exponent;
      lobe.map.size = 9;
      lobe.map.texels = lobe_values(harmonics, zonal_multipliers(exponent, degree), GridAngles(cube(9), {}), 13);
      EXPECT_LT(lobe_error(env, lobe, 15, 3, 1).max, 2e-6) << exponent;
    }
}

TEST(Harmonics, taps_keep_their_promise) {
  const envmap::Environment env = random_environment(64, 32, 6);
  const double exponent = 50;
  const int degree = sufficient_degree(exponent, 1e-10, 600);
  const Harmonics harmonics = harmonics_of(env, zonal_multipliers(exponent, degree));
  const std::vector<double> k = zonal_multipliers(exponent, degree);
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
}  // namespace goniochrome::prefilter
