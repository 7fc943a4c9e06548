#include "paint/edit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "base/hard_case_for_test.h"
#include "paint/curve.h"

namespace goniochrome::paint::edit_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

// Lab values up to 150 go through a handful of operations, each rounded by half an ulp (1.4e-14 at 128): 1e-12 leaves
// room for some seventy of them.
constexpr double kRounding = 1e-12;

void expect_near(const color::Lab& x, const color::Lab& y, double bound = kRounding) {
  EXPECT_NEAR(x.L, y.L, bound);
  EXPECT_NEAR(x.a, y.a, bound);
  EXPECT_NEAR(x.b, y.b, bound);
}

Appearance blue() {
  return {{62, -13.5, -51}, {12, 17, -38}, 72, std::nullopt};
}

LabReading reading(const char* geometry, const color::Lab& lab) {
  return {*parse_geometry(geometry), lab};
}

// A paint whose rows lie on its curve.
Paint on_curve(const Appearance& appearance) {
  Paint paint;
  paint.name = "p";
  paint.appearance = appearance;
  paint.measurement.emplace();
  for (const char* geometry : {"45as-15", "45as15", "45as25", "45as45", "45as75", "45as110", "45as60az125"}) {
    const double angle = aspecular_angle_deg(*parse_geometry(geometry));
    paint.measurement->rows.push_back(reading(geometry, lab_at(appearance, angle)));
  }
  paint.gloss = {{60, 91}};
  return paint;
}

// A three-angle measurement, without an appearance.
Paint measured() {
  Paint paint;
  paint.name = "m";
  paint.code = "RM331";
  paint.paint_class = PaintClass::kMetallic;
  paint.measurement = Measurement{{}, "meter", {}};
  paint.measurement->rows = {reading("45as15", {57.7, -13.3, -55.4}), reading("45as45", {29.1, 3.8, -53.2}),
                             reading("45as110", {12.2, 17.9, -39.4})};
  return paint;
}

Paint done(const Paint& paint, const Edit& edit) {
  const auto result = edited(paint, edit);
  EXPECT_TRUE(result.ok());
  return result->paint;
}

TEST(Tweak, IdentityChangesNoBit) {
  const color::Lab lab{41.3, -0.1, 17.7};
  EXPECT_EQ(tweaked(lab, {}), lab);
}

TEST(Tweak, TurnsScalesAndLifts) {
  expect_near(tweaked({50, 30, -10}, {4, 2, 90}), {54, 20, 60});
  EXPECT_NEAR(color::chroma(tweaked({50, 30, -10}, {0, 1, 37})), std::hypot(30, 10), kRounding);
  EXPECT_EQ(color::chroma(tweaked({50, 30, -10}, {0, 0, 0})), 0);
}

TEST(FaceShare, IsOneAtTheFaceAndZeroAtTheFlop) {
  const Appearance a{{}, {}, 95, std::nullopt};
  EXPECT_EQ(face_share(a, 0), 1);
  EXPECT_EQ(face_share(a, 15), 1);
  EXPECT_EQ(face_share(a, 55), 0.5);
  EXPECT_EQ(face_share(a, 95), 0);
  EXPECT_EQ(face_share(a, 180), 0);
}

TEST(FaceShare, ThePrintedFormMovesTheWrongEnd) {
  // In the printed form R is 0 below 15 deg and 1 beyond the travel, and the face is blended by R: a tweak at the face
  // leaves the face alone and moves the flop.
  const Appearance a = blue();
  const auto printed = [&](double t) { return std::clamp((t - 15) / (a.travel_deg - 15), 0.0, 1.0); };
  Edit edit;
  edit.tweak.lightness = 10;
  edit.at_deg = 15;
  const Appearance ours = *done(on_curve(a), edit).appearance;
  EXPECT_EQ(ours.face.L, a.face.L + 10);
  EXPECT_EQ(ours.flop, a.flop);
  const double printed_face_L = a.face.L + printed(15) * 10;
  EXPECT_NE(printed_face_L, a.face.L + 10);
}

TEST(Edit, BlendAtAnAngleMovesEachEndByItsShare) {
  const Appearance a{{80, 20, 10}, {20, 5, 0}, 75, std::nullopt};
  Edit edit;
  edit.share = Share::kSource;
  edit.tweak = {8, 1.5, 0};
  edit.at_deg = 30;  // R = 45/60
  const Appearance b = *done(on_curve(a), edit).appearance;
  expect_near(b.face, {80 + 6, 20 * 1.375, 10 * 1.375});
  expect_near(b.flop, {20 + 2, 5 * 1.125, 0});
  EXPECT_EQ(b.travel_deg, 75);
}

// The color at the angle has the lightness, chroma and hue that were asked for, at every angle; the blend of the source
// misses them between the ends.
TEST(Edit, AtAnAngleTheColorChangesByWhatIsAsked) {
  double worst_blend = 0;
  for (double t = 0; t <= 180; t += 7.5) {
    Edit edit;
    edit.tweak = {10, 1.3, -25};
    edit.at_deg = t;
    const color::Lab wanted = tweaked(lab_at(blue(), t), edit.tweak);
    expect_near(lab_at(*done(on_curve(blue()), edit).appearance, t), wanted);
    edit.share = Share::kSource;
    edit.tweak = {10, 1, 0};
    worst_blend =
        std::max(worst_blend, lab_at(blue(), t).L + 10 - lab_at(*done(on_curve(blue()), edit).appearance, t).L);
  }
  // f(R) = 1 - R - R^2 + 2 R^3 of the shift is made; its least value is 0.472, at R = 0.608.
  EXPECT_NEAR(worst_blend, 10 * (1 - 0.472), 0.05);
}

// Among all changes of face and flop that make the change at the angle, ours has the least sum of squares.
TEST(Edit, AtAnAngleFaceAndFlopChangeLeast) {
  const double t = 40, w = std::pow((72.0 - t) / (72.0 - 15), 2);
  Edit edit;
  edit.tweak = {6, 1, 0};
  edit.at_deg = t;
  const Appearance after = *done(on_curve(blue()), edit).appearance;
  const double ours = std::pow(after.face.L - blue().face.L, 2) + std::pow(after.flop.L - blue().flop.L, 2);
  for (double of_face = -20; of_face <= 20; of_face += 0.01) {
    const double of_flop = (6 - w * of_face) / (1 - w);
    EXPECT_GE(of_face * of_face + of_flop * of_flop, ours - kRounding * 400);
  }
}

// The residual of a measured paint stands between its reading and the curve: the reading is what is seen there.
TEST(Edit, AtTheAngleOfAReadingTheReadingChangesByWhatIsAsked) {
  Edit edit;
  edit.tweak = {-3, 0.5, 40};
  edit.at_deg = 45;
  const Paint now = done(measured(), edit);
  expect_near(now.measurement->rows[1].lab, tweaked({29.1, 3.8, -53.2}, edit.tweak));
}

TEST(Edit, StatedFaceFlopAndTravelRestateTheRows) {
  const Appearance wanted{{45, 55, 30}, {20, 25, 12}, 70, std::nullopt};
  Edit edit;
  edit.face = wanted.face;
  edit.flop = wanted.flop;
  edit.travel_deg = wanted.travel_deg;
  const auto result = edited(measured(), edit);
  ASSERT_TRUE(result.ok());
  const Paint& now = result->paint;
  for (const LabReading& row : now.measurement->rows)
    expect_near(row.lab, lab_at(wanted, aspecular_angle_deg(row.geometry)));
  expect_near(now.measurement->rows[0].lab, wanted.face);
  expect_near(now.measurement->rows[2].lab, wanted.flop);
  EXPECT_NEAR(*now.appearance->residual_de00, 0, 1e-9);
  EXPECT_THAT(result->dropped, ElementsAre("residual of the rows"));
  EXPECT_GT(*result->restated_de00, 0.1);
}

TEST(Edit, AKeptResidualMovesWithTheCurve) {
  Edit edit;
  edit.face = color::Lab{45, 55, 30};
  edit.keep_residual = true;
  const auto fit = appearance_from_rows(measured().measurement->rows);
  const Paint now = done(measured(), edit);
  const color::Lab residual_now = now.measurement->rows[0].lab;
  EXPECT_NEAR(residual_now.L - 45, 57.7 - fit->appearance.face.L, kRounding);
  EXPECT_GT(std::abs(residual_now.L - 45), 0.01);
}

TEST(Edit, AReadingIsSetAndTheCurveFollows) {
  Edit edit;
  edit.readings = {reading("45as45", {40, 1, 2})};
  const auto result = edited(measured(), edit);
  ASSERT_TRUE(result.ok());
  const auto& rows = result->paint.measurement->rows;
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].lab, measured().measurement->rows[0].lab);
  EXPECT_EQ(rows[1].lab, (color::Lab{40, 1, 2}));
  const auto fit = appearance_from_rows(rows);
  EXPECT_EQ(result->paint.appearance->face, fit->appearance.face);
  EXPECT_EQ(result->fitted_de00, fit->appearance.residual_de00);
}

TEST(Edit, AReadingOfAPaintWithoutRowsStandsAmongThoseOfItsCurve) {
  Paint paint = on_curve(blue());
  paint.measurement.reset();
  Edit edit;
  edit.readings = {reading("45as25", {40, 1, 2}), reading("45as60", {20, 1, 2})};
  const Paint now = done(paint, edit);
  ASSERT_EQ(now.measurement->rows.size(), 6u);
  EXPECT_EQ(now.measurement->rows[1].lab, (color::Lab{40, 1, 2}));
  EXPECT_EQ(now.measurement->rows[0].lab, blue().face);
}

TEST(Edit, ReadingsMakeAPaintFromNothing) {
  Edit edit;
  edit.readings = measured().measurement->rows;
  const Paint now = done(Paint(), edit);
  EXPECT_EQ(now.measurement->rows.size(), 3u);
  EXPECT_EQ(now.appearance->face, appearance_from_rows(edit.readings)->appearance.face);
}

TEST(Edit, AnisotropyIsSetAndTakenAway) {
  Edit edit;
  edit.anisotropy = Anisotropy{0.05, 0.3};
  Paint brushed = done(on_curve(blue()), edit);
  ASSERT_TRUE(brushed.anisotropy);
  EXPECT_EQ(brushed.anisotropy->alpha_y, 0.3);
  edit.anisotropy = Anisotropy{};
  EXPECT_FALSE(done(brushed, edit).anisotropy);
  edit = {};
  edit.flakes = Flakes{40, 0.2, 0.3};
  const Paint coarse = done(brushed, edit);
  EXPECT_EQ(coarse.flakes, edit.flakes);
  EXPECT_TRUE(coarse.anisotropy);
  edit.flakes = Flakes{0, 0, 0};
  EXPECT_FALSE(done(coarse, edit).flakes);
}

TEST(Edit, BlackHasNoColor) {
  Edit edit;
  edit.tweak.lightness = -40;
  const auto result = edited(on_curve(blue()), edit);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->paint.appearance->flop, color::Lab());
  for (const LabReading& row : result->paint.measurement->rows) {
    EXPECT_TRUE(row.lab.L > 0 || row.lab == color::Lab()) << geometry_name(row.geometry);
  }
  EXPECT_THAT(result->clipped, testing::Contains(HasSubstr("flop: chroma 41.63 to 0, as black has none")));
}

TEST(Neighbors, AtTheEndOfTheScaleAreLeftOut) {
  Paint paint = on_curve(blue());
  paint.gloss = {{60, 92.1}};
  std::set<double> units;
  int distinct = 0;
  for (const Neighbor& neighbor : neighbors(Variation::kGloss, 5)) {
    const auto result = edited(paint, neighbor.edit);
    ASSERT_TRUE(result.ok());
    if (!is_distinct(*result, paint)) continue;
    ++distinct;
    units.insert(result->paint.gloss[0].gloss_units);
  }
  EXPECT_EQ(distinct, 5);  // -20, -15, -10, -5 and +5
  EXPECT_EQ(units.size(), 5u);
  Paint black = on_curve({{60, 0, 0}, {0, 0, 0}, 60, std::nullopt});
  for (const Neighbor& neighbor : neighbors(Variation::kFlop, 5)) {
    EXPECT_EQ(is_distinct(*edited(black, neighbor.edit), black), neighbor.name == "flop-lighter") << neighbor.name;
  }
}

TEST(Edit, ReachesTheAverageItIsTold) {
  Edit edit;
  edit.average_hue_deg = 140;
  edit.average_chroma = 25;
  edit.average_lightness = 44;
  const AverageColor average = average_color(*done(on_curve(blue()), edit).appearance);
  EXPECT_NEAR(average.hue_deg, 140, kRounding);
  EXPECT_NEAR(average.chroma, 25, kRounding);
  EXPECT_NEAR(average.L, 44, kRounding);
}

TEST(Edit, AverageHueOf360IsThatOf0) {
  Edit zero, full, negative;
  zero.average_hue_deg = 0;
  full.average_hue_deg = 360;
  negative.average_hue_deg = -360;
  expect_near(done(on_curve(blue()), zero).appearance->face, done(on_curve(blue()), full).appearance->face);
  expect_near(done(on_curve(blue()), zero).appearance->face, done(on_curve(blue()), negative).appearance->face);
}

Edit random_edit(std::mt19937& random) {
  const auto uniform = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  Edit edit;
  switch (random() % 5) {
    case 0:
      edit.tweak = {uniform(0, 20), uniform(0, 2), uniform(-180, 180)};
      break;
    case 1:
      edit.tweak = {uniform(0, 20), uniform(0, 2), uniform(-180, 180)};
      edit.at_deg = uniform(0, 180);
      break;
    case 2:
      edit.face = color::Lab{uniform(60, 120), uniform(-60, 60), uniform(-60, 60)};
      break;
    case 3:
      edit.flop_shift = {uniform(0, 40), uniform(-30, 30), uniform(-30, 30)};
      break;
    default:
      edit.travel_deg = uniform(25, 180);
  }
  return edit;
}

// Rows on the curve stay on it. Blending a row by R, which is linear in the angle, and not by the weight R^2 that the
// curve gives the face there, takes it off the curve.
TEST(Edit, RowsOnTheCurveStayOnIt) {
  std::mt19937 random(7);
  double worst_linear = 0;
  for (int i = 0; i < 500; ++i) {
    const Appearance a = blue();
    const Edit edit = random_edit(random);
    const Paint paint = done(on_curve(a), edit);
    for (const LabReading& row : paint.measurement->rows) {
      const double t = aspecular_angle_deg(row.geometry);
      expect_near(row.lab, lab_at(*paint.appearance, t));
      const double share = face_share(a, t);
      const double linear = lab_at(a, t).L + share * (paint.appearance->face.L - a.face.L) +
                            (1 - share) * (paint.appearance->flop.L - a.flop.L);
      worst_linear = std::max(worst_linear, std::abs(linear - lab_at(*paint.appearance, t).L));
    }
    EXPECT_NEAR(*paint.appearance->residual_de00, 0, 1e-9);
  }
  EXPECT_GT(worst_linear, 1);
}

TEST(Edit, WhatTheCurveDoesNotExplainStays) {
  const Paint paint = measured();
  const auto fit = appearance_from_rows(paint.measurement->rows);
  ASSERT_TRUE(fit.ok());
  Edit edit;
  edit.flop_shift = {10, 3, -4};
  edit.travel_shift_deg = 12;
  const auto result = edited(paint, edit);
  ASSERT_TRUE(result.ok());
  ASSERT_TRUE(result->fitted_de00);
  EXPECT_EQ(*result->fitted_de00, *fit->appearance.residual_de00);
  const Appearance& after = *result->paint.appearance;
  EXPECT_EQ(after.travel_deg, fit->appearance.travel_deg + 12);
  for (std::size_t i = 0; i < paint.measurement->rows.size(); ++i) {
    const double t = aspecular_angle_deg(paint.measurement->rows[i].geometry);
    const color::Lab before = paint.measurement->rows[i].lab, now = result->paint.measurement->rows[i].lab;
    const color::Lab was = lab_at(fit->appearance, t), is = lab_at(after, t);
    EXPECT_NEAR(before.L - was.L, now.L - is.L, kRounding);
    EXPECT_NEAR(before.a - was.a, now.a - is.a, kRounding);
    EXPECT_NEAR(before.b - was.b, now.b - is.b, kRounding);
  }
}

TEST(Edit, WholePaintMapsEveryRow) {
  const Paint paint = measured();
  Edit edit;
  edit.tweak = {2, 0.5, 30};
  const Paint now = done(paint, edit);
  for (std::size_t i = 0; i < paint.measurement->rows.size(); ++i)
    EXPECT_EQ(now.measurement->rows[i].lab, tweaked(paint.measurement->rows[i].lab, edit.tweak));
}

TEST(Edit, KeepsTheIdentityAndForgetsTheMeter) {
  Edit edit;
  edit.tweak.lightness = 1;
  const Paint now = done(measured(), edit);
  EXPECT_EQ(now.name, "m");
  EXPECT_EQ(now.code, "RM331");
  EXPECT_EQ(now.paint_class, PaintClass::kMetallic);
  EXPECT_EQ(now.measurement->instrument, "");
}

TEST(Edit, DropsWhatHoldsTheOldColor) {
  Paint paint = on_curve(blue());
  paint.lobes.emplace();
  paint.color_map = ColorMapReference{"map.exr", 1.5};
  paint.anisotropy = Anisotropy{0.05, 0.3};
  Edit edit;
  edit.tweak.hue_deg = 5;
  const auto result = edited(paint, edit);
  ASSERT_TRUE(result.ok());
  EXPECT_FALSE(result->paint.lobes);
  EXPECT_FALSE(result->paint.color_map);
  EXPECT_TRUE(result->paint.anisotropy);
  EXPECT_THAT(result->dropped, ElementsAre("lobes", "color map"));
}

TEST(Edit, GlossAloneLeavesTheColorAsItIs) {
  Paint paint = measured();
  paint.lobes.emplace();
  paint.color_map = ColorMapReference{"map.exr", 1.5};
  paint.gloss = {{20, 80}, {60, 91}};
  Edit edit;
  edit.gloss = 30;
  const auto result = edited(paint, edit);
  ASSERT_TRUE(result.ok());
  EXPECT_FALSE(result->paint.appearance);
  EXPECT_EQ(result->paint.measurement->instrument, "meter");
  EXPECT_EQ(result->paint.measurement->rows[0].lab, paint.measurement->rows[0].lab);
  EXPECT_TRUE(result->paint.color_map);
  ASSERT_EQ(result->paint.gloss.size(), 1u);
  EXPECT_EQ(result->paint.gloss[0].gloss_units, 30);
  EXPECT_THAT(result->dropped, ElementsAre("gloss at 20 deg", "lobes"));
}

TEST(Edit, GlossStaysWithinItsScale) {
  Edit up, down;
  up.gloss_shift = 50;
  down.gloss_shift = -95;
  EXPECT_EQ(done(on_curve(blue()), up).gloss[0].gloss_units, 100);
  EXPECT_EQ(done(on_curve(blue()), down).gloss[0].gloss_units, 0);
  Paint mirror = on_curve(blue());
  mirror.gloss = {{60, 400}};
  EXPECT_EQ(done(mirror, up).gloss[0].gloss_units, 400);
  EXPECT_EQ(done(mirror, down).gloss[0].gloss_units, 305);
}

TEST(Edit, GlossShiftWithoutAReadingIsLeftOut) {
  Edit edit;
  edit.gloss_shift = 5;
  edit.gloss_angle_deg = 20;
  const auto result = edited(on_curve(blue()), edit);
  ASSERT_TRUE(result.ok());
  EXPECT_THAT(result->skipped, ElementsAre(HasSubstr("20 deg")));
  EXPECT_EQ(result->paint.gloss.size(), 1u);
}

TEST(Edit, GrayHasNoHueToSet) {
  const Appearance gray{{60, 0.2, 0}, {30, 0, -0.3}, 70, std::nullopt};
  Edit edit;
  edit.average_hue_deg = 90;
  edit.average_lightness = 50;
  const auto result = edited(on_curve(gray), edit);
  ASSERT_TRUE(result.ok());
  EXPECT_THAT(result->skipped, ElementsAre(HasSubstr("hue")));
  EXPECT_EQ(result->paint.appearance->face.a, 0.2);
  EXPECT_NEAR(average_color(*result->paint.appearance).L, 50, kRounding);
}

TEST(Edit, TravelOutOfItsDomainIsLeftOut) {
  for (const double shift : {-57.0, -200.0, 108.5}) {
    Edit edit;
    edit.travel_shift_deg = shift;
    const auto result = edited(on_curve(blue()), edit);
    ASSERT_TRUE(result.ok());
    EXPECT_THAT(result->skipped, ElementsAre(HasSubstr("travel")));
    EXPECT_EQ(result->paint.appearance->travel_deg, 72);
  }
  Edit last;
  last.travel_shift_deg = 108;
  EXPECT_EQ(done(on_curve(blue()), last).appearance->travel_deg, 180);
}

TEST(Edit, LightnessStopsAtBlack) {
  Edit edit;
  edit.tweak.lightness = -20;
  const auto result = edited(on_curve(blue()), edit);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result->paint.appearance->flop.L, 0);
  EXPECT_EQ(result->paint.appearance->face.L, 42);
  for (const LabReading& row : result->paint.measurement->rows) EXPECT_GE(row.lab.L, 0);
  EXPECT_THAT(result->clipped, testing::Contains(HasSubstr("flop")));
}

TEST(Edit, PaintWithoutColorTakesGlossOnly) {
  Paint paint;
  paint.gloss = {{60, 50}};
  Edit edit;
  edit.tweak.lightness = 3;
  edit.gloss_shift = 3;
  const auto result = edited(paint, edit);
  ASSERT_TRUE(result.ok());
  EXPECT_THAT(result->skipped, ElementsAre(HasSubstr("color")));
  EXPECT_FALSE(result->paint.appearance);
  EXPECT_EQ(result->paint.gloss[0].gloss_units, 53);
}

// The form that divides by the quadratic's first coefficient has 0/0 for a solid: the vertex form keeps it constant.
TEST(HardCase, CurveSolidEdited) {
  const color::Lab gray{50, 0, 0};
  Paint paint = on_curve({gray, gray, 60, std::nullopt});
  paint.appearance.reset();
  for (LabReading& row : paint.measurement->rows) row.lab = gray;
  Edit edit;
  edit.tweak = {7, 1.2, 15};
  edit.travel_deg = 140;
  const Paint now = done(paint, edit);
  double ours = 0;
  for (const LabReading& row : now.measurement->rows) ours = worst_of(ours, color::delta_e_76(row.lab, {57, 0, 0}));
  EXPECT_EQ(now.appearance->face, now.appearance->flop);
  const double textbook_a = (gray.L - gray.L) / ((15 - 60.0) * (15 - 60.0)), textbook_b = -2 * textbook_a * 60;
  const double textbook = -textbook_b / (2 * textbook_a);
  hard_case(
      "curve-solid",
      {.what = "readings of an edited solid paint", .textbook = textbook, .ours = ours, .bound = 0, .unit = "dE76"});
}

TEST(Neighbors, AreEightDistinctOnesAtTheStep) {
  const Paint paint = on_curve(blue());
  for (const Variation variation : {Variation::kFace, Variation::kFlop, Variation::kTravel, Variation::kGloss}) {
    std::set<std::string> names;
    for (const Neighbor& neighbor : neighbors(variation, 2)) {
      names.insert(neighbor.name);
      const Paint now = done(paint, neighbor.edit);
      const double face = color::delta_e_76(now.appearance->face, blue().face);
      const double flop = color::delta_e_76(now.appearance->flop, blue().flop);
      EXPECT_NEAR(face, variation == Variation::kFace ? 2 : 0, kRounding) << neighbor.name;
      EXPECT_NEAR(flop, variation == Variation::kFlop ? 2 : 0, kRounding) << neighbor.name;
      EXPECT_EQ(now.appearance->travel_deg != 72, variation == Variation::kTravel) << neighbor.name;
      EXPECT_EQ(now.gloss[0].gloss_units != 91, variation == Variation::kGloss) << neighbor.name;
    }
    EXPECT_EQ(names.size(), 8u);
  }
}

TEST(Between, StartsAtOnePaintAndEndsAtTheOther) {
  const Appearance red{{52, 60, 33}, {11, 29, 15}, 80, std::nullopt};
  const Paint from = on_curve(blue()), to = on_curve(red);
  for (const double fraction : {0.0, 1.0}) {
    const auto paint = between(from, to, fraction);
    ASSERT_TRUE(paint.ok());
    const Paint& end = fraction == 0 ? from : to;
    EXPECT_EQ(paint->appearance->face, end.appearance->face);
    EXPECT_EQ(paint->appearance->flop, end.appearance->flop);
    EXPECT_EQ(paint->appearance->travel_deg, end.appearance->travel_deg);
    for (std::size_t i = 0; i < end.measurement->rows.size(); ++i)
      EXPECT_EQ(paint->measurement->rows[i].lab, end.measurement->rows[i].lab);
  }
}

TEST(Between, HalfWayIsHalfWay) {
  Appearance red{{52, 60, 33}, {11, 29, 15}, 80, std::nullopt};
  Paint to = on_curve(red);
  to.gloss = {{60, 71}, {20, 40}};
  to.paint_class = PaintClass::kPearl;
  to.measurement->rows.erase(to.measurement->rows.begin());
  const auto paint = between(on_curve(blue()), to, 0.5);
  ASSERT_TRUE(paint.ok());
  expect_near(paint->appearance->face, {57, 23.25, -9});
  EXPECT_EQ(paint->appearance->travel_deg, 76);
  ASSERT_EQ(paint->gloss.size(), 1u);
  EXPECT_EQ(paint->gloss[0].gloss_units, 81);
  EXPECT_EQ(paint->paint_class, PaintClass::kUnknown);
  EXPECT_EQ(paint->measurement->rows.size(), 6u);
  expect_near(paint->measurement->rows[0].lab, {57, 23.25, -9});
}

TEST(Between, SolidEndHasNoTravelOfItsOwn) {
  const color::Lab white{90, 0, 0};
  const auto paint = between(on_curve(blue()), on_curve({white, white, 170, std::nullopt}), 0.25);
  ASSERT_TRUE(paint.ok());
  EXPECT_EQ(paint->appearance->travel_deg, 72);
}

TEST(Between, RefusesTwoObservers) {
  Paint other = measured();
  other.name = "two_degrees";
  other.measurement->condition.observer_deg = 2;
  const auto paint = between(measured(), other, 0.5);
  ASSERT_FALSE(paint.ok());
  EXPECT_THAT(paint.error().message, HasSubstr("two_degrees"));
}

TEST(Between, KeepsTheConditionWithoutCommonGeometries) {
  Paint from = measured(), to = measured();
  from.measurement->condition.observer_deg = to.measurement->condition.observer_deg = 2;
  for (LabReading& row : to.measurement->rows) row.geometry.aspecular_deg += 1;
  const auto paint = between(from, to, 0.5);
  ASSERT_TRUE(paint.ok());
  EXPECT_EQ(condition_of(*paint).observer_deg, 2);
  // Without rows the condition would be lost in a file.
  ASSERT_EQ(paint->measurement->rows.size(), kExportAngles_deg.size());
  expect_near(paint->measurement->rows[0].lab, paint->appearance->face);

  from.measurement->condition.observer_deg = to.measurement->condition.observer_deg = 10;
  const auto usual = between(from, to, 0.5);
  ASSERT_TRUE(usual.ok());
  EXPECT_FALSE(usual->measurement);
}

}  // namespace
}  // namespace goniochrome::paint::edit_test
