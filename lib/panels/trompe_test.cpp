#include "panels/trompe.h"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <random>

#include "base/hard_case_for_test.h"
#include "panels/geometry_sets.h"

namespace goniochrome::panels::trompe_test {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

std::vector<PanelView> views_of(const std::string& lights, const std::string& views, double b_deg) {
  std::vector<PanelView> all;
  const GeometryList list = *geometry_list({.lights = lights, .views = views});
  for (const LightView& geometry : list.pairs)
    if (const auto view = panel_view(geometry, 90, b_deg)) all.push_back(*view);
  return all;
}

TrompeOptions varying(std::initializer_list<int> parameters) {
  TrompeOptions options;
  options.vary.fill(false);
  for (const int p : parameters) options.vary[p] = true;
  return options;
}

const paint::Appearance kSilverBlackFlop{{70, 0, 0}, {4, 0, 0}, 70, {}};
const paint::Appearance kPearl{{75, 20, 30}, {30, -15, 5}, 80, {}};

// A silver with black flop, 2 deg: face L* and travel alone hide it. The aspecular angle of the second panel is 2b
// smaller where it turns toward the light, so its curve must be the first one's moved by 2b: the travel falls by 2b, or
// grows by 2b for a panel that turns away.
TEST(Trompe, HidesTheTiltOfSilverWithBlackFlopByFaceAndTravel) {
  for (const double b : {2.0, -2.0}) {
    const auto fit = trompe_fit(kSilverBlackFlop, false, views_of("45", "as15:105:10", b), varying({kFaceL, kTravel}));
    ASSERT_TRUE(fit.ok()) << fit.error().message;
    EXPECT_TRUE(fit->converged);
    EXPECT_GT(fit->before.rms, 5 * fit->after.rms);
    EXPECT_NEAR(fit->b.travel_deg - kSilverBlackFlop.travel_deg, -2 * b, 0.6);
    // dL/dtheta at the face is -2 (face - flop)/(travel - 15): 2.4 a degree, 4.8 units a degree of b.
    EXPECT_NEAR(fit->b.face.L - kSilverBlackFlop.face.L, -2 * b * 2.4, 1.5);
    EXPECT_EQ(fit->b.flop, kSilverBlackFlop.flop);
    EXPECT_THAT(fit->undetermined, ::testing::IsEmpty());
  }
}

// Where the shading is the same for both panels, the shifted curve is an exact answer for a black flop of L* 0.
TEST(Trompe, FindsTheShiftedCurve) {
  std::vector<PanelView> views;
  for (double as = 15; as <= 105; as += 5) views.push_back({as, 1, as - 4, 1, 1});
  const paint::Appearance a{{60, 0, 0}, {0, 0, 0}, 75, {}};
  const auto fit = trompe_fit(a, false, views, varying({kFaceL, kTravel}));
  ASSERT_TRUE(fit.ok());
  EXPECT_NEAR(fit->b.travel_deg, 71, 1e-3);
  EXPECT_NEAR(fit->b.face.L, 60 * std::pow((71.0 - 15) / (75 - 15), 2), 1e-3);
  EXPECT_LT(fit->after.rms, 1e-3);
}

TEST(Trompe, FindsAllSevenFromTheirOwnColors) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 20; ++i) {
    // Panel B without misalignment, shown in the colors of another paint: that paint must come out.
    paint::Appearance other = kPearl;
    other.face.L += 5 * unit(random), other.face.a += 5 * unit(random), other.face.b += 5 * unit(random);
    other.flop.L += 5 * unit(random), other.flop.a += 5 * unit(random), other.flop.b += 5 * unit(random);
    other.travel_deg += 8 * unit(random);
    std::vector<color::Lab> target;
    std::vector<double> angles;
    for (double t = 15; t <= 110; t += 5) target.push_back(paint::lab_at(other, t)), angles.push_back(t);
    const auto colors = [&](const paint::Appearance& b) -> Result<std::vector<color::Lab>> {
      std::vector<color::Lab> shown;
      for (const double t : angles) shown.push_back(paint::lab_at(b, t));
      return shown;
    };
    const auto fit = trompe_fit(kPearl, false, target, std::vector<double>(target.size(), 1.0), colors, {});
    ASSERT_TRUE(fit.ok());
    EXPECT_LT(fit->after.max, 1e-2);
    EXPECT_NEAR(fit->b.travel_deg, other.travel_deg, 0.02);
  }
}

TEST(Trompe, LeastMaximumIsBelowThatOfTheLeastRms) {
  const auto views = views_of("15,30,45,60", "-60:60:10", 3);
  TrompeOptions options;
  const auto rms = trompe_fit(kPearl, false, views, options);
  options.least_maximum = true;
  const auto max = trompe_fit(kPearl, false, views, options);
  ASSERT_TRUE(rms.ok() && max.ok());
  EXPECT_LT(max->after.max, rms->after.max);
  EXPECT_GE(max->after.rms, rms->after.rms * (1 - 1e-9));
  // No neighbor is better: seven parameters, both ways.
  for (int p = 0; p < kTrompeParameters; ++p)
    for (const double step : {-0.02, 0.02}) {
      TrompeValues v = values_of(rms->b);
      v[p] += step;
      EXPECT_GE(trompe_errors(kPearl, appearance_of(v), views).rms, rms->after.rms * (1 - 1e-6)) << p;
    }
}

// [hard case] A solid paint, one geometry and mirrored geometries make the normal equations singular.
TEST(HardCase, TrompeFlatFitsEndAtTheirOptimum) {
  const paint::Appearance solid{{45, 30, 20}, {45, 30, 20}, 60, {}};
  const auto views = views_of("45", "as15:105:10", 3);
  // The textbook Newton step for all seven: G = J'J of a solid is singular, its Cholesky factor fails.
  Eigen::MatrixXd J(static_cast<Eigen::Index>(3 * views.size()), kTrompeParameters);
  for (int p = 0; p < kTrompeParameters; ++p)
    for (std::size_t i = 0; i < views.size(); ++i) {
      TrompeValues v = values_of(solid);
      v[p] += 1e-3;
      const color::Lab x = paint::lab_at(appearance_of(v), views[i].aspecular_b_deg),
                       y = paint::lab_at(solid, views[i].aspecular_b_deg);
      const auto row = static_cast<Eigen::Index>(3 * i);
      J(row, p) = (x.L - y.L) / 1e-3, J(row + 1, p) = (x.a - y.a) / 1e-3, J(row + 2, p) = (x.b - y.b) / 1e-3;
    }
  const Eigen::MatrixXd G = J.transpose() * J;
  const bool solvable = G.llt().info() == Eigen::Success && G.ldlt().rcond() > 1e-12;

  const auto fit = trompe_fit(solid, false, views, {});
  ASSERT_TRUE(fit.ok()) << fit.error().message;
  EXPECT_TRUE(fit->converged);
  EXPECT_TRUE(fit->solid);
  EXPECT_EQ(fit->b.travel_deg, 60) << "a solid paint has no travel to fit";
  EXPECT_LT(color::delta_e_76(fit->b.face, fit->b.flop), 1e-9) << "a solid paint stays solid";
  // One light: the cosine alone, which one color makes up for.
  hard_case("trompe-flat", {.what = "difference left between solid panels",
                            .textbook = solvable ? fit->after.max : INFINITY,
                            .ours = fit->after.max,
                            .bound = 1e-3,
                            .unit = "dE76"});
  EXPECT_EQ(trompe_fit(solid, false, views, varying({kTravel})).error().kind, ErrorKind::kUsage);

  // One geometry: matched there; what it leaves open is named and stays near paint A.
  const auto one = trompe_fit(kPearl, false, views_of("45", "as25", 3), {});
  ASSERT_TRUE(one.ok());
  EXPECT_LT(one->after.max, 1e-3);
  EXPECT_THAT(one->undetermined, Contains("travel"));
  EXPECT_GE(one->undetermined.size(), 4u);
  EXPECT_LT(std::abs(one->b.travel_deg - kPearl.travel_deg), 10);

  // Mirrored: one panel turned by +3 and one by -3 ask for opposite changes. It ends where it began, or better.
  auto mirrored = views;
  for (const PanelView& view : views_of("45", "as15:105:10", -3)) mirrored.push_back(view);
  const auto both = trompe_fit(kPearl, false, mirrored, {});
  ASSERT_TRUE(both.ok());
  EXPECT_TRUE(both->converged);
  EXPECT_LE(both->after.rms, both->before.rms);
  // The compromise of both is the mean of two shifted curves: the edge of the plateau is worn round, over 2b to either
  // side.
  EXPECT_NEAR(both->b.travel_deg, kPearl.travel_deg, 12);
}

TEST(Trompe, KeepsItsBoundsAndTellsThem) {
  TrompeOptions options = varying({kFaceL, kTravel});
  options.high[kFaceL] = 71;
  const auto fit = trompe_fit(kSilverBlackFlop, false, views_of("45", "as15:105:10", -2), options);
  ASSERT_TRUE(fit.ok());
  EXPECT_LE(fit->b.face.L, 71 + 1e-12);
  EXPECT_THAT(fit->at_bound, Contains("face_l"));
  options.high[kFaceL] = 40;  // paint A itself is outside: the bound holds all the same
  EXPECT_LE(trompe_fit(kSilverBlackFlop, false, views_of("45", "as15:105:10", -2), options)->b.face.L, 40 + 1e-12);
}

TEST(Trompe, RefusesBadProblemsByName) {
  const auto views = views_of("45", "as45", 2);
  TrompeOptions options = varying({});
  EXPECT_THAT(trompe_fit(kPearl, false, views, options).error().message, HasSubstr("nothing to vary"));
  options = {};
  options.low[kTravel] = 10;
  EXPECT_THAT(trompe_fit(kPearl, false, views, options).error().message, HasSubstr("above 15"));
  options = {};
  options.low[kFaceL] = 90, options.high[kFaceL] = 20;
  EXPECT_THAT(trompe_fit(kPearl, false, views, options).error().message, HasSubstr("bounds of face_l are 90 to 20"));
  EXPECT_THAT(trompe_fit(kPearl, false, std::vector<PanelView>{}, {}).error().message, HasSubstr("no view"));
  paint::Appearance beyond = kPearl;
  beyond.travel_deg = 15;
  EXPECT_THAT(trompe_fit(beyond, false, views, {}).error().message, HasSubstr("travel is 15"));
}

// Under a coat light and viewer count with what it lets through; without one, nothing changes.
TEST(Trompe, ViewsUnderACoatAreThoseOfTheCurve) {
  const LightView geometry{60, 70, 0};
  const PanelView view = *panel_view(geometry, 90, 6);
  EXPECT_EQ(view.under_coat(paint::kNoCoat).cos_a, view.cos_a);
  paint::Paint paint;
  paint.appearance = kPearl;
  paint.coat_index = 1.5;
  const FlakeCurve curve = *FlakeCurve::make(paint, paint::TargetCurve::Kind::kCurve);
  const TrompeErrors errors = trompe_errors(kPearl, kPearl, under_coat({view}, 1.5));
  EXPECT_NEAR(errors.max, difference_at(curve, TiltedPair::make(geometry, 90), 6, DifferenceMetric::kDe76), 1e-9);
  EXPECT_GT(std::abs(errors.max - trompe_errors(kPearl, kPearl, {view}).max), 0.1);
}

}  // namespace
}  // namespace goniochrome::panels::trompe_test
