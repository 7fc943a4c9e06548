// What it takes to shade by prefiltered maps: the arithmetic of a frame, counted, times nanoseconds that each engine
// measured for itself. goniochrome-theory(7), PLAN, The cost of an effect.
#pragma once

#include "render/engine.h"

namespace goniochrome::render {

// Of a textured point: four texels around a place, each with its lobes, or the mean texel.
struct TextureCost {
  double point, lobe, fetches, lit;  // the point, a lobe of a texel, its two fetches, its light
  bool each_texel_once;              // however many probes of a footprint show it
};

// Nanoseconds on one core of the machine that they were measured on (2.6 GHz, AVX-512).
struct MapCost {
  double pixel;      // a pixel of the picture, which is written and maybe read back, whether it shows the mesh or not
  double point;      // what every visible point takes
  double block;      // one block of maps more
  double direction;  // one direction more in which maps are looked up
  double light;      // one light more
  double lit_lobe;   // one lobe in a light that is a point
  double disc_lobe;  // one lobe in a light that is a disc
  double view;       // weights that depend on the view
  double tilted;     // tilted lobes, at a point that has any
  double lookup;     // one look-up of a tilted lobe
  bool pairs;        // whether a block holds two maps as long as the product of colors has at most four forms
  TextureCost texture;
};

// Of one visible point, textures and color maps apart.
double point_ns(const Workload& work, const Effects& effects, const MapCost& cost);

// Of the shading of one frame on all cores, textures and color maps included.
double frame_ms(const Workload& work, const Effects& effects, const MapCost& cost);

}  // namespace goniochrome::render
