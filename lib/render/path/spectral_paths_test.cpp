// Light in bands: closed forms where every bounce multiplies the band, and gray scenes, which three channels draw as
// well.
#include "render/path/spectral_paths.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "base/testdata_for_test.h"
#include "fit/paint_fit.h"
#include "formats/xml.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::spectral_paths_test {
namespace {

using color::Bands;
using color::kBands;

template <class Function>
Bands bands_by(const Function& function) {
  Bands bands{};
  for (int b = 0; b < kBands; ++b) bands[static_cast<std::size_t>(b)] = function(color::band_nm(b));
  return bands;
}

paint::BandLobes matt(const Bands& reflectance) {
  paint::BandLobes lobes;
  lobes.views.push_back({0, color::scaled(1 / kPi, reflectance), {}, {}, {}});
  return lobes;
}

// Bands with these weights in every band.
paint::BandLobes even(const paint::LobeFit& fit) {
  paint::BandLobes lobes;
  lobes.coat_index = fit.coat_index;
  std::vector<paint::ViewLobes> views = fit.views;
  if (views.empty()) views.push_back({0, fit.diffuse, fit.lobes});
  lobes.exponents = lobe_exponents({fit});
  for (const paint::ViewLobes& view : views) {
    paint::BandWeights weights{view.view_deg, color::even_bands(view.diffuse.y), {}, {}, {}};
    weights.directional_diffuse.resize(lobes.exponents.size()), weights.gloss.resize(lobes.exponents.size());
    for (const paint::Lobe& lobe : view.lobes) {
      if (lobe.is_mirror()) {
        weights.mirror = color::even_bands(lobe.gloss.y);
        continue;
      }
      const auto j =
          static_cast<std::size_t>(std::ranges::find(lobes.exponents, lobe.exponent) - lobes.exponents.begin());
      weights.directional_diffuse[j] = color::even_bands(lobe.directional_diffuse.y);
      weights.gloss[j] = color::even_bands(lobe.gloss.y);
    }
    lobes.views.push_back(weights);
  }
  return lobes;
}

color::BandObserver eye() {
  return color::BandObserver::make().value();
}

double de00(const color::Rgb& x, const color::Rgb& y, double white) {
  const color::Xyz d65 = color::xyz_d65_from_rgb({1, 1, 1});
  return color::delta_e_2000(color::lab_from_rgb((1 / white) * x, d65), color::lab_from_rgb((1 / white) * y, d65));
}

// Inside a closed box whose walls have the reflectance r and shine with e, every point shows e/(1 - r) in each band.
TEST(SpectralPaths, ShowAFurnaceBandByBand) {
  const Bands r = bands_by([](double nm) { return 0.05 + 0.85 / (1 + std::exp((590 - nm) / 8)); });  // a red
  const Bands e = bands_by([](double nm) { return nm > 480 && nm < 620 ? 1.0 : 0.02; });             // greenish light
  Bands truth{};
  for (std::size_t b = 0; b < truth.size(); ++b) truth[b] = e[b] / (1 - r[b]);
  PathStage stage(box_mesh(true), {paint::LobeFit{}});
  SceneSpectra spectra{
      eye(), std::vector(stage.mesh.parts.size(), matt(r)), {}, std::vector(stage.mesh.parts.size(), e), {}};
  stage.scene.spectra = &spectra;
  stage.build();
  PathOptions options;
  options.bounces = 4096;
  const PathEstimate seen = stage.seen(options, {0, 0, 0}, {0.3, -1, 0.2}, 400);
  const color::Rgb expected = eye().rgb(truth);
  for (int c = 0; c < 3; ++c) {
    const double sigma = std::sqrt(seen.covariance[static_cast<std::size_t>(c)]);
    EXPECT_LT(sigma, 0.01 * expected[c]);
    EXPECT_NEAR(seen.radiance[c], expected[c], 4 * sigma + 1e-5);
  }
  EXPECT_LT(de00(seen.radiance, expected, expected.y), 0.5);
  // Channel by channel the same box has another color.
  const color::Rgb light = eye().rgb(e), paint = eye().rgb(r);
  color::Rgb channels;
  for (int c = 0; c < 3; ++c) channels[c] = light[c] / (1 - paint[c]);
  EXPECT_GT(de00(channels, expected, expected.y), 3);
}

// One bounce at a time: what is seen is e (1 + r + r^2 + ...) with as many terms as surfaces pass on light.
TEST(SpectralPaths, CountBouncesAsThreeChannelsDo) {
  const Bands r = bands_by([](double nm) { return nm < 500 ? 0.9 : 0.1; });
  const Bands e = color::even_bands(1);
  PathStage stage(box_mesh(true), {paint::LobeFit{}});
  SceneSpectra spectra{
      eye(), std::vector(stage.mesh.parts.size(), matt(r)), {}, std::vector(stage.mesh.parts.size(), e), {}};
  stage.scene.spectra = &spectra;
  stage.build();
  for (const int bounces : {0, 1, 3}) {
    Bands truth = e;
    Bands term = e;
    for (int k = 0; k <= bounces; ++k) {
      term = color::product(term, r);
      for (std::size_t b = 0; b < truth.size(); ++b) truth[b] += term[b];
    }
    PathOptions options;
    options.bounces = bounces;
    const PathEstimate seen = stage.seen(options, {0, 0, 0}, {0.3, -1, 0.2}, 100);
    const color::Rgb expected = eye().rgb(truth);
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(seen.radiance[c], expected[c], 4 * std::sqrt(seen.covariance[static_cast<std::size_t>(c)]) + 1e-5)
          << bounces;
  }
}

// A rough coat in bands is that in three channels, by light of a wall, and by that of a narrow lamp, whose disc
// channels see by a sum of a few hundred directions; the control is a scene whose coats stay lobes.
TEST(SpectralPaths, DrawRoughCoats) {
  const formats::Basis basis = *formats::read_basis(testdata("b7.basis.xml"));
  paint::Paint satin;
  satin.measurement = paint::Measurement{{}, "", {{{45, 45}, {40, 0, 0}}}};
  satin.gloss = {{20, 18}, {60, 60}, {85, 88}};
  const paint::LobeFit fitted = fit::PaintFitter(basis, {}).fit(satin)->lobes;
  ASSERT_FALSE(fitted.views.empty());
  for (const bool lamp : {false, true}) {
    const auto make = [&](bool spectral, bool rough, SceneSpectra& spectra) {
      auto stage = std::make_unique<PathStage>(box_mesh(false), std::vector<paint::LobeFit>(5, fitted));
      stage->rough_coats = rough;
      stage->scene.gloss_deg.assign(5, 20);
      if (lamp) {
        Light light;
        light.direction = normalized({0.2, 1, 0.3}), light.radius_rad = 0.02, light.white = {2, 2, 2};
        stage->scene.lights = {light};
      } else {
        stage->emission = {{}, {}, {}, {}, {1, 1, 1}};
      }
      if (spectral) {
        for (const paint::LobeFit& paint : stage->scene.paints) spectra.paints.push_back(even(paint));
        for (const Light& light : stage->scene.lights) spectra.lights.push_back(color::even_bands(light.white.y));
        for (const color::Rgb& e : stage->emission) spectra.emission.push_back(color::even_bands(e.y));
        stage->scene.spectra = &spectra;
      }
      stage->build();
      return stage;
    };
    SceneSpectra unused{eye(), {}, {}, {}, {}}, with{eye(), {}, {}, {}, {}}, without{eye(), {}, {}, {}, {}};
    const auto channels = make(false, true, unused), bands = make(true, true, with), lobes = make(true, false, without);
    PathOptions options;
    options.bounces = lamp ? 0 : 6;
    double control = 0;
    for (const Vec3& to : {Vec3{0.1, -1, 0.1}, Vec3{-1, -0.2, 0.3}, Vec3{0.2, -0.3, -1}}) {
      const Vec3 from{0.3, 0.2, 0.2};
      const PathEstimate a = channels->seen(options, from, to, 2500), b = bands->seen(options, from, to, 2500, 7),
                         c = lobes->seen(options, from, to, 2500, 11);
      const double sigma = std::sqrt(a.covariance[1] + b.covariance[1]);
      EXPECT_LT(sigma, 0.03 * a.radiance.y);
      const double apart = 4 * sigma + 1e-5 + (lamp ? 1e-3 * a.radiance.y : 0);
      EXPECT_NEAR(a.radiance.y, b.radiance.y, apart) << lamp;
      control = std::max(control, std::abs(c.radiance.y - a.radiance.y) / apart);
    }
    EXPECT_GT(control, 1.5) << lamp;
  }
}

// Glossy paints, a coat, views, brushed tilts, lamps far and near, wide and narrow, and a part that shines: where all
// is gray, bands and channels are the same. Transport in three channels is held by tests of its own.
TEST(SpectralPaths, ShowGrayScenesAsThreeChannelsDo) {
  paint::LobeFit coated;
  coated.coat_index = 1.5;
  coated.diffuse = {0.1, 0.1, 0.1};
  coated.lobes = {{20, {0.2, 0.2, 0.2}, {}}, {300, {}, {1, 1, 1}}, {paint::kMirrorExponent, {}, {0.5, 0.5, 0.5}}};
  paint::LobeFit viewed;
  viewed.diffuse = {0.05, 0.05, 0.05};
  viewed.lobes = {{40, {0.5, 0.5, 0.5}, {}}};
  viewed.views = {{10, viewed.diffuse, viewed.lobes},
                  {70, {0.15, 0.15, 0.15}, {{40, {0.1, 0.1, 0.1}, {}}, {90, {}, {0.4, 0.4, 0.4}}}}};
  paint::LobeFit white;
  white.diffuse = {0.25, 0.25, 0.25};
  const std::vector<paint::LobeFit> paints = {coated, viewed, white, white, white};
  const auto make = [&](bool spectral, SceneSpectra& spectra) {
    auto stage = std::make_unique<PathStage>(box_mesh(false), paints);
    add_rectangle(stage->mesh, "lamp", {-0.3, 0.9, -0.3}, {0.6, 0, 0}, {0, 0, 0.6});
    stage->scene.paints.push_back(paint::LobeFit{});
    stage->scene.anisotropy.assign(stage->mesh.parts.size(), {});
    stage->scene.anisotropy[1] = {0.1, 0.3};
    Light far;
    far.direction = normalized({0.2, 1, 0.3}), far.radius_rad = 0.004, far.white = {2, 2, 2};
    Light point;
    point.direction = normalized({-0.3, 1, 0.4}), point.white = {0.5, 0.5, 0.5};
    Light near;
    near.place = {{0.2, 0.1, 0.1}, 1}, near.radius_rad = 0.05, near.white = {0.3, 0.3, 0.3};
    stage->scene.lights = {far, point, near};
    stage->emission.assign(stage->mesh.parts.size(), {});
    stage->emission.back() = {3, 3, 3};
    if (spectral) {
      for (const paint::LobeFit& paint : stage->scene.paints) spectra.paints.push_back(even(paint));
      for (const Light& light : stage->scene.lights) spectra.lights.push_back(color::even_bands(light.white.y));
      for (const color::Rgb& e : stage->emission) spectra.emission.push_back(color::even_bands(e.y));
      stage->scene.spectra = &spectra;
    }
    stage->build();
    return stage;
  };
  SceneSpectra unused{eye(), {}, {}, {}, {}}, spectra{eye(), {}, {}, {}, {}};
  const auto channels = make(false, unused), bands = make(true, spectra);
  PathOptions options;
  const std::pair<Vec3, Vec3> looks[] = {{{0.5, 0.5, 0.5}, {0.1, -1, 0.1}},
                                         {{0, 0, 0}, {-1, 0.1, 0.2}},
                                         {{0.8, -0.5, 0}, {-1, -0.2, 0.3}},
                                         {{0, 0.2, 0}, {0.2, 0, -1}}};
  for (const auto& [from, to] : looks) {
    const PathEstimate a = channels->seen(options, from, to, 1500), b = bands->seen(options, from, to, 1500, 7);
    for (int c = 0; c < 3; ++c) {
      const auto at = static_cast<std::size_t>(c);
      const double sigma = std::sqrt(a.covariance[at] + b.covariance[at]);
      EXPECT_LT(sigma, 0.03 * a.radiance[c]);
      EXPECT_NEAR(a.radiance[c], b.radiance[c], 4 * sigma + 1e-5) << to.x << " " << to.y << " " << to.z;
    }
    EXPECT_NEAR(b.radiance.x, b.radiance.z, 1e-4 * b.radiance.x);  // 31 floats and their sums
  }
}

TEST(SpectralPaths, AskForSpectraOfEverything) {
  PathStage stage(box_mesh(true), {paint::LobeFit{}});
  SceneSpectra spectra{eye(), {matt(color::even_bands(0.5))}, {}, {}, {}};
  stage.scene.spectra = &spectra;
  PathScene path;
  path.scene = &stage.scene;
  EXPECT_FALSE(Transport::create(path).ok());
  spectra.paints.resize(stage.mesh.parts.size(), matt(color::even_bands(0.5)));
  EXPECT_TRUE(Transport::create(path).ok());
  path.ground = Ground{};
  path.ground->kind = Ground::Kind::kPaint, path.ground->height = -2;
  EXPECT_FALSE(Transport::create(path).ok());
  spectra.floor = matt(color::even_bands(0.5));
  EXPECT_TRUE(Transport::create(path).ok());
  spectra.emission.assign(1, color::even_bands(-1));
  EXPECT_FALSE(Transport::create(path).ok());
}

}  // namespace
}  // namespace goniochrome::render::spectral_paths_test
