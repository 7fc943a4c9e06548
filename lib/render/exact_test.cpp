#include "render/exact.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "brdf/ward.h"
#include "math/cosine_power.h"
#include "render/picture_error.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::exact_test {
namespace {

envmap::Environment lat_long(int width, int height, const std::function<Vec3(int column, int row)>& radiance) {
  image::Image image{width, height, 3, {}, {}};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const Vec3 value = radiance(column, row);
      for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(value[c]));
    }
  }
  auto environment =
      envmap::Environment::from_lat_long(std::move(image), envmap::Environment::BadPixels::kError, "test");
  EXPECT_TRUE(environment.ok());
  return *std::move(environment);
}

paint::LobeFit one_lobe(double exponent, double directional_diffuse, double gloss) {
  paint::LobeFit paint;
  paint.lobes.push_back({exponent, directional_diffuse * color::Rgb{1, 1, 1}, gloss * color::Rgb{1, 1, 1}});
  return paint;
}

color::Rgb at(const paint::LobeFit& paint, const Vec3& normal, const Vec3& to_viewer, const envmap::Environment& env) {
  return reference_radiance({{normal, to_viewer, &paint}}, &env, {}).front();
}

// In a constant environment, seen along the normal: K_D pi, K_DD 2 pi/(E+2), K_G 2 pi/(E+1). Texels of h = 2.8 deg err
// by h^2/24 E or so, until the lobe is narrower and they are cut.
TEST(ReferenceRadiance, ConstantEnvironmentHasAClosedForm) {
  const envmap::Environment env = lat_long(128, 64, [](int, int) { return Vec3{2, 1, 0.5}; });
  const Vec3 n = normalized({0.3, 0.5, -0.8});
  EXPECT_NEAR(at(matt({0.5, 0.5, 0.5}), n, n, env).x, 1, 1e-3);
  for (const double exponent : {0.0, 0.5, 1.0, 7.0, 100.0, 3000.0, 1e5, 1e6}) {
    const double diffuse = 2 * kPi / (exponent + 2), gloss = 2 * kPi / (exponent + 1);
    EXPECT_NEAR(at(one_lobe(exponent, 1, 0), n, n, env).y / diffuse, 1, 2e-3) << exponent;
    EXPECT_NEAR(at(one_lobe(exponent, 0, 1), n, n, env).y / gloss, 1, 2e-3) << exponent;
  }
  // The control, the same sum over texel centers, misses a sharp lobe altogether.
  double centers = 0;
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 128; ++column) {
      const Vec3 apart = env.direction(column, row) - n;
      centers += env.solid_angle(column, row) * math::cos_power_from_versine(0.5 * dot(apart, apart), 1e5);
    }
  }
  EXPECT_GT(std::abs(centers * (1e5 + 1) / (2 * kPi) - 1), 0.1);
}

// Against the definition, with brdf/lobe_model's f and its aspecular angle by atan2.
TEST(ReferenceRadiance, IsTheSumOverTexelsOfTheExactBrdf) {
  TestNumbers random(11);
  const envmap::Environment env = lat_long(32, 16, [&](int, int) { return Vec3{random(), random(), random()}; });
  for (int trial = 0; trial < 50; ++trial) {
    paint::LobeFit paint = matt({random(), random(), random()});
    for (const double exponent : {0.7, 1.3}) {  // wide enough not to be cut
      paint.lobes.push_back({exponent, {random(), random(), random()}, {random(), random(), random()}});
    }
    const Vec3 n = normalized({random() - 0.5, random() - 0.5, random() - 0.5});
    Vec3 wo = normalized({random() - 0.5, random() - 0.5, random() - 0.5});
    if (dot(n, wo) < 0) wo = -wo;
    color::Rgb wanted;
    for (int row = 0; row < 16; ++row) {
      for (int column = 0; column < 32; ++column) {
        const Vec3 wi = env.direction(column, row);
        const float* texel = env.radiance(column, row);
        const double weight = env.solid_angle(column, row) * std::max(0.0, dot(n, wi));
        wanted += weight * (brdf::brdf(paint, wi, wo, n) * color::Rgb{texel[0], texel[1], texel[2]});
      }
    }
    const color::Rgb sum = at(paint, n, wo, env);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], wanted[c], 1e-12 * wanted[c]);
  }
}

// About one tilt after the other, each of which is summed as it is. The control has fewer tilts.
TEST(ReferenceRadiance, OfABrushedPointIsTheSumOverItsTilts) {
  const envmap::Environment env = lat_long(64, 32, [](int column, int row) {
    return row > 6 && row < 11 && column % 16 < 3 ? Vec3{40, 35, 30} : Vec3{.4, .5, .7};
  });
  const Vec3 n = normalized({0.3, 0.5, 0.8});
  for (const double exponent : {2.0, 6.0, 30.0, 200.0}) {
    const paint::LobeFit paint = one_lobe(exponent, 0.3, 0.2);
    const paint::Anisotropy alpha{brdf::lobe_alpha(200), 0.3};
    const auto tilts = brdf::ward_tilts(alpha, alpha.alpha_x, 1e-3)->tilts;
    for (const double view_deg : {0.0, 40.0, 80.0}) {
      const Vec3 across = normalized(cross(n, {0, 1, 0}));
      const Vec3 viewer = std::cos(view_deg * kDegree) * n + std::sin(view_deg * kDegree) * across;
      const auto about = [&](std::vector<brdf::Tilt> some) {
        ExactModel model;
        model.tilts = std::move(some);
        return reference_radiance({{n, viewer, &paint, &model}}, &env, {}).front().y;
      };
      double sum = 0;
      for (const brdf::Tilt& tilt : tilts) sum += tilt.weight * about({{tilt.normal, 1}});
      EXPECT_NEAR(about(tilts) / sum, 1, 2e-4) << exponent << " at " << view_deg;
      if (exponent == 200) {
        EXPECT_GT(std::abs(about(brdf::ward_tilts(alpha, alpha.alpha_x, 1e-3, 6)->tilts) / sum - 1), 2e-4);
      }
    }
  }
}

// A patch is a patch, not a point: a lobe of E = 1e4 over one bright texel of 2.8 deg, against a fine brute-force sum.
TEST(ReferenceRadiance, SharpLobeSeesTexelsAsPatches) {
  const envmap::Environment env =
      lat_long(128, 64, [](int column, int row) { return column == 40 && row == 30 ? Vec3{1, 1, 1} : Vec3{}; });
  const paint::LobeFit paint = one_lobe(1e4, 0, 1);
  for (const double off : {0.0, 0.3, 0.5, 0.9}) {  // from the middle of the texel to its edge and beyond
    const Vec3 n = env.direction_at(40.5 + off, 30.5);
    double wanted = 0;
    constexpr int kFine = 1000;
    for (int j = 0; j < kFine; ++j) {
      for (int i = 0; i < kFine; ++i) {
        const Vec3 d = env.direction_at(40 + (i + 0.5) / kFine, 30 + (j + 0.5) / kFine);
        wanted += math::cos_power_from_versine(0.5 * dot(d - n, d - n), 1e4);
      }
    }
    wanted *= env.solid_angle(40, 30) / (kFine * kFine);
    EXPECT_NEAR(at(paint, n, n, env).x, wanted, 2e-3 * 2 * kPi / 1e4) << off;
  }
}

TEST(ReferenceRadiance, NothingComesFromBelowTheHorizon) {
  const envmap::Environment env =
      lat_long(64, 32, [](int, int row) { return row >= 16 ? Vec3{1, 1, 1} : Vec3{}; });  // -Y half
  paint::LobeFit paint = one_lobe(5, 1, 1);
  paint.diffuse = {1, 1, 1};
  EXPECT_EQ(at(paint, {0, 1, 0}, normalized({1, 0.1, 0}), env), color::Rgb{});
  // The textbook picture form, which prefilters the whole sphere, takes light from there: approximation (b).
  const Vec3 r = normalized({-1, 0.1, 0});
  double below = 0;
  for (int row = 16; row < 32; ++row) {
    for (int column = 0; column < 64; ++column) {
      below += env.solid_angle(column, row) * std::pow(std::max(0.0, dot(r, env.direction(column, row))), 5);
    }
  }
  EXPECT_GT(below, 0.1);
}

TEST(ReferenceRadiance, MirrorIsFresnelTimesTheLightSeen) {
  const envmap::Environment env = lat_long(8, 4, [](int column, int row) { return Vec3{1.0 * column, 1.0 * row, 1}; });
  const Vec3 n{0, 0, 1}, wo = normalized({0.4, 0.2, 0.7});
  const Vec3 mirrored = env.blended(2 * dot(n, wo) * n - wo);
  const double fresnel = brdf::fresnel_dielectric(wo.z, brdf::kCoatIndex);
  const color::Rgb seen = at(only_mirror(0.5), n, wo, env);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(seen[c], 0.5 * fresnel * mirrored[c], 1e-15);
}

TEST(ReferenceRadiance, LightsAreIrradianceOverPi) {
  paint::LobeFit paint = one_lobe(30, 0.3, 0.1);
  paint.diffuse = {0.1, 0.2, 0.3};
  const Light light{normalized({1, 1, 3}), {2, 1, 0.5}};
  const Vec3 n{0, 0, 1}, wo = normalized({-1, 0, 2});
  const color::Rgb seen = reference_radiance({{n, wo, &paint}}, nullptr, {light}).front();
  const color::Rgb f = brdf::brdf(paint, light.direction, wo, n);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(seen[c], kPi * light.direction.z * light.white[c] * f[c], 1e-14);
  }
}

TEST(ReferenceRadiance, HardCase_ThreadsGiveTheSameBits) {
  TestNumbers random(5);
  const envmap::Environment env = lat_long(64, 32, [&](int, int) { return Vec3{random(), random(), random()}; });
  paint::LobeFit paint = one_lobe(500, 0.1, 3);
  std::vector<SurfacePoint> points;
  for (int i = 0; i < 100; ++i) {
    const Vec3 n = normalized({random() - 0.5, random() - 0.5, random() - 0.5});
    points.push_back({n, normalized(n + Vec3{0.5 * random(), 0.5 * random(), 0.5 * random()}), &paint});
  }
  std::vector<std::vector<color::Rgb>> results;
  for (const int count : {1, 2, 7}) {
    set_threads(count);
    results.push_back(reference_radiance(points, &env, {}));
  }
  set_threads(0);
  double apart = 0;
  for (const auto& other : results)
    for (std::size_t i = 0; i < points.size(); ++i) apart = worst_of(apart, length(other[i] - results[0][i]));
  // The control: one running sum taken in another order does not come out the same.
  double forward = 0, backward = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    forward += results[0][i].x;
    backward += results[0][points.size() - 1 - i].x;
  }
  hard_case("threads", {.what = "reference radiance by 1, 2 and 7 threads",
                        .textbook = std::abs(forward - backward),
                        .ours = apart,
                        .bound = 0,
                        .unit = "radiance"});
}

TEST(PictureError, IsNothingForTheReferenceItselfAndTellsTheWorstPixel) {
  const mesh::Mesh mesh = panels_mesh(1);
  const Light light{normalized({0, 1, 1}), {1, 1, 1}};
  const Scene scene{&mesh, {matt({0.5, 0.3, 0.2})}, nullptr, {light}, Background::kNone, {}};
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  ASSERT_TRUE(renderer->load(scene).ok());
  Camera camera;
  camera.eye = {0, 0, 4};
  auto frame = renderer->draw(camera, 40, 40, 1, true);
  ASSERT_TRUE(frame.ok());
  const PictureError none = picture_error(*frame, scene, nullptr, 1, 1000000, 1);
  EXPECT_LT(none.de00_max, 1e-3);
  EXPECT_GT(none.checked_pixels, 300);
  EXPECT_EQ(picture_error(*frame, scene, nullptr, 1, 25, 1).checked_pixels, 25);

  frame->centers.pixel(20, 18)[0] *= 2;
  const PictureError one = picture_error(*frame, scene, nullptr, 1, 1000000, 1);
  EXPECT_GT(one.de00_max, 5);
  EXPECT_EQ(one.worst_x, 20);
  EXPECT_EQ(one.worst_y, 18);
  EXPECT_LT(one.de00_p95, 1e-3);
  EXPECT_NEAR(one.de00_mean, one.de00_max / one.checked_pixels, 1e-3);
}

}  // namespace
}  // namespace goniochrome::render::exact_test
