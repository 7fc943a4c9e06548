#include "render/plan/sum_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "base/clock.h"

namespace goniochrome::render {

namespace {

// The same allowance for the choice of points as for other effects.
constexpr double kSafetyOfSums = 0.8;
// Sums are worth their time where they leave at most this part of what maps miss in the mean: else it is sharp lobes
// that miss it. Sharp lobes alone may decide the 95th percentile, which therefore need not fall; but since the
// tolerance is of it, it may grow to no more than this multiple.
constexpr double kMostLeft = 0.95, kMostGrown = 1.05;

bool worth_it(const Missed& by_maps, const Missed& by_sums) {
  return by_sums.mean <= kMostLeft * by_maps.mean && by_sums.p95 <= kMostGrown * by_maps.p95;
}

// The sums have what these effects draw, so that a picture without one of them would show it nevertheless.
bool lacks_what_sums_have(const Words& words) {
  return std::ranges::any_of(words.forced, [](const auto& word) {
    return !word.second && (word.first == "horizon" || word.first == "fresnel");
  });
}

// Of a frame: the sums that its cells lack.
double missing_sums(const OpenResidual& residual, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers) {
  double missing = 0;
  for (const auto& gbuffer : gbuffers) missing += static_cast<double>(residual.missing(*gbuffer));
  return missing / static_cast<double>(gbuffers.size());
}

}  // namespace

SumChoice no_sums(const std::string& reason) {
  SumChoice choice;
  choice.item.effect = kSumsName, choice.item.reason = reason;
  return choice;
}

SumChoice unmeasured_sums(const PlanRequest& request) {
  SumChoice choice = no_sums("what maps miss is measured where rays are traced, or where sums are named with a plus");
  PlanItem& item = choice.item;
  item.de00_p95 = item.cost_ms = std::numeric_limits<double>::quiet_NaN();
  if (sums_forced(request.effects) == std::optional(false)) item.needed = true, item.decision = Decision::kForcedOff;
  return choice;
}

Result<SumChoice> sum_choice(const OpenTruth& truth, const std::vector<color::Rgb>& planned, const Scene& scene,
                             const Effects& effects, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                             const PlanRequest& request, const Words& words, OpenResidual& residual) {
  const Missed by_maps = truth.error(planned);
  const std::optional<bool> forced = sums_forced(request.effects);
  SumChoice choice = no_sums(
      fmt::format("prefiltered maps miss the open light by dE00 {:.2g} (p95; mean {:.2g})", by_maps.p95, by_maps.mean));
  choice.open_de00 = by_maps.p95;
  PlanItem& item = choice.item;
  item.needed = true, item.de00_p95 = by_maps.p95, item.cost_ms = std::numeric_limits<double>::quiet_NaN();
  const bool off = forced == std::optional(false) || (words.start == Start::kNone && !forced);
  item.decision = forced == std::optional(false) ? Decision::kForcedOff : Decision::kDropped;
  const double most = kSafetyOfSums * request.tolerance_de00;
  if (off || (!forced && by_maps.p95 <= most)) return Result(std::move(choice));
  if (!OpenResidual::applies(effects) || lacks_what_sums_have(words)) {
    item.reason += "; sums have the effects horizon and fresnel, which are not drawn";
    return Result(std::move(choice));
  }
  GONIO_TRY(residual.load(scene, effects));
  const std::size_t before = residual.count();
  const Stopwatch clock;
  const std::vector<color::Rgb> more = residual.at(truth.points());
  const auto made = static_cast<double>(std::max<std::size_t>(1, residual.count() - before));
  const double sum_ms = 1000 * clock.elapsed_s() / made;
  const double sums = missing_sums(residual, gbuffers) + made;
  item.cost_ms = sum_ms * sums;
  item.de00_p95 = truth.change(planned, more);
  const Missed by_sums = truth.error(planned, more);
  item.reason += fmt::format(", and by {:.2g} (mean {:.2g}) with {:.0f} sums over the environment", by_sums.p95,
                             by_sums.mean, sums);
  item.on = forced || worth_it(by_maps, by_sums);
  item.decision = forced ? Decision::kForcedOn : item.on ? Decision::kDrawn : Decision::kDropped;
  if (item.on && !forced && request.budget_ms > 0 && item.cost_ms > request.budget_ms)
    item.on = false, item.decision = Decision::kOverBudget;
  if (item.on) choice.open_de00 = by_sums.p95;
  return Result(std::move(choice));
}

}  // namespace goniochrome::render
