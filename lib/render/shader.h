// The shading program, written for one scene: only the effects and lobes that it uses. goniochrome-theory(7),
// RENDERING.
#pragma once

#include <string>
#include <vector>

#include "render/scene.h"

namespace goniochrome {

// What a scene calls for.
struct Effects {
  struct LobeUse {
    double exponent = 1;
    bool directional_diffuse = false, gloss = false;  // whether any paint has such a weight
  };
  bool environment = false;
  bool mirror = false;
  std::size_t lights = 0;
  Background background = Background::kNone;
  std::vector<LobeUse> lobes;  // ascending exponents
};
Effects effects_of(const Scene& scene);

// The weights that the program reads: for each part a row of RGBA texels (diffuse; directional-diffuse and gloss of
// each lobe; mirror), in 1/sr.
struct WeightTable {
  int columns = 0, rows = 0;
  std::vector<float> rgba;
};
WeightTable weight_table(const Scene& scene, const Effects& effects);

// Draws the G-buffer: unit normal, turned to the viewer, and part + 1 (negative where a surface is seen from inside).
std::string gbuffer_vertex_shader();
std::string gbuffer_fragment_shader();

// Covers the picture, and shades each point of the G-buffer.
std::string shading_vertex_shader();
std::string shading_fragment_shader(const Effects& effects);

}  // namespace goniochrome
