// The words of --effects, and the effects of a plan that each of them switches. goniochrome-plan(7), "PLAN".
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"

namespace goniochrome::render {

enum class Start { kAuto, kAll, kNone };
// The words of --effects say where a plan starts, and which of its effects or groups are forced on or off.
struct EffectWords {
  Start start = Start::kAuto;
  std::vector<std::pair<std::string, bool>> forced = {};  // name, on
  bool operator==(const EffectWords&) const = default;

  // Returns true where the effect is forced on, false where off, and nothing where neither it nor its group is named.
  std::optional<bool> forced_on(const std::string& name, const std::string& group = "") const;
  // Returns true where no effect of rays is left on. Rays are then not traced.
  bool leave_out_rays() const;
};

// Reads auto, all or none and then +WORD and -WORD, separated by commas. Error (usage): a word that is none, with those
// that there are or with what to write in its place.
Result<EffectWords> words_of(const std::string& text);

// The words as a list for the man page, an item each.
std::string effect_items();

// The word that switches an effect of the plan, as satin does stretch.
std::string word_of_effect(const std::string& effect);

}  // namespace goniochrome::render
