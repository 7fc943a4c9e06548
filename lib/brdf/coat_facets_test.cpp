#include "brdf/coat_facets.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "brdf/gloss.h"
#include "brdf/true_coat_for_test.h"

namespace goniochrome::brdf::coat_facets_test {
namespace {

const TrueCoat kCoats[] = {{0, 0.004, 0.3},       {0, 0.25, 0.3},       {1.2, 0.008, 0.3},      {2.9, 0.02, 0.45},
                           {0, 0.004, 0.3, true}, {0, 0.25, 0.3, true}, {1.2, 0.008, 0.3, true}};

RoughCoat ours(const TrueCoat& coat) {
  return {coat.k, coat.slope, coat.haze, coat.beckmann ? Slopes::kGaussian : Slopes::kGgx};
}

Vec3 direction(double deg, double azimuth_deg = 0) {
  const double t = deg * kDegree, p = azimuth_deg * kDegree;
  return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
}

// Both are double sums of the same equation: some rounding of the sine of the half vector, which the exponent of
// Gaussian slopes magnifies, and an error function that is known to 1.5e-7.
TEST(CoatFacets, SendWhatThePaperSays) {
  for (const TrueCoat& coat : kCoats) {
    const CoatFacets facets(ours(coat), 1.5);
    for (const double view : {0.0, 30.0, 60.0, 85.0})
      for (const double light : {1.0, 29.7, 61.0, 88.0})
        for (const double azimuth : {0.0, 90.0, 179.0}) {
          const double truth = coat.f_cos(direction(light, azimuth), direction(view));
          EXPECT_NEAR(facets.sent(direction(light, azimuth), direction(view)).f_cos, truth,
                      (coat.beckmann ? 1e-6 : 1e-9) * truth + 1e-300);
        }
    EXPECT_EQ(facets.sent(direction(91), direction(20)).f_cos, 0);
  }
}

// The light within rings around the mirror direction: the mean of f cos_i/p over directions that are drawn is that of
// facets drawn by the test. A wrong density shows in some ring. 20,000 directions spread evenly: 1 % of all the light.
TEST(CoatFacets, AreDrawnByTheDensityTheyTell) {
  constexpr int kCount = 20000;
  constexpr double kRings_deg[] = {0.5, 2, 5, 15, 40, 180};
  for (const TrueCoat& coat : kCoats) {
    const CoatFacets facets(ours(coat), 1.5);
    for (const double view : {0.0, 45.0, 80.0}) {
      const Vec3 out = direction(view), axis = {-out.x, 0, out.z};
      double mean[6] = {}, truth[6] = {};
      const auto add = [&](double* rings, const Vec3& light, double energy) {
        const double deg = std::atan2(length(cross(axis, light)), dot(axis, light)) / kDegree;
        for (int k = 0; k < 6; ++k)
          if (deg <= kRings_deg[k]) rings[k] += energy;
      };
      constexpr double kGolden = 1.22074408460575947536;  // evenly spread triples [Roberts]
      for (int i = 0; i < kCount; ++i) {
        const auto number = [i](int power) { return std::fmod(0.5 + i / std::pow(kGolden, power), 1); };
        const Vec3 light = facets.drawn(out, number(1), number(2), number(3));
        const CoatFacets::Sent sent = facets.sent(light, out);
        if (sent.pdf > 0) add(mean, light, sent.f_cos / sent.pdf / kCount);
      }
      coat.each_light(out, 100000, [&](const Vec3& light, double energy) { add(truth, light, energy); });
      for (int k = 0; k < 6; ++k)
        EXPECT_NEAR(mean[k], truth[k], 0.01 * truth[5]) << coat.slope << " " << view << " " << k;
    }
  }
}

// A dense sum over the disc, of which 1e-9 and less is nothing beside peaks of 100 and more. The control is one
// direction in its middle.
TEST(CoatFacets, GatherADisc) {
  constexpr double kNothing = 1e-9;
  double control = 0;
  for (const TrueCoat& coat : kCoats) {
    const CoatFacets facets(ours(coat), 1.5);
    for (const double view : {10.0, 60.0, 80.0})
      for (const double radius_deg : {0.27, 3.0})
        for (const double apart_deg : {0.0, 0.2, 1.0, 6.0}) {
          const Vec3 out = direction(view), middle = direction(view - apart_deg, 180);
          const double radius = radius_deg * kDegree;
          constexpr int kRadii = 100, kAround = 50;  // half of the disc, whose other half mirrors it
          double truth = 0;
          const Vec3 y = {0, 1, 0}, x = cross(y, middle);
          for (int i = 0; i < kRadii; ++i)
            for (int j = 0; j < kAround; ++j) {
              const double t = radius * (i + 0.5) / kRadii, p = kPi * (j + 0.5) / kAround;
              const Vec3 light =
                  std::cos(t) * middle + (std::sin(t) * std::cos(p)) * x + (std::sin(t) * std::sin(p)) * y;
              if (light.z > 0) truth += radius / kRadii * 2 * kPi / kAround * std::sin(t) * coat.f_cos(light, out);
            }
          truth /= kPi * std::pow(std::sin(radius), 2);
          const double found = facets.over_disc(out, middle, radius);
          EXPECT_NEAR(found, truth, 0.06 * truth + kNothing)
              << coat.slope << " " << view << " " << radius_deg << " " << apart_deg;
          control = std::max(control, std::abs(coat.f_cos(middle, out) / truth - 1));
        }
  }
  EXPECT_GT(control, 1);
}

// The three readings of a coat go into lobes, and come back out of them. No lobe of this basis is as narrow as a coat
// that meters take for a mirror at 60 and 85 deg, so that its lobes miss a reading by more.
TEST(CoatFacets, LobesTellTheirCoat) {
  const GlossTable table({1.3, 6, 20, 70, 250, 900, 3000});
  for (const TrueCoat& coat : kCoats) {
    paint::LobeFit fit;
    fit.coat_index = 1.5;
    fit.diffuse = {0.1, 0.05, 0.02};
    for (const double e : table.exponents()) fit.lobes.push_back({e, {0.1, 0.1, 0.2}, {}});
    fit.lobes.push_back({paint::kMirrorExponent, {}, {}});
    std::vector<paint::GlossReading> readings;
    for (const double angle : kGlossAngles_deg)
      readings.push_back({angle, *coat_reading(ours(coat), angle, 1.5) + gloss_units(table, **table.at(angle), fit)});
    ASSERT_TRUE(set_gloss(table, readings, fit).ok());
    EXPECT_FALSE(coat_of_lobes(fit, 20)) << "one set for all views";
    ASSERT_TRUE(set_gloss_views(table, readings, fit).ok());
    const std::optional<RoughCoat> found = coat_of_lobes(fit, 20);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->slopes, ours(coat).slopes) << coat.slope;
    const bool narrow = coat.beckmann && coat.slope < 0.005;
    for (const double angle : kGlossAngles_deg)
      EXPECT_NEAR(*coat_reading(*found, angle, 1.5), *coat_reading(ours(coat), angle, 1.5), narrow ? 0.75 : 0.1)
          << coat.slope;
  }
  EXPECT_FALSE(coat_of_lobes({}, 45));
}

}  // namespace
}  // namespace goniochrome::brdf::coat_facets_test
