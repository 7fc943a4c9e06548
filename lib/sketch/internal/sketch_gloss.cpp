#include "sketch/internal/sketch_gloss.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/gloss.h"
#include "math/least_squares.h"
#include "math/statistics.h"
#include "sketch/internal/sketch_lobes.h"

namespace goniochrome::sketch {

namespace {

constexpr double kNearSpecular_deg = 1.5;
constexpr double kBin_deg = 0.5;
constexpr double kLeastReading = 0.5;  // gloss units; less is noise

const std::vector<double>& highlight_exponents() {
  static const std::vector<double> all = {32, 64, 128, 256, 512, 1024, 2048, 4096};
  return all;
}

// Median excess and mean angle of each bin that has samples.
std::vector<HighlightSample> binned(const std::vector<HighlightSample>& samples) {
  std::vector<std::vector<HighlightSample>> bins;
  for (const HighlightSample& s : samples) {
    const auto bin = static_cast<std::size_t>(s.aspecular_deg / kBin_deg);
    if (bins.size() <= bin) bins.resize(bin + 1);
    bins[bin].push_back(s);
  }
  std::vector<HighlightSample> means;
  for (const auto& bin : bins) {
    if (bin.empty()) continue;
    HighlightSample m;
    std::vector<double> excess;
    for (const HighlightSample& s : bin) m.aspecular_deg += s.aspecular_deg, excess.push_back(s.excess);
    m.aspecular_deg /= static_cast<double>(bin.size());
    m.excess = math::median(excess);
    means.push_back(m);
  }
  return means;
}

}  // namespace

std::optional<double> highlight_gloss(const std::vector<HighlightSample>& samples) {
  const std::vector<HighlightSample> means = binned(samples);
  if (means.empty() || means.front().aspecular_deg > kNearSpecular_deg) return std::nullopt;
  const auto& exponents = highlight_exponents();
  math::Matrix m(static_cast<int>(means.size()), static_cast<int>(exponents.size()));
  std::vector<double> excess;
  for (int i = 0; i < m.rows; ++i) {
    for (int j = 0; j < m.columns; ++j) m(i, j) = lobe_at(means[i].aspecular_deg, exponents[j]);
    excess.push_back(means[i].excess);
  }
  const math::NonNegativeFit fit = math::nnls(m, excess);
  paint::LobeFit lobes;
  for (std::size_t j = 0; j < exponents.size(); ++j) {
    const double weight = fit.x[j] / kPi;  // what is seen is pi times the BRDF's gloss term
    lobes.lobes.push_back({exponents[j], {}, {weight, weight, weight}});
  }
  const brdf::GlossTable table(exponents);
  const double reading = brdf::gloss_units(table, **table.at(60), lobes);
  if (reading < kLeastReading) return std::nullopt;
  return std::min(reading, 100.0);
}

}  // namespace goniochrome::sketch
