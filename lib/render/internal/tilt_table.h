// The look-ups of tilted lobes, as the engine cpu reads them: for each part and each segment of the
// view, the lobes that have any weight there. goniochrome-interference(7), "TILTED LOBES".
#pragma once

#include <array>
#include <vector>

#include "render/effects.h"
#include "render/gbuffer.h"

namespace goniochrome::render {

// One look-up: in the direction a r + s n + c (n x o), where r is the mirror direction, n the normal and o the
// direction to the viewer. All values are linear in the view: start + t (end - start), with t the part of the segment.
struct TiltLookup {
  std::size_t map = 0;                           // the number of its exponent
  std::array<float, 3> axis{}, axis_step{};      // a, s, c at the start, and what is added to reach the end
  std::array<float, 3> weight{}, weight_step{};  // of the map, R G B
};

struct TiltTable {
  std::vector<int> group_of_part;  // parts that wear the same are one group
  // (group * kViewSegments + segment), each in the order of the maps.
  std::vector<std::vector<TiltLookup>> rows;
};

// The set that a paint is drawn with by these effects, or null: its lobes are.
const paint::TiltedLobes* drawn_tilts(const paint::LobeFit& paint, const Effects& effects);

// The exponents (ascending) of all sets of the scene's paints, drawn or not, and of the gloss lobes that stand for
// rough coats; none where the effects draw neither.
std::vector<double> tilt_exponents(const Scene& scene, const Effects& effects);

// The look-ups in maps of those exponents. Lobes of other exponents are left out.
TiltTable tilt_table(const Scene& scene, const Effects& effects, const std::vector<double>& exponents);

// Takes flake lobes out of the effects that no paint shows: all that have them are drawn by tilted lobes. Under lights
// they stay, since color maps are drawn there as a difference from the lobes.
void leave_to_tilts(const Scene& scene, Effects& effects);

}  // namespace goniochrome::render
