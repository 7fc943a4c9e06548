#include "render/renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "rays/ray_scene.h"
#include "render/internal/seen.h"
#include "render/path/visible_surface.h"
#include "render/scene_effects.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::renderer_test {
namespace {

using testing::HasSubstr;

// Shader arithmetic is float, and llvmpipe's exp and log are polynomials.
constexpr double kFloat = 2e-6;

// The Fresnel reflectance F(x^2) is drawn as 64 straight pieces of x: h^2/8 times its second derivative, which is
// largest at grazing, -11.6.
constexpr double kPieces = 11.6 / 8 / 64 / 64;

Camera front(double distance = 8, double fov_deg = 20) {
  Camera camera;
  camera.eye = {0, 0, distance};
  camera.fov_deg = fov_deg;
  return camera;
}

Frame drawn(const Scene& scene, const Effects& effects, const Camera& camera, int width, int height, int samples = 1) {
  auto renderer = Renderer::create();
  EXPECT_TRUE(renderer.ok());
  const auto loaded = renderer->load(scene, effects, "gl");
  EXPECT_TRUE(loaded.ok()) << loaded.error().message;
  auto frame = renderer->draw(camera, width, height, samples, true);
  EXPECT_TRUE(frame.ok()) << frame.error().message;
  return *std::move(frame);
}

Frame drawn(const Scene& scene, const Camera& camera, int width, int height, int samples = 1) {
  return drawn(scene, effects_of(scene), camera, width, height, samples);
}

double fresnel_share(double cos_o) {
  return brdf::fresnel_dielectric(cos_o, brdf::kCoatIndex) / brdf::fresnel_dielectric(std::sqrt(0.5), brdf::kCoatIndex);
}

template <class Body>
int for_each_visible(const Frame& frame, Body body) {
  int visible = 0;
  for (int y = 0; y < frame.gbuffer->height; ++y) {
    for (int x = 0; x < frame.gbuffer->width; ++x) {
      if (frame.gbuffer->part(x, y) < 0) continue;
      ++visible;
      body(x, y, frame.centers.pixel(x, y));
    }
  }
  return visible;
}

TEST(Renderer, WhiteMattPaintShowsTheConstantEnvironment) {
  const mesh::Mesh mesh = sphere_mesh();
  const envmap::PrefilteredEnvironment env = constant_env({0.25, 0.5, 2}, {});
  Scene scene{&mesh, {matt({1, 1, 1})}, &env, {}, Background::kNone, {}};
  const Frame frame = drawn(scene, front(), 64, 64);
  const int visible = for_each_visible(frame, [](int x, int y, const float* pixel) {
    EXPECT_NEAR(pixel[0], 0.25, 0.25 * kFloat) << x << " " << y;
    EXPECT_NEAR(pixel[1], 0.5, 0.5 * kFloat);
    EXPECT_NEAR(pixel[2], 2, 2 * kFloat);
    EXPECT_EQ(pixel[3], 1);
  });
  EXPECT_NEAR(visible, kPi * std::pow(32 / std::tan(10 * kDegree) / std::sqrt(63), 2), 40);
}

// The closed form of goniochrome-rendering(7), "RENDERING", in a constant environment: every P_E is 1.
TEST(Renderer, FurnaceFollowsTheClosedForm) {
  const mesh::Mesh mesh = sphere_mesh();
  const envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {2.5, 40, 3000});
  paint::LobeFit paint = matt({0.1, 0.2, 0.3});
  paint.lobes.push_back({2.5, {0.01, 0.02, 0.03}, {}});
  paint.lobes.push_back({40, {0.3, 0.2, 0.1}, {0.5, 0.5, 0.5}});
  paint.lobes.push_back({3000, {}, {20, 20, 20}});
  paint.lobes.push_back({paint::kMirrorExponent, {}, {0.9, 0.9, 0.9}});
  Scene scene{&mesh, {paint}, &env, {}, Background::kNone, {}};
  Effects effects = effects_of(scene);
  effects.horizon = false;
  const Frame frame = drawn(scene, effects, front(), 64, 64);
  const int visible = for_each_visible(frame, [&](int x, int y, const float* pixel) {
    const double c = dot(frame.gbuffer->normal(x, y), frame.gbuffer->to_viewer(x, y));
    for (int channel = 0; channel < 3; ++channel) {
      double wanted = kPi * paint.diffuse[channel] + 0.9 * brdf::fresnel_dielectric(c, brdf::kCoatIndex);
      double pieces = 0.9 * kPieces;  // the cosine c = x^2 bends less
      for (int j = 0; j < 3; ++j) {
        const paint::Lobe& lobe = paint.lobes[static_cast<std::size_t>(j)];
        const double solid_angle = 2 * kPi / (lobe.exponent + 1);
        wanted += (c * lobe.directional_diffuse[channel] + fresnel_share(c) * lobe.gloss[channel]) * solid_angle;
        pieces += kPieces *
                  (lobe.directional_diffuse[channel] +
                   lobe.gloss[channel] / brdf::fresnel_dielectric(std::sqrt(0.5), brdf::kCoatIndex)) *
                  solid_angle;
      }
      EXPECT_NEAR(pixel[channel], wanted, pieces + 1e-5 * wanted) << x << " " << y;
    }
  });
  EXPECT_GT(visible, 1000);
}

// Random texels show every mistake in the order, the turning or the flipping of faces, in the texel rule, at edges and
// at corners.
TEST(Renderer, MirrorShowsTheEnvironmentAsTheCubeMapHasIt) {
  const mesh::Mesh mesh = sphere_mesh();
  TestNumbers random(7);
  envmap::PrefilteredEnvironment env = constant_env({0, 0, 0}, {});
  env.mirror.map = cube_of(8, [&](const Vec3&) { return Vec3{random(), random(), random()}; });
  Scene scene{&mesh, {only_mirror()}, &env, {}, Background::kEnvironment, {}};
  int compared = 0;
  for (const auto& [azimuth, elevation] : {std::pair{0, 0}, {90, 10}, {200, -50}, {300, 80}}) {
    const Frame frame = drawn(scene, Camera::orbit(mesh, azimuth, elevation, 1, 40, 1), 96, 96);
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 96; ++x) {
        const bool seen = frame.gbuffer->part(x, y) >= 0;
        const Vec3 n = frame.gbuffer->normal(x, y), wo = frame.gbuffer->to_viewer(x, y);
        const Vec3 direction = seen ? 2 * dot(n, wo) * n - wo : -wo;
        const Vec3 wanted = (seen ? brdf::fresnel_dielectric(dot(n, wo), brdf::kCoatIndex) : 1) *
                            envmap::bilinear(env.mirror.map, direction);
        for (int c = 0; c < 3; ++c)
          EXPECT_NEAR(frame.centers.pixel(x, y)[c], wanted[c], 1e-4 + kPieces) << x << " " << y;
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 4 * 96 * 96);
}

// One bright direction, and where a person would look for its reflection: half way between it and the viewer.
TEST(Renderer, OneBrightTexelIsSeenOnItsOwnSide) {
  const mesh::Mesh mesh = sphere_mesh();
  struct Case {
    Vec3 direction;
    int right, up;  // of the sphere's middle in the picture
  };
  for (const Case& one : {Case{{1, 0, 0}, 1, 0}, {{-1, 0, 0}, -1, 0}, {{0, 1, 0}, 0, 1}, {{0, -1, 0}, 0, -1}}) {
    envmap::PrefilteredEnvironment env = constant_env({0, 0, 0}, {});
    env.mirror.map =
        cube_of(15, [&](const Vec3& d) { return dot(d, one.direction) > 0.9999 ? Vec3{1, 1, 1} : Vec3{}; });
    Scene scene{&mesh, {only_mirror()}, &env, {}, Background::kNone, {}};
    const Frame frame = drawn(scene, front(8, 15), 101, 101);
    double sum = 0, x_sum = 0, y_sum = 0;
    for_each_visible(frame, [&](int x, int y, const float* pixel) {
      sum += pixel[0], x_sum += pixel[0] * (x - 50), y_sum += pixel[0] * (50 - y);
    });
    ASSERT_GT(sum, 0);
    const double sphere = 50 / std::tan(7.5 * kDegree) / std::sqrt(63);  // its radius in pixels
    EXPECT_NEAR(x_sum / sum, one.right * sphere * std::sqrt(0.5), 3);
    EXPECT_NEAR(y_sum / sum, one.up * sphere * std::sqrt(0.5), 3);
  }
}

TEST(Renderer, LightsFollowTheExactBrdf) {
  const mesh::Mesh mesh = sphere_mesh();
  paint::LobeFit paint = matt({0.1, 0.2, 0.3});
  paint.lobes.push_back({0.3, {0.05, 0.02, 0.03}, {}});
  paint.lobes.push_back({25, {0.3, 0.2, 0.1}, {0.5, 0.5, 0.5}});
  paint.lobes.push_back({4000, {}, {200, 200, 200}});
  Scene scene{&mesh,
              {paint},
              nullptr,
              {{normalized({1, 2, 3}), {1, 1, 1}}, {normalized({-3, -1, 0.5}), {2, 0, 1}}},
              Background::kNone,
              {}};
  const Frame frame = drawn(scene, front(), 128, 128);
  double brightest = 0;
  for_each_visible(frame, [&](int x, int y, const float* pixel) {
    const Vec3 n = frame.gbuffer->normal(x, y), wo = frame.gbuffer->to_viewer(x, y);
    color::Rgb wanted;
    for (const Light& light : scene.lights) {
      const double cos_i = std::max(0.0, dot(n, light.direction));
      paint::LobeFit here = paint;
      for (paint::Lobe& lobe : here.lobes) {
        lobe.gloss = fresnel_share(length(light.direction + wo) / 2) * lobe.gloss;
      }
      wanted += kPi * cos_i * (light.white * brdf::brdf(here, light.direction, wo, n));
    }
    brightest = std::max(brightest, wanted.x);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(pixel[c], wanted[c], 2e-4 * wanted[c] + 1e-6) << x << " " << y;
  });
  EXPECT_GT(brightest, 100) << "the sharp highlight was met";
}

// The normal of the ideal sphere that the pixel's ray meets. Interpolating exact normals over triangles of size h errs
// by h^2/8 = 2e-5 rad at the middle, and the flat triangle moves the point by as much over the cosine.
TEST(Renderer, SphereNormalsAreExact) {
  const mesh::Mesh mesh = sphere_mesh();
  Scene scene{&mesh, {matt({1, 1, 1})}, nullptr, {Light{}}, Background::kNone, {}};
  const Camera camera = Camera::orbit(mesh, 30, 20, 1, 30, 1);
  const Frame frame = drawn(scene, camera, 128, 128);
  const int visible = for_each_visible(frame, [&](int x, int y, const float*) {
    const Vec3 ray = -frame.gbuffer->to_viewer(x, y);
    const double b = dot(camera.eye, ray), under_root = b * b - dot(camera.eye, camera.eye) + 1;
    if (under_root < 1e-3) return;  // the outline
    const Vec3 wanted = camera.eye + (-b - std::sqrt(under_root)) * ray;
    const double cos_o = -dot(wanted, ray);
    EXPECT_LT(length(frame.gbuffer->normal(x, y) - wanted), 4e-5 / cos_o + 1e-6) << x << " " << y;
    EXPECT_GE(dot(frame.gbuffer->normal(x, y), -ray), 9e-4) << "never away from the viewer";
  });
  EXPECT_GT(visible, 5000);
}

TEST(Renderer, EachPartWearsItsPaint) {
  const mesh::Mesh mesh = panels_mesh(3);
  const envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {});
  Scene scene{
      &mesh, {matt({1, 0, 0}), matt({0, 1, 0}), matt({0, 0, 1})}, &env, {}, Background::kColor, {0.5, 0.25, 0.125}};
  const Frame frame = drawn(scene, front(4, 30), 120, 60);
  for (int panel = 0; panel < 3; ++panel) {
    const int x = 60 + (panel - 1) * 28;
    EXPECT_EQ(frame.gbuffer->part(x, 30), panel);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(frame.centers.pixel(x, 30)[c], c == panel ? 1 : 0, kFloat);
  }
  EXPECT_EQ(frame.gbuffer->part(60, 2), -1);
  EXPECT_EQ(frame.centers.pixel(60, 2)[1], 0.25F);
  EXPECT_EQ(frame.centers.pixel(60, 2)[3], 1);
}

// Panels that share an edge leave no gap and no line between them, however the picture is turned and sampled.
TEST(Renderer, PartsMeetWithoutASeam) {
  const mesh::Mesh mesh = panels_mesh(7);
  const envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {});
  Scene scene{&mesh, std::vector<paint::LobeFit>(7, matt({0.5, 0.5, 0.5})), &env, {}, Background::kNone, {}};
  for (const int samples : {1, 4, 16}) {
    Camera camera = front(1.2, 25);
    camera.eye = {0.3, 0.05, 1.2};
    camera.target = {0.31, 0.02, 0};
    camera.up = {0.3, 1, 0};
    const Frame frame = drawn(scene, camera, 128, 96, samples);
    for (int y = 0; y < 96; ++y) {
      for (int x = 0; x < 128; ++x) {
        EXPECT_NEAR(frame.picture.pixel(x, y)[0], 0.5, kFloat) << x << " " << y;
        EXPECT_EQ(frame.picture.pixel(x, y)[3], 1);
      }
    }
  }
}

// An upright edge at a known place: coverage is resolved in as many steps as there are samples.
TEST(Renderer, SamplesResolveCoverage) {
  const mesh::Mesh mesh = panels_mesh(2);
  const envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {});
  Scene scene{&mesh, std::vector<paint::LobeFit>(2, matt({1, 1, 1})), &env, {}, Background::kNone, {}};
  for (const int samples : {4, 16}) {
    for (const double part : {0.1, 0.3, 0.55, 0.9}) {
      Camera camera = front(1, 30);
      const double pixel = 2 * std::tan(15 * kDegree) / 20;
      camera.eye = {1 - part * pixel, 0, 1};  // the edge at x = 1 falls at this part of pixel 10
      camera.target = {1 - part * pixel, 0, 0};
      const Frame frame = drawn(scene, camera, 20, 20, samples);
      const float* edge = frame.picture.pixel(10, 10);
      EXPECT_NEAR(edge[3], part, 0.51 / samples + 1e-6) << samples;
      EXPECT_NEAR(edge[0], edge[3], kFloat) << "premultiplied";
      EXPECT_EQ(frame.picture.pixel(9, 10)[3], 1);
      EXPECT_EQ(frame.picture.pixel(11, 10)[3], 0);
    }
  }
}

// Where the center of a pixel tells its mean, the samples are not shaded. Beside the mean over all of them, the picture
// keeps a tenth of its tolerance at 95 of 100 pixels, and half of it in the worst. The control: centers alone do not.
// Centers that nobody asked for are left out where no pixel is told by them, whatever was in the picture before.
TEST(Renderer, CentersStandForSamplesThatTheyTell) {
  constexpr int kSize = 192, kSamples = 4;
  constexpr double kTolerance = 0.5;  // of a renderer that was asked for none
  const mesh::Mesh mesh = sphere_mesh(64);
  const envmap::PrefilteredEnvironment env = uneven_env({1.3, 6, 40, 300, 3000}, {32, 20, 44, 100, 64});
  const Scene scene{&mesh, {rich_paint()}, &env, {}, Background::kEnvironment, {}};
  const Camera camera = Camera::orbit(mesh, 30, 20, 1, 30, 1);
  Renderer renderer = Renderer::tracing();
  ASSERT_TRUE(renderer.load(scene, "cpu").ok());
  const auto frame = renderer.draw(camera, kSize, kSize, kSamples, true);
  ASSERT_TRUE(frame.ok());
  Frame alone;
  alone.picture.data.assign(frame->picture.data.size(), NAN);
  ASSERT_TRUE(renderer.draw({camera, kSize, kSize, kSamples, false}, alone).ok());
  EXPECT_EQ(alone.picture.data, frame->picture.data);
  const rays::RayScene met = *rays::RayScene::create(mesh);
  std::vector<color::Rgb> mean(frame->picture.data.size() / 4);
  for (const auto& [x, y] : sample_shifts(kSamples)) {
    Renderer one = Renderer::shading(
        std::make_shared<const Gbuffer>(mesh_gbuffer(met, rays(camera, kSize, kSize)->shifted(x, y), kSize, kSize)));
    ASSERT_TRUE(one.load(scene, "cpu").ok());
    const auto sample = one.draw(camera, kSize, kSize, 1);
    ASSERT_TRUE(sample.ok());
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += (1.0 / kSamples) * vec3(&sample->picture.data[4 * i]);
  }
  std::vector<double> off, of_centers;
  int told = 0;
  for (std::size_t i = 0; i < mean.size(); ++i) {
    off.push_back(seen_difference(vec3(&frame->picture.data[4 * i]), mean[i], 1));
    of_centers.push_back(seen_difference(vec3(&frame->centers.data[4 * i]), mean[i], 1));
    told += std::equal(&frame->picture.data[4 * i], &frame->picture.data[4 * i + 3], &frame->centers.data[4 * i]);
  }
  EXPECT_GT(told, kSize * kSize / 2);
  EXPECT_LT(percentile_95(off), 0.1 * kTolerance);
  EXPECT_LT(std::ranges::max(off), 0.5 * kTolerance);
  EXPECT_GT(percentile_95(of_centers), 5 * percentile_95(off));
  EXPECT_GT(std::ranges::max(of_centers), 10 * kTolerance);
}

TEST(Renderer, BackSidesAreTurnedAndMarked) {
  const mesh::Mesh mesh = sphere_mesh(32);
  Scene scene{&mesh, {matt({1, 1, 1})}, nullptr, {Light{}}, Background::kNone, {}};
  Camera camera;
  camera.eye = {0.1, 0, 0};
  camera.target = {1, 0, 0};
  camera.fov_deg = 60;
  const Frame frame = drawn(scene, camera, 32, 32);
  const int visible = for_each_visible(frame, [&](int x, int y, const float*) {
    EXPECT_LT(frame.gbuffer->at(x, y)[3], 0);
    EXPECT_EQ(frame.gbuffer->part(x, y), 0);
    EXPECT_GT(dot(frame.gbuffer->normal(x, y), frame.gbuffer->to_viewer(x, y)), 0);
  });
  EXPECT_EQ(visible, 32 * 32);
}

TEST(Renderer, MissingLobeNamesExponentAndCommand) {
  const mesh::Mesh mesh = sphere_mesh(8);
  envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {6});
  env.source = "hall.hdr";
  paint::LobeFit paint;
  paint.lobes.push_back({6, {1, 1, 1}, {}});
  paint.lobes.push_back({12.5, {}, {1, 1, 1}});
  paint.lobes.push_back({70, {}, {}});  // no weight: not needed
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  const auto refused = renderer->load({&mesh, {paint}, &env, {}, Background::kNone, {}});
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("no lobe of exponent 12.5"));
  EXPECT_THAT(refused.error().message, HasSubstr("prefilter-envmap hall.hdr --exponents 6,12.5 "));
  env.mirror = {};
  const auto no_mirror = renderer->load({&mesh, {only_mirror()}, &env, {}, Background::kNone, {}});
  ASSERT_FALSE(no_mirror.ok());
  EXPECT_THAT(no_mirror.error().message, HasSubstr("no mirror part"));
  EXPECT_TRUE(renderer->load({&mesh, {paint}, nullptr, {Light{}}, Background::kNone, {}}).ok())
      << "lights alone need no lobe maps";
}

TEST(Renderer, ShaderHoldsOnlyWhatTheSceneUses) {
  const mesh::Mesh mesh = sphere_mesh(8);
  const envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {6, 20});
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  ASSERT_TRUE(renderer->load({&mesh, {matt({1, 1, 1})}, &env, {}, Background::kNone, {}}).ok());
  for (const char* word : {"lobe_", "fresnel", "light", "cos_power", "mirror"}) {
    EXPECT_EQ(renderer->shader().find(word), std::string::npos) << word;
  }
  paint::LobeFit paint = only_mirror();
  paint.lobes.insert(paint.lobes.begin(), {20, {1, 1, 1}, {1, 1, 1}});
  ASSERT_TRUE(renderer->load({&mesh, {paint}, &env, {Light{}}, Background::kNone, {}}).ok());
  for (const char* word : {"lobe_0", "fresnel", "light", "cos_power", "mirror", "E = 20"}) {
    EXPECT_NE(renderer->shader().find(word), std::string::npos) << word;
  }
  EXPECT_EQ(renderer->shader().find("lobe_1"), std::string::npos);
}

TEST(Renderer, OneRendererDrawsManyScenesAndSizes) {
  const mesh::Mesh mesh = sphere_mesh(64), panels = panels_mesh(2);
  const envmap::PrefilteredEnvironment env = constant_env({1, 1, 1}, {6});
  paint::LobeFit paint = matt({0.5, 0.5, 0.5});
  paint.lobes.push_back({6, {0.1, 0.1, 0.1}, {}});
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  std::vector<float> first;
  for (int turn = 0; turn < 3; ++turn) {
    ASSERT_TRUE(renderer->load({&mesh, {paint}, &env, {}, Background::kNone, {}}).ok());
    const auto frame = renderer->draw(front(), 64, 48, 1);
    ASSERT_TRUE(frame.ok());
    if (turn == 0) first = frame->picture.data;
    EXPECT_EQ(frame->picture.data, first);
    ASSERT_TRUE(renderer->load({&panels, {paint, matt({0, 0, 0})}, nullptr, {Light{}}, Background::kNone, {}}).ok());
    ASSERT_TRUE(renderer->draw(front(), 33, 77, 4).ok());
  }
}

TEST(Renderer, KeptViewsAndEditedPaintsDrawWhatFreshOnesDo) {
  const mesh::Mesh mesh = sphere_mesh(64);
  const envmap::PrefilteredEnvironment env = uneven_env({1.3, 6, 40, 300, 3000}, {32, 20, 44, 100, 64});
  Scene scene{&mesh, {rich_paint()}, &env, {}, Background::kNone, {}};
  const View view{Camera::orbit(mesh, 30, 20, 1, 30, 1), 64, 64, 4, true};
  for (const char* engine : {"gl", "cpu"}) {
    auto renderer = Renderer::create();
    ASSERT_TRUE(renderer->load(scene, engine).ok());
    Frame first, edited, fresh;
    ASSERT_TRUE(renderer->draw(view, first).ok());
    Scene other = scene;
    other.paints[0].diffuse = {0.2, 0.05, 0.01};
    renderer->load_paints(other);
    ASSERT_TRUE(renderer->draw(view, edited).ok());
    EXPECT_NE(first.picture.data, edited.picture.data);
    auto again = Renderer::create();
    ASSERT_TRUE(again->load(other, engine).ok());
    ASSERT_TRUE(again->draw(view, fresh).ok());
    EXPECT_EQ(fresh.picture.data, edited.picture.data);
    EXPECT_EQ(fresh.centers.data, edited.centers.data);
  }
}

TEST(Renderer, ShadingRefusesWhatNeedsTheMesh) {
  const mesh::Mesh mesh = panels_mesh(2);
  const Scene scene{&mesh, std::vector<paint::LobeFit>(2, matt({1, 1, 1})), nullptr, {Light{}}, Background::kNone, {}};
  Renderer renderer = Renderer::shading(drawn(scene, front(4, 30), 32, 32).gbuffer);
  EXPECT_THAT(renderer.load(scene, "gl").error().message, HasSubstr("engine gl"));
  ASSERT_TRUE(renderer.load(scene, "cpu").ok());
  Frame frame;
  EXPECT_THAT(renderer.draw({front(4, 30), 32, 32, 4, false}, frame).error().message,
              HasSubstr("1 sample a pixel, not 4"));
}

}  // namespace
}  // namespace goniochrome::render::renderer_test
