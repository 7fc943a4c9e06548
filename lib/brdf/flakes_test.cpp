#include "brdf/flakes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/angles.h"
#include "base/random_for_test.h"
#include "brdf/disc_light.h"
#include "brdf/lobe_model.h"

namespace goniochrome::brdf::flakes_test {
namespace {

// A level plate of explicit flakes, each with its place and the direction that it shows: the truth. A viewer at
// `view_deg` from the normal sees light from the other side; a flake is hidden in proportion to the cosine of what it
// shows, as every reflection model has it.
class Plate {
 public:
  Plate(double exponent, double view_deg, double per_m2, double side_m, std::uint64_t seed)
      : exponent_(exponent), per_m2_(per_m2), side_m_(side_m), numbers_(seed) {
    const double t = view_deg * kDegree;
    mirrored = {-std::sin(t), 0, std::cos(t)};
    const Vec3 x = normalized(across - dot(across, mirrored) * mirrored), y = cross(mirrored, x);
    for (double left = per_m2 * side_m * side_m; left > 0; --left) {
      const double cosine = std::pow(numbers_(), 1 / (exponent + 1)), sine = std::sqrt(1 - cosine * cosine),
                   turn = 2 * kPi * numbers_();
      const Vec3 shown = cosine * mirrored + sine * std::cos(turn) * x + sine * std::sin(turn) * y;
      const bool is_seen = numbers_() < shown.z;
      flakes_.push_back({numbers_() * side_m, numbers_() * side_m, shown, is_seen});
    }
  }

  // The radiance of each of pixels x pixels squares of the plate for K_DD = 1, where light(direction) is the radiance.
  std::vector<double> pixels(int pixels, const std::function<double(const Vec3&)>& light) const {
    std::vector<double> radiance(static_cast<std::size_t>(pixels * pixels));
    const double of_pixel = per_m2_ * side_m_ * side_m_ / (pixels * pixels);
    for (const Flake& flake : flakes_) {
      if (!flake.is_seen) continue;
      const int x = static_cast<int>(flake.x / side_m_ * pixels), y = static_cast<int>(flake.y / side_m_ * pixels);
      radiance[static_cast<std::size_t>(y * pixels + x)] += 2 * kPi / (exponent_ + 1) * light(flake.shown) / of_pixel;
    }
    return radiance;
  }

  Vec3 mirrored;
  const Vec3 normal{0, 0, 1}, across{1, 0, 0};

 private:
  struct Flake {
    double x, y;
    Vec3 shown;
    bool is_seen;
  };
  double exponent_, per_m2_, side_m_;
  TestNumbers numbers_;
  std::vector<Flake> flakes_;
};

FlakeLamp lamp_of(double exponent, double radius_rad, double spread_deg) {
  return {{{exponent, 1, nullptr, nullptr}}, radius_rad, spread_deg};
}

// The pixels by counts, lit by one disc of radiance 1.
std::vector<double> counted(const Plate& plate, double exponent, double per_m2, double side_m, int pixels,
                            const Vec3& toward, double radius_rad, double spread_deg) {
  const FlakeLamp lamp = lamp_of(exponent, radius_rad, spread_deg);
  FlakeBox box = tilts_that_show(lamp, plate.mirrored, plate.across, toward);
  box.size = {side_m / pixels, side_m / pixels};
  box.shown = dot(plate.normal, toward);
  const FlakeTree tree(per_m2, 1);
  const double white = std::pow(std::sin(radius_rad), 2);
  const double light = disc_light(lamp, 0, plate.normal, plate.mirrored, toward, paint::kNoCoat);
  std::vector<double> radiance;
  for (int i = 0; i < pixels * pixels; ++i) {
    box.place = {(i % pixels) * box.size[0], (i / pixels) * box.size[1]};
    radiance.push_back(white * light * tree.count(box) / (per_m2 * box.area() * box.part()));
  }
  return radiance;
}

struct Spread {
  double mean = 0, variance = 0, above[3] = {0, 0, 0};
};
Spread spread_of(const std::vector<double>& values) {
  Spread s;
  for (const double v : values) s.mean += v / static_cast<double>(values.size());
  for (const double v : values) s.variance += (v - s.mean) * (v - s.mean) / static_cast<double>(values.size());
  for (int i = 0; i < 3; ++i)
    for (const double v : values) s.above[i] += v > (2 << i) * s.mean ? 1 / static_cast<double>(values.size()) : 0;
  return s;
}

// Five per cent, and four standard errors of both samples of so many pixels.
void expect_alike(const Spread& a, const Spread& b, double pixels, double kurtosis, const std::string& where) {
  const double of_mean = std::sqrt(2 * b.variance / pixels) / b.mean;
  EXPECT_NEAR(a.mean / b.mean, 1, 0.01 + 4 * of_mean) << where;
  EXPECT_NEAR(a.variance / b.variance, 1, 0.05 + 4 * std::sqrt(2 * (kurtosis + 2) / pixels)) << where;
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(a.above[i], b.above[i], 0.05 * b.above[i] + 4 * std::sqrt(2 * b.above[i] / pixels) + 4 / pixels)
        << where << ", above " << (2 << i);
}

// The sun and a lamp of a studio, three lobes, pixels as from four distances.
TEST(Flakes, CountsAreThoseOfExplicitFlakes) {
  constexpr double kSpread_deg = 0.5;
  bool sparse = false, dense = false;
  for (const double exponent : {6.0, 20.0, 250.0}) {
    const double per_m2 = 1e5, side_m = 4;
    const Plate plate(exponent, 20, per_m2, side_m, 11);
    for (const double radius_rad : {0.265 * kDegree, 8 * kDegree}) {
      const double apart = (exponent > 100 ? 3 : 15) * kDegree;
      const Vec3 toward = normalized({-std::sin(20 * kDegree + apart), 0.05, std::cos(20 * kDegree + apart)});
      const double radius = shown_radius(radius_rad, kSpread_deg);
      const double dimmed = std::pow(std::sin(radius_rad) / std::sin(radius), 2);
      const auto light = [&](const Vec3& d) { return length(d - toward) <= 2 * std::sin(radius / 2) ? dimmed : 0; };
      for (const int pixels : {50, 100, 200, 400}) {
        const Spread truth = spread_of(plate.pixels(pixels, light)),
                     found =
                         spread_of(counted(plate, exponent, per_m2, side_m, pixels, toward, radius_rad, kSpread_deg));
        const double expected = truth.mean * truth.mean / truth.variance;
        sparse |= expected < 0.3, dense |= expected > 30;
        expect_alike(found, truth, pixels * pixels, 1 / expected,
                     "exponent " + std::to_string(exponent) + ", radius " + std::to_string(radius_rad) + ", pixels " +
                         std::to_string(pixels));
      }
    }
  }
  EXPECT_TRUE(sparse && dense);
}

// The prediction of what a pixel varies by, which decides whether it is drawn.
TEST(Flakes, PredictTheirVariance) {
  for (const double view_deg : {0.0, 45.0, 75.0}) {
    constexpr double kExponent = 20, kPer_m2 = 1e6, kSide_m = 1;
    constexpr int kPixels = 60;
    const Plate plate(kExponent, view_deg, kPer_m2, kSide_m, 5);
    const Vec3 toward = normalized(plate.mirrored + 0.1 * Vec3{0, 1, 0.5});
    const double radius = shown_radius(0.265 * kDegree, 1);
    const auto light = [&](const Vec3& d) { return length(d - toward) <= 2 * std::sin(radius / 2) ? 1.0 : 0; };
    const Spread truth = spread_of(plate.pixels(kPixels, light));
    const FlakeLamp sun = lamp_of(kExponent, 0.265 * kDegree, 1);
    const double predicted =
        disc_variance(sun, plate.normal, plate.mirrored, toward) * kPixels * kPixels / (kPer_m2 * kSide_m * kSide_m);
    EXPECT_NEAR(truth.variance / (truth.mean * truth.mean) / predicted, 1, 0.12) << view_deg;
    const double gathered = disc_light(sun, 0, plate.normal, plate.mirrored, toward, paint::kNoCoat);
    EXPECT_NEAR(gathered * std::pow(std::sin(0.265 * kDegree), 2) /
                    (truth.mean * std::pow(std::sin(0.265 * kDegree) / std::sin(radius), 2)),
                1, 0.05)
        << view_deg;
  }
}

TEST(Flakes, ASpotWiderThanTheLobeIsShownByAllFlakes) {
  EXPECT_NEAR(lamp_of(5000, 0.4, 0).part_that_shows(0), 1, 1e-3);
  const FlakeBox box = tilts_that_show(lamp_of(5000, 0.4, 0), {0, 0, 1}, {1, 0, 0}, {0, 0, 1});
  EXPECT_NEAR(box.tilts[0] * box.tilts[1], 1, 1e-3);
  EXPECT_LT(lamp_of(5000, 0.4, 0).part_that_shows(2 * std::sin(0.6)), 1e-6);
  // At every angle the box is within all tilts and has the flakes of the disc.
  for (const double between : {0.0, 1e-9, 0.01, 0.3, 1.0, 1.57, 2.5})
    for (const double exponent : {1.3, 20.0, 1e5}) {
      const Vec3 toward{std::sin(between), 0, std::cos(between)};
      const FlakeBox at = tilts_that_show(lamp_of(exponent, 0.02, 0), {0, 0, 1}, {1, 0, 0}, toward);
      EXPECT_NEAR(at.tilts[0] * at.tilts[1], lamp_of(exponent, 0.02, 0).part_that_shows(2 * std::sin(0.5 * between)),
                  1e-9);
      EXPECT_GE(at.tilt[0], 0);
      EXPECT_LE(at.tilt[0] + at.tilts[0], 1 + 1e-12);
    }
}

TEST(Flakes, ShareOutTheLightOfTheLobes) {
  paint::LobeFit fit;
  fit.lobes = {{5, {1, 1, 1}, {}}, {23, {8, 8, 8}, {1, 1, 1}}, {paint::kMirrorExponent, {}, {1, 1, 1}}};
  const std::vector<double> shares = flake_shares(fit);
  ASSERT_EQ(shares.size(), 3U);
  EXPECT_NEAR(shares[0], 1.0 / 3, 1e-12);
  EXPECT_NEAR(shares[1], 2.0 / 3, 1e-12);
  EXPECT_EQ(shares[2], 0);
  EXPECT_EQ(flake_shares(paint::LobeFit{}), std::vector<double>());
  EXPECT_DOUBLE_EQ(shown_radius(0, 0.5), kDegree);
}

}  // namespace
}  // namespace goniochrome::brdf::flakes_test
