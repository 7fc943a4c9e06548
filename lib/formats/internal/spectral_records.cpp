#include "formats/internal/spectral_records.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/text.h"
#include "paint/spectra.h"

namespace goniochrome::formats {

namespace {

// Instruments weigh their spectra by tables for their own bands, which changes the color by less.
constexpr double kAgrees_de00 = 0.5;

std::vector<double> wavelengths_of(const SpectralRecord& record) {
  if (!record.nm.empty()) return record.nm;
  std::vector<double> nm;
  for (std::size_t i = 0; i < record.values.size(); ++i)
    nm.push_back(record.first_nm + record.step_nm * static_cast<double>(i));
  return nm;
}

}  // namespace

Result<void> RecordImport::refuse(int line, const std::string& why) {
  const Error error = input_error("{}:{}: {}", file_, line, why);
  if (!options_.keep_going) return error;
  result_.skipped.push_back(error.message);
  return {};
}

Result<ImportedPaints> RecordImport::finish() {
  for (SpectralRecord& record : records_)
    if (!record.geometry) record.geometry = geometry_in_words(record.viewing, options_, remarks_);
  GONIO_TRY(find_units());
  const auto has_spectrum = [](const SpectralRecord& record) { return !record.values.empty(); };
  xyz_scale_.set(options_.scale, std::ranges::any_of(records_, has_spectrum));
  for (SpectralRecord& record : records_) make_paint(record);
  close_paint();
  xyz_scale_.finish(remarks_);
  result_.warnings = remarks_.lines();
  return std::move(result_);
}

// Records of one scale are judged together.
Result<void> RecordImport::find_units() {
  std::array<ScaleJudge, 3> judges;
  std::array<bool, 3> any{};
  for (const SpectralRecord& record : records_) {
    if (!record.geometry || record.values.empty()) continue;
    const auto scale = static_cast<std::size_t>(record.scale);
    any[scale] = true;
    std::optional<double> L;
    if (record.xyz) L = color::lab_from_xyz({1, record.xyz->Y / 100, 1}, {1, 1, 1}).L;
    judges[scale].add(record.name, *record.geometry, record.values, L);
  }
  for (const Scale scale : {Scale::kUnstated, Scale::kFactor, Scale::kPercent}) {
    const auto at = static_cast<std::size_t>(scale);
    if (!any[at]) continue;
    const auto unit = scale == Scale::kUnstated ? judges[at].unit(scale, options_.scale, remarks_)
                                                : judges[at].unit_of_format(format_, scale, options_.scale, remarks_);
    if (!unit.ok()) return input_error("{}: {}", file_, unit.error().message);
    units_[at] = *unit;
  }
  return {};
}

void RecordImport::make_paint(SpectralRecord& record) {
  if (!record.joins || !open_) {
    close_paint();
    open_.emplace();
    open_->paint.name = record.name.empty() ? fmt::format("sample {}", result_.paints.size() + 1) : record.name;
    open_->paint.code = record.code;
    open_->instrument = record.instrument, open_->date = record.date;
  }
  if (!record.geometry) return;
  const bool silent = record.condition.illuminant.empty() || record.condition.observer_deg == 0;
  const color::ViewingCondition condition = completed(record.condition, options_, {"D65", 10});
  if (silent && (options_.illuminant.empty() || options_.observer_deg == 0))
    remarks_.note(
        fmt::format("colors of spectra are those under {}/{}: paint-convert --illuminant and --observer choose others",
                    condition.illuminant, condition.observer_deg),
        "");
  for (double& value : record.values) value *= units_[static_cast<std::size_t>(record.scale)];
  const std::optional<color::Lab> lab = color_of(record, *record.geometry, condition);
  if (!lab) return;
  open_->readings.push_back({condition, {*record.geometry, *lab}});
  if (record.values.empty()) return;
  if (const auto kept = paint::spectrum_of(*record.geometry, wavelengths_of(record), record.values))
    open_->spectra.push_back(*kept);
  else
    remarks_.note("the points of spectra in unequal steps are not kept", open_->paint.name);
}

// The color of a record whose values are factors; nothing where it has none, which is remarked.
std::optional<color::Lab> RecordImport::color_of(const SpectralRecord& record, const paint::Geometry& geometry,
                                                 const color::ViewingCondition& condition) {
  const std::string place = fmt::format("{} at {}", shown(open_->paint.name), paint::geometry_name(geometry));
  const auto left_out = [&](const Error& error) {
    remarks_.note("readings were left out: " + error.message, place);
    return std::nullopt;
  };
  Result<color::Lab> lab = color::Lab{};
  std::optional<color::Lab> stated;
  if (record.xyz) {
    const auto white = color::white_point(condition);
    if (!white.ok() && record.values.empty()) return left_out(white.error());
    if (white.ok()) stated = color::lab_from_xyz(xyz_scale_.scaled(*record.xyz), *white);
  }
  if (record.values.empty()) {
    lab = *stated;
  } else {
    if (const auto checked = check_not_negative(record.values); !checked.ok()) return left_out(checked.error());
    if (record.nm.empty()) {
      lab = meter_.lab({geometry, record.first_nm, record.step_nm, record.values}, condition);
      if (lab.ok()) note_uncovered(meter_.held_share(), open_->paint.name, remarks_);
    } else {
      const auto meter = color::SpectralColorimeter::make(record.nm, condition);
      if (!meter.ok()) return left_out(meter.error());
      lab = meter->lab(record.values);
      note_uncovered(meter->held_share(), open_->paint.name, remarks_);
    }
  }
  if (!lab.ok()) return left_out(lab.error());
  if (const auto checked = check_lab(*lab); !checked.ok()) return left_out(checked.error());
  if (stated && !record.values.empty() && color::delta_e_2000(*lab, *stated) > kAgrees_de00)
    remarks_.note("the color of the spectrum was taken where the XYZ beside it are another", place);
  return *lab;
}

void RecordImport::close_paint() {
  if (!open_) return;
  const bool kept = open_->complete(options_, remarks_);
  open_->paint.name = names_.own(open_->paint.name, remarks_);
  if (kept) result_.paints.push_back(std::move(open_->paint));
  open_.reset();
}

Result<std::vector<double>> listed_values(std::string_view text, char separator) {
  std::vector<double> values;
  const auto words = split(text, separator);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string_view word = trimmed(words[i]);
    if (word.empty() && (separator == ' ' || i + 1 == words.size())) continue;
    const auto value = parse_number(word);
    if (!value)
      return input_error("value {} is \"{}\": write a number with a decimal point", values.size() + 1, shown(word));
    if (!(std::abs(*value) <= kLargestReflectance))
      return input_error("value {} is {}, which is no reflectance", values.size() + 1, shown(word));
    values.push_back(*value);
  }
  return values;
}

}  // namespace goniochrome::formats
