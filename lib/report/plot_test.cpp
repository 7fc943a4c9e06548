#include "report/plot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace goniochrome::report::plot_test {
namespace {

TEST(Plot, TicksAreRoundNumbersInsideTheAxis) {
  EXPECT_EQ(ticks(0, 10, false, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(ticks(1, 1000, true, 6), (std::vector<double>{1, 10, 100, 1000}));
  EXPECT_EQ(ticks(1, 20, true, 6), (std::vector<double>{1, 2, 5, 10, 20}));
  EXPECT_EQ(ticks(0.012, 1.4, true, 6), (std::vector<double>{0.02, 0.05, 0.1, 0.2, 0.5, 1}));  // not 0.1 and 1 alone
  EXPECT_TRUE(ticks(3, 3, false, 5).empty());
  EXPECT_EQ(ticks(0.21, 0.48, true, 3).size(), 2u);  // 0.3 and 0.4, where 1, 2 and 5 are not
  EXPECT_GE(ticks(0.0021, 0.0048, true, 6).size(), 3u);
  for (const double high : {1e-7, 0.3, 17.0, 9e6}) {
    const auto at = ticks(-high, high, false, 6);
    EXPECT_GE(at.size(), 3u);
    EXPECT_LE(at.size(), 14u);
  }
}

TEST(Plot, LabelsAreEscaped) {
  Plot plot;
  plot.title = "a < b & \"c\"";
  plot.series = {{"<script>", {0, 1}, {0, 1}}};
  const std::string text = svg(plot);
  EXPECT_NE(text.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_EQ(text.find("<script>"), std::string::npos);
}

TEST(Plot, ValuesThatCannotBeDrawnBreakTheLineAndNothingElse) {
  Plot plot;
  plot.y.logarithmic = true;
  plot.series = {{"s", {1, 2, 3, 4, 5}, {1, std::nan(""), 10, 0, 100}}};
  const std::string text = svg(plot);
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(text.find("inf"), std::string::npos);
  plot.series = {{"nothing", {}, {}}, {"one point", {2}, {2}}};
  EXPECT_EQ(svg(plot).find("nan"), std::string::npos);
  plot.series = {{"one logarithm", {1, 2}, {9e299, std::nextafter(9e299, 1e300)}}};
  EXPECT_EQ(svg(plot).find("nan"), std::string::npos);
}

TEST(Plot, PowersOfTenAreShort) {
  Plot plot;
  plot.x.logarithmic = plot.y.logarithmic = true;
  plot.series = {{"s", {1e-6, 1e6}, {1e-12, 1}}};
  const std::string text = svg(plot);
  for (const char* label : {">1e-6<", ">1e6<", ">1e-12<", ">1<"})
    EXPECT_NE(text.find(label), std::string::npos) << label;
  EXPECT_EQ(text.find("e-0"), std::string::npos);
  EXPECT_EQ(text.find("e+"), std::string::npos);
}

// Seven colors serve fourteen series: the points of the second seven are hollow.
TEST(Plot, SeriesBeyondThePaletteAreHollow) {
  Plot plot;
  plot.series.assign(8, {"s", {1}, {1}, Series::Style::kPoints});
  const auto hollow = [&] {
    const std::string text = svg(plot);
    int count = 0;
    for (auto at = text.find("fill=\"#fff\" stroke"); at != std::string::npos;
         at = text.find("fill=\"#fff\" stroke", at + 1))
      ++count;
    return count;
  };
  EXPECT_EQ(hollow(), 2);  // in the plot and in the legend
  plot.series.back().color = "black";
  EXPECT_EQ(hollow(), 0);
}

TEST(Plot, SheetHoldsEveryPlot) {
  Plot plot;
  plot.width = 300, plot.height = 200;
  const std::string text = svg({plot, plot, plot}, 2);
  EXPECT_NE(text.find("width=\"600\" height=\"400\""), std::string::npos);
}

}  // namespace
}  // namespace goniochrome::report::plot_test
