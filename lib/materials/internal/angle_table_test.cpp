#include "materials/internal/angle_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "base/random_for_test.h"
#include "brdf/band_lobes.h"
#include "brdf/lobe_model.h"
#include "materials/internal/paints_for_test.h"
#include "materials/internal/shown.h"

namespace goniochrome::materials::angle_table_test {
namespace {

color::BandObserver eye() {
  return *color::BandObserver::make();
}

// Gray needs no spectrum.
paint::Paint gray(std::vector<paint::Lobe> lobes) {
  return paint_for_test("gray", {0.02, 0.02, 0.02}, std::move(lobes), 1.5);
}

AngleTable table_of(const paint::Paint& paint) {
  return AngleTable(*brdf::band_lobes(paint, eye()));
}

std::size_t nearest(const std::vector<double>& nodes, double x) {
  std::size_t best = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (std::abs(nodes[i] - x) < std::abs(nodes[best] - x)) best = i;
  return best;
}

// Between the rows, for lights and viewers to 70 deg at random. A reader that takes the nearest row is the control.
TEST(AngleTable, LinesBetweenItsRowsAreNearThePaint) {
  const paint::Paint paint = gray({{6, {0.1, 0.1, 0.1}, {}}, {20, {0.3, 0.3, 0.3}, {}}, {70, {0.4, 0.4, 0.4}, {}}});
  const AngleTable table = table_of(paint);
  const color::Xyz white = *color::white_point(paint::condition_of(paint));
  const auto lab = [&](const color::Rgb& f) { return color::lab_from_rgb(kPi * f, white); };
  TestNumbers random(7);
  double linear = 0, at_nearest = 0;
  int count = 0;
  while (count < 400) {
    const double in = std::acos(1 - 0.66 * random()), out = std::acos(1 - 0.66 * random());
    const double turn = kPi * random();
    const Vec3 light = direction(in, 0), view = direction(out, turn);
    if (paint::aspecular_angle_rad(light, view, {0, 0, 1}) < 15 * kDegree) continue;
    const auto &polar = AngleTable::polar_rad(), &azimuth = AngleTable::azimuth_rad();
    const color::Lab wanted = lab(brdf::coated_brdf(*paint.lobes, light, view, {0, 0, 1}));
    linear += color::delta_e_2000(wanted, lab(eye().rgb(table.at(light, view))));
    at_nearest += color::delta_e_2000(
        wanted, lab(eye().rgb(table.at(direction(polar[nearest(polar, in)], 0),
                                       direction(polar[nearest(polar, out)], azimuth[nearest(azimuth, turn)])))));
    ++count;
  }
  EXPECT_LE(linear / count, 0.3) << at_nearest / count;
  EXPECT_GT(at_nearest / count, 2 * linear / count);
}

// The light of the mirror is that of a coat, with light at its rows and between them; also that of a lobe too sharp for
// them.
TEST(AngleTable, KeepsTheLightOfTheMirror) {
  constexpr double kExponent = 3000, kWeight = 10;
  const paint::Paint mirror = gray({{paint::kMirrorExponent, {}, {0.5, 0.5, 0.5}}}),
                     sharp = gray({{kExponent, {}, {kWeight, kWeight, kWeight}}}), none = gray({});
  const AngleTable with_mirror = table_of(mirror), with_sharp = table_of(sharp), without = table_of(none);
  for (const double deg : {15.0, 31.0, 45.0, 46.25, 60.0}) {
    const Vec3 light = direction(deg * kDegree, 0);
    double sum = 0, sum_sharp = 0;
    constexpr int kSteps = 200;
    constexpr double kStep = 9.0 / kSteps * kDegree;
    for (int i = 0; i < kSteps; ++i)
      for (int j = 0; j < kSteps; ++j) {
        const double polar = (deg - 4.5) * kDegree + (i + 0.5) * kStep;
        const Vec3 view = direction(polar, kPi - 4.5 * kDegree + (j + 0.5) * kStep);
        const double share = std::cos(polar) * std::sin(polar) * kStep * kStep;
        sum += (with_mirror.at(light, view)[0] - without.at(light, view)[0]) * share;
        sum_sharp += (with_sharp.at(light, view)[0] - without.at(light, view)[0]) * share;
      }
    const double fresnel = brdf::fresnel_dielectric(light.z, 1.5),
                 usual = brdf::fresnel_dielectric(std::sqrt(0.5), 1.5);
    EXPECT_NEAR(sum / (0.5 * fresnel), 1, 0.02) << deg;
    EXPECT_NEAR(sum_sharp / (2 * kPi * kWeight / (kExponent + 1) * fresnel / usual), 1, 0.02) << deg;
  }
}

}  // namespace
}  // namespace goniochrome::materials::angle_table_test
