#include "color/reflection_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "base/file.h"
#include "base/json.h"
#include "base/paths.h"
#include "base/text.h"
#include "color/internal/reflection_space.h"

namespace goniochrome::color {

namespace {

// A table, and the primaries of the colors that it multiplies; none: the working space.
struct Table {
  ReflectionOperator op;
  std::optional<Primaries> primaries = {};
};

std::optional<Table> named_table(std::string_view name) {
  if (name == "fitted") return Table{fitted_operator()};
  if (name == "plain" || name == "none") return Table{component_wise()};
  if (name == "iso") return Table{iso_rgb_operator()};
  if (name == "iso709") return Table{iso_rgb_operator(), kRec709};
  if (name == "estimated" || name == "working" || name == "rec2020") return Table{working_space_operator()};
  return std::nullopt;
}

// In Rec.2020 the estimated table keeps more than 1 of red; the same product has shares of all three in Rec.709.
bool has_shares_in_rec709(std::string_view name) {
  return name == "estimated" || name == "working" || name == "rec2020";
}

// The shares at the end of a text, one or three numbers from 0 to 1 after commas, which are cut off.
std::optional<Rgb> cut_shares(std::string& text) {
  const auto words = split(text, ',');
  for (const std::size_t count : {std::size_t{3}, std::size_t{1}}) {
    if (words.size() <= count) continue;
    Rgb shares;
    bool all = true;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto share = parse_number(trimmed(words[words.size() - count + (count == 3 ? i : 0)]));
      all = all && share && *share >= 0 && *share <= 1;
      if (all) shares[static_cast<int>(i)] = *share;
    }
    if (!all) continue;
    std::string rest(words[0]);
    for (std::size_t i = 1; i < words.size() - count; ++i) rest += "," + std::string(words[i]);
    text = rest;
    return shares;
  }
  return std::nullopt;
}

bool is_path(const std::string& text) {
  return text.ends_with(".json") || text.find('/') != std::string::npos || is_there(text);
}

Result<ReflectionOperator> with_shares(const ReflectionOperator& op, const Rgb& shares) {
  constexpr const char* kChannels[] = {"red", "green", "blue"};
  for (int c = 0; c < 3; ++c) {
    const double own = op.k[static_cast<std::size_t>(c)][static_cast<std::size_t>(c)][static_cast<std::size_t>(c)];
    if (shares[c] > 0 && own > 1 - 1e-9)
      return input_error(
          "{} of this operator keeps {:.3f} of itself and takes nothing from the other channels that could become {}: "
          "write 0 for it, or name fitted, iso, iso709 or estimated",
          kChannels[c], own, shares[c]);
  }
  return with_transfer(op, shares);
}

Result<Table> read_table(const std::string& path);

Result<ReflectionOperator> on_working_space(const Table& table) {
  if (!table.primaries) return table.op;
  return in_working_space(table.op, *table.primaries);
}

}  // namespace

std::string operator_sentences() {
  return "fitted is a bilinear product that is fitted to published spectra and keeps red paint red in cyan light; it "
         "errs less than plain on all kinds of spectra that were held out but one; see goniochrome-color(7), \"COLORED "
         "LIGHT\". plain multiplies each channel by itself. iso is the published table for camera sensors, applied to "
         "Rec.2020 values; it was the default before. iso709 is the same table in the primaries of Rec.709, for which "
         "it was made. estimated comes from color-matching functions. none is another name for plain, and working and "
         "rec2020 are other names for estimated. A JSON file holds a table, and may name the primaries that it is for; "
         "goniochrome-paint(5) describes it. A number from 0 to 1 after a comma says how much each channel takes from "
         "the others, and three numbers say it for red, green and blue, in the primaries of the table; estimated has "
         "them in those of Rec.709. A channel that keeps all of itself, as each of plain, takes no such number but 0.";
}

Result<ReflectionOperator> chosen_operator(const std::string& text, const std::optional<Rgb>& shares) {
  std::string name(trimmed(text));
  const std::optional<Rgb> written = cut_shares(name);
  std::optional<Table> table = named_table(name);
  if (!table) {
    if (!is_path(name))
      return usage_error(
          "--operator is \"{}\": write fitted, plain, iso, iso709, estimated or a JSON file, and if wanted after a "
          "comma a share from 0 to 1, or three",
          text);
    GONIO_ASSIGN(table, read_table(name));
  }
  if (const std::optional<Rgb> wanted = shares ? shares : written) {
    if (has_shares_in_rec709(name)) {
      GONIO_ASSIGN(table->op, in_primaries(table->op, kRec709));
      table->primaries = kRec709;
    }
    auto shared = with_shares(table->op, *wanted);
    if (!shared.ok() && !shares) return usage_error("--operator is \"{}\": {}", text, shared.error().message);
    GONIO_ASSIGN(table->op, shared);
  }
  auto result = on_working_space(*table);
  if (!result.ok()) return input_error("{}: {}", name, result.error().message);
  return result;
}

std::string reflection_json(const ReflectionOperator& op, const Primaries* primaries) {
  Json json{{"k", op.k}};
  if (primaries) json["primaries"] = primaries->rgb, json["white"] = primaries->white;
  return json_text(json) + "\n";
}

namespace {

bool is_list(const Json& list, std::size_t count) {
  if (!list.is_array() || list.size() != count) return false;
  for (const Json& value : list)
    if (!value.is_number()) return false;
  return true;
}

bool is_table(const Json& k) {
  if (!k.is_array() || k.size() != 3) return false;
  for (const Json& rows : k) {
    if (!rows.is_array() || rows.size() != 3) return false;
    for (const Json& row : rows)
      if (!is_list(row, 3)) return false;
  }
  return true;
}

// The primaries that a file names, if it names any.
Result<std::optional<Primaries>> source_primaries(const Json& json, const std::string& path) {
  if (!json.contains("primaries")) {
    if (json.contains("white")) return input_error("{}: \"white\" says nothing without \"primaries\": add them", path);
    return std::optional<Primaries>();
  }
  const Json& named = json["primaries"];
  Primaries primaries = kRec2020;
  if (named == "rec709") {
    primaries = kRec709;
  } else if (named != "rec2020") {
    const bool pairs =
        named.is_array() && named.size() == 3 && is_list(named[0], 2) && is_list(named[1], 2) && is_list(named[2], 2);
    if (!pairs)
      return input_error(
          "{}: \"primaries\" are {}: give \"rec709\", \"rec2020\" or x and y of red, green and blue, such as "
          "[[0.64,0.33],[0.3,0.6],[0.15,0.06]]",
          path, json_text(named));
    named.get_to(primaries.rgb);
  }
  if (json.contains("white")) {
    if (!is_list(json["white"], 2))
      return input_error("{}: \"white\" is {}: give x and y, such as [0.3127,0.329]", path, json_text(json["white"]));
    json["white"].get_to(primaries.white);
  }
  return std::optional(primaries);
}

Result<void> check_coherent(const ReflectionOperator& op, const std::string& path) {
  constexpr double kTolerance = 1e-6;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t d = 0; d < 3; ++d) {
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
  return {};
}

Result<Table> read_table(const std::string& path) {
  GONIO_ASSIGN(const std::string text, file_content(path));
  const Json json = parse_json(text);
  if (!json.is_object() || !json.contains("k") || !is_table(json["k"]))
    return input_error("{}: a reflection operator is a JSON object with \"k\", three tables of 3 x 3 numbers", path);
  for (const auto& entry : json.items()) {
    constexpr std::string_view kKnown[] = {"k", "primaries", "white", "name", "comment"};
    if (std::ranges::find(kKnown, entry.key()) == std::end(kKnown))
      return input_error(
          "{}: \"{}\" is not known: an operator has \"k\", \"primaries\", \"white\", \"name\" and \"comment\"", path,
          shown(entry.key()));
  }
  ReflectionOperator op;
  json["k"].get_to(op.k);
  GONIO_TRY(check_coherent(op, path));
  GONIO_ASSIGN(const std::optional<Primaries> primaries, source_primaries(json, path));
  return Table{nearest_coherent(op), primaries};
}

}  // namespace

Result<ReflectionOperator> read_reflection_operator(const std::string& path) {
  GONIO_ASSIGN(const Table table, read_table(path));
  auto result = on_working_space(table);
  if (!result.ok()) return input_error("{}: {}", path, result.error().message);
  return result;
}

}  // namespace goniochrome::color
