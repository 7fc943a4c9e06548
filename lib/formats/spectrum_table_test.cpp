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
