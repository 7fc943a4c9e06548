#include "brdf/tilted_lobes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"

namespace goniochrome::brdf::tilted_lobes_test {
namespace {

paint::TiltedLobes two_lobes() {
  paint::TiltedLobes set;
  set.lobes = {{20, -30, 0}, {6, 15, 40}};
  set.views = {{0, {0.1, 0.1, 0.1}, {{0.2, 0.1, 0}, {0.1, 0.1, 0.3}}},
               {60, {0.2, 0.1, 0}, {{0, 0.3, 0.1}, {0.3, 0.1, 0.1}}},
               {90, {0, 0, 0}, {{0, 0, 0}, {0.5, 0.5, 0.5}}}};
  return set;
}

TEST(TiltedLobes, AxesAreTurnedInThePlaneAndThenOutOfIt) {
  for (const double view_deg : {kFullTilt_deg, 40.0, 70.0, 89.9, 90.0}) {
    const Vec3 axis = tilted_axis({20, -30, 0}, view_deg);
    EXPECT_NEAR(std::atan2(axis.x, axis.z) / kDegree, view_deg - 30, 1e-9);
    EXPECT_EQ(axis.y, 0);
    const Vec3 out = tilted_axis({20, 10, 25}, view_deg);
    EXPECT_NEAR(std::asin(out.y) / kDegree, 25, 1e-9);
    EXPECT_NEAR(std::atan2(out.x, out.z) / kDegree, view_deg + 10, 1e-9);
    EXPECT_NEAR(length(out), 1, 1e-15);
  }
  // At the normal there is no plane of incidence, and so no tilt.
  EXPECT_EQ(tilted_axis({20, -30, 40}, 0), (Vec3{0, 0, 1}));
}

// A viewer at the azimuth phi about any normal: the sum of world vectors is the axis, turned by phi. The textbook way
// takes the tangent by a division by sin of the view, which is 0/0 at the normal.
TEST(TiltedLobes, TheSumOfVectorsIsTheAxisInAnyFrameAndAtTheNormal) {
  const Vec3 n = normalized({0.3, -0.8, 0.4}), x = normalized(cross({0, 1, 0}, n)), y = cross(n, x);
  for (const double view_deg : {1e-9, 1e-5, 0.01, 1.0, 14.0, 30.0, 60.0, 89.0, 89.9, 90.0}) {
    for (const double phi : {0.0, 1.0, 4.0}) {
      const double t = view_deg * kDegree;
      const Vec3 across = std::cos(phi) * x + std::sin(phi) * y;
      const Vec3 o = std::cos(t) * n - std::sin(t) * across, r = 2 * dot(n, o) * n - o;
      const paint::TiltedLobe lobe{70, -50, 35};
      const AxisSum sum = axis_sum(lobe, view_deg);
      const Vec3 d = sum.a * r + sum.s * n + sum.c * cross(n, o);
      const Vec3 axis = tilted_axis(lobe, view_deg);
      const Vec3 out = cross(n, across);
      // n x o is -sin t out, so that this is the one of the pair on the other side.
      const Vec3 expected = axis.x * across - axis.y * out + axis.z * n;
      // a and c are near 1/sin(15 deg): 8 ulps of them. Nearer to the normal than 1e-4 deg the taper is held.
      EXPECT_LT(length(d - expected), view_deg < 1e-4 ? 3e-5 : 1e-14) << view_deg;
      EXPECT_TRUE(std::isfinite(sum.a) && std::isfinite(sum.s) && std::isfinite(sum.c));
    }
  }
  const AxisSum at_normal = axis_sum({70, -50, 35}, 0);
  EXPECT_NEAR(at_normal.a + at_normal.s, 1, 1e-9);
}

TEST(TiltedLobes, WeightsAreLinearBetweenViewsAndConstantBeyond) {
  const paint::TiltedLobes set = two_lobes();
  EXPECT_EQ(at_view(set, 60), set.views[1]);
  EXPECT_EQ(at_view(set, 0).weights, set.views[0].weights);
  EXPECT_EQ(at_view(set, 90).weights, set.views[2].weights);
  const paint::TiltedView quarter = at_view(set, 15);
  EXPECT_NEAR(quarter.diffuse.x, 0.125, 1e-15);
  EXPECT_NEAR(quarter.weights[0].y, 0.15, 1e-15);
  // Continuous at the views themselves.
  for (const double view_deg : {15.0, 60.0}) {
    const paint::TiltedView low = at_view(set, view_deg - 1e-9), high = at_view(set, view_deg + 1e-9);
    for (std::size_t k = 0; k < 2; ++k) EXPECT_LT(length(low.weights[k] - high.weights[k]), 1e-9);
  }
}

// Even light from all around shows the sum of the weights, and pi K_D.
TEST(TiltedLobes, AWeightIsTheShareOfEvenLight) {
  const paint::TiltedLobes set = two_lobes();
  for (const double view_deg : {0.0, 7.0, 50.0}) {
    const paint::TiltedView view = at_view(set, view_deg);
    color::Rgb sum;
    constexpr int kRows = 400, kColumns = 400;
    for (int row = 0; row < kRows; ++row) {
      const double z = -1 + 2 * (row + 0.5) / kRows, r = std::sqrt(1 - z * z);
      for (int column = 0; column < kColumns; ++column) {
        const double phi = 2 * kPi * (column + 0.5) / kColumns;
        sum += 4 * kPi / (kRows * kColumns) * reflected_part(set, {r * std::cos(phi), r * std::sin(phi), z}, view_deg);
      }
    }
    const color::Rgb expected = kPi * view.diffuse + view.weights[0] + view.weights[1];
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], expected[c], 1e-4);  // the midpoint rule: (h^2/24) of the bend
  }
}

}  // namespace
}  // namespace goniochrome::brdf::tilted_lobes_test
