#include "formats/spectrum_table.h"

#include <gtest/gtest.h>

#include "base/file.h"
#include "base/testdata_for_test.h"

namespace goniochrome::formats::spectrum_table_test {
namespace {

std::string written(const std::string& text) {
  const std::string path = testing::TempDir() + "spectra.csv";
  EXPECT_TRUE(write_file(path, text).ok());
  return path;
}

TEST(SpectrumTable, ReadsThePublishedLights) {
  const auto table = read_spectrum_table(testdata("published-lights.csv"));
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_EQ(table->names.size(), 32U);
  EXPECT_EQ(table->wavelengths_nm.front(), 380);
  EXPECT_EQ(table->wavelengths_nm.back(), 730);
  EXPECT_EQ(table->column("A").value().front(), 9.7951);
  const auto none = table->column("moonlight");
  ASSERT_FALSE(none.ok());
  EXPECT_NE(none.error().message.find("D65, A, C"), std::string::npos);
}

TEST(SpectrumTable, ReadsNamesWithBlanksAndLinesOfOtherSystems) {
  const auto table = read_spectrum_table(written("\xEF\xBB\xBFnm,a red,b\r\nset,x,y\r\n400,1,2\r\n\r\n410,3,4\r\n"));
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_EQ(table->column("a red").value(), (std::vector<double>{1, 3}));
}

// A filter in percent was taken for one that passes fifty times the light.
TEST(SpectrumTable, FactorsAreOfTheScaleThatTheTableStates) {
  for (const char* text : {"nm,a [%],b\n400,50,.25\n410,60,.5\n", "nm,a,b\n[nm],%,-\n400,50,.25\n410,60,.5\n"}) {
    const auto table = read_spectrum_table(written(text));
    ASSERT_TRUE(table.ok()) << table.error().message;
    EXPECT_EQ(table->factors("a").value(), (std::vector<double>{.5, .6}));
    EXPECT_EQ(table->factors("b").value(), (std::vector<double>{.25, .5}));
  }
  const auto unstated = read_spectrum_table(written("nm,a,b\n400,.5,3\n410,60,4\n"));
  ASSERT_TRUE(unstated.ok());
  EXPECT_EQ(unstated->factors("a").error().message,
            "\"a\" is 60 at 410 nm, which no filter is as a factor: head it \"a [%]\" if it is percent");
  EXPECT_EQ(unstated->column("a").value(), (std::vector<double>{.5, 60}));
  EXPECT_FALSE(unstated->factors("c").ok());
}

TEST(SpectrumTable, IsReadAsSpreadsheetsSaveIt) {
  const auto table = read_spectrum_table(written("sep=;\nnm;\"a\"\n400;0,5\n410;\"0,25\"\n;\n"));
  ASSERT_TRUE(table.ok()) << table.error().message;
  EXPECT_EQ(table->column("a").value(), (std::vector<double>{.5, .25}));
  const auto twice = read_spectrum_table(written("nm,a,a\n400,1,2\n410,1,2\n"));
  EXPECT_EQ(twice->column("a").error().message, "2 columns are named \"a\": rename all but one");
}

TEST(SpectrumTable, NamesTheLineOfWhatIsWrong) {
  const std::pair<const char*, const char*> cases[] = {
      {"nm\n400\n410\n", ":1:"},     {"nm,a\n400,1\n", "two wavelengths"}, {"nm,a\n400,1\n390,2\n", ":3:"},
      {"nm,a\n400,1\n410\n", ":3:"}, {"nm,a\n400,1\n410,1;5\n", ":3:"},    {"nm,a\n400,1\nx,2\n", ":3:"},
      {"", "two wavelengths"}};
  for (const auto& [text, wanted] : cases) {
    const auto table = read_spectrum_table(written(text));
    ASSERT_FALSE(table.ok()) << text;
    EXPECT_NE(table.error().message.find(wanted), std::string::npos) << table.error().message;
  }
  EXPECT_FALSE(read_spectrum_table("/nowhere/at/all.csv").ok());
}

}  // namespace
}  // namespace goniochrome::formats::spectrum_table_test
