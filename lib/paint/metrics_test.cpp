#include "paint/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "paint/curve.h"

namespace goniochrome::paint::metrics_test {
namespace {

using testing::HasSubstr;

Paint measured(const std::vector<std::pair<double, color::Lab>>& rows) {
  Paint paint;
  paint.name = "test";
  paint.measurement = Measurement{};
  for (const auto& [aspecular_deg, lab] : rows)
    paint.measurement->rows.push_back({{.incidence_deg = 45, .aspecular_deg = aspecular_deg}, lab});
  return paint;
}

color::Lab polar(double L, double C, double hue_deg) {
  const double h = hue_deg * kDegree;
  return {L, C * std::cos(h), C * std::sin(h)};
}

bool has_flag(const PaintMetrics& numbers, std::string_view flag) {
  for (const char* f : numbers.flags)
    if (f == flag) return true;
  return false;
}

double textbook_flop_index(double L15, double L45, double L110) {
  return 2.69 * std::pow(L15 - L110, 1.11) / std::pow(L45, 0.86);
}

TEST(Metrics, FlopIndexOfAMetallicIsTheOneByHand) {
  // 2.69 * 80^1.11 / 50^0.86 by hand: 80^1.11 = 129.548, 50^0.86 = 28.916.
  EXPECT_NEAR(flop_index(100, 50, 20).value, 12.052, 1e-3);
  EXPECT_DOUBLE_EQ(flop_index(100, 50, 20).value, textbook_flop_index(100, 50, 20));
  EXPECT_FALSE(flop_index(100, 50, 20).unstable());
  EXPECT_EQ(flop_index(40, 40, 40).value, 0);
}

TEST(HardCase, FlopIndexDark) {
  // The textbook form has no value where the flop is lighter than the face; ours is the mirrored one, negative.
  hard_case("flop-index-dark", {.what = "flop index of a flop lighter than the face",
                                .textbook = textbook_flop_index(20, 50, 100) + textbook_flop_index(100, 50, 20),
                                .ours = std::abs(flop_index(20, 50, 100).value + flop_index(100, 50, 20).value),
                                .bound = 0,
                                .unit = "index"});

  // It explodes in the dark without a word: 0.1 in one L*, within any instrument's repeatability, moves it a lot.
  const double moved = textbook_flop_index(3, 0.2, 0.2) - textbook_flop_index(3, 0.3, 0.2);
  const FlopIndex dark = flop_index(3, 0.2, 0.2);
  hard_case("flop-index-dark", {.what = "change by 0.1 L* in the dark of which no warning tells",
                                .textbook = moved,
                                .ours = dark.unstable() ? std::max(0.0, moved - dark.sensitivity) : moved,
                                .bound = 0,
                                .unit = "index"});
  EXPECT_FALSE(std::isfinite(textbook_flop_index(3, 0, 0.2)));
  EXPECT_TRUE(flop_index(3, 0.2, 0.2).unstable());
  EXPECT_GT(flop_index(3, 0.2, 0.2).sensitivity, 9);
  EXPECT_TRUE(flop_index(3, 0.1, 0.2).unstable());
  EXPECT_TRUE(std::isinf(flop_index(3, 0.1, 0.2).sensitivity));
  EXPECT_TRUE(std::isnan(flop_index(3, 0, 0.2).value));
  EXPECT_TRUE(flop_index(3, 0, 0.2).unstable());
  EXPECT_TRUE(flop_index(0, 0, 0).unstable());
  EXPECT_TRUE(has_flag(*metrics(measured({{15, {3, 1, 2}}, {45, {0.2, 0, 0}}, {110, {0.2, 0, 0}}})), "dark"));
}

// The sensitivity holds for every move within 0.1, and is reached.
TEST(Metrics, FlopSensitivityIsTheWorstCase) {
  for (const auto& [a, b, c] :
       {std::array{100.0, 50.0, 20.0}, {20.0, 30.0, 60.0}, {10.05, 10.0, 10.0}, {5.0, 1.0, 1.0}}) {
    const FlopIndex index = flop_index(a, b, c);
    double worst = 0;
    for (int i = 0; i < 21 * 21 * 21; ++i) {
      const double x = a + (i % 21 - 10) * 0.01, y = b + (i / 21 % 21 - 10) * 0.01, z = c + (i / 441 - 10) * 0.01;
      worst = worst_of(worst, std::abs(flop_index(x, y, z).value - index.value));
    }
    EXPECT_LE(worst, index.sensitivity * (1 + 1e-9));
    EXPECT_NEAR(worst, index.sensitivity, 1e-6 * index.sensitivity + 1e-9);
  }
}

double textbook_hue_shift(const color::Lab& f, const color::Lab& g) {
  return std::abs(g.a * f.b - f.a * g.b) / std::sqrt(f.a * f.a + f.b * f.b);
}

TEST(Metrics, HueShiftAndChromaAreThoseByHand) {
  const color::Lab face = polar(60, 50, 30), flop = polar(20, 20, 60);
  EXPECT_NEAR(hue_shift_index(face, flop), 20 * std::sin(kPi / 6), 1e-12);
  EXPECT_DOUBLE_EQ(hue_shift_index(face, flop), textbook_hue_shift(face, flop));
  EXPECT_NEAR(chroma_index(face, flop), 30, 1e-12);
  EXPECT_NEAR(hue_travel(std::array{face, flop}).degrees, 30, 1e-12);
  EXPECT_NEAR(hue_travel(std::array{flop, face}).degrees, -30, 1e-12);
}

TEST(HardCase, HueShiftAchromatic) {
  // Gray face: the textbook form divides 0 by 0, or turns rounding into 15 units of hue shift.
  EXPECT_TRUE(std::isnan(textbook_hue_shift({50, 0, 0}, {20, 15, 0})));
  const double shift = hue_shift_index({50, 0, 1e-17}, {20, 15, 0});
  hard_case("hue-shift-achromatic", {.what = "hue shift made up for a gray face",
                                     .textbook = textbook_hue_shift({50, 0, 1e-17}, {20, 15, 0}),
                                     .ours = std::isnan(shift) ? 0 : shift,
                                     .bound = 0,
                                     .unit = "index"});
  const auto gray = *metrics(measured({{15, {50, 0, 1e-17}}, {45, {30, 5, 0}}, {110, {20, 15, 0}}}));
  EXPECT_TRUE(std::isnan(gray.hue_shift_index));
  EXPECT_TRUE(std::isnan(gray.hue_travel_deg));
  EXPECT_TRUE(has_flag(gray, "achromatic"));

  // Hue turned by 180 deg: the textbook form reads 0, as of a paint of one hue. The travel tells.
  const auto turned = *metrics(measured(
      {{15, polar(60, 40, 20)}, {25, polar(55, 40, 80)}, {45, polar(45, 35, 140)}, {110, polar(30, 30, 200)}}));
  EXPECT_NEAR(turned.hue_shift_index, 0, 1e-9);
  const double seen = textbook_hue_shift(polar(60, 40, 20), polar(30, 30, 200));
  hard_case("hue-shift-achromatic", {.what = "hue turned by 180 deg",
                                     .textbook = 180 - std::asin(seen / 30) / kDegree,
                                     .ours = std::abs(turned.hue_travel_deg - 180),
                                     .bound = 1e-9,
                                     .unit = "deg"});
  EXPECT_FALSE(has_flag(turned, "through_gray"));

  // Beyond a full turn it goes on counting.
  std::vector<std::pair<double, color::Lab>> winding;
  for (int i = 0; i <= 10; ++i) winding.emplace_back(15 + 9.5 * i, polar(50, 30, 45 * i));
  EXPECT_NEAR(hue_travel([&] {
                std::vector<color::Lab> path;
                for (const auto& row : winding) path.push_back(row.second);
                return path;
              }())
                  .degrees,
              450, 1e-9);

  // Straight through gray the sense of turning is noise, and is told.
  EXPECT_TRUE(hue_travel(std::array{polar(60, 40, 20), polar(30, 40, 200.5)}).through_gray);
}

TEST(Metrics, ComeFromRowsFromTheCurveOrFromAFit) {
  const Appearance appearance{polar(80, 40, 250), polar(20, 10, 260), 70, {}};
  Paint designed;
  designed.appearance = appearance;
  const auto from_curve = *metrics(designed);
  EXPECT_EQ(from_curve.source, PaintMetrics::Source::kCurve);
  EXPECT_TRUE(std::isnan(from_curve.residual_de00));
  EXPECT_EQ(from_curve.travel_deg, 70);

  Paint with_rows =
      measured({{15, lab_at(appearance, 15)}, {45, lab_at(appearance, 45)}, {110, lab_at(appearance, 110)}});
  with_rows.gloss = {{20, 80}, {60, 92}};
  const auto from_rows = *metrics(with_rows);
  EXPECT_EQ(from_rows.source, PaintMetrics::Source::kRows);
  EXPECT_DOUBLE_EQ(from_rows.flop_index, from_curve.flop_index);
  EXPECT_DOUBLE_EQ(from_rows.hue_shift_index, from_curve.hue_shift_index);
  EXPECT_EQ(from_rows.gloss, 92);
  EXPECT_EQ(from_rows.gloss_angle_deg, 60);
  EXPECT_LT(from_rows.residual_de00, 1e-5);
  EXPECT_NEAR(from_rows.travel_deg, 70, 1e-4);

  // Neither 15 nor 110 was measured: the fitted curve stands in, and says so.
  const auto fitted =
      *metrics(measured({{25, lab_at(appearance, 25)}, {45, lab_at(appearance, 45)}, {75, lab_at(appearance, 75)}}));
  EXPECT_EQ(fitted.source, PaintMetrics::Source::kFitted);
  EXPECT_NEAR(fitted.flop_index, from_curve.flop_index, 1e-3);

  // A stated curve that misses the rows has the residual of its worst row.
  with_rows.appearance = appearance;
  with_rows.appearance->flop.L += 5;
  const auto missed = *metrics(with_rows);
  EXPECT_DOUBLE_EQ(missed.residual_de00,
                   color::delta_e_2000(lab_at(appearance, 110), lab_at(*with_rows.appearance, 110)));

  const auto quick =
      *metrics(measured({{15, {50, 1, 2}}, {45, {40, 1, 2}}, {110, {30, 1, 2}}}), CurveFit::kWhereNeeded);
  EXPECT_TRUE(std::isnan(quick.travel_deg));
  EXPECT_FALSE(std::isnan(quick.flop_index));
}

TEST(Metrics, NoColorAndColorsOutsideTheGamutAreFlagged) {
  EXPECT_TRUE(has_flag(*metrics(Paint{}), "no_color"));
  EXPECT_TRUE(std::isnan(metrics(Paint{})->flop_index));
  const auto inside = *metrics(measured({{15, {50, 10, 10}}, {45, {40, 5, 5}}, {110, {30, 1, 2}}}));
  EXPECT_EQ(inside.gamut_de00, 0);
  const auto outside = *metrics(measured({{15, {50, -140, 20}}, {45, {40, 5, 5}}, {110, {30, 1, 2}}}));
  EXPECT_GT(outside.gamut_de00, 1);
  EXPECT_TRUE(has_flag(outside, "gamut"));
}

TEST(Metrics, RowsOffThePathAreLeftOut) {
  Paint paint = measured({{15, polar(60, 40, 20)}, {45, polar(45, 35, 30)}, {110, polar(30, 30, 40)}});
  paint.measurement->rows.push_back({{.incidence_deg = 15, .aspecular_deg = 15}, polar(90, 90, 200)});
  paint.measurement->rows.push_back({{.incidence_deg = 45, .aspecular_deg = -15}, polar(90, 90, 200)});
  paint.measurement->rows.push_back(
      {{.incidence_deg = 45, .aspecular_deg = 25, .out_of_plane = true, .azimuth_deg = 90}, polar(90, 90, 200)});
  EXPECT_NEAR(metrics(paint)->hue_travel_deg, 20, 1e-9);
}

TEST(Metrics, ColumnsHaveDistinctNames) {
  for (const MetricColumn& column : metric_columns()) EXPECT_EQ(find_metric(column.name), &column);
  EXPECT_EQ(find_metric("nonsense"), nullptr);
  EXPECT_EQ(metric_columns_without_fit().size(), metric_columns().size() - 2);
}

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

TEST(PaintFilter, ComparesNumbers) {
  EXPECT_TRUE(matches("flop_index>=17 && chroma_index<5"));
  EXPECT_FALSE(matches("flop_index > 17"));
  EXPECT_TRUE(matches("flop_index==17"));
  EXPECT_TRUE(matches("17 <= flop_index"));
  EXPECT_TRUE(matches("flop_index != 16.5"));
  EXPECT_TRUE(matches("hue_travel_deg<-11.5"));
  EXPECT_TRUE(matches("hue_travel_deg < +1e+1"));
  EXPECT_TRUE(matches("chroma_index < flop_index"));
}

TEST(PaintFilter, AndBindsMoreTightlyThanOr) {
  EXPECT_TRUE(matches("flop_index>0 or flop_index<0 and flop_index<0"));
  EXPECT_FALSE(matches("(flop_index>0 or flop_index<0) and flop_index<0"));
  EXPECT_TRUE(matches("not flop_index<0 && !(chroma_index>5)"));
  EXPECT_TRUE(matches("! ! flop_index>0"));
}

TEST(PaintFilter, ComparesTexts) {
  EXPECT_TRUE(matches("class==metallic"));
  EXPECT_TRUE(matches("class != solid"));
  EXPECT_TRUE(matches("name == RM331"));
  EXPECT_TRUE(matches("code == 'x 1' and code==\"x 1\""));
  EXPECT_TRUE(matches("flags==dark and flags!=gamut and source==rows"));
  EXPECT_TRUE(matches("metallic == class"));
}

TEST(PaintFilter, ANumberThatDoesNotApplyIsOnlyEqualToNa) {
  EXPECT_FALSE(matches("gloss<1000"));
  EXPECT_FALSE(matches("gloss>=0"));
  EXPECT_FALSE(matches("gloss!=3"));
  EXPECT_TRUE(matches("not gloss<1000"));
  EXPECT_TRUE(matches("gloss==na"));
  EXPECT_TRUE(matches("na != flop_index"));
}

TEST(PaintFilter, ErrorsNameThePlace) {
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

TEST(MetricRange, BoundsAreIncludedAndErrorsAreTold) {
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
}  // namespace goniochrome::paint::metrics_test
