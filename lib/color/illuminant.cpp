#include "color/illuminant.h"

#include <algorithm>
#include <array>
#include <utility>

#include "base/text.h"
#include "color/internal/cie_tables.h"

namespace goniochrome::color {

namespace {

// Names of trade for the CIE's. F2 is cool white fluorescent, F10 to F12 are three lamps of narrow bands: TL85, TL84
// and TL83.
constexpr std::array<std::pair<std::string_view, std::string_view>, 11> kOtherNames = {{
    {"CWF", "F2"},
    {"CWF2", "F2"},
    {"F2CWF", "F2"},
    {"TL84", "F11"},
    {"F11TL84", "F11"},
    {"TL83", "F12"},
    {"U30", "F12"},
    {"UL30", "F12"},
    {"INC", "A"},
    {"INCA", "A"},
    {"INCANDESCENT", "A"},
}};

// Files state colors under these too.
constexpr std::array<std::string_view, 3> kWithoutTable = {"D60", "D93", "E"};

// In capitals, and without what does not tell names apart.
std::string plain_name(std::string_view text) {
  std::string name = upper(trimmed(text));
  std::erase_if(name, [](char c) { return c == ' ' || c == '-' || c == '_'; });
  if (name.starts_with("FL") && name.size() > 2 && name[2] >= '0' && name[2] <= '9') name.erase(1, 1);
  return name;
}

}  // namespace

std::optional<std::string> illuminant_named(std::string_view text) {
  for (const char* known : kIlluminantNames)
    if (text == known) return known;
  std::string name = plain_name(text);
  const auto other = std::ranges::find(kOtherNames, name, &std::pair<std::string_view, std::string_view>::first);
  if (other != kOtherNames.end()) name = other->second;
  for (const char* known : kIlluminantNames)
    if (plain_name(known) == name) return known;
  return std::nullopt;
}

int observer_in(std::string_view text) {
  text = trimmed(text);
  const auto digits = text.substr(0, std::min(text.find_first_not_of("0123456789"), text.size()));
  return digits == "2" || digits == "1931" ? 2 : digits == "10" || digits == "1964" ? 10 : 0;
}

std::optional<ViewingCondition> condition_in(std::string_view text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  const auto illuminant = illuminant_named(text.substr(0, slash));
  if (!illuminant) return std::nullopt;
  if (slash == text.size()) return ViewingCondition{*illuminant, 0};
  const int observer = observer_in(text.substr(slash + 1));
  return observer == 0 ? std::nullopt : std::optional(ViewingCondition{*illuminant, observer});
}

ViewingCondition condition_among(std::string_view text) {
  std::string word;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ' ';
    const bool is_part = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-';
    if (is_part) {
      word += c;
      continue;
    }
    std::optional<std::string> named = illuminant_named(word);
    if (!named && std::ranges::find(kWithoutTable, upper(word)) != kWithoutTable.end()) named = upper(word);
    if (named) return {*named, c == '/' ? observer_in(text.substr(i + 1)) : 0};
    word.clear();
  }
  return {"", 0};
}

ViewingCondition condition_of(std::string_view name, int observer_deg) {
  ViewingCondition condition = condition_in(name).value_or(ViewingCondition{std::string(name), 0});
  if (condition.observer_deg == 0) condition.observer_deg = observer_deg;
  return condition;
}

}  // namespace goniochrome::color
