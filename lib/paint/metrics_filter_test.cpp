#include "paint/metrics_filter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace goniochrome::paint {
namespace {

using testing::HasSubstr;

Paint red() {
  Paint paint;
  paint.name = "RM331";
  paint.code = "x 1";
  paint.paint_class = PaintClass::kMetallic;
  return paint;
}

PaintMetrics numbers() {
  PaintMetrics n;
  n.flop_index = 17;
  n.chroma_index = 4.5;
  n.hue_travel_deg = -12;
  n.flags = {"dark"};
  n.source = PaintMetrics::Source::kRows;
  return n;
}

bool matches(std::string_view condition) {
  const auto filter = PaintFilter::parse(condition);
  if (!filter.ok()) {
    ADD_FAILURE() << filter.error().message;
    return false;
  }
  return filter->matches(red(), numbers());
}

std::string complaint(std::string_view condition) {
  const auto filter = PaintFilter::parse(condition);
  if (filter.ok()) return "accepted";
  EXPECT_EQ(filter.error().kind, ErrorKind::kUsage);
  return filter.error().message;
}

TEST(PaintFilter, comparisons) {
  EXPECT_TRUE(matches("flop_index>=17 && chroma_index<5"));
  EXPECT_FALSE(matches("flop_index > 17"));
  EXPECT_TRUE(matches("flop_index==17"));
  EXPECT_TRUE(matches("17 <= flop_index"));
  EXPECT_TRUE(matches("flop_index != 16.5"));
  EXPECT_TRUE(matches("hue_travel_deg<-11.5"));
  EXPECT_TRUE(matches("hue_travel_deg < +1e+1"));
  EXPECT_TRUE(matches("chroma_index < flop_index"));
}

TEST(PaintFilter, precedence_and_words) {
  EXPECT_TRUE(matches("flop_index>0 or flop_index<0 and flop_index<0"));
  EXPECT_FALSE(matches("(flop_index>0 or flop_index<0) and flop_index<0"));
  EXPECT_TRUE(matches("not flop_index<0 && !(chroma_index>5)"));
  EXPECT_TRUE(matches("! ! flop_index>0"));
}

TEST(PaintFilter, texts) {
  EXPECT_TRUE(matches("class==metallic"));
  EXPECT_TRUE(matches("class != solid"));
  EXPECT_TRUE(matches("name == RM331"));
  EXPECT_TRUE(matches("code == 'x 1' and code==\"x 1\""));
  EXPECT_TRUE(matches("flags==dark and flags!=gamut and source==rows"));
  EXPECT_TRUE(matches("metallic == class"));
}

TEST(PaintFilter, not_applicable) {
  EXPECT_FALSE(matches("gloss<1000"));
  EXPECT_FALSE(matches("gloss>=0"));
  EXPECT_FALSE(matches("gloss!=3"));
  EXPECT_TRUE(matches("not gloss<1000"));
  EXPECT_TRUE(matches("gloss==na"));
  EXPECT_TRUE(matches("na != flop_index"));
}

TEST(PaintFilter, errors_name_the_place) {
  EXPECT_THAT(complaint("flop_idx>3"), HasSubstr("\"flop_idx\" at character 1 is no metric; did you mean flop_index?"));
  EXPECT_THAT(complaint("flop_index>3 && zzzzzzzzzzzz<1"), HasSubstr("there are flop_index, "));
  EXPECT_THAT(complaint("flop_index>"), HasSubstr("ends where a name or a number is needed"));
  EXPECT_THAT(complaint(""), HasSubstr("ends where"));
  EXPECT_THAT(complaint("flop_index"), HasSubstr("a comparison"));
  EXPECT_THAT(complaint("flop_index=3"), HasSubstr("write \"==\""));
  EXPECT_THAT(complaint("flop_index>3 & gloss>2"), HasSubstr("write it twice"));
  EXPECT_THAT(complaint("(flop_index>3"), HasSubstr("\")\""));
  EXPECT_THAT(complaint("flop_index>3)"), HasSubstr("\")\" at character 13"));
  EXPECT_THAT(complaint("flop_index>3 gloss>1"), HasSubstr("\"and\", \"or\" or the end"));
  EXPECT_THAT(complaint("flop_index>3,5"), HasSubstr("\",\" at character 13"));
  EXPECT_THAT(complaint("flop_index>12abc"), HasSubstr("\"12abc\" at character 12 is no metric"));
  EXPECT_THAT(complaint("class>solid"), HasSubstr("class is a text"));
  EXPECT_THAT(complaint("class==metalic"), HasSubstr("there is no class \"metalic\""));
  EXPECT_THAT(complaint("name=='RM"), HasSubstr("not closed"));
  EXPECT_THAT(complaint("gloss<na"), HasSubstr("na has no order"));
  EXPECT_THAT(complaint(std::string(100000, '(')), HasSubstr("nested too deeply"));
  EXPECT_THAT(complaint(std::string(100000, '!')), HasSubstr("nested too deeply"));
}

TEST(MetricRange, bounds_and_errors) {
  const auto range = parse_metric_range("flop_index=3:10");
  ASSERT_TRUE(range.ok());
  EXPECT_TRUE(range->contains(3) && range->contains(10) && !range->contains(10.001));
  EXPECT_FALSE(range->contains(std::numeric_limits<double>::quiet_NaN()));
  EXPECT_TRUE(parse_metric_range("gloss=:5")->contains(-1e9));
  EXPECT_TRUE(parse_metric_range("gloss=5:")->contains(1e9));
  for (const char* wrong : {"flop_index", "flop_index=3", "flop_indx=3:4", "flop_index=a:4", "flop_index=4:3", "=1:2"})
    EXPECT_FALSE(parse_metric_range(wrong).ok()) << wrong;
  EXPECT_THAT(parse_metric_range("flop_indx=3:4").error().message, HasSubstr("did you mean flop_index?"));
}

}  // namespace
}  // namespace goniochrome::paint
