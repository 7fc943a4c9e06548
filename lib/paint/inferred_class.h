// The class of a paint that states none, as far as its readings tell it. goniochrome-paint(7), "CLASSES".
#pragma once

#include <optional>

#include "paint/metrics.h"
#include "paint/paint.h"

namespace goniochrome::paint {

// The class that follows from the colors at 15, 45 and 110 deg and from sparkle, or nothing where they decide none.
// `numbers` are the metrics of the paint.
std::optional<PaintClass> inferred_class(const Paint& paint, const PaintMetrics& numbers);

}  // namespace goniochrome::paint
