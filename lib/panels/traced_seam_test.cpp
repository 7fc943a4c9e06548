// The light at a seam beside a long wall in even light, where the share of the sky that the wall hides is known.
#include "panels/traced_seam.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "base/parallel.h"

namespace goniochrome::panels::traced_seam_test {
namespace {

using testing::HasSubstr;

constexpr double kHeight = 1, kDistance = 0.6, kGap = 0.3, kLong = 200, kRadiance = 3;

// Two level panels that meet at a seam along z, and a wall beyond the second one that faces them.
mesh::Mesh panels_and_wall() {
  mesh::Mesh mesh;
  const auto quad = [&](const char* name, const std::array<Vec3, 4>& corners, const Vec3& normal) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3& p : corners) mesh.positions.push_back(p), mesh.normals.push_back(normal);
    mesh.parts.push_back({name, "", mesh.triangles.size(), 2});
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  const double wall = kGap + kDistance;
  quad("a", {Vec3{-1, 0, kLong}, {0, 0, kLong}, {0, 0, -kLong}, {-1, 0, -kLong}}, {0, 1, 0});
  quad("b", {Vec3{kGap, 0, kLong}, {wall, 0, kLong}, {wall, 0, -kLong}, {kGap, 0, -kLong}}, {0, 1, 0});
  quad("wall", {Vec3{wall, 0, -kLong}, {wall, 0, kLong}, {wall, kHeight, kLong}, {wall, kHeight, -kLong}}, {-1, 0, 0});
  return mesh;
}

mesh::Seam seam() {
  mesh::Seam seam;
  mesh::SeamPoint p;
  p.a = {0, 0, 0}, p.b = {kGap, 0, 0};
  p.normal_a = p.normal_b = {0, 1, 0};
  p.along = {0, 0, 1}, p.across = {1, 0, 0};
  seam.points.push_back(p);
  return seam;
}

envmap::PrefilteredEnvironment even_light(bool with_mirror = true) {
  envmap::PrefilteredEnvironment env;
  const auto lobe = [&](double exponent) {
    envmap::PrefilteredLobe made;
    made.exponent = exponent, made.map = envmap::CubeMap(4);
    for (float& texel : made.map.texels) texel = static_cast<float>(kRadiance);
    return made;
  };
  env.diffuse = lobe(1);
  for (const double exponent : {2.0, 8.0, 32.0}) env.lobes.push_back(lobe(exponent));
  if (with_mirror) env.mirror = lobe(paint::kMirrorExponent);
  return env;
}

paint::LobeFit matt(double reflectance) {
  paint::LobeFit paint;
  paint.diffuse = reflectance / kPi * color::Rgb{1, 1, 1};
  return paint;
}

std::vector<SeamView> from_above() {
  std::vector<SeamView> views;
  for (int i = 0; i < 40; ++i) views.push_back({0, std::nullopt, normalized({-0.3, 1, 0.02 * i}), 1});
  return views;
}

double mean_diffuse(const std::vector<EnvironmentPanels::Light>& lights) {
  double sum = 0;
  for (const auto& light : lights) sum += light.front().y / (kPi * kRadiance);
  return sum / static_cast<double>(lights.size());
}

// A long wall of height h at a distance d hides (1 - cos atan(h/d))/2 of the irradiance of a level point. The spot lies
// some steps of a thousandth of the mesh's size (400) beside the edge. Of 40 views with 512 directions each, the mean
// share has a standard deviation below sqrt(1/4/(40 512)) = 0.0035; the control is the open light.
TEST(TracedSeam, ABlackWallHidesItsShareOfTheSkyAndAWhiteOneSendsItBack) {
  const mesh::Mesh mesh = panels_and_wall();
  const envmap::PrefilteredEnvironment env = even_light();
  const auto traced = TracedSeam::create(mesh, env);
  ASSERT_TRUE(traced.ok()) << traced.error().message;
  const double step = 1e-3 * length(Vec3{1 + kGap + kDistance, kHeight, 2 * kLong});
  const auto hidden = [](double distance) { return 0.5 * (1 - std::cos(std::atan(kHeight / distance))); };
  for (const auto& [side, part, distance] :
       {std::tuple{SeamSide::kA, "a", kGap + kDistance + step}, {SeamSide::kB, "b", kDistance - step}}) {
    const auto black = traced->seen(matt(1e-6), seam(), from_above(), side, part);
    ASSERT_TRUE(black.ok()) << black.error().message;
    EXPECT_EQ(black->beside, 0u);
    EXPECT_NEAR(mean_diffuse(black->lights), 1 - hidden(distance), 4 * 0.0035) << part;
    EXPECT_NEAR(mean_diffuse(black->open), 1, 3e-3) << part;  // of the maps
    EXPECT_GT(hidden(distance), 0.1) << "the control must fail";
    // Surfaces that send everything back are as bright as the sky; four bounces leave out at most 0.3^5.
    const auto white = traced->seen(matt(1), seam(), from_above(), side, part);
    ASSERT_TRUE(white.ok());
    EXPECT_NEAR(mean_diffuse(white->lights), 1, 4 * 0.0035 + 3e-3 + 0.003) << part;
  }
}

// The transmission of a dielectric of index 1.5, by the formulas of Fresnel.
double let_through(double cosine) {
  const double n = 1.5, inside = std::sqrt(1 - (1 - cosine * cosine) / (n * n));
  const double s = (cosine - n * inside) / (cosine + n * inside), p = (n * cosine - inside) / (n * cosine + inside);
  return 1 - (s * s + p * p) / 2;
}

// A coat lets light in by its angle and out to the viewer by another, and a wall takes the light that comes near the
// horizon, of which the coat lets in least. The sum over directions above a wall of that height at that distance is
// taken here, as a part of even light, and without what goes out to the viewer.
double let_in_above_wall(double height, double distance) {
  constexpr int kRows = 400, kColumns = 720;
  double sum = 0;
  for (int row = 0; row < kRows; ++row) {
    // Rows of equal cos d(cos).
    const double up = std::sqrt((row + 0.5) / kRows), flat = std::sqrt(1 - up * up);
    for (int column = 0; column < kColumns; ++column) {
      const double toward_wall = flat * std::cos(2 * kPi * (column + 0.5) / kColumns);
      if (toward_wall * height < up * distance) sum += let_through(up) / (kRows * kColumns);
    }
  }
  return sum;
}

TEST(TracedSeam, ACoatLetsInWhatTheWallLeaves) {
  const mesh::Mesh mesh = panels_and_wall();
  const envmap::PrefilteredEnvironment env = even_light();
  const auto traced = TracedSeam::create(mesh, env);
  ASSERT_TRUE(traced.ok()) << traced.error().message;
  paint::LobeFit coated = matt(1e-6);
  coated.coat_index = 1.5;
  const double step = 1e-3 * length(Vec3{1 + kGap + kDistance, kHeight, 2 * kLong});
  const auto let_in = [&](const std::vector<EnvironmentPanels::Light>& lights) {
    double sum = 0;
    const std::vector<SeamView> views = from_above();
    for (std::size_t i = 0; i < lights.size(); ++i)
      sum += lights[i].front().y / (kPi * kRadiance) / let_through(views[i].view.y);
    return sum / static_cast<double>(lights.size());
  };
  for (const auto& [side, part, distance] :
       {std::tuple{SeamSide::kA, "a", kGap + kDistance + step}, {SeamSide::kB, "b", kDistance - step}}) {
    const auto seen = traced->seen(coated, seam(), from_above(), side, part);
    ASSERT_TRUE(seen.ok()) << seen.error().message;
    const double truth = let_in_above_wall(kHeight, distance), open = let_in_above_wall(0, 1);
    EXPECT_NEAR(let_in(seen->lights), truth, 4 * 0.0035) << part;
    EXPECT_NEAR(let_in(seen->open), open, 5e-3) << part;  // of the maps
    // The controls: no coat, and a coat that takes as large a part of what the wall leaves as of all.
    const auto bare = traced->seen(matt(1e-6), seam(), from_above(), side, part);
    ASSERT_TRUE(bare.ok());
    EXPECT_GT(mean_diffuse(bare->lights), truth + 8 * 0.0035) << part;
    const double hidden = 0.5 * (1 - std::cos(std::atan(kHeight / distance)));
    EXPECT_GT(truth, open * (1 - hidden) + 1e-3) << part;
  }
}

TEST(TracedSeam, TheDifferenceThatAWallMakesIsToldWithItsNoiseForAnyNumberOfThreads) {
  const mesh::Mesh mesh = panels_and_wall();
  const envmap::PrefilteredEnvironment env = even_light();
  const auto traced = TracedSeam::create(mesh, env);
  const auto panels = EnvironmentPanels::make(env, {});
  ASSERT_TRUE(traced.ok() && panels.ok());
  const paint::LobeFit gray = matt(0.2);
  std::vector<double> first;
  for (const int threads : {1, 3}) {
    set_threads(threads);
    const auto lights = seam_lights(*panels, &*traced, gray, seam(), from_above(), "a", "b");
    ASSERT_TRUE(lights.ok()) << lights.error().message;
    // The wall hides 10 and 40 % of the sky from the two panels. If it sends nothing back, the gray of .2 has L* 49.4
    // and 41.2 there; if it sends back a fifth of the whole sky, 49.9 and 43.6. The truth lies between, and noise is
    // added.
    EXPECT_GT(lights->worth_de76, 49.9 - 43.6 - 2 * lights->noise_de76);
    EXPECT_LT(lights->worth_de76, 49.4 - 41.2 + 2 * lights->noise_de76);
    EXPECT_GT(lights->noise_de76, 0);
    EXPECT_LT(lights->noise_de76, 0.5);
    std::vector<double> values;
    for (const auto& light : lights->b) values.push_back(light.front().x);
    if (threads == 1) first = values;
    EXPECT_EQ(values, first);
  }
  set_threads(0);
  const auto bare = TracedSeam::create(mesh, env, true);
  ASSERT_TRUE(bare.ok());
  const auto without = seam_lights(*panels, &*bare, gray, seam(), from_above(), "a", "b");
  ASSERT_TRUE(without.ok());
  EXPECT_EQ(without->worth_de76, 0);
  EXPECT_NEAR(without->b.front().front().x, kPi * kRadiance, 3e-3 * kPi * kRadiance);  // of the maps
  const auto open = seam_lights(*panels, nullptr, gray, seam(), from_above(), "a", "b");
  ASSERT_TRUE(open.ok());
  EXPECT_EQ(open->worth_de76, 0);
  EXPECT_EQ(open->a.front().front(), open->b.front().front());
}

TEST(TracedSeam, WhatCannotBeTracedIsNamed) {
  const mesh::Mesh mesh = panels_and_wall();
  const envmap::PrefilteredEnvironment without = even_light(false), env = even_light();
  EXPECT_THAT(TracedSeam::create(mesh, without).error().message, HasSubstr("has no mirror part"));
  const auto traced = TracedSeam::create(mesh, env);
  ASSERT_TRUE(traced.ok());
  EXPECT_THAT(traced->seen(matt(0.5), seam(), from_above(), SeamSide::kA, "roof").error().message,
              HasSubstr("no part \"roof\""));
  // A place in the air: the light there is open.
  mesh::Seam away = seam();
  away.points.front().a.y = 50;
  const auto seen = traced->seen(matt(0.5), away, from_above(), SeamSide::kA, "a");
  ASSERT_TRUE(seen.ok());
  EXPECT_EQ(seen->beside, from_above().size());
  EXPECT_EQ(seen->lights.front().front(), seen->open.front().front());
}

}  // namespace
}  // namespace goniochrome::panels::traced_seam_test
