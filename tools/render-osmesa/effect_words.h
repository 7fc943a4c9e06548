// The words of --effects, and the effects of a plan that each of them stands for.
#pragma once

#include <string>

#include "base/result.h"

namespace goniochrome::tool {

// The words as a list for the man page, an item each.
std::string effect_items();

// --effects in the names of a plan's effects, as render::check_effects() takes them. Error (usage): a word that is
// none, with those that there are or with what to write in its place.
Result<std::string> effects_of_words(const std::string& text);

// The word that switches an effect of the plan, as satin does stretch.
std::string word_of_effect(const std::string& effect);

}  // namespace goniochrome::tool
