// Coats in every engine: their energy, and the exact sum.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "base/testdata_for_test.h"
#include "brdf/lobe_model.h"
#include "fit/paint_fit.h"
#include "formats/paint_source.h"
#include "render/cpu/cpu_engine.h"
#include "render/exact.h"
#include "render/path/lobe_columns.h"
#include "render/path/open_light.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::coat_test {
namespace {

envmap::Environment even_sky() {
  image::Image image{64, 32, 3, {}, {}};
  image.data.assign(64UL * 32 * 3, 1.0F);
  return *envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "even");
}

const formats::Basis& basis() {
  static const formats::Basis read = *formats::read_basis(testdata("b7.basis.xml"));
  return read;
}

// Every paint of testdata/ as fit-paint writes it.
const std::vector<paint::LobeFit>& fitted_paints() {
  static const std::vector<paint::LobeFit> all = [] {
    std::vector<paint::LobeFit> lobes;
    for (const auto& fit :
         fit::fits(fit::PaintFitter(basis(), {}), *formats::read_paints(testdata("paints.paints.xml"))))
      lobes.push_back(fit->lobes);
    return lobes;
  }();
  return all;
}

double largest(const color::Rgb& c) {
  return std::max({c.x, c.y, c.z});
}

// The albedo of every paint, at views up to 89.5 deg, by the exact sum in an even environment of 1. The control is the
// textbook form. The texels of 5.6 deg err by 2e-3 at the horizon.
TEST(Coat, NoPaintSendsBackMoreThanItGets) {
  const envmap::Environment sky = even_sky();
  std::vector<paint::LobeFit> paints = fitted_paints(), textbook;
  ASSERT_GT(paints.size(), 50U);
  for (const paint::LobeFit& paint : paints) textbook.push_back(brdf::under_coat(paint, paint::kNoCoat));
  double most = 0, most_textbook = 0;
  for (const auto* all : {&paints, &textbook}) {
    std::vector<ExactModel> models(1);
    models[0].fresnel = true, models[0].gloss_deg = 60;
    std::vector<SurfacePoint> points;
    for (const paint::LobeFit& paint : *all)
      for (const double view_deg : {0.0, 30.0, 60.0, 75.0, 80.0, 85.0, 88.0, 89.5}) {
        const double t = view_deg * kDegree;
        points.push_back({{0, 1, 0}, {std::sin(t), std::cos(t), 0}, &paint, models.data()});
      }
    for (const color::Rgb& radiance : reference_radiance(points, &sky, {}))
      (all == &paints ? most : most_textbook) = std::max(all == &paints ? most : most_textbook, largest(radiance));
  }
  EXPECT_LE(most, 1 + 2e-3);
  EXPECT_GT(most_textbook, 1.5);
}

// Bases without a mirror, whose lobes may not send more than a coat reflects, although they then read less gloss, do
// the same. Colors do not depend on gloss. The control scales the sharpest lobe up until the meter reads what is
// stated.
TEST(Coat, NoPaintSendsBackMoreThanItGetsWithoutAMirror) {
  const envmap::Environment sky = even_sky();
  const std::vector<paint::Paint> paints = *formats::read_paints(testdata("paints.paints.xml"));
  double most = 0, most_textbook = 0, moved = 0;
  for (const std::vector<double>& exponents :
       {std::vector<double>{1.3, 6, 20, 70, 250, 900, 3000}, {2, 12, 60, 300}, {20}, {1.3}}) {
    const formats::Basis bare{.name = "bare", .exponents = exponents};
    const brdf::GlossTable table(exponents);
    std::vector<paint::LobeFit> fitted, textbook;
    for (paint::Paint paint : paints) {
      fitted.push_back(fit::PaintFitter(bare, {}).fit(paint)->lobes);
      textbook.push_back(fitted.back());
      const double lacking = paint.gloss.front().gloss_units - brdf::gloss_units(table, **table.at(60), fitted.back());
      if (paint::Lobe& last = textbook.back().lobes.back(); lacking > 0 && last.exponent == exponents.back())
        last.gloss += (lacking / (**table.at(60)).gloss.back()) * color::Rgb{1, 1, 1};
      paint.gloss.clear(), paint.coat_index = fitted.back().coat_index;
      const paint::LobeFit matt = fit::PaintFitter(bare, {}).fit(paint)->lobes;
      for (const double angle : {15.0, 45.0, 110.0})
        moved = std::max(moved, length(brdf::flake_reflectance_factor(matt, angle) -
                                       brdf::flake_reflectance_factor(fitted.back(), angle)));
    }
    ExactModel model;
    model.fresnel = true, model.gloss_deg = 60;
    for (const auto* all : {&fitted, &textbook}) {
      std::vector<SurfacePoint> points;
      for (const paint::LobeFit& paint : *all)
        for (const double view_deg : {0.0, 60.0, 80.0, 85.0, 88.0}) {
          const double t = view_deg * kDegree;
          points.push_back({{0, 1, 0}, {std::sin(t), std::cos(t), 0}, &paint, &model});
        }
      double& brightest = all == &fitted ? most : most_textbook;
      for (const color::Rgb& radiance : reference_radiance(points, &sky, {}))
        brightest = std::max(brightest, largest(radiance));
    }
  }
  EXPECT_LE(most, 1 + 2e-3);
  EXPECT_GT(most_textbook, 1.5);
  EXPECT_LE(moved, 1e-9);
}

// Lamps: each engine has the passage of the lamp's own direction, so that only floats part it from the exact sum. The
// control leaves that passage out.
TEST(Coat, LampsPassItAtTheirOwnAngle) {
  const mesh::Mesh mesh = sphere_mesh(48);
  paint::LobeFit paint = matt({0.1, 0.2, 0.05});
  paint.lobes = {{6, {0.05, 0.1, 0.02}, {}}, {40, {0.2, 0.3, 0.1}, {0.1, 0.1, 0.1}}};
  paint.coat_index = 1.52;
  Scene scene;
  scene.mesh = &mesh, scene.paints = {paint};
  scene.lights = {{normalized({3, 0.5, 0.2}), {1, 0.9, 0.8}}, {normalized({-1, 2, 1}), {0.3, 0.3, 0.5}}};
  const View view{Camera::orbit(mesh, 30, 20, 1, 30, 1), 40, 40, 1, true};
  for (const EngineInfo* engine : engines()) {
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer.ok());
    if (engine->needs_texels) continue;
    ASSERT_TRUE(renderer->load(scene, engine->name).ok()) << engine->name;
    Frame frame;
    ASSERT_TRUE(renderer->draw(view, frame).ok()) << engine->name;
    std::vector<VisiblePoint> points;
    std::vector<const float*> pixels;
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x)
        if (frame.gbuffer->part(x, y) >= 0)
          points.push_back(frame.gbuffer->point(x, y)), pixels.push_back(frame.centers.pixel(x, y));
    Effects effects = effects_of(scene);
    const auto truth = exact_radiance(points, scene, effects, nullptr);
    effects.coat = false;
    const auto control = exact_radiance(points, scene, effects, nullptr);
    ASSERT_GT(points.size(), 500U);
    double off = 0, off_control = 0;
    for (std::size_t i = 0; i < points.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        off = std::max(off, std::abs(pixels[i][c] - truth[i][c]));
        off_control = std::max(off_control, std::abs(control[i][c] - truth[i][c]));
      }
    // The weights are straight pieces of the root of the view's cosine.
    EXPECT_LE(off, 2e-3) << engine->name;
    EXPECT_GT(off_control, 2e-2);
  }
}

// A part without a coat stands beside one with a coat, where a disc lamp touches the horizon from below: its light
// there tends to 0, and the coat is asked for its transmission at a cosine of 0. Without a coat that is 1. The control
// is the textbook form of the amplitudes, which is 0/0.
TEST(HardCase, PartsWithoutACoatWhereALampSets) {
  paint::LobeFit bare = matt({0.1, 0.2, 0.05});
  bare.lobes = {{6, {0.05, 0.1, 0.02}, {0.01, 0.01, 0.01}}};
  bare.coat_index = paint::kNoCoat;
  paint::LobeFit coated = bare;
  coated.coat_index = 1.5;
  const mesh::Mesh mesh = panels_mesh(2);
  Scene scene;
  scene.mesh = &mesh, scene.paints = {bare, coated};
  Light disc{{0, 1, 0}, {1, 1, 1}};
  disc.radius_rad = 0.05;
  scene.lights = {disc};
  std::vector<VisiblePoint> points;
  auto sine = static_cast<float>(-std::sin(disc.radius_rad));
  for (int k = 0; k < 4; ++k) sine = std::nextafter(sine, -1.0F);
  for (int k = 0; k < 64; ++k, sine = std::nextafter(sine, 1.0F)) {
    const double y = sine, x = std::sqrt(1 - y * y);
    points.push_back({{x, y, 0}, {x, y, 0}, 0});
  }
  const Effects effects = effects_of(scene);
  CpuEngine cpu;
  ASSERT_TRUE(cpu.load(scene, effects).ok());
  const std::vector<color::Rgb> seen = cpu.colors(points), truth = exact_radiance(points, scene, effects, nullptr);
  double ours = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int c = 0; c < 3; ++c) ours = worst_of(ours, std::abs(seen[i][c] - truth[i][c]));
  const float contrast = 0, c = 0, g = std::sqrt(contrast + c * c), s = c + g;
  const double textbook = worst_of(0, std::abs(1 - 0.5 * std::pow(contrast / (s * s), 2)));
  hard_case("coat-absent", {"a part without a coat where lamps touch the horizon", textbook, ours, 1e-6, "radiance"});
}

// Pictures of every engine are finite: normals turn across the part so that the lamp sets on it.
TEST(Coat, PartsWithoutOneAreFiniteWhereALampSets) {
  mesh::Mesh mesh = panels_mesh(2);
  Light disc{{0, 1, 0}, {1, 1, 1}};
  disc.radius_rad = 0.05;
  const double sine = std::sin(disc.radius_rad);
  for (std::size_t i = 0; i < mesh.normals.size(); ++i) {
    const double y = -sine * (1 - 1e-3 * mesh.positions[i].y);
    mesh.normals[i] = {0, y, std::sqrt(1 - y * y)};
  }
  Scene scene;
  scene.mesh = &mesh, scene.paints = {matt({0.1, 0.2, 0.05}), matt({0.1, 0.2, 0.05})};
  scene.paints[1].coat_index = 1.5;
  scene.lights = {disc};
  const View view{Camera{{0, 0, 4}, {0, 0, 0}, {0, 1, 0}, 15}, 64, 64, 1, true};
  for (const EngineInfo* engine : engines()) {
    if (engine->needs_texels) continue;
    auto renderer = Renderer::create();
    Frame frame;
    ASSERT_TRUE(renderer.ok() && renderer->load(scene, engine->name).ok() && renderer->draw(view, frame).ok());
    int seen = 0, finite = 0;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        if (frame.gbuffer->part(x, y) != 0) continue;
        ++seen;
        finite += std::isfinite(frame.centers.pixel(x, y)[0]) ? 1 : 0;
      }
    EXPECT_GT(seen, 500) << engine->name;
    EXPECT_EQ(finite, seen) << engine->name;
  }
}

// The unoccluded light of a transport is the light that the engine cpu draws, also where parts differ in their coats.
TEST(Coat, IsInTheOpenLightOfATransport) {
  const mesh::Mesh mesh = sphere_mesh(48);
  const std::vector<double> exponents = {1.3, 6, 40, 300, 3000};
  envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, exponents);
  const auto sky = [](const Vec3& d) { return Vec3{1.2 + d.y, 1 + 0.5 * d.x, 1 - 0.5 * d.z}; };
  env.diffuse.map = env.mirror.map = cube_of(16, sky);
  for (envmap::PrefilteredLobe& lobe : env.lobes) lobe.map = cube_of(16, sky);
  Scene scene;
  scene.mesh = &mesh, scene.env = &env, scene.gloss_deg = {60};
  const View view{Camera::orbit(mesh, 30, 20, 1, 30, 1), 24, 24, 1, true};
  const LobeColumns columns{exponents};
  for (const double coat_index : {paint::kNoCoat, 1.5, 1.54}) {
    paint::LobeFit paint = rich_paint();
    paint.coat_index = coat_index;
    scene.paints = {paint};
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer.ok() && renderer->load(scene, "cpu").ok());
    Frame frame;
    ASSERT_TRUE(renderer->draw(view, frame).ok());
    const auto open = OpenLight::create(scene, columns, {coat_index == 1.5 ? paint::kNoCoat : 1.5, coat_index});
    const auto weights = column_weights(columns, paint.diffuse, paint.lobes, 60);
    ASSERT_TRUE(open.ok() && weights.ok());
    std::vector<color::Rgb> light(columns.count());
    double off = 0, control = 0;
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        if (frame.gbuffer->part(x, y) < 0) continue;
        for (const int part : {0, 1}) {
          open->at(frame.gbuffer->normal(x, y), frame.gbuffer->to_viewer(x, y), part, light.data());
          color::Rgb sum;
          for (std::size_t k = 0; k < columns.count(); ++k) sum += light[k] * (*weights)[k];
          const double apart = std::abs(sum.y - frame.centers.pixel(x, y)[1]);
          (part == 1 ? off : control) = std::max(part == 1 ? off : control, apart);
        }
      }
    // Lobes with two weights share one direction in the engine; in the columns each has its own.
    EXPECT_LE(off, 5e-3) << coat_index;
    if (coat_index != 1.54) {  // that of 1.5 is close
      EXPECT_GT(control, 2e-2) << coat_index;
    }
  }
}

// The columns of a transport under a coat are the parts of the lobe model under it.
TEST(Coat, IsInTheColumnsOfATransportAndInPaths) {
  paint::LobeFit paint = rich_paint();
  paint.coat_index = 1.54;
  const LobeColumns columns{{1.3, 6, 40, 300, 3000}};
  const auto weights = column_weights(columns, paint.diffuse, paint.lobes, 60);
  ASSERT_TRUE(weights.ok());
  const auto traced = TracedPaint::create(paint, 60, {});
  ASSERT_TRUE(traced.ok());
  TestNumbers next(5);
  const auto direction = [&] {
    const double z = 0.02 + 0.98 * next(), p = 2 * kPi * next(), s = std::sqrt(1 - z * z);
    return Vec3{s * std::cos(p), s * std::sin(p), z};
  };
  double control = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 viewer = direction(), light = direction();
    const PaintedPoint point(*traced, {0, 0, 1}, rays::float3(viewer));
    const PaintedPoint basis = point.of_basis(columns.exponents);
    const PaintedPoint::Shares values = basis.shares(rays::float3(light));
    color::Rgb sum;
    for (std::size_t k = 0; k < columns.count(); ++k) sum += values.of[k] * (*weights)[k];
    const color::Rgb wanted = light.z * brdf::coated_brdf(paint, light, viewer, {0, 0, 1}, 60),
                     f = rays::vec3(point.at(rays::float3(light)).f_cos);
    paint::LobeFit bare = paint;
    bare.coat_index = paint::kNoCoat;
    const color::Rgb without = light.z * brdf::coated_brdf(bare, light, viewer, {0, 0, 1}, 60);
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(sum[c], wanted[c], 1e-4 * wanted[c] + 1e-7);
      EXPECT_NEAR(f[c], wanted[c], 1e-4 * wanted[c] + 1e-7);
      control = std::max(control, std::abs(without[c] / wanted[c] - 1));
    }
    EXPECT_NEAR(basis.mirror().x, brdf::fresnel_dielectric(viewer.z, 1.54), 1e-5);
  }
  EXPECT_GT(control, 0.5);
}

}  // namespace
}  // namespace goniochrome::render::coat_test
