#include "brdf/disc_light.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "base/vec3.h"
#include "math/cosine_power.h"
#include "math/quadrature.h"

namespace goniochrome::brdf::disc_light_test {
namespace {

using ::testing::Le;

// The integral over the disc about +Z of a function of the direction that is even in y, relative to pi sin^2(radius),
// by brute force: Gauss-Legendre over the polar angle, and even steps of the azimuth over half a turn.
template <class F>
auto brute_force(double radius, int rings, int steps, const F& f) {
  std::vector<Vec3> around;
  for (int k = 0; k < steps / 2; ++k) {
    const double phi = 2 * kPi * (k + 0.5) / steps;
    around.push_back({std::cos(phi), std::sin(phi), 0});
  }
  decltype(f(Vec3{})) sum{};
  for (const math::QuadraturePoint& p : math::gauss_legendre(rings)) {
    const double t = radius * 0.5 * (1 + p.position), sine = std::sin(t), cosine = std::cos(t);
    const double weight = radius * p.weight * sine * (2 * kPi / steps);
    for (const Vec3& a : around) sum += weight * f(Vec3{sine * a.x, sine * a.y, cosine});
  }
  return (1 / (kPi * std::sin(radius) * std::sin(radius))) * sum;
}

Vec3 tilted(double angle) {
  return {std::sin(angle), 0, std::cos(angle)};
}

double versine_power(const Vec3& a, const Vec3& b, double exponent) {
  return math::cos_power_from_versine(0.5 * dot(a - b, a - b), exponent);
}

TEST(DiscLight, HorizonCutsTheDiscAsTheIntegralOverItSays) {
  // Brute force with a hard edge errs by about one part in its steps of what lies on the edge.
  for (const double radius_deg : {0.265, 5.0, 30.0, 60.0, 89.0}) {
    const double radius = radius_deg * kDegree;
    for (const double part : {-0.9, -0.5, 0.0, 0.3, 0.8, 1.2}) {
      const double elevation = std::min(part * radius, kPi / 2);
      const Vec3 normal = tilted(kPi / 2 - elevation);
      const double cosine = std::sin(elevation);
      // The irradiance, what lies above the horizon, and all of the disc.
      const Vec3 sums = brute_force(radius, 400, 4000, [&](const Vec3& w) {
        const double up = dot(normal, w);
        return Vec3{std::max(0.0, up), up > 0 ? 1.0 : 0.0, 1};
      });
      EXPECT_NEAR(disc_irradiance(cosine, radius), sums.x, 1e-5 * std::sin(radius)) << radius_deg << " " << part;
      EXPECT_NEAR(disc_above(cosine, radius), sums.y / sums.z, 2e-3) << radius_deg << " " << part;
    }
  }
}

TEST(DiscLight, HalfASphereGivesHalfOfOnePlusTheCosine) {
  for (const double angle_deg : {0.0, 30.0, 90.0, 150.0, 179.0}) {
    const double cosine = std::cos(angle_deg * kDegree);
    EXPECT_NEAR(disc_irradiance(cosine, kPi / 2), 0.5 * (1 + cosine), 1e-12);
    EXPECT_NEAR(disc_above(cosine, kPi / 2), 1 - angle_deg / 180, 1e-12);
  }
}

// The flat form below kFlat_rad and the closed form above it meet.
TEST(HardCase, LampExtentHorizonHasNoStep) {
  for (const double part : {-0.99, -0.4, 0.0, 0.6, 0.999}) {
    const double below = 3e-4 * (1 - 1e-9), above = 3e-4 * (1 + 1e-9);
    EXPECT_NEAR(disc_irradiance(part * std::sin(below), below), disc_irradiance(part * std::sin(above), above),
                3e-7 * 3e-4);
    EXPECT_NEAR(disc_above(part * std::sin(below), below), disc_above(part * std::sin(above), above), 3e-7);
  }
  for (const double radius : {1e-12, 8.7e-7, 1e-3, 1.0}) {
    EXPECT_EQ(disc_irradiance(std::sin(radius), radius), std::sin(radius));
    EXPECT_EQ(disc_irradiance(-std::sin(radius), radius), 0);
  }
}

struct Case {
  double exponent, radius_deg;
};

TEST(DiscLight, LobeGathersWhatTheDoubleIntegralOverTheDiscSays) {
  double worst = 0, worst_moment = 0, textbook = 0;
  for (const Case c : {Case{0, 40},
                       {1.3, 0.265},
                       {1.3, 60},
                       {6, 30},
                       {70, 2},
                       {900, 0.265},
                       {900, 10},
                       {3e4, 0.265},
                       {3e4, 2},
                       {1e6, 0.265},
                       {1e6, 5e-5}}) {
    const double radius = c.radius_deg * kDegree, width = 1 / std::sqrt(c.exponent + 1);
    const double peak = lobe_of_disc(c.exponent, radius, 0).power;
    for (const double at : {0.0, 0.3, 0.99, 1.0, 1.01, 1.5}) {
      for (const double more : {0.0, 1.0, 3.0}) {
        const double between = std::min(at * radius + more * std::min(width, 1.0), kPi);
        const Vec3 r = tilted(between);
        // The edge at 90 degrees of the widest lobes takes more steps, and that of exponent 0 is a jump.
        const bool has_edge = c.exponent < 2 && std::abs(between - kPi / 2) < radius;
        const int fine = has_edge ? 400 : std::min(900, 60 + static_cast<int>(12 * radius / width));
        // The moment along another direction tells both of its parts at once; the part of y is zero.
        const Vec3 any = normalized({0.3, 0, 0.8});
        const Vec3 sums = brute_force(radius, fine, 4 * fine, [&](const Vec3& w) {
          const double f = versine_power(w, r, c.exponent);
          return Vec3{f, f * dot(any, w), 0};
        });
        const double power = sums.x, moment = sums.y;
        const LobeOfDisc lobe = lobe_of_disc(c.exponent, radius, between);
        const double error = std::abs(lobe.power - power) / peak;
        worst = std::max(worst, error);
        worst_moment =
            std::max(worst_moment, std::abs(lobe.by_light * any.z + lobe.by_mirror * dot(any, r) - moment) / peak);
        textbook = std::max(textbook, std::abs(math::cos_power(between, c.exponent) - power) / peak);
        EXPECT_LT(error, c.exponent < 1   ? 1e-3
                         : c.exponent < 2 ? 2e-6
                                          : 1e-6)
            << c.exponent << " " << c.radius_deg << " " << at << " " << more;
      }
    }
  }
  EXPECT_LT(worst_moment, 1e-3);
  // The textbook point lamp, by contrast, gathers too much by orders of magnitude where the lobe is narrow.
  EXPECT_GT(textbook, 10);
  RecordProperty("worst", std::to_string(worst));
}

// A lobe gathers over all directions about the disc what the disc sends, whatever its extent.
TEST(DiscLight, ExtentKeepsTheEnergyOfALobe) {
  for (const double exponent : {20.0, 900.0, 1e5, 1e6}) {
    for (const double radius_deg : {5e-5, 0.265, 3.0, 30.0}) {
      const double radius = radius_deg * kDegree, reach = 9 / std::sqrt(exponent);
      const double first = std::max(0.0, radius - reach), last = std::min(kPi, radius + reach);
      double sum = 0;
      for (const math::QuadraturePoint& p : math::gauss_legendre(400)) {
        const double t = first + 0.5 * (last - first) * (1 + p.position);
        sum += 0.5 * (last - first) * p.weight * 2 * kPi * std::sin(t) * lobe_of_disc(exponent, radius, t).power;
      }
      sum += 4 * kPi * std::pow(std::sin(0.5 * first), 2) * lobe_of_disc(exponent, radius, 0).power;
      // Solid angle of the disc over pi sin^2 R, times the integral of the lobe.
      const double wanted = 2 / (1 + std::cos(radius)) * 2 * kPi / (exponent + 1);
      EXPECT_NEAR(sum / wanted, 1, 1e-6) << exponent << " " << radius_deg;
    }
  }
}

TEST(HardCase, LampExtentSharpLobeUnderTheSun) {
  double worst = 0, textbook = 0;
  const double radius = 0.265 * kDegree;
  for (const double exponent : {3e4, 1e6}) {
    for (const double between : {0.0, 0.5 * radius}) {
      const Vec3 r = tilted(between);
      const double truth = brute_force(radius, 600, 2400, [&](const Vec3& w) { return versine_power(w, r, exponent); });
      worst = worst_of(worst, std::abs(lobe_of_disc(exponent, radius, between).power / truth - 1));
      textbook = worst_of(textbook, std::abs(math::cos_power(between, exponent) / truth - 1));
    }
  }
  hard_case("lamp-extent", {"highlight of a narrow lobe under the sun", textbook, worst, 1e-6, "relative"});
}

TEST(HardCase, LampExtentGoesToThePointLampForWideLobes) {
  for (const double exponent : {0.0, 1.3, 70.0, 3000.0, 1e6}) {
    for (const double radius : {1e-12, 8.7e-7}) {
      for (const double between : {0.0, 1e-6, 1e-3, 0.5, 1.5, 2.0, kPi}) {
        const LobeOfDisc lobe = lobe_of_disc(exponent, radius, between);
        const double point = math::cos_power(between, exponent);
        EXPECT_NEAR(lobe.power, point, 1e-6) << exponent << " " << radius << " " << between;
        EXPECT_GE(lobe.by_light, 0);
        EXPECT_GE(lobe.by_mirror, 0);
        EXPECT_NEAR(lobe.by_light + lobe.by_mirror, lobe.power, 2e-6);
      }
    }
  }
}

TEST(DiscLight, TableErrsByLessThanItSays) {
  double worst = 0;
  for (const double exponent : {1.3, 20.0, 900.0, 3e4, 1e6}) {
    for (const double radius_deg : {5e-5, 0.265, 3.0, 30.0, 90.0}) {
      const double radius = radius_deg * kDegree, peak = lobe_of_disc(exponent, radius, 0).power;
      const auto table = disc_lobe_table(exponent, radius);
      EXPECT_EQ(table, disc_lobe_table(exponent, radius));
      for (int i = 0; i <= 2000; ++i) {
        const double between = std::min(kPi, (radius + 10 / std::sqrt(exponent + 0.5)) * i / 2000);
        const DiscLobeTable::Node node = table->at(2 * std::sin(0.5 * between));
        const LobeOfDisc lobe = lobe_of_disc(exponent, radius, between);
        const double plain = node.plain[0] + node.plain[1];
        worst = std::max(worst, std::abs(plain - lobe.power) / peak);
      }
    }
  }
  EXPECT_THAT(worst, Le(5e-5));
  RecordProperty("worst", std::to_string(worst));
}

// Most nodes of a table are not computed, and they agree with those that are. Lines between as few nodes would not do.
TEST(DiscLight, NodesThatAreFilledAgreeWithThoseThatAreComputed) {
  double worst = 0, by_lines = 0;
  for (const double exponent : {0.0, 0.4, 1.0, 1.3, 4.0, 20.0, 150.0, 900.0, 3e4, 1e6}) {
    for (const double radius_deg : {5e-5, 0.265, 1.1, 3.0, 12.0, 30.0, 88.0, 90.0}) {
      const double radius = radius_deg * kDegree;
      const auto table = disc_lobe_table(exponent, radius);
      std::vector<DiscLobeTable::Node> computed;
      DiscLobeTable::Node largest;
      for (int i = 0; i < DiscLobeTable::kNodes - 1; ++i) {
        computed.push_back(disc_lobe_node(exponent, radius, table->first_chord + i / table->nodes_per_chord));
        largest.cosine[0] = std::max(largest.cosine[0], computed.back().cosine[0] + computed.back().cosine[1]);
        largest.plain[0] = std::max(largest.plain[0], computed.back().plain[0] + computed.back().plain[1]);
      }
      for (std::size_t i = 0; i + 8 < computed.size(); ++i) {
        const std::size_t before = i / 8 * 8;
        const double t = static_cast<double>(i - before) / 8;
        for (int k = 0; k < 2; ++k) {
          worst = std::max<double>(worst, std::abs(table->nodes[i].plain[k] - computed[i].plain[k]) / largest.plain[0]);
          worst =
              std::max<double>(worst, std::abs(table->nodes[i].cosine[k] - computed[i].cosine[k]) / largest.cosine[0]);
          const double line = (1 - t) * computed[before].plain[k] + t * computed[before + 8].plain[k];
          by_lines = std::max(by_lines, std::abs(line - computed[i].plain[k]) / largest.plain[0]);
        }
      }
    }
  }
  // Twice the bound of the sixth difference, and what the rule of 20 rings errs by.
  EXPECT_LE(worst, 4e-6);
  EXPECT_GT(by_lines, 1e-3);
  RecordProperty("worst", std::to_string(worst));
}

// Between its nodes the table is linear, and the ends of both functions are steeper than lines.
TEST(DiscLight, TheTableOfTheHorizonIsCloseToIt) {
  for (const double radius : {1e-3, 0.01, 0.1, 0.5, 1.2, kWidestDisc_rad}) {
    const auto table = disc_horizon_table(radius);
    const double most = disc_irradiance(std::sin(radius), radius);
    for (int i = 0; i <= 5000; ++i) {
      const float part = static_cast<float>(i) / 2500 - 1;
      const double sine = std::sin(part * radius);
      const auto [irradiance, above] = table->at(part);
      EXPECT_NEAR(irradiance, disc_irradiance(sine, radius), 1e-4 * most) << radius << ' ' << part;
      EXPECT_NEAR(above, disc_above(sine, radius), 1e-4) << radius << ' ' << part;
    }
  }
}

}  // namespace
}  // namespace goniochrome::brdf::disc_light_test
