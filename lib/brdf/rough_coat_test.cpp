#include "brdf/rough_coat.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "brdf/gloss.h"
#include "brdf/true_coat_for_test.h"

namespace goniochrome::brdf::rough_coat_test {
namespace {

const std::vector<double> kBasis = {1.3, 6, 20, 70, 250, 900, 3000};

const GlossTable& table() {
  static const GlossTable made(kBasis);
  return made;
}

constexpr int kDirections = 3000;  // for each of 36 points of the source: 0.1 GU

std::vector<paint::GlossReading> readings_of(const TrueCoat& coat) {
  std::vector<paint::GlossReading> readings;
  for (const TestMeter& meter : kTestMeters)
    readings.push_back({meter.angle_deg, true_reading(coat, meter, kDirections)});
  return readings;
}

RoughCoat ours(const TrueCoat& coat) {
  return {coat.k, coat.slope, coat.haze, coat.beckmann ? Slopes::kGaussian : Slopes::kGgx};
}

// A paint of gloss alone, with views.
paint::LobeFit coated(const std::vector<paint::GlossReading>& readings) {
  paint::LobeFit fit;
  fit.coat_index = 1.5;
  for (const double e : kBasis) fit.lobes.push_back({e, {}, {}});
  fit.lobes.push_back({paint::kMirrorExponent, {}, {}});
  EXPECT_TRUE(set_gloss(table(), readings, fit).ok());
  EXPECT_TRUE(set_gloss_views(table(), readings, fit).ok());
  return fit;
}

// The meter by one dense product rule over both windows, of the lobes as engines draw them: weights between views,
// Fresnel at the half vector.
double shown_reading(const paint::LobeFit& fit, const TestMeter& meter, double gloss_deg) {
  const auto source = window_points(meter.angle_deg, kSourceParallel_deg, kSourcePerpendicular_deg, 4),
             receptor = window_points(meter.angle_deg, meter.receptor_par_deg, meter.receptor_perp_deg, 32);
  double numerator = 0, mirror = 0, denominator = 0;
  for (const WindowPoint& i : source) {
    const Vec3 light = {-i.w.x, -i.w.y, i.w.z};
    denominator += i.solid_angle * i.w.z * TrueCoat::fresnel(i.w.z, 1.567);
    const paint::LobeFit there = at_view(fit, std::acos(i.w.z) / kDegree);
    for (const paint::Lobe& lobe : there.lobes)
      if (lobe.is_mirror()) mirror += i.solid_angle * i.w.z * lobe.gloss.y * TrueCoat::fresnel(i.w.z, 1.5);
    for (const WindowPoint& o : receptor)
      numerator += i.solid_angle * o.solid_angle * i.w.z * o.w.z * coated_brdf(fit, light, o.w, {0, 0, 1}, gloss_deg).y;
  }
  return 100 * (numerator + mirror) / denominator;
}

TEST(RoughCoat, ReadingsAreThoseOfFacetsDrawnAtRandom) {
  for (const TrueCoat& coat :
       {TrueCoat{0, 0.003, 0.3}, TrueCoat{0, 0.05, 0.3}, TrueCoat{0, 0.4, 0.3}, TrueCoat{1.1, 0.009, 0.3},
        TrueCoat{2.5, 0.02, 0.2}, TrueCoat{0, 0.003, 0.3, true}, TrueCoat{0, 0.05, 0.3, true},
        TrueCoat{0, 0.4, 0.3, true}, TrueCoat{1.1, 0.009, 0.3, true}})
    for (const TestMeter& meter : kTestMeters)
      EXPECT_NEAR(*coat_reading(ours(coat), meter.angle_deg, 1.5), true_reading(coat, meter, 8 * kDirections), 0.25)
          << coat.k << " " << coat.slope << " " << meter.angle_deg;
}

// Each ring has one share, that of its mean (wi.h)^2 = m: exp(-k m) falls short of the mean by k^2/2 times the variance
// of (wi.h)^2, at most 0.04 in the wide rings, which hold less than half of the light.
TEST(RoughCoat, RingsHoldTheLightOfFacetsDrawnAtRandom) {
  for (const TrueCoat& coat : {TrueCoat{0, 0.004, 0.3}, TrueCoat{0, 0.1, 0.3}, TrueCoat{1.1, 0.009, 0.4},
                               TrueCoat{0, 0.02, 0.3, true}, TrueCoat{1.1, 0.009, 0.3, true}})
    for (const std::size_t view : {0U, 3U, 5U, 8U, 11U, 13U}) {
      const double t = kCoatViews_deg[view] * kDegree;
      const Vec3 out = {std::sin(t), 0, std::cos(t)}, axis = {-out.x, 0, out.z};
      std::vector<double> within(ring_angles_rad().size());
      const double mirror = TrueCoat::fresnel(out.z, 1.5);
      coat.each_light(out, 200000, [&](const Vec3& light, double energy) {
        const double angle = std::atan2(length(cross(axis, light)), dot(axis, light));
        const auto ring = std::ranges::lower_bound(ring_angles_rad(), angle) - ring_angles_rad().begin();
        if (ring < std::ssize(within)) within[ring] += energy / mirror;
      });
      std::partial_sum(within.begin(), within.end(), within.begin());
      const std::vector<double> found = coat_within(ours(coat), view);
      for (std::size_t k = 0; k < within.size(); ++k)
        EXPECT_NEAR(found[k], within[k], coat.beckmann ? 1.2e-2 : 1e-2)
            << coat.slope << " " << kCoatViews_deg[view] << " " << k;
    }
}

// The gloss levels of the Master Painters Institute pair 60 with 85 deg: G1 below 5 with below 10, G2 below 10 with 10
// to 35, G3 10 to 25 with 10 to 35, G4 20 to 35 with 35 and more. The control has one width for all angles (k = 0),
// whose satin is as dull at 85 deg as at 60.
TEST(RoughCoat, OneReadingGoesWithItsGlossLevel) {
  struct {
    double at_60, low_85, high_85;
  } const levels[] = {{3, 0, 10},   {4.8, 0, 10}, {6, 10, 35},   {9, 10, 35},
                      {15, 10, 35}, {19, 10, 35}, {22, 35, 100}, {34, 35, 100}};
  for (const auto& level : levels) {
    const RoughCoat coat = **rough_coat_of({{60, level.at_60}}, 1.5);
    EXPECT_NEAR(*coat_reading(coat, 60, 1.5), level.at_60, 1e-9);
    EXPECT_GE(*coat_reading(coat, 85, 1.5), level.low_85) << level.at_60;
    EXPECT_LE(*coat_reading(coat, 85, 1.5), level.high_85) << level.at_60;
    EXPECT_LT(*coat_reading(coat, 20, 1.5), level.at_60 / 4);
  }
  const RoughCoat satin = **rough_coat_of({{60, 60}}, 1.5);
  EXPECT_NEAR(*coat_reading(satin, 20, 1.5), 18, 3);
  EXPECT_NEAR(*coat_reading(satin, 85, 1.5), 88, 5);
  EXPECT_NEAR(*coat_reading({0, 0.0205, 0.3}, 85, 1.5), 60, 3) << "the control";
  EXPECT_FALSE(*rough_coat_of({{60, 88.6}}, 1.5)) << "smooth";
  EXPECT_FALSE(*rough_coat_of({}, 1.5));
  EXPECT_FALSE(rough_coat_of({{45, 50}}, 1.5).ok());
}

// How slopes are distributed, and on how many scales, follows from readings that are simulated by random facets. The
// control is the two scales of GGX that fit a Gaussian surface best, which miss its readings by several GU. Readings
// that are off by a tenth still tell the distribution of nearly all surfaces.
TEST(RoughCoat, ReadingsTellHowSlopesAreDistributed) {
  TestNumbers next(7);
  int told = 0, told_noisy = 0, count = 0;
  for (TrueCoat coat : true_coats())
    for (const bool gaussian : {false, true}) {
      coat.beckmann = gaussian;
      std::vector<paint::GlossReading> readings = readings_of(coat);
      const auto is_told = [&](const RoughCoat& found) {
        return found.slopes == ours(coat).slopes && (found.k == 0) == (coat.k == 0);
      };
      const RoughCoat found = **rough_coat_of(readings, 1.5);
      if (coat.k == 0) {
        EXPECT_TRUE(is_told(found)) << coat.slope;
        EXPECT_NEAR(found.slope / coat.slope, 1, 0.02) << coat.slope;  // readings are simulated to 0.1 GU
      }
      for (const paint::GlossReading& reading : readings)
        EXPECT_NEAR(*coat_reading(found, reading.angle_deg, 1.5), reading.gloss_units, 0.3) << coat.slope;
      told += is_told(found) ? 1 : 0, ++count;
      for (paint::GlossReading& reading : readings) reading.gloss_units += 0.2 * (next() - 0.5);
      told_noisy += is_told(**rough_coat_of(readings, 1.5)) ? 1 : 0;
    }
  EXPECT_GE(told, 0.95 * count);
  EXPECT_GE(told_noisy, 0.9 * count);
  const TrueCoat sharp{0, 0.017, 0.3, true};
  const std::vector<paint::GlossReading> readings = readings_of(sharp);
  double best = 1e9;
  for (int i = 0; i < 40; ++i)
    for (int j = 0; j < 40; ++j)
      for (int k = 0; k < 40; ++k) {
        const RoughCoat control{0.075 * i, 0.005 * std::pow(10, j / 40.0), 0.02 * std::pow(30, k / 40.0)};
        double off = 0;
        for (std::size_t m = 0; m < readings.size() && off < best; ++m)
          off = std::max(off, std::abs(*coat_reading(control, readings[m].angle_deg, 1.5) - readings[m].gloss_units));
        best = std::min(best, off);
      }
  EXPECT_GT(best, 1) << "the control";
}

// The true coat of readings in tenths lies within the range, whose ends have the readings as well. The control has ten
// thousand times finer readings, which leave next to nothing open: it is the readings that tell too little.
TEST(RoughCoat, ReadingsLeaveARangeOfCoats) {
  int count = 0, within = 0;
  for (const TrueCoat& coat : true_coats())
    for (const Slopes slopes : {Slopes::kGgx, Slopes::kGaussian}) {
      const RoughCoat truth{coat.k, coat.slope, coat.haze, slopes};
      std::vector<paint::GlossReading> exact, tenths;
      for (const double angle : kGlossAngles_deg) {
        exact.push_back({angle, *coat_reading(truth, angle, 1.5)});
        tenths.push_back({angle, 0.1 * std::round(10 * exact.back().gloss_units)});
      }
      const auto range = *rough_coat_range(tenths, 1.5);
      if (coat.k == 0) {
        EXPECT_FALSE(range) << "one scale has no haze: " << coat.slope;
        continue;
      }
      ASSERT_TRUE(range) << coat.slope;
      EXPECT_EQ(range->probable, **rough_coat_of(tenths, 1.5));
      for (const RoughCoat& end : {range->least_haze, range->probable, range->most_haze})
        for (const paint::GlossReading& reading : tenths)
          EXPECT_NEAR(*coat_reading(end, reading.angle_deg, 1.5), reading.gloss_units, 0.25) << coat.slope;
      ++count;
      within += truth.haze >= range->least_haze.haze && truth.haze <= range->most_haze.haze ? 1 : 0;
      EXPECT_GT(range->most_haze.haze, 1.2 * range->least_haze.haze) << coat.slope;
      const auto narrow = *rough_coat_range(exact, 1.5, 1e-5);
      ASSERT_TRUE(narrow) << coat.slope;
      EXPECT_LT(narrow->most_haze.haze, 1.02 * narrow->least_haze.haze) << "the control: " << coat.slope;
    }
  EXPECT_EQ(count, 40);
  EXPECT_GE(within, 0.95 * count);
}

TEST(HardCase, GlossSatinMeetsThreeReadingsTogether) {
  std::vector<std::vector<paint::GlossReading>> all = {{{20, 18}, {60, 60}, {85, 88}}};
  for (TrueCoat coat : true_coats())
    for (const bool gaussian : {false, true}) {
      coat.beckmann = gaussian;
      all.push_back(readings_of(coat));
    }
  double met = 0, textbook = 0;
  for (const std::vector<paint::GlossReading>& readings : all) {
    const paint::LobeFit fit = coated(readings), control = coated({});
    paint::LobeFit one = control;
    one.views.clear();
    ASSERT_TRUE(set_gloss(table(), {readings[1]}, one).ok());
    for (std::size_t m = 0; m < 3; ++m) {
      const double off = std::abs(shown_reading(fit, kTestMeters[m], 20) - readings[m].gloss_units);
      met = worst_of(met, off);
      textbook = worst_of(textbook, std::abs(shown_reading(one, kTestMeters[m], 60) - readings[m].gloss_units));
    }
  }
  hard_case("gloss-satin", {.what = "readings at 20, 60 and 85 deg of a satin coat and of 80 rough dielectrics",
                            .textbook = textbook,
                            .ours = met,
                            .bound = 3,
                            .unit = "GU"});
}

}  // namespace
}  // namespace goniochrome::brdf::rough_coat_test
