// How a design leaves a page, for formulation systems and for the other tools.
#pragma once

#include <string>

#include "base/result.h"
#include "paint/paint.h"

namespace goniochrome::studio {

// One paint as paint XML; `command` is the step in its history, none where it is empty.
Result<void> write_xml(const std::string& file, const paint::Paint& paint, const std::string& command);

// Its readings as a long table, or those of its curve at the export angles where it has none.
Result<void> write_csv(const std::string& file, paint::Paint paint);

}  // namespace goniochrome::studio
