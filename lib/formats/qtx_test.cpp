// QTX: standards and batches as sections of keys. Texts are made here; those of programs are read where they are known.
#include <cmath>
#include <cstdlib>

#include "formats/importers.h"
#include "formats/internal/import_for_test.h"

namespace goniochrome::formats::qtx_test {
namespace {

// A section of a standard of `count` values from 400 nm on by 10 nm; `viewing` is its geometry.
std::string section(const std::string& name, const std::string& viewing, int count, double value,
                    const std::string& more = "", double step = 0.5) {
  std::string list;
  for (int i = 0; i < count; ++i) list += fmt::format("{}{}", i == 0 ? "" : ", ", value + step * i);
  return fmt::format(
      "[STANDARD_DATA 0]\r\nSTD_NAME={}\r\nSTD_DATETIME=1029098162,\r\nSTD_REFLPOINTS={},\r\nSTD_REFLINTERVAL=10,\r\n"
      "STD_REFLLOW=400,\r\nSTD_VIEWING={}\r\nSTD_R={},\r\n{}\r\n",
      name, count, viewing, list, more);
}

ImportOptions as_45(const char* words) {
  ImportOptions options;
  options.viewings = {{words, geometry("45as45")}};
  return options;
}

class Qtx : public ImportTest<read_qtx> {};

TEST_F(Qtx, SpectraAreThoseOfTheText) {
  const auto paints = good(section("Rot, matt", "45/0", 31, 5));
  ASSERT_EQ(paints.paints.size(), 1u);
  const paint::Paint& paint = paints.paints[0];
  EXPECT_EQ(paint.name, "Rot, matt");
  ASSERT_EQ(paint.measurement->spectra.size(), 1u);
  const paint::SpectrumReading& spectrum = paint.measurement->spectra[0];
  EXPECT_EQ(spectrum.geometry, geometry("45as45"));
  EXPECT_EQ(spectrum.from_nm, 400);
  EXPECT_EQ(spectrum.step_nm, 10);
  ASSERT_EQ(spectrum.factors.size(), 31u);
  for (int i = 0; i < 31; ++i) EXPECT_NEAR(spectrum.factors[static_cast<std::size_t>(i)], .05 + .005 * i, 1e-15);
  EXPECT_EQ(paint.measurement->condition, (color::ViewingCondition{"D65", 10}));
  EXPECT_EQ(paint.measurement->rows.size(), 1u);
  EXPECT_EQ(paint.measurement->date, "2002-08-11T20:36:02Z");
}

// A sphere has no aspecular angle: its readings are named, and taken for others only by the user's word.
TEST_F(Qtx, ASphereIsNamedAndNeverGuessed) {
  const std::string text = section("a", "%R SAV SCE UV Inc", 31, 5) + section("b", "SCI", 31, 5);
  const auto none = good(text);
  EXPECT_THAT(none.paints, IsEmpty());
  EXPECT_THAT(none.warnings, Contains(HasSubstr("the viewing \"%R SAV SCE UV Inc\" has no aspecular angle, and its "
                                                "readings are left out: give paint-convert --viewing")));
  const auto excluded = good(text, as_45("sce"));
  ASSERT_EQ(excluded.paints.size(), 1u);
  EXPECT_EQ(excluded.paints[0].name, "a");
  EXPECT_THAT(excluded.warnings, Contains("the viewing \"%R SAV SCE UV Inc\" was taken as 45as45, as --viewing says"));
  EXPECT_EQ(good(text, as_45("")).paints.size(), 2u);
  EXPECT_THAT(good(text, as_45("in")).paints, IsEmpty());  // no part of Inc
}

TEST_F(Qtx, BatchesHaveNamesOfTheirOwn) {
  std::string text = section("Standard", "45as15", 31, 5);
  std::string batch = section("x", "45as15", 31, 6);
  for (const auto& [from, to] : {std::pair{"[STANDARD_DATA 0]", "[BATCH_DATA 0]"}, {"STD_", "BAT_"}})
    for (auto at = batch.find(from); at != std::string::npos; at = batch.find(from))
      batch.replace(at, std::string(from).size(), to);
  batch.insert(batch.find("BAT_NAME"), "STD_NAME=Standard\r\n");
  const auto paints = good(text + batch + batch);
  ASSERT_EQ(paints.paints.size(), 3u);
  EXPECT_EQ(paints.paints[0].name, "Standard");
  EXPECT_EQ(paints.paints[1].name, "x");
  EXPECT_EQ(paints.paints[2].name, "x (2)");
}

// X, Y and Z under a light that is stated stand in for a spectrum, and tell the scale of one.
TEST_F(Qtx, TristimulusValuesTellColorAndScale) {
  const std::string xyz = "STD_CORD_ILLUM=D65/10 deg\r\nSTD_X=94.811\r\nSTD_Y=100\r\nSTD_Z=107.304\r\n";
  const auto white = good("[STANDARD 1]\nSTD_NAME=w\nSTD_VIEWING=45/0\n" + xyz);
  ASSERT_EQ(white.paints.size(), 1u);
  EXPECT_NEAR(white.paints[0].measurement->rows[0].lab.L, 100, 1e-9);
  EXPECT_TRUE(white.paints[0].measurement->spectra.empty());
  // Percent below 1 beside Y of 70 are factors.
  std::string text = section("f", "45/0", 31, .1, "STD_CORD_ILLUM=D65/10\nSTD_X=8\nSTD_Y=30\nSTD_Z=8", .01);
  const auto factors = good(text);
  EXPECT_NEAR(factors.paints[0].measurement->spectra[0].factors[0], .1, 1e-15);
  EXPECT_THAT(factors.warnings, Contains(HasSubstr("factors, as the L* beside them says")));
  EXPECT_THAT(good(section("d", "45/0", 31, -7.3)).warnings,
              Contains(HasSubstr("give paint-convert --scale factor if they are factors")));
}

// XYZ from 0 to 1 were nearly black, and XYZ beside the spectrum of another color were dropped, both without a word.
TEST_F(Qtx, DarkAndContradictoryTristimulusValuesAreTold) {
  const std::string head = "[STANDARD 1]\nSTD_NAME=w\nSTD_VIEWING=45/0\nSTD_CORD_ILLUM=D65/10\n";
  const std::string ones = head + "STD_X=.42665\nSTD_Y=.45\nSTD_Z=.48287\n";
  EXPECT_THAT(good(ones).warnings, Contains(HasSubstr("XYZ were read from 0 to 100, as the format has them")));
  ImportOptions options;
  options.scale = Scale::kFactor;
  EXPECT_NEAR(good(ones, options).paints.at(0).measurement->rows.at(0).lab.L, 116 * std::cbrt(.45) - 16, 1e-9);
  const auto told = HasSubstr("the color of the spectrum was taken where the XYZ beside it are another (a at 45as45)");
  const auto beside = [](const char* y) {
    return section("a", "45/0", 31, 45, fmt::format("STD_CORD_ILLUM=D65/10\nSTD_X=42.67\nSTD_Y={}\nSTD_Z=48.29", y), 0);
  };
  EXPECT_THAT(good(beside("45")).warnings, testing::Not(Contains(told)));
  EXPECT_THAT(good(beside("30")).warnings, Contains(told));
}

TEST_F(Qtx, NamesMayBeInAnyEncoding) {
  const auto western = good(section("Gr\xfcn \x80", "45/0", 31, 5));
  EXPECT_EQ(western.paints[0].name, "Gr\xc3\xbcn \xe2\x82\xac");
  EXPECT_THAT(western.warnings, Contains("is not UTF-8: read as Windows-1252"));
  std::string wide = "\xff\xfe";
  for (const char c : section("Rot", "45/0", 31, 5)) wide += c, wide += '\0';
  EXPECT_EQ(good(wide).paints[0].name, "Rot");
}

TEST_F(Qtx, RefusalsNameLineKeyAndRemedy) {
  const std::string whole = section("a", "45/0", 31, 5);
  EXPECT_THAT(refusal("[STANDARD 0]\nSTD_NAME=a\nSTD_REFL"),
              HasSubstr(":3: \"STD_REFL\" is neither [SECTION] nor KEY=VALUE"));
  EXPECT_THAT(refusal(whole.substr(0, whole.find("17,"))),
              HasSubstr(":8: STD_R has 24 values, and STD_REFLPOINTS is 31: the file is damaged, or was cut off"));
  EXPECT_THAT(refusal("[STANDARD 0]\nSTD_R=1,2,x\n"), HasSubstr(":2: STD_R: value 3 is \"x\": write a number"));
  EXPECT_THAT(refusal("[STANDARD 0]\nSTD_R=1,2\n"), HasSubstr("STD_R stands beside STD_REFLPOINTS \"\""));
  EXPECT_THAT(refusal("[STANDARD 0]\nSTD_R=1,2\nSTD_REFLPOINTS=2\nSTD_REFLLOW=90000\nSTD_REFLINTERVAL=10\n"),
              HasSubstr("wavelengths lie from 300 to 1100 nm"));
  EXPECT_THAT(refusal("[STANDARD 0]\nSTD_R=1,2\nSTD_R=1,2\n"), HasSubstr(":3: STD_R stands in this section a second"));
  EXPECT_THAT(refusal("[STANDARD 0]\nSTD_R=1e9,2\n"), HasSubstr("which is no reflectance"));
  // Sound sections around it are read where that is wanted.
  ImportOptions options;
  options.keep_going = true;
  const auto rest = good("[BATCH 0]\nBAT_R=1\n" + whole, options);
  EXPECT_EQ(rest.paints.size(), 1u);
  EXPECT_EQ(rest.skipped.size(), 1u);
}

// A million keys take the memory of their text, and no more time than reading it.
TEST_F(Qtx, ManyKeysAreReadInTheirOwnSize) {
  std::string text = section("a", "45/0", 31, 5);
  for (int i = 0; i < 1'000'000; ++i) text += "KEY" + std::to_string(i) + "=1\n";
  EXPECT_EQ(good(text).paints.size(), 1u);
}

TEST_F(Qtx, ReadsTheFilesOfProgramsRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (!data) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const std::pair<const char*, std::size_t> files[] = {{"CTMAIL.QTX", 10}, {"batches.qtx", 3}, {"file1.qtx", 1}};
  for (const auto& [name, most] : files) {
    const auto paints = read_file(std::string(data) + "/formats/" + name, as_45(""));
    ASSERT_TRUE(paints.ok()) << name;
    ASSERT_GE(paints->paints.size(), 1u) << name;
    EXPECT_LE(paints->paints.size(), most) << name;
    for (const paint::Paint& paint : paints->paints) {
      ASSERT_EQ(paint.measurement->spectra.size(), 1u);
      EXPECT_EQ(paint.measurement->spectra[0].from_nm, 360);
      EXPECT_EQ(paint.measurement->spectra[0].factors.size(), 35u);
    }
  }
  const auto nylon = read_file(std::string(data) + "/formats/file1.qtx", as_45("SCE"));
  EXPECT_EQ(nylon->paints.at(0).name, "Blue Nylon 33445");
  EXPECT_DOUBLE_EQ(nylon->paints[0].measurement->spectra[0].factors[0], .2984853);
  EXPECT_DOUBLE_EQ(nylon->paints[0].measurement->spectra[0].factors[34], .59350403);
}

}  // namespace
}  // namespace goniochrome::formats::qtx_test
