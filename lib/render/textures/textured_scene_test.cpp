// Pictures of textured parts: both engines, the certificate, and what the plan says of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/angles.h"
#include "render/exact.h"
#include "render/gl/gl.h"
#include "render/gl/shader.h"
#include "render/integral/integral_engine.h"
#include "render/internal/seen.h"
#include "render/picture_error.h"
#include "render/planning.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"
#include "render/surface_layer.h"
#include "render/textures/textured_scene_for_test.h"

namespace goniochrome::render::textured_scene_test {
namespace {

TEST_F(TexturedScene, EnginesAgree) {
  scene.lights = {{normalized({0.4, 0.5, 1}), {1, 0.8, 0.6}}};
  scene.reflection = color::iso_rgb_operator();
  dress();
  for (const int samples : {1, 4}) {
    view.samples = samples;
    const Frame gl = drawn("gl", effects_of(scene)), cpu = drawn("cpu", effects_of(scene));
    double worst = 0;
    for (std::size_t i = 0; i < gl.picture.data.size(); i += 4) {
      const float *a = &gl.picture.data[i], *b = &cpu.picture.data[i];
      worst = std::max(worst, seen_difference({a[0], a[1], a[2]}, {b[0], b[1], b[2]}, 1));
    }
    EXPECT_LT(worst, 0.05) << samples;
  }
}

// A coated paint with a mirror, and a map over it.
class Alpha : public TexturedScene {
 protected:
  Alpha() {
    scene.lights = {{normalized({0.4, 0.5, 1}), {1, 0.8, 0.6}}};
    paint::LobeFit paint;
    paint.diffuse = {0.2, 0.02, 0.01};
    paint.lobes = {{16, {0.3, 0.05, 0.02}, {0.1, 0.1, 0.1}}, {64, {}, {1, 1, 1}}};
    paint.coat_index = 1.5;
    scene.paints = {paint};
  }
  // The texture with so much alpha in column k as `alpha` says.
  brdf::SbrdfTexture covering(const std::function<double(int)>& alpha) const {
    brdf::SbrdfTexture result = texture;
    for (int row = 0; row < texture.height; ++row) {
      for (int column = 0; column < texture.width; ++column) {
        const auto a = static_cast<float>(alpha(column));
        const auto at = static_cast<std::size_t>(row * texture.width + column);
        float* values = &result.values[at * static_cast<std::size_t>(texture.stride())];
        for (int c = 0; c < 3; ++c) values[c] *= a;
        for (int lobe = 0; lobe < texture.lobes; ++lobe)
          for (int c = 0; c < 3; ++c) values[5 + 7 * lobe + c] *= a;
        result.alpha.push_back(a);
      }
    }
    return result;
  }
  void wear(PartSurface surface) {
    layer = std::make_unique<SurfaceLayer>(scene, std::vector<PartSurface>{std::move(surface)},
                                           brdf::CriticalAngle::kSlide);
    scene.layer = layer.get();
  }
};

// A map of alpha a shows a of the map and 1-a of the paint, whichever engine draws. Paths see lamps alone, which they
// draw without noise. The map without alpha is the control.
TEST_F(Alpha, AShareOfThePaintIsSeen) {
  constexpr double kShare = 0.3;
  const brdf::SbrdfTexture sheer = covering([](int) { return kShare; });
  const envmap::Environment source = sloping_source();
  const envmap::BlockTree blocks(source);
  view.width = view.height = 48;
  for (const char* engine : {"cpu", "gl", "integral", "path"}) {
    const bool lamps_alone = engine == std::string("path");
    scene.env = lamps_alone ? nullptr : &env;
    scene.texels = engine == std::string("integral") ? &blocks : nullptr;
    view.samples = engine == std::string("cpu") ? 4 : 1;
    scene.layer = nullptr;
    const Frame paint = drawn(engine, effects_of(scene));
    std::vector<paint::LobeFit> bare = {{}};
    std::swap(scene.paints, bare);
    wear({{{&texture, 6}}});
    const Frame map = drawn(engine, effects_of(scene));
    std::swap(scene.paints, bare);
    wear({{{&sheer, 6}}});
    const Frame both = drawn(engine, effects_of(scene));
    double worst = 0, control = 0;
    for (std::size_t i = 0; i < both.picture.data.size(); ++i) {
      const double wanted = kShare * map.picture.data[i] + (1 - kShare) * paint.picture.data[i];
      if (i % 4 == 3) continue;
      worst = std::max(worst, std::abs(both.picture.data[i] - wanted));
      control = std::max(control, std::abs(map.picture.data[i] - wanted));
    }
    EXPECT_LT(worst, 2e-4) << engine;  // of 0 to 3; maps by the integral end at 1e-4
    EXPECT_GT(control, 0.1) << engine;
  }
}

// A kept view draws what a fresh one does. It keeps what it shows of a texture from its second picture on, and each
// paint asks for samples of other pixels.
TEST_F(Alpha, AKeptViewServesPaintsThatWantOtherPixels) {
  const brdf::SbrdfTexture sheer = covering([](int) { return 0.3; });
  wear({{{&sheer, 0.2}}});
  view.width = view.height = 256, view.samples = 4;
  Renderer renderer = Renderer::tracing();
  ASSERT_TRUE(renderer.load(scene, effects_of(scene), "cpu").ok());
  const paint::LobeFit first = scene.paints[0];
  for (const double scale : {1.0, 30.0, 0.01, 1.0}) {
    scene.paints[0] = first;
    scene.paints[0].diffuse = scale * first.diffuse;
    for (paint::Lobe& lobe : scene.paints[0].lobes) lobe.gloss = scale * lobe.gloss;
    renderer.load_paints(scene);
    Frame kept;
    ASSERT_TRUE(renderer.draw(view, kept).ok());
    EXPECT_EQ(kept.picture.data, drawn("cpu", effects_of(scene)).picture.data) << scale;
  }
}

// Three facets of a map, letters over them and a second, narrower map over all: they lie over what OpenGL drew as over
// what the processor drew, and the certificate agrees. The order turned around is the control.
TEST_F(Alpha, MapsLieOverOneAnother) {
  const brdf::SbrdfTexture letters = covering([](int column) {
    return column % 3 == 0 ? 0.0 : column % 3 == 1 ? 1.0 : 0.4;
  });
  const brdf::SbrdfTexture ground = {2, 1, 1, {0.1F,  0.05F, 0.02F, 1, 0, 0.05F, 0.04F, 0.03F, -1, -1, 1, 16,
                                               0.02F, 0.2F,  0.3F,  1, 0, 0.02F, 0.02F, 0.02F, -1, -1, 1, 40}};
  const brdf::SbrdfTexture film = {1, 1, 0, {0.02F, 0.1F, 0.02F, 1, 0}, {0.6F}};
  std::vector<LaidTexture> facets(3, {&ground, 1, {Projection::kFacet, {0, 1, 0}, {}, 0.5}, true});
  for (int facet = 0; facet < 3; ++facet) facets[static_cast<std::size_t>(facet)].laying.facet = facet;
  facets[0].blends = false;
  TextureLaying decal{Projection::kDecal, normalized({0.3, 0.2, 1}), {}, 1.2};
  decal.ends = true;
  TextureLaying spot = decal;
  spot.width = 0.7;
  const LaidTexture over{&letters, 1, decal, false}, last{&film, 1, spot, false};
  for (const bool painted : {false, true}) {
    PartSurface surface, turned;
    if (painted) {
      surface = {{over, last}}, turned = {{last, over}};
    } else {
      scene.paints = {{}};
      surface = {{facets[0], facets[1], facets[2], over, last}};
      turned = {{facets[0], facets[1], facets[2], last, over}};
    }
    wear(turned);
    view.samples = 1;
    const Frame control = drawn("cpu", effects_of(scene));
    wear(surface);
    for (const int samples : {4, 1}) {
      view.samples = samples;
      const Frame gl = drawn("gl", effects_of(scene)), cpu = drawn("cpu", effects_of(scene));
      double worst = 0, apart = 0;
      for (std::size_t i = 0; i < gl.picture.data.size(); i += 4) {
        const float *a = &gl.picture.data[i], *b = &cpu.picture.data[i], *c = &control.picture.data[i];
        ASSERT_TRUE(std::isfinite(a[0] + a[1] + a[2])) << i;
        worst = std::max(worst, seen_difference({a[0], a[1], a[2]}, {b[0], b[1], b[2]}, 1));
        apart = std::max(apart, seen_difference({c[0], c[1], c[2]}, {b[0], b[1], b[2]}, 1));
      }
      EXPECT_LT(worst, 0.05) << painted << samples;
      EXPECT_GT(apart, 5) << painted << samples;
      if (samples > 1) continue;
      scene.env = nullptr;
      const Frame lit = drawn("cpu", effects_of(scene));
      EXPECT_LT(picture_error(lit, scene, nullptr, 1, 500, 5).de00_p95, 0.05) << painted;
      EXPECT_GT(picture_error(control, scene, nullptr, 1, 500, 5).de00_p95, 5) << painted;
      scene.env = &env;
    }
  }
}

// The mean over a minified map is the mean of what its texels show over the paint: 256 samples a pixel without the
// filter are the truth, one without it the control.
TEST_F(Alpha, MinifiedMapsCoverTheirMean) {
  const brdf::SbrdfTexture letters = covering([](int column) { return column % 2; });
  wear({{{&letters, 40, {Projection::kPlanar, {0, 0, 1}, {}, 2}}}});
  view.camera = Camera::orbit(mesh, 0, 0, 1, 30, 1);
  view.width = view.height = 48;
  const auto with_filter = [&](bool filter, int samples) {
    Effects effects = effects_of(scene);
    effects.texture_filter = filter;
    view.samples = samples;
    return drawn("cpu", effects);
  };
  const Frame truth = with_filter(false, 256);
  const double left = difference(truth, with_filter(true, 1)), aliased = difference(truth, with_filter(false, 1));
  EXPECT_LT(left, 1.5);
  EXPECT_GT(aliased, 4 * left);
}

// Lights are exact: what is left is single precision, and with footprints the difference of two grids of places.
TEST_F(TexturedScene, CertificateUnderLights) {
  scene.env = nullptr;
  scene.lights = {{normalized({0.4, 0.5, 1}), {1, 0.8, 0.6}}, {normalized({1, 0.2, 0.1}), {0.1, 0.2, 0.5}}};
  scene.reflection = color::iso_rgb_operator();
  dress();
  Effects at_points = effects_of(scene);
  at_points.texture_filter = false;
  const Frame frame = drawn("cpu", at_points);
  const PixelSample sample = sampled_pixels(*frame.gbuffer, scene, 2000, 5);
  const std::vector<color::Rgb> truth = exact_radiance(sample.points, scene, at_points, nullptr);
  double worst = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const float* pixel = frame.centers.pixel(sample.places[i][0], sample.places[i][1]);
    worst = std::max(worst, seen_difference({pixel[0], pixel[1], pixel[2]}, truth[i], 1));
  }
  EXPECT_LT(worst, 0.02);
  const PictureError error = picture_error(drawn("cpu", effects_of(scene)), scene, nullptr, 1, 2000, 5);
  EXPECT_EQ(error.checked_pixels, 2000);
  EXPECT_LT(error.de00_p95, 0.05);
}

// Under a sloping environment a lobe shows the value at its middle, but for the slope of the cosine and what the
// horizon cuts off: together within a small difference in color. The wrong texels are the control.
TEST_F(TexturedScene, CertificateUnderAnEnvironment) {
  dress();
  const Frame frame = drawn("cpu", effects_of(scene));
  const envmap::Environment source = sloping_source();
  const PictureError error = picture_error(frame, scene, &source, 1, 60, 5);
  EXPECT_EQ(error.checked_pixels, 60);
  EXPECT_LT(error.de00_p95, 1.0);
  EXPECT_LT(error.de00_mean, 0.5);
  for (std::size_t i = 0; i < texture.values.size(); i += 29) std::swap(texture.values[i + 3], texture.values[i + 4]);
  EXPECT_GT(picture_error(frame, scene, &source, 1, 60, 5).de00_mean, 3 * error.de00_mean) << "the control";
}

TEST_F(TexturedScene, ThePlanTriesOutTextureAndLobes) {
  dress();
  Frame all, without;
  PlanRequest request;
  request.effects = {Start::kAll};
  const Plan plan = planned(request, all);
  for (const char* name : {"texture", "texture-0", "texture-1", "texture-2"})
    EXPECT_TRUE(item(plan, name).needed) << name;
  for (const char* name : {"texture", "texture-0", "texture-1"}) {
    request.effects = {Start::kAll, {{name, false}}};
    const Plan left = planned(request, without);
    EXPECT_EQ(item(left, name).decision, Decision::kForcedOff);
    const double real = difference(all, without), estimate = item(plan, name).de00_p95;
    // The texels of the probe are not those of the picture; they are as many of each.
    EXPECT_NEAR(std::log2(estimate / real), 0, 0.5) << name << ": " << estimate << " for " << real;
  }
  // Nobody sees the third lobe.
  request.effects = {};
  const Plan chosen = planned(request, without);
  EXPECT_EQ(item(chosen, "texture-2").decision, Decision::kDropped);
  EXPECT_EQ(item(chosen, "texture-1").decision, Decision::kDrawn);
  EXPECT_EQ(item(chosen, "texture").decision, Decision::kDrawn);
  EXPECT_LE(difference(all, without), request.tolerance_de00);
}

TEST_F(TexturedScene, TheIntegralIsWithinWhatIsAsked) {
  dress();
  const envmap::Environment source = sloping_source();
  const envmap::BlockTree blocks(source);
  scene.texels = &blocks;
  Effects effects = effects_of(scene);
  for (const double tolerance : {0.5, 0.1}) {
    effects.tolerance_de00 = tolerance;
    EXPECT_LT(picture_error(drawn("integral", effects), scene, &source, 1, 60, 5).de00_p95, tolerance);
  }
}

TEST_F(TexturedScene, TruthStandsBesideTheEstimate) {
  dress();
  Frame frame;
  PlanRequest request;
  request.effects = {Start::kAll};
  Plan plan = planned(request, frame);
  const envmap::Environment source = sloping_source();
  const PixelSample sample = sampled_pixels(*frame.gbuffer, scene, 60, 3);
  add_truth(plan, scene, sample.points, &source, 1);
  for (const char* name : {"texture", "texture-0", "texture-1"}) {
    const PlanItem tried = item(plan, name);
    ASSERT_TRUE(tried.truth_de00_p95.has_value()) << name;
    EXPECT_NEAR(std::log2(tried.de00_p95 / *tried.truth_de00_p95), 0, 1) << name;
  }
}

// A texture of one texel is a paint: both ways of drawing it, and both certificates, are one.
TEST_F(TexturedScene, OneTexelIsAPaint) {
  texture = {1, 1, 1, {0.1F, 0.05F, 0.02F, 1, 0, 0.5F, 0.4F, 0.3F, -1, -1, 1, 16}};
  scene.lights = {{normalized({0.4, 0.5, 1}), {1, 1, 1}}};
  dress();
  const Frame textured = drawn("cpu", effects_of(scene));
  const envmap::Environment source = sloping_source();
  const double error = picture_error(textured, scene, &source, 1, 40, 5).de00_mean;
  scene.layer = nullptr;
  scene.paints[0].diffuse = {0.1, 0.05, 0.02};
  scene.paints[0].lobes = {{16, {0.5, 0.4, 0.3}, {}}};
  const Frame painted = drawn("cpu", effects_of(scene));
  EXPECT_NEAR(picture_error(painted, scene, &source, 1, 40, 5).de00_mean, error, 0.1);
  EXPECT_LT(difference(textured, painted), 0.3);
}

}  // namespace
}  // namespace goniochrome::render::textured_scene_test
