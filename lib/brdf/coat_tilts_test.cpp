#include "brdf/coat_tilts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/coat_facets.h"
#include "brdf/tilted_lobes.h"
#include "brdf/true_coat_for_test.h"

namespace goniochrome::brdf::coat_tilts_test {
namespace {

const std::vector<double> kBasis = {1.3, 6, 20, 70, 250, 900, 3000};

// The light of a coat and of its set through a window of the sky, as shares of even light: a cap of some radius beside
// the mirror direction, by angles in and out of the plane of incidence.
struct Window {
  double in_deg, out_deg, radius_deg;
  Vec3 axis(double view_deg) const { return tilted_axis({1, in_deg, out_deg}, view_deg); }
};

double through(const Window& window, const TrueCoat& coat, double view_deg) {
  const Vec3 axis = window.axis(view_deg);
  const Vec3 out = {-std::sin(view_deg * kDegree), 0, std::cos(view_deg * kDegree)};
  double sum = 0;
  const auto is_inside = [&, low = std::cos(window.radius_deg * kDegree)](const Vec3& light) {
    return dot(light, axis) > low;
  };
  coat.each_light(out, 60000, is_inside, [&](const Vec3&, double energy) { sum += energy; });
  return sum;
}

double through(const Window& window, const paint::TiltedLobes& set, double view_deg) {
  const Vec3 axis = window.axis(view_deg);
  constexpr int kPoints = 1000;
  const double versine = 1 - std::cos(window.radius_deg * kDegree);
  const Vec3 x = normalized(cross(axis, std::abs(axis.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), y = cross(axis, x);
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    constexpr double kGolden = 1.32471795724474602596;
    const double low = std::fmod(0.5 + i / kGolden, 1) * versine, sine = std::sqrt(low * (2 - low)),
                 p = 2 * kPi * std::fmod(0.5 + i / (kGolden * kGolden), 1);
    const Vec3 to = (1 - low) * axis + (sine * std::cos(p)) * x + (sine * std::sin(p)) * y;
    sum += reflected_part(set, to, view_deg).x * 2 * kPi * versine / kPoints;
  }
  return sum;
}

// At oblique views the light is wider in the plane of incidence than across it. The control is the set without tilts.
TEST(CoatTilts, HaveTheShapeOfTheLight) {
  for (const TrueCoat& coat : {TrueCoat{0, 0.1, 0.3}, TrueCoat{0, 0.1, 0.3, true}}) {
    const RoughCoat rough{0, coat.slope, 0.3, coat.beckmann ? Slopes::kGaussian : Slopes::kGgx};
    const paint::TiltedLobes set = coat_tilts(rough, 1.5, kBasis, std::vector<double>(std::size(kCoatViews_deg), 0.0));
    for (const double view_deg : {45.0, 60.0, 71.0}) {
      paint::TiltedLobes round = set;
      for (paint::TiltedLobe& lobe : round.lobes) lobe.tilt_deg = 0;
      double all = 0, worst = 0, control = 0;
      for (const Window& window :
           {Window{0, 0, 4}, Window{9, 0, 4}, Window{-9, 0, 4}, Window{0, 9, 4}, Window{-18, 0, 6}}) {
        const double truth = through(window, coat, view_deg);
        all = std::max(all, truth);
        worst = std::max(worst, std::abs(through(window, set, view_deg) - truth));
        control = std::max(control, std::abs(through(window, round, view_deg) - truth));
      }
      std::printf("view %g: %.3f, control %.3f of %.4f\n", view_deg, worst / all, control / all, all);
      EXPECT_LE(worst, 0.08 * all) << view_deg;
      EXPECT_GT(control, 0.12 * all) << view_deg;
    }
  }
}

// All the light is there, beside what a mirror shows of it.
TEST(CoatTilts, HaveAllTheLight) {
  const RoughCoat rough{1.2, 0.02, 0.4};
  const TrueCoat coat{1.2, 0.02, 0.4};
  const std::vector<double> mirrored(std::size(kCoatViews_deg), 0.01);
  const paint::TiltedLobes set = coat_tilts(rough, 1.5, kBasis, mirrored);
  ASSERT_EQ(set.views.size(), std::size(kCoatViews_deg));
  for (const paint::TiltedView& view : set.views) {
    ASSERT_EQ(view.weights.size(), set.lobes.size());
    const Vec3 out = {-std::sin(view.view_deg * kDegree), 0, std::cos(view.view_deg * kDegree)};
    double truth = 0, sum = 0.01;
    coat.each_light(out, 60000, [&](const Vec3&, double energy) { truth += energy; });
    for (std::size_t j = 0; j < set.lobes.size(); ++j) {
      EXPECT_GE(view.weights[j].x, 0);
      if (view.view_deg == 0 && set.lobes[j].tilt_deg != 0) {
        EXPECT_EQ(view.weights[j].x, 0);
      }
      sum += view.weights[j].x;
    }
    EXPECT_NEAR(sum, truth, 0.02 * truth) << view.view_deg;
  }
}

}  // namespace
}  // namespace goniochrome::brdf::coat_tilts_test
