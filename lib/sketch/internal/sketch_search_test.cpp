// Paints whose lobes make given lights look as samples show them.
#include "sketch/internal/sketch_search.h"

#include <gtest/gtest.h>

#include <random>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "paint/paint.h"
#include "sketch/internal/sketch_scene_for_test.h"

namespace goniochrome::sketch::sketch_search_test {
namespace {

// A solid of hardly any travel and three readings. Under a coat no weights for all views meet them, since the coat
// takes other shares of light at each of their views.
paint::Paint solid(const color::Lab& at_15, const color::Lab& at_45, const color::Lab& at_110) {
  paint::Paint paint;
  paint.measurement = paint::Measurement{};
  paint.measurement->rows = {{{45, 15}, at_15}, {{45, 45}, at_45}, {{45, 110}, at_110}};
  paint.gloss.push_back({60, 85});
  return paint;
}

// Light from all around, of which sharper lobes see less evenly, on surfaces at any angle to the viewer.
SearchSamples samples_of(const PaintWeights& weights, std::size_t count, std::mt19937_64& random) {
  std::uniform_real_distribution<double> unit(0, 1);
  SearchSamples samples;
  samples.columns = search_columns(sketch_scene::basis());
  samples.coat_index = brdf::kCoatIndex;
  for (std::size_t i = 0; i < count; ++i) {
    samples.view_deg.push_back(80 * unit(random));
    const double passed = brdf::coat_transmission(std::cos(samples.view_deg.back() * kDegree), brdf::kCoatIndex);
    for (std::size_t k = 0; k < samples.columns; ++k) {
      const bool is_mirror = k + 1 == samples.columns, is_gloss = k > 0 && k % 2 == 0;
      const double whole = k == 0      ? kPi
                           : is_mirror ? 0.04
                                       : 2 * kPi / (sketch_scene::basis().exponents[(k - 1) / 2] + 1);
      const double light = 0.3 + 0.7 * unit(random);
      samples.light.push_back((is_mirror || is_gloss ? whole * light : passed * whole * light) * Vec3{1, 1, 1});
    }
    samples.seen.push_back(shown_light(samples.columns_of(i), weights.mixed_at(samples.view_deg.back()), {}));
    samples.importance.push_back(1);
  }
  return samples;
}

double worst_de00(const FoundPaint& found, const paint::Paint& truth) {
  const paint::Paint paint = found.paint();
  double worst = 0;
  for (const paint::LabReading& row : truth.measurement->rows) {
    const double angle = row.geometry.aspecular_deg;
    const auto at = [&] {
      if (paint.appearance) return paint::lab_at(*paint.appearance, angle);
      for (const paint::LabReading& one : paint.measurement->rows)
        if (one.geometry.aspecular_deg == angle) return one.lab;
      return color::Lab{};
    };
    worst = std::max(worst, color::delta_e_2000(at(), row.lab));
  }
  return worst;
}

// The samples are exact, so that what is left is where the search stops. The control is the search by weights for all
// views, which is told no angles of the viewer: the colors it finds are those of no paint.
TEST(LobeSearch, ASolidWhoseCoatTakesItsReadingsIsFoundByItsViews) {
  std::mt19937_64 random(21);
  fit::FitOptions options;
  options.coat_index = brdf::kCoatIndex;
  const fit::PaintFitter fitter(sketch_scene::basis(), options);
  const SearchFitters fitters(sketch_scene::basis(), brdf::kCoatIndex);
  for (const paint::Paint& truth : {solid({95, -1, 2}, {94.6, -1.1, 2.2}, {94.3, -1.1, 2.3}),
                                    solid({43, 58, 37}, {42.2, 59, 38.5}, {41.7, 59.4, 39}),
                                    solid({60, -40, 20}, {59.3, -40.5, 20.6}, {58.9, -40.7, 20.9})}) {
    const auto fit = fitter.fit(truth);
    ASSERT_TRUE(fit.ok());
    const double lightness = truth.measurement->rows.front().lab.L;
    ASSERT_TRUE(fit->report.views_for_coat) << lightness;
    SearchSamples samples = samples_of(paint_weights(sketch_scene::basis(), fit->lobes), 1200, random), blind = samples;
    blind.view_deg.clear();
    const LobeSearch search(fitters, samples), control(fitters, blind);
    EXPECT_LE(worst_de00(search.find(search), truth), 0.05) << lightness;
    EXPECT_GT(worst_de00(control.find(control), truth), 0.3) << lightness << ": the control must fail";
  }
}

// A solid under one lamp, 25 to 110 deg from specular, from viewers at any angle. A lamp lights no mirror image, and
// gloss passes for flake there, so that the rows alone are asked for. The control is as above.
TEST(LobeSearch, UnderALampASolidIsFoundByItsViewsAsWell) {
  std::mt19937_64 random(22);
  std::uniform_real_distribution<double> unit(0, 1);
  const formats::Basis& basis = sketch_scene::basis();
  fit::FitOptions options;
  options.coat_index = brdf::kCoatIndex;
  const SearchFitters fitters(basis, brdf::kCoatIndex);
  const paint::Paint truth = solid({43, 58, 37}, {42.2, 59, 38.5}, {41.7, 59.4, 39});
  const auto fit = fit::PaintFitter(basis, options).fit(truth);
  ASSERT_TRUE(fit.ok());
  const PaintWeights weights = paint_weights(basis, fit->lobes);
  SearchSamples samples;
  samples.columns = search_columns(basis);
  samples.coat_index = brdf::kCoatIndex;
  for (int i = 0; i < 700; ++i) {
    const double aspecular_deg = 12 + 98 * unit(random), base = (0.3 + 0.7 * unit(random)) * kPi;
    samples.view_deg.push_back(75 * unit(random));
    samples.light.push_back(base * Vec3{1, 1, 1});
    for (const double exponent : basis.exponents) {
      const double power = lobe_at(aspecular_deg, exponent);
      samples.light.push_back(base * power * Vec3{1, 1, 1});
      samples.light.push_back(kPi * power * Vec3{1, 1, 1});
    }
    samples.light.emplace_back();
    samples.seen.push_back(
        shown_light(samples.columns_of(samples.size()), weights.mixed_at(samples.view_deg.back()), {}));
    samples.importance.push_back(1);
  }
  SearchSamples blind = samples;
  blind.view_deg.clear();
  const LobeSearch search(fitters, samples), control(fitters, blind);
  EXPECT_LE(worst_de00(search.find_plain(search), truth), 0.1);
  EXPECT_GT(worst_de00(control.find_plain(control), truth), 0.3) << "the control must fail";
}

}  // namespace
}  // namespace goniochrome::sketch::sketch_search_test
