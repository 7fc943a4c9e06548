// Paints as JSON, for a page in a browser. Numbers keep every bit, and all that a paint XML file holds of a paint
// stands in it, but for lobes: a page fits its paints itself.
#pragma once

#include "base/json.h"
#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::studio {

// L*, a*, b* as a list.
Json lab_json(const color::Lab& lab);

Json paint_json(const paint::Paint& paint);

// Error: what is missing or is of another kind. A wrong value of a paint, such as a travel of 5 degrees, is no error
// here: whoever uses the paint refuses it.
Result<paint::Paint> paint_of_json(const Json& json);

}  // namespace goniochrome::studio
