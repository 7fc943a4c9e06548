#include "render/plan/effect_words.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "base/text.h"
#include "render/plan.h"
#include "render/plan/effect_list.h"

namespace goniochrome::render {

Result<Words> words_of(const std::string& text) {
  static constexpr std::pair<const char*, Start> kStarts[] = {
      {"auto", Start::kAuto}, {"all", Start::kAll}, {"none", Start::kNone}};
  Words words;
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

std::optional<bool> floor_forced(const std::string& effects) {
  std::optional<bool> forced;
  const auto words = words_of(effects);
  if (!words.ok()) return forced;
  for (const auto& [name, on] : words->forced)
    if (name == "floor") forced = on;
  return forced;
}

}  // namespace goniochrome::render
