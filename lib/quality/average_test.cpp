#include "quality/average.h"

#include <gtest/gtest.h>

#include "paint/spectra.h"
#include "quality/control_chart.h"

namespace goniochrome::quality::average_test {
namespace {

paint::Paint reading(const std::string& name, const color::Lab& lab) {
  paint::Paint paint;
  paint.name = name;
  paint.measurement = paint::Measurement{{}, "meter", {{{.aspecular_deg = 15}, lab}, {{.aspecular_deg = 45}, lab}}};
  return paint;
}

TEST(Average, HasMeanDeviationAndNumber) {
  std::vector<paint::Paint> readings = {reading("x", {50, 1, 2}), reading("x (2)", {52, 1, 2}),
                                        reading("x (3)", {54, 1, 5})};
  readings[2].measurement->rows.pop_back();
  readings[0].gloss = {{60, 80}, {20, 1}}, readings[1].gloss = readings[2].gloss = {{60, 83}};
  const auto average = quality::average(readings, false);
  ASSERT_TRUE(average.ok()) << average.error().message;
  EXPECT_EQ(average->paint.measurement->rows[0].lab, (color::Lab{52, 1, 3}));
  EXPECT_EQ(average->paint.measurement->rows[1].lab, (color::Lab{51, 1, 2}));
  EXPECT_EQ(average->scatter[0].readings, 3u);
  EXPECT_EQ(average->scatter[1].readings, 2u);
  EXPECT_NEAR(average->scatter[0].deviation.L, 2, 1e-12);
  EXPECT_NEAR(average->scatter[1].deviation.L, std::sqrt(2.0), 1e-12);
  ASSERT_EQ(average->paint.gloss.size(), 1u);
  EXPECT_EQ(average->paint.gloss.front().gloss_units, 82);
}

TEST(Average, KeepsTheSpanOfDatesAllCodesAndAllSerials) {
  std::vector<paint::Paint> readings = {reading("x", {50, 1, 2}), reading("x", {52, 1, 2}), reading("x", {52, 1, 2})};
  const char* dates[] = {"2021-11-27", "2021-11-26T09:00", ""};
  for (std::size_t i = 0; i < 3; ++i) readings[i].measurement->date = dates[i];
  readings[0].measurement->serial = readings[1].measurement->serial = "7", readings[2].measurement->serial = "8";
  readings[0].code = "X1", readings[2].code = "X2";
  const auto average = quality::average(readings, false);
  ASSERT_TRUE(average.ok());
  EXPECT_EQ(average->paint.measurement->date, "2021-11-26T09:00..2021-11-27");
  EXPECT_EQ(average->paint.measurement->serial, "7, 8");
  EXPECT_EQ(average->paint.code, "X1, X2");
}

TEST(Average, OfSpectraIsTheColorOfTheMeanSpectrum) {
  std::vector<paint::Paint> readings = {reading("x", {0, 0, 0}), reading("x", {0, 0, 0})};
  for (std::size_t i = 0; i < 2; ++i) {
    paint::Measurement& m = *readings[i].measurement;
    m.spectra = {{m.rows[0].geometry, 400, 10, std::vector<double>(31, i ? 0.7 : 0.1)}};
    m.rows[0].lab = *paint::lab_of(m.spectra[0], m.condition);
  }
  const auto average = quality::average(readings, false);
  ASSERT_TRUE(average.ok());
  const paint::Measurement& mean = *average->paint.measurement;
  EXPECT_NEAR(mean.spectra.at(0).factors[5], 0.4, 1e-15);
  EXPECT_EQ(mean.rows[0].lab, *paint::lab_of(mean.spectra[0], mean.condition));
  // The mean of L* would be 60.9: L* is no linear scale of light.
  EXPECT_NEAR(mean.rows[0].lab.L, 69.47, 0.01);
}

TEST(Average, NamesReadingsThatStandApartAndDropsThemWhereAsked) {
  std::vector<paint::Paint> readings;
  for (const double L : {50.0, 50.2, 49.9, 50.1, 57.0}) readings.push_back(reading("x", {L, 0, 0}));
  const auto kept = quality::average(readings, false), dropped = quality::average(readings, true);
  ASSERT_EQ(kept->outliers.size(), 1u);
  EXPECT_EQ(kept->outliers[0].place, 4u);
  EXPECT_NEAR(kept->paint.measurement->rows[0].lab.L, 51.44, 1e-9);
  EXPECT_NEAR(dropped->paint.measurement->rows[0].lab.L, 50.05, 1e-9);
  EXPECT_EQ(dropped->kept, 4u);
  readings.erase(readings.begin(), readings.begin() + 2);
  EXPECT_TRUE(quality::average(readings, true)->outliers.empty());  // three readings have no outlier
}

TEST(Average, RefusesReadingsThatDoNotBelongTogether) {
  std::vector<paint::Paint> readings = {reading("x", {50, 0, 0}), reading("x", {50, 0, 0})};
  readings[1].measurement->instrument = "other";
  EXPECT_FALSE(quality::average(readings, false).ok());
  readings[1] = reading("x", {50, 0, 0}), readings[1].measurement->condition.observer_deg = 2;
  EXPECT_FALSE(quality::average(readings, false).ok());
  readings[1].measurement.reset();
  EXPECT_FALSE(quality::average(readings, false).ok());
}

TEST(Average, OfOneReadingIsThatReading) {
  const paint::Paint one = reading("x", {50, 1, 2});
  EXPECT_EQ(quality::average({one}, true)->paint.measurement->rows[0].lab, one.measurement->rows[0].lab);
}

TEST(Average, NamesLoseTheMarksOfReadersAlone) {
  EXPECT_EQ(base_name("NISSAN 002 (S1)-LS (2)"), "NISSAN 002 (S1)-LS");
  EXPECT_EQ(base_name("red (2026-11-27T10:00:00Z)"), "red");
  EXPECT_EQ(base_name("red (2026-11-27) (3)"), "red");
  EXPECT_EQ(base_name("red (matt)"), "red (matt)");
  EXPECT_EQ(base_name(" (2)"), " (2)");
}

// The arithmetic of a chart, done by hand: ranges 1, 1, 2, 8 with the mean 3.
TEST(ControlChart, HasSigmaFromMovingRanges) {
  const ControlChart chart = control_chart({1, 2, 1, 3, 11});
  EXPECT_EQ(chart.ranges, (std::vector<double>{1, 1, 2, 8}));
  EXPECT_DOUBLE_EQ(chart.mean, 3.6);
  EXPECT_DOUBLE_EQ(chart.sigma, 3 / 1.128);
  EXPECT_DOUBLE_EQ(chart.range_limit, 3 * 3.267);
  EXPECT_TRUE(chart.beyond.empty());
  EXPECT_EQ(control_chart({1, 1.1, 1, 1.1, 1, 1.1, 1, 1.1, 1, 3}).beyond, std::vector<std::size_t>{9});
  EXPECT_EQ(control_chart({5}).sigma, 0);
}

}  // namespace
}  // namespace goniochrome::quality::average_test
