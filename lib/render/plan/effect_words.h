// What --effects says. goniochrome-theory(7), PLAN.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/result.h"

namespace goniochrome::render {

// The words of --effects: what is on to begin with, and the effects that are forced on or off.
enum class Start { kAuto, kAll, kNone };
struct Words {
  Start start = Start::kAuto;
  std::vector<std::pair<std::string, bool>> forced;  // name, on
};

// Error (usage): a word that is none, or that names no effect, with the names that there are.
Result<Words> words_of(const std::string& text);

}  // namespace goniochrome::render
