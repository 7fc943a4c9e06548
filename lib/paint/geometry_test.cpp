#include "paint/geometry.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"

namespace goniochrome::paint::geometry_test {
namespace {

void expect_near(const Vec3& v, const Vec3& expected, double tolerance) {
  EXPECT_NEAR(v.x, expected.x, tolerance);
  EXPECT_NEAR(v.y, expected.y, tolerance);
  EXPECT_NEAR(v.z, expected.z, tolerance);
}

TEST(Geometry, NamesAreReadAndWritten) {
  struct {
    const char *text, *name;
    double incidence, aspecular;
  } const table[] = {
      {"45as15", "45as15", 45, 15},
      {"45as-15", "45as-15", 45, -15},
      {"45asMinus15", "45as-15", 45, -15},
      {"45ASminus15", "45as-15", 45, -15},
      {"45as+15", "45as15", 45, 15},
      {"15as-45", "15as-45", 15, -45},
      {"r45as-15", "r45as-15", 45, -15},
      {"45as110", "45as110", 45, 110},
      {"15", "45as15", 45, 15},
      {" -15 ", "45as-15", 45, -15},
      {"minus15", "45as-15", 45, -15},
      {"65as42.5", "65as42.5", 65, 42.5},
      {"0as0", "0as0", 0, 0},
  };
  for (const auto& row : table) {
    const auto geometry = parse_geometry(row.text);
    ASSERT_TRUE(geometry.ok()) << geometry.error().message;
    EXPECT_EQ(geometry_name(*geometry), row.name);
    EXPECT_EQ(geometry->incidence_deg, row.incidence);
    EXPECT_EQ(geometry->aspecular_deg, row.aspecular);
    EXPECT_FALSE(geometry->out_of_plane);
    EXPECT_EQ(*parse_geometry(geometry_name(*geometry)), *geometry);
  }
}

TEST(Geometry, AzimuthsOutOfPlaneAreReadAndWritten) {
  for (const auto& [text, name] : {std::pair{"45as25az90", "45as25az90"},
                                   {"45as25az-90", "45as25az-90"},
                                   {"45as25azMinus90", "45as25az-90"},
                                   {"45as25az270", "45as25az-90"},
                                   {"45as25az-180", "45as25az180"},
                                   {"15as38.3az43", "15as38.3az43"}}) {
    const auto geometry = parse_geometry(text);
    ASSERT_TRUE(geometry.ok()) << geometry.error().message;
    EXPECT_TRUE(geometry->out_of_plane);
    EXPECT_EQ(geometry_name(*geometry), name);
  }
}

TEST(Geometry, WrongNamesAreRefusedWithARemedy) {
  for (const char* text : {"", "as", "45as", "as15", "45as15az", "45x15", "fifteen", "45as15as25", "r15", "45as1,5",
                           "45as15 deg", "45asminus-15", "nan", "45asinf", "r", "45as25azx"}) {
    const auto geometry = parse_geometry(text);
    ASSERT_FALSE(geometry.ok()) << text;
    EXPECT_NE(geometry.error().message.find("write it like 45as15"), std::string::npos) << geometry.error().message;
  }
  EXPECT_EQ(parse_geometry("95as15").error().message,
            "geometry \"95as15\": the light is at 95 deg: give 0 to below 90 deg from the normal");
  EXPECT_EQ(parse_geometry("45as-45").error().message,
            "geometry \"45as-45\" puts the detector below the surface: give a smaller aspecular angle");
  EXPECT_FALSE(parse_geometry("45as140").ok());
  EXPECT_FALSE(parse_geometry("45as60az0").ok());
  EXPECT_FALSE(parse_geometry("45as400").ok());
  EXPECT_FALSE(parse_geometry("45as-25az90").ok());
  EXPECT_FALSE(parse_geometry("-5as15").ok());
}

TEST(Geometry, DirectionsOutOfPlaneFollowTheAzimuth) {
  // To the four digits at which these three geometries are usually given.
  expect_near(directions(*parse_geometry("45as25az-76")).view, {0.7132, -0.4101, 0.5686}, 5e-5);
  expect_near(directions(*parse_geometry("45as60az125.3")).view, {0, 0.7071, 0.7071}, 5e-4);  // 125.3 is rounded
  expect_near(directions(*parse_geometry("15as38.3az43")).view, {0.6409, 0.4226, 0.6409}, 5e-4);
}

TEST(Geometry, InPlanePositiveIsTowardTheNormalAndAzimuth0AwayFromIt) {
  const auto polar_deg = [](const char* name) {
    const Vec3 v = directions(*parse_geometry(name)).view;
    return std::atan2(v.x, v.z) / kDegree;
  };
  EXPECT_NEAR(polar_deg("45as0"), 45, 1e-13);
  EXPECT_NEAR(polar_deg("45as15"), 30, 1e-13);
  EXPECT_NEAR(polar_deg("45as-15"), 60, 1e-13);
  EXPECT_NEAR(polar_deg("45as110"), -65, 1e-13);
  EXPECT_NEAR(polar_deg("15as-45"), 60, 1e-13);
  EXPECT_NEAR(polar_deg("45as25az0"), 70, 1e-13);
  EXPECT_NEAR(polar_deg("45as25az180"), 20, 1e-13);
}

TEST(Geometry, LightStandsOppositeAndReversedTradesPlaces) {
  const auto plain = directions(*parse_geometry("45as-15")), reversed = directions(*parse_geometry("r45as-15"));
  EXPECT_LT(plain.light.x, 0);
  EXPECT_NEAR(plain.light.z, std::sqrt(0.5), 1e-15);
  EXPECT_EQ(plain.light, reversed.view);
  EXPECT_EQ(plain.view, reversed.light);
}

TEST(Geometry, AngleOfTheDirectionsIsTheAngleOfTheName) {
  for (const char* name : {"45as15", "45as-15", "r45as-15", "15as-45", "45as110", "45as25az-76", "15as38.3az43"}) {
    const Geometry geometry = *parse_geometry(name);
    const auto [light, view] = directions(geometry);
    EXPECT_NEAR(length(view), 1, 4e-16);
    EXPECT_NEAR(aspecular_angle_rad(light, view, {0, 0, 1}) / kDegree, aspecular_angle_deg(geometry), 1e-12) << name;
  }
}

// The textbook form: the arc cosine of the scalar product.
double textbook_angle_rad(const Vec3& light, const Vec3& view, const Vec3& normal) {
  return std::acos(dot(2 * dot(normal, light) * normal - light, view));
}

// Distance in units in the last place of a double at `exact`.
double ulps(double value, long double exact) {
  const double at = static_cast<double>(exact);
  return static_cast<double>(std::abs(value - exact) / (std::nextafter(at, 10.0) - at));
}

// Directions on a grid of 2^-20 make every product of the reference exact in long double (64 bits: 21 + 21 bits for a
// product with the normal (0,0,1), and 42 for the cross product), so the reference errs by its own square root and arc
// tangent alone, 1e-3 ulp of a double.
TEST(HardCase, AngleAcos) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<int> grid(-(1 << 20), 1 << 20), tiny(-3, 3);
  const Vec3 normal{0, 0, 1};
  int parallel = 0, opposite = 0, wide = 0;
  double worst = 0, textbook = 0;
  for (int i = 0; i < 300000; ++i) {
    const std::array<int, 3> light{grid(random), grid(random), grid(random)};
    std::array<int, 3> view{grid(random), grid(random), grid(random)};
    if (i % 3 != 0) {
      const int sign = i % 3 == 1 ? 1 : -1;  // along the mirror direction, or opposite to it
      view = {sign * -light[0] + tiny(random), sign * -light[1] + tiny(random), sign * light[2] + tiny(random)};
    }
    std::array<long double, 3> m, v;
    for (int k = 0; k < 3; ++k) m[k] = k == 2 ? light[k] : -light[k], v[k] = view[k];
    const long double x = m[1] * v[2] - m[2] * v[1], y = m[2] * v[0] - m[0] * v[2], z = m[0] * v[1] - m[1] * v[0];
    const long double across = std::sqrt(x * x + y * y + z * z), along = m[0] * v[0] + m[1] * v[1] + m[2] * v[2];
    if (across == 0 && along == 0) continue;
    const long double exact = std::atan2(across, along);
    constexpr double kGrid = 1.0 / (1 << 20);
    const Vec3 l{light[0] * kGrid, light[1] * kGrid, light[2] * kGrid};
    const Vec3 w{view[0] * kGrid, view[1] * kGrid, view[2] * kGrid};
    worst = worst_of(worst, ulps(aspecular_angle_rad(l, w, normal), exact));
    textbook = worst_of(textbook, ulps(textbook_angle_rad((1 / length(l)) * l, (1 / length(w)) * w, normal), exact));
    (exact < 1e-4L ? parallel : exact > 3.1414L ? opposite : wide)++;
  }
  EXPECT_GT(parallel, 50000);
  EXPECT_GT(opposite, 50000);
  EXPECT_GT(wide, 50000);
  hard_case("angle-acos", {.what = "aspecular angle, near the mirror direction and opposite to it",
                           .textbook = textbook,
                           .ours = worst,
                           .bound = 4,
                           .unit = "ulp"});
}

// Unit directions a known tiny angle from the mirror direction about a tilted normal.
TEST(HardCase, AngleAcosOfUnitVectors) {
  int textbook_wrong = 0, textbook_nan = 0;
  double worst = 0, control = 0;
  for (const double angle : {1e-14, 1e-10, 1e-8, 1e-6, 1e-3})
    for (int i = 0; i < 100; ++i) {
      const double t = 0.01 + 0.015 * i;
      const Vec3 light{-std::sin(t), 0, std::cos(t)};
      const Vec3 view{std::sin(t) + std::cos(t) * angle, 0, std::cos(t) - std::sin(t) * angle};
      const double ours = aspecular_angle_rad(light, view, {0, 0, 1});
      // sin and cos are rounded to 1.1e-16, which turns the directions themselves by at most 4 such steps.
      worst = worst_of(worst, std::abs(ours - std::atan(angle)));
      const double textbook = textbook_angle_rad(light, (1 / length(view)) * view, {0, 0, 1});
      textbook_nan += std::isnan(textbook);
      if (!std::isnan(textbook)) control = worst_of(control, std::abs(textbook - std::atan(angle)));
      textbook_wrong += !(std::abs(textbook - std::atan(angle)) < 1e-3 * angle);
    }
  EXPECT_GT(textbook_nan, 0);
  EXPECT_GT(textbook_wrong, 200);
  hard_case("angle-acos", {.what = "angle between unit directions that are 1e-14 to 1e-3 apart",
                           .textbook = control,
                           .ours = worst,
                           .bound = 5e-16,
                           .unit = "rad"});
  // Tilted normals, any lengths: a common factor of each vector changes nothing.
  std::mt19937_64 random(4);
  std::normal_distribution<double> any;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 l{any(random), any(random), any(random)}, v{any(random), any(random), any(random)},
        n{any(random), any(random), any(random)};
    EXPECT_EQ(aspecular_angle_rad(l, v, n), aspecular_angle_rad(8 * l, 0.25 * v, 2 * n));
  }
}

}  // namespace
}  // namespace goniochrome::paint::geometry_test
