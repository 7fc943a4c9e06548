#include "formats/cgats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "formats/internal/import_for_test.h"

namespace goniochrome::formats::cgats_test {
namespace {

using Cgats = ImportTest<read_cgats>;

constexpr const char* kHead =
    "CGATS.17\nWEIGHTING_FUNCTION \"ILLUMINANT, D65\"\nWEIGHTING_FUNCTION \"OBSERVER, 10 degree\"\n";

std::string table(const std::string& fields, const std::string& rows) {
  return "BEGIN_DATA_FORMAT\n" + fields + "\nEND_DATA_FORMAT\nBEGIN_DATA\n" + rows + "\nEND_DATA\n";
}

TEST_F(Cgats, RoundTripKeepsEveryBit) {
  const std::vector<paint::Paint> paints = two_paints("A");
  auto file = OutputFile::create(path());
  ASSERT_TRUE(file.ok());
  auto writer = CgatsWriter::begin(std::move(file).value(), "test 1.0", "2026-01-02");
  ASSERT_TRUE(writer.ok());
  for (const paint::Paint& paint : paints) ASSERT_TRUE(writer->write(paint).ok());
  ASSERT_TRUE(writer->finish().ok());

  const auto read = read_file(path());
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_THAT(read->warnings, IsEmpty());
  expect_same(paints, read->paints);
}

TEST_F(Cgats, WriterRefusesAPaintWithoutReadings) {
  auto writer = CgatsWriter::begin(OutputFile::create(path()).value(), "test", "");
  paint::Paint paint;
  paint.name = "empty";
  EXPECT_THAT(writer->write(paint).error().message, HasSubstr("\"empty\" has no readings"));
}

// A file of a densitometer program: tabs, bare spaces in names, a degree sign in Latin-1, doubled quotation marks,
// CRLF, a comment, a wrong count.
TEST_F(Cgats, ReadsTheTableOfAnotherProgram) {
  const auto paints = good(
      "ECI2002\r\nORIGINATOR\t\"\"\r\nCREATED\t\"10/17/2005\"  # Time: 15:24\r\n"
      "MEASUREMENT_SOURCE\t\"\"Illumination=D50\tObserverAngle=2\xB0\tWhiteBase=Abs\"\"\r\n"
      "KEYWORD\t\"SAMPLE_NAME\"\r\nMEASUREMENT_GEOMETRY \"45/0\"\r\nNUMBER_OF_FIELDS\t5\r\nBEGIN_DATA_FORMAT\r\n"
      "SampleID\tSAMPLE_NAME\tLAB_L\tLAB_A\tLAB_B\r\nEND_DATA_FORMAT\r\nNUMBER_OF_SETS\t3\r\nBEGIN_DATA\r\n"
      "1\tPapier wei\xDF matt\t95.1\t-0.2\t1.5\r\n2\tCyan\t55\t-37\t-50\r\nEND_DATA\r\n");
  ASSERT_EQ(paints.paints.size(), 2u);
  EXPECT_EQ(paints.paints[0].name, "Papier wei\xC3\x9F matt");
  EXPECT_EQ(paints.paints[0].measurement->condition, (color::ViewingCondition{"D50", 2}));
  EXPECT_EQ(paints.paints[0].measurement->rows[0].geometry, geometry("45as45"));
  EXPECT_EQ(paints.paints[0].measurement->rows[0].lab, (color::Lab{95.1, -0.2, 1.5}));
  EXPECT_THAT(paints.warnings, ElementsAre(HasSubstr("NUMBER_OF_SETS"), HasSubstr("Windows-1252")));
}

TEST_F(Cgats, ReadsDecimalCommasWideTablesAndGaps) {
  const auto paints =
      good(std::string(kHead) + table("SAMPLE_NAME LAB_L_45as15 LAB_A_45as15 LAB_B_45as15 LAB_L_110 LAB_A_110 "
                                      "LAB_B_110 GLOSS",
                                      "one 41,5 -1 2 7 8 9 92\ntwo \"\" \"\" \"\" 1 2 3 \"\""));
  ASSERT_EQ(paints.paints.size(), 2u);
  EXPECT_EQ(paints.paints[0].measurement->rows[0].lab.L, 41.5);
  EXPECT_EQ(paints.paints[0].measurement->rows[1].geometry, geometry("45as110"));
  EXPECT_EQ(paints.paints[0].gloss[0].gloss_units, 92);
  EXPECT_EQ(paints.paints[1].measurement->rows.size(), 1u);
  EXPECT_TRUE(paints.paints[1].gloss.empty());
  EXPECT_THAT(paints.warnings, ElementsAre(HasSubstr("decimal commas")));
}

TEST_F(Cgats, ReadsXyzAndAssumesUnstatedConditions) {
  const std::string text = table("SAMPLE_ID XYZ_X XYZ_Y XYZ_Z", "7 96.42 100 82.51");
  const auto paints = good(text);
  ASSERT_EQ(paints.paints.size(), 1u);
  EXPECT_EQ(paints.paints[0].name, "7");
  EXPECT_EQ(paints.paints[0].measurement->condition, (color::ViewingCondition{"D50", 2}));
  EXPECT_NEAR(paints.paints[0].measurement->rows[0].lab.L, 100, 1e-12);
  EXPECT_NEAR(paints.paints[0].measurement->rows[0].lab.a, 0, 0.05);
  EXPECT_THAT(paints.warnings, ElementsAre(HasSubstr("taken as D50/2"), HasSubstr("taken as 45/0")));
  EXPECT_EQ(good(text, {"D65", 10, false}).paints[0].measurement->condition, (color::ViewingCondition{"D65", 10}));
}

// XYZ from 0 to 1 were read as percent without a word: L* 8.6 for a white of 95.
TEST_F(Cgats, XyzTooDarkForPercentAreTold) {
  const std::string small = table("SAMPLE_ID XYZ_X XYZ_Y XYZ_Z", "7 0.9 0.95 0.8\n8 0.1 0.12 0.09");
  EXPECT_THAT(good(small).warnings, Contains(HasSubstr("no Y is above 0.95: give paint-convert --scale factor")));
  ImportOptions options;
  options.scale = Scale::kFactor;
  const auto read = good(small, options);
  EXPECT_NEAR(read.paints[0].measurement->rows[0].lab.L, 116 * std::cbrt(.95) - 16, 1e-12);
  EXPECT_THAT(read.warnings, testing::Not(Contains(HasSubstr("no Y is above"))));
  const std::string dark = table("SAMPLE_ID XYZ_X XYZ_Y XYZ_Z", "7 0.9 0.95 0.8\n8 20 21 22");
  EXPECT_THAT(good(dark).warnings, testing::Not(Contains(HasSubstr("no Y is above"))));
}

// An observer by its year was dropped, and half a condition was completed in silence.
TEST_F(Cgats, HalfAConditionIsCompletedAloud) {
  const std::string rows = "MEASUREMENT_GEOMETRY 45/0\n" + table("SAMPLE_NAME LAB_L LAB_A LAB_B", "p 1 2 3");
  const auto light = good("CGATS.17\nILLUMINANT D65\n" + rows);
  EXPECT_EQ(light.paints[0].measurement->condition, (color::ViewingCondition{"D65", 2}));
  EXPECT_THAT(light.warnings, ElementsAre(HasSubstr("states no observer: taken as 2 deg")));
  const auto observer = good("CGATS.17\nOBSERVER 1964\n" + rows);
  EXPECT_EQ(observer.paints[0].measurement->condition, (color::ViewingCondition{"D50", 10}));
  EXPECT_THAT(observer.warnings, ElementsAre(HasSubstr("states no illuminant: taken as D50")));
  EXPECT_THAT(good("CGATS.17\nILLUMINANT D65\nOBSERVER 1931\n" + rows).warnings, IsEmpty());
  const auto four = good("CGATS.17\nILLUMINANT D65\nOBSERVER 4\n" + rows);
  EXPECT_THAT(four.warnings, ElementsAre(HasSubstr("OBSERVER \"4\" may change"), HasSubstr("taken as 2 deg")));
  EXPECT_THAT(refusal("CGATS.17\nSPECTRAL_NORM abc\n" + rows), HasSubstr(":2: SPECTRAL_NORM is \"abc\": write"));
}

// Keywords that change what readings are were passed over in silence.
TEST_F(Cgats, KeywordsThatChangeReadingsAreTold) {
  const std::string rows = table("SAMPLE_NAME LAB_L LAB_A LAB_B", "p 1 2 3"),
                    known = std::string(kHead) + "MEASUREMENT_GEOMETRY 45/0\n";
  for (const char* line : {"FILTER \"UV cut\"", "POLARIZATION yes", "DEVICE_CLASS \"DISPLAY\"", "ILLUMINANT moonlight",
                           "WEIGHTING_FUNCTION \"STATUS, T\"", "MEASUREMENT_SOURCE \"Filter=UVcut WhiteBase=Abs\"",
                           "MEASUREMENT_SOURCE \"Filter=No WhiteBase=Paper\"", "COMPUTATIONAL_PARAMETER \"Lab 10\""}) {
    const auto paints = good(known + line + "\n" + rows);
    EXPECT_EQ(paints.paints.size(), 1u);
    EXPECT_THAT(paints.warnings, ElementsAre(HasSubstr("may change what the readings are"))) << line;
  }
  for (const char* line : {"FILTER none", "POLARIZATION \"NA\"", "DEVICE_CLASS OUTPUT", "OPERATOR \"me\"",
                           "MEASUREMENT_SOURCE \"Filter=No WhiteBase=Abs\""})
    EXPECT_THAT(good(known + line + "\n" + rows).warnings, IsEmpty()) << line;
}

TEST_F(Cgats, OneConditionIsChosen) {
  const std::string text = table("SAMPLE_NAME GEOMETRY ILLUMINANT OBSERVER LAB_L LAB_A LAB_B",
                                 "p 45as15 D65 10 1 2 3\np 45as15 A 10 4 5 6\np 45as15 A 10 7 8 9");
  const auto first = good(text);
  EXPECT_EQ(first.paints[0].measurement->condition.illuminant, "D65");
  EXPECT_THAT(first.warnings, Contains(HasSubstr("--illuminant")));
  const auto incandescent = good(text, {"A", 0, false});
  EXPECT_EQ(incandescent.paints[0].measurement->rows.size(), 1u);
  EXPECT_EQ(incandescent.paints[0].measurement->rows[0].lab.L, 4);
  EXPECT_THAT(incandescent.warnings, Contains(HasSubstr("first was taken (p at 45as15)")));
  EXPECT_THAT(good(text, {"D50", 0, false}).paints, IsEmpty());
}

TEST_F(Cgats, NumbersRepeatedNamesAndLeavesOutSpheres) {
  const auto twice = good(std::string(kHead) + "MEASUREMENT_GEOMETRY 45/0\n" +
                          table("SAMPLE_NAME LAB_L LAB_A LAB_B", "p 1 2 3\np 4 5 6"));
  ASSERT_EQ(twice.paints.size(), 2u);
  EXPECT_EQ(twice.paints[1].name, "p (2)");
  const auto sphere =
      good(std::string(kHead) + "MEASUREMENT_GEOMETRY \"d/8\"\n" + table("SAMPLE_NAME LAB_L LAB_A LAB_B", "p 1 2 3"));
  EXPECT_THAT(sphere.paints, IsEmpty());
  EXPECT_THAT(sphere.warnings, Contains(HasSubstr("\"d/8\" has no aspecular angle")));
}

// Rows of one name are several paints where their codes differ, or their dates at one geometry.
TEST_F(Cgats, CodesAndDatesTellPaintsOfOneNameApart) {
  const auto paints = good(std::string(kHead) +
                           table("SAMPLE_NAME PAINT_CODE DATE GEOMETRY LAB_L LAB_A LAB_B",
                                 "p A 1 45as15 1 2 3\np A 2 45as25 2 2 3\np B 2 45as15 3 2 3\np B 3 45as15 4 2 3"));
  ASSERT_EQ(paints.paints.size(), 3u);
  EXPECT_EQ(paints.paints[0].measurement->rows.size(), 2u);
  EXPECT_EQ(paints.paints[0].measurement->date, "1..2");
  EXPECT_EQ(paints.paints[1].name, "p (2)");
  EXPECT_EQ(paints.paints[1].code, "B");
  EXPECT_EQ(paints.paints[2].measurement->rows[0].lab.L, 4);
}

TEST_F(Cgats, RefusalsNameLineAndCell) {
  const std::string fields = "SAMPLE_NAME GEOMETRY LAB_L LAB_A LAB_B";
  EXPECT_THAT(refusal(table(fields, "p 45as15 1 2 x")), HasSubstr(":5: LAB_B is \"x\": write a number"));
  EXPECT_THAT(refusal(table(fields, "p q 45as15 1 2 3")), HasSubstr(":5: 6 cells where the format has 5 fields"));
  EXPECT_THAT(refusal(table(fields, "p sideways 1 2 3")), HasSubstr(":5: "));
  EXPECT_THAT(refusal(table("SAMPLE_NAME RGB_R", "p 1")), HasSubstr("neither LAB_L LAB_A LAB_B nor XYZ_X"));
  EXPECT_THAT(refusal("BEGIN_DATA_FORMAT\nLAB_L"), HasSubstr(":1: BEGIN_DATA_FORMAT has no END_DATA_FORMAT"));
  EXPECT_THAT(refusal("BEGIN_DATA_FORMAT\nLAB_L LAB_A LAB_B\nEND_DATA_FORMAT\nBEGIN_DATA\n1 2 3\n"),
              HasSubstr(":4: BEGIN_DATA has no END_DATA"));
  EXPECT_THAT(refusal("BEGIN_DATA\n1 2 3\nEND_DATA\n"), HasSubstr("columns have no names"));
  EXPECT_THAT(refusal("hello"), HasSubstr("has no BEGIN_DATA"));
}

TEST_F(Cgats, BadRowsArePassedOverWhenAsked) {
  const auto paints = good(std::string(kHead) + table("SAMPLE_NAME GEOMETRY LAB_L LAB_A LAB_B",
                                                      "p 45as15 1 2 3\nq 45as15 1 2\nr 45as15 7 8 9"),
                           {"", 0, true});
  EXPECT_EQ(paints.paints.size(), 2u);
  EXPECT_THAT(paints.skipped, ElementsAre(HasSubstr(":9: 4 cells where the format has 5 fields: fill")));
}

// Two percent at all wavelengths are L* 116 (.02)^(1/3) - 16, whatever the light.
TEST_F(Cgats, ReadsSpectra) {
  std::string fields = "SAMPLE_ID", cells = "gray";
  for (int nm = 400; nm <= 700; nm += 10) fields += fmt::format(" SPECTRAL_NM_{}", nm), cells += " 2";
  const auto paints =
      good(std::string(kHead) + "SPECTRAL_NORM 100\nMEASUREMENT_GEOMETRY \"45/0\"\n" + table(fields, cells));
  const paint::Measurement& measurement = *paints.paints.at(0).measurement;
  EXPECT_NEAR(measurement.rows.at(0).lab.L, 116 * std::cbrt(0.02) - 16, 1e-9);
  EXPECT_EQ(measurement.rows.at(0).geometry, geometry("45as45"));
  EXPECT_NEAR(measurement.spectra.at(0).factors.at(0), 0.02, 1e-15);
  EXPECT_THAT(refusal(std::string(kHead) + table(fields, cells + " 3")), HasSubstr("33 cells"));
}

// 4 and 2 % without a norm were L* 168 and 130, and percent with a norm of 1 was kept.
TEST_F(Cgats, FindsTheScaleOfSpectra) {
  std::string fields = "SAMPLE_ID SAMPLE_NAME GEOMETRY", one = "1 S 45as15", two = "2 S 45as45";
  for (int nm = 400; nm <= 700; nm += 10) fields += fmt::format(" SPECTRAL_NM_{}", nm), one += " 4.0", two += " 2.0";
  const std::string text = table(fields, one + "\n" + two);
  const auto read = good(std::string(kHead) + text);
  EXPECT_NEAR(read.paints.at(0).measurement->rows.at(1).lab.L, 116 * std::cbrt(0.02) - 16, 1e-9);
  EXPECT_THAT(read.warnings, Contains(HasSubstr("reflectances were read as percent")));
  EXPECT_THAT(good(std::string(kHead) + text, {"", 0, false, Scale::kPercent}).warnings,
              testing::Not(Contains(HasSubstr("percent"))));
  EXPECT_THAT(refusal(std::string(kHead) + "SPECTRAL_NORM 1\n" + text),
              HasSubstr("SPECTRAL_NORM says that reflectances are factors"));
  EXPECT_NEAR(good(std::string(kHead) + "SPECTRAL_NORM 100\n" + text, {"", 0, false, Scale::kFactor})
                  .paints.at(0)
                  .measurement->rows.at(0)
                  .lab.L,
              116 * std::cbrt(0.04) - 16, 1e-9);
}

TEST_F(Cgats, ReadsUtf16) {
  const std::string text = std::string(kHead) + table("SAMPLE_ID GEOMETRY LAB_L LAB_A LAB_B", "p 45as15 1 2 3");
  std::string wide = "\xfe\xff";
  for (const char c : text) wide += std::string{'\0', c};
  EXPECT_EQ(good(wide).paints.at(0).measurement->rows.at(0).lab, (color::Lab{1, 2, 3}));
}

}  // namespace
}  // namespace goniochrome::formats::cgats_test
