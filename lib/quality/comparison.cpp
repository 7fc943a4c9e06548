#include "quality/comparison.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/text.h"
#include "library/index.h"
#include "paint/spectra.h"

namespace goniochrome::quality {

namespace {

constexpr std::array kLabDifferences = {
    std::pair{"dL", &color::LabDifference::dL}, std::pair{"da", &color::LabDifference::da},
    std::pair{"db", &color::LabDifference::db}, std::pair{"dC", &color::LabDifference::dC},
    std::pair{"dH", &color::LabDifference::dH}};

std::string light_name(const color::ViewingCondition& condition) {
  return fmt::format("{}/{}", condition.illuminant, condition.observer_deg);
}

std::string names_of_rows(const std::vector<paint::LabReading>& rows) {
  return joined(rows, ",", [](const paint::LabReading& row) { return paint::geometry_name(row.geometry); });
}

bool has_spectra(const paint::Paint& paint) {
  return paint.measurement && !paint.measurement->spectra.empty();
}

void add_missing(const std::string& at, const std::string& quantity, Comparison& comparison) {
  comparison.missing.push_back({at, quantity, std::numeric_limits<double>::quiet_NaN()});
}

// The mean of each difference, and the one of the largest size; NaN where a geometry has no value.
void summarize(Comparison& comparison, std::size_t formulas) {
  AngleDifference &mean = comparison.mean, &largest = comparison.largest;
  mean.by_formula.assign(formulas, 0), largest.by_formula.assign(formulas, 0);
  const auto count = static_cast<double>(comparison.angles.size());
  const auto take = [&](double value, double& sum, double& most) {
    sum += value / count;
    if (std::isnan(value) || std::abs(value) > std::abs(most)) most = value;
  };
  for (const AngleDifference& angle : comparison.angles) {
    for (const auto& [name, member] : kLabDifferences) take(angle.lab.*member, mean.lab.*member, largest.lab.*member);
    for (std::size_t i = 0; i < formulas; ++i) take(angle.by_formula[i], mean.by_formula[i], largest.by_formula[i]);
  }
}

// Indices of a sample that lacks 15, 45 or 110 degrees, which its standard has, would be those of a fitted curve.
void add_indices(const Subject& standard, const Subject& sample, Comparison& comparison) {
  using Source = paint::PaintMetrics::Source;
  const bool lacks = standard.metrics.source == Source::kRows && sample.metrics.source == Source::kFitted;
  std::vector<Deviation>& others = comparison.others;
  for (const char* name : {"flop_index", "chroma_index", "hue_shift_index", "hue_travel_deg"}) {
    const auto value = paint::find_metric(name)->value;
    const double difference = sample.metrics.*value - standard.metrics.*value;
    if (!std::isfinite(difference)) continue;
    if (lacks)
      add_missing(kWhole, name, comparison);
    else
      others.push_back({kWhole, name, difference});
  }
  for (const paint::GlossReading& gloss : sample.paint.gloss) {
    const auto other = std::ranges::find(standard.paint.gloss, gloss.angle_deg, &paint::GlossReading::angle_deg);
    if (other != standard.paint.gloss.end())
      others.push_back(
          {kWhole, fmt::format("gloss{}", shortest(gloss.angle_deg)), gloss.gloss_units - other->gloss_units});
  }
}

// Adds what a reading of the standard would tell and the sample has no reading for; mean and largest lack it too.
void add_missing_rows(const Subject& standard, const Subject& sample, const CompareOptions& options,
                      Comparison& comparison) {
  std::vector<std::string> places;
  for (const paint::LabReading& row : standard.rows)
    if (std::ranges::find(sample.rows, row.geometry, &paint::LabReading::geometry) == sample.rows.end())
      places.push_back(paint::geometry_name(row.geometry));
  if (places.empty()) return;
  comparison.remarks.push_back(fmt::format("the sample lacks geometries of its standard: {} of {} are compared",
                                           comparison.angles.size(), standard.rows.size()));
  for (const std::string& place : places)
    for (const auto& [name, member] : kLabDifferences) add_missing(place, name, comparison);
  places.insert(places.end(), {kMean, kLargest});
  for (const std::string& place : places)
    for (const color::DifferenceFormula& formula : options.formulas)
      add_missing(place, quantity_of(formula), comparison);
}

// The place of a texture: its geometry, by its name if it has one, or the whole paint.
std::string texture_place(const paint::TextureReading& texture) {
  if (const auto geometry = paint::parse_geometry(texture.geometry); geometry.ok())
    return paint::geometry_name(*geometry);
  return texture.geometry.empty() ? kWhole : texture.geometry;
}

void add_missing_textures(const paint::Measurement& standard, Comparison& comparison) {
  for (const paint::TextureReading& texture : standard.textures) {
    const std::string at = texture_place(texture), quantity = "texture:" + texture.quantity;
    if (std::ranges::none_of(comparison.others,
                             [&](const Deviation& d) { return d.at == at && d.quantity == quantity; }))
      add_missing(at, quantity, comparison);
  }
}

void add_textures(const paint::Measurement& standard, const paint::Measurement& sample, Comparison& comparison) {
  if (standard.textures.empty() || sample.textures.empty()) return;
  if (standard.instrument != sample.instrument) {
    comparison.remarks.push_back(fmt::format(
        "textures are not compared: those of the standard are on the scale of the instrument \"{}\", those of the "
        "sample on that of \"{}\"",
        standard.instrument, sample.instrument));
    return;
  }
  for (const paint::TextureReading& texture : sample.textures) {
    const auto other = std::ranges::find_if(standard.textures, [&](const paint::TextureReading& t) {
      return t.quantity == texture.quantity && t.geometry == texture.geometry;
    });
    if (other == standard.textures.end()) continue;
    if (other->version != texture.version) {
      comparison.remarks.push_back(
          fmt::format("{} is not compared: the standard has version \"{}\" of its scale, the sample \"{}\"",
                      texture.quantity, other->version, texture.version));
      continue;
    }
    comparison.others.push_back({texture_place(texture), "texture:" + texture.quantity, texture.value - other->value});
  }
}

Result<void> add_metamerism(const Subject& standard_subject, const paint::Paint& sample, const CompareOptions& options,
                            Comparison& comparison) {
  if (options.illuminants.empty()) return {};
  const paint::Paint& standard = standard_subject.paint;
  if (!has_spectra(standard) || !has_spectra(sample)) {
    comparison.remarks.emplace_back("metamerism is not told: it needs the spectra of standard and sample");
    return {};
  }
  for (const std::string& name : options.illuminants) {
    const color::ViewingCondition light = paint::condition_of(standard), test{name, light.observer_deg};
    GONIO_ASSIGN(const auto found,
                 paint::metamerism(*sample.measurement, *standard.measurement, light, test, options.formulas.front()));
    for (const paint::DifferenceAt& difference : found)
      comparison.others.push_back({paint::geometry_name(difference.geometry), "metamerism_" + name, difference.value});
    for (const paint::LabReading& row : standard_subject.rows)
      if (std::ranges::find(found, row.geometry, &paint::DifferenceAt::geometry) == found.end())
        add_missing(paint::geometry_name(row.geometry), "metamerism_" + name, comparison);
  }
  return {};
}

// Compares two paints under one light.
Result<Comparison> compare_in_one_light(const Subject& standard, const Subject& sample, const CompareOptions& options) {
  Comparison comparison{standard.paint.name, sample.paint.name, {}, {}, {}, {}, {}, {}};
  for (const paint::LabReading& row : sample.rows) {
    const auto other = std::ranges::find(standard.rows, row.geometry, &paint::LabReading::geometry);
    if (other == standard.rows.end()) continue;
    AngleDifference angle{row.geometry, other->lab, row.lab, color::lab_difference(other->lab, row.lab), {}};
    const double aspecular_deg = paint::aspecular_angle_deg(row.geometry);
    for (const color::DifferenceFormula& formula : options.formulas)
      angle.by_formula.push_back(color::difference(formula, other->lab, row.lab, aspecular_deg));
    comparison.angles.push_back(std::move(angle));
  }
  if (comparison.angles.empty())
    return input_error("they have no geometry in common: the standard was measured at {}, the sample at {}",
                       names_of_rows(standard.rows), names_of_rows(sample.rows));
  add_missing_rows(standard, sample, options, comparison);
  summarize(comparison, options.formulas.size());
  add_indices(standard, sample, comparison);
  if (standard.paint.measurement && sample.paint.measurement)
    add_textures(*standard.paint.measurement, *sample.paint.measurement, comparison);
  if (standard.paint.measurement) add_missing_textures(*standard.paint.measurement, comparison);
  GONIO_TRY(add_metamerism(standard, sample.paint, options, comparison));
  return Result(std::move(comparison));
}

}  // namespace

Result<Subject> subject_of(paint::Paint paint) {
  Subject subject{std::move(paint), {}, {}};
  subject.rows = library::comparable_rows(subject.paint);
  if (subject.rows.empty()) return input_error("it has no color: give it a measurement or an appearance");
  GONIO_ASSIGN(subject.metrics, paint::metrics(subject.paint, paint::CurveFit::kWhereNeeded));
  return Result(std::move(subject));
}

Result<Comparison> compare(const Subject& standard, const Subject& sample, const CompareOptions& options) {
  const color::ViewingCondition of_standard = paint::condition_of(standard.paint),
                                of_sample = paint::condition_of(sample.paint);
  if (of_standard == of_sample) return compare_in_one_light(standard, sample, options);
  const bool moves_sample = has_spectra(sample.paint);
  const Subject& moved = moves_sample ? sample : standard;
  if (!has_spectra(moved.paint))
    return input_error(
        "the standard is stated for {}, the sample for {}, and neither has spectra to convert: measure both in one "
        "light",
        light_name(of_standard), light_name(of_sample));
  GONIO_ASSIGN(paint::Paint lit, paint::in_light(moved.paint, moves_sample ? of_standard : of_sample));
  GONIO_ASSIGN(const Subject subject, subject_of(std::move(lit)));
  GONIO_ASSIGN(Comparison comparison, moves_sample ? compare_in_one_light(standard, subject, options)
                                                   : compare_in_one_light(subject, sample, options));
  comparison.remarks.push_back(fmt::format(
      "the {} was brought from {} to {} by its spectra", moves_sample ? "sample" : "standard",
      light_name(moves_sample ? of_sample : of_standard), light_name(moves_sample ? of_standard : of_sample)));
  return Result(std::move(comparison));
}

std::string quantity_of(const color::DifferenceFormula& formula) {
  return "dE_" + color::formula_name(formula);
}

std::vector<Deviation> deviations(const Comparison& comparison, const CompareOptions& options) {
  std::vector<std::string> names;
  for (const color::DifferenceFormula& formula : options.formulas) names.push_back(quantity_of(formula));
  std::vector<Deviation> all;
  for (const AngleDifference& angle : comparison.angles) {
    const std::string at = paint::geometry_name(angle.geometry);
    for (const auto& [name, member] : kLabDifferences) all.push_back({at, name, angle.lab.*member});
    for (std::size_t i = 0; i < names.size(); ++i) all.push_back({at, names[i], angle.by_formula[i]});
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    all.push_back({kMean, names[i], comparison.mean.by_formula[i]});
    all.push_back({kLargest, names[i], comparison.largest.by_formula[i]});
  }
  all.insert(all.end(), comparison.others.begin(), comparison.others.end());
  return all;
}

}  // namespace goniochrome::quality
