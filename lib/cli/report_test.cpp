#include "cli/report.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "base/clock.h"
#include "base/file.h"

namespace goniochrome::cli::report_test {
namespace {

std::string path() {
  return (std::filesystem::path(testing::TempDir()) / "goniochrome-report.json").string();
}

// The text is what one dump of the whole document gives, lists or no lists, so both ways of adding can be mixed.
TEST(Report, ReadsAsOneDocumentInTheOrderWritten) {
  const Json head = {{"tool", "fit-paint"}, {"seed", 1}};
  const Json paint = {
      {"name", "red\n\"flake\""}, {"lobes", {1, 2}}, {"views", Json::object()}, {"none", Json::array()}};
  Report report;
  Json expected = head;
  report.results()["first"] = expected["results"]["first"] = {1.5, nullptr};
  for (int i = 0; i < 3; ++i) {
    report.add("paints", paint);
    expected["results"]["paints"].push_back(paint);
  }
  report.begin_list("none");
  expected["results"]["none"] = Json::array();
  report.results()["last"] = expected["results"]["last"] = paint;
  ASSERT_TRUE(report.write(path(), head).ok());
  EXPECT_EQ(*file_content(path()), json_text(expected, 2) + "\n");
}

TEST(Report, WithoutResultsIsADocument) {
  ASSERT_TRUE(Report().write(path(), {{"tool", "relight"}}).ok());
  EXPECT_EQ(*file_content(path()), "{\n  \"tool\": \"relight\",\n  \"results\": {}\n}\n");
}

#ifndef __SANITIZE_ADDRESS__  // which keeps what was freed
// 10^5 paints with forty figures each, 90 MB as text. The control: a fifth of them in one document.
TEST(Report, AListOfAnyLengthTakesConstantMemory) {
  const Json paint = {{"name", "red"}, {"de00_by_geometry", std::vector<double>(40, 0.123456789)}};
  const double before_mb = peak_rss_mb();
  Report report;
  for (int i = 0; i < 100'000; ++i) report.add("paints", paint);
  ASSERT_TRUE(report.write(path(), Json::object()).ok());
  EXPECT_GT(std::filesystem::file_size(path()), 80e6);
  EXPECT_LT(peak_rss_mb() - before_mb, 4);
  const std::vector<Json> document(20'000, paint);
  EXPECT_GT(peak_rss_mb() - before_mb, 10);
  std::filesystem::remove(path());
}
#endif

}  // namespace
}  // namespace goniochrome::cli::report_test
