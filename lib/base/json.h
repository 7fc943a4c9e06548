// JSON for reports and headers of files. Keys stay in the order in which they are written, and a number that is not
// finite becomes null. Text is read and written here alone, because each unit that compiles a reader or a writer of
// JSON takes seconds for it.
#pragma once

#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "base/vec3.h"

namespace goniochrome {

using Json = nlohmann::ordered_json;

// `value` as JSON; null if it is not finite, because JSON has no NaN. Put a `status` beside it.
inline Json json_number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}

// A vector or a color is an array of three numbers.
inline void to_json(Json& json, const Vec3& v) {
  json = Json::array({v.x, v.y, v.z});
}
inline void from_json(const Json& json, Vec3& v) {
  for (int c = 0; c < 3; ++c) json.at(static_cast<std::size_t>(c)).get_to(v[c]);
}

// The value of a text; is_discarded() where the text is no JSON.
Json parse_json(std::string_view text);

// The text of a value in one line, or with this indentation; bytes that are not UTF-8 become U+FFFD.
std::string json_text(const Json& value, int indentation = -1);

}  // namespace goniochrome
