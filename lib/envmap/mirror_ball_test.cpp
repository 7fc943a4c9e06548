#include "envmap/internal/mirror_ball.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "base/angles.h"
#include "base/vec3.h"
#include "envmap/environment.h"

namespace goniochrome::envmap::mirror_ball_test {
namespace {

using testing::HasSubstr;

// A scene without symmetry, of gradients up to 1.5 a radian.
Vec3 scene(const Vec3& d) {
  return {2 + d.x + 0.3 * d.y * d.z, 1.5 + d.y - 0.4 * d.x, 3 + 0.8 * d.z + 0.5 * d.x * d.y};
}

// The picture of a camera at +Z: rays that run along -Z meet a ball and leave by the law of reflection. Each texel is
// the mean of 8 x 8 rays; those that miss the ball see `ground`.
image::Image photograph(int width, int height, const BallDisc& disc,
                        const std::function<Vec3(double, double)>& ground) {
  constexpr int kRays = 8;
  image::Image image = {width, height, 3, {}, {}};
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column) {
      Vec3 sum;
      for (int j = 0; j < kRays; ++j)
        for (int i = 0; i < kRays; ++i) {
          const double x = column + (i + 0.5) / kRays, y = row + (j + 0.5) / kRays;
          const double u = (x - disc.x) / disc.radius, v = (disc.y - y) / disc.radius;
          const double w2 = 1 - u * u - v * v;
          if (w2 <= 0) {
            sum += ground(x, y);
            continue;
          }
          const Vec3 normal = {u, v, std::sqrt(w2)}, ray = {0, 0, -1};
          sum += scene(ray - 2 * dot(ray, normal) * normal);
        }
      for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(sum[c] / (kRays * kRays)));
    }
  return image;
}

Vec3 black(double, double) {
  return {};
}
Vec3 wallpaper(double x, double y) {
  return {0.4 + 0.2 * std::sin(x / 7), 0.3, 0.5 + 0.2 * std::cos(y / 5)};
}

Environment unrolled(const image::Image& photo, const BallDisc& disc) {
  auto map = unrolled_ball(photo, disc, "ball");
  EXPECT_TRUE(map.ok()) << map.error().message;
  return Environment::from_lat_long(std::move(map).value(), Environment::BadPixels::kError, "ball").value();
}

// The largest error of any direction within `reach` of +Z, by bilinear reading of the photograph and the texels of the
// map.
double largest_error(const Environment& env, double reach_deg) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  double worst = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 d = normalized({normal(random), normal(random), normal(random)});
    if (d.z < std::cos(reach_deg * kDegree)) continue;
    const float* found = env.lookup(d);
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::fabs(found[c] - scene(d)[c]));
  }
  return worst;
}

TEST(MirrorBall, ShowsTheSceneThatItReflects) {
  const BallDisc disc = {150.3, 97.8, 90.6};
  const Environment env = unrolled(photograph(260, 200, disc, wallpaper), disc);
  // A texel of the map is 1/90.6 * pi/2 * (90.6/142) wide; half its diagonal times the slope 1.5 is .024. Toward -Z a
  // texel of the photograph shows up to 12 deg and more.
  EXPECT_LT(largest_error(env, 120), 0.03);
  EXPECT_LT(largest_error(env, 150), 0.06);
  EXPECT_LT(largest_error(env, 180), 0.4);
  // The photograph is as wide in all directions: its light is kept.
  const Vec3 flux = env.flux();
  EXPECT_NEAR(flux.x / (4 * kPi * 2), 1, 2e-3);
  EXPECT_NEAR(flux.y / (4 * kPi * 1.5), 1, 2e-3);
  EXPECT_NEAR(flux.z / (4 * kPi * 3), 1, 4e-3);
  // A mirror image, a ball of another size or an angular map would not pass.
  EXPECT_GT(largest_error(unrolled(photograph(260, 200, disc, wallpaper), {150.3, 97.8, 85}), 120), 0.1);
  EXPECT_GT(largest_error(unrolled(photograph(260, 200, disc, wallpaper), {147, 97.8, 90.6}), 120), 0.06);
}

TEST(MirrorBall, IsFoundBeforeADarkGroundWhereverItLies) {
  for (const BallDisc& disc : {BallDisc{150.3, 97.8, 90.6}, BallDisc{40, 42, 38.5}, BallDisc{64, 64, 64}}) {
    const int width = disc.radius == 64 ? 128 : 260, height = disc.radius == 64 ? 128 : 200;
    const auto found = ball_disc(photograph(width, height, disc, black), "ball");
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_NEAR(found->x, disc.x, 0.25);
    EXPECT_NEAR(found->y, disc.y, 0.25);
    EXPECT_NEAR(found->radius, disc.radius, 0.7);
  }
}

// A fifth of the ball reflects something black, which takes a piece out of its outline.
TEST(MirrorBall, IsFoundWithADarkPieceAtItsRim) {
  const BallDisc disc = {150.3, 97.8, 90.6};
  image::Image photo = photograph(260, 200, disc, black);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 260; ++x)
      if (x + 0.3 * y > 235) std::fill_n(photo.pixel(x, y), 3, 0.0F);
  const auto found = ball_disc(photo, "ball");
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_NEAR(found->x, disc.x, 0.5);
  EXPECT_NEAR(found->y, disc.y, 0.5);
  EXPECT_NEAR(found->radius, disc.radius, 1);
}

TEST(MirrorBall, IsTheWholeSquareBeforeALitGroundAndElseMustBeNamed) {
  const auto square = ball_disc(photograph(100, 100, {50, 50, 50}, wallpaper), "ball");
  ASSERT_TRUE(square.ok());
  EXPECT_EQ(square->radius, 50);
  const auto unknown = ball_disc(photograph(120, 100, {60, 50, 40}, wallpaper), "ball");
  ASSERT_FALSE(unknown.ok());
  EXPECT_THAT(unknown.error().message, HasSubstr("--ball X,Y,RADIUS"));
}

TEST(MirrorBall, ThatThePictureCutsIsRefused) {
  const BallDisc disc = {50, 97.8, 90.6};
  const image::Image photo = photograph(260, 200, disc, black);
  const auto found = ball_disc(photo, "ball");
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_NEAR(found->x, disc.x, 1);
  const auto map = unrolled_ball(photo, *found, "ball");
  ASSERT_FALSE(map.ok());
  EXPECT_THAT(map.error().message, HasSubstr("beyond the picture of 260 x 200"));
  EXPECT_FALSE(unrolled_ball(photo, {50, 50, 0.5}, "ball").ok());
}

TEST(MirrorBall, NothingRoundIsRefused) {
  image::Image bar = {200, 200, 3, std::vector<float>(120000), {}};
  for (int y = 60; y < 90; ++y)
    for (int x = 30; x < 170; ++x) std::fill_n(bar.pixel(x, y), 3, 1.0F);
  const auto found = ball_disc(bar, "bar");
  ASSERT_FALSE(found.ok());
  EXPECT_THAT(found.error().message, HasSubstr("no round outline"));
  EXPECT_FALSE(ball_disc({200, 200, 3, std::vector<float>(120000), {}}, "black").ok());
}

TEST(MirrorBall, LightInTheCornersOfASquareTellsThatItIsNoAngularMap) {
  EXPECT_TRUE(has_lit_corners(photograph(100, 100, {50, 50, 50}, wallpaper)));
  EXPECT_FALSE(has_lit_corners(photograph(100, 100, {50, 50, 50}, black)));
}

}  // namespace
}  // namespace goniochrome::envmap::mirror_ball_test
