#include "color/spectrum.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

#include "color/illuminant.h"
#include "color/internal/cie_tables.h"

namespace goniochrome::color {

namespace {

constexpr std::size_t kFirstColumns = 3;

std::optional<std::size_t> illuminant_column(const std::string& name) {
  const auto found = std::ranges::find(kIlluminantNames, name);
  if (found == kIlluminantNames.end()) return std::nullopt;
  return static_cast<std::size_t>(found - kIlluminantNames.begin());
}

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

// A wavelength of the grid on which reflectance is interpolated, and the measured values that it is made of.
struct Node {
  double nm = 0;
  std::array<std::pair<std::size_t, double>, 4> shares = {};
  std::size_t count = 0;

  void add(std::size_t measured, double weight) { shares[count++] = {measured, weight}; }
};

// The measured wavelengths. Between those of 20 nm there are others in the middle, and beyond the outermost the grid
// goes on to the ends of the tables with their values (ASTM E308, 7.3 and 7.4).
std::vector<Node> nodes_of(std::span<const double> measured_nm) {
  std::vector<Node> nodes;
  for (std::size_t i = 0; i < measured_nm.size(); ++i) {
    nodes.push_back({measured_nm[i]});
    nodes.back().add(i, 1);
    if (i + 1 == measured_nm.size() || measured_nm[i + 1] - measured_nm[i] != 20) continue;
    const double middle = measured_nm[i] + 10;
    const Window window = window_around(measured_nm, middle);
    nodes.push_back({middle});
    for (std::size_t k = window.first; k < window.first + window.count; ++k)
      nodes.back().add(k, lagrange_weight(measured_nm, window, k, middle));
  }
  constexpr double kFinest_nm = 1;
  const std::size_t last = nodes.size() - 1;
  const double before = std::max(nodes[1].nm - nodes[0].nm, kFinest_nm),
               behind = std::max(nodes[last].nm - nodes[last - 1].nm, kFinest_nm);
  Node end = nodes.back();
  while (end.nm < kCieEnd_nm) end.nm += behind, nodes.push_back(end);
  std::vector<Node> front;
  Node begin = nodes.front();
  while (begin.nm > kCieStart_nm) begin.nm -= before, front.push_back(begin);
  nodes.insert(nodes.begin(), front.rbegin(), front.rend());
  return nodes;
}

using Triple = std::array<double, 3>;

// Illuminant times color-matching functions, `row` nm above the first wavelength of the tables.
Triple weighted_observer(std::size_t row, std::size_t illuminant, int observer_deg) {
  constexpr auto kStep = static_cast<std::size_t>(kCieStep_nm);
  const std::size_t i = std::min(row / kStep, kCieTable.size() - 2);
  const double between = static_cast<double>(row - kStep * i) / kCieStep_nm;
  const double light = std::lerp(illuminant_power(i, illuminant), illuminant_power(i + 1, illuminant), between);
  const Triple& observer = observer_deg == 2 ? kCieObservers[row].observer_2 : kCieObservers[row].observer_10;
  return {light * observer[0], light * observer[1], light * observer[2]};
}

}  // namespace

Result<double> illuminant_power(double nm, const std::string& name) {
  const auto column = illuminant_column(illuminant_named(name).value_or(name));
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
  for (std::size_t i = 0; i < kIlluminantNames.size(); ++i)
    all += (i == 0 ? "" : i + 1 < kIlluminantNames.size() ? ", " : " or ") + std::string(kIlluminantNames[i]);
  return all;
}

// X = k sum_l S(l) xbar(l) R(l) over every nanometer, k = 1 / sum_l S(l) ybar(l) (CIE 15:2004, 7.1). The 5 nm of the
// illuminants become 1 nm along straight lines. R between the wavelengths of the grid is the Lagrange cubic through
// four of them (ASTM E2022). All this is linear in R, so it folds into one weight per measured wavelength: those of
// ASTM E308 for 10 and 20 nm.
Result<SpectralColorimeter> SpectralColorimeter::make(std::span<const double> wavelengths_nm,
                                                      const ViewingCondition& stated) {
  const ViewingCondition condition = condition_of(stated.illuminant, stated.observer_deg);
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
  const std::vector<Node> nodes = nodes_of(wavelengths_nm);
  std::vector<double> grid_nm;
  for (const Node& node : nodes) grid_nm.push_back(node.nm);
  std::vector<Triple> weights(nodes.size());
  Triple total{}, held{};
  for (std::size_t row = 0; row < kCieObservers.size(); ++row) {
    const double nm = kCieStart_nm + static_cast<double>(row);
    const Triple power = weighted_observer(row, *illuminant, condition.observer_deg);
    const bool is_held = nm < wavelengths_nm.front() || nm > wavelengths_nm.back();
    const Window window = window_around(grid_nm, nm);
    for (std::size_t c = 0; c < 3; ++c) {
      total[c] += power[c];
      if (is_held) held[c] += power[c];
    }
    for (std::size_t k = window.first; k < window.first + window.count; ++k) {
      const double share = lagrange_weight(grid_nm, window, k, nm);
      for (std::size_t c = 0; c < 3; ++c) weights[k][c] += power[c] * share;
    }
  }
  for (std::size_t k = 0; k < nodes.size(); ++k)
    for (std::size_t s = 0; s < nodes[k].count; ++s)
      for (std::size_t c = 0; c < 3; ++c)
        result.weights_[nodes[k].shares[s].first][c] += nodes[k].shares[s].second * weights[k][c];
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
