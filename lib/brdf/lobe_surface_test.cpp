#include "brdf/lobe_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"

namespace goniochrome::brdf::lobe_surface_test {
namespace {

// The definition of McAllister's equation 2, with the frame of the lobe as three vectors.
color::Rgb by_definition(const LobeSurface& surface, const Vec3& wi, const Vec3& wo) {
  color::Rgb f = surface.diffuse;
  for (const TurnedLobe& turned : surface.lobes) {
    const Vec3 x = {std::cos(turned.turn_rad), std::sin(turned.turn_rad), 0}, y = cross({0, 0, 1}, x);
    const double p = turned.lobe.axes.x * dot(wo, x) * dot(wi, x) + turned.lobe.axes.y * dot(wo, y) * dot(wi, y) +
                     turned.lobe.axes.z * wo.z * wi.z;
    if (p > 0) f += std::pow(p, turned.lobe.exponent) * turned.lobe.albedo;
  }
  return f;
}

Vec3 direction(double elevation_deg, double azimuth_deg) {
  const double e = elevation_deg * kDegree, a = azimuth_deg * kDegree;
  return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

const LafortuneLobe kBrushed{{0.5, 0.4, 0.3}, {-1, -0.4, 1}, 30};

TEST(LobeSurface, ALobeTurnedByAnyAngleReflectsAsItsDefinition) {
  for (const double turn_deg : {-170.0, -100.0, -45.0, -10.0, 0.0, 30.0, 60.0, 90.0, 135.0, 300.0}) {
    const LobeSurface ours{{0.1, 0.1, 0.1}, {turned_lobe(kBrushed, turn_deg * kDegree)}};
    EXPECT_LE(std::abs(ours.lobes[0].turn_rad), 45.0001 * kDegree);
    const LobeSurface plain{{0.1, 0.1, 0.1}, {{kBrushed, turn_deg * kDegree}}};
    for (double a = 5; a < 360; a += 35) {
      const Vec3 wi = direction(50, a), wo = direction(65, 190 + 0.8 * a);
      EXPECT_NEAR(brdf(ours, wi, wo).x, by_definition(plain, wi, wo).x, 1e-12) << turn_deg << " " << a;
    }
  }
}

TEST(LobeSurface, ATexelThatIsReadAndWrittenStaysAsItIs) {
  SbrdfTexture texture{1, 1, 2, std::vector<float>(19)};
  const LobeSurface surface{{0.1, 0.2, 0.3}, {turned_lobe(kBrushed, 0.3), {{{1, 1, 1}, {-1, -1, 1}, 8}, 0}}};
  write_texel(surface, 2, 1, texture.values.data());
  EXPECT_EQ(texture.values[11], 8) << "ascending exponents";
  const LobeSurface back = lobe_surface(texture, 0, 0);
  ASSERT_EQ(back.lobes.size(), 2U);
  const SbrdfTexel texel = sbrdf_texel(texture, 0, 0);
  const SurfaceFrame frame = surface_frame(texel, {0, 0, 1}, {1, 0, 0});
  for (double a = 5; a < 360; a += 35) {
    const Vec3 wi = direction(50, a), wo = direction(65, 190 + 0.8 * a);
    EXPECT_NEAR(brdf(back, wi, wo).y, brdf(surface, wi, wo).y, 1e-6);
    EXPECT_NEAR(brdf(texel.surface, frame.local(wi), frame.local(wo)).y, brdf(surface, wi, wo).y, 1e-6);
  }
}

// The control takes the mean of the lobes' parameters, as a filter of the channels does.
TEST(LobeSurface, AMixtureReflectsTheMeanOfWhatItsPartsReflect) {
  const LobeSurface a{{0.1, 0.1, 0.1}, {{{{1, 1, 1}, {-1, -1, 1}, 10}, 0}}};
  const LobeSurface b{{0.3, 0.2, 0.1}, {{{{2, 2, 2}, {-1, -1, 1}, 150}, 0}, {{{1, 0, 0}, {-1, -1, 1}, 10}, 0}}};
  LobeSurface sum;
  add_surface(sum, a, 0.25), add_surface(sum, b, 0.75);
  EXPECT_EQ(sum.lobes.size(), 2U) << "lobes of one exponent are one";
  const LobeSurface control{{0.25, 0.175, 0.1}, {{{{1.75, 1.75, 1.75}, {-1, -1, 1}, 115}, 0}}};
  double worst = 0, worst_control = 0;
  for (double e = 10; e < 90; e += 10) {
    const Vec3 wi = direction(e, 0), wo = direction(60, 175);
    const color::Rgb truth = 0.25 * by_definition(a, wi, wo) + 0.75 * by_definition(b, wi, wo);
    worst = std::max(worst, std::abs(brdf(sum, wi, wo).x / truth.x - 1));
    worst_control = std::max(worst_control, std::abs(brdf(control, wi, wo).x / truth.x - 1));
  }
  EXPECT_LT(worst, 1e-14);
  EXPECT_GT(worst_control, 0.3);
}

TEST(LobeSurface, OneFrameIsToldFromTwo) {
  LobeSurface surface{{}, {turned_lobe(kBrushed, 0.2), turned_lobe(kBrushed, 0.2 + kPi / 2)}};
  EXPECT_TRUE(has_one_frame(surface)) << "a quarter of a turn exchanges the axes";
  surface.lobes.push_back({{{1, 1, 1}, {-1, -1, 1}, 5}, 0});
  EXPECT_TRUE(has_one_frame(surface)) << "a round lobe has no direction";
  surface.lobes.push_back(turned_lobe(kBrushed, 0.9));
  EXPECT_FALSE(has_one_frame(surface));
}

// The reference is the lobe model itself, sampled about the mirror direction; the exact share of light of a mirror is
// Fresnel's.
TEST(LobeSurface, APaintKeepsItsExponentsAndReflectsLikeItsLobeModel) {
  paint::LobeFit fit;
  fit.coat_index = 1.5;
  fit.diffuse = {0.02, 0.01, 0.005};
  fit.lobes = {
      {6, {0.2, 0.1, 0.05}, {}}, {70, {0.3, 0.3, 0.3}, {0.02, 0.02, 0.02}}, {paint::kMirrorExponent, {}, {1, 1, 1}}};
  const PaintedSurface painted = painted_surface(fit, 60, 3000);
  for (const TurnedLobe& lobe : painted.surface.lobes)
    EXPECT_TRUE(lobe.lobe.exponent == 6 || lobe.lobe.exponent == 70 || lobe.lobe.exponent == 3000);
  EXPECT_LT(painted.mirror_error, 0.07);  // 0.065 was measured
  // Away from the mirror image and from grazing angles; the passages of the coat differ most at 60 deg, by 8 %.
  for (const double view_deg : {0.0, 20.0, 45.0, 60.0}) {
    for (const double as_deg : {15.0, 25.0, 45.0}) {
      const Vec3 wi = direction(90 - view_deg, 0), wo = direction(90 - view_deg + as_deg, 180);
      const double truth = coated_brdf(fit, wi, wo, {0, 0, 1}, 60).x;
      EXPECT_NEAR(brdf(painted.surface, wi, wo).x / truth, 1, 0.1) << view_deg << " " << as_deg;
    }
  }
  for (const double view_deg : {0.0, 30.0, 60.0, 75.0}) {
    const double cosine = std::cos(view_deg * kDegree);
    double share = 0;
    for (const TurnedLobe& lobe : painted.surface.lobes)
      if (lobe.lobe.exponent == 3000) share += environment_fetch(lobe.lobe, direction(90 - view_deg, 0)).weight.x;
    EXPECT_NEAR(share / fresnel_dielectric(cosine, 1.5), 1, 0.06) << view_deg;
  }
}

// Three lobes of three directions, one of which is round, through a texel and back. One frame for all is the control.
TEST(LobeSurface, LobesKeepDirectionsOfTheirOwn) {
  const LobeSurface surface = {
      {0.05, 0.04, 0.03},
      {turned_lobe({{0.5, 0.4, 0.3}, {-1, -0.3, 1}, 20}, 0.2), turned_lobe({{0.2, 0.4, 0.3}, {-1, -0.5, 1}, 40}, 1.9),
       turned_lobe({{0.1, 0.1, 0.1}, {-1, -1, 1}, 10}, 0)}};
  ASSERT_FALSE(has_one_frame(surface));
  SbrdfTexture texture{1, 1, 4, {}};
  texture.values.resize(static_cast<std::size_t>(texture.stride()));
  texture.turns.resize(8);
  write_texel(surface, 4, 1, texture.values.data(), texture.turns.data());
  const auto apart = [&] {
    double most = 0;
    for (int i = 0; i < 8; ++i) {
      const Vec3 wi = direction(50, 45 * i), wo = direction(65, 45 * i + 170);
      const color::Rgb wanted = brdf(surface, wi, wo);
      const color::Rgb by_texel = brdf(lobe_surface(texture, 0, 0), wi, wo);
      color::Rgb by_parts;
      for (const SbrdfTexel& texel : sbrdf_texels(texture, 0, 0)) {
        const SurfaceFrame frame = surface_frame(texel, {0, 0, 1}, {1, 0, 0});
        by_parts += brdf(texel.surface, frame.local(wi), frame.local(wo));
      }
      for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(by_parts[c], by_texel[c], 1e-12 * (1 + by_texel[c]));
        most = std::max(most, std::abs(by_texel[c] - wanted[c]) / wanted[c]);
      }
    }
    return most;
  };
  EXPECT_LT(apart(), 1e-5) << "single precision, to the power of 40";
  texture.turns.clear();
  EXPECT_GT(apart(), 0.1) << "the control";
}

}  // namespace
}  // namespace goniochrome::brdf::lobe_surface_test
