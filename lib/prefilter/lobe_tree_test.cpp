#include "prefilter/lobe_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/internal/environments_for_test.h"

namespace goniochrome::prefilter::lobe_tree_test {
namespace {

Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return normalized({normal(random), normal(random), normal(random)});
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

TEST(HardCase, PrefilterExponentBlocksKeepTheTolerance) {
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

// Lobes that are narrower than a texel have a quadrature of their own, beside texels' edges and at the poles, where
// columns are narrow. The reference cuts texels into quarters.
TEST(LobeTree, SharpLobesOnLatLongMapsKeepTheTolerance) {
  constexpr double kTolerance = 1e-5;
  std::mt19937_64 random(12);
  for (const envmap::Environment& env : environments()) {
    if (env.layout() != envmap::Environment::Layout::kLatLong) continue;
    const LobeTree tree(env);
    const Vec3 mean = (1 / (4 * kPi)) * env.flux();
    std::vector<Vec3> directions = {{0, 1, 0}, {1e-3, -1, 1e-4}, {0.02, 1, -0.01}, {0, 0, -1}, env.direction(3, 3)};
    for (int i = 0; i < 4; ++i) directions.push_back(random_direction(random));
    for (Vec3& d : directions) d = normalized(d);
    for (const double exponent : {3e3, 2e4, 1e5, 1e6})
      for (const Vec3& d : directions) {
        const Vec3 want = reference_lobe(env, d, exponent), got = tree.lobe(d, exponent, kTolerance);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(got[c], want[c], kTolerance * std::max(want[c], 1e-3 * mean[c])) << exponent << " " << d.y;
      }
  }
}

}  // namespace
}  // namespace goniochrome::prefilter::lobe_tree_test
