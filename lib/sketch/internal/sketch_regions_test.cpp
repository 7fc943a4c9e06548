// How far regions of a picture disagree about its paint.
#include "sketch/internal/sketch_regions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "base/angles.h"
#include "sketch/internal/sketch_scene_for_test.h"

namespace goniochrome::sketch::sketch_regions_test {
namespace {

formats::Basis one_lobe() {
  return {"one", {4}, false};
}

// A gray base of reflectance .1 below a lobe of flake of this strength.
PaintWeights gray(double flake) {
  return {{(0.1 / kPi) * color::Rgb{1, 1, 1}, (flake / kPi) * color::Rgb{1, 1, 1}, {}, {}}};
}

double lightness(double reflectance) {
  return 116 * std::cbrt(reflectance) - 16;  // CIE 1976, above L* 8
}

// The jackknife of two regions by hand: sqrt(1/2 (d1^2 + d2^2)), of differences in lightness alone. The lobe of
// exponent 4 is nearly nothing at 110 deg, so that it leaves the color there alone.
TEST(SketchRegions, TheJackknifeIsThatByHand) {
  const PaintWeights found = gray(0.5), low = gray(0.4), high = gray(0.7);
  const std::vector<double> apart = apart_by_regions(one_lobe(), found, {low, high}, paint::kNoCoat);
  ASSERT_EQ(apart.size(), 5U);
  const auto at_45 = [](double weight) { return color::Lab{lightness(0.1 + weight * 0.25), 0, 0}; };
  const double d1 = color::delta_e_2000(at_45(0.5), at_45(0.4)), d2 = color::delta_e_2000(at_45(0.5), at_45(0.7));
  EXPECT_NEAR(apart[2], std::sqrt(0.5 * (d1 * d1 + d2 * d2)), 2e-3 * apart[2]);
  EXPECT_LT(apart[4], 0.01);
  EXPECT_EQ(apart_by_regions(one_lobe(), found, {found, found}, paint::kNoCoat)[0], 0);
}

struct Told {
  double places = 0, all = 0;  // at 45 deg: four standard errors by places alone, and what is told
  double off = 0;              // by how much the paint found is
};

// A picture of which a half gets this part of the light that the search knows: its lower half, or what faces down,
// which is spread evenly over it. Every pixel sees its own light.
enum class Half { kLower, kFacesDown };
Told told(double lit, Half half = Half::kLower) {
  constexpr int kSide = 32;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(0, 1);
  const SearchFitters fitters(sketch_scene::basis(), paint::kNoCoat);
  const PaintWeights paint =
      paint_weights(sketch_scene::basis(), sketch_scene::lobes(sketch_scene::random_paint(random)));
  SearchSamples samples;
  samples.columns = search_columns(sketch_scene::basis());
  std::vector<std::uint32_t> places;
  std::vector<double> up;
  for (int i = 0; i < kSide * kSide; ++i) {
    for (std::size_t k = 0; k < samples.columns; ++k) {
      const bool is_mirror = k + 1 == samples.columns;
      const double whole = k == 0      ? kPi
                           : is_mirror ? 0.04
                                       : 2 * kPi / (sketch_scene::basis().exponents[(k - 1) / 2] + 1);
      samples.light.push_back((0.3 + 0.7 * unit(random)) * whole * Vec3{1, 1, 1});
    }
    const color::Rgb all = shown_light(samples.columns_of(samples.size()), paint.all, {});
    up.push_back(2 * unit(random) - 1);
    samples.seen.push_back(((half == Half::kLower ? i < kSide * kSide / 2 : up.back() > 0) ? 1 : lit) * all);
    samples.importance.push_back(1);
    places.push_back(static_cast<std::uint32_t>(i));
  }
  const LobeSearch search(fitters, samples);
  const FoundPaint found = search.find(search);
  const Regions regions = regions_of_places(places, kSide);
  const auto without = without_each_region(search, found, regions, LobeSearch::Gloss::kFound);
  const color::Lab at_45 = instrument_lab(sketch_scene::basis(), found.weights, paint::kNoCoat, 45);
  return {4 * apart_by_regions(sketch_scene::basis(), found.weights, without, paint::kNoCoat)[2],
          told_by_regions(search, found, sketch_scene::basis(), paint::kNoCoat, regions, halves_by_height(up))[2],
          color::delta_e_2000(at_45, instrument_lab(sketch_scene::basis(), paint, paint::kNoCoat, 45))};
}

// What is found in a picture with a shadow is off by no more than four standard errors, which grow with the shadow. The
// control is the picture without one, whose regions agree.
TEST(SketchRegions, AShadowOnOneHalfIsTold) {
  const Told none = told(1), light = told(0.9), deep = told(0.6);
  EXPECT_LT(none.places, 4 * 0.02);
  EXPECT_GT(light.places, 4 * 0.1);
  EXPECT_GT(deep.places, light.places);
  for (const Told& one : {none, light, deep}) EXPECT_LE(one.off, one.places + 0.02);
}

// A floor darkens what faces down, of which every region of the picture has as much. The control is the regions, four
// of whose standard errors are less than what the paint is off by where little light is taken away.
TEST(SketchRegions, WhatAllRegionsShareIsToldByTheWayTheyFace) {
  const Told none = told(1, Half::kFacesDown), light = told(0.9, Half::kFacesDown), deep = told(0.6, Half::kFacesDown);
  EXPECT_LT(none.all, 0.02);
  for (const Told& one : {light, deep}) EXPECT_LE(one.off, one.all);
  EXPECT_GT(light.off, light.places);
}

}  // namespace
}  // namespace goniochrome::sketch::sketch_regions_test
