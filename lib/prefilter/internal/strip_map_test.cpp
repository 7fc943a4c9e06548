#include "prefilter/internal/strip_map.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <random>

#include "base/angles.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/internal/local_sums.h"

namespace goniochrome::prefilter::strip_map_test {
namespace {

envmap::Environment noise(int height, float sun = 0) {
  std::mt19937 random(11);
  std::uniform_real_distribution<float> unit(0, 2);
  image::Image image = {2 * height, height, 3, {}, {}};
  for (int i = 0; i < 6 * height * height; ++i) image.data.push_back(unit(random));
  if (sun > 0) std::fill_n(image.pixel(height / 3, height / 4), 3, sun);
  return envmap::Environment::from_lat_long(image, envmap::Environment::BadPixels::kError, "noise").value();
}

// The square of the cosine within 60 deg, times the solid angle.
double counted(const envmap::Environment& env, int column, int row, const Vec3& d) {
  const double t = dot(d, env.direction(column, row));
  return t > 0.5 ? t * t * env.solid_angle(column, row) : 0;
}

// The largest relative difference between the sums of a map and those of each direction by itself, over all texels of a
// cube, and for how many directions weights were asked for.
std::pair<double, int> difference_and_seats(const envmap::Environment& env, const envmap::Rotation& turn) {
  const envmap::SphereGrid cube(envmap::SphereGrid::Layout::kCube, 8, 48);
  std::vector<Vec3> directions;
  for (int i = 0; i < 384; ++i) directions.push_back(turn.to_environment(cube.direction(i % 8, i / 8)));
  std::atomic<int> seats = 0;
  const std::vector<Vec3> sums = StripMap(env, {}).sums(directions, [&](const StripMap::Seat& seat, Strips& strips) {
    ++seats;
    std::vector<float> weights(static_cast<std::size_t>(env.width()));
    for (int row = 0; row < env.height(); ++row) {
      for (int column = 0; column < env.width(); ++column)
        weights[static_cast<std::size_t>(column)] = static_cast<float>(counted(env, column, row, seat.d));
      strips.add(row, 0, weights.data(), weights.size());
    }
  });
  double worst = 0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    Vec3 want;
    for (int row = 0; row < env.height(); ++row)
      for (int column = 0; column < env.width(); ++column) {
        const float* rgb = env.radiance(column, row);
        want += counted(env, column, row, directions[i]) * Vec3{rgb[0], rgb[1], rgb[2]};
      }
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::fabs(sums[i][c] / want[c] - 1));
  }
  return {worst, seats};
}

// A weight and a product round by 6e-8 each, and sixteen strips of a vector's lanes are added up as floats.
constexpr double kRounding = 1e-6;

// Upright: 256 texels of the sides in sixteens, and of 128 on top and below the 32 on the diagonals in eights. Columns
// that a quarter turn does not meet, and turns about the axis, leave eights; any other turn leaves pairs.
TEST(StripMap, SharesWeightsAmongDirectionsThatLieAlike) {
  const auto turned = envmap::Rotation::about_axes;
  const struct {
    int height;
    envmap::Rotation turn;
    int seats;
  } cases[] = {{32, {}, 26}, {33, {}, 48}, {32, turned(0.3, 0, 0), 48}, {32, turned(0.3, 0.2, 0.1), 192}};
  for (const auto& [height, turn, want] : cases) {
    const auto [difference, seats] = difference_and_seats(noise(height), turn);
    EXPECT_LE(difference, kRounding) << height << " " << want;
    EXPECT_EQ(seats, want) << height;
  }
}

// A lobe that reaches over the poles and the seam of a map of noise with a sun, in all its directions.
TEST(LocalSums, AreTheReference) {
  const envmap::Environment env = noise(64, 1e5F);
  const LocalSums local(env);
  const std::vector<Vec3> directions = {{0, 1, 0},
                                        normalized({0.01, -1, 0.02}),
                                        normalized({0.03, 0.2, -1}),
                                        normalized({-0.03, 0.2, -1}),
                                        normalized({0.3, 0.5, 0.4}),
                                        env.direction_at(21.3, 16.2),
                                        env.direction_at(23, 18)};
  for (const double exponent : {1500.0, 1e5}) {
    const CosineKernel kernel(exponent);
    const std::vector<Vec3> sums = local.lobe(directions, kernel, 1e-17), few = local.lobe(directions, kernel, 0.1);
    double without = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const Vec3 want = reference_lobe(env, directions[i], exponent);
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(sums[i][c] / want[c], 1, kRounding) << exponent << " " << i;
        without = std::max(without, std::fabs(few[i][c] / want[c] - 1));
      }
    }
    EXPECT_GT(without, 1e-4) << exponent;  // the control: a circle that is too small
  }
}

}  // namespace
}  // namespace goniochrome::prefilter::strip_map_test
