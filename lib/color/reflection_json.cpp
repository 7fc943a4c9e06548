#include "color/reflection_json.h"

#include <cmath>

#include "base/file.h"
#include "base/json.h"

namespace goniochrome::color {

std::string reflection_json(const ReflectionOperator& op) {
  return Json{{"k", op.k}}.dump() + "\n";
}

namespace {

bool is_table(const Json& k) {
  if (!k.is_array() || k.size() != 3) return false;
  for (const Json& rows : k) {
    if (!rows.is_array() || rows.size() != 3) return false;
    for (const Json& row : rows) {
      if (!row.is_array() || row.size() != 3) return false;
      for (const Json& value : row)
        if (!value.is_number()) return false;
    }
  }
  return true;
}

}  // namespace

Result<ReflectionOperator> read_reflection_operator(const std::string& path) {
  GONIO_ASSIGN(const std::string text, file_content(path));
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("k") || !is_table(json["k"]))
    return input_error("{}: a reflection operator is a JSON object with \"k\", three tables of 3 x 3 numbers", path);
  ReflectionOperator op;
  json["k"].get_to(op.k);
  constexpr double kTolerance = 1e-6;
  for (int c = 0; c < 3; ++c) {
    for (int d = 0; d < 3; ++d) {
      const auto& row = op.k[c][d];
      const double sum = row[0] + row[1] + row[2];
      const bool symmetric =
          std::abs(row[0] - op.k[c][0][d]) + std::abs(row[1] - op.k[c][1][d]) + std::abs(row[2] - op.k[c][2][d]) <=
          kTolerance;
      if (!symmetric || !(std::abs(sum - (c == d)) <= kTolerance))
        return input_error("{}: k[{}][{}] is {}: each table is symmetric, and the row sums to {}, here {}", path, c, d,
                           symmetric ? "not coherent" : "not symmetric", c == d ? 1 : 0, sum);
    }
  }
  return nearest_coherent(op);
}

}  // namespace goniochrome::color
