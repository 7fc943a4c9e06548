// JCAMP-DX: ordinates as numbers and in all forms of compression.
#include "formats/importers.h"
#include "formats/internal/import_for_test.h"

namespace goniochrome::formats::jcamp_test {
namespace {

// 31 points from 400 to 700 nm of which the k-th is 10 + k percent.
std::string block(const std::string& lines, const std::string& form = "(X++(Y..Y))",
                  const char* units = "% REFLECTANCE") {
  return fmt::format(
      "##TITLE=Red, glossy $$ made\n##JCAMP-DX=4.24\n##DATA TYPE=UV/VIS SPECTRUM\n##$GEOMETRY=45as15\n"
      "##LONGDATE=2010/10/15 13:04:05\n##SPECTROMETER/DATA SYSTEM=S "
      "1\n##XUNITS=NANOMETERS\n##YUNITS={}\n##XFACTOR=1\n##YFACTOR=1\n##FIRSTX=400\n"
      "##LASTX=700\n##NPOINTS=31\n##XYDATA={}\n{}##END=\n",
      units, form, lines);
}

const std::string kPlain =
    "400 10 11 12 13 14 15 16 17 18 19 20\n510 21 22 23 24 25 26 27 28 29 30\n610 31 32 33 34 35 36 37 38 39 40\n";

class Jcamp : public ImportTest<read_jcamp> {};

TEST_F(Jcamp, EveryFormOfOrdinatesSaysTheSame) {
  std::string pairs;
  for (int k = 0; k < 31; ++k) pairs += fmt::format("{},{}; ", 400 + 10 * k, 10 + k);
  const std::pair<const char*, std::string> forms[] = {
      {"plain", block(kPlain)},
      {"packed", block("400+10+11+12+13+14+15+16+17+18+19+20\n510+21+22+23+24+25+26+27+28+29+30\n"
                       "610+31+32+33+34+35+36+37+38+39+40\n")},
      {"squeezed", block("400A0A1A2A3A4A5A6A7A8A9B0\n510B1B2B3B4B5B6B7B8B9C0\n610C1C2C3C4C5C6C7C8C9D0\n")},
      // A line that follows a difference begins with the last value once more.
      {"differences", block("400A0JJJJJJJJJJ\n500B0JJJJJJJJJJ\n600C0JJJJJJJJJJ\n")},
      {"pairs", block(pairs + "\n", "(XY..XY)")}};
  for (const auto& [name, text] : forms) {
    const auto paints = good(text);
    ASSERT_EQ(paints.paints.size(), 1u) << name;
    EXPECT_EQ(paints.paints[0].name, "Red, glossy");
    EXPECT_EQ(paints.paints[0].measurement->instrument, "S 1");
    EXPECT_EQ(paints.paints[0].measurement->date, "2010-10-15T13:04:05");
    const paint::SpectrumReading& spectrum = paints.paints[0].measurement->spectra.at(0);
    EXPECT_EQ(spectrum.geometry, geometry("45as15"));
    EXPECT_EQ(spectrum.from_nm, 400);
    EXPECT_NEAR(spectrum.step_nm, 10, 1e-12);
    ASSERT_EQ(spectrum.factors.size(), 31u) << name;
    for (int k = 0; k < 31; ++k)
      EXPECT_NEAR(spectrum.factors[static_cast<std::size_t>(k)], .1 + .01 * k, 1e-12) << name;
  }
}

// Z stands for eight times, Y for seven. A difference is repeated as one, and checked at the beginning of the next
// line.
TEST_F(Jcamp, RepeatsGoOnAsTheyBegan) {
  const auto same = good(block("400 A0Z\n480 A0Z\n560 A0Z\n640 A0Y\n"));
  EXPECT_NEAR(same.paints.at(0).measurement->spectra.at(0).factors[30], .1, 1e-12);
  const auto rising = good(block("400A0JY\n470A7JZ\n550B5JZ\n630C3JY\n"));
  for (int k = 0; k < 31; ++k)
    EXPECT_NEAR(rising.paints.at(0).measurement->spectra.at(0).factors[static_cast<std::size_t>(k)], .1 + .01 * k,
                1e-12);
}

TEST_F(Jcamp, OtherUnitsAreTurnedOrNamed) {
  const auto factors =
      good(block("400 .1 .1 .1 .1 .1 .1 .1 .1 .1 .1\n500 .1 .1 .1 .1 .1 .1 .1 .1 .1 .1\n600 .1 .1 .1 .1 "
                 ".1 .1 .1 .1 .1 .1 .1\n",
                 "(X++(Y..Y))", "REFLECTANCE"));
  EXPECT_NEAR(factors.paints.at(0).measurement->spectra.at(0).factors[0], .1, 1e-12);
  for (const char* unit : {"ABSORBANCE", "TRANSMITTANCE", "LOG(1/REFLECTANCE)"}) {
    const auto none = good(block(kPlain, "(X++(Y..Y))", unit));
    EXPECT_THAT(none.paints, IsEmpty()) << unit;
    EXPECT_THAT(none.warnings, Contains(HasSubstr(fmt::format("spectra of \"{}\" are of no reflectance", unit))));
  }
  // Wavenumbers descend as wavelengths ascend: a color, whose points are in unequal steps.
  std::string waves = block("25000 20 20 20 20 20 20\n19285 20 20 20 20\n", "(X++(Y..Y))");
  for (const auto& [from, to] : {std::pair{"NANOMETERS", "1/CM"},
                                 {"FIRSTX=400", "FIRSTX=25000"},
                                 {"LASTX=700", "LASTX=14000"},
                                 {"NPOINTS=31", "NPOINTS=10"}})
    waves.replace(waves.find(from), std::string(from).size(), to);
  const auto color = good(waves);
  ASSERT_EQ(color.paints.size(), 1u);
  EXPECT_TRUE(color.paints[0].measurement->spectra.empty());
  EXPECT_NEAR(color.paints[0].measurement->rows.at(0).lab.L, 51.8372, 1e-4);  // 116 (.2)^(1/3) - 16
}

// A factor that is no number was 1, and a largest value that contradicts the ordinates was not heard.
TEST_F(Jcamp, FactorsAndTheLargestValueAreHeard) {
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = block(kPlain);
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_THAT(refusal(with("##YFACTOR=1", "##YFACTOR=1,0")), HasSubstr("YFACTOR is \"1,0\": write a number"));
  EXPECT_THAT(refusal(with("##XFACTOR=1", "##XFACTOR=x")), HasSubstr("XFACTOR is \"x\": write a number"));
  EXPECT_EQ(good(with("##YFACTOR=1\n", "")).paints.size(), 1u);
  const auto told = HasSubstr("MAXY is 4, and the largest ordinate times YFACTOR 40: the file contradicts itself");
  EXPECT_THAT(good(with("##YFACTOR=1\n", "##YFACTOR=1\n##MAXY=40.3\n")).warnings, testing::Not(Contains(told)));
  EXPECT_THAT(good(with("##YFACTOR=1\n", "##YFACTOR=1\n##MAXY=4\n")).warnings, Contains(told));
}

TEST_F(Jcamp, RefusalsNameLineAndCount) {
  EXPECT_THAT(refusal(block(kPlain.substr(0, kPlain.find("610")))),
              HasSubstr("has 21 values, and NPOINTS is 31: the file is damaged, or was cut off"));
  const std::string whole = block(kPlain);
  EXPECT_THAT(refusal(whole.substr(0, whole.find("##END"))),
              HasSubstr("the file ends within a spectrum, without ##END=:"));
  std::string lost = kPlain;
  lost.erase(lost.find("510"), lost.find("610") - lost.find("510"));
  EXPECT_THAT(refusal(block(lost)), HasSubstr(":16: the line begins at 610, and after 11 of 31 values"));
  EXPECT_THAT(refusal(block(lost)), HasSubstr("lines are missing"));
  EXPECT_THAT(refusal(block("400 0,2\n410 0,2\n420 0,2\n430 0,2\n")), HasSubstr("lines have too many values"));
  EXPECT_THAT(refusal(block("400A0JJJ\n430A4J\n")),
              HasSubstr(":16: the line begins with 14, and the line before ends with 13"));
  EXPECT_THAT(refusal(block("400 10 ? 12\n")), HasSubstr("\"?"));
  EXPECT_THAT(refusal(block(kPlain, "(R++(I..I))")), HasSubstr("the form \"(R++(I..I))\" is not known"));
  EXPECT_THAT(refusal(block("400A0Z999999999\n")), HasSubstr("is repeated"));
  EXPECT_THAT(refusal(block(kPlain).replace(block(kPlain).find("NANOMETERS"), 10, "SECONDS   ")),
              HasSubstr("XUNITS is \"SECONDS\""));
}

}  // namespace
}  // namespace goniochrome::formats::jcamp_test
