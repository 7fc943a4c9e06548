#include "color/spectrum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>

#include "color/internal/cie_tables.h"

namespace goniochrome::color {

namespace {

// The columns of both tables, side by side.
constexpr std::array kIlluminants = {"D65", "D50", "A", "C", "D55", "D75", "F2", "F7", "F11"};
constexpr std::size_t kFirstColumns = 3;

std::optional<std::size_t> illuminant_column(const std::string& name) {
  const auto found = std::ranges::find(kIlluminants, name);
  if (found == kIlluminants.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kIlluminants.begin());
}

// Fluorescent lamps have lines, so that straight lines between their values would spread them: each value stands for
// the light of its 5 nm, all of it at the wavelength of the table.
constexpr std::size_t kFirstLamp = 6;

double illuminant_power(std::size_t row, std::size_t column) {
  return column < kFirstColumns ? kCieTable[row].illuminants[column]
                                : kMoreIlluminantTable[row][column - kFirstColumns];
}

// The nodes of the interpolating cubic at `x`: two on either side, three in all at the ends of the list (CIE 167:2005).
struct Window {
  std::size_t first, count;
};
Window window_around(std::span<const double> nodes, double x) {
  const auto above = static_cast<std::size_t>(std::upper_bound(nodes.begin(), nodes.end(), x) - nodes.begin());
  const std::size_t interval = std::clamp<std::size_t>(above, 1, nodes.size() - 1) - 1;
  const std::size_t first = interval == 0 ? 0 : interval - 1;
  const std::size_t last = std::min(interval + 2, nodes.size() - 1);
  return {first, last - first + 1};
}

// The weight of node `k` of the window in the Lagrange polynomial at `x`.
double lagrange_weight(std::span<const double> nodes, const Window& window, std::size_t k, double x) {
  double weight = 1;
  for (std::size_t j = window.first; j < window.first + window.count; ++j)
    if (j != k) weight *= (x - nodes[j]) / (nodes[k] - nodes[j]);
  return weight;
}

using Triple = std::array<double, 3>;

// Illuminant times color-matching functions, `row` nm above the first wavelength of the tables.
Triple weighted_observer(std::size_t row, std::size_t illuminant, int observer_deg) {
  constexpr auto kStep = static_cast<std::size_t>(kCieStep_nm);
  const std::size_t i = std::min(row / kStep, kCieTable.size() - 2);
  const double between = static_cast<double>(row - kStep * i) / kCieStep_nm;
  if (illuminant >= kFirstLamp && between != 0 && between != 1) return {};
  const double light = std::lerp(illuminant_power(i, illuminant), illuminant_power(i + 1, illuminant), between);
  const Triple& observer = observer_deg == 2 ? kCieObservers[row].observer_2 : kCieObservers[row].observer_10;
  return {light * observer[0], light * observer[1], light * observer[2]};
}

}  // namespace

Result<double> illuminant_power(double nm, const std::string& name) {
  const auto column = illuminant_column(name);
  if (!column) return input_error("illuminant is \"{}\": {} are known", name, spectral_illuminants());
  const double at = (nm - kCieStart_nm) / kCieStep_nm;
  if (!(at >= 0 && at <= kCieRows - 1)) return input_error("the tables of illuminants end at 360 and 780 nm");
  const auto i = std::min(static_cast<std::size_t>(at), kCieTable.size() - 2);
  return std::lerp(illuminant_power(i, *column), illuminant_power(i + 1, *column), at - static_cast<double>(i));
}

double interpolated(std::span<const double> wavelengths_nm, std::span<const double> values, double nm) {
  const double inside_nm = std::clamp(nm, wavelengths_nm.front(), wavelengths_nm.back());
  const Window window = window_around(wavelengths_nm, inside_nm);
  double sum = 0;
  for (std::size_t k = window.first; k < window.first + window.count; ++k)
    sum += values[k] * lagrange_weight(wavelengths_nm, window, k, inside_nm);
  return sum;
}

std::string spectral_illuminants() {
  std::string all;
  for (std::size_t i = 0; i < kIlluminants.size(); ++i)
    all += (i == 0 ? "" : i + 1 < kIlluminants.size() ? ", " : " or ") + std::string(kIlluminants[i]);
  return all;
}

// X = k sum_l S(l) xbar(l) R(l) over every nanometer, k = 1 / sum_l S(l) ybar(l) (CIE 15:2004, 7.1). The 5 nm of the
// illuminants (but for lamps with lines) become 1 nm along straight lines, as their makers say. R between the measured
// wavelengths is the Lagrange cubic through four of them; beyond them the outermost value is held. All this is linear
// in R, so it folds into one weight per measured wavelength.
Result<SpectralColorimeter> SpectralColorimeter::make(std::span<const double> wavelengths_nm,
                                                      const ViewingCondition& condition) {
  const auto illuminant = illuminant_column(condition.illuminant);
  if (!illuminant)
    return input_error("illuminant is \"{}\": spectra are integrated under {}", condition.illuminant,
                       spectral_illuminants());
  if (condition.observer_deg != 2 && condition.observer_deg != 10)
    return input_error("observer is {} deg: the standard observers are 2 and 10 deg", condition.observer_deg);
  if (wavelengths_nm.size() < 2) return input_error("a spectrum needs at least two wavelengths");
  if (!std::is_sorted(wavelengths_nm.begin(), wavelengths_nm.end(), std::less_equal<>()))
    return input_error("wavelengths must ascend");

  SpectralColorimeter result;
  result.weights_.assign(wavelengths_nm.size(), {});
  Triple total{}, held{};
  for (std::size_t row = 0; row < kCieObservers.size(); ++row) {
    const double nm = kCieStart_nm + static_cast<double>(row);
    const Triple power = weighted_observer(row, *illuminant, condition.observer_deg);
    const double inside_nm = std::clamp(nm, wavelengths_nm.front(), wavelengths_nm.back());
    const Window window = window_around(wavelengths_nm, inside_nm);
    for (std::size_t c = 0; c < 3; ++c) {
      total[c] += power[c];
      if (inside_nm != nm) held[c] += power[c];
    }
    for (std::size_t k = window.first; k < window.first + window.count; ++k) {
      const double share = lagrange_weight(wavelengths_nm, window, k, inside_nm);
      for (std::size_t c = 0; c < 3; ++c) result.weights_[k][c] += power[c] * share;
    }
  }
  for (auto& weight : result.weights_)
    for (double& w : weight) w /= total[1];
  result.white_ = {total[0] / total[1], 1.0, total[2] / total[1]};
  for (std::size_t c = 0; c < 3; ++c) result.held_share_ = std::max(result.held_share_, held[c] / total[c]);
  if (result.held_share_ > kMostHeldShare)
    return input_error(
        "the spectrum goes from {} to {} nm and leaves out {:.0f} % of what the observer sees: measure 400 to 700 nm",
        wavelengths_nm.front(), wavelengths_nm.back(), 100 * result.held_share_);
  return result;
}

Xyz SpectralColorimeter::xyz(std::span<const double> reflectance) const {
  Xyz sum;
  for (std::size_t k = 0; k < weights_.size(); ++k) {
    sum.X += weights_[k][0] * reflectance[k];
    sum.Y += weights_[k][1] * reflectance[k];
    sum.Z += weights_[k][2] * reflectance[k];
  }
  return sum;
}

}  // namespace goniochrome::color
