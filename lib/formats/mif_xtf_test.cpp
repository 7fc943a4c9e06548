// MIF and XTF, which say the same in two ways.
#include <cstdlib>

#include "formats/importers.h"
#include "formats/internal/import_for_test.h"

namespace goniochrome::formats::mif_xtf_test {
namespace {

// 31 values from `value` on.
std::string values(double value, char separator, int count = 31) {
  std::string list;
  for (int i = 0; i < count; ++i) list += fmt::format("{}{:.7e}", i == 0 ? "" : std::string(1, separator), value + i);
  return list;
}

std::string mif(const std::vector<std::string>& angles) {
  std::string text =
      "[FILE INFO]\nVERSION=Version 2000\nANGLE=MA\n[CUSTOMER]\nCOMP=\n[STANDARD]\nNAME=Silver\n"
      "TOLR=25 CMC D65/10 2.0\n[MEASUREMENT]\nTIME=7164914\nINST=MA68\n";
  for (std::size_t i = 0; i < angles.size(); ++i)
    text += "ANGL=" + angles[i] + " " + values(1 + static_cast<double>(i), ' ') + "\n";
  return text;
}

std::string xtf(int angles, int given) {
  std::string text = fmt::format(
      "[FILE INFO]\nVERSION=2000\nANGLES={}\n[STANDARD]\nSTD=Silver`Original`731320`5`\n"
      "MEAS=8`0`1`8306`0`\n",
      angles);
  for (int i = 0; i < given; ++i) text += fmt::format("REFL={}`{}`\n", i, values(1 + i, '`'));
  return text + "TOL=CMC`*`0`7`\n[SAMPLE]\nSMP=Batch`x`\nMEAS=8`\nREFL=0`" + values(9, '`') + "`\n";
}

class Mif : public ImportTest<read_mif> {};
class Xtf : public ImportTest<read_xtf> {};

TEST_F(Mif, AnglesOfAMeasurementAreOnePaint) {
  const auto paints = good(mif({"15", "25", "45", "75", "110"}));
  ASSERT_EQ(paints.paints.size(), 1u);
  const paint::Measurement& measurement = *paints.paints[0].measurement;
  EXPECT_EQ(paints.paints[0].name, "Silver");
  EXPECT_EQ(measurement.instrument, "MA68");
  EXPECT_EQ(measurement.date, "7164914");
  ASSERT_EQ(measurement.spectra.size(), 5u);
  EXPECT_EQ(measurement.spectra[4].geometry, geometry("45as110"));
  EXPECT_EQ(measurement.spectra[4].from_nm, 400);
  EXPECT_EQ(measurement.spectra[4].step_nm, 10);
  EXPECT_NEAR(measurement.spectra[4].factors[30], .35, 1e-12);
}

TEST_F(Mif, EachSampleAndMeasurementIsAPaint) {
  const std::string one = mif({"25"}), section = one.substr(one.find("[MEASUREMENT]"));
  std::string undated = section;
  undated.erase(undated.find("TIME="), undated.find("INST=") - undated.find("TIME="));
  const auto paints = good(one + undated + "[SAMPLE]\nNAME=Batch\n" + section);
  ASSERT_EQ(paints.paints.size(), 3u);
  EXPECT_EQ(paints.paints[0].measurement->date, "7164914");
  EXPECT_EQ(paints.paints[1].measurement->date, "") << "that of the measurement before is not its own";
  EXPECT_EQ(paints.paints[1].name, "Silver (2)");
  EXPECT_EQ(paints.paints[2].name, "Batch");
}

TEST_F(Mif, SpheresAreNamed) {
  const std::string text = mif({"In", "Ex"});
  EXPECT_THAT(good(text).paints, IsEmpty());
  ImportOptions options;
  options.viewings = {{"Ex", geometry("45as45")}};
  const auto paints = good(text, options);
  ASSERT_EQ(paints.paints.size(), 1u);
  EXPECT_NEAR(paints.paints[0].measurement->spectra.at(0).factors[0], .02, 1e-12);
  EXPECT_THAT(paints.warnings, Contains(HasSubstr("the viewing \"In\" has no aspecular angle")));
}

TEST_F(Mif, RefusalsNameLineAndCount) {
  const std::string whole = mif({"15"});
  EXPECT_THAT(refusal(whole.substr(0, whole.size() - 20)),
              HasSubstr(":12: ANGL 15 has 30 values, and 31 are from 400"));
  EXPECT_THAT(refusal("[FILE INFO]\nANGLE=45\n[MEASUREMENT]\nANGL=45 1\n[STANDARD]\n[MEASUREMENT]\nANGL=45 1\n"),
              HasSubstr(":7: ANGL stands before the name of a sample"));
  EXPECT_THAT(refusal(whole + "ANG"), HasSubstr(":13: \"ANG\" is neither [SECTION] nor KEY=VALUE"));
}

// The numbers of angles mean those that instruments of so many angles have.
TEST_F(Xtf, AnglesAreThoseOfTheInstrument) {
  const std::pair<int, std::vector<const char*>> cases[] = {
      {1, {"45as45"}}, {3, {"45as25", "45as45", "45as75"}}, {5, {"45as15", "45as25", "45as45", "45as75", "45as110"}}};
  for (const auto& [angles, names] : cases) {
    const auto paints = good(xtf(angles, angles));
    ASSERT_EQ(paints.paints.size(), 2u) << angles;
    EXPECT_EQ(paints.paints[0].name, "Silver");
    EXPECT_EQ(paints.paints[1].name, "Batch");
    EXPECT_EQ(paints.paints[0].measurement->date, "731320 5");
    EXPECT_EQ(paints.paints[1].measurement->date, "");
    const auto& spectra = paints.paints[0].measurement->spectra;
    ASSERT_EQ(spectra.size(), names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_EQ(spectra[i].geometry, geometry(names[i]));
      EXPECT_NEAR(spectra[i].factors[30], .31 + .01 * static_cast<double>(i), 1e-12);
    }
  }
}

TEST_F(Xtf, OtherAnglesAreNamed) {
  EXPECT_THAT(good(xtf(2, 2)).warnings, Contains(HasSubstr("the viewing \"In\" has no aspecular angle")));
  EXPECT_THAT(good(xtf(4, 4)).warnings, Contains(HasSubstr("the viewing \"angle 3 of 4\" has no aspecular angle")));
  EXPECT_THAT(refusal("[FILE INFO]\n[STANDARD]\nSTD=a`\nREFL=0`1`\n"),
              HasSubstr(":4: REFL begins with \"0\", and ANGLES"));
  EXPECT_THAT(refusal(xtf(3, 3) + "REFL=1`" + values(1, '`', 12) + "`\n"), HasSubstr("has 12 values, and 31 are"));
}

TEST_F(Mif, ReadsTheFileOfAProgramRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (!data) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  ImportOptions options;
  options.viewings = {{"In", geometry("45as45")}, {"Ex", geometry("45as75")}};
  const auto mif = read_file(std::string(data) + "/formats/gold.mif", options);
  auto input = InputFile::open(std::string(data) + "/formats/Gold.xtf");
  const auto xtf = read_xtf(std::move(*input), options);
  ASSERT_TRUE(mif.ok() && xtf.ok());
  for (const auto* paints : {&*mif, &*xtf}) {
    ASSERT_EQ(paints->paints.size(), 1u);
    EXPECT_EQ(paints->paints[0].name, "Golden Yellow");
    const auto& spectra = paints->paints[0].measurement->spectra;
    ASSERT_EQ(spectra.size(), 2u);
    EXPECT_DOUBLE_EQ(spectra[0].factors[0], .13885177);
    EXPECT_DOUBLE_EQ(spectra[1].factors[3], .12559001);
  }
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_EQ(mif->paints[0].measurement->spectra[i].factors, xtf->paints[0].measurement->spectra[i].factors);
}

}  // namespace
}  // namespace goniochrome::formats::mif_xtf_test
