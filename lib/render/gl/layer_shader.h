// Programs that keep the light of a view in layers. As long as the view and the light stay, a picture is a sum of what
// the slots of weights meet at each point, times the weights of the paint there: where that light is kept, another
// paint takes one product for each layer in the place of look-ups in maps and sums over lamps.
// goniochrome-rendering(7), "Layers".
#pragma once

#include <string>
#include <vector>

#include "render/effects.h"

namespace goniochrome::render {

// A layer keeps the light that one slot of weights meets, see WeightTable.
struct LightLayer {
  int slot = 0;
  bool of_lamps = false;  // light of lamps; else that of a map
  std::string sampler;    // the map
  double exponent = 0;    // of its lobe, kDiffusePart or infinite
  // Where the slot has the shift by which a lobe looks beside its mirror direction; -1 where there is none.
  int shift_slot = -1, shift_channel = 0;
};

// The layers that a paint may need under these effects, whose lights are discs. The light in them depends on three
// things of a paint alone: the shifts, the coat's index, and the tilts of a brushed paint.
std::vector<LightLayer> light_layers(const Effects& effects);

// Programs draw so many layers at once, which every OpenGL ES 3 can.
constexpr int kLayersAtOnce = 4;
// In the place of a slot: what is seen beside the mesh, and no layer.
constexpr int kBesideLayer = -1, kNoLayer = -2;
// The most layers of one picture, without that of kBesideLayer.
constexpr int kMostLayers = 32;

// Draws the layers of uniform slots[4], each divided by scales[4], at the points of a G-buffer. It reads what the
// shading program of these effects reads.
std::string gathering_fragment_shader(const Effects& effects, bool on_page);

// The picture from layers: `layers` has the one of kBesideLayer first; `count` others have their slot and place in
// uniform used[], and what they were divided by in scales[].
std::string layers_fragment_shader(const Effects& effects, const color::ReflectionOperator& op);

}  // namespace goniochrome::render
