// The programs by which a page adds the light of single flakes to a picture, see goniochrome-flakes(7).
#pragma once

#include <string>

#include "color/reflection.h"
#include "render/effects.h"

namespace goniochrome::render {

// The mesh is drawn once more over its G-buffer.
std::string sparkle_vertex_shader();
// Adds to each pixel how far the light of its flakes that show a lamp is from their mean. The number of flakes is
// Poisson in cells of place and tilt that are fixed to the surface. The texture `flakes` has a row for each lamp, by
// chord: the part of all flakes that shows the lamp, the part at larger angles to the mirror direction, and the angular
// radius of the lamp as flakes of their spread show it. Returns "" where the effects have no lamps.
std::string sparkle_fragment_shader(const Effects& effects, const color::ReflectionOperator& op);
// Columns of `flakes`, at even steps of the chord up to kMostFlakeChord.
constexpr int kFlakeNodes = 512;
constexpr double kMostFlakeChord = 1.4142135623730951;

}  // namespace goniochrome::render
