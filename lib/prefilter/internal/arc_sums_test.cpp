#include "prefilter/internal/arc_sums.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/angles.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/internal/bright_texels.h"

namespace goniochrome::prefilter::arc_sums_test {
namespace {

envmap::Environment noise(int height, float most) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0, most);
  image::Image image = {2 * height, height, 3, {}, {}};
  for (int i = 0; i < 6 * height * height; ++i) image.data.push_back(unit(random));
  return envmap::Environment::from_lat_long(image, envmap::Environment::BadPixels::kError, "noise").value();
}

// The poles, the seam, and anything between.
std::vector<Vec3> directions(int count) {
  std::vector<Vec3> all = {{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, -1}, {0, 0, 1}, normalized({0, 1e-9, 1})};
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  for (int i = 0; i < count; ++i) all.push_back(normalized({normal(random), normal(random), normal(random)}));
  return all;
}

double largest_error(const envmap::Environment& env, double exponent, double tolerance) {
  const std::vector<Vec3> to = directions(1), sums = arc_sums(env, {}, CosineKernel(exponent), to, tolerance);
  double worst = 0;
  for (std::size_t i = 0; i < to.size(); ++i) {
    const Vec3 want = reference_lobe(env, to[i], exponent);
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::fabs(sums[i][c] / want[c] - 1));
  }
  return worst;
}

// White noise, the worst of maps, on texels of h = 0.052 rad: N = 2 x 60 rows and columns are cut at random, each off
// by at most h^3/72 of its jump at two points (E = 1) and by h^2/4 over the points (E = 0), of a sum of pi.
TEST(ArcSums, OfNoiseKeepTheTolerance) {
  const envmap::Environment env = noise(60, 2);
  const double h = kPi / 60;
  EXPECT_LE(largest_error(env, 1, 1e-4), std::sqrt(120) * h * h * h / 72);
  EXPECT_LE(largest_error(env, 1, 1e-6), 0.5 * std::sqrt(120) * h * h * h / 72);
  EXPECT_LE(largest_error(env, 0, 1e-3), std::sqrt(120) * h * h / 4 / kPi / 4);
  EXPECT_LE(largest_error(env, 0, 1e-4), std::sqrt(120) * h * h / 4 / kPi / 16);
}

// The textbook sum over texel centers is the control: a center is above the horizon or it is not.
TEST(ArcSums, TexelCentersFail) {
  const envmap::Environment env = noise(60, 2);
  double worst = 0;
  for (const Vec3& d : directions(4)) {
    double sum = 0;
    for (int y = 0; y < env.height(); ++y)
      for (int x = 0; x < env.width(); ++x)
        sum += (dot(d, env.direction(x, y)) > 0 ? 1 : 0) * env.solid_angle(x, y) * env.radiance(x, y)[1];
    worst = std::max(worst, std::fabs(sum / (2 * kPi) / reference_lobe(env, d, 0).y - 1));
  }
  EXPECT_GT(worst, 2e-4);
  EXPECT_LT(largest_error(env, 0, 1e-4), worst / 3);
}

TEST(ArcSums, LeaveAConstantMapAsItIs) {
  image::Image image = {64, 32, 3, std::vector<float>(64 * 32 * 3, 0.25F), {}};
  const envmap::Environment env =
      envmap::Environment::from_lat_long(image, envmap::Environment::BadPixels::kError, "gray").value();
  for (const double exponent : {0.0, 1.0})
    // Two points across rows of 0.1 rad leave the sine h^4/4320, and its root where the horizon touches a row.
    for (const Vec3& sum : arc_sums(env, {}, CosineKernel(exponent), directions(40), 1e-4))
      EXPECT_NEAR(sum.x, 0.25, 2e-5) << exponent;
}

// What is split off by a clip is left out.
TEST(ArcSums, LeaveOutWhatIsClipped) {
  image::Image image = {64, 32, 3, std::vector<float>(64 * 32 * 3, 1.0F), {}};
  std::fill_n(image.pixel(20, 9), 3, 1e5F);
  const envmap::Environment env =
      envmap::Environment::from_lat_long(image, envmap::Environment::BadPixels::kError, "sun").value();
  const Vec3 sun = env.direction(20, 9);
  EXPECT_NEAR(arc_sums(env, {1000, 1}, CosineKernel(1), {sun}, 1e-4)[0].x, 1, 5e-5);  // rows of 0.1 rad, as above
  EXPECT_GT(arc_sums(env, {}, CosineKernel(1), {sun}, 1e-4)[0].x, 100);
}

}  // namespace
}  // namespace goniochrome::prefilter::arc_sums_test
