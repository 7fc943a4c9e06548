#include "fit/internal/basis_errors.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "math/cosine_power.h"
#include "math/least_squares.h"

namespace goniochrome::fit::basis_errors_test {
namespace {

// Targets with noise, weights of their own, and either of two lists of angles; every third one has a coat.
std::vector<BasisTarget> targets(int count) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<BasisTarget> all;
  for (int i = 0; i < count; ++i) {
    BasisTarget target{.name = "t" + std::to_string(i), .rows = {}};
    for (int r = 0; r < 20; ++r) {
      const double angle = (i % 2 ? 15 : 20) + 4.5 * r, exponent = 1 + 60 * unit(random) * unit(random);
      const double value = 0.05 + math::cos_power(angle * kDegree, exponent);
      target.rows.push_back({angle, {value, value * unit(random), 0.1 * unit(random)}, 0.2 + unit(random)});
    }
    if (i % 3 == 0) target.coat = *brdf::rough_coat_of({{60, 30 + 10.0 * (i % 5)}}, brdf::kCoatIndex);
    target.coat_weights = {.1, .2, .2, .3, .2}, target.mirror = i % 2 == 0;
    all.push_back(target);
  }
  return all;
}

// The flake part of the squared error by its definition: one fit of all rows for each channel.
double flake_by_definition(const std::vector<double>& exponents, const BasisTarget& target) {
  const int rows = static_cast<int>(target.rows.size()), lobes = static_cast<int>(exponents.size());
  math::Matrix m(rows, lobes + 1);
  std::vector<double> b(target.rows.size());
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < rows; ++r) {
      const BasisRow& row = target.rows[r];
      m(r, 0) = row.weight, b[r] = row.weight * row.value[c];
      for (int j = 0; j < lobes; ++j) m(r, j + 1) = row.weight * math::cos_power(row.angle_deg * kDegree, exponents[j]);
    }
    const double objective = math::nnls(m, b).objective;
    sum += objective * objective;
  }
  return sum / (3 * rows);
}

// Both forms solve the same problems by orthogonal transformations, so they differ by the rounding of the residual:
// some ten ulp of |b|, of which |residual| is at least a thousandth here.
TEST(BasisErrors, AreThoseOfTheDefinition) {
  std::vector<BasisTarget> all = targets(30);
  for (BasisTarget& target : all) target.coat.reset();
  for (const std::vector<double>& exponents :
       {std::vector<double>{12}, {2, 30}, {1, 4, 9, 40, 200}, {1, 4, 4, 9, 9.0001, 500, 3000}, {3, 20000}}) {
    const auto errors = BasisErrors(all).at(exponents, false);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double wanted = flake_by_definition(exponents, all[i]);
      EXPECT_NEAR(errors[i].value, wanted, 1e-9 * wanted) << i;
    }
  }
}

// With fewer rows than lobes there is no full triangle.
TEST(BasisErrors, HoldForFewerAnglesThanLobes) {
  std::vector<BasisTarget> all = targets(6);
  for (BasisTarget& target : all) target.coat.reset(), target.rows.resize(3);
  const std::vector<double> exponents = {1, 4, 9, 40, 200};
  const auto errors = BasisErrors(all).at(exponents, false);
  for (std::size_t i = 0; i < all.size(); ++i)
    EXPECT_NEAR(errors[i].value, flake_by_definition(exponents, all[i]), 1e-12) << i;
}

TEST(BasisErrors, DoNotDependOnThreadsNorOnTheOtherTargets) {
  const std::vector<BasisTarget> all = targets(40);
  const std::vector<double> exponents = {2, 11, 90, 2000};
  set_threads(1);
  const auto one = BasisErrors(all).at(exponents, true);
  set_threads(7);
  const auto seven = BasisErrors(all).at(exponents, true);
  set_threads(0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<BasisTarget> alone = {all[i]};
    const SquaredError own = BasisErrors(alone).at(exponents, true).front();
    EXPECT_EQ(one[i].value, seven[i].value);
    EXPECT_EQ(one[i].gradient, seven[i].gradient);
    EXPECT_EQ(one[i].value, own.value);
    EXPECT_EQ(one[i].gradient, own.gradient);
  }
}

}  // namespace
}  // namespace goniochrome::fit::basis_errors_test
