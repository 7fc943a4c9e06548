#include "base/csv_records.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace goniochrome::csv_records_test {
namespace {

using Cells = std::vector<std::string>;
using namespace std::string_view_literals;

std::vector<Cells> rows_of(std::string_view text, bool has_comments = false) {
  const auto rows = table_rows(CsvRecords("t.csv", text), has_comments);
  EXPECT_TRUE(rows.ok()) << text;
  std::vector<Cells> all;
  for (const TableRow& row : *rows) all.push_back(row.cells);
  return all;
}

// Small tables knew commas alone, and took the marks of other encodings and separators for words.
TEST(CsvRecords, SmallTablesAreReadAsSpreadsheetsSaveThem) {
  const std::vector<Cells> wanted = {{"a", "b"}, {"1", "2"}};
  for (const std::string_view text : {"a,b\n1,2\n"sv,
                                      "\xef\xbb\xbf"
                                      "a;b\r\n1;2\r\n"sv,
                                      "sep=;\na;b\n1;2\n;\n"sv, "\"a\"\tb\r1\t\"2\"\r"sv, "a,b\n\n1 , 2\xc2\xa0\n,\n"sv,
                                      "\xfe\xff\0a\0;\0b\0\n\0"
                                      "1\0;\0"
                                      "2\0\n"sv})
    EXPECT_EQ(rows_of(text), wanted) << text;
}

TEST(CsvRecords, LinesOfRemarksArePassedOverWhereTheyAreAskedFor) {
  EXPECT_EQ(rows_of("# x; y\na,b\n#1,2\n", true), (std::vector<Cells>{{"a", "b"}}));
  EXPECT_EQ(rows_of("#1,2\n"), (std::vector<Cells>{{"#1", "2"}})) << "control";
  const auto rows = table_rows(CsvRecords("t.csv", "# x\n\na\n"), true);
  EXPECT_EQ(rows->front().line, 3);
}

TEST(CsvRecords, ACellIsANumberWithAPointOrAComma) {
  EXPECT_EQ(number_in_cell("1.5"), 1.5);
  EXPECT_EQ(number_in_cell("1,5"), 1.5);
  for (const char* text : {"", "1.000,5", "1,5,0", "a"}) EXPECT_FALSE(number_in_cell(text)) << text;
}

}  // namespace
}  // namespace goniochrome::csv_records_test
