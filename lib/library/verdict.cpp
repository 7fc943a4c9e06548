#include "library/verdict.h"

#include <cmath>

#include "base/angles.h"
#include "math/elementary.h"
#include "paint/metrics.h"

namespace goniochrome::library {

double signed_hue_shift(double hue_shift_index, double hue_travel_deg) {
  return std::copysign(hue_shift_index, math::sin(hue_travel_deg * kDegree));
}

Verdict verdict(const paint::Paint& query, const LibraryIndex& index, std::size_t match, double mean_de,
                const VerdictLimits& limits) {
  Verdict result;
  result.hue_shift = result.hue_travel_deg = paint::PaintMetrics::kNone;
  result.outside = mean_de > limits.outside;
  if (const auto numbers = paint::metrics(query, paint::CurveFit::kWhereNeeded); numbers.ok()) {
    result.hue_travel_deg = numbers->hue_travel_deg;
    result.hue_shift = signed_hue_shift(numbers->hue_shift_index, numbers->hue_travel_deg);
  }
  const auto of_match = [&](const char* name) { return index.metric(match, *paint::find_metric(name)); };
  result.matched_hue_travel_deg = of_match("hue_travel_deg");
  result.matched_hue_shift = signed_hue_shift(of_match("hue_shift_index"), result.matched_hue_travel_deg);
  result.off_radial = std::abs(result.hue_shift - result.matched_hue_shift) > limits.off_radial;
  const auto turn = [](double travel_deg) { return std::isnan(travel_deg) ? 0 : travel_deg; };
  result.turns = std::abs(turn(result.hue_travel_deg) - turn(result.matched_hue_travel_deg)) > limits.hue_travel_deg;
  return result;
}

}  // namespace goniochrome::library
