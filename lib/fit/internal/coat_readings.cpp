#include "fit/internal/coat_readings.h"

#include <cmath>

namespace goniochrome::fit {

namespace {

// The largest difference of a channel, in reflectance factor.
double misfit(const FlakeModel& model, const FlakeFit& fit, const FlakeRow& row) {
  const color::Rgb apart = shown(model, fit.x, row.at) - row.value;
  return std::max({std::abs(apart.x), std::abs(apart.y), std::abs(apart.z)});
}

// The fit of a linear method. Rows that it holds are marked in `target`.
CoatedFit hold(FitMethod method, FlakeTarget& target, const FlakeModel& model, const Deadline& deadline) {
  CoatedFit out{flake_fit(method, target, model, deadline), {}};
  if (target.without_coat.empty()) return out;
  const auto is_met = [&](const FlakeFit& fit, const FlakeRow& row) { return misfit(model, fit, row) <= kMet; };
  std::vector<std::size_t> missed, met;
  for (std::size_t i = 0; i < target.rows.size(); ++i)
    if (!target.rows[i].inferred) (is_met(out.fit, target.rows[i]) ? met : missed).push_back(i);
  if (missed.empty()) return out;

  FlakeTarget bare = target;
  bare.rows = target.without_coat;
  const FlakeFit without = flake_fit(method, bare, model, deadline);
  std::erase_if(missed, [&](std::size_t i) { return !is_met(without, bare.rows[i]); });
  if (missed.empty()) return out;
  const FlakeFit free = out.fit;
  std::ranges::stable_sort(missed, {}, [&](std::size_t i) { return misfit(model, free, target.rows[i]); });
  for (const std::size_t i : met) target.rows[i].held = is_met(without, bare.rows[i]);
  for (const std::size_t i : missed) {
    target.rows[i].held = true;
    FlakeFit trial = flake_fit(method, target, model, deadline);
    if (std::ranges::all_of(target.rows, [&](const FlakeRow& row) { return !row.held || is_met(trial, row); })) {
      out.fit = std::move(trial);
    } else {
      target.rows[i].held = false;
      out.lost.push_back(target.rows[i].at);
    }
  }
  return out;
}

}  // namespace

CoatedFit fit_under_coat(FitMethod method, const FlakeTarget& target, const FlakeModel& model,
                         const Deadline& deadline) {
  FlakeTarget held = target;
  if (method != FitMethod::kDeltaE) return hold(method, held, model, deadline);
  std::vector<FlakePoint> lost;
  if (!target.without_coat.empty()) lost = hold(FitMethod::kL1, held, model, deadline).lost;
  return {flake_fit(method, held, model, deadline), std::move(lost)};
}

}  // namespace goniochrome::fit
