// The part of the shading program that draws textures of generalized cosine lobes, and the layout of what it reads them
// from. goniochrome-theory(7), SPATIALLY VARYING SURFACES, Drawing.
#pragma once

#include <string>
#include <vector>

#include "render/effects.h"
#include "render/gl/disc_texture.h"
#include "render/textures/sbrdf.h"
#include "render/textures/texture_places.h"

namespace goniochrome::render {

// What the text of the program knows of the textures.
struct TextureProgram {
  // A texture that is drawn, and its levels, which lie one below the other in one array: the size and the first row of
  // each.
  struct Level {
    int width = 0, height = 0, row = 0;
  };
  struct Texture {
    int lobes = 0, level_lobes = 0;
    std::vector<Level> levels;  // none without the effect texture_filter
  };
  std::vector<Texture> textures;  // none: the scene has none
  int depth = 0;                  // the most that a part has
  bool dims = false;              // whether paints are seen through some
  // Of each cube of prefiltered light in "lobe_maps": the texels along a face, and the row where it begins. That of the
  // diffuse part is the last. None: no environment.
  struct Cube {
    int size = 0, row = 0;
  };
  std::vector<Cube> cubes;
  int horizon_rows = 0;  // of "lobe_horizon", for the exponents that it has

  bool any() const { return !textures.empty(); }
  bool filtered() const;
};
// Of the scene's textures, or of their mean texels where the effects leave the textures out.
TextureProgram texture_program(const Scene& scene, const Effects& effects);

// One texture as an array of layers, each of RGBA texels row by row from the top. Layer 0: the diffuse color. Then
// three for each lobe: its color with the largest channel 1, and the logarithm of its largest albedo; its axes and its
// exponent; its place among the cubes and among the rows of the horizon, where a half lies between two of them, and the
// angle from the tangent to its x axis.
constexpr int kTextureLobeLayers = 3;
struct TextureLayers {
  int width = 0, height = 0, layers = 0;
  std::vector<float> rgba;
};
TextureLayers texture_layers(const PackedTexture& texture);
// The levels of one texture, as its part of the program has them.
TextureLayers level_layers(const SbrdfShader& shader, std::size_t number, std::uint32_t lobes,
                           const TextureProgram::Texture& texture);

// The cubes of prefiltered light: six faces side by side, each with a border of one texel, and cube above cube.
FloatTexture lobe_map_texture(const SbrdfShader& shader);
// The table of SbrdfShading::horizon, with a node in R and G of each texel.
FloatTexture lobe_horizon_texture(const SbrdfShader& shader);

// A texel for each pixel, in four layers for each texture of a part, the lowest first: the place on the texture within
// 0..1, the number of the texture and 1 (0: none), and the level; the tangent and the number of probes; the footprint
// to the right and downward; the part of what is seen that it shows, and what all textures together cover of the paint.
// A sample stands for `share` of its pixel.
constexpr int kPlaceLayers = 4;
TextureLayers place_layers(const SurfaceLayer& layer, const Effects& effects, const Gbuffer& gbuffer,
                           const std::vector<TexturePlace>& places, double share);

// The uniforms, the function `textured(at, map, n, wo)` that returns the radiance of a texture at a pixel, black where
// it has none, and what the main function does with it. All are empty where nothing is textured.
std::string texture_uniforms(const TextureProgram& textures, const Effects& effects);
std::string texture_function(const TextureProgram& textures, const Effects& effects);
std::string texture_terms(const TextureProgram& textures);

}  // namespace goniochrome::render
