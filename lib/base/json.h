// JSON for reports. Keys stay in the order in which they are written, and a number that is not finite becomes null.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>

namespace goniochrome {

using Json = nlohmann::ordered_json;

// `value` as JSON; null if it is not finite, because JSON has no NaN. Put a `status` beside it.
inline Json json_number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

}  // namespace goniochrome
