// Readings of a paint stay when its coat is drawn: readings that lobes meet without the coat are met under it, by
// weights for views where no weights for all views can. Without those the report names what is lost. All paints of
// testdata/, and those of shared data where GONIOCHROME_DATA names it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

#include "base/angles.h"
#include "base/testdata_for_test.h"
#include "brdf/lobe_model.h"
#include "fit/internal/coat_readings.h"
#include "fit/internal/target_rows.h"
#include "fit/paint_fit.h"
#include "formats/csv.h"
#include "formats/paint_source.h"

namespace goniochrome::fit::coated_readings_test {
namespace {

const formats::Basis kBasis = {"b7", {1.3, 6, 20, 70, 250, 900, 3000}, true};

void add_table(const std::string& file, std::vector<paint::Paint>& paints) {
  auto reader = formats::CsvPaintReader::open(file);
  ASSERT_TRUE(reader.ok()) << file;
  for (;;) {
    auto paint = reader->next();
    ASSERT_TRUE(paint.ok()) << file;
    if (!*paint) return;
    paints.push_back(**paint);
  }
}

// Those with readings or an appearance.
const std::vector<paint::Paint>& all_paints() {
  static const std::vector<paint::Paint> all = [] {
    std::vector<paint::Paint> paints;
    for (const char* file : {"paints.paints.xml", "travel.paints.xml"})
      std::ranges::copy(*formats::read_paints(testdata(file)), std::back_inserter(paints));
    for (const char* file : {"paints.csv", "paints-wide.csv"}) add_table(testdata(file), paints);
    if (const char* data = std::getenv("GONIOCHROME_DATA"))
      for (const char* file : {"measured-multiangle.csv", "reconstructed-multiangle.csv"})
        add_table(std::string(data) + "/lab/" + file, paints);
    return paints;
  }();
  return all;
}

// The readings that the lobes show to 1e-9 in reflectance factor, by their numbers among those beyond glare.
std::set<std::size_t> met(const paint::Paint& paint, const paint::LobeFit& fit) {
  paint::LobeFit base = fit;
  for (paint::Lobe& lobe : base.lobes) lobe.gloss = {};
  for (paint::ViewLobes& view : base.views)
    for (paint::Lobe& lobe : view.lobes) lobe.gloss = {};
  const color::Xyz white = *color::white_point(paint::condition_of(paint));
  std::set<std::size_t> numbers;
  std::size_t number = 0;
  for (const paint::LabReading& reading : paint.measurement->rows) {
    if (paint::aspecular_angle_deg(reading.geometry) < kGlareAngle_deg) continue;
    const paint::DirectionPair at = paint::directions(reading.geometry);
    const color::Rgb apart =
        kPi * brdf::coated_brdf(base, at.light, at.view, {0, 0, 1}) - color::rgb_from_lab(reading.lab, white);
    if (std::max({std::abs(apart.x), std::abs(apart.y), std::abs(apart.z)}) <= 1e-9) numbers.insert(number);
    ++number;
  }
  return numbers;
}

struct Counts {
  std::size_t readings = 0, bare = 0, lost = 0, lost_by_view = 0, unheld = 0, paints = 0;
  double largest_de00 = 0;
};

// The weights for all views, of lobes that have any. Views keep some lobes that have none for all views.
std::vector<color::Rgb> weights_for_all(const paint::LobeFit& fit) {
  std::vector<color::Rgb> weights = {fit.diffuse};
  for (const paint::Lobe& lobe : fit.lobes) {
    if (lobe.directional_diffuse == color::Rgb{} && lobe.gloss == color::Rgb{}) continue;
    weights.push_back(lobe.directional_diffuse), weights.push_back(lobe.gloss);
  }
  return weights;
}

// The fit by flake_fit() alone, which does not hold the readings that are met without the coat.
std::set<std::size_t> met_unheld(const paint::Paint& paint, double coat_index) {
  const color::Xyz white = *color::white_point(paint::condition_of(paint));
  const FitOptions options;
  const Target target = *target_rows(paint, options.target, white, kBasis.exponents, coat_index);
  FlakeTarget flake{white, {}, {}};
  for (const TargetRow& row : target.rows) flake.rows.push_back(flake_row(row, options, row.importance < 1));
  const FlakeModel model{seen_exponents(kBasis.exponents, target.first_deg * kDegree)};
  const FlakeFit fit = flake_fit(FitMethod::kL1, flake, model, Deadline(0));
  paint::LobeFit lobes;
  lobes.coat_index = coat_index, lobes.diffuse = (1 / kPi) * fit.x[0];
  for (std::size_t j = 0; j < model.exponents.size(); ++j)
    lobes.lobes.push_back({model.exponents[j], (1 / kPi) * fit.x[j + 1], {}});
  return met(paint, lobes);
}

TEST(CoatedReadings, AreMetAsWithoutTheCoatOrToldByTheReport) {
  const std::vector<paint::GlossReading> glossy = {{60, 90}};
  const PaintFitter bare(kBasis, {.assumed_gloss = glossy, .coat_index = paint::kNoCoat}),
      coated(kBasis, {.assumed_gloss = glossy, .view_sets = ViewSets::kNone}),
      by_default(kBasis, {.assumed_gloss = glossy});
  Counts counts;
  for (const paint::Paint& paint : all_paints()) {
    if (!paint.measurement) continue;
    const auto without = bare.fit(paint), under = coated.fit(paint), views = by_default.fit(paint);
    ASSERT_TRUE(without.ok() && under.ok() && views.ok()) << paint.name;
    ASSERT_GT(under->lobes.coat_index, paint::kNoCoat) << paint.name;
    const std::set<std::size_t> before = met(paint, without->lobes), after = met(paint, under->lobes),
                                unheld = met_unheld(paint, under->lobes.coat_index);
    std::set<std::string> told;
    for (const GeometryError& lost : under->report.lost_to_coat) {
      told.insert(lost.geometry);
      counts.largest_de00 = std::max(counts.largest_de00, lost.de00);
    }
    EXPECT_TRUE(without->report.lost_to_coat.empty()) << paint.name;
    const auto& errors = under->report.de00_by_geometry;
    for (std::size_t i = 0; i < errors.size(); ++i) {
      if (!before.contains(i)) continue;
      EXPECT_NE(after.contains(i), told.contains(errors[i].geometry)) << paint.name << " " << errors[i].geometry;
      counts.unheld += !unheld.contains(i);
    }
    counts.readings += errors.size(), counts.bare += before.size(), counts.lost += told.size();
    counts.lost_by_view += views->report.lost_to_coat.size();
    const std::set<std::size_t> with_views = met(paint, views->lobes);
    for (const std::size_t i : before) EXPECT_TRUE(with_views.contains(i)) << paint.name << " " << errors[i].geometry;
    EXPECT_EQ(views->report.views_for_coat, !told.empty()) << paint.name;
    EXPECT_EQ(views->lobes.views.empty(), told.empty()) << paint.name;
    EXPECT_EQ(weights_for_all(views->lobes), weights_for_all(under->lobes)) << paint.name;
    counts.paints += !told.empty();
  }
  std::printf(
      "of %zu readings %zu are met without a coat; of these %zu of %zu paints are lost under it, by up to dE00 %.2f, "
      "%zu of them by weights for views too; fits that hold none lose %zu\n",
      counts.readings, counts.bare, counts.lost, counts.paints, counts.largest_de00, counts.lost_by_view,
      counts.unheld);
  EXPECT_GT(counts.bare, 100U);
  EXPECT_GT(counts.lost, 0U) << "the paints no longer have a case that no weights can meet";
  EXPECT_EQ(counts.lost_by_view, 0U);
  EXPECT_GT(counts.unheld, counts.lost) << "the control: holding them makes no difference";
}

// A reading is told as lost only where no weights meet it together with those that are met: the least squares over
// these rows alone have a residual. The control is the same without the reading that was lost.
TEST(CoatedReadings, OnlyWhatNoWeightsMeetIsLost) {
  const std::vector<paint::GlossReading> glossy = {{60, 90}};
  const PaintFitter coated(kBasis, {.assumed_gloss = glossy, .view_sets = ViewSets::kNone});
  std::size_t checked = 0;
  for (const paint::Paint& paint : all_paints()) {
    if (!paint.measurement) continue;
    const auto under = coated.fit(paint);
    ASSERT_TRUE(under.ok());
    if (under->report.lost_to_coat.empty()) continue;
    const std::set<std::size_t> held = met(paint, under->lobes);
    const color::Xyz white = *color::white_point(paint::condition_of(paint));
    const auto& rows = paint.measurement->rows;
    std::vector<std::size_t> numbers(held.begin(), held.end());
    double first_deg = 180;
    for (const auto& row : rows) first_deg = std::min(first_deg, paint::aspecular_angle_deg(row.geometry));
    const FlakeModel model{seen_exponents(kBasis.exponents, first_deg * kDegree)};
    const auto residual = [&](const std::vector<std::size_t>& which) {
      FlakeTarget target{white, {}, {}};
      for (const std::size_t i : which) {
        const FlakeReading reading = flake_reading(rows[i], under->lobes.coat_index);
        target.rows.push_back({reading.at, (1 / reading.passages) * color::rgb_from_lab(rows[i].lab, white)});
      }
      return linear_fit(Norm::kL2, linear_problem(target, model)).objective;
    };
    EXPECT_LE(residual(numbers), 1e-9) << paint.name;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (std::ranges::none_of(under->report.lost_to_coat, [&](const auto& lost) {
            return lost.geometry == paint::geometry_name(rows[i].geometry);
          }))
        continue;
      std::vector<std::size_t> more = numbers;
      more.push_back(i);
      EXPECT_GT(residual(more), 1e-7) << paint.name << " " << paint::geometry_name(rows[i].geometry);
      ++checked;
    }
  }
  EXPECT_GT(checked, 0U);
}

}  // namespace
}  // namespace goniochrome::fit::coated_readings_test
