// The data that a page in a browser needs to draw paints in prefiltered light by WebGL 2, as the engine gl draws them:
// the same programs, and the maps and lamps that they read. Weights are those of weight_table().
// goniochrome-rendering(7), "RENDERING".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"
#include "render/effects.h"
#include "render/gl/layer_shader.h"

namespace goniochrome::render {

// OpenGL ES 3. The G-buffer takes the row of the paint's weights for the number of the part.
struct PagePrograms {
  std::string gbuffer_vertex, gbuffer_fragment, shading_vertex, sparkle_vertex;
};
PagePrograms page_programs();

// How a page keeps the light of a view, so that another paint is shown by sums of a few products a pixel: the picture
// is drawn by layers_fragment from layers that were drawn by the gathering program of an environment, see
// render/gl/layer_shader.h.
struct PageLayers {
  std::string layers_fragment;
  std::vector<LightLayer> layers;
  int light_slot = 0;  // the fourth channel of its weights is the square of the coat's index
};
PageLayers page_layers(Effects effects, const color::ReflectionOperator& op);

// One cube texture, by the name of its sampler: six faces of RGB.
struct PageCube {
  std::string sampler;
  int size = 0;
  std::vector<float> texels;
};

// A lamp as the uniforms light_direction, light_white and light_disc have it.
struct PageLamp {
  Vec3 direction, white, disc;
};

// The programs of one light. Those for brushed paints read the texture "tilts".
struct PageShading {
  std::string shading, brushed_shading;
  std::string gathering, brushed_gathering;  // its layers
  std::string sparkle;                       // see sparkle_fragment_shader()
};

struct PageLight {
  PageShading programs;
  std::vector<PageCube> cubes;
  std::vector<PageLamp> lamps;          // its bright spots
  int disc_columns = 0, disc_rows = 0;  // of the texture "discs"
  std::vector<float> discs;             // its RGBA texels; empty without lamps
};

// The data that a page needs to draw one more lamp in an environment: a disc far away, which the page moves and dims.
struct PageMovableLamp {
  PageShading programs;      // those of the environment with this lamp before its others
  Vec3 disc;                 // as light_disc has it
  std::vector<float> discs;  // texels that go before those of the others
};

// The data by which the programs `sparkle` draw the flakes of a paint.
struct PageFlakes {
  double per_m2 = 0;          // 0 where none of its light comes from flakes
  std::vector<double> most;   // the largest part of them that shows each lamp
  std::vector<float> texels;  // RGBA of the texture "flakes", as sparkle_fragment_shader() reads it
};
PageFlakes page_flakes(const paint::LobeFit& fit, const paint::Flakes& flakes, const std::vector<double>& lamps_rad);

// WebGL 2 promises 16 textures. Besides lobes, the program reads seven.
constexpr std::size_t kMostPageLobes = 9;

// Error: a lobe or the mirror part that the environment lacks, with the command that makes it; more than
// kMostPageLobes.
Result<PageLight> page_light(const envmap::PrefilteredEnvironment& env, const Effects& effects,
                             const color::ReflectionOperator& op);

// `effects` are those of page_light(), without the lamp. radius_rad is that of the disc as it is seen,
// above 0 and up to kWidestDisc_rad.
PageMovableLamp page_movable_lamp(Effects effects, const color::ReflectionOperator& op, double radius_rad);

}  // namespace goniochrome::render
