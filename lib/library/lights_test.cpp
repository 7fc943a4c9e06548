#include "library/lights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "base/scratch_for_test.h"
#include "color/spectrum.h"
#include "formats/xml.h"
#include "paint/spectra.h"

namespace goniochrome::library::lights_test {
namespace {

constexpr int kPaints = 200;
const std::vector<std::string> kLights = {"D65", "A", "F11"};

// A paint whose spectra are bands of random place, width and height, darker toward the flop.
paint::Paint random_paint(std::mt19937_64& random, const std::string& name) {
  std::uniform_real_distribution<double> number(0, 1);
  paint::Paint paint;
  paint.name = name;
  paint.measurement.emplace();
  const double center_nm = 420 + 260 * number(random), width_nm = 15 + 80 * number(random), height = number(random);
  for (const double angle_deg : {15.0, 45.0, 110.0}) {
    paint::SpectrumReading spectrum{{.aspecular_deg = angle_deg}, 400, 10, {}};
    for (double nm = 400; nm <= 700; nm += 10)
      spectrum.factors.push_back((0.05 + height * std::exp(-std::pow((nm - center_nm) / width_nm, 2))) * 15 /
                                 angle_deg);
    paint.measurement->spectra.push_back(spectrum);
  }
  auto lit = paint::under_light(*paint.measurement, {"D65", 10});
  EXPECT_TRUE(lit.ok());
  paint.measurement = *lit;
  return paint;
}

class Lights : public testing::Test {
 protected:
  Lights() {
    for (int i = 0; i < kPaints; ++i) paints_.push_back(random_paint(random_, "p" + std::to_string(i)));
    paints_[7] = paints_[3];  // a tie
    paints_[7].name = "p7";
    paints_[11].measurement->spectra.clear();
    write();
  }
  void write() {
    auto file = OutputFile::create(path_);
    auto writer = formats::PaintWriter::begin(std::move(*file));
    for (const paint::Paint& paint : paints_) EXPECT_TRUE(writer->write(paint).ok());
    EXPECT_TRUE(writer->finish().ok());
  }
  // The distance in one light by sums over the spectra, without rows, index or plan.
  static double distance_in(const std::string& light, const paint::Paint& x, const paint::Paint& y,
                            color::DifferenceFormula metric) {
    static std::map<std::string, color::SpectralColorimeter> meters;
    if (!meters.contains(light)) {
      std::vector<double> nm;
      for (int i = 0; i < 31; ++i) nm.push_back(400 + 10 * i);
      meters.emplace(light, *color::SpectralColorimeter::make(nm, {light, 10}));
    }
    const color::SpectralColorimeter* meter = &meters.at(light);
    double sum = 0;
    for (std::size_t g = 0; g < 3; ++g) {
      const color::Lab a = meter->lab(x.measurement->spectra[g].factors),
                       b = meter->lab(y.measurement->spectra[g].factors);
      sum += metric == kDe76 ? color::delta_e_76(a, b) : color::delta_e_2000(a, b);
    }
    return sum;
  }
  std::mt19937_64 random_{5};
  std::vector<paint::Paint> paints_;
  ScratchFolder folder_;
  std::string path_ = folder_.path("library.paints.xml");
};

TEST_F(Lights, TheNearestAreThoseOfALookAtEveryPaintInEveryLight) {
  for (const color::DifferenceFormula& metric : {kDe76, kDe00}) {
    const auto search = LightsSearch::open(path_, kLights, {.count = 5, .metric = metric});
    ASSERT_TRUE(search.ok()) << search.error().message;
    EXPECT_EQ(search->without_spectra(), 1U);
    int other_than_by_daylight = 0;
    for (int q = 0; q < 10; ++q) {
      const paint::Paint query = q == 0 ? paints_[3] : random_paint(random_, "query");
      std::vector<std::pair<double, std::uint32_t>> all, daylight;
      for (std::uint32_t i = 0; i < kPaints; ++i) {
        if (i == 11) continue;
        double most = 0;
        for (const std::string& light : kLights) most = std::max(most, distance_in(light, query, paints_[i], metric));
        all.emplace_back(most, i);
        daylight.emplace_back(distance_in("D65", query, paints_[i], metric), i);
      }
      std::ranges::sort(all);
      std::ranges::sort(daylight);
      const auto plan = search->plan(query);
      ASSERT_TRUE(plan.ok()) << plan.error().message;
      const auto matches = search->nearest(*plan);
      ASSERT_EQ(matches.size(), 5U);
      for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_EQ(matches[i].match.paint, all[i].second) << q;
        // The file has all digits of the factors, and the sums have the same order.
        EXPECT_NEAR(matches[i].match.distance, all[i].first, 1e-9);
        EXPECT_NEAR(distance_in(kLights[matches[i].light], query, paints_[all[i].second], metric), all[i].first, 1e-9);
        other_than_by_daylight += all[i].second != daylight[i].second;
      }
    }
    EXPECT_GT(other_than_by_daylight, 5) << "the control: daylight alone finds other paints";
  }
}

TEST_F(Lights, AQueryWithoutSpectraIsRefused) {
  const auto search = LightsSearch::open(path_, kLights, {});
  const auto plan = search->plan(paints_[11]);
  ASSERT_FALSE(plan.ok());
  EXPECT_NE(plan.error().message.find("it has no spectra"), std::string::npos);
}

}  // namespace
}  // namespace goniochrome::library::lights_test
