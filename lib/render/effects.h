// The effects that a scene is shaded with, and the table of weights that all engines with prefiltered maps read.
// goniochrome-rendering(7), "RENDERING".
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "render/scene.h"

namespace goniochrome::render {

// The effects that are drawn by tracing rays: what the mesh does to light on its way. They are nested, so that it is
// plain what a picture without one of them shows. goniochrome-plan(7), "Effects of rays".
struct RayEffects {
  // The mesh takes light away from its own surface. Where it does, the surface sees a black body. Without this effect,
  // every point sees all of the light around, and the other two effects are off as well.
  bool shadow = false;
  // Instead of black, the lobes and the mirror of a point see the light that the body sends back.
  bool self = false;
  // The switch for the diffuse part of a point.
  bool bounce = false;
  // A floor that shows the ground of the environment lies below: it is seen, shaded by the mesh, and sends its light to
  // the mesh in the place of what the environment has below the horizon. It needs `shadow`.
  bool floor = false;

  bool any() const { return shadow; }
  bool operator==(const RayEffects&) const = default;
};

// The effects that are on, and how accurate they are.
struct Effects {
  struct LobeUse {
    double exponent = 1;
    bool directional_diffuse = false, gloss = false;  // whether any paint has such a weight
    bool operator==(const LobeUse&) const = default;
  };
  bool environment = false;
  bool diffuse = true;
  std::vector<LobeUse> lobes;  // ascending exponents
  bool mirror = false;
  bool fresnel = false;     // of gloss lobes and mirror
  bool coat = false;        // light passes the coat on its way to the base and back; else as much everywhere
  bool horizon = false;     // lobes end at the horizon, and each of their directions has its own cosine
  std::size_t spots = 0;    // bright spots of the environment that each horizon cuts by itself; with horizon
  bool views = false;       // weights of paints that change with the view
  bool satin = false;       // rough coats as surfaces of facets, by engines that can evaluate them
  bool stretch = false;     // elsewhere as lobes along the plane of incidence; else about the mirror direction alone
  bool maps = false;        // color maps under lights
  bool image_maps = false;  // color maps in image light, by engines that can evaluate them there
  int tilt_level = 0;       // what stands for them elsewhere: which set of tilted lobes; 0: none
  bool texture = false;     // textures of lobes; else the mean texel of each
  std::uint32_t texture_lobes = ~0U;  // of textures, by bits
  bool texture_filter = false;        // pixels show the mean of all texels that they cover; else those in their middle
  bool anisotropy = false;
  double tilt_tolerance = 0.005;  // Scene::tilt_error
  int most_tilts = 1024;
  double tolerance_de00 = 0.3;  // of the picture: p95 over the visible pixels
  bool sums = false;  // the diffuse part and the wide lobes by sums over the environment, which plans alone turn on
  bool reflection = false;  // the scene's reflection operator in place of the component-wise product
  bool panes = false;       // what lies behind panes; else they mirror before black
  std::size_t lights = 0;
  bool placed = false;   // some of them stand at a place
  bool extent = false;   // lamps as discs, which lobes and the mirror see; else as points
  bool sparkle = false;  // flakes one by one, added to the picture of an engine with prefiltered maps by plans alone
  RayEffects rays = {};  // effects_of() leaves them out, since no engine with prefiltered maps draws them by itself
  int most_ray_samples = 1 << 16;  // of a visible point, in all samples of its pixel
  Background background = Background::kNone;

  bool operator==(const Effects&) const = default;
  // Lights that engines of maps sum one by one: lamps, and bright spots of the environment as discs.
  std::size_t single_lights() const { return lights + spots; }
  bool discs() const { return extent || spots > 0; }
  bool depends_on_view() const { return fresnel || coat || horizon || views || stretch || tilt_level > 0; }
};

// The lamps that these effects draw, as points where the effect `extent` is off.
std::vector<Light> lights_of(const Scene& scene, const Effects& effects);

// Weights are piecewise linear in the view: W = a + b t. Where no effect depends on the view there is one segment, with
// t = n.wo itself; else kViewSegments of them, even in x = sqrt(n.wo), with t the part of a segment. Each part of the
// mesh has a row for each segment; each slot has two RGBA texels, a and b.
//   slot 0            pi K_D, of the diffuse map, of a paint without a coat
//   slot 1 + j        lobe j's share of P_Ej(r + s n), cosine, coat and 2 pi/(E+1) included
//   slot 1 + lobes    K_M F, of the mirror map
//   slot 2 + lobes    pi K_D, of the coat's diffuse map, of a paint with a coat, times its passages
//   then, for lights, K_D, and K_DD and K_G of each lobe, in 1/sr; all but K_G as the coat lets them out to the viewer.
//                     The fourth channel of K_D is the square of the coat's index, 1 without a coat
//   then s of each lobe, four in a slot
//   then K_M F, of the mirror image of lamps
constexpr int kViewSegments = 64;
// Lobes up to this exponent look where the light they gather above the horizon comes from, each by itself; sharper ones
// share the mirror direction. With the effect `horizon`.
constexpr double kWidestShared = 100;
inline bool is_shifted(const Effects& effects, double exponent) {
  return effects.horizon && exponent <= kWidestShared;
}
struct WeightTable {
  int lobes = 0, segments = 1, slots = 0;
  std::vector<int> rows;    // of each part: neighbors that wear the same share one
  std::vector<float> rgba;  // ((row * segments + segment) * slots + slot) * 8

  static int diffuse_slot() { return 0; }
  static int lobe_slot(std::size_t lobe) { return 1 + static_cast<int>(lobe); }
  int mirror_slot() const { return 1 + lobes; }
  int coat_diffuse_slot() const { return 2 + lobes; }
  int light_slot() const { return 3 + lobes; }
  int directional_diffuse_slot(std::size_t lobe) const { return 4 + lobes + 2 * static_cast<int>(lobe); }
  int gloss_slot(std::size_t lobe) const { return directional_diffuse_slot(lobe) + 1; }
  int shift_slot(std::size_t lobe) const { return 4 + 3 * lobes + static_cast<int>(lobe / 4); }  // channel lobe % 4
  int lamp_mirror_slot() const { return 4 + 3 * lobes + (lobes + 3) / 4; }
  int row_count() const { return rows.empty() ? 0 : rows.back() + 1; }
  std::size_t row_floats() const { return static_cast<std::size_t>(segments) * static_cast<std::size_t>(slots) * 8; }
  const float* at(int row, int segment, int slot) const {
    return &rgba[static_cast<std::size_t>(row) * row_floats() + static_cast<std::size_t>(segment * slots + slot) * 8];
  }
};
// The table's sizes, without its weights.
WeightTable slots_of(const Effects& effects);
}  // namespace goniochrome::render
