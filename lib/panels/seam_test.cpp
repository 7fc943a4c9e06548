#include "panels/seam.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace goniochrome::panels::seam_test {
namespace {

// One place of a seam along x: the first panel faces up, the second one falls away beyond it by `fold_deg`.
mesh::Seam one_place(double fold_deg) {
  mesh::Seam seam;
  mesh::SeamPoint p;
  p.normal_a = {0, 1, 0};
  p.normal_b = {0, std::cos(fold_deg * kDegree), std::sin(fold_deg * kDegree)};
  p.along = {1, 0, 0}, p.across = {0, 0, 1};
  p.fold_deg = fold_deg;
  seam.points.push_back(p);
  return seam;
}

double difference_of(const FlakeCurve& curve, const PanelView& view) {
  return color::delta_e_76(panel_color(curve.at(view.aspecular_a_deg), view.cos_a),
                           panel_color(curve.at(view.aspecular_b_deg), view.cos_b));
}

TEST(SpreadPlaces, AreAllInOrderOrEvenlySpread) {
  EXPECT_EQ(spread_places(3, 5), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(spread_places(0, 5).empty());
  // Ten views at each of 200 places of a seam: by the golden ratio each view comes 40 times in 400, and no more than 4
  // off, which is the spread of such a sequence over ten classes; every fifth place, the control, knows two views only.
  std::vector<int> of_view(10), of_step(10);
  const std::vector<std::size_t> some = spread_places(2000, 400);
  ASSERT_EQ(some.size(), 400u);
  for (std::size_t i = 0; i < some.size(); ++i) {
    ASSERT_LT(some[i], 2000u);
    ++of_view[some[i] % 10], ++of_step[5 * i % 10];
  }
  for (const int count : of_view) EXPECT_NEAR(count, 40, 4);
  EXPECT_EQ(std::ranges::count(of_step, 0), 8);
}

// A ridge turns the second panel away from light on the first one's side and toward light on its own.
TEST(SeamViews, AgreeWithPanelsTurnedBothWays) {
  const FlakeCurve curve(paint::Appearance{{75, 20, 30}, {30, -15, 5}, 80, {}});
  for (const double seam_deg : {90.0, 60.0, 0.0}) {
    GeometryList list = *geometry_list({.lights = "30,50", .views = "as25,-20", .azimuths = "0,30"});
    const mesh::Seam seam = one_place(4);
    const auto views = views_at_seam(seam, list, seam_deg);
    ASSERT_EQ(views.size(), 2 * list.pairs.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
      const TiltedPair pair = TiltedPair::make(list.pairs[i % list.pairs.size()], seam_deg);
      const double b = i < list.pairs.size() ? -4 : 4;
      EXPECT_NEAR(difference_of(curve, panel_view(seam, views[i])),
                  difference_at(curve, pair, b, DifferenceMetric::kDe76), 1e-9);
    }
  }
}

TEST(SeamViews, GlareDarknessAndBackSidesAreLeftOut) {
  const mesh::Seam seam = one_place(4);
  const Vec3 up{0, 1, 0}, down{0, -1, 0}, low = normalized({0, 1, 1});
  EXPECT_EQ(views_in_world(seam, {up}, {low}).size(), 1u);
  EXPECT_TRUE(views_in_world(seam, {up}, {up}).empty()) << "glare";
  EXPECT_TRUE(views_in_world(seam, {down}, {low}).empty()) << "dark";
  EXPECT_TRUE(views_in_world(seam, {up}, {down}).empty()) << "the viewer is below";
  EXPECT_EQ(views_in_world(seam, {}, {up, low}).size(), 2u) << "an environment has no glare to avoid";
}

TEST(SeamViews, PlacesGatherTheirViews) {
  mesh::Seam seam = one_place(4);
  seam.points.push_back(seam.points[0]);
  const std::vector<SeamView> views = {{0, {}, {0, 1, 0}, 1}, {0, {}, {0, 1, 0}, 3}};
  const auto places = by_place(seam, views, {2, 4});
  EXPECT_EQ(places[0].max, 4);
  EXPECT_NEAR(places[0].rms, std::sqrt((4.0 + 3 * 16) / 4), 1e-15);
  EXPECT_EQ(places[1].views, 0);
  EXPECT_TRUE(std::isnan(places[1].max) && std::isnan(places[1].rms));
}

envmap::PrefilteredEnvironment uniform(double radiance) {
  envmap::PrefilteredEnvironment env;
  const auto lobe = [&](double exponent) {
    envmap::PrefilteredLobe made;
    made.exponent = exponent, made.map = envmap::CubeMap(4);
    for (float& texel : made.map.texels) texel = static_cast<float>(radiance);
    return made;
  };
  env.diffuse = lobe(1);
  for (const double exponent : {2.0, 8.0, 32.0}) env.lobes.push_back(lobe(exponent));
  return env;
}

// In uniform light a matt panel looks the same whichever way it faces, and like its own color, since white is what the
// same light makes of a white diffuser.
TEST(EnvironmentPanels, ShowAMattPaintAsItIsInUniformLight) {
  const envmap::PrefilteredEnvironment env = uniform(7);
  const EnvironmentPanels panels = *EnvironmentPanels::make(env, {});
  const color::Lab gray{50, 4, -3};
  const mesh::Seam seam = one_place(20);
  const auto views = views_in_world(seam, {}, {normalized({0.2, 1, 0.5}), Vec3{0, 1, 0}});
  for (const SeamSide side : {SeamSide::kA, SeamSide::kB}) {
    const auto colors = seam_colors(panels, seam, views, side)(paint::Appearance{gray, gray, 60, {}});
    ASSERT_TRUE(colors.ok());
    for (const color::Lab& lab : *colors) EXPECT_LT(color::delta_e_76(lab, gray), 0.1);
  }
  EXPECT_FALSE(EnvironmentPanels::make(uniform(0), {}).ok());
}

TEST(EnvironmentPanels, AreHelpedByATrompeFitInLightFromAbove) {
  envmap::PrefilteredEnvironment env = uniform(0.2);
  for (envmap::PrefilteredLobe* lobe : {&env.diffuse, &env.lobes[0], &env.lobes[1], &env.lobes[2]})
    for (int i = 0; i < 16 * 3; ++i) lobe->map.texels[static_cast<std::size_t>(2 * 16 * 3 + i)] = 5;  // +Y
  const EnvironmentPanels panels = *EnvironmentPanels::make(env, {});
  const mesh::Seam seam = one_place(6);
  const paint::Appearance a{{75, 0, 0}, {25, 0, 0}, 75, {}};
  const auto views = views_in_world(seam, {}, {normalized({0, 1, 1}), normalized({0, 1, 2}), normalized({1, 1, 2})});
  const auto target = seam_colors(panels, seam, views, SeamSide::kA)(a);
  ASSERT_TRUE(target.ok());
  const auto fit = trompe_fit(a, false, *target, std::vector<double>(views.size(), 1.0),
                              seam_colors(panels, seam, views, SeamSide::kB), {});
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_GT(fit->before.rms, 1);
  EXPECT_LT(fit->after.rms, 0.7 * fit->before.rms);
}

// Even light passes a coat on its way in with the cosine mean of what it lets through, and on its way out at the angle
// of the viewer; the paint was read through the coat as well. The mean of index 1.5 is published as .9082 [Duntley].
TEST(EnvironmentPanels, ShowAMattPaintThroughItsCoat) {
  const envmap::PrefilteredEnvironment env = uniform(2);
  const EnvironmentPanels panels = *EnvironmentPanels::make(env, {}, 1.5);
  const color::Lab gray{60, 0, 0};
  const paint::LobeFit fit = *panels.lobes({gray, gray, 60, {}});
  EXPECT_EQ(fit.coat_index, 1.5);
  const auto through = [](double deg) {
    const double c = std::cos(deg * kDegree), t = std::sqrt(1 - (1 - c * c) / 2.25);
    const double s = (c - 1.5 * t) / (c + 1.5 * t), p = (1.5 * c - t) / (1.5 * c + t);
    return 1 - (s * s + p * p) / 2;
  };
  const double beta = color::xyz_from_lab(gray, {100, 100, 100}).Y / 100;
  for (const double view_deg : {0.0, 60.0, 80.0}) {
    const Vec3 view{std::sin(view_deg * kDegree), 0, std::cos(view_deg * kDegree)};
    const color::Lab shown = panels.color(fit, panels.light({0, 0, 1}, view));
    const double luminance = color::xyz_from_lab(shown, {100, 100, 100}).Y / 100;
    // The readings lie on lobes of a few exponents, so that their passages are met to a percent.
    EXPECT_NEAR(luminance / (beta * through(view_deg) * 0.9082 / (through(45) * through(0))), 1, 0.02) << view_deg;
  }
  EXPECT_LT(panels.color(fit, panels.light({0, 0, 1}, {std::sin(1.4), 0, std::cos(1.4)})).L, 57);
}

}  // namespace
}  // namespace goniochrome::panels::seam_test
