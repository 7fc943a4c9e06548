// Effects for many paints in turn: what one of them calls for is on for all.
#pragma once

#include "render/effects.h"

namespace goniochrome::render {

// The effects with everything that is on in `a` or in `b`, as finely as the finer of both. Color maps and tilted lobes
// stand for the light of all maps, so that with them no bright spots are cut out of the maps.
Effects united(const Effects& a, const Effects& b);

// True if `all` draws everything that `wanted` calls for.
bool covers(const Effects& all, const Effects& wanted);

// `effects` with a use for each exponent (finite) of the environment, so that no paint of its basis adds a lobe.
Effects with_all_lobes(const Effects& effects, const envmap::PrefilteredEnvironment& env);

}  // namespace goniochrome::render
