#include "quality/average.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "math/statistics.h"
#include "paint/date.h"
#include "paint/spectra.h"

namespace goniochrome::quality {

namespace {

using Readings = std::vector<const paint::Paint*>;

const paint::LabReading* row_at(const paint::Paint& paint, const paint::Geometry& geometry) {
  const auto& rows = paint.measurement->rows;
  const auto found = std::ranges::find(rows, geometry, &paint::LabReading::geometry);
  return found == rows.end() ? nullptr : &*found;
}

const paint::SpectrumReading* spectrum_at(const paint::Paint& paint, const paint::Geometry& geometry) {
  const auto& spectra = paint.measurement->spectra;
  const auto found = std::ranges::find(spectra, geometry, &paint::SpectrumReading::geometry);
  return found == spectra.end() ? nullptr : &*found;
}

std::vector<color::Lab> colors_at(const Readings& readings, const paint::Geometry& geometry) {
  std::vector<color::Lab> colors;
  for (const paint::Paint* reading : readings)
    if (const paint::LabReading* row = row_at(*reading, geometry)) colors.push_back(row->lab);
  return colors;
}

// The geometries of all readings, in the order of first appearance.
std::vector<paint::Geometry> geometries_of(const Readings& readings) {
  std::vector<paint::Geometry> all;
  for (const paint::Paint* reading : readings)
    for (const paint::LabReading& row : reading->measurement->rows)
      if (std::ranges::find(all, row.geometry) == all.end()) all.push_back(row.geometry);
  return all;
}

color::Lab mean_of(const std::vector<color::Lab>& colors) {
  color::Lab sum;
  for (const color::Lab& lab : colors) sum.L += lab.L, sum.a += lab.a, sum.b += lab.b;
  const auto count = static_cast<double>(colors.size());
  return {sum.L / count, sum.a / count, sum.b / count};
}

double median_of(std::vector<double> values) {
  const std::size_t middle = values.size() / 2;
  const double upper = math::ranked(values, middle);
  return values.size() % 2 == 1 ? upper : (math::ranked(values, middle - 1) + upper) / 2;
}

color::Lab median_color(const std::vector<color::Lab>& colors) {
  const auto median = [&](double color::Lab::*channel) {
    std::vector<double> values;
    for (const color::Lab& lab : colors) values.push_back(lab.*channel);
    return median_of(std::move(values));
  };
  return {median(&color::Lab::L), median(&color::Lab::a), median(&color::Lab::b)};
}

std::vector<Outlier> outliers_of(const Readings& readings) {
  if (readings.size() < kFewestForOutliers) return {};
  std::vector<double> distances(readings.size(), 0), counts(readings.size(), 0);
  for (const paint::Geometry& geometry : geometries_of(readings)) {
    const color::Lab middle = median_color(colors_at(readings, geometry));
    for (std::size_t i = 0; i < readings.size(); ++i)
      if (const paint::LabReading* row = row_at(*readings[i], geometry))
        distances[i] += color::delta_e_76(row->lab, middle), ++counts[i];
  }
  for (std::size_t i = 0; i < readings.size(); ++i) distances[i] /= std::max(counts[i], 1.0);
  const double median = median_of(distances);
  std::vector<Outlier> outliers;
  for (std::size_t i = 0; i < readings.size(); ++i)
    if (distances[i] > kOutlierFactor * median && distances[i] > kOutlierFloor)
      outliers.push_back({i, distances[i], median});
  return outliers;
}

Scatter scatter_of(const Readings& readings, const paint::Geometry& geometry) {
  const std::vector<color::Lab> colors = colors_at(readings, geometry);
  const color::Lab mean = mean_of(colors);
  Scatter scatter{geometry, colors.size(), {}, 0};
  for (const color::Lab& lab : colors) {
    scatter.mean_distance += color::delta_e_76(lab, mean) / static_cast<double>(colors.size());
    for (const auto channel : {&color::Lab::L, &color::Lab::a, &color::Lab::b})
      scatter.deviation.*channel += (lab.*channel - mean.*channel) * (lab.*channel - mean.*channel);
  }
  for (const auto channel : {&color::Lab::L, &color::Lab::a, &color::Lab::b})
    scatter.deviation.*channel = std::sqrt(scatter.deviation.*channel / std::max(1.0, double(colors.size()) - 1));
  return scatter;
}

// The mean spectrum at a geometry, or nothing where a reading that has the geometry has no such spectrum.
std::optional<paint::SpectrumReading> mean_spectrum(const Readings& readings, const paint::Geometry& geometry) {
  std::optional<paint::SpectrumReading> mean;
  double count = 0;
  for (const paint::Paint* reading : readings) {
    if (!row_at(*reading, geometry)) continue;
    const paint::SpectrumReading* spectrum = spectrum_at(*reading, geometry);
    if (!spectrum) return std::nullopt;
    ++count;
    if (!mean) {
      mean = *spectrum;
      continue;
    }
    if (spectrum->from_nm != mean->from_nm || spectrum->step_nm != mean->step_nm ||
        spectrum->factors.size() != mean->factors.size())
      return std::nullopt;
    for (std::size_t i = 0; i < mean->factors.size(); ++i) mean->factors[i] += spectrum->factors[i];
  }
  if (mean)
    for (double& factor : mean->factors) factor /= count;
  return mean;
}

Result<void> average_rows(const Readings& readings, paint::Measurement& mean) {
  mean.rows.clear(), mean.spectra.clear();
  for (const paint::Geometry& geometry : geometries_of(readings)) {
    color::Lab lab = mean_of(colors_at(readings, geometry));
    if (auto spectrum = mean_spectrum(readings, geometry)) {
      GONIO_ASSIGN(lab, paint::lab_of(*spectrum, mean.condition));
      mean.spectra.push_back(std::move(*spectrum));
    }
    mean.rows.push_back({geometry, lab});
  }
  return {};
}

// The mean of what `same` finds for each item of the first reading; items that a reading lacks are left out.
template <class Item, class Items, class Same>
void average_items(const Readings& readings, std::vector<Item>& mean, double Item::*value, Items&& items, Same&& same) {
  std::erase_if(mean, [&](Item& item) {
    double sum = 0;
    for (const paint::Paint* reading : readings) {
      const auto& all = items(*reading);
      const auto found = std::ranges::find_if(all, [&](const Item& other) { return same(item, other); });
      if (found == all.end()) return true;
      sum += (*found).*value;
    }
    item.*value = sum / static_cast<double>(readings.size());
    return false;
  });
}

// All words of the readings that are not empty, each once.
template <class WordOf>
std::string all_words(const Readings& readings, WordOf&& word_of) {
  std::vector<std::string> words;
  for (const paint::Paint* reading : readings) {
    const std::string& word = word_of(*reading);
    if (!word.empty() && std::ranges::find(words, word) == words.end()) words.push_back(word);
  }
  return joined(words, ", ");
}

// The span of the dates, the codes, and the serials of all instruments.
void gather_origins(const Readings& readings, paint::Paint& mean) {
  for (const paint::Paint* reading : readings)
    mean.measurement->date = paint::span_of_dates(mean.measurement->date, reading->measurement->date);
  mean.code = all_words(readings, [](const paint::Paint& p) -> const std::string& { return p.code; });
  mean.measurement->serial =
      all_words(readings, [](const paint::Paint& p) -> const std::string& { return p.measurement->serial; });
}

Result<void> check_alike(const std::vector<paint::Paint>& readings) {
  for (const paint::Paint& reading : readings) {
    if (!reading.measurement || reading.measurement->rows.empty())
      return input_error("\"{}\" has no readings to average", reading.name);
    const paint::Measurement &first = *readings.front().measurement, &other = *reading.measurement;
    if (other.condition != first.condition)
      return input_error("readings for {}/{} and for {}/{} have no mean: convert them with --illuminant first",
                         first.condition.illuminant, first.condition.observer_deg, other.condition.illuminant,
                         other.condition.observer_deg);
    if (other.instrument != first.instrument)
      return input_error("readings of \"{}\" and of \"{}\" are of two instruments: average them apart",
                         first.instrument, other.instrument);
  }
  return {};
}

}  // namespace

Result<Average> average(const std::vector<paint::Paint>& readings, bool drop_outliers) {
  GONIO_TRY(check_alike(readings));
  Readings kept;
  for (const paint::Paint& reading : readings) kept.push_back(&reading);
  Average result{readings.front(), {}, outliers_of(kept), 0};
  if (drop_outliers)
    for (auto outlier = result.outliers.rbegin(); outlier != result.outliers.rend(); ++outlier)
      kept.erase(kept.begin() + static_cast<std::ptrdiff_t>(outlier->place));
  result.kept = kept.size();
  for (const paint::Geometry& geometry : geometries_of(kept)) result.scatter.push_back(scatter_of(kept, geometry));

  paint::Paint& mean = result.paint;
  if (std::ranges::any_of(kept, [&](const paint::Paint* p) { return p->paint_class != mean.paint_class; }))
    mean.paint_class = paint::PaintClass::kUnknown;
  if (readings.size() > 1) mean.appearance.reset(), mean.lobes.reset(), mean.color_map.reset();
  mean.measurement->date.clear();
  gather_origins(kept, mean);
  GONIO_TRY(average_rows(kept, *mean.measurement));
  average_items(
      kept, mean.gloss, &paint::GlossReading::gloss_units, [](const paint::Paint& p) -> auto& { return p.gloss; },
      [](const auto& x, const auto& y) { return x.angle_deg == y.angle_deg; });
  average_items(
      kept, mean.measurement->textures, &paint::TextureReading::value,
      [](const paint::Paint& p) -> auto& { return p.measurement->textures; },
      [](const auto& x, const auto& y) {
        return x.quantity == y.quantity && x.geometry == y.geometry && x.version == y.version;
      });
  return Result(std::move(result));
}

std::string base_name(const std::string& name) {
  const std::size_t open = name.rfind(" (");
  if (open == std::string::npos || open == 0 || !name.ends_with(')')) return name;
  const std::string inside = name.substr(open + 2, name.size() - open - 3);
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const bool number = !inside.empty() && std::ranges::all_of(inside, is_digit);
  const bool date = inside.size() >= 10 && inside[4] == '-' && inside[7] == '-' && is_digit(inside[0]) &&
                    is_digit(inside[3]) && is_digit(inside[5]) && is_digit(inside[8]);
  return number || date ? base_name(name.substr(0, open)) : name;
}

}  // namespace goniochrome::quality
