#include "quality/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace goniochrome::quality::comparison_test {
namespace {

using Kind = color::DifferenceFormula::Kind;

paint::Paint paint_of(const std::string& name, std::vector<std::pair<double, color::Lab>> rows) {
  paint::Paint paint;
  paint.name = name;
  paint.measurement = paint::Measurement{{}, "meter", {}};
  for (const auto& [angle, lab] : rows) paint.measurement->rows.push_back({{.aspecular_deg = angle}, lab});
  return paint;
}

Comparison compared(const paint::Paint& standard, const paint::Paint& sample, CompareOptions options = {{{}}, {}}) {
  auto result = compare(*subject_of(standard), *subject_of(sample), options);
  EXPECT_TRUE(result.ok()) << result.error().message;
  return *result;
}

double other(const Comparison& comparison, const std::string& quantity) {
  const auto found = std::ranges::find(comparison.others, quantity, &Deviation::quantity);
  return found == comparison.others.end() ? std::nan("") : found->value;
}

const paint::Paint kStandard = paint_of("standard", {{15, {124.3, -1.2, 2.1}}, {45, {60, -1, 1}}, {110, {31, 0, -1}}});

TEST(Comparison, IsSampleMinusStandardAtCommonGeometries) {
  const auto sample = paint_of("sample", {{25, {80, 0, 0}}, {45, {61, -0.5, 1.5}}, {15, {121.9, -0.9, 2.9}}});
  const Comparison c = compared(kStandard, sample, {{{Kind::kDin6175}, {Kind::kCmc}}, {}});
  ASSERT_EQ(c.angles.size(), 2u);
  EXPECT_EQ(c.angles[0].geometry.aspecular_deg, 15);
  EXPECT_NEAR(c.angles[0].lab.dL, -2.4, 1e-12);
  EXPECT_NEAR(c.angles[0].by_formula[0], 1.3771, 5e-5);
  EXPECT_NEAR(c.angles[0].by_formula[1], 1.3369, 5e-5);
  EXPECT_NEAR(c.angles[1].lab.dL, 1, 1e-12);
  EXPECT_NEAR(c.mean.lab.dL, -0.7, 1e-12);
  EXPECT_NEAR(c.largest.lab.dL, -2.4, 1e-12);
  EXPECT_EQ(c.largest.by_formula[0], std::max(c.angles[0].by_formula[0], c.angles[1].by_formula[0]));
  EXPECT_EQ(c.remarks.size(), 1u);  // the standard has 45as110, too
}

TEST(Comparison, TellsIndicesAndGlossOfTheWholePaint) {
  auto standard = kStandard, sample = kStandard;
  standard.gloss = {{60, 80}, {20, 60}}, sample.gloss = {{60, 75}};
  sample.measurement->rows[0].lab.L += 5;
  const Comparison c = compared(standard, sample);
  EXPECT_EQ(other(c, "gloss60"), -5);
  EXPECT_TRUE(std::isnan(other(c, "gloss20")));
  EXPECT_GT(other(c, "flop_index"), 0);
}

TEST(Comparison, OfTexturesNeedsOneInstrumentAndScale) {
  auto standard = kStandard, sample = kStandard;
  standard.measurement->textures = {{"Sparkle Grade", "15d", "1", 4}},
  sample.measurement->textures = {{"Sparkle Grade", "15d", "1", 4.5}};
  EXPECT_EQ(other(compared(standard, sample), "texture:Sparkle Grade"), 0.5);
  sample.measurement->textures.front().version = "2";
  EXPECT_TRUE(std::isnan(other(compared(standard, sample), "texture:Sparkle Grade")));
  EXPECT_EQ(compared(standard, sample).remarks.size(), 1u);
  sample.measurement->textures.front().version = "1", sample.measurement->instrument = "another";
  EXPECT_TRUE(std::isnan(other(compared(standard, sample), "texture:Sparkle Grade")));
  EXPECT_EQ(compared(standard, sample).remarks.size(), 1u);
}

TEST(Comparison, BringsASampleToTheLightOfItsStandardByItsSpectra) {
  auto standard = kStandard, sample = kStandard;
  standard.measurement->condition = {"A", 2};
  const auto none = compare(*subject_of(standard), *subject_of(sample), {{{}}, {}});
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().message.find("A/2"), std::string::npos);
  const std::vector<double> gray(31, 0.25);
  for (const paint::LabReading& row : sample.measurement->rows)
    sample.measurement->spectra.push_back({row.geometry, 400, 10, gray});
  const Comparison c = compared(standard, sample, {{{}}, {"F11"}});
  // A gray of a quarter has L* 57.08 in every light.
  EXPECT_NEAR(c.angles[1].sample.L, 57.075, 0.001);
  EXPECT_NEAR(c.angles[1].sample.a, 0, 1e-9);
  EXPECT_EQ(c.remarks.size(), 2u);  // the light, and metamerism without the spectra of the standard
}

TEST(Comparison, RefusesPaintsWithoutCommonGeometryOrColor) {
  const auto result = compare(*subject_of(kStandard), *subject_of(paint_of("x", {{25, {50, 0, 0}}})), {{{}}, {}});
  ASSERT_FALSE(result.ok());
  EXPECT_NE(result.error().message.find("45as25"), std::string::npos);
  EXPECT_FALSE(subject_of({}).ok());
}

TEST(Comparison, OfAPaintWithItselfIsZeroEverywhere) {
  const CompareOptions options{{{Kind::kCie94}, {Kind::kCiede2000}, {Kind::kDin99o}, {Kind::kDin6175}}, {}};
  for (const Deviation& d : deviations(compared(kStandard, kStandard, options), options))
    EXPECT_EQ(d.value, 0) << d.quantity;
}

// DIN 6175-2 has no value in the mirror direction.
TEST(Comparison, HasNoMeanAndNoLargestOfWhatAGeometryLacks) {
  const auto standard = paint_of("standard", {{-15, {80, 20, 30}}, {0, {120, 20, 30}}, {15, {50, 20, 30}}});
  const auto sample = paint_of("sample", {{-15, {50, 20, 30}}, {0, {120, 20, 30}}, {15, {50, 20, 30}}});
  const Comparison c = compared(standard, sample, {{{Kind::kDin6175}}, {}});
  EXPECT_TRUE(std::isnan(c.mean.by_formula[0]));
  EXPECT_TRUE(std::isnan(c.largest.by_formula[0]));
  EXPECT_EQ(c.largest.lab.dL, -30);
}

TEST(Comparison, OfMetamerismMissesTheGeometriesThatHaveNoSpectra) {
  auto paint = kStandard;
  paint.measurement->spectra = {{{.aspecular_deg = 45}, 400, 10, std::vector<double>(31, 0.25)}};
  const Comparison c = compared(paint, paint, {{{}}, {"A"}});
  EXPECT_EQ(std::ranges::count(c.missing, "metamerism_A", &Deviation::quantity), 2);
  EXPECT_EQ(other(c, "metamerism_A"), 0);
}

TEST(Comparison, OfBlackHasFiniteDifferences) {
  const auto black = paint_of("black", {{15, {0, 0, 0}}, {45, {0, 0, 0}}});
  const auto dark = paint_of("dark", {{15, {1, 0.1, 0}}, {45, {0.5, 0, -0.1}}});
  const CompareOptions options{{{Kind::kCie94}, {Kind::kCmc}, {Kind::kDin99o}, {Kind::kDin6175}}, {}};
  for (const Deviation& d : deviations(compared(black, dark, options), options)) EXPECT_TRUE(std::isfinite(d.value));
}

}  // namespace
}  // namespace goniochrome::quality::comparison_test
