// The chi-square test of a sampler of directions.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "base/angles.h"
#include "base/random_for_test.h"
#include "rays/float3.h"
#include "render/path/traced_paint.h"

namespace goniochrome::render {

// Bins of equal solid angle, even in azimuth and in the cosine from an axis.
class SphereBins {
 public:
  SphereBins(const Vec3& axis, int rows, int columns) : z_(axis), rows_(rows), columns_(columns) {
    const rays::Frame frame = rays::frame_about(rays::float3(axis));
    x_ = rays::vec3(frame.x), y_ = rays::vec3(frame.y);
  }
  std::size_t count() const { return static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_); }
  std::size_t bin(const Vec3& d) const {
    const int row = std::clamp(static_cast<int>((1 - dot(d, z_)) / 2 * rows_), 0, rows_ - 1);
    const double azimuth = std::atan2(dot(d, y_), dot(d, x_)) / (2 * kPi) + 0.5;
    return static_cast<std::size_t>(row * columns_ + std::clamp(static_cast<int>(azimuth * columns_), 0, columns_ - 1));
  }
  // The direction at a part (a, b) of a bin.
  Vec3 direction(std::size_t bin, double a, double b) const {
    const double c = 1 - 2 * (static_cast<double>(bin / static_cast<std::size_t>(columns_)) + a) / rows_;
    const double p = 2 * kPi * ((static_cast<double>(bin % static_cast<std::size_t>(columns_)) + b) / columns_ - 0.5);
    const double s = std::sqrt(1 - c * c);
    return s * std::cos(p) * x_ + s * std::sin(p) * y_ + c * z_;
  }
  double solid_angle() const { return 4 * kPi / static_cast<double>(count()); }

 private:
  Vec3 x_, y_, z_;
  int rows_, columns_;
};

// Standard deviations by which the bins' chi-square exceeds its mean: below 5 in all but one of a million cases. A draw
// may come to nothing; so may the density be less than 1 in sum. `points` are those by which the density is summed over
// a bin: many where it jumps inside.
inline double excess(const SphereBins& bins, int draws,
                     const std::function<std::optional<Vec3>(double, double, double)>& draw,
                     const std::function<double(const Vec3&)>& density, int points = 576) {
  TestNumbers next(5);
  std::vector<double> seen(bins.count() + 1), expected(bins.count() + 1);
  for (int i = 0; i < draws; ++i) {
    const double a = next(), b = next(), c = next();
    const auto direction = draw(a, b, c);
    seen[direction ? bins.bin(*direction) : bins.count()] += 1;
  }
  expected.back() = draws;
  constexpr double kGolden = 1.32471795724474602596;  // evenly spread pairs [Roberts]
  std::vector<std::array<double, 2>> places;
  for (int i = 0; i < points; ++i)
    places.push_back({std::fmod(0.5 + i / kGolden, 1), std::fmod(0.5 + i / (kGolden * kGolden), 1)});
  for (std::size_t bin = 0; bin < bins.count(); ++bin) {
    double sum = 0;
    for (const auto& [a, b] : places) sum += density(bins.direction(bin, a, b));
    expected[bin] = draws * sum / points * bins.solid_angle();
    expected.back() -= expected[bin];
  }
  expected.back() = std::max(expected.back(), 0.0);
  // Bins that expect fewer than ten are put together.
  double chi2 = 0, few_seen = 0, few_expected = 0;
  int freedom = -1;
  for (std::size_t bin = 0; bin < seen.size(); ++bin) {
    if (expected[bin] < 10) {
      few_seen += seen[bin], few_expected += expected[bin];
      continue;
    }
    chi2 += (seen[bin] - expected[bin]) * (seen[bin] - expected[bin]) / expected[bin];
    ++freedom;
  }
  if (few_expected > 10) chi2 += (few_seen - few_expected) * (few_seen - few_expected) / few_expected, ++freedom;
  EXPECT_GT(freedom, 3);
  EXPECT_LT(few_seen, few_expected + 10 + 6 * std::sqrt(few_expected + 10));
  return (chi2 - freedom) / std::sqrt(2.0 * freedom);
}

// The excess of the directions that a point draws, about its mirror direction.
inline double excess_of_draws(const PaintedPoint& point, int rows, int columns,
                              const std::function<double(const Vec3&)>& density) {
  const SphereBins bins(rays::vec3(point.mirrored()), rows, columns);
  return excess(
      bins, 400000,
      [&](double choice, double u, double v) -> std::optional<Vec3> {
        const Reflection drawn = point.drawn(choice, u, v);
        if (!(drawn.pdf > 0)) return std::nullopt;
        return rays::vec3(drawn.direction);
      },
      density);
}

}  // namespace goniochrome::render
