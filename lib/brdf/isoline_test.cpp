#include "brdf/isoline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "base/angles.h"
#include "base/hard_case_for_test.h"

namespace goniochrome::brdf::isoline_test {
namespace {

constexpr std::array kTreatments = {CriticalAngle::kClip, CriticalAngle::kSlide, CriticalAngle::kSlideMap,
                                    CriticalAngle::kIndexOne};

Vec3 direction(double polar_rad, double azimuth_rad) {
  return {std::sin(polar_rad) * std::cos(azimuth_rad), std::sin(polar_rad) * std::sin(azimuth_rad),
          std::cos(polar_rad)};
}

// The formulas on exact angles, in long double: the half vector of both refracted directions.
struct Exact {
  long double flake, incidence;
};
Exact exact_angles(double ti, double to, double azimuth, long double n) {
  const auto refracted = [n](long double t, long double phi) {
    const long double s = std::sin(t) / n;
    return std::array<long double, 3>{s * std::cos(phi), s * std::sin(phi), std::sqrt((1 - s) * (1 + s))};
  };
  const auto a = refracted(ti, 0), b = refracted(to, azimuth);
  long double h[3], d[3];
  for (int i = 0; i < 3; ++i) h[i] = a[i] + b[i], d[i] = a[i] - b[i];
  return {std::atan2(std::hypot(h[0], h[1]), h[2]),
          std::atan2(std::hypot(d[0], d[1], d[2]), std::hypot(h[0], h[1], h[2]))};
}

// The control: the equations as printed, [Kirchner] 3 and 4.
FlakeAngles printed_angles(const Vec3& wi, const Vec3& wo, double n) {
  const double s1 = std::hypot(wi.x, wi.y) / n, s2 = std::hypot(wo.x, wo.y) / n;
  const double c1 = std::sqrt(1 - s1 * s1), c2 = std::sqrt(1 - s2 * s2);
  const double lengths = std::hypot(wi.x, wi.y) * std::hypot(wo.x, wo.y);
  const double mixed = s1 * s2 * (lengths > 0 ? (wi.x * wo.x + wi.y * wo.y) / lengths : 1) + c1 * c2;
  return {std::acos((c1 + c2) / std::sqrt(2 + 2 * mixed)), 0.5 * std::acos(mixed)};
}

TEST(HardCase, IsolineDegenerateFlakeAnglesToRounding) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  double worst = 0, printed = 0;
  int coincident = 0;
  for (int i = 0; i < 200000; ++i) {
    const double ti = uniform(random) * kPi / 2;
    double to = uniform(random) * kPi / 2, azimuth = uniform(random) * 2 * kPi;
    // A third each: near retro-reflection (incidence -> 0), near specular (flake -> 0), anywhere.
    const double near = std::pow(10.0, -16 * uniform(random));
    if (i % 3 != 2) to = std::min(std::abs(ti + near), kPi / 2), azimuth = near + (i % 3 == 0 ? 0 : kPi), ++coincident;
    const Exact exact = exact_angles(ti, to, azimuth, 1.5L);
    const Vec3 wi = direction(ti, 0), wo = direction(to, azimuth);
    const FlakeAngles ours = flake_angles(wi, wo, 1.5), theirs = printed_angles(wi, wo, 1.5);
    const auto error = [&](const FlakeAngles& got) {
      return static_cast<double>(
          std::max(std::abs(got.flake_rad - exact.flake), std::abs(got.incidence_rad - exact.incidence)));
    };
    worst = worst_of(worst, error(ours));
    printed = worst_of(printed, error(theirs));
  }
  EXPECT_GT(coincident, 100000);
  // The components of the two given directions are rounded to 1.1e-16 themselves, those near 1 and their sums included.
  hard_case("isoline-degenerate", {.what = "flake angles near retro-reflection and specular",
                                   .textbook = printed,
                                   .ours = worst,
                                   .bound = 4e-16,
                                   .unit = "rad"});
}

// [Kirchner] 5 to 7 with phi_flake = 0, as printed: cos t1 and cos t2.
std::array<double, 2> printed_in_plane(const FlakeAngles& f) {
  const double cos1 =
      std::cos(f.flake_rad) * std::cos(f.incidence_rad) - std::sin(f.flake_rad) * std::sin(f.incidence_rad);
  const double sin1 = (std::cos(f.incidence_rad) - std::cos(f.flake_rad) * cos1) / std::sin(f.flake_rad);
  const double t = std::sin(f.flake_rad) * sin1 + std::cos(f.flake_rad) * cos1;
  return {cos1, -cos1 + 2 * t * std::cos(f.flake_rad)};
}

TEST(HardCase, IsolineDegenerateInPlaneMapsToItself) {
  double worst = 0, printed = 0;
  std::vector<double> polar;
  for (double t = 0; t < 90.01; t += 2.5) polar.push_back(std::min(t, 90.0) * kDegree);
  for (const double tiny : {1e-12, 1e-9, 1e-6, 1e-3}) polar.insert(polar.end(), {tiny, kPi / 2 - tiny});
  int broken = 0;
  for (const CriticalAngle treatment : kTreatments) {
    for (const double ti : polar) {
      for (const double to : polar) {
        for (const double side : {1.0, -1.0}) {
          const Vec3 wi = {std::sin(ti), 0, std::cos(ti)}, wo = {side * std::sin(to), 0, std::cos(to)};
          const InPlaneAngles pair = equivalent_in_plane_angles(wi, wo, 1.5, treatment);
          ASSERT_TRUE(std::isfinite(pair.light_rad) && std::isfinite(pair.view_rad));
          const double view = ti == 0 || to == 0 ? std::abs(pair.view_rad) - to : pair.view_rad - side * to;
          worst = worst_of(worst_of(worst, std::abs(pair.light_rad - ti)), std::abs(view));
          const double divided = printed_in_plane(printed_angles(wi, wo, 1.5))[1];
          broken += !std::isfinite(divided);
          printed = worst_of(printed, divided);
        }
      }
    }
  }
  // Every step is a handful of roundings relative to the sines and cosines themselves.
  EXPECT_GT(broken, 100) << "the control, the equations as printed, divides by nothing";
  hard_case(
      "isoline-degenerate",
      {.what = "in-plane pair mapped to itself", .textbook = printed, .ours = worst, .bound = 1e-14, .unit = "rad"});
}

TEST(Isoline, KeepsBothFlakeAngles) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  int kept = 0, beyond = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 wi = direction(std::acos(uniform(random)), 0);
    const Vec3 wo = direction(std::acos(uniform(random)), 2 * kPi * uniform(random));
    const FlakeAngles angles = flake_angles(wi, wo, 1.5);
    if (angles.flake_rad + angles.incidence_rad > std::asin(1 / 1.5)) {
      ++beyond;
      continue;
    }
    const InPlaneAngles pair = equivalent_in_plane_angles(wi, wo, 1.5, CriticalAngle::kClip);
    const FlakeAngles again =
        flake_angles(direction(pair.light_rad, 0), {std::sin(pair.view_rad), 0, std::cos(pair.view_rad)}, 1.5);
    // Next to the horizon the cosine in air is the root of a difference: 1e-16 becomes 1e-8, and refraction takes it
    // back.
    ASSERT_NEAR(again.flake_rad, angles.flake_rad, 2e-15);
    ASSERT_NEAR(again.incidence_rad, angles.incidence_rad, 2e-15);
    ++kept;
  }
  EXPECT_GT(kept, 5000);
  // 60 % of pairs that are uniform over both hemispheres; the spread of the share is 0.35 %.
  EXPECT_NEAR(beyond / 20000.0, 0.60, 0.02);
}

TEST(Isoline, ReciprocalAndIsotropic) {
  const Vec3 wi = direction(0.9, 0.3), wo = direction(0.4, 2.0);
  for (const CriticalAngle treatment : kTreatments) {
    const InPlane one = equivalent_in_plane(wi, wo, 1.5, treatment);
    const InPlane swapped = equivalent_in_plane(wo, wi, 1.5, treatment);
    const InPlane turned = equivalent_in_plane(direction(0.9, 1.3), direction(0.4, 3.0), 1.5, treatment);
    for (const InPlane& other : {swapped, turned}) {
      EXPECT_NEAR(other.cos_far, one.cos_far, 1e-15);
      EXPECT_NEAR(other.cos_near, one.cos_near, 1e-15);
      EXPECT_EQ(other.same_side, one.same_side);
    }
    const InPlaneAngles angles = equivalent_in_plane_angles(wi, wo, 1.5, treatment);
    const InPlaneAngles back = equivalent_in_plane_angles(wo, wi, 1.5, treatment);
    EXPECT_NEAR(std::abs(angles.light_rad), std::abs(back.view_rad), 1e-15);
    EXPECT_NEAR(angles.light_rad * angles.view_rad, back.light_rad * back.view_rad, 1e-15);
  }
}

// Where a pair stands in the color map: its column and height, which are what a lookup sees.
std::array<double, 2> place(const Vec3& wi, const Vec3& wo, double index, CriticalAngle treatment) {
  const InPlane pair = equivalent_in_plane(wi, wo, index, treatment);
  return {pair.cos_far, (pair.same_side ? -1 : 1) * (1 - pair.cos_near)};
}

TEST(HardCase, IsolineCriticalTreatmentsAreContinuous) {
  int crossings = 0;
  double ours = 0, arc_sine = 0;
  for (const CriticalAngle treatment : kTreatments) {
    for (double ti = 20; ti <= 85; ti += 5) {
      for (double to = 20; to <= 85; to += 5) {
        // Bisect for the azimuth at which the steeper in-coat angle is critical, then step across it by 1e-12.
        const auto beyond = [&](double azimuth) {
          const FlakeAngles f = flake_angles(direction(ti * kDegree, 0), direction(to * kDegree, azimuth), 1.5);
          return f.flake_rad + f.incidence_rad > std::asin(1 / 1.5);
        };
        double low = 0, high = kPi / 2;
        if (beyond(low) || !beyond(high)) continue;
        while (high - low > 1e-15) (beyond(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
        ++crossings;
        const Vec3 wi = direction(ti * kDegree, 0);
        const auto inside = place(wi, direction(to * kDegree, low - 1e-12), 1.5, treatment);
        const auto outside = place(wi, direction(to * kDegree, low + 1e-12), 1.5, treatment);
        // Cosines go to 0 as the root of the distance: 1e-12 of angle is some 1e-6.
        for (int k = 0; k < 2; ++k) ours = worst_of(ours, std::abs(inside[k] - outside[k]));
        const FlakeAngles f = flake_angles(wi, direction(to * kDegree, low + 1e-12), 1.5);
        arc_sine = worst_of(arc_sine, std::asin(1.5 * std::sin(f.flake_rad + f.incidence_rad)));
      }
    }
  }
  EXPECT_GT(crossings, 200);
  // The control is the arc sine of Snell's law.
  hard_case("isoline-critical", {.what = "step in place across the critical angle, three treatments",
                                 .textbook = arc_sine,
                                 .ours = ours,
                                 .bound = 5e-6,
                                 .unit = "cosine"});
}

// The steepest change of place over steps of 1e-4 rad anywhere, past the critical angle and before it: no jumps.
TEST(Isoline, PlaceInTheMapHasNoJumps) {
  for (const CriticalAngle treatment : kTreatments) {
    double steepest = 0;
    for (double ti = 2; ti < 90; ti += 4) {
      for (double to = 2; to < 90; to += 4) {
        std::array<double, 2> last{};
        for (int k = 0; k <= 6283; k += 1) {
          const auto at = place(direction(ti * kDegree, 0), direction(to * kDegree, k * 5e-4), 1.5, treatment);
          // Squared column: the column itself is a square root at the border.
          if (k > 0)
            steepest = std::max({steepest, std::abs(at[0] * at[0] - last[0] * last[0]), std::abs(at[1] - last[1])});
          last = at;
        }
      }
    }
    // Both have slopes up to some ten units; kSlideMap adds the root of the distance beyond the border, sqrt(5e-4 x
    // slope).
    EXPECT_LE(steepest, treatment == CriticalAngle::kSlideMap ? 0.04 : 0.01) << critical_angle_name(treatment);
  }
}

TEST(HardCase, IsolineIndex1IsReachedSmoothly) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(0.02, 1);
  double ours = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 wi = direction(std::acos(uniform(random)), 0),
               wo = direction(std::acos(uniform(random)), 6 * uniform(random));
    const auto limit = place(wi, wo, 1, CriticalAngle::kIndexOne);
    const auto exact = place(wi, wo, 1, CriticalAngle::kClip);
    for (int k = 0; k < 2; ++k) ours = worst_of(ours, std::abs(limit[k] - exact[k]));
    for (const double excess : {1e-4, 1e-8, 1e-12, 1e-15}) {
      const auto near = place(wi, wo, 1 + excess, CriticalAngle::kClip);
      // The square of the far cosine and the height move in proportion to n - 1; the slope is of the order of 1/z^2.
      EXPECT_NEAR(near[0] * near[0], limit[0] * limit[0], 100 * excess + 1e-13);
      EXPECT_NEAR(near[1], limit[1], 100 * excess + 1e-13);
    }
  }
  // The control is the equations as printed: at index 1, where no coat lifts it, grazing light and its mirror image
  // leave 0/0.
  const Vec3 grazing = {1, 0, 0}, mirrored = {-1, 0, 0};
  const auto limit = place(grazing, mirrored, 1, CriticalAngle::kIndexOne);
  const auto exact = place(grazing, mirrored, 1, CriticalAngle::kClip);
  for (int k = 0; k < 2; ++k) ours = worst_of(ours, std::abs(limit[k] - exact[k]));
  hard_case("isoline-index-1", {.what = "place by clipping at n = 1 against that of index 1",
                                .textbook = printed_angles(grazing, mirrored, 1).flake_rad,
                                .ours = ours,
                                .bound = 0,
                                .unit = "cosine"});
}

TEST(Isoline, SlideKeepsTheFlakeAngle) {
  const Vec3 wi = direction(70 * kDegree, 0), wo = direction(65 * kDegree, 80 * kDegree);
  const FlakeAngles given = flake_angles(wi, wo, 1.5);
  ASSERT_GT(given.flake_rad + given.incidence_rad, std::asin(1 / 1.5));
  const InPlaneAngles slid = equivalent_in_plane_angles(wi, wo, 1.5, CriticalAngle::kSlide);
  EXPECT_NEAR(slid.light_rad, kPi / 2, 1e-15);
  const FlakeAngles kept = flake_angles({1, 0, 0}, {std::sin(slid.view_rad), 0, std::cos(slid.view_rad)}, 1.5);
  EXPECT_NEAR(kept.flake_rad, given.flake_rad, 1e-15);
  // Clipping keeps the other in-coat angle instead.
  const InPlaneAngles clipped = equivalent_in_plane_angles(wi, wo, 1.5, CriticalAngle::kClip);
  EXPECT_NEAR(std::asin(std::sin(clipped.view_rad) / 1.5), given.flake_rad - given.incidence_rad, 1e-15);
}

TEST(Isoline, NamesOfTreatments) {
  for (const CriticalAngle treatment : kTreatments)
    EXPECT_EQ(critical_angle_of(critical_angle_name(treatment)), treatment);
  EXPECT_FALSE(critical_angle_of("cut"));
}

}  // namespace
}  // namespace goniochrome::brdf::isoline_test
