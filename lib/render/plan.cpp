#include "render/plan.h"

#include <limits>

namespace goniochrome::render {

Decision decision_of(bool needed, bool on, bool forced) {
  if (!needed) return Decision::kNotInScene;
  if (forced) return on ? Decision::kForcedOn : Decision::kForcedOff;
  return on ? Decision::kDrawn : Decision::kDropped;
}

const char* spelled(Decision decision) {
  static constexpr const char* kWords[] = {"not in the scene", "drawn",      "dropped",
                                           "forced on",        "forced off", "first pass alone"};
  return kWords[static_cast<std::size_t>(decision)];
}

PlanItem unmeasured(const std::string& effect, const std::string& reason, bool needed) {
  constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
  return {effect, needed, reason, kNoValue, false, decision_of(needed, false, false), {}};
}

}  // namespace goniochrome::render
