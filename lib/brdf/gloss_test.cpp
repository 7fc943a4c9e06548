#include "brdf/gloss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "brdf/internal/gloss_meter_for_test.h"

namespace goniochrome::brdf::gloss_test {
namespace {

const std::vector<double> kBasis = {1.3, 6, 20, 70, 250, 900, 3000};
constexpr double kMirror = std::numeric_limits<double>::infinity();

paint::LobeFit empty_fit(bool mirror = true) {
  paint::LobeFit fit;
  for (const double e : kBasis) fit.lobes.push_back({e, {}, {}});
  if (mirror) fit.lobes.push_back({kMirror, {}, {}});
  return fit;
}

const GlossTable& table() {
  static const GlossTable made(kBasis);
  return made;
}

// The meter by brute force: unit vectors, the plain dot product, one dense product rule over both windows.
double brute_force_gloss(const TestMeter& meter, double exponent, int source_points, int receptor_points) {
  const auto source = window_points(meter.angle_deg, kSourceParallel_deg, kSourcePerpendicular_deg, source_points);
  const auto receptor =
      window_points(meter.angle_deg, meter.receptor_par_deg, meter.receptor_perp_deg, receptor_points);
  double numerator = 0, denominator = 0;
  for (const WindowPoint& i : source) {
    denominator += i.solid_angle * i.w.z * fresnel_dielectric(i.w.z, kBlackGlassIndex);
    for (const WindowPoint& o : receptor)
      numerator += i.solid_angle * o.solid_angle * o.w.z * std::pow(std::max(0.0, dot(i.w, o.w)), exponent);
  }
  return 100 * numerator / denominator;
}

TEST(Gloss, QuadratureMatchesBruteForce) {
  const std::vector<double> exponents = {0, 1.3, 70, 900, 3000, 30000};
  const GlossTable many(exponents);
  for (const TestMeter& meter : kTestMeters)
    for (std::size_t j = 0; j < exponents.size(); ++j) {
      const double brute = brute_force_gloss(meter, exponents[j], 6, exponents[j] > 5000 ? 96 : 40);
      EXPECT_NEAR((*many.at(meter.angle_deg))->gloss[j] / brute, 1, 1e-4) << meter.angle_deg << " " << exponents[j];
    }
}

TEST(Gloss, VerySharpLobeReadsAsTheMirrorOfItsEnergy) {
  const GlossTable sharp({1e6});
  for (const TestMeter& meter : kTestMeters) {
    const GlossColumns& columns = **sharp.at(meter.angle_deg);
    // All of a unit-energy lobe enters the receptor: 100 / F_1.567, averaged over the source (its cosines vary).
    const double energy_one = (1e6 + 1) / (2 * kPi) * columns.gloss[0];
    const double f = fresnel_dielectric(std::cos(meter.angle_deg * kDegree), kCoatIndex);
    EXPECT_NEAR(energy_one * f / columns.mirror, 1, 1e-3) << meter.angle_deg;
  }
}

TEST(Gloss, ClosedFormSeedIsNear) {
  // G ~ 100 F/F_1.567 erf(w_par/2 sqrt(e/2)) erf(w_perp/2 sqrt(e/2)) has no cosines and a source without width, which
  // matters most at 20 deg, where the receptor is only 1.8 deg wide: 10 % at e = 3000.
  for (const TestMeter& meter : kTestMeters)
    for (const double e : {70.0, 250.0, 900.0, 3000.0}) {
      const GlossTable one({e});
      const double t = meter.angle_deg * kDegree, c = std::cos(t);
      const double seed = 100 / fresnel_dielectric(c, kBlackGlassIndex) *
                          std::erf(meter.receptor_par_deg / 2 * kDegree * std::sqrt(e / 2)) *
                          std::erf(meter.receptor_perp_deg / 2 * kDegree * std::sqrt(e / 2));
      const double ours = (*one.at(meter.angle_deg))->gloss[0] * (e + 1) / (2 * kPi);
      EXPECT_NEAR(ours / seed, 1, 0.12) << meter.angle_deg << " " << e;
    }
}

TEST(HardCase, GlossLimitsSmoothCoatReadsThePublishedValues) {
  // Published from Fresnel factors of four digits (.0403/.0491): good to 0.1 GU.
  struct {
    double angle_deg, published;
  } const rows[] = {{20, 82.1}, {60, 89.1}, {85, 99.0}};
  // The control is the quintic in 1 - cos that often stands for Fresnel's equations.
  const auto quintic = [](double cosine, double index) {
    const double f = std::pow((index - 1) / (index + 1), 2);
    return f + (1 - f) * std::pow(1 - cosine, 5);
  };
  double ours = 0, textbook = 0;
  for (const auto& row : rows) {
    ours = worst_of(ours, std::abs((*table().at(row.angle_deg))->mirror - row.published));
    const double cosine = std::cos(row.angle_deg * kDegree);
    const double units = 100 * quintic(cosine, kCoatIndex) / quintic(cosine, kBlackGlassIndex);
    textbook = worst_of(textbook, std::abs(units - row.published));
  }
  hard_case("gloss-limits", {.what = "a smooth coat of index 1.5 at 20, 60 and 85 deg",
                             .textbook = textbook,
                             .ours = ours,
                             .bound = 0.1,
                             .unit = "GU"});
}

TEST(HardCase, GlossLimitsEndPointsAreExact) {
  double ours = 0, clipped = 0;
  for (const double angle : {20.0, 60.0, 85.0}) {
    paint::LobeFit fit = empty_fit();
    // 0 GU: nothing at all.
    auto misfit = set_gloss(table(), {{angle, 0}}, fit);
    ASSERT_TRUE(misfit.ok());
    for (const paint::Lobe& lobe : fit.lobes) EXPECT_EQ(lobe.gloss, color::Rgb{});
    EXPECT_EQ((*misfit)[0], 0);
    // The smooth limit: the mirror alone with weight 1.
    const double smooth = (*table().at(angle))->mirror;
    misfit = set_gloss(table(), {{angle, smooth}}, fit);
    EXPECT_NEAR(fit.lobes.back().gloss.x, 1, 1e-12);
    for (std::size_t j = 0; j + 1 < fit.lobes.size(); ++j) EXPECT_NEAR(fit.lobes[j].gloss.x, 0, 1e-9);
    // 100 GU: a little more mirror; beyond, the rest is told.
    misfit = set_gloss(table(), {{angle, 100}}, fit);
    EXPECT_NEAR(fit.lobes.back().gloss.x, 100 / smooth, 1e-12);
    ours = worst_of(ours, std::abs((*misfit)[0]));
    clipped = worst_of(clipped, 100 - smooth);
    misfit = set_gloss(table(), {{angle, 130}}, fit);
    EXPECT_NEAR((*misfit)[0], -30, 1e-10);
  }
  // The control lets no coat reflect more than a smooth one.
  hard_case("gloss-limits",
            {.what = "a reading of 100 GU", .textbook = clipped, .ours = ours, .bound = 1e-10, .unit = "GU"});
}

TEST(HardCase, GlossLimitsAnySingleReadingIsMet) {
  double ours = 0;
  for (const bool mirror : {true, false})
    for (const double angle : {20.0, 60.0, 85.0})
      for (double gu = 0.01; gu <= 100; gu *= 1.17) {
        paint::LobeFit fit = empty_fit(mirror);
        const auto misfit = set_gloss(table(), {{angle, gu}}, fit);
        ASSERT_TRUE(misfit.ok());
        // Without a mirror a reading is met as far as the sharpest lobe reads it with all that a coat reflects.
        const double all = fresnel_dielectric(std::cos(angle * kDegree), kCoatIndex);
        const double sharpest = (**table().at(angle)).gloss.back() * all * (kBasis.back() + 1) / (2 * kPi);
        if (!mirror && gu > sharpest) {
          EXPECT_NEAR((*misfit)[0], sharpest - gu, 1e-9);
          EXPECT_NEAR(fit.lobes.back().gloss.x * 2 * kPi / (kBasis.back() + 1), all, 1e-12);
          continue;
        }
        ours = worst_of(ours, std::abs((*misfit)[0]) / gu);
        int used = 0;
        for (const paint::Lobe& lobe : fit.lobes) {
          EXPECT_GE(lobe.gloss.x, 0);
          EXPECT_EQ(lobe.gloss.x, lobe.gloss.z);
          used += lobe.gloss.x > 0;
        }
        EXPECT_LE(used, 2);
      }
  // The control: the equivalent lobe put on the nearest exponent of the basis alone.
  const double energy = fresnel_dielectric(0.5, kCoatIndex);
  double worst = 0;
  for (double gu = 1; gu < 89; ++gu) {
    double nearest = INFINITY;
    for (std::size_t j = 0; j < kBasis.size(); ++j) {
      paint::LobeFit fit = empty_fit();
      fit.lobes[j].gloss = (energy * (kBasis[j] + 1) / (2 * kPi)) * color::Rgb{1, 1, 1};
      nearest = std::min(nearest, std::abs(gloss_units(table(), **table().at(60), fit) - gu));
    }
    worst = worst_of(worst, nearest / gu);
  }
  hard_case("gloss-limits", {.what = "any single reading from 0.01 to 100 GU",
                             .textbook = worst,
                             .ours = ours,
                             .bound = 1e-10,
                             .unit = "relative"});
}

TEST(HardCase, GlossLimitsImpossibleTriplesAreTold) {
  paint::LobeFit fit = empty_fit();
  // A smooth coat is possible, and found.
  auto misfit = set_gloss(table(), {{20, 82.1}, {60, 89.1}, {85, 99.0}}, fit);
  ASSERT_TRUE(misfit.ok());
  for (const double m : *misfit) EXPECT_NEAR(m, 0, 0.1);
  EXPECT_NEAR(fit.lobes.back().gloss.x, 1, 2e-3);
  // Glossy at 20 deg and dull at 85 is not.
  misfit = set_gloss(table(), {{20, 90}, {60, 40}, {85, 5}}, fit);
  ASSERT_TRUE(misfit.ok());
  double worst = 0;
  for (const double m : *misfit) worst = worst_of(worst, std::abs(m));
  EXPECT_GT(worst, 10);
  for (const paint::Lobe& lobe : fit.lobes) EXPECT_TRUE(std::isfinite(lobe.gloss.x) && lobe.gloss.x >= 0);
  // No such meter; no such reading.
  EXPECT_FALSE(set_gloss(table(), {{45, 50}}, fit).ok());
  EXPECT_FALSE(set_gloss(table(), {{60, -1}}, fit).ok());
  EXPECT_FALSE(set_gloss(table(), {{60, std::nan("")}}, fit).ok());
}

TEST(Gloss, DiffuseAndFlakeLightCountInTheReading) {
  paint::LobeFit white = empty_fit();
  white.diffuse = (1 / kPi) * color::Rgb{1, 1, 1};
  const double alone = gloss_units(table(), **table().at(60), white);
  EXPECT_NEAR(alone, 2.5, 0.2);  // cos x receptor / (pi F): a white card is not at 0
  const auto misfit = set_gloss(table(), {{60, 91.4}}, white);
  EXPECT_NEAR((*misfit)[0], 0, 1e-10);
  EXPECT_LT(white.lobes.back().gloss.x, 1.0);
  // It cannot read less than its own diffuse light.
  EXPECT_NEAR((*set_gloss(table(), {{60, 1}}, white))[0], alone - 1, 1e-10);
}

TEST(Gloss, NoReadingNoGloss) {
  paint::LobeFit fit = empty_fit();
  fit.lobes[2].gloss = {1, 1, 1};
  const auto misfit = set_gloss(table(), {}, fit);
  ASSERT_TRUE(misfit.ok());
  EXPECT_TRUE(misfit->empty());
  for (const paint::Lobe& lobe : fit.lobes) EXPECT_EQ(lobe.gloss, color::Rgb{});
}

// A smooth coat reads no more than its index allows: beyond that the index grows, up to that of the black glass, so
// that the mirror image is never scaled beyond Fresnel's equations.
TEST(Gloss, TheIndexOfACoatIsWhatItsGlossAsksFor) {
  EXPECT_EQ(*coat_index_of({}), paint::kNoCoat);
  EXPECT_EQ(*coat_index_of({{60, 0}}), paint::kNoCoat);
  EXPECT_EQ(*coat_index_of({{60, 5}}), kCoatIndex);
  EXPECT_NEAR(*coat_index_of({{60, 100}}), kBlackGlassIndex, 1e-9);
  EXPECT_NEAR(*coat_index_of({{60, 150}}), kBlackGlassIndex, 1e-9);
  EXPECT_FALSE(coat_index_of({{45, 90}}).ok());
  for (const double angle : kGlossAngles_deg)
    for (const double gu : {93.0, 96.0, 99.0}) {
      const double index = *coat_index_of({{angle, gu}});
      EXPECT_NEAR(*smooth_gloss(angle, index), std::max(gu, *smooth_gloss(angle, kCoatIndex)), 1e-6)
          << angle << " " << gu;
      paint::LobeFit fit = empty_fit();
      fit.coat_index = index;
      EXPECT_NEAR((*set_gloss(table(), {{angle, gu}}, fit))[0], 0, 1e-6);
      EXPECT_LE(fit.lobes.back().gloss.y, 1 + 1e-9);
      // The control: the usual index needs a mirror that sends back more than it gets at grazing angles.
      paint::LobeFit textbook = empty_fit();
      ASSERT_TRUE(set_gloss(table(), {{angle, gu}}, textbook).ok());
      if (gu > *smooth_gloss(angle, kCoatIndex)) {
        EXPECT_GT(textbook.lobes.back().gloss.y, 1);
      }
    }
}

TEST(Gloss, TheCoatOfAPaintIsWhatItStatesOrItsGlossAsksFor) {
  const auto index = [](std::optional<double> stated, const std::vector<paint::GlossReading>& gloss,
                        const std::vector<paint::GlossReading>& assumed = {}) {
    paint::Paint paint;
    paint.coat_index = stated, paint.gloss = gloss;
    return *coat_index_of_paint(paint, assumed);
  };
  EXPECT_EQ(index({}, {}), paint::kNoCoat);
  EXPECT_EQ(index({}, {{60, 40}}), kCoatIndex);
  EXPECT_EQ(index(1.6, {{60, 40}}), 1.6);
  EXPECT_NEAR(index(kCoatIndex, {{60, 100}}), kBlackGlassIndex, 1e-9);
  EXPECT_EQ(index(paint::kNoCoat, {{60, 100}}), paint::kNoCoat) << "a paint may say that it has none";
  EXPECT_EQ(index({}, {}, {{60, 40}}), kCoatIndex);
  EXPECT_EQ(index({}, {{60, 0}}, {{60, 40}}), paint::kNoCoat) << "readings go before those assumed";
}

// The base is read through the coat.
TEST(Gloss, ACoatTakesFromWhatTheBaseReads) {
  paint::LobeFit white = empty_fit();
  white.diffuse = (1 / kPi) * color::Rgb{1, 1, 1};
  const double bare = gloss_units(table(), **table().at(60), white);
  white.coat_index = 1.5;
  EXPECT_NEAR(gloss_units(table(), **table().at(60), white) / bare, coat_passages(1.5, 0.5, 0.5), 1e-12);
}

}  // namespace
}  // namespace goniochrome::brdf::gloss_test
