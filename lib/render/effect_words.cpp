#include "render/effect_words.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "base/text.h"
#include "render/plan/effect_list.h"

namespace goniochrome::render {

Result<EffectWords> words_of(const std::string& text) {
  static constexpr std::pair<const char*, Start> kStarts[] = {
      {"auto", Start::kAuto}, {"all", Start::kAll}, {"none", Start::kNone}};
  EffectWords words;
  for (const std::string_view piece : split(text, ',')) {
    const std::string word(trimmed(piece));
    const auto start = std::ranges::find(kStarts, word, [](const auto& known) { return known.first; });
    if (start != std::end(kStarts)) {
      words.start = start->second;
    } else if (word.size() > 1 && (word[0] == '+' || word[0] == '-')) {
      words.forced.emplace_back(word.substr(1), word[0] == '+');
    } else {
      return usage_error("--effects is \"{}\": write auto, all or none, then +NAME or -NAME, as in \"auto,-fresnel\"",
                         text);
    }
  }
  for (const auto& [name, on] : words.forced) {
    if (is_effect_name(name)) continue;
    std::string known;
    for (const std::string& group : effect_groups()) known += (known.empty() ? "" : ", ") + group;
    return usage_error("--effects names \"{}\": there are {}, and single lobes such as lobe-20 or gloss-900", name,
                       known);
  }
  return words;
}

Result<void> check_effects(const std::string& effects) {
  GONIO_ASSIGN(const EffectWords words, words_of(effects));
  return {};
}

bool leave_out_rays(const std::string& effects) {
  const auto words = words_of(effects);
  if (!words.ok()) return false;
  bool shadow = words->start != Start::kNone, named = false;
  for (const auto& [name, on] : words->forced) {
    if (name == "rays" || name == "shadow") shadow = on, named = true;
    if ((name == "self" || name == "bounce") && on && !named) shadow = true;
  }
  return !shadow;
}

namespace {

std::optional<bool> forced(const std::string& effects, const char* effect) {
  std::optional<bool> forced;
  const auto words = words_of(effects);
  if (!words.ok()) return forced;
  for (const auto& [name, on] : words->forced)
    if (name == effect) forced = on;
  return forced;
}

}  // namespace

std::optional<bool> floor_forced(const std::string& effects) {
  return forced(effects, "floor");
}

std::optional<bool> sums_forced(const std::string& effects) {
  return forced(effects, "sums");
}

}  // namespace goniochrome::render
