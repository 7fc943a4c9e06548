#include "color/reflection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "base/hard_case_for_test.h"
#include "color/internal/cie_tables.h"

namespace goniochrome::color::reflection_test {
namespace {

double largest_difference(const ReflectionOperator& a, const ReflectionOperator& b) {
  double largest = 0;
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e) largest = std::max(largest, std::abs(a.k[c][d][e] - b.k[c][d][e]));
  return largest;
}

void expect_near(const Rgb& got, const Rgb& want, double tolerance) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], want[c], tolerance);
}

TEST(Reflection, WhiteLightChangesNothing) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(0, 2);
  for (const ReflectionOperator& op :
       {component_wise(), iso_rgb_operator(), working_space_operator(), fitted_operator(), iso_rec709_operator()}) {
    for (int i = 0; i < 1000; ++i) {
      const Rgb color = {uniform(random), uniform(random), uniform(random)};
      const double gray = uniform(random);
      expect_near(reflected(op, {gray, gray, gray}, color), gray * color, 1e-12);
      const Rgb other = {uniform(random), uniform(random), uniform(random)};
      expect_near(reflected(op, color, other), reflected(op, other, color), 1e-14);
    }
  }
}

TEST(Reflection, PublishedTableIsKeptToItsDigits) {
  const ReflectionOperator op = iso_rgb_operator();
  EXPECT_NEAR(op.k[0][0][0], .6533043776, 5e-10);
  EXPECT_NEAR(op.k[0][1][1], -.2135258222, 5e-10);
  EXPECT_NEAR(op.k[1][2][0], -.01811892773, 5e-10);
  EXPECT_NEAR(op.k[2][2][2], .9497684667, 5e-10);
}

TEST(Reflection, ComponentWiseIsThePlainProduct) {
  expect_near(reflected(component_wise(), {0.2, 0.5, 3}, {0.7, 0.1, 2}), {0.14, 0.05, 6}, 1e-15);
}

TEST(Reflection, RedStaysRedInCyanLight) {
  const Rgb red = {0.6, 0.02, 0.02}, cyan = {0, 1, 1};
  const Rgb plain = reflected(component_wise(), red, cyan), ours = reflected(iso_rgb_operator(), red, cyan);
  EXPECT_EQ(plain.x, 0);
  EXPECT_GT(ours.x, 0.15);
  EXPECT_GT(ours.x, 3 * std::max(ours.y, ours.z));
  // The estimate for the working space does the same to the colors of a display.
  const auto of_display = [](const Rgb& a, const Rgb& b) {
    return rec709_from_rec2020(reflected(working_space_operator(), rec2020_from_rec709(a), rec2020_from_rec709(b)));
  };
  EXPECT_GT(of_display(red, cyan).x, 0.1);
}

// The table that was fitted without limits: red paint in cyan light is below 0.
ReflectionOperator unlimited_fit() {
  return nearest_coherent({{{{{{1.033, -0.095, 0.062}, {-0.095, 0.179, -0.084}, {0.062, -0.084, 0.022}}},
                             {{{0.060, -0.032, -0.028}, {-0.032, 1.011, 0.021}, {-0.028, 0.021, 0.007}}},
                             {{{0.005, -0.007, 0.002}, {-0.007, 0.004, 0.003}, {0.002, 0.003, 0.995}}}}}});
}

TEST(Reflection, FittedKeepsAPrimaryInTheLightOfTheOtherTwo) {
  const auto kept = [](const ReflectionOperator& op, int paint, const Rgb& light) {
    Rgb primary;
    primary[paint] = 1;
    return reflected(op, primary, light);
  };
  const ReflectionOperator op = fitted_operator();
  EXPECT_GE(kept(op, 0, {0, 1, 1}).x, 0.05 - 1e-12);
  EXPECT_GE(kept(op, 1, {0, 1, 1}).x, -1e-12);
  EXPECT_GE(kept(op, 1, {1, 0, 1}).y, 0.005 - 1e-12);
  EXPECT_GE(kept(op, 2, {1, 1, 0}).z, 0.005 - 1e-12);
  EXPECT_LT(kept(unlimited_fit(), 0, {0, 1, 1}).x, -0.03);
  EXPECT_LT(kept(unlimited_fit(), 1, {1, 0, 1}).y, -0.01);
}

// Products of primaries are the coefficients. Where none is negative and the rows of k[c] sum to 0 but for row c, all
// rows but row c are 0, and by symmetry row c is 0 but for k[c][c][c].
TEST(Reflection, OnlyThePlainProductIsNeverNegative) {
  const auto least = [](const ReflectionOperator& op) {
    double smallest = 0;
    for (const auto& table : op.k)
      for (const auto& row : table) smallest = std::min(smallest, *std::ranges::min_element(row));
    return smallest;
  };
  EXPECT_EQ(least(component_wise()), 0);
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> uniform(-0.1, 0.1);
  for (int i = 0; i < 1000; ++i) {
    ReflectionOperator op = component_wise();
    for (auto& table : op.k)
      for (auto& row : table)
        for (double& k : row) k += uniform(random);
    op = nearest_coherent(op);
    EXPECT_LT(least(op), -0.1 * largest_difference(op, component_wise()));
  }
}

// Color-matching functions of Rec.709, which the sensors of ISO 17321 are close to, give nearly the published table.
TEST(Reflection, EstimateForRec709IsCloseToThePublishedTable) {
  std::vector<Rgb> matching;
  for (const CieRow& row : kCieTable)
    matching.push_back(
        rec709_from_rec2020(rgb_from_xyz_d65({row.observer_2[0], row.observer_2[1], row.observer_2[2]})));
  const auto op = estimated_operator(matching);
  ASSERT_TRUE(op.ok());
  EXPECT_LE(largest_difference(*op, iso_rgb_operator()), 0.1);
  EXPECT_GT(largest_difference(*op, component_wise()), 0.2);
}

// The product of two colors of Rec.709 is taken there: the published table's own figures come out, in the coordinates
// in which they were published. The control applies the table to Rec.2020 coordinates.
TEST(Reflection, TableOfOtherPrimariesIsAppliedInThem) {
  const Rgb a = {0.7, 0.2, 0.1}, b = {0.1, 0.6, 0.9};
  const auto in_2020 = [&](const ReflectionOperator& op) {
    return rec709_from_rec2020(reflected(op, rec2020_from_rec709(a), rec2020_from_rec709(b)));
  };
  const Rgb wanted = reflected(iso_rgb_operator(), a, b);
  expect_near(in_2020(iso_rec709_operator()), wanted, 1e-14);
  EXPECT_GT(length(in_2020(iso_rgb_operator()) - wanted), 0.02);
  // In the primaries of the working space nothing changes.
  const auto same = in_working_space(iso_rgb_operator(), kRec2020);
  ASSERT_TRUE(same.ok());
  EXPECT_LE(largest_difference(*same, iso_rgb_operator()), 1e-14);
  // Two spaces of one white whose axes are the same, red and blue exchanged: k is permuted.
  Primaries swapped = kRec2020;
  std::swap(swapped.rgb[0], swapped.rgb[2]);
  const auto exchanged = in_working_space(iso_rgb_operator(), swapped);
  ASSERT_TRUE(exchanged.ok());
  EXPECT_NEAR(exchanged->k[2][2][1], iso_rgb_operator().k[0][0][1], 1e-14);
  // A space whose white is D50 keeps white light neutral.
  const auto d50 = in_working_space(iso_rgb_operator(), {kRec709.rgb, {0.3457, 0.3585}});
  ASSERT_TRUE(d50.ok());
  expect_near(reflected(*d50, {1, 1, 1}, b), b, 1e-14);
  EXPECT_FALSE(in_working_space(iso_rgb_operator(), {{{{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}}}, {0.3, 0.3}}).ok());
  EXPECT_FALSE(in_working_space(iso_rgb_operator(), {{{{0.6, 0}, {0.2, 0.7}, {0.1, 0.1}}}, {0.3, 0.3}}).ok());
}

TEST(Reflection, DivisionUndoesMultiplication) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const ReflectionOperator& op : {component_wise(), iso_rgb_operator(), working_space_operator()}) {
    int divisions = 0;
    for (int i = 0; i < 2000; ++i) {
      const Rgb a = {uniform(random), uniform(random), uniform(random)}, b = {uniform(random), 1, uniform(random)};
      const auto back = divided(op, reflected(op, a, b), a);
      if (!back.ok()) continue;
      ++divisions;
      // Rounding times the worst condition number that is let pass.
      expect_near(*back, b, 1e-15 * kWorstCondition);
    }
    EXPECT_GT(divisions, 1900);
  }
}

TEST(Reflection, RelightingThereAndBack) {
  const ReflectionOperator op = iso_rgb_operator();
  const Rgb blue_sky = {0.4, 0.9, 1.0}, yellow = {1.0, 0.9, 0.1}, color = {0.3, 0.5, 0.2};
  const auto there = relighting(op, blue_sky, yellow), back = relighting(op, yellow, blue_sky);
  ASSERT_TRUE(there.ok() && back.ok());
  expect_near(product(back->matrix, product(there->matrix, color)), color, 1e-12);
  expect_near(product(there->matrix, reflected(op, blue_sky, color)), reflected(op, yellow, color), 1e-14);
  EXPECT_FALSE(relighting(op, {0, 0, 0}, yellow).ok());
  // Light that does not change leaves the color.
  expect_near(product(relighting(op, yellow, yellow)->matrix, color), color, 1e-13);
}

TEST(HardCase, ColourDivideRefusesWithTheConditionNumber) {
  const ReflectionOperator iso = iso_rgb_operator();
  const auto by_black = divided(iso, {1, 1, 1}, {0, 0, 0});
  ASSERT_FALSE(by_black.ok());
  EXPECT_NE(by_black.error().message.find("condition number is inf"), std::string::npos) << by_black.error().message;

  // Component by component, one dark channel is enough; the control divides 0 by 0.
  EXPECT_FALSE(divided(component_wise(), {1, 0, 1}, {1, 0, 1}).ok());
  EXPECT_TRUE(std::isnan(0.0 / 0.0));
  // Pure red can be divided by here.
  EXPECT_TRUE(divided(iso, {0.3, 0.1, 0.1}, {1, 0, 0}).ok());

  // Along a line from where the determinant is positive to where it is negative there is a color that cannot be divided
  // by: found by bisection, it and all that is near is refused, and never Inf or NaN returned.
  const Rgb from = {1, 0, 0}, to = {0, 1, 0};
  const auto at = [&](double t) { return (1 - t) * from + t * to; };
  const auto determinant = [&](const Rgb& a) {
    const Matrix3 m = reflection_matrix(iso, a);
    return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
           m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
  };
  double low = 0, high = 1;
  ASSERT_LT(determinant(at(low)) * determinant(at(high)), 0);
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (determinant(at(middle)) * determinant(at(low)) > 0 ? low : high) = middle;
  }
  int refused = 0, done = 0;
  double ours = 0, cramer = 0;
  for (const double off : {0.0, 1e-15, 1e-12, 1e-9, 1e-6, 1e-2}) {
    const auto quotient = divided(iso, {0.2, 0.2, 0.2}, at(low + off));
    if (quotient.ok()) ours = worst_of(ours, length(*quotient));
    cramer = worst_of(cramer, 0.2 / std::abs(determinant(at(low + off))));
    quotient.ok() ? ++done : ++refused;
  }
  EXPECT_GE(refused, 4);
  EXPECT_GE(done, 1);
  // The control is Cramer's rule. Ours divides where the condition number is up to 1e4.
  hard_case("colour-divide", {.what = "size of a quotient near the colors that cannot be divided by",
                              .textbook = cramer,
                              .ours = ours,
                              .bound = 1e4,
                              .unit = "radiance"});
}

TEST(HardCase, ColourDivideTransferOfAChannelThatHasNone) {
  ASSERT_TRUE(with_transfer(component_wise(), {0, 0, 0}).ok());
  const auto refused = with_transfer(component_wise(), {0, 0.5, 0});
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("channel 1"), std::string::npos);
  EXPECT_TRUE(std::isinf(0.5 / (1 - component_wise().k[1][1][1]))) << "the control divides by 0";
}

TEST(Reflection, TransferRunsFromThePlainProductToTheTable) {
  const ReflectionOperator iso = iso_rgb_operator();
  const auto none = with_transfer(iso, {0, 0, 0});
  ASSERT_TRUE(none.ok());
  EXPECT_EQ(largest_difference(*none, component_wise()), 0);
  const auto same = with_transfer(iso, {1 - iso.k[0][0][0], 1 - iso.k[1][1][1], 1 - iso.k[2][2][2]});
  ASSERT_TRUE(same.ok());
  EXPECT_LE(largest_difference(*same, iso), 1e-14);
  // Any transfer stays coherent and symmetric: projecting it again moves nothing.
  const auto blue = with_transfer(iso, {0, 0, 1});
  ASSERT_TRUE(blue.ok());
  EXPECT_LE(largest_difference(nearest_coherent(*blue), *blue), 1e-14);
  EXPECT_EQ(blue->k[2][2][2], 0);
  EXPECT_FALSE(with_transfer(iso, {NAN, 0, 0}).ok());
}

TEST(Reflection, NearestCoherentIsNearest) {
  ReflectionOperator op = iso_rgb_operator();
  op.k[0][0][1] += 0.3, op.k[2][1][1] -= 0.2;
  const ReflectionOperator near = nearest_coherent(op);
  expect_near(reflected(near, {1, 1, 1}, {0.3, 0.6, 0.2}), {0.3, 0.6, 0.2}, 1e-15);
  // The residual is orthogonal to every coherent direction: here k[c] of the form v v' with v = (1,-1,0).
  for (int c = 0; c < 3; ++c) {
    double along = 0;
    const double v[3] = {1, -1, 0};
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e) along += v[d] * v[e] * (op.k[c][d][e] - near.k[c][d][e]);
    EXPECT_NEAR(along, 0, 1e-15);
  }
}

TEST(Reflection, EstimationIsExactForSensorsThatDoNotOverlap) {
  // Three boxes: each channel is its own spectrum, and the product is the plain one.
  std::vector<Rgb> boxes(90);
  for (int i = 0; i < 90; ++i) boxes[i][i / 30] = 1;
  const auto op = estimated_operator(boxes);
  ASSERT_TRUE(op.ok());
  EXPECT_LE(largest_difference(*op, component_wise()), 1e-14);
  EXPECT_FALSE(estimated_operator(std::vector<Rgb>(90, Rgb{1, 1, 1})).ok());
  EXPECT_FALSE(estimated_operator(std::vector<Rgb>{}).ok());
}

}  // namespace
}  // namespace goniochrome::color::reflection_test
