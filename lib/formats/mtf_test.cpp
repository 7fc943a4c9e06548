// MTF, a report whose values may touch.
#include <cstdlib>

#include "formats/importers.h"
#include "formats/internal/import_for_test.h"

namespace goniochrome::formats::mtf_test {
namespace {

const std::string kHead =
    "                     TREEPOINT QTEX Statistics\r\n"
    "    Reference : ID          :STD\r\n"
    "                Name        :ASPEN\r\n"
    "                Date        :29/07/2003 02:09:31 PM\r\n"
    "                Status      :CM/Reflexion/SCI/N:1\r\n";
const std::string kColumns = "    nm     0     10     20     30    40     50    60     70     80    90\r\n";
const std::string kTable = kColumns +
                           "    300                                           0.000  0.000  0.000 0.000\r\n"
                           "    400    11.88010.930 10.960 11.41012.620 14.55017.240 20.630 25.15029.780\r\n"
                           "    500    35.57042.010 49.050 56.56063.420 69.15073.610 76.810 79.44081.420\r\n"
                           "    600    82.66083.380 83.850 84.26084.900 85.90086.800 87.480 88.19088.660\r\n"
                           "    700    89.3500.000  0.000  0.000 0.000\r\n";
const std::string kSample = "    1/1   TKI-21 ASPEN GOLD          0.30    0.68     -0.18    0.29    0.27     0.21\r\n";

ImportOptions as_45() {
  ImportOptions options;
  options.viewings = {{"", geometry("45as45")}};
  return options;
}

class Mtf : public ImportTest<read_mtf> {};

TEST_F(Mtf, ValuesThatTouchAreThoseOfTheText) {
  const auto paints = good(kHead + kTable + kSample + kTable, as_45());
  ASSERT_EQ(paints.paints.size(), 2u);
  EXPECT_EQ(paints.paints[0].name, "ASPEN");
  EXPECT_EQ(paints.paints[1].name, "TKI-21 ASPEN GOLD");
  for (const paint::Paint& paint : paints.paints) {
    const paint::SpectrumReading& spectrum = paint.measurement->spectra.at(0);
    EXPECT_EQ(spectrum.from_nm, 400);
    EXPECT_EQ(spectrum.step_nm, 10);
    ASSERT_EQ(spectrum.factors.size(), 31u);
    EXPECT_DOUBLE_EQ(spectrum.factors[1], .1093);
    EXPECT_DOUBLE_EQ(spectrum.factors[30], .8935);
  }
  EXPECT_EQ(paints.paints[0].measurement->instrument, "CM");
  EXPECT_EQ(paints.paints[0].measurement->date, "29/07/2003 02:09:31 PM");
  EXPECT_EQ(paints.paints[1].measurement->date, "");
  EXPECT_THAT(paints.warnings, Contains(HasSubstr("zeros at the ends of spectra are taken as not measured")));
  EXPECT_THAT(paints.warnings, Contains(HasSubstr("the viewing \"SCI\" was taken as 45as45")));
  EXPECT_THAT(good(kHead + kTable).paints, IsEmpty());
}

TEST_F(Mtf, LightThatWentThroughIsLeftOut) {
  std::string head = kHead;
  head.replace(head.find("Reflexion"), 9, "Transmission");
  const auto paints = good(head + kTable, as_45());
  EXPECT_THAT(paints.paints, IsEmpty());
  EXPECT_THAT(paints.warnings, Contains(HasSubstr("values of Transmission are of no reflected light")));
}

TEST_F(Mtf, RefusalsNameTheLine) {
  EXPECT_THAT(refusal(kHead), HasSubstr("has no table of wavelengths: the file was cut off"));
  const std::string text = kHead + kTable;
  EXPECT_THAT(refusal(text.substr(0, text.find(".350") + 2)), HasSubstr(":11: \"89.3\" is no percentage with three"));
  std::string missing = text;
  missing.erase(missing.find("    500"), missing.find("    600") - missing.find("    500"));
  EXPECT_THAT(refusal(missing), HasSubstr(":9: the row of 600 nm has 10 values from 600 nm on, where that of 500 nm"));
  // In the last row, the values behind a gap moved one wavelength down.
  std::string gap = text;
  gap.replace(gap.find("0.000  0.000  0.000 0.000\r\n", gap.find("    700")), 5, "     ");
  EXPECT_THAT(refusal(gap), HasSubstr(":11: no value stands at 710 nm, and 720 nm has one"));
  EXPECT_THAT(refusal(kHead + "    nm     0     10\r\n"),
              HasSubstr("the heads of a table of wavelengths are nm, 0, 10"));
}

TEST_F(Mtf, ReadsTheFileOfAProgramRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (!data) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const auto paints = read_file(std::string(data) + "/formats/PINK.mtf", as_45());
  ASSERT_TRUE(paints.ok());
  ASSERT_EQ(paints->paints.size(), 1u);
  EXPECT_EQ(paints->paints[0].name, "K");
  const paint::SpectrumReading& spectrum = paints->paints[0].measurement->spectra.at(0);
  EXPECT_EQ(spectrum.from_nm, 400);
  ASSERT_EQ(spectrum.factors.size(), 35u);
  EXPECT_DOUBLE_EQ(spectrum.factors[0], .62035);
  EXPECT_DOUBLE_EQ(spectrum.factors[34], .86347);
}

}  // namespace
}  // namespace goniochrome::formats::mtf_test
