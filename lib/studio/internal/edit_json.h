// The moves of paint-edit as JSON: each member has the name of an option, without dashes.
#pragma once

#include "base/json.h"
#include "base/result.h"
#include "paint/edit.h"

namespace goniochrome::studio {

// Error: a member that is no move, or a value of another kind or out of the domain of the option.
Result<paint::Edit> edit_of_json(const Json& json);

// The shifts of face, flop, travel and gloss of an edit, of which variations consist.
Json shifts_json(const paint::Edit& edit);

}  // namespace goniochrome::studio
