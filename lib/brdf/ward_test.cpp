#include "brdf/ward.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/hard_case_for_test.h"

namespace goniochrome::brdf::ward_test {
namespace {

Vec3 direction(double polar_rad, double azimuth_rad) {
  return {std::sin(polar_rad) * std::cos(azimuth_rad), std::sin(polar_rad) * std::sin(azimuth_rad),
          std::cos(polar_rad)};
}

// The control: [Ward1992] 5a with the square root of both cosines.
double textbook(const Vec3& wi, const Vec3& wo, const paint::Anisotropy& a) {
  const Vec3 h = normalized(wi + wo);
  const double exponent = -2 * (std::pow(h.x / a.alpha_x, 2) + std::pow(h.y / a.alpha_y, 2)) / (1 + h.z);
  return std::exp(exponent) / std::sqrt(wi.z * wo.z) / (4 * kPi * a.alpha_x * a.alpha_y);
}

// The integral of f cos_i over the hemisphere of h, mapped from the equal-area plane: midpoint rule in polar angle of
// u, stretched by the widths, so that narrow lobes are resolved.
template <class F>
double albedo(const F& f, const Vec3& wo, const paint::Anisotropy& a) {
  constexpr int kRadii = 300, kTurns = 360;
  double sum = 0;
  for (int i = 0; i < kRadii; ++i) {
    for (int j = 0; j < kTurns; ++j) {
      const double r = 6 * (i + 0.5) / kRadii, phi = 2 * kPi * (j + 0.5) / kTurns;
      const double ux = a.alpha_x * r * std::cos(phi), uy = a.alpha_y * r * std::sin(phi), u2 = ux * ux + uy * uy;
      if (u2 >= 2) continue;
      const double scale = std::sqrt(1 - u2 / 4);
      const Vec3 h = {ux * scale, uy * scale, 1 - u2 / 2};
      const double c = dot(h, wo);
      if (c <= 0) continue;
      const Vec3 wi = 2 * c * h - wo;
      if (wi.z <= 0) continue;
      const double area = a.alpha_x * a.alpha_y * r * (6.0 / kRadii) * (2 * kPi / kTurns);
      sum += f(wi, wo, a) * wi.z * 4 * c * area;
    }
  }
  return sum;
}

TEST(HardCase, WardGrazingIsFiniteAndSendsBackNoMoreThanItGot) {
  double most = 0, textbook_most = 0;
  for (const double polar_deg : {0.0, 30.0, 60.0, 80.0, 89.0, 89.99, 89.9999999}) {
    const Vec3 wo = direction(polar_deg * kDegree, 0.4);
    for (const paint::Anisotropy a :
         {paint::Anisotropy{1e-4, 0.1}, {0.05, 0.3}, {0.3, 0.3}, {0.2, 1.0}, {1.0, 1e-3}, {3, 3}}) {
      most = worst_of(most, albedo(ward, wo, a));
      textbook_most = worst_of(textbook_most, albedo(textbook, wo, a));
    }
  }
  EXPECT_GT(most, 0.98);
  // The control divides by sqrt(cos_i cos_o); 1e-3 is the quadrature's own error.
  hard_case("ward-grazing", {.what = "light sent back over light received, up to 89.9999999 deg",
                             .textbook = textbook_most,
                             .ours = most,
                             .bound = 1 + 1e-3,
                             .unit = "energy"});

  for (const double tiny : {1e-8, 1e-160, 1e-300}) {
    const Vec3 grazing = {1, 0, tiny}, steep = direction(0.5, 1), opposite = {-1, 0, tiny};
    for (const paint::Anisotropy a : {paint::Anisotropy{1e-4, 0.1}, {1, 1}}) {
      EXPECT_TRUE(std::isfinite(ward(grazing, steep, a)));
      EXPECT_TRUE(std::isfinite(ward(grazing, opposite, a) * tiny));
      EXPECT_LE(ward(grazing, opposite, a) * tiny, 1 / (4 * kPi * a.alpha_x * a.alpha_y) * (1 + 1e-12));
    }
  }
  EXPECT_FALSE(std::isfinite(textbook({1, 0, 1e-200}, {-1, 0, 1e-200}, {1, 1})));
  EXPECT_EQ(ward({0, 0, -1}, {0, 0, 1}, {0.1, 0.1}), 0);
}

TEST(Ward, AlbedoOfNarrowLobesIsTheCosine) {
  for (const double polar_deg : {0.0, 45.0, 75.0}) {
    const Vec3 wo = direction(polar_deg * kDegree, 1.1);
    // The first correction is of the order alpha^2.
    EXPECT_NEAR(albedo(ward, wo, {0.01, 0.03}), wo.z, 5 * 0.03 * 0.03);
  }
}

TEST(Ward, IsReciprocalAndAgreesWithThePrintedFormAtMirrorPairs) {
  const paint::Anisotropy a = {0.1, 0.4};
  const Vec3 wi = direction(0.7, 0.2), wo = direction(0.9, 2.8);
  EXPECT_EQ(ward(wi, wo, a), ward(wo, wi, a));
  const Vec3 mirror = {-wi.x, -wi.y, wi.z};
  EXPECT_NEAR(ward(wi, mirror, a) / textbook(wi, mirror, a), 1, 1e-14);
  // Beside the mirror direction the two differ by the square of the cosines' difference: (x - y)^2/(8 x y).
  const Vec3 beside = normalized(mirror + Vec3{0, 0, 0.05});
  const double expected = std::pow(wi.z - beside.z, 2) / (8 * wi.z * beside.z);
  EXPECT_NEAR(textbook(wi, beside, a) / ward(wi, beside, a) - 1, expected, 0.1 * expected);
}

// The wide lobe in half vectors, along the line through the peak, against the sum of the tilted narrow lobes.
double tilt_error(const TiltSet& set, double wide) {
  double worst = 0;
  for (double u = -std::min(4 * wide, 1.2); u <= std::min(4 * wide, 1.2); u += set.narrow_alpha / 8) {
    double sum = 0;
    for (const Tilt& tilt : set.tilts) {
      const double t = std::copysign(std::sqrt(2 * (1 - tilt.normal.z)), tilt.normal.y);
      sum += tilt.weight * std::exp(-std::pow((u - t) / set.narrow_alpha, 2)) * wide / set.narrow_alpha;
    }
    worst = std::max(worst, std::abs(sum - std::exp(-std::pow(u / wide, 2))));
  }
  return worst;
}

TEST(HardCase, WardGrazingTiltCountComesFromTheErrorBound) {
  int fewest = kMostTilts, most = 0;
  double ours = 0, fixed_count = 0;
  for (const double ratio : {1.0, 1.005, 1.2, 2.0, 4.0, 10.0, 25.0, 100.0}) {
    for (const double tolerance : {0.1, 0.01, 1e-4}) {
      const double wide = 0.25;
      const auto set = ward_tilts({wide / ratio, wide}, 0, tolerance);
      ASSERT_TRUE(set.ok());
      ours = worst_of(ours, set->error / tolerance);
      EXPECT_LE(tilt_error(*set, wide), set->error * (1 + 1e-9) + 1e-9) << ratio;
      const int count = static_cast<int>(set->tilts.size());
      fewest = std::min(fewest, count), most = std::max(most, count);
      double sum = 0;
      for (const Tilt& tilt : set->tilts) {
        sum += tilt.weight;
        EXPECT_NEAR(length(tilt.normal), 1, 1e-15);
        EXPECT_EQ(tilt.normal.x, 0);
      }
      EXPECT_NEAR(sum, 1, 1e-14);
      // The control: a fixed count of nine, spread over two standard deviations, breaks the highlight apart.
      if (ratio < 25) continue;
      TiltSet nine = {{}, wide / ratio, 0};
      for (int k = -4; k <= 4; ++k) {
        const double t = k * wide / 4;
        nine.tilts.push_back({{0, t * std::sqrt(1 - t * t / 4), 1 - t * t / 2}, std::exp(-16.0 * k * k / 256)});
      }
      double total = 0;
      for (const Tilt& tilt : nine.tilts) total += tilt.weight;
      for (Tilt& tilt : nine.tilts) tilt.weight /= total;
      fixed_count = worst_of(fixed_count, tilt_error(nine, wide) / tolerance);
    }
  }
  EXPECT_EQ(fewest, 1);
  EXPECT_GT(most, 81);
  hard_case("ward-grazing", {.what = "error of the tilted lobes over the tolerance, axes 1 to 100",
                             .textbook = fixed_count,
                             .ours = ours,
                             .bound = 1,
                             .unit = "ratio"});
}

TEST(Ward, TiltsOfExtremeAndSwappedAxes) {
  const auto extreme = ward_tilts({1e-4, 0.1}, 0, 0.01);
  ASSERT_TRUE(extreme.ok());
  EXPECT_GT(extreme->tilts.size(), 1000u);
  EXPECT_LE(extreme->error, 0.01);
  // A lobe basis that stops at E = 3000 is as wide as alpha = 0.013: far fewer serve.
  const auto basis = ward_tilts({1e-4, 0.1}, lobe_alpha(3000), 0.01);
  ASSERT_TRUE(basis.ok());
  EXPECT_LT(basis->tilts.size(), 40u);
  EXPECT_DOUBLE_EQ(basis->narrow_alpha, lobe_alpha(3000));
  const auto capped = ward_tilts({1e-4, 0.1}, 0, 0.01, 9);
  ASSERT_TRUE(capped.ok());
  EXPECT_EQ(capped->tilts.size(), 9u);
  EXPECT_GT(capped->error, 0.5);
  const auto along_x = ward_tilts({0.4, 0.1}, 0, 0.01);
  ASSERT_TRUE(along_x.ok());
  for (const Tilt& tilt : along_x->tilts) EXPECT_EQ(tilt.normal.y, 0);
  EXPECT_FALSE(ward_tilts({0, 0.1}, 0, 0.01).ok());
  EXPECT_FALSE(ward_tilts({0.1, NAN}, 0, 0.01).ok());
  EXPECT_EQ(ward_tilts({0.2, 0.2}, 0, 0.01)->tilts.size(), 1u);
}

}  // namespace
}  // namespace goniochrome::brdf::ward_test
