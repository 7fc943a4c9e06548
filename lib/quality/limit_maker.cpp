#include "quality/limit_maker.h"

#include <algorithm>
#include <cmath>

#include "math/statistics.h"

namespace goniochrome::quality {

namespace {

// Four decimals say all that an instrument tells; a limit is rounded away from the panels that it was made of.
constexpr double kSteps = 1e4;

std::vector<Limit> limits_around(const auto& spreads, double k) {
  std::vector<Limit> limits;
  for (const auto& spread : spreads) {
    Limit& limit = limits.emplace_back(Limit{spread.key.first, spread.key.second});
    limit.high = std::ceil((spread.mean + k * spread.deviation) * kSteps) / kSteps;
    if (!spread.one_sided) limit.low = std::floor((spread.mean - k * spread.deviation) * kSteps) / kSteps;
  }
  return limits;
}

}  // namespace

void LimitMaker::add(const Comparison& comparison, const CompareOptions& options) {
  ++panels_;
  for (const Deviation& deviation : deviations(comparison, options)) {
    Column& column =
        columns_.try_emplace({deviation.at, deviation.quantity}, Column{columns_.size(), {}}).first->second;
    if (std::isfinite(deviation.value)) column.values.push_back(deviation.value);
  }
  for (const Deviation& missing : comparison.missing)
    columns_.try_emplace({missing.at, missing.quantity}, Column{columns_.size(), {}});
}

std::vector<std::string> LimitMaker::dropped() const {
  const auto lacks = [&](const Key& key) {
    const auto found = columns_.find(key);
    return found != columns_.end() && found->second.values.size() < panels_;
  };
  std::vector<std::string> names;
  for (const auto& [key, column] : columns_) {
    const auto& [at, quantity] = key;
    if (!lacks(key) || (quantity != "dL" && lacks({at, "dL"}))) continue;
    names.push_back(at == kWhole ? quantity : quantity == "dL" ? at : fmt::format("{} at {}", quantity, at));
  }
  return names;
}

Result<std::vector<LimitMaker::Spread>> LimitMaker::spreads() const {
  if (panels_ < kFewestPanels)
    return input_error("limits are made from {} or more accepted panels, and there are {}", kFewestPanels, panels_);
  std::vector<Spread> spreads(columns_.size());
  for (const auto& [key, column] : columns_) {
    const double mean = column.values.empty() ? 0 : math::mean(column.values);
    double sum = 0;
    for (const double value : column.values) sum += (value - mean) * (value - mean);
    const double deviation = std::sqrt(sum / static_cast<double>(panels_ - 1));
    spreads[column.place] = {key, &column.values, mean, deviation, key.second.starts_with("dE_")};
  }
  std::erase_if(spreads, [&](const Spread& spread) { return spread.values->size() < panels_; });
  return spreads;
}

Result<std::vector<Limit>> LimitMaker::by_spread(double k) const {
  GONIO_ASSIGN(const auto spreads, this->spreads());
  return limits_around(spreads, k);
}

Result<std::vector<Limit>> LimitMaker::by_share(double share) const {
  GONIO_ASSIGN(const auto spreads, this->spreads());
  std::vector<double> needed(panels_, 0);  // the k by which each panel keeps its limits
  for (const Spread& spread : spreads)
    for (std::size_t i = 0; i < panels_ && spread.deviation > 0; ++i) {
      const double off = (*spread.values)[i] - spread.mean;
      needed[i] = std::max(needed[i], (spread.one_sided ? off : std::abs(off)) / spread.deviation);
    }
  const auto kept = static_cast<std::size_t>(std::ceil(share * static_cast<double>(panels_) - 1e-9));
  return limits_around(spreads, kept == 0 ? 0 : math::ranked(needed, kept - 1));
}

}  // namespace goniochrome::quality
