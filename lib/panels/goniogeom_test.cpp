#include "panels/goniogeom.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "panels/geometry_sets.h"

namespace goniochrome::panels::goniogeom_test {
namespace {

constexpr DifferenceMetric k76 = DifferenceMetric::kDe76, k00 = DifferenceMetric::kDe00;

const paint::Appearance kSilver{{75, -0.5, -1}, {22, -0.3, -2}, 75, {}};

Vec3 random_direction(std::mt19937_64& random, double least_z) {
  std::uniform_real_distribution<double> height(least_z, 1), turn(0, 2 * kPi);
  const double z = height(random), a = turn(random), r = std::sqrt(1 - z * z);
  return {r * std::cos(a), r * std::sin(a), z};
}

// Rodrigues' formula.
Vec3 turned(const Vec3& v, const Vec3& axis, double b_deg) {
  const double b = b_deg * kDegree;
  return std::cos(b) * v + std::sin(b) * cross(axis, v) + (1 - std::cos(b)) * dot(axis, v) * axis;
}

// The panels by vectors, the white by XYZ: no closed form of ours in it.
double difference_by_vectors(const FlakeCurve& curve, const Vec3& light, const Vec3& view, const Vec3& axis, double b,
                             DifferenceMetric metric) {
  const color::Xyz white = *color::white_point({"D65", 10});
  const auto color = [&](const Vec3& normal) {
    color::Xyz xyz = color::xyz_from_lab(curve.at(paint::aspecular_angle_rad(light, view, normal) / kDegree), white);
    const double c = std::max(0.0, dot(normal, light));
    return color::lab_from_xyz({xyz.X * c, xyz.Y * c, xyz.Z * c}, white);
  };
  const Vec3 normal{0, 0, 1};
  return difference(metric, color(normal), color(turned(normal, axis, b)));
}

// The share that a coat of that index lets through at that cosine, from the amplitudes of both polarizations.
double let_through(double cosine, double index) {
  const double c = std::clamp(cosine, 0.0, 1.0), t = std::sqrt(1 - (1 - c * c) / (index * index));
  const double s = (c - index * t) / (c + index * t), p = (index * c - t) / (index * c + t);
  return 1 - (s * s + p * p) / 2;
}

TEST(PanelColor, IsTheScaledStimulusForAnyWhiteAndBothBranches) {
  const color::Xyz white = *color::white_point({"A", 2});
  int dark = 0, light = 0;
  for (const color::Lab& lab : {color::Lab{90, 3, -8}, color::Lab{160, 0, 0}, color::Lab{12, 10, -20},
                                color::Lab{5, -2, 1}, color::Lab{0.1, 0, 0.1}, color::Lab{}}) {
    for (const double c : {1.0, 0.9, 0.5, 0.1, 0.01, 1e-4, 0.0}) {
      const color::Xyz xyz = color::xyz_from_lab(lab, white);
      const color::Lab wanted = color::lab_from_xyz({xyz.X * c, xyz.Y * c, xyz.Z * c}, white),
                       got = panel_color(lab, c);
      EXPECT_LT(color::delta_e_76(wanted, got), 1e-12 * 500) << lab.L << " " << c;  // 500 multiplies the rounding of f
      (wanted.L < 8 ? dark : light) += 1;
    }
  }
  EXPECT_GT(dark, 5);
  EXPECT_GT(light, 5);
  EXPECT_EQ(panel_color({50, 1, 1}, -0.5).L, panel_color({50, 1, 1}, 0).L) << "a panel in its own shadow is black";
}

TEST(FlakeCurve, IsTheCurveItStandsFor) {
  paint::Paint paint;
  paint.measurement.emplace();
  paint.measurement->rows = {{{.aspecular_deg = 15}, {80, 5, -9}},
                             {{.aspecular_deg = 25}, {66, 4, -8}},
                             {{.aspecular_deg = 45}, {41, 6, -2}},
                             {{.aspecular_deg = 75}, {30, 2, 1}},
                             {{.aspecular_deg = 110}, {31, 1, 1}}};
  const FlakeCurve measured = *FlakeCurve::make(paint, paint::TargetCurve::Kind::kMeasured);
  const paint::TargetCurve target = *paint::TargetCurve::make(paint, paint::TargetCurve::Kind::kMeasured);
  const FlakeCurve curve = *FlakeCurve::make(paint, paint::TargetCurve::Kind::kCurve);
  const paint::Appearance appearance = *appearance_of(paint);
  for (double t = 0; t <= 180; t += 0.37) {
    if (t >= 15) {
      EXPECT_LT(color::delta_e_76(measured.at(t), target.at(t)), 1e-11) << t;
    }
    EXPECT_LT(color::delta_e_76(curve.at(t), paint::lab_at(appearance, t)), 1e-11) << t;
  }
  for (const FlakeCurve& any : {measured, curve}) {
    for (double t = 0; t < 180; t += 0.013) {
      const double slope = color::delta_e_76(any.at(t), any.at(t + 1e-3)) / 1e-3;
      EXPECT_LE(slope, any.steepest(t, t + 1e-3) * (1 + 1e-6) + 1e-9) << t;
    }
  }
}

// The highlight by hand: f(t) = f(15) (cos t / cos 15)^e with the exponent between 15 and 25 deg, of the base under the
// coat. The control holds the curve constant below its first reading.
TEST(FlakeCurve, ContinuesTheHighlightBelowItsFirstReading) {
  const color::Xyz white = *color::white_point({"D65", 10});
  for (const double gloss : {0.0, 90.0}) {
    paint::Paint paint;
    paint.measurement.emplace();
    paint.measurement->rows = {{{.aspecular_deg = 5}, {99, 0, 0}},  // glare, which no flake shows
                               {{.aspecular_deg = 15}, {80, 5, -9}},
                               {{.aspecular_deg = 25}, {66, 4, -8}},
                               {{.aspecular_deg = 45}, {41, 6, -2}}};
    paint.gloss = {{60, gloss}};
    const FlakeCurve curve = *FlakeCurve::make(paint, paint::TargetCurve::Kind::kMeasured);
    EXPECT_EQ(curve.coat_index() == paint::kNoCoat, gloss == 0) << "gloss implies a coat";
    const auto passages = [&](double t) {
      return gloss == 0 ? 1
                        : let_through(std::sqrt(0.5), curve.coat_index()) *
                              let_through(std::cos((45 - t) * kDegree), curve.coat_index());
    };
    const color::Rgb at_15 = (1 / passages(15)) * color::rgb_from_lab({80, 5, -9}, white),
                     at_25 = (1 / passages(25)) * color::rgb_from_lab({66, 4, -8}, white);
    double control = 0;
    for (double t = 0; t <= 15; t += 0.1) {
      color::Rgb wanted;
      for (int c = 0; c < 3; ++c) {
        const double e = std::log(at_15[c] / at_25[c]) / std::log(std::cos(15 * kDegree) / std::cos(25 * kDegree));
        wanted[c] = passages(t) * at_15[c] * std::pow(std::cos(t * kDegree) / std::cos(15 * kDegree), e);
      }
      EXPECT_LT(color::delta_e_76(curve.at(t), color::lab_from_rgb(wanted, white)), 1e-4) << t;
      control = std::max(control, color::delta_e_76({80, 5, -9}, color::lab_from_rgb(wanted, white)));
    }
    EXPECT_GT(control, 5);
  }
}

TEST(TiltedPair, AgreesWithVectorsInAndOutOfPlane) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> angle(0, 360);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 light = random_direction(random, 0.02), view = random_direction(random, 0.02), normal{0, 0, 1};
    const double turn = angle(random) * kDegree;
    const Vec3 axis{std::cos(turn), std::sin(turn), 0};
    const TiltedPair pair(light, view, normal, axis);
    for (const int sign : {1, -1}) {
      const double range = pair.range_deg(sign);
      EXPECT_NEAR(dot(turned(normal, axis, sign * range), view), 0, 1e-14) << "the panel is edge on at its range";
      for (const double part : {0.0, 1e-6, 0.01, 0.3, 0.9}) {
        const double b = sign * part * range;
        const Vec3 n = turned(normal, axis, b);
        const TiltedPair::State state = pair.at(b);
        // 2 atan2(x, y) of sums of squares: an absolute error of some units in the last place of pi.
        EXPECT_NEAR(state.aspecular_deg, paint::aspecular_angle_rad(light, view, n) / kDegree, 1e-12);
        EXPECT_NEAR(state.cos_light, std::max(0.0, dot(n, light)), 1e-15);
      }
    }
  }
}

// [hard case] Near the mirror direction and opposite to it acos(dot) keeps eight digits at most.
TEST(HardCase, AngleAcosOfATiltedPairKeepsItsDigits) {
  double ours = 0, control = 0;
  for (const double as : {1e-9, 1e-6, 1e-3, 179.999999}) {
    const TiltedPair pair = TiltedPair::make({45, 0, 0}, 90);
    const double b = (45 - as) / 2;  // the mirror turns by 2b, from 45 deg to `as`
    const double got = pair.at(b).aspecular_deg;
    ours = worst_of(ours, std::abs(got - as));
    control = worst_of(control, std::abs(std::acos(std::cos(as * kDegree)) / kDegree - as));
  }
  hard_case(
      "angle-acos",
      {.what = "aspecular angle of a tilted panel", .textbook = control, .ours = ours, .bound = 1e-13, .unit = "deg"});
}

TEST(TiltedPair, InPlaneTheAspecularAngleFallsByTwiceTheTiltTowardTheLight) {
  const TiltedPair pair = TiltedPair::make({45, -15, 0}, 90);  // aspecular 60
  EXPECT_NEAR(pair.at(0).aspecular_deg, 60, 1e-13);
  EXPECT_NEAR(pair.at(2).aspecular_deg, 56, 1e-13);
  EXPECT_NEAR(pair.at(-2).aspecular_deg, 64, 1e-13);
  EXPECT_NEAR(pair.at(2).cos_light, std::cos(43 * kDegree), 1e-15);
  const paint::DirectionPair directions_of = directions(LightView{45, -15, 0});
  for (double b = -74; b < 105; b += 0.5)
    EXPECT_NEAR(
        pair.at(b).aspecular_deg,
        paint::aspecular_angle_rad(directions_of.light, directions_of.view, turned({0, 0, 1}, {0, -1, 0}, b)) / kDegree,
        1e-12);
  EXPECT_NEAR(pair.range_deg(1), 105, 1e-12);
  EXPECT_NEAR(pair.range_deg(-1), 75, 1e-12);
}

// A solid paint changes by the cosine alone: |k(b) - k(0)| M = threshold with k = cbrt(cos), M = |(L + 16, a, b)|.
double closed_form(const color::Lab& lab, double light_deg, int sign, double threshold) {
  const double M = std::sqrt((lab.L + 16) * (lab.L + 16) + lab.a * lab.a + lab.b * lab.b);
  const double k0 = std::cbrt(std::cos(light_deg * kDegree));
  const double k = light_deg == 0 || sign < 0 ? k0 - threshold / M : k0 + threshold / M;
  return std::abs(light_deg - std::acos(k * k * k) / kDegree);
}

TEST(FirstCrossing, OfASolidPaintMeetsTheClosedFormOfTheCosine) {
  for (const color::Lab& lab : {color::Lab{50, 0, 0}, color::Lab{44, 52, 30}, color::Lab{90, -2, 60}}) {
    const FlakeCurve curve(paint::Appearance{lab, lab, 60, {}});
    for (const double light : {10.0, 45.0, 70.0}) {
      const GeometryIndex index = geometry_index(curve, TiltedPair::make({light, 0, 0}, 90), 1, k76);
      ASSERT_TRUE(index.minus_deg);
      EXPECT_NEAR(*index.minus_deg, closed_form(lab, light, -1, 1), 1e-9);
      if (light == 10) continue;  // toward the light it may only brighten by 1 - k0
      ASSERT_TRUE(index.plus_deg);
      EXPECT_NEAR(*index.plus_deg, closed_form(lab, light, 1, 1), 1e-9);
    }
    const GeometryIndex above = geometry_index(curve, TiltedPair::make({0, 20, 0}, 90), 2.3, k76);
    const GeometryIndex at45 = geometry_index(curve, TiltedPair::make({45, 20, 0}, 90), 2.3, k76);
    EXPECT_NEAR(*above.plus_deg, closed_form(lab, 0, 1, 2.3), 1e-9);
    EXPECT_EQ(*above.plus_deg, *above.minus_deg) << "there is no first-order term";
    EXPECT_GT(above.smallest_deg(), 3 * at45.smallest_deg());
  }
}

// The first b of a dense grid at which the threshold is reached, or infinity.
double brute_force(const FlakeCurve& curve, const TiltedPair& pair, int sign, double threshold, DifferenceMetric metric,
                   double step, double range) {
  for (int i = 1; i * step < range; ++i)
    if (difference_at(curve, pair, sign * i * step, metric) >= threshold) return i * step;
  return std::numeric_limits<double>::infinity();
}

// A pearl seen 15 deg from the mirror: turned toward the light, the panel passes the mirror at 7.5 deg and shows the
// same flake color again at 15 deg, darker and lighter by the cosine alone.
TEST(HardCase, IndexCrossingIsTheFirstOfThree) {
  const FlakeCurve curve(paint::Appearance{{60, 30, 20}, {25, -25, -10}, 70, {}});
  const TiltedPair pair = TiltedPair::make({30, 15, 0}, 90);
  const double threshold = 8;
  const auto over = [&](double b) { return difference_at(curve, pair, b, k76) - threshold; };
  std::vector<double> roots;
  for (double b = 0.001; b < 20; b += 0.001)
    if ((over(b) >= 0) != (over(b - 0.001) >= 0)) roots.push_back(b);
  ASSERT_GE(roots.size(), 3u) << "dE(b) must rise, fall and rise again";

  const auto index = first_crossing(curve, pair, 1, threshold, k76);
  ASSERT_TRUE(index);
  EXPECT_LT(over(*index - 1e-9), 0) << "bracketed to 1e-9 deg";
  EXPECT_GE(over(*index), 0);

  // The textbook bisection finds a root, and it is not the first: its first middle falls into the dip.
  double low = 0, high = roots[1] + roots[2];
  ASSERT_LT(over(low), 0);
  ASSERT_GE(over(high), 0);
  while (high - low > 1e-9) (over((low + high) / 2) >= 0 ? high : low) = (low + high) / 2;
  hard_case("index-crossing", {.what = "first crossing of a difference that rises, falls and rises",
                               .textbook = high - roots[0],
                               .ours = std::abs(*index - roots[0]),
                               .bound = 0.001,
                               .unit = "deg"});

  // Where the threshold is above every difference there is no index, and none is made up.
  EXPECT_FALSE(first_crossing(curve, pair, 1, 200, k76));
  const FlakeCurve black(paint::Appearance{{2, 0, 0}, {2, 0, 0}, 60, {}});
  EXPECT_FALSE(first_crossing(black, pair, -1, 2.3, k76)) << "a black panel in shadow is 2 L* away";
}

TEST(FirstCrossing, IsNeverMissedOnRandomPaintsAndGeometries) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  int found = 0, none = 0, early = 0;
  for (int i = 0; i < 1000; ++i) {
    const double contrast = i % 4 == 0 ? 0 : 1;
    const color::Lab flop{70 * unit(random), 60 * unit(random) - 30, 60 * unit(random) - 30};
    paint::Appearance appearance{flop, flop, 20 + 150 * unit(random), {}};
    appearance.face.L += contrast * (60 * unit(random) - 10);
    appearance.face.a += contrast * (60 * unit(random) - 30);
    appearance.face.b += contrast * (60 * unit(random) - 30);
    appearance.face.L = std::max(appearance.face.L, 0.0);
    const FlakeCurve curve(appearance);
    const TiltedPair pair(random_direction(random, 0.1), random_direction(random, 0.1), {0, 0, 1}, {0, 1, 0});
    const DifferenceMetric metric = i % 3 == 0 ? k00 : k76;
    const double threshold = std::array{0.5, 2.3, 10.0}[i % 3 == 0 ? i % 2 : i % 3];
    for (const int sign : {1, -1}) {
      const double range = pair.range_deg(sign), step = 0.01;
      const double wanted = brute_force(curve, pair, sign, threshold, metric, step, range);
      const auto index = first_crossing(curve, pair, sign, threshold, metric);
      if (!index) {
        EXPECT_TRUE(std::isinf(wanted)) << i << ": missed " << wanted;
        ++none;
        continue;
      }
      ++found;
      EXPECT_GE(difference_at(curve, pair, sign * *index, metric), threshold) << i;
      EXPECT_LE(*index, wanted) << i;
      early += *index < wanted - step * (1 + 1e-9);  // an excursion between two points of the grid
    }
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(none, 50);
  EXPECT_LT(early, 20);
}

TEST(FirstCrossing, AgreesWithVectorsOutOfPlane) {
  std::mt19937_64 random(5);
  const FlakeCurve curve(kSilver);
  for (int i = 0; i < 100; ++i) {
    const LightView geometry{40, 10 + i * 0.5, i * 3.6};
    const paint::DirectionPair pair = directions(geometry);
    const double seam = i * 1.8;
    const Vec3 axis{std::cos(seam * kDegree), -std::sin(seam * kDegree), 0};
    for (const double b : {-7.0, 0.3, 12.0})
      EXPECT_NEAR(difference_at(curve, TiltedPair::make(geometry, seam), b, k76),
                  difference_by_vectors(curve, pair.light, pair.view, axis, b, k76), 1e-10);
  }
}

// The step of the search rests on |dE00(x,y) - dE00(x,z)| <= 2.5 |y - z| for colors that are not of opposite hue.
TEST(FirstCrossing, StretchOfDe00IsWithinItsBound) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  double most = 0;
  for (int i = 0; i < 1000000; ++i) {
    const double colorful = i % 2 ? 100 : 4, far = i % 3 ? 3 : 8;
    const color::Lab x{50 + 50 * unit(random), colorful * unit(random), colorful * unit(random)};
    const color::Lab y{x.L + far * unit(random), x.a + far * unit(random), x.b + far * unit(random)};
    const color::Lab z{y.L + 0.1 * unit(random), y.a + 0.1 * unit(random), y.b + 0.1 * unit(random)};
    if (x.a * y.a + x.b * y.b < 0 || x.a * z.a + x.b * z.b < 0) continue;
    most = std::max(most, std::abs(color::delta_e_2000(x, y) - color::delta_e_2000(x, z)) / color::delta_e_76(y, z));
  }
  EXPECT_LT(most, 2.5);
  EXPECT_GT(most, 1) << "dE00 is steeper than dE76 somewhere: the stretch is needed";
}

// The differences through a coat by vectors: each reading is taken through the coat at 45 deg and at the angle of its
// viewer, and seen through it where light and viewer stand. The control is the curve without its coat.
TEST(Coat, PanelsAreSeenThroughIt) {
  paint::Paint paint;
  paint.appearance = kSilver;
  const FlakeCurve bare = *FlakeCurve::make(paint, paint::TargetCurve::Kind::kCurve);
  paint.coat_index = 1.55;
  const FlakeCurve coated = *FlakeCurve::make(paint, paint::TargetCurve::Kind::kCurve);
  EXPECT_EQ(bare.coat_index(), paint::kNoCoat);
  const color::Xyz white = *color::white_point({"D65", 10});
  std::mt19937_64 random(3);
  double off = 0, control = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3 light = random_direction(random, 0.1), view = random_direction(random, 0.1), normal{0, 0, 1};
    const double turn = 2 * kPi * i / 300;
    const Vec3 axis{std::cos(turn), std::sin(turn), 0};
    const auto color = [&](const Vec3& n) {
      const double as = paint::aspecular_angle_rad(light, view, n) / kDegree;
      const double read_deg = std::min(std::abs(45 - as), 65.0), cos_i = std::max(0.0, dot(n, light));
      const double c = cos_i * let_through(cos_i, 1.55) * let_through(dot(n, view), 1.55) /
                       (let_through(std::sqrt(0.5), 1.55) * let_through(std::cos(read_deg * kDegree), 1.55));
      const color::Xyz xyz = color::xyz_from_lab(coated.at(as), white);
      return color::lab_from_xyz({xyz.X * c, xyz.Y * c, xyz.Z * c}, white);
    };
    const TiltedPair pair(light, view, normal, axis);
    for (const double b : {-3.0, 1.0, 8.0}) {
      if (dot(turned(normal, axis, b), view) <= 0.01) continue;
      const double wanted = difference(k76, color(normal), color(turned(normal, axis, b)));
      off = std::max(off, std::abs(difference_at(coated, pair, b, k76) - wanted));
      control = std::max(control, std::abs(difference_at(bare, pair, b, k76) - wanted));
    }
  }
  EXPECT_LE(off, 1e-9);
  EXPECT_GT(control, 1);
}

// The first crossing is that of a dense scan, so that the steps are safe under a coat too.
TEST(Coat, FirstCrossingsAreThoseOfADenseScan) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> part(0, 1);
  int crossed = 0;
  for (int i = 0; i < 60; ++i) {
    paint::Paint paint;
    paint.appearance = paint::Appearance{{120 * part(random), 60 * part(random) - 30, 60 * part(random) - 30},
                                         {40 * part(random), 40 * part(random) - 20, 40 * part(random) - 20},
                                         20 + 100 * part(random),
                                         {}};
    paint.coat_index = 1.5 + 0.2 * part(random);
    const FlakeCurve curve = *FlakeCurve::make(paint, paint::TargetCurve::Kind::kCurve);
    const double turn = 2 * kPi * part(random);
    const TiltedPair pair(random_direction(random, 0.05), random_direction(random, 0.05), {0, 0, 1},
                          {std::cos(turn), std::sin(turn), 0});
    for (const int sign : {1, -1}) {
      const double threshold = 0.5 + 8 * part(random);
      const auto found = first_crossing(curve, pair, sign, threshold, k76);
      std::optional<double> scanned;
      for (double b = 0.005; b < pair.range_deg(sign) && !scanned; b += 0.005)
        if (difference_at(curve, pair, sign * b, k76) >= threshold) scanned = b;
      ASSERT_EQ(found.has_value(), scanned.has_value()) << i;
      if (!found) continue;
      ++crossed;
      EXPECT_NEAR(*found, *scanned, 0.0051) << i;
      EXPECT_NEAR(difference_at(curve, pair, sign * *found, k76), threshold, 1e-6) << i;
    }
  }
  EXPECT_GT(crossed, 60);
}

}  // namespace
}  // namespace goniochrome::panels::goniogeom_test
