// The words of --effects. goniochrome-theory(7), PLAN.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"

namespace goniochrome::render {

// The words of --effects: what is on to begin with, and the effects that are forced on or off.
enum class Start { kAuto, kAll, kNone };
struct EffectWords {
  Start start = Start::kAuto;
  std::vector<std::pair<std::string, bool>> forced;  // name, on
};

// Error (usage): a word that is none, or that names no effect, with the names that there are.
Result<EffectWords> words_of(const std::string& text);

// Error (usage): a word of --effects that names no effect, with the names that there are.
Result<void> check_effects(const std::string& effects);

// Returns true where these words leave no effect of rays on. Rays are then not traced. The words are checked.
bool leave_out_rays(const std::string& effects);
// Each returns true where the words force the effect on, false where off, and nothing where they do not name it.
std::optional<bool> floor_forced(const std::string& effects);
std::optional<bool> sums_forced(const std::string& effects);

}  // namespace goniochrome::render
