// Values that a command line states outright: readings, and a whole paint from nothing.
#pragma once

#include <vector>

#include "base/result.h"
#include "tool.h"

namespace goniochrome::tool {

// The readings of --set, in their order. Error (usage): a text that is not GEOMETRY=L,A,B, an L* below 0, or a geometry
// that is set twice.
Result<std::vector<paint::LabReading>> stated_readings(const std::vector<std::string>& texts);

// The paint of --new before its moves: its name, and its face, flop and travel if a face is stated. A paint without a
// flop is solid. Error (usage): neither a face nor a reading is stated, or a flop without a travel.
Result<paint::Paint> stated_paint(const Options& options, const paint::Edit& edit);

}  // namespace goniochrome::tool
