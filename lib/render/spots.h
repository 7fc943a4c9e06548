// Bright spots of an environment are drawn as lamps. goniochrome-rendering(7), "Bright spots".
#pragma once

#include "envmap/bright_spots.h"
#include "render/scene.h"

namespace goniochrome::render {

// The spot as a lamp. Mirrors do not show it, because they show the environment itself.
Light light_of(const envmap::Spot& spot);

}  // namespace goniochrome::render
