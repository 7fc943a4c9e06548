#include "paint/curve.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/hard_case_for_test.h"

namespace goniochrome::paint::curve_test {
namespace {

double difference(const color::Lab& x, const color::Lab& y) {
  return std::max({std::abs(x.L - y.L), std::abs(x.a - y.a), std::abs(x.b - y.b)});
}

std::vector<LabReading> rows_at(const Appearance& appearance, const std::vector<double>& angles_deg) {
  std::vector<LabReading> rows;
  for (const double t : angles_deg) rows.push_back({{.aspecular_deg = t}, lab_at(appearance, std::abs(t))});
  return rows;
}

// The textbook form of the clamped quadratic [Shimizu2009] 3.3.8-3.3.10: a t^2 + b t + c with theta_clamp = -b/(2a).
struct TextbookQuadratic {
  double a, b, c;
  TextbookQuadratic(double face, double flop, double travel)
      : a((face - flop) / ((travel - 15) * (travel - 15))), b(-2 * a * travel), c(flop + a * travel * travel) {}
  double clamp_deg() const { return -b / (2 * a); }
  double at(double t) const {
    t = t < clamp_deg() ? t : clamp_deg();
    return (a * t + b) * t + c;
  }
};

// And its three-angle mapping, which takes the square root of s as it comes.
double textbook_travel_deg(double at_15, double at_45, double at_110) {
  const double root = std::sqrt((at_45 - at_110) / (at_15 - at_110));
  return (45 - 15 * root) / (1 - root);
}

TEST(Curve, EqualsTheTextbookQuadraticWhereThatHolds) {
  const Appearance appearance{{80, 20, -10}, {30, 5, -2}, 70, {}};
  const TextbookQuadratic L(80, 30, 70), a(20, 5, 70), b(-10, -2, 70);
  for (double t = 0; t <= 180; t += 0.5)
    EXPECT_LE(difference(lab_at(appearance, t), {L.at(t), a.at(t), b.at(t)}), 1e-12) << t;
}

TEST(Curve, PassesFaceAt15AndFlopFromTheTravelOn) {
  const Appearance appearance{{81.3, 20.1, -10.7}, {30.9, 5.3, -2.1}, 63, {}};
  EXPECT_EQ(lab_at(appearance, 63), appearance.flop);
  EXPECT_EQ(lab_at(appearance, 110), appearance.flop);
  EXPECT_LE(difference(lab_at(appearance, 15), appearance.face), 2e-14);
}

TEST(HardCase, CurveSolid) {
  const color::Lab lab{41.87, -0.3, 0.1};
  double ours = 0;
  for (const double travel : {15.0001, 16.0, 60.0, 180.0}) {
    const Appearance solid{lab, lab, travel, {}};
    for (const double t : {0.0, 15.0, 45.0, 110.0, 180.0}) ours = worst_of(ours, difference(lab_at(solid, t), lab));
    EXPECT_TRUE(std::isnan(TextbookQuadratic(lab.L, lab.L, travel).at(45)));
  }
  hard_case("curve-solid", {.what = "L*a*b* of a curve whose face is its flop",
                            .textbook = TextbookQuadratic(lab.L, lab.L, 60).at(45) - lab.L,
                            .ours = ours,
                            .bound = 0,
                            .unit = "L*"});
  const ChannelCurve channel = channel_curve(50, 50, 50);
  EXPECT_TRUE(channel.exact);
  EXPECT_EQ(channel.at(0), 50);
  EXPECT_EQ(channel.at(170), 50);
  const auto fit = appearance_from_rows(rows_at({{50, 1, 2}, {50, 1, 2}, 40, {}}, {15, 25, 45, 75, 110}));
  EXPECT_EQ(fit->appearance.face, fit->appearance.flop);
  EXPECT_EQ(fit->appearance.travel_deg, 60);
  EXPECT_EQ(*fit->appearance.residual_de00, 0);
}

TEST(HardCase, CurveTravel15) {
  // Refused at 15 and beyond 180, bounded and told just above.
  for (const double travel : {15.0, 14.0, -3.0, 180.001, std::nan("")}) {
    const auto checked = check({{}, {}, travel, {}});
    ASSERT_FALSE(checked.ok()) << travel;
    EXPECT_NE(checked.error().message.find("above 15 and up to 180 deg"), std::string::npos);
  }
  EXPECT_TRUE(check({{}, {}, 180, {}}).ok());
  EXPECT_TRUE(check({{}, {}, 15.01, {}}).ok());
  const double above = std::nextafter(15.0, 16.0);
  const Appearance steep{{80, 0, 0}, {30, 0, 0}, above, {}};
  EXPECT_EQ(lab_at(steep, above), steep.flop);
  EXPECT_TRUE(std::isfinite(lab_at(steep, 0).L));
  EXPECT_GT(extrapolation_at_specular(steep), 4);
  EXPECT_DOUBLE_EQ(extrapolation_at_specular({{}, {}, 30, {}}), 4);
  // The textbook coefficients grow as 1/(travel - 15)^2 and cancel: the face is lost.
  const TextbookQuadratic textbook(80, 30, above);
  hard_case("curve-travel-15", {.what = "face of a curve whose travel is the next number above 15",
                                .textbook = std::abs(textbook.at(15) - 80),
                                .ours = difference(lab_at(steep, 15), steep.face),
                                .bound = 0,
                                .unit = "L*"});
  EXPECT_TRUE(std::isnan(TextbookQuadratic(80, 30, 15).at(20)));
  EXPECT_NEAR(lab_at({{80, 0, 0}, {30, 0, 0}, 15 + 1e-9, {}}, 15).L, 80, 1e-13);
}

TEST(HardCase, AspecularNonmonotone) {
  struct {
    double at_15, at_45, at_110;
  } const odd[] = {{50, 60, 40}, {50, 30, 40}, {40, 60, 50}, {50, 60, 50}, {50, 40, 50}, {50, 50, 40}, {0, -5, 3}};
  // How far a travel is outside of its domain: above 15 and up to 180 deg.
  const auto outside_deg = [](double travel) {
    return std::isfinite(travel) ? std::max({0.0, std::nextafter(15.0, 16.0) - travel, travel - 180}) : INFINITY;
  };
  double textbook_outside = 0, ours_outside = 0;
  for (const auto& q : odd) {
    // Not a number, infinite, or on the wrong side of 15 deg.
    const double textbook = textbook_travel_deg(q.at_15, q.at_45, q.at_110);
    EXPECT_GT(outside_deg(textbook), 0);
    textbook_outside = worst_of(textbook_outside, outside_deg(textbook));
    const ChannelCurve curve = channel_curve(q.at_15, q.at_45, q.at_110);
    EXPECT_FALSE(curve.exact);
    ASSERT_TRUE(check({{}, {}, curve.travel_deg, {}}).ok()) << curve.travel_deg;
    ours_outside = worst_of(ours_outside, outside_deg(curve.travel_deg));
    // Least squares: no clamped quadratic of a fine brute-force scan comes closer.
    const auto squares = [&](const auto& at) {
      return std::pow(at(15) - q.at_15, 2) + std::pow(at(45) - q.at_45, 2) + std::pow(at(110) - q.at_110, 2);
    };
    const double ours = squares([&](double t) { return curve.at(t); });
    for (double travel = 15.5; travel <= 180; travel += 2.5)
      for (double face = -20; face <= 80; face += 2)
        for (double flop = -20; flop <= 80; flop += 2) {
          const ChannelCurve other{face, flop, travel, false};
          ASSERT_LE(ours, squares([&](double t) { return other.at(t); }) + 1e-9);
        }
    // And the residual is told.
    const auto fit = appearance_from_rows({{{.aspecular_deg = 15}, {q.at_15 + 50, 0, 0}},
                                           {{.aspecular_deg = 45}, {q.at_45 + 50, 0, 0}},
                                           {{.aspecular_deg = 110}, {q.at_110 + 50, 0, 0}}});
    EXPECT_GT(*fit->appearance.residual_de00, 0.1);
    EXPECT_EQ(fit->de00.size(), 3u);
  }
  hard_case("aspecular-nonmonotone", {.what = "travel outside of its domain, L45 not between L15 and L110",
                                      .textbook = textbook_outside,
                                      .ours = ours_outside,
                                      .bound = 0,
                                      .unit = "deg"});
}

// Every channel with 0 <= s < 1 whose vertex stays within 180 deg is met at all three angles.
TEST(Curve, ThreeAnglesAreMetExactly) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> value(-80, 100), share(0, 1);
  int plateau = 0, vertex = 0, beyond = 0;
  for (int i = 0; i < 20000; ++i) {
    const double q15 = value(random), q110 = value(random), s = i % 100 == 0 ? 0 : share(random);
    const double q45 = q110 + s * (q15 - q110);
    const ChannelCurve curve = channel_curve(q15, q45, q110);
    if (!curve.exact) {
      // A vertex at 180 deg has s = (135^2 - 70^2)/(165^2 - 70^2) = 0.5966.
      EXPECT_GT(s, 0.5965);
      ++beyond;
      continue;
    }
    // Values up to 100 carry 1.4e-14; the vertex form scales them by at most (165/70)^2 and adds.
    EXPECT_NEAR(curve.at(15), q15, 2e-13);
    EXPECT_NEAR(curve.at(45), q45, 2e-13 * std::max(1.0, 180 / (180.0001 - curve.travel_deg)));
    EXPECT_NEAR(curve.at(110), q110, 2e-12);
    EXPECT_GT(curve.travel_deg, 44.999);
    (curve.travel_deg <= 110 ? plateau : vertex)++;
  }
  EXPECT_GT(plateau, 1000);
  EXPECT_GT(vertex, 1000);
  EXPECT_GT(beyond, 1000);
}

TEST(Curve, TheMappingIsContinuousWhereThePlateauLeaves110) {
  const double s = std::pow(65.0 / 95.0, 2);
  const ChannelCurve before = channel_curve(1, s - 1e-9, 0), after = channel_curve(1, s + 1e-9, 0);
  EXPECT_LE(before.travel_deg, 110);
  EXPECT_GT(after.travel_deg, 110);
  EXPECT_NEAR(before.travel_deg, after.travel_deg, 1e-4);
  EXPECT_NEAR(before.flop, after.flop, 1e-6);
}

TEST(Curve, RowsOfAnAppearanceGiveItBack) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> travel(26, 180), axis(-40, 40), light(10, 110);
  for (int i = 0; i < 300; ++i) {
    const Appearance made{
        {light(random), axis(random), axis(random)}, {light(random), axis(random), axis(random)}, travel(random), {}};
    const auto fit = appearance_from_rows(rows_at(made, {-15, 15, 25, 45, 75, 110}));
    ASSERT_TRUE(fit.ok());
    // The squares have their minimum 0 at the travel, so it is found to rounding, not to its square root; rows at 25
    // deg fix a travel of 26 deg by their distance from the flop, (1/11)^2 of the whole.
    EXPECT_NEAR(fit->appearance.travel_deg, made.travel_deg, 1e-6) << i;
    EXPECT_LE(difference(fit->appearance.face, made.face), 1e-6);
    EXPECT_LE(difference(fit->appearance.flop, made.flop), 1e-6);
    EXPECT_LE(*fit->appearance.residual_de00, 1e-6);
  }
}

TEST(Curve, OpenTravelExtrapolatesLeast) {
  // A step between 15 and 25 deg: any travel between them meets both; the largest is taken.
  const auto step = appearance_from_rows({{{.aspecular_deg = 15}, {80, 0, 0}},
                                          {{.aspecular_deg = 25}, {30, 0, 0}},
                                          {{.aspecular_deg = 45}, {30, 0, 0}},
                                          {{.aspecular_deg = 110}, {30, 0, 0}}});
  EXPECT_NEAR(step->appearance.travel_deg, 25, 1e-9);
  EXPECT_NEAR(step->appearance.face.L, 80, 1e-12);
  // Two angles: the plateau begins at the wider one. One angle: a solid color.
  const auto two = appearance_from_rows({{{.aspecular_deg = 15}, {80, 0, 0}}, {{.aspecular_deg = 45}, {30, 0, 0}}});
  EXPECT_EQ(two->appearance.travel_deg, 45);
  EXPECT_NEAR(two->appearance.flop.L, 30, 1e-12);
  const auto one = appearance_from_rows({{{.aspecular_deg = 45}, {30, 1, 2}}});
  EXPECT_EQ(one->appearance.face, (color::Lab{30, 1, 2}));
  EXPECT_EQ(one->appearance.flop, (color::Lab{30, 1, 2}));
  EXPECT_FALSE(appearance_from_rows({}).ok());
}

TEST(Curve, OutOfPlaneRowsAreToldButNotFitted) {
  auto rows = rows_at({{80, 10, 5}, {30, 0, 0}, 60, {}}, {15, 25, 45, 75, 110});
  rows.push_back({{.aspecular_deg = 25, .out_of_plane = true, .azimuth_deg = 90}, {20, 0, 0}});
  const auto fit = appearance_from_rows(rows);
  EXPECT_NEAR(fit->appearance.travel_deg, 60, 1e-6);
  EXPECT_LE(*fit->appearance.residual_de00, 1e-6);
  EXPECT_GT(fit->de00.back(), 5);
}

TEST(Curve, DesignedPaintHasRowsAtBothExportSets) {
  const auto rows = rows_of({{80, 10, 5}, {30, 0, 0}, 60, {}});
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(geometry_name(rows.front().geometry), "45as15");
  EXPECT_EQ(geometry_name(rows.back().geometry), "45as110");
  EXPECT_EQ(rows.back().lab, (color::Lab{30, 0, 0}));
}

Paint measured(const std::vector<std::pair<Geometry, color::Lab>>& rows) {
  Paint paint;
  paint.name = "p";
  paint.measurement.emplace();
  for (const auto& [geometry, lab] : rows) paint.measurement->rows.push_back({geometry, lab});
  return paint;
}

TEST(TargetCurve, PassesThroughEveryRowAndStaysBetweenNeighbors) {
  const Paint paint = measured({{{.aspecular_deg = 110}, {22, 3, 1}},
                                {{.aspecular_deg = 15}, {80, 10, -4}},
                                {{.aspecular_deg = 25}, {60, 12, -4}},
                                {{.aspecular_deg = 45}, {35, 4, 2}},
                                {{.aspecular_deg = 75}, {24, 5, 1}}});
  const auto curve = TargetCurve::make(paint, TargetCurve::Kind::kMeasured);
  ASSERT_TRUE(curve.ok());
  EXPECT_EQ(curve->known_angles_deg(), (std::vector<double>{15, 25, 45, 75, 110}));
  for (const LabReading& row : paint.measurement->rows) EXPECT_EQ(curve->at(row.geometry.aspecular_deg), row.lab);
  for (double t = 0; t <= 180; t += 0.25) {
    const auto& known = curve->known_angles_deg();
    const double low = *std::prev(std::ranges::upper_bound(known, std::clamp(t, 15.0, 109.99)));
    const double high = *std::ranges::upper_bound(known, std::clamp(t, 15.0, 109.99));
    const color::Lab x = curve->at(low), y = curve->at(high), at = curve->at(t);
    const auto between = [](double v, double p, double q) {
      return v >= std::min(p, q) - 1e-12 && v <= std::max(p, q) + 1e-12;
    };
    EXPECT_TRUE(between(at.L, x.L, y.L) && between(at.a, x.a, y.a) && between(at.b, x.b, y.b)) << t;
  }
  EXPECT_EQ(curve->at(0), (color::Lab{80, 10, -4}));
  EXPECT_EQ(curve->at(180), (color::Lab{22, 3, 1}));
}

TEST(TargetCurve, RowsOnALineOverThePlaceStayOnIt) {
  const auto line = [](double t) { return 90 - 20 * std::log((t + 5) / 20); };
  std::vector<std::pair<Geometry, color::Lab>> rows;
  for (const double t : {15.0, 25.0, 45.0, 75.0}) rows.push_back({{.aspecular_deg = t}, {line(t), 0, 0}});
  const auto curve = TargetCurve::make(measured(rows), TargetCurve::Kind::kMeasured);
  for (double t = 15; t <= 75; t += 0.5) EXPECT_NEAR(curve->at(t).L, line(t), 1e-12);
}

TEST(TargetCurve, PlacesAndAnglesAreInverse) {
  for (double t = 0; t <= 180; t += 7.5) {
    EXPECT_NEAR(angle_of_place_deg(curve_place(t)), t, 1e-12);
    EXPECT_NEAR((curve_place(t + 1e-4) - curve_place(t)) / 1e-4, curve_place_slope(t), 2e-6);
  }
}

TEST(TargetCurve, BothSidesOfSpecularAreAveragedAndOutOfPlaneLeftOut) {
  const auto curve =
      TargetCurve::make(measured({{{.aspecular_deg = 15}, {80, 0, 0}},
                                  {{.aspecular_deg = -15}, {84, 2, 0}},
                                  {{.aspecular_deg = 45}, {30, 0, 0}},
                                  {{.aspecular_deg = 25, .out_of_plane = true, .azimuth_deg = 90}, {20, 0, 0}}}),
                        TargetCurve::Kind::kMeasured);
  EXPECT_EQ(curve->known_angles_deg(), (std::vector<double>{15, 45}));
  EXPECT_EQ(curve->at(15), (color::Lab{82, 1, 0}));
  // Two rows make a line over the place, ln(t + 5 deg): 35 deg lies halfway between 20 and 50 deg by ratio.
  EXPECT_NEAR(curve->at(std::sqrt(20.0 * 50.0) - 5).L, 56, 1e-12);
}

// Each channel travels on its own, as the common travel of face and flop cannot, and is met where it is a quadratic.
TEST(TargetCurve, ChannelsTravelOnTheirOwn) {
  const ChannelCurve L{80, 20, 60, true}, a{-10, 30, 120, true}, b{5, -40, 45, true};
  std::vector<std::pair<Geometry, color::Lab>> rows;
  for (const double t : {15.0, 25.0, 45.0, 75.0, 110.0})
    rows.push_back({{.aspecular_deg = t}, {L.at(t), a.at(t), b.at(t)}});
  const Paint paint = measured(rows);
  const auto curve = TargetCurve::make(paint, TargetCurve::Kind::kCurve);
  for (double t = 10; t <= 130; t += 5) {
    EXPECT_NEAR(curve->at(t).L, L.at(t), 1e-6) << t;
    EXPECT_NEAR(curve->at(t).a, a.at(t), 1e-6) << t;
    EXPECT_NEAR(curve->at(t).b, b.at(t), 1e-6) << t;
  }
  // The control: the nearest face and flop.
  EXPECT_GT(*appearance_from_rows(paint.measurement->rows)->appearance.residual_de00, 1);
}

// Readings close together near specular count no more than the one whose place they take.
TEST(TargetCurve, CloseReadingsDoNotOutvoteTheFlop) {
  const auto rows = [](const std::vector<double>& angles) {
    std::vector<std::pair<Geometry, color::Lab>> r;
    for (const double t : angles) r.push_back({{.aspecular_deg = t}, {100 * std::exp(-t / 30), 0, 0}});
    return measured(r);
  };
  const Paint few = rows({15, 25, 45, 75, 110}), many = rows({15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 45, 75, 110});
  const auto sparse = TargetCurve::make(few, TargetCurve::Kind::kCurve);
  const auto dense = TargetCurve::make(many, TargetCurve::Kind::kCurve);
  // The control: the same readings with one vote each.
  std::vector<ChannelValue> equal;
  for (const LabReading& r : many.measurement->rows) equal.push_back({r.geometry.aspecular_deg, r.lab.L});
  const ChannelCurve control = nearest_channel_curve(equal);
  double worst = 0, worst_control = 0;
  for (const double t : {45.0, 60.0, 75.0, 90.0, 110.0}) {
    worst = std::max(worst, std::abs(dense->at(t).L - sparse->at(t).L));
    worst_control = std::max(worst_control, std::abs(control.at(t) - sparse->at(t).L));
  }
  EXPECT_LT(worst, 0.5);
  EXPECT_GT(worst_control, 2 * worst);
}

TEST(TargetCurve, FallsBackOnWhatThePaintHas) {
  Paint designed;
  designed.name = "d";
  designed.appearance = Appearance{{80, 0, 0}, {30, 0, 0}, 60, {}};
  const auto curve = TargetCurve::make(designed, TargetCurve::Kind::kMeasured);
  EXPECT_EQ(curve->kind(), TargetCurve::Kind::kCurve);
  EXPECT_EQ(curve->known_angles_deg(), (std::vector<double>{15, 25, 45, 75, 110}));
  EXPECT_EQ(curve->at(90).L, 30);
  const auto fitted = TargetCurve::make(
      measured({{{.aspecular_deg = 15}, {80, 0, 0}}, {{.aspecular_deg = 45}, {30, 0, 0}}}), TargetCurve::Kind::kCurve);
  EXPECT_EQ(fitted->kind(), TargetCurve::Kind::kCurve);
  EXPECT_EQ(fitted->known_angles_deg(), (std::vector<double>{15, 45}));
  EXPECT_NEAR(fitted->at(100).L, 30, 1e-12);
  Paint blank;
  blank.name = "nothing";
  EXPECT_EQ(TargetCurve::make(blank, TargetCurve::Kind::kMeasured).error().message,
            "paint \"nothing\" has no color: give it a measurement or an appearance");
  designed.appearance->travel_deg = 10;
  EXPECT_FALSE(TargetCurve::make(designed, TargetCurve::Kind::kCurve).ok());
}

}  // namespace
}  // namespace goniochrome::paint::curve_test
