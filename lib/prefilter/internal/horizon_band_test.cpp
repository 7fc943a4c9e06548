#include "prefilter/internal/horizon_band.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/angles.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/internal/harmonic_grid.h"
#include "prefilter/internal/harmonics.h"

namespace goniochrome::prefilter::horizon_band_test {
namespace {

using Layout = envmap::SphereGrid::Layout;

// A map with as much in every degree up to twice the highest: white noise has more in the higher ones.
std::vector<Vec3> even_degrees(int degree) {
  std::vector<Vec3> beyond;
  for (int l = 0; l <= degree; ++l) {
    const double rms = std::sqrt(1 - l / (2.0 * degree));
    beyond.push_back({rms, rms, rms});
  }
  return beyond;
}

HorizonParts parts_of(double exponent, int degree, double allowed) {
  return HorizonParts(CosineKernel(exponent), even_degrees(degree), {allowed, allowed, allowed}, kPi / 128);
}

// The sum of (2l+1) k_l P_l(t) / (4 pi scale): what the multipliers k_l of a kernel make of it.
double smooth_part(const HorizonParts& parts, const CosineKernel& kernel, double t) {
  double sum = 0, p = 1, before = 0;
  for (std::size_t l = 0; l < parts.multipliers().size(); ++l) {
    const double n = static_cast<double>(l);
    sum += (2 * n + 1) / (4 * kPi * kernel.scale()) * parts.multipliers()[l] * p;
    const double next = ((2 * n + 1) * t * p - n * before) / (n + 1);
    before = p, p = next;
  }
  return sum;
}

// The two parts add up to the kernel wherever the band reaches, and the smooth part is the kernel beyond it.
TEST(HorizonParts, AddUpToTheKernel) {
  for (const double exponent : {0.0, 0.3, 0.9, 1.0}) {
    const CosineKernel kernel(exponent);
    const HorizonParts parts = parts_of(exponent, 256, 1e-6);
    const SecondIntegral& band = parts.band();
    for (double t = -0.5; t < 0.5; t += 0.00377) {
      // The outermost part of the band holds the bumps, too.
      const double within = band.reach - 6.0 / 256;
      if ((std::fabs(t) > within && std::fabs(t) < band.reach + 1e-4) || std::fabs(t) < 1e-3) continue;
      // Cubics of F bend D by (0.65/16)^2/12 of itself; the power bends by (step/t)^2 more.
      const double got = smooth_part(parts, kernel, t) + band.mean(t, 1e-5, 2e-5);
      EXPECT_NEAR(got, kernel.value(t), std::fabs(t) < within ? 1e-4 : 3e-3) << exponent << " " << t;
    }
  }
}

// Away from the horizon the table of means is the mean over square texels, however they are turned, to 0.2 % of the
// largest value of D, and over texels of a third of the area, which lie near the poles of a map, to 1 %.
TEST(HorizonParts, MeansAwayFromTheHorizon) {
  const double h = kPi / 512, largest = 0.07;  // 512^-0.3 / 2
  const HorizonParts parts(CosineKernel(0.3), even_degrees(512), {}, h);
  const SecondIntegral& band = parts.band();
  ASSERT_LT(band.cut, h);
  for (double t = band.cut; t < band.reach + 2 * h; t += 1e-4) {
    for (const double turn : {1e-3, 0.3, 0.6, kPi / 4}) {
      const double along = h * std::cos(turn), down = h * std::sin(turn);
      EXPECT_NEAR(band.far_mean(t, along, down), band.mean(t, along, down), 2e-3 * largest) << t << " " << turn;
      EXPECT_NEAR(band.far_mean(-t, along / 3, down), band.mean(-t, along / 3, down), 1e-2 * largest) << t;
    }
  }
  // Texels that are wide beside a wave do without.
  EXPECT_GT(HorizonParts(CosineKernel(0.3), even_degrees(512), {}, 2 * h).band().cut, 1);
}

// Less may be left out of a wider band. The slope of F beyond the band is the integral of D and of the bumps, which is
// 0 over all of the sphere since k_0 of the smooth part is 1; what lies beyond 100/256 of the horizon is not looked at.
TEST(HorizonParts, LeaveOutNoMoreThanAskedFor) {
  double reach = 0;
  for (const double allowed : {3e-5, 3e-6, 3e-7}) {
    const HorizonParts parts = parts_of(0.3, 256, allowed);
    EXPECT_LE(parts.left_out().y, allowed);
    EXPECT_GT(parts.band().reach, reach);
    reach = parts.band().reach;
    EXPECT_NEAR((parts.band().at(0.5) - parts.band().at(0.4)) / 0.1, 0, 3e-7) << allowed;
  }
  EXPECT_GE(parts_of(0.3, 256, 0).band().reach, 40.0 / 256);
  EXPECT_EQ(parts_of(0.3, 256, 1).band().reach, 0);
}

// The map of the smooth part of noise differs from the map with the band by as much as is stated, by Parseval.
TEST(HorizonParts, SayWhatTheyLeaveOut) {
  const int degree = 96;
  const CosineKernel kernel(0.3);
  Harmonics noise(degree);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::vector<Vec3> beyond(static_cast<std::size_t>(degree) + 1);
  for (int m = 0; m <= degree; ++m)
    for (int l = m; l <= degree; ++l)
      for (int c = 0; c < 6; ++c) {
        const double a = l == 0 || (m == 0 && c >= 3) ? 0 : normal(random);
        noise.order(m)[6 * (l - m) + c] = a;
        for (int less = 0; less < l; ++less)
          beyond[static_cast<std::size_t>(less)][c % 3] += (m == 0 ? 1 : 2) * a * a / (4 * kPi);
      }
  for (Vec3& v : beyond)
    for (int c = 0; c < 3; ++c) v[c] = std::sqrt(v[c]);
  const HorizonParts none(kernel, beyond, {1e9, 1e9, 1e9}, kPi / 128);
  ASSERT_EQ(none.band().reach, 0);
  const envmap::SphereGrid grid(Layout::kCube, 12, 72);
  const GridAngles angles(grid, {});
  // Values below zero are cut off, so a level is added.
  Harmonics raised = noise;
  for (int c = 0; c < 3; ++c) raised.order(0)[c] = 100 * std::sqrt(4 * kPi) * beyond[0][c];
  const std::vector<float> exact = lobe_values(raised, kernel.multipliers(degree), angles, 14);
  const std::vector<float> smooth = lobe_values(raised, none.multipliers(), angles, 14);
  double square = 0;
  for (std::size_t i = 0; i < exact.size(); i += 3) square += std::pow(exact[i] - smooth[i], 2);
  const double rms = std::sqrt(square / (static_cast<double>(exact.size()) / 3));
  // 864 directions of about 9400 coefficients: 10 % is 4 standard deviations of their mean square.
  EXPECT_NEAR(none.left_out().x, rms, 0.1 * rms);
}

envmap::Environment noise(Layout layout, int size) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0, 2);
  const bool flat = layout == Layout::kLatLong;
  image::Image image = {flat ? 2 * size : size, flat ? size : 6 * size, 3, {}, {}};
  for (int i = 0; i < 3 * image.width * image.height; ++i) image.data.push_back(unit(random));
  constexpr auto kError = envmap::Environment::BadPixels::kError;
  if (flat) return envmap::Environment::from_lat_long(image, kError, "noise").value();
  if (layout == Layout::kCubeEdges) return envmap::Environment::from_cube_edges(image, kError, "noise").value();
  envmap::CubeMap map(size);
  map.texels = image.data;
  return envmap::Environment::from_cube(map, "noise");
}

// The error of the harmonics of the smooth part with the band, and without it: relative, at texels of a small cube.
std::pair<double, double> errors(const envmap::Environment& env, double exponent) {
  const CosineKernel kernel(exponent);
  const HorizonParts parts = parts_of(exponent, 192, 0);
  const Harmonics harmonics = harmonics_of(env, kernel.multipliers(192));
  const envmap::SphereGrid grid(Layout::kCube, 5, 30);  // the middles of faces lie on the horizons of others
  const std::vector<float> smooth = lobe_values(harmonics, parts.multipliers(), GridAngles(grid, {}), 14);
  const HorizonBand band(env, {});
  double with = 0, without = 0;
  for (int i = 0; i < 150; i += 26) {
    const Vec3 d = grid.direction(i % 5, i / 5), want = reference_lobe(env, d, exponent);
    const Vec3 more = kernel.scale() * band.sums({d}, parts.band())[0];
    for (int c = 0; c < 3; ++c) {
      const double plain = smooth[3 * static_cast<std::size_t>(i) + static_cast<std::size_t>(c)];
      with = std::max(with, std::fabs(plain + more[c] - want[c]) / want[c]);
      without = std::max(without, std::fabs(plain - want[c]) / want[c]);
    }
  }
  return {with, without};
}

// White noise of rms 1/sqrt(3), on texels of h = 0.025 rad, is the worst of maps. The horizon cuts some 2 pi 1.3 / h =
// 330 texels, each off by at most r/5 = h/7 of what it adds, h^2 h^E / (2 pi) at most, with a random sign; three such
// deviations are allowed for.
TEST(HorizonBand, OfNoiseIsTheReference) {
  for (const Layout layout : {Layout::kLatLong, Layout::kCube, Layout::kCubeEdges}) {
    const envmap::Environment env = noise(layout, layout == Layout::kLatLong ? 128 : 64);
    const double h = kPi / 128;
    for (const double exponent : {0.0, 0.3, 0.7, 1.0}) {
      if (layout != Layout::kLatLong && exponent != 0.3) continue;
      const auto [with, without] = errors(env, exponent);
      EXPECT_LE(with, 3 * std::sqrt(330 / 3.0) * h / 7 * h * h * std::pow(h, exponent) / (2 * kPi))
          << exponent << " " << int(layout);
      // Without the band, as a control.
      EXPECT_GT(without, 3 * with) << exponent << " " << int(layout);
    }
  }
}

// A half sphere of light is a step along great circles, which may be the horizon itself.
TEST(HorizonBand, OfAHalfSphereIsThePublishedIntegral) {
  image::Image image = {256, 128, 3, std::vector<float>(256 * 128 * 3, 0.0F), {}};
  std::fill_n(image.pixel(0, 0), 256 * 64 * 3, 1.0F);
  const envmap::Environment env =
      envmap::Environment::from_lat_long(image, envmap::Environment::BadPixels::kError, "half").value();
  const CosineKernel kernel(0);
  const HorizonParts parts = parts_of(0, 256, 0);
  const Harmonics harmonics = harmonics_of(env, kernel.multipliers(256));
  const envmap::SphereGrid grid(Layout::kLatLong, 10, 5);  // the third row lies on the horizon of the poles
  const std::vector<float> smooth = lobe_values(harmonics, parts.multipliers(), GridAngles(grid, {}), 14);
  const HorizonBand band(env, {});
  for (std::size_t i = 0; i < 50; ++i) {
    const Vec3 d = grid.direction(static_cast<int>(i % 10), static_cast<int>(i / 10));
    const double got = smooth[3 * i] + kernel.scale() * band.sums({d}, parts.band())[0].x;
    EXPECT_NEAR(got, 1 - std::acos(d.y) / kPi, 2e-6) << i;
  }
}

}  // namespace
}  // namespace goniochrome::prefilter::horizon_band_test
