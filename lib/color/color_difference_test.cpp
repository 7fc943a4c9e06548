#include "color/color_difference.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "base/random_for_test.h"

namespace goniochrome::color::color_difference_test {
namespace {

using Kind = DifferenceFormula::Kind;

constexpr std::array kAll = {DifferenceFormula{Kind::kCie76},    DifferenceFormula{Kind::kCie94},
                             DifferenceFormula{Kind::kCmc},      DifferenceFormula{Kind::kCmc, 1, 1},
                             DifferenceFormula{Kind::kDin99o},   DifferenceFormula{Kind::kDin6175},
                             DifferenceFormula{Kind::kCiede2000}};

// A color of 0 < L < 140 and |a|, |b| < 90; one in ten is gray, and one in ten lies on an axis.
Lab random_color(TestNumbers& random) {
  const double kind = random();
  const Lab lab{140 * random(), 180 * random() - 90, 180 * random() - 90};
  if (kind < 0.1) return {lab.L, 0, 0};
  return kind < 0.2 ? Lab{lab.L, lab.a, 0} : lab;
}

// The pairs were computed by separate arithmetic; those of CMC and CIE94 equal colour-science to the last digit.
TEST(ColorDifference, HasTheValuesOfWorkedPairs) {
  struct Pair {
    Lab standard, sample;
    double aspecular_deg, din6175, cmc, cie94, din99o;
  };
  constexpr Pair kPairs[] = {
      {{124.3, -1.2, 2.1}, {121.9, -0.9, 2.9}, 15, 1.3771, 1.3369, 2.5288, 2.2729},
      {{60.1, -0.8, 1.4}, {61.0, -0.7, 1.1}, 45, 0.6606, 0.5704, 0.9473, 0.9581},
      {{31.2, 0.2, -0.9}, {32.4, 0.1, -1.5}, 110, 1.3706, 1.1377, 1.3352, 1.5352},
      {{38.2, 52.1, 28.4}, {37.1, 53.9, 30.2}, 25, 1.0332, 1.1623, 1.3391, 1.4174},
  };
  constexpr double kPrinted = 0.5e-4;
  for (const Pair& p : kPairs) {
    const auto of = [&](Kind kind) { return difference({kind}, p.standard, p.sample, p.aspecular_deg); };
    EXPECT_NEAR(of(Kind::kDin6175), p.din6175, kPrinted);
    EXPECT_NEAR(of(Kind::kCmc), p.cmc, kPrinted);
    EXPECT_NEAR(of(Kind::kCie94), p.cie94, kPrinted);
    EXPECT_NEAR(of(Kind::kDin99o), p.din99o, kPrinted);
    EXPECT_EQ(of(Kind::kCie76), delta_e_76(p.standard, p.sample));
    EXPECT_EQ(of(Kind::kCiede2000), delta_e_2000(p.standard, p.sample));
  }
}

TEST(ColorDifference, OfAColorFromItselfIsZeroAndNeverNegative) {
  TestNumbers random(1);
  for (int i = 0; i < 10000; ++i) {
    const Lab x = random_color(random), y = random_color(random);
    for (const DifferenceFormula& formula : kAll) {
      EXPECT_EQ(difference(formula, x, x, 25), 0) << formula_name(formula);
      EXPECT_GT(difference(formula, x, y, 25), 0) << formula_name(formula);
    }
  }
}

TEST(ColorDifference, OfSymmetricFormulasIsTheSameEitherWayAndOfTheOthersIsNot) {
  TestNumbers random(2);
  for (int i = 0; i < 10000; ++i) {
    const Lab x = random_color(random), y = random_color(random);
    for (const DifferenceFormula& formula : kAll) {
      const double forth = difference(formula, x, y, 25), back = difference(formula, y, x, 25);
      const bool by_standard = formula.kind == Kind::kCmc || formula.kind == Kind::kCie94;
      if (by_standard) continue;
      EXPECT_NEAR(forth, back, 1e-12 * forth) << formula_name(formula);
    }
  }
  const Lab gray{50, 0, 0}, red{50, 60, 0};
  EXPECT_GT(difference({Kind::kCmc}, gray, red, 45), 2 * difference({Kind::kCmc}, red, gray, 45));
  EXPECT_GT(difference({Kind::kCie94}, gray, red, 45), 2 * difference({Kind::kCie94}, red, gray, 45));
}

TEST(ColorDifference, SplitsIntoLightnessChromaAndHue) {
  TestNumbers random(3);
  for (int i = 0; i < 10000; ++i) {
    const Lab x = random_color(random), y = random_color(random);
    const LabDifference d = lab_difference(x, y);
    const double plane = d.da * d.da + d.db * d.db;
    // The squares are below 1e5, and each carries a few roundings of 1e-16.
    EXPECT_NEAR(d.dC * d.dC + d.dH * d.dH, plane, 1e-10);
    EXPECT_EQ(d.dL, y.L - x.L);
  }
  EXPECT_GT(lab_difference({50, 40, 0}, {50, 40, 1}).dH, 0);
  EXPECT_LT(lab_difference({50, 40, 0}, {50, 40, -1}).dH, 0);
  EXPECT_NEAR(std::abs(lab_difference({50, 40, 0}, {50, -40, 0}).dH), 80, 1e-12);
}

TEST(ColorDifference, OfDin6175TakesTheSizeOfTheAngleAndHasNoneAtZero) {
  const Lab x{60, 10, 20}, y{61, 11, 19};
  EXPECT_EQ(difference({Kind::kDin6175}, x, y, -15), difference({Kind::kDin6175}, x, y, 15));
  EXPECT_GT(difference({Kind::kDin6175}, x, y, 75), difference({Kind::kDin6175}, x, y, 15));
  EXPECT_TRUE(std::isnan(difference({Kind::kDin6175}, x, y, 0)));
}

TEST(ColorDifference, IsNotBelowTheFloorOfABox) {
  TestNumbers random(4);
  int close = 0;
  for (int i = 0; i < 20000; ++i) {
    const Lab standard = random_color(random), middle = random() < 0.5 ? standard : random_color(random);
    const Lab half{5 * random(), 10 * random(), 10 * random()};
    const LabBox box{{middle.L - half.L, middle.a - half.a, middle.b - half.b},
                     {middle.L + half.L, middle.a + half.a, middle.b + half.b}};
    const Lab inside{box.lower.L + 2 * half.L * random(), box.lower.a + 2 * half.a * random(),
                     box.lower.b + 2 * half.b * random()};
    for (const DifferenceFormula& formula : kAll) {
      const double aspecular_deg = 15 + 95 * random();
      const double is = difference(formula, standard, inside, aspecular_deg);
      const double floor = difference_floor(formula, standard, box, aspecular_deg);
      EXPECT_LE(floor, is * (1 + 1e-12) + 1e-12) << formula_name(formula);
      const double point = difference_floor(formula, standard, {inside, inside}, aspecular_deg);
      EXPECT_LE(point, is * (1 + 1e-12) + 1e-12) << formula_name(formula);
      EXPECT_LE(floor, point * (1 + 1e-12) + 1e-12) << formula_name(formula);
      close += point > 0.5 * is;
    }
  }
  EXPECT_GT(close, 60000);  // half of the pairs: a floor of 0 would be one too
}

TEST(ColorDifference, FormulasAreReadByTheNamesThatTheyHave) {
  for (const DifferenceFormula& formula : kAll) EXPECT_EQ(*parse_formula(formula_name(formula)), formula);
  EXPECT_EQ(*parse_formula("cmc"), (DifferenceFormula{Kind::kCmc, 2, 1}));
  EXPECT_EQ(*parse_formula(" DE00 "), DifferenceFormula{Kind::kCiede2000});
  for (const char* wrong : {"", "cie", "cmc:", "cmc:2", "cmc:2:0", "cmc:2:1:1", "cmc:-2:1", "cmc:2:x", "ciede2000:1"}) {
    const auto formula = parse_formula(wrong);
    ASSERT_FALSE(formula.ok()) << wrong;
    EXPECT_EQ(formula.error().kind, ErrorKind::kUsage);
  }
}

}  // namespace
}  // namespace goniochrome::color::color_difference_test
