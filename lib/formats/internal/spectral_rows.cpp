#include "formats/internal/spectral_rows.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/text.h"

namespace goniochrome::formats {

namespace {

constexpr double kFirst_nm = 300, kLast_nm = 1100;

}  // namespace

std::optional<double> wavelength_in(std::string_view heading) {
  std::string text = lower(heading);
  std::erase_if(text, [](char c) { return std::string_view(" _[]()*").find(c) != std::string_view::npos; });
  for (const std::string_view before : {"spectralnm", "spectral", "spec", "nm", "r"})
    if (text.starts_with(before)) {
      text.erase(0, before.size());
      break;
    }
  if (text.ends_with("nm")) text.erase(text.size() - 2);
  const auto nm = parse_number(text);
  return nm && *nm >= kFirst_nm && *nm <= kLast_nm ? nm : std::nullopt;
}

Result<void> check_not_negative(const std::vector<double>& factors) {
  const double least = *std::ranges::min_element(factors);
  if (least > kSmallestFactor) return {};
  return input_error("a reflectance factor is {}: 0 is black, and noise goes no lower than {}", least, kSmallestFactor);
}

Result<void> check_steps(const std::vector<WavelengthColumn>& columns) {
  for (std::size_t i = 2; i < columns.size(); ++i) {
    const double step = columns[1].nm - columns[0].nm, expected = columns[0].nm + step * static_cast<double>(i);
    if (!(step > 0) || std::abs(columns[i].nm - expected) > 1e-6)
      return input_error("the column of {} nm stands where that of {} nm would: give wavelengths in equal steps",
                         columns[i].nm, expected);
  }
  return {};
}

Result<color::Lab> SpectralMeter::lab(const paint::SpectrumReading& spectrum, const color::ViewingCondition& condition,
                                      double unit) {
  if (!meter_ || spectrum.from_nm != from_nm_ || spectrum.step_nm != step_nm_ ||
      spectrum.factors.size() != factors_.size() || condition != condition_) {
    from_nm_ = spectrum.from_nm, step_nm_ = spectrum.step_nm, condition_ = condition;
    std::vector<double> nm;
    for (std::size_t i = 0; i < spectrum.factors.size(); ++i)
      nm.push_back(from_nm_ + step_nm_ * static_cast<double>(i));
    meter_.reset();
    GONIO_ASSIGN(meter_, color::SpectralColorimeter::make(nm, condition));
  }
  factors_ = spectrum.factors;
  for (double& factor : factors_) factor *= unit;
  return meter_->lab(factors_);
}

Result<void> SpectralMeter::make_factors(paint::SpectrumReading& spectrum, const color::ViewingCondition& condition,
                                         std::optional<double> L) {
  if (!L) {
    if (*std::ranges::max_element(spectrum.factors) > kLargestFactor)
      return input_error(
          "a reflectance is {}: write factors, where 1 is the perfect diffuser, or L*, a* and b* beside them",
          *std::ranges::max_element(spectrum.factors));
    return check_not_negative(spectrum.factors);
  }
  const auto as_factors = lab(spectrum, condition), as_percent = lab(spectrum, condition, 0.01);
  // Where the light is not known, nothing tells.
  if (as_factors.ok() && as_percent.ok() && std::abs(as_percent->L - *L) < std::abs(as_factors->L - *L))
    for (double& factor : spectrum.factors) factor /= 100;
  return check_not_negative(spectrum.factors);
}

}  // namespace goniochrome::formats
