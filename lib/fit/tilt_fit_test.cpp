#include "fit/tilt_fit.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/testdata_for_test.h"
#include "brdf/tilted_lobes.h"
#include "fit/color_map_fit.h"
#include "fit/paint_fit.h"
#include "formats/paint_source.h"

namespace goniochrome::fit::tilt_fit_test {
namespace {

const formats::Basis kBasis = {"b7", {1.3, 6, 20, 70, 250, 900, 3000}, true};

struct Traveling {
  paint::Paint paint;
  brdf::ColorMap map;
  paint::LobeFit lobes;
};
const Traveling& traveling() {
  static const Traveling made = [] {
    Traveling t;
    t.paint = formats::read_paints(testdata("travel.paints.xml"))->front();
    t.map = fit_color_map(*t.paint.measurement, {.size = 64})->map;
    t.lobes = PaintFitter(kBasis, {}).fit(t.paint)->lobes;
    return t;
  }();
  return made;
}

TiltFit fitted(std::vector<int> lookups) {
  TiltOptions options;
  options.lookups = std::move(lookups);
  return fit_tilts(traveling().map, traveling().lobes, kBasis, options);
}

// A thin film: its color depends on the flakes' angle of incidence, which lobes about the mirror direction do not know.
TEST(TiltFit, FollowsATravelingColorBetterTheMoreLookupsThereAre) {
  const TiltFit fit = fitted({6, 12});
  ASSERT_EQ(fit.sets.size(), 2u);
  EXPECT_GT(fit.lobes_de00, 5);  // the control
  EXPECT_LT(fit.sets[0].mean_de00, 0.35 * fit.lobes_de00);
  EXPECT_LT(fit.sets[1].mean_de00, fit.sets[0].mean_de00);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LE(fit.sets[i].lookups(), i == 0 ? 6 : 12);
    for (const paint::TiltedView& view : fit.sets[i].views) {
      ASSERT_EQ(view.weights.size(), fit.sets[i].lobes.size());
      for (const color::Rgb& w : view.weights) EXPECT_TRUE(w.x >= 0 && w.y >= 0 && w.z >= 0);
    }
    EXPECT_EQ(fit.sets[i].views.front().view_deg, 0);
    EXPECT_EQ(fit.sets[i].views.back().view_deg, 90);
  }
}

// The colors at one view under lamps cos^32 that stand so far from the mirror direction, in the plane of incidence and
// out of it, each with a quarter of even light.
std::array<color::Rgb, 3> lit(const std::function<color::Rgb(const Vec3& light)>& f_cos, double view_deg) {
  constexpr double kLamps_deg[][2] = {{0, 0}, {-25, 0}, {10, 20}};
  std::array<Vec3, 3> lamps;
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    const double at = (view_deg + kLamps_deg[i][0]) * kDegree, out = kLamps_deg[i][1] * kDegree;
    lamps[i] = {std::sin(at) * std::cos(out), std::sin(out), std::cos(at) * std::cos(out)};
  }
  constexpr int kRows = 60, kColumns = 120;
  constexpr double kExponent = 32;
  std::array<color::Rgb, 3> sums;
  for (int row = 0; row < kRows; ++row) {
    const double z = -1 + 2 * (row + 0.5) / kRows, r = std::sqrt(1 - z * z);
    for (int column = 0; column < kColumns; ++column) {
      const double phi = 2 * kPi * (column + 0.5) / kColumns;
      const Vec3 light{r * std::cos(phi), r * std::sin(phi), z};
      const color::Rgb sent = (4 * kPi / (kRows * kColumns)) * f_cos(light);
      for (std::size_t i = 0; i < lamps.size(); ++i) {
        const double lamp_light = (kExponent + 1) / 2 * std::pow(std::max(0.0, dot(light, lamps[i])), kExponent);
        sums[i] += (0.25 + 0.75 * lamp_light) * sent;
      }
    }
  }
  return sums;
}

// The error of a set at a quarter of the way between the views of `at`, in the mean over lamps about the mirror
// direction.
double error_between(const paint::TiltedLobes& set, const std::vector<paint::TiltedView>& at) {
  double error = 0;
  int count = 0;
  for (std::size_t v = 0; v + 1 < at.size(); ++v) {
    const double view_deg = 0.75 * at[v].view_deg + 0.25 * at[v + 1].view_deg, view_rad = view_deg * kDegree;
    const Vec3 viewer{-std::sin(view_rad), 0, std::cos(view_rad)};
    const auto shown = lit([&](const Vec3& light) { return brdf::reflected_part(set, light, view_deg); }, view_deg);
    const auto truth = lit(
        [&](const Vec3& light) {
          return light.z <= 0
                     ? color::Rgb{}
                     : light.z / kPi *
                           brdf::reflectance_factor(traveling().map, light, viewer, brdf::CriticalAngle::kSlide);
        },
        view_deg);
    const color::Xyz white = *color::white_point({"D65", 2});
    for (std::size_t i = 0; i < truth.size(); ++i)
      error += color::delta_e_2000(color::lab_from_rgb(shown[i], white), color::lab_from_rgb(truth[i], white)), ++count;
  }
  return error / count;
}

// Few lobes stay near the mirror direction, since far ones show a small lamp as spots; many may stand farther out. The
// control is the set of 32, which stays near. Between its views a set is linear, and its colors are not. The control is
// the same set with every other view.
TEST(TiltFit, ManyLookupsReachFartherComeCloserAndHaveCloseViews) {
  const TiltFit fit = fitted({32, 64});
  ASSERT_EQ(fit.sets.size(), 2u);
  EXPECT_LT(fit.sets[1].mean_de00, 0.8 * fit.sets[0].mean_de00);
  const auto farthest = [](const paint::TiltedLobes& of) {
    double most = 0;
    for (const paint::TiltedLobe& lobe : of.lobes)
      most = std::max(most, std::max(std::abs(lobe.tilt_deg), lobe.out_deg) * kDegree * std::sqrt(lobe.exponent));
    return most;
  };
  EXPECT_LE(farthest(fit.sets[0]), 2.2);
  EXPECT_GT(farthest(fit.sets[1]), 2.2);

  const paint::TiltedLobes& set = fit.sets[1];
  paint::TiltedLobes sparse = set;
  sparse.views.clear();
  for (std::size_t v = 0; v < set.views.size(); v += 2) sparse.views.push_back(set.views[v]);
  EXPECT_EQ(sparse.views.back().view_deg, 90);
  const double error = error_between(set, sparse.views), control = error_between(sparse, sparse.views);
  std::printf("half-way between the views: %.2f; with every other view alone %.2f\n", error, control);
  EXPECT_LT(error, 0.5);
  EXPECT_GT(control, 1.5 * error);
}

// The truth is the map itself, whose light from below the horizon is 0: a set sends little there at any view. A lobe of
// exponent 20 about the mirror direction, with the same light in it, is the control: at 85 deg a third of it lies
// below.
TEST(TiltFit, HardlyReachesBelowTheHorizon) {
  const TiltFit fit = fitted({12});
  ASSERT_EQ(fit.sets.size(), 1u);
  const auto share_below = [](const paint::TiltedLobes& set, double view_deg) {
    double below = 0, all = 0;
    constexpr int kRows = 90, kColumns = 120;
    for (int row = 0; row < kRows; ++row) {
      const double z = -1 + 2 * (row + 0.5) / kRows, r = std::sqrt(1 - z * z);
      for (int column = 0; column < kColumns; ++column) {
        const double phi = 2 * kPi * (column + 0.5) / kColumns;
        const double y = brdf::reflected_part(set, {r * std::cos(phi), r * std::sin(phi), z}, view_deg).y;
        (z < 0 ? below : all) += y;
      }
    }
    return below / (all + below);
  };
  paint::TiltedLobes control;
  control.lobes = {{20, 0, 0}};
  control.views = {{0, {}, {{1, 1, 1}}}, {90, {}, {{1, 1, 1}}}};
  for (const double view_deg : {0.0, 30.0, 50.0, 65.0, 80.0, 85.0}) {
    EXPECT_LT(share_below(fit.sets[0], view_deg), 0.06) << view_deg;
  }
  EXPECT_GT(share_below(control, 85), 0.3);  // 5 deg of the 12.8 that such a lobe has as its standard deviation
}

TEST(TiltFit, NothingIsTiltedWhereLobesDoAsWell) {
  // A gray matt paint, and lobes that are its color.
  brdf::ColorMap gray = brdf::color_map_of_size(32, 1.5);
  for (float& factor : gray.factors) factor = 0.2F;
  paint::LobeFit matt;
  matt.diffuse = (0.2 / kPi) * color::Rgb{1, 1, 1};
  const TiltFit same = fit_tilts(gray, matt, kBasis, {});
  EXPECT_TRUE(same.sets.empty());
  EXPECT_LT(same.lobes_de00, 0.05);
  // The control: lobes of another color do not.
  matt.diffuse = (0.2 / kPi) * color::Rgb{1, 0.5, 0.5};
  TiltOptions few;
  few.lookups = {8};
  const TiltFit other = fit_tilts(gray, matt, kBasis, few);
  EXPECT_GT(other.lobes_de00, 5);
  EXPECT_FALSE(other.sets.empty());
  // A map of the aspecular angle.
  brdf::ColorMap aspecular = traveling().map;
  aspecular.aspecular = true;
  EXPECT_TRUE(fit_tilts(aspecular, traveling().lobes, kBasis, {}).sets.empty());
  TiltOptions none;
  none.lookups.clear();
  EXPECT_TRUE(fit_tilts(traveling().map, traveling().lobes, kBasis, none).sets.empty());
}

TEST(TiltFit, TheThreadsMakeNoDifference) {
  set_threads(1);
  const TiltFit one = fitted({4});
  set_threads(3);
  const TiltFit three = fitted({4});
  set_threads(0);
  EXPECT_EQ(one.sets, three.sets);
  EXPECT_EQ(one.lobes_de00, three.lobes_de00);
}

}  // namespace
}  // namespace goniochrome::fit::tilt_fit_test
