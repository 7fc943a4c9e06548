// The lobes that stand for rough coats where prefiltered maps are looked up. goniochrome-coats(7), "What maps draw".
#pragma once

#include <memory>
#include <vector>

#include "render/effects.h"

namespace goniochrome::render {

// The set that the rough coat of a part is drawn with by these effects, in the place of its gloss lobes but beside its
// mirror; null where they draw none. It has the exponents of those gloss lobes. Sets are kept, since making one takes
// some 25 ms.
std::shared_ptr<const paint::TiltedLobes> drawn_stretch(const Scene& scene, const Effects& effects, std::size_t part);

// Flags of the parts that have such a set.
std::vector<bool> stretched_parts(const Scene& scene, const Effects& effects);

}  // namespace goniochrome::render
