// The effects that a scene calls for, and the table of weights that all engines with prefiltered maps read.
// goniochrome-rendering(7), "RENDERING".
#pragma once

#include <vector>

#include "base/result.h"
#include "brdf/ward.h"
#include "render/effects.h"
#include "render/scene.h"

namespace goniochrome::render {

// Everything that the scene's paints and lights call for.
Effects effects_of(const Scene& scene);

// A paint with the diffuse part, lobes, mirror, views and coat that are on alone.
paint::LobeFit with_effects(const paint::LobeFit& paint, const Effects& effects);

// These, and then the bright spots of the environment that are cut one by one, which scene_maps() takes out of the
// maps.
std::vector<Light> single_lights(const Scene& scene, const Effects& effects);

// The tilted normals that each part's lobes are drawn about; a single one where the part is isotropic.
std::vector<std::vector<brdf::Tilt>> tilts_of(const Scene& scene, const Effects& effects);
brdf::TiltSet tilts_of(const Scene& scene, const Effects& effects, std::size_t part);
// RGBA texels of them: a row for each part, all as long as the longest, of a normal in the frame of the surface and its
// share; what is left of a row is 0.
std::vector<float> tilt_texels(const std::vector<std::vector<brdf::Tilt>>& tilts);

// Error: a paint that is seen shows the extent of a lamp at a place. What its lobes gather of a disc is tabulated for
// one radius, and the lamp has another at each point. `engine` is the name of the engine that asks.
Result<void> draws_placed_lamps(const Scene& scene, const char* engine);

// `stretched` tells of each part whether other lobes stand for the gloss of its rough coat; empty: of none.
WeightTable weight_table(const Scene& scene, const Effects& effects, const std::vector<bool>& stretched = {});

// The parts whose paint sends more than 1.01 times even light to some viewer, in some channel. Paths between such walls
// gain light for ever and are ended by chance alone. Parts where a texture or a color map shows in the place of the
// paint are left out.
std::vector<int> gaining_parts(const Scene& scene);

}  // namespace goniochrome::render
