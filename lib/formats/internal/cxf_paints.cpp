#include "formats/internal/cxf_paints.h"

#include <algorithm>
#include <utility>

#include "base/text.h"
#include "color/spectrum.h"
#include "paint/spectra.h"

namespace goniochrome::formats {

namespace {

constexpr double kSmallestStep_nm = 1, kLargestStep_nm = 20;  // of the schema

// The wavelengths of a spectrum; none where it does not say them.
std::vector<double> wavelengths_of(const CxfColor& color, const CxfSpecification& specification) {
  if (!color.nm.empty()) return color.nm;
  const double first_nm = color.first_nm > 0 ? color.first_nm : specification.first_nm,
               step_nm = color.step_nm > 0 ? color.step_nm : specification.step_nm;
  std::vector<double> nm;
  if (first_nm > 0 && step_nm > 0)
    for (std::size_t i = 0; i < color.spectrum.size(); ++i) nm.push_back(first_nm + step_nm * static_cast<double>(i));
  return nm;
}

// True if its values are of reflected light at angles.
bool is_placed(const CxfSpecification& specification) {
  return !specification.angles.empty() && specification.unlike_reflectance.empty();
}

}  // namespace

void CxfResolver::add(CxfObject object) {
  if (object.joined.empty() || object.joined != joined_) {
    finish();
    open_.emplace().paint = std::move(object.paint);
    open_->date = object.date;
    if (!object.joined.empty()) open_->paint.name = object.joined;
  }
  joined_ = object.joined;
  unread_ = std::move(object.unread);
  using Kind = CxfColor::Kind;
  std::map<std::string, std::map<Kind, std::size_t>> counts, used;  // per specification
  for (const CxfColor& color : object.colors) ++counts[color.specification][color.kind];
  for (CxfColor& color : object.colors) {
    auto& count = counts[color.specification];
    const std::size_t number = used[color.specification][color.kind]++;
    const bool spectral = color.kind == Kind::kSpectrum;
    if (spectral && !is_sound(color)) continue;
    if (spectral) keep_spectrum(color, count[color.kind], number);
    // The file's own Lab is what it says, or else its XYZ.
    const bool stated =
        (color.kind != Kind::kLab && count.contains(Kind::kLab)) || (spectral && count.contains(Kind::kXyz));
    if (!stated) place(color, count[color.kind], number);
  }
}

void CxfResolver::finish() {
  if (!open_) return;
  paint::Paint& paint = open_->paint;
  if (open_->complete(options_, remarks_)) {
    paint.name = names_.own(paint.name, remarks_);
    paints_.push_back(std::move(paint));
  } else if (open_->readings.empty()) {
    remarks_.note("objects without a color at an angle were left out", paint.name);
    for (const std::string& kind : unread_) remarks_.note(fmt::format("values in {} are not read", kind), paint.name);
  }
  open_.reset();
}

// Checks a spectrum, which then has factors; else the error names it. Where its specification is missing or has no
// angles, place() tells it.
bool CxfResolver::is_sound(CxfColor& color) {
  const auto found = specifications_.find(color.specification);
  if (found == specifications_.end() || !is_placed(found->second)) return true;
  const CxfSpecification& specification = found->second;
  for (double& value : color.spectrum) value *= unit_;
  const std::vector<double> nm = wavelengths_of(color, specification);
  const double step_nm = color.step_nm > 0 ? color.step_nm : specification.step_nm;
  std::string fault;
  if (color.nm.empty() && step_nm < 0)
    fault = "spectra in a WavelengthRange of a negative Increment were left out";
  else if (nm.empty())
    fault = "spectra without a WavelengthRange were left out";
  else if (color.spectrum.size() < 2)
    fault = "spectra of a single wavelength were left out";
  else if (color.nm.empty() && (step_nm < kSmallestStep_nm || step_nm > kLargestStep_nm))
    fault = fmt::format("spectra in steps of {} nm were left out: CxF3 has steps of 1, 2, 5, 10 or 20 nm",
                        shortest(step_nm));
  else if (std::ranges::any_of(color.spectrum, [](double factor) { return factor > kLargestReflectance; }))
    fault = fmt::format("spectra with factors beyond {} were left out: 1 is the perfect diffuser", kLargestReflectance);
  else if (std::ranges::any_of(color.spectrum, [](double factor) { return factor <= kSmallestFactor; }))
    fault = fmt::format("spectra with factors of {} or less were left out: 0 is black", kSmallestFactor);
  if (!fault.empty()) remarks_.note(fault, open_->paint.name);
  return fault.empty();
}

// The k-th of n spectra under one specification, at the angles that place() gives it. A paint has spectra in equal
// steps; the color of any other is read, and its points are not kept.
void CxfResolver::keep_spectrum(const CxfColor& color, std::size_t n, std::size_t k) {
  const auto found = specifications_.find(color.specification);
  if (found == specifications_.end()) return;
  const std::vector<paint::Geometry>& angles = found->second.angles;
  if (!is_placed(found->second) || (n != 1 && n != angles.size())) return;
  const std::vector<double> nm = wavelengths_of(color, found->second);
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (n != 1 && i != k) continue;
    if (const auto kept = paint::spectrum_of(angles[i], nm, color.spectrum))
      open_->spectra.push_back(*kept);
    else
      remarks_.note("the points of spectra in unequal steps are not kept", open_->paint.name);
  }
}

// The k-th of n values under one specification: n angles take one each, a single value stands for all.
void CxfResolver::place(const CxfColor& color, std::size_t n, std::size_t k) {
  const auto found = specifications_.find(color.specification);
  if (found == specifications_.end()) {
    remarks_.note(
        fmt::format("color specification \"{}\" is not in the file: its values were left out", color.specification),
        open_->paint.name);
    return;
  }
  const CxfSpecification& specification = found->second;
  const std::vector<paint::Geometry>& angles = specification.angles;
  if (!specification.unlike_reflectance.empty()) {
    remarks_.note(fmt::format("values of {} are of no reflected light and were left out",
                              shown(specification.unlike_reflectance)),
                  open_->paint.name);
    return;
  }
  if (angles.empty()) {
    remarks_.note(
        fmt::format(
            "values of {} geometry have no aspecular angle and were left out: give paint-convert --viewing GEOMETRY, "
            "such as 45as45, to take them as that",
            specification.other.empty() ? "unstated" : specification.other),
        open_->paint.name);
    return;
  }
  if (n != 1 && n != angles.size()) {
    remarks_.note(fmt::format("{} values under a specification of {} angles were left out", n, angles.size()),
                  open_->paint.name);
    return;
  }
  if (n == 1 && angles.size() > 1) remarks_.note("one value stands for several angles", open_->paint.name);
  for (const std::string& remark : specification.remarks) remarks_.note(remark, "");
  const color::ViewingCondition condition = stated(specification);
  const std::optional<color::Lab> lab = lab_of(color, specification, condition);
  if (!lab) return;
  if (const auto checked = check_lab(*lab); !checked.ok()) {
    remarks_.note("colors were left out: " + checked.error().message, open_->paint.name);
    return;
  }
  for (std::size_t i = 0; i < angles.size(); ++i)
    if (n == 1 || i == k) open_->readings.push_back({condition, {angles[i], *lab}});
  if (open_->instrument.empty()) open_->instrument = specification.instrument;
  if (open_->serial.empty()) open_->serial = specification.serial;
}

color::ViewingCondition CxfResolver::stated(const CxfSpecification& specification) {
  const bool silent = specification.condition.illuminant.empty() || specification.condition.observer_deg == 0;
  const color::ViewingCondition condition = completed(specification.condition, options_, {"D65", 10});
  if (silent && (options_.illuminant.empty() || options_.observer_deg == 0))
    remarks_.note(fmt::format("illuminant or observer is not stated: taken as {}/{}; give paint-convert --illuminant "
                              "and --observer if not",
                              condition.illuminant, condition.observer_deg),
                  open_->paint.name);
  return condition;
}

// The color that the file states, or makes known otherwise; nothing where it is left out, which is remarked.
std::optional<color::Lab> CxfResolver::lab_of(const CxfColor& color, const CxfSpecification& specification,
                                              const color::ViewingCondition& condition) {
  if (color.kind == CxfColor::Kind::kLab) return color.lab;
  if (color.kind == CxfColor::Kind::kXyz) {
    const auto white = color::white_point(condition);
    if (white.ok()) return color::lab_from_xyz(xyz_scale_.scaled(color.xyz), *white);
    remarks_.note("XYZ values were left out: " + white.error().message, open_->paint.name);
    return std::nullopt;
  }
  const auto meter = color::SpectralColorimeter::make(wavelengths_of(color, specification), condition);
  if (!meter.ok()) {
    remarks_.note("spectra were left out: " + meter.error().message, open_->paint.name);
    return std::nullopt;
  }
  note_uncovered(meter->held_share(), open_->paint.name, remarks_);
  return meter->lab(color.spectrum);
}

}  // namespace goniochrome::formats
