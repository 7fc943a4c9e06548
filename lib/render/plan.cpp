#include "render/plan.h"

namespace goniochrome::render {

const char* spelled(Decision decision) {
  switch (decision) {
    case Decision::kNotInScene:
      return "not in the scene";
    case Decision::kDrawn:
      return "drawn";
    case Decision::kDropped:
      return "dropped";
    case Decision::kForcedOn:
      return "forced on";
    case Decision::kForcedOff:
      return "forced off";
    case Decision::kFirstPass:
      break;
  }
  return "first pass alone";
}

}  // namespace goniochrome::render
