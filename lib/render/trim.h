// What parts of a vehicle wear that nobody paints: glass, rubber, seams, wheels and the underside.
#pragma once

#include <optional>

#include "mesh/mesh.h"
#include "paint/paint.h"

namespace goniochrome::render {

// The finish of a part by the words in its name or, where its name has none, in its material, whatever their case:
//   glass, window, windshield, windscreen      black, under a coat that mirrors
//   tire, tires, tyre, tyres, rubber, seam, seams, underbody, underside      matt black of 3 %
//   rim, rims, wheel, wheels, chrome, metal    gray of 20 %, under a coat that mirrors
// Words are separated by anything that is not a letter. Nothing where there is none of these words. It has no lobes but
// the mirror, and that only `with_mirror`, so that any prefiltered environment shows it.
std::optional<paint::LobeFit> trim_of(const mesh::MeshPart& part, bool with_mirror);

}  // namespace goniochrome::render
