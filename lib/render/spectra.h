// The spectra of a scene: what its paints and lamps are in bands of wavelength. goniochrome-color(7), "LIGHT IN BANDS".
#pragma once

#include <optional>
#include <vector>

#include "color/bands.h"
#include "paint/band_lobes.h"

namespace goniochrome::render {

// Where a scene has these, the engine path follows light in bands and multiplies it band by band. There is no
// environment then, no textures and no color maps, which have no spectra.
struct SceneSpectra {
  color::BandObserver eye;
  std::vector<paint::BandLobes> paints;     // for each part, as Scene::paints
  std::optional<paint::BandLobes> floor;    // of a floor that wears a paint
  std::vector<color::Bands> emission = {};  // radiance of each part, relative to daylight; none where there are fewer
  std::vector<color::Bands> lights = {};    // white of each of Scene::lights, relative to daylight
};

}  // namespace goniochrome::render
