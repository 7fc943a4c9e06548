#include "fit/basis_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/gloss.h"
#include "brdf/lobe_model.h"
#include "math/cosine_power.h"

namespace goniochrome::fit::basis_search_test {
namespace {

// Paints that are sums of lobes with random weights, at 40 angles from 15 to 90 deg.
std::vector<BasisTarget> planted(const std::vector<double>& exponents, int paints, double noise = 0) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<BasisTarget> targets;
  for (int p = 0; p < paints; ++p) {
    BasisTarget target;
    target.name = "paint" + std::to_string(p);
    for (int i = 0; i < 40; ++i) target.rows.push_back({15 + 75.0 * i / 39, {}, 1});
    for (int c = 0; c < 3; ++c) {
      std::vector<double> weights;
      for (std::size_t j = 0; j <= exponents.size(); ++j) weights.push_back(unit(random));
      for (BasisRow& row : target.rows) {
        double value = 0.1 * weights[0];
        for (std::size_t j = 0; j < exponents.size(); ++j)
          value += weights[j + 1] * math::cos_power(row.angle_deg * kDegree, exponents[j]);
        row.value[c] = value + noise * unit(random);
      }
    }
    targets.push_back(target);
  }
  return targets;
}

TEST(BasisSearch, FindsPlantedExponents) {
  const auto targets = planted({3, 40}, 12);
  BasisSearchOptions options;
  options.last = 3;
  const BasisSearch search = search_basis(targets, options);
  ASSERT_EQ(search.sets.size(), 3u);
  ASSERT_EQ(search.sets[1].exponents.size(), 2u);
  EXPECT_NEAR(search.sets[1].exponents[0], 3, 0.1);
  EXPECT_NEAR(search.sets[1].exponents[1], 40, 1);
  EXPECT_GT(search.sets[0].error.objective(), 10 * search.sets[1].error.objective());
}

// The control: every pair (triple) of a grid in log E. The search must be at least as good as the best of them.
TEST(BasisSearch, IsNotWorseThanAnExhaustiveGrid) {
  const auto targets = planted({1.5, 9, 70}, 10, 0.02);
  BasisSearchOptions options;
  options.low = 0.5, options.high = 500, options.last = 3;
  for (const BasisMethod method : {BasisMethod::kPowerMean, BasisMethod::kLevenbergMarquardt}) {
    options.method = method;
    const BasisSearch search = search_basis(targets, options);
    std::vector<double> grid;
    for (double x = std::log(0.5); x < std::log(500); x += 0.35) grid.push_back(std::exp(x));
    double best[4] = {0, 1e9, 1e9, 1e9};
    for (std::size_t i = 0; i < grid.size(); ++i) {
      best[1] = std::min(best[1], basis_error({grid[i]}, targets).objective());
      for (std::size_t j = i + 1; j < grid.size(); ++j) {
        best[2] = std::min(best[2], basis_error({grid[i], grid[j]}, targets).objective());
        for (std::size_t k = j + 1; k < grid.size(); k += 2)
          best[3] = std::min(best[3], basis_error({grid[i], grid[j], grid[k]}, targets).objective());
      }
    }
    for (std::size_t m = 1; m <= 3; ++m) EXPECT_LE(search.sets[m - 1].error.objective(), best[m] * (1 + 1e-9)) << m;
  }
}

TEST(BasisSearch, ErrorNeverRisesWithALobeAndDoesNotDependOnThreads) {
  const auto targets = planted({1.2, 5, 25, 140}, 8, 0.05);
  BasisSearchOptions options;
  options.last = 6, options.starts = 3;
  set_threads(1);
  const BasisSearch one = search_basis(targets, options);
  set_threads(7);
  const BasisSearch seven = search_basis(targets, options);
  set_threads(0);
  for (std::size_t i = 0; i < one.sets.size(); ++i) {
    EXPECT_EQ(one.sets[i].exponents, seven.sets[i].exponents);
    if (i) {
      EXPECT_LE(one.sets[i].error.objective(), one.sets[i - 1].error.objective());
    }
    EXPECT_TRUE(std::ranges::is_sorted(one.sets[i].exponents));
  }
}

// The search on some of the targets against the search on all. The control: what a search on as few targets of the same
// list, without those that join, misses of the largest error.
TEST(BasisSearch, RepresentativesStandForALargeLibrary) {
  auto targets = planted({1.2, 5, 25, 140}, 400, 0.05);
  for (std::size_t i = 0; i < targets.size(); i += 97)  // a few unlike the others
    for (BasisRow& row : targets[i].rows) row.value.x += 0.3 * math::cos_power(row.angle_deg * kDegree, 55);
  BasisSearchOptions options;
  options.first = options.last = 3, options.starts = 3, options.representatives = 0;
  const FoundBasis all = search_basis(targets, options).sets.front();
  EXPECT_EQ(all.looked_at, 400);
  options.representatives = 40;
  const FoundBasis some = search_basis(targets, options).sets.front();
  EXPECT_GE(some.looked_at, 40);
  EXPECT_LE(some.looked_at, 140);
  EXPECT_LE(some.error.objective(), 1.005 * all.error.objective());
  EXPECT_EQ(some.error.each.size(), targets.size()) << "the errors are those of the whole library";
  EXPECT_EQ(some.error.max, basis_error(some.exponents, targets).max);

  options.representatives = 0;
  std::vector<BasisTarget> few;
  for (std::size_t i = 5; i < targets.size(); i += 10) few.push_back(targets[i]);
  const FoundBasis blind = search_basis(few, options).sets.front();
  EXPECT_GT(basis_error(blind.exponents, targets).objective(), some.error.objective());
}

// A lobe that is nothing from the second angle on meets the first one exactly, with a weight beyond all measure.
TEST(BasisSearch, NoLobeIsSharperThanTheTargetsSee) {
  const auto targets = planted({1.2, 5, 25}, 8, 0.05);
  BasisSearchOptions options;
  options.first = 4, options.last = 4, options.starts = 2;
  const double first_rad = targets.front().rows.front().angle_deg * kDegree;
  for (const FoundBasis& set : search_basis(targets, options).sets)
    EXPECT_GE(math::cos_power(first_rad, set.exponents.back()), 0.999e-3) << set.exponents.size();
  // The control: such a lobe lowers the error.
  const std::vector<double> three = {1.2, 5, 25};
  EXPECT_LT(basis_error({1.2, 5, 25, 6000}, targets).mean, basis_error(three, targets).mean);
}

// The gradient leaves the inner optimum out (envelope theorem); central differences take it along.
TEST(BasisSearch, GradientMatchesDifferences) {
  const auto targets = planted({2, 30}, 4, 0.1);
  const std::vector<double> exponents = {1.1, 6, 55};
  const auto errors = squared_basis_errors(exponents, targets, true);
  constexpr double kStep = 1e-5;
  for (std::size_t j = 0; j < exponents.size(); ++j) {
    auto up = exponents, down = exponents;
    up[j] *= std::exp(kStep), down[j] *= std::exp(-kStep);
    const auto above = squared_basis_errors(up, targets, false), below = squared_basis_errors(down, targets, false);
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const double difference = (above[i].value - below[i].value) / (2 * kStep);
      EXPECT_NEAR(errors[i].gradient[j], difference, 1e-6 * (std::abs(difference) + errors[i].value));
    }
  }
}

TEST(BasisSearch, KeepsTheBestSoFarAtItsTimeLimit) {
  const auto targets = planted({2, 30}, 40, 0.1);
  BasisSearchOptions options;
  options.time_limit_s = 0.02;
  const BasisSearch search = search_basis(targets, options);
  EXPECT_TRUE(search.stopped);
  ASSERT_GE(search.sets.size(), 1u);
  EXPECT_LT(search.sets.size(), 11u);
}

TEST(BasisTarget, OfAMeasuredBrdfIsItsMeanByAspecularAngle) {
  BrdfTarget brdf;
  brdf.paint.name = "one lobe";
  for (int i = 0; i < 2000; ++i) {
    const double angle = 5 + 0.055 * i;
    const double value = 0.1 + math::cos_power(angle * kDegree, 12);
    brdf.samples.push_back({angle * kDegree, 30, 30, {value, value / 2, value / 4}});
    brdf.samples.push_back({angle * kDegree, 30, 80, {9, 9, 9}});  // too steep to count
  }
  const auto target = basis_target(brdf, {});
  ASSERT_TRUE(target.ok());
  EXPECT_EQ(target->rows.size(), 40u);
  EXPECT_LT(basis_error({12}, *target), 0.2) << "means over 2.5 deg of a lobe that bends";
  EXPECT_GT(basis_error({3}, *target), 1);
  brdf.samples.resize(2);
  EXPECT_FALSE(basis_target(brdf, {}).ok());
}

TEST(BasisTarget, OfASolidPaintNeedsNoLobe) {
  paint::Paint paint;
  paint.name = "gray";
  paint.appearance = paint::Appearance{{50, 0, 0}, {50, 0, 0}, 60, {}};
  const auto target = basis_target(paint, {.target = paint::TargetCurve::Kind::kCurve});
  ASSERT_TRUE(target.ok());
  EXPECT_LT(basis_error({10}, *target), 1e-9);
  EXPECT_LT(basis_de00({10}, *target), 1e-6);
}

paint::Paint painted(const std::string& name, double lightness, std::vector<paint::GlossReading> gloss) {
  paint::Paint paint;
  paint.name = name, paint.gloss = std::move(gloss);
  paint.appearance = paint::Appearance{{1.5 * lightness, 5, 5}, {lightness / 2, 2, 2}, 60, {}};
  return paint;
}

std::vector<BasisTarget> library(const std::vector<paint::GlossReading>& gloss) {
  std::vector<BasisTarget> targets;
  for (const double lightness : {20.0, 40.0, 60.0}) {
    targets.push_back(*basis_target(painted("p", lightness, gloss), {}));
    targets.back().mirror = true;
  }
  return targets;
}

// A library of satin coats gets sharper lobes than one of the same colors with smooth coats, and libraries of 40 and of
// 90 GU get different ones. The control is the basis that was chosen for smooth coats: satin ones err more with it.
TEST(BasisSearch, SatinCoatsGetLobes) {
  BasisSearchOptions options;
  options.first = options.last = 4, options.starts = 2;
  const auto satin = library({{20, 18}, {60, 60}, {85, 88}}), medium = library({{60, 40}}),
             smooth = library({{60, 90}});
  EXPECT_TRUE(satin[0].coat && medium[0].coat);
  EXPECT_FALSE(smooth[0].coat) << "its mirror is enough";
  const auto best = [&](const std::vector<BasisTarget>& targets) {
    return search_basis(targets, options).sets.back().exponents;
  };
  const std::vector<double> for_satin = best(satin), for_medium = best(medium), for_smooth = best(smooth);
  EXPECT_GT(for_satin.back(), 1000);
  EXPECT_LT(for_smooth.back(), 1000);
  EXPECT_NE(for_medium, for_smooth);
  EXPECT_LT(2 * basis_error(for_satin, satin).objective(), basis_error(for_smooth, satin).objective());
}

TEST(BasisSearch, GradientHoldsWithACoat) {
  const std::vector<BasisTarget> targets = library({{20, 18}, {60, 60}, {85, 88}});
  const std::vector<double> exponents = {2, 20, 300, 4000};
  const auto at = squared_basis_errors(exponents, targets, true);
  for (std::size_t j = 0; j < exponents.size(); ++j) {
    std::vector<double> low = exponents, high = exponents;
    low[j] *= std::exp(-1e-4), high[j] *= std::exp(1e-4);
    const double slope =
        (squared_basis_errors(high, targets, false)[0].value - squared_basis_errors(low, targets, false)[0].value) /
        2e-4;
    EXPECT_NEAR(at[0].gradient[j], slope, 1e-4 * std::abs(slope) + 1e-9) << j;
  }
}

// A paint whose base is two lobes under a coat has no error with these. The control: read as a paint without a coat, as
// the search once took it, the same readings have one.
TEST(BasisTarget, IsTheBaseUnderTheCoat) {
  paint::Paint paint;
  paint.name = "coated", paint.gloss = {{60, 92}};
  const double index = *brdf::coat_index_of(paint.gloss);
  const color::Xyz white = *color::white_point({"D65", 10});
  paint.measurement = paint::Measurement{};
  for (const double angle : {15.0, 25.0, 45.0, 75.0, 110.0}) {
    const double base = 0.05 + 0.2 * math::cos_power(angle * kDegree, 2) + math::cos_power(angle * kDegree, 12);
    const double seen = base * brdf::coat_passages(index, std::cos(45 * kDegree), std::cos((angle - 45) * kDegree));
    paint.measurement->rows.push_back({{.aspecular_deg = angle}, color::lab_from_rgb({seen, seen, seen}, white)});
  }
  const auto at_readings = [](BasisTarget target) {
    std::erase_if(target.rows, [](const BasisRow& row) {
      return std::ranges::none_of(std::array{15, 25, 45, 75, 110},
                                  [&](int a) { return std::abs(a - row.angle_deg) < 1e-9; });
    });
    target.coat.reset();
    return target;
  };
  const BasisTarget coated = at_readings(*basis_target(paint, {}));
  EXPECT_EQ(coated.rows.size(), 5u);
  EXPECT_LT(basis_error({2, 12}, coated), 1e-9);
  paint.coat_index = paint::kNoCoat;
  EXPECT_GT(basis_error({2, 12}, at_readings(*basis_target(paint, {}))), 0.1);
}

// A paint that grows away from specular is met by no lobes. With its floor it no longer is the worst of a basis that
// meets all the others badly. The control is the error without floors.
TEST(BasisSearch, LeavesOutWhatNoLobesMend) {
  auto targets = planted({3, 40}, 6);
  for (BasisTarget& target : targets)
    for (BasisRow& row : target.rows) row.weight = 0.1;
  targets.push_back(targets.front());
  for (BasisRow& row : targets.back().rows) row.value = 0.01 * row.angle_deg * color::Rgb{1, 1, 1}, row.weight = 1;
  const std::vector<double> poor = {9};
  BasisError error = basis_error(poor, targets);
  EXPECT_EQ(error.max, error.each.back());
  set_floors(targets);
  error = basis_error(poor, targets);
  EXPECT_LT(error.each.back(), 0.1 * error.max);
  EXPECT_GT(targets.back().floor, 10 * targets.front().floor);
}

TEST(BasisSearch, GradientHoldsWithAFloor) {
  auto targets = planted({2, 30}, 3, 0.2);
  set_floors(targets);
  const std::vector<double> exponents = {5, 90};
  const auto at = squared_basis_errors(exponents, targets, true);
  for (std::size_t j = 0; j < exponents.size(); ++j) {
    std::vector<double> low = exponents, high = exponents;
    low[j] *= std::exp(-1e-5), high[j] *= std::exp(1e-5);
    const double slope =
        (squared_basis_errors(high, targets, false)[0].value - squared_basis_errors(low, targets, false)[0].value) /
        2e-5;
    EXPECT_NEAR(at[0].gradient[j], slope, 1e-5 * std::abs(slope) + 1e-9) << j;
  }
}

TEST(BasisSearch, TellsWhichExponentsAreAtTheirBound) {
  const auto targets = planted({3, 40}, 6);
  BasisSearchOptions options;
  options.first = options.last = 2, options.starts = 2;
  const FoundBasis free = search_basis(targets, options).sets.front();
  EXPECT_FALSE(free.at_low || free.at_high);
  options.high = 25;
  EXPECT_TRUE(search_basis(targets, options).sets.front().at_high);
  options.high = 2e4, options.low = 5;
  EXPECT_TRUE(search_basis(targets, options).sets.front().at_low);
}

}  // namespace
}  // namespace goniochrome::fit::basis_search_test
