// The kernel of the engine cpu. It is compiled for several instruction sets, of which the best that the processor has
// is chosen at run time.
#pragma once

#include <cstddef>
#include <cstdint>

#include "brdf/disc_light.h"
#include "render/cpu/interleaved_maps.h"
#include "render/internal/placed_lamps.h"

namespace goniochrome::render {

// The direction of the look-up: the normal; the mirror direction; or the mirror directions about tilted normals.
enum class MapUse { kNormal, kMirror, kTilted };

constexpr int kMostClasses = 16;
constexpr int kMostBlocks = 32;  // of all maps met by the mirror direction together
constexpr int kMostLobes = 2 * kMostBlocks;
static_assert(kMostLobes <= 64, "CpuShading::lit_lobes has a bit for each");

// Data that the kernel shades with. Weights of a row and segment: for each class of maps in order, for each block, 8
// floats a and 8 floats b (W = a + b t). Then, for each light slot, 4 floats a and 4 floats
// b. Then, for each class, a and b of the shift s of its direction, r + s n.
struct CpuShading {
  int classes = 0;
  InterleavedMaps maps[kMostClasses];
  MapUse use[kMostClasses] = {};
  bool shifted[kMostClasses] = {};
  const float* product = nullptr;  // product_columns()
  int segments = 1;
  const int* rows = nullptr;       // of each part, in the weights
  const float* weights = nullptr;  // row by row
  std::size_t segment_floats = 0;
  const std::uint64_t* shown_blocks = nullptr;  // of each part, bits: the blocks of all classes with any weight
  // Within a segment: of the light slots, after which the mirror's for lamps stands, and of the shifts.
  std::size_t light_offset = 0, shift_offset = 0;

  // Tilts of the normal, 4 floats each (in the frame of the surface, then the share); part p has those from
  // first_tilt[p] to first_tilt[p + 1]. Null where no part has more than one.
  const float* tilts = nullptr;
  const int* first_tilt = nullptr;
  int most_tilts = 1;

  int lights = 0;
  const float* light = nullptr;        // 8 a light: direction, 0, pi times its white, 0
  const PlacedLamp* placed = nullptr;  // of each light; null: all are far away
  int lobes = 0;
  const float* exponents = nullptr;
  const std::uint64_t* lit_lobes = nullptr;  // of each part, bits: the lobes with any weight in the light of lamps
  bool lit_diffuse = false, fresnel = false, coat = false;

  // Where lamps are drawn as discs: for each light its disc, and for each light and lobe what the lobe gathers of it.
  struct Disc {
    const brdf::DiscHorizonTable* horizon = nullptr;
    float radius_rad = 0, sine = 0, chord = 0;  // of the radius
    float mirrored = 0;  // of the mirror, within the disc, beside pi times the light: 1/(pi sin^2 of the radius)
  };
  const Disc* discs = nullptr;  // null: all are points
  const brdf::DiscLobeTable* const* disc_lobes = nullptr;
};

// Points as separate arrays of kPointsAtOnce each. The first `count` of them are shaded; the others must hold any
// finite numbers, since the kernel computes with them as well.
struct PointArrays {
  float nx[kPointsAtOnce], ny[kPointsAtOnce], nz[kPointsAtOnce];
  float vx[kPointsAtOnce], vy[kPointsAtOnce], vz[kPointsAtOnce];  // toward the viewer, of any length
  std::int32_t part[kPointsAtOnce];
  float px[kPointsAtOnce], py[kPointsAtOnce], pz[kPointsAtOnce];  // from origin_of() the mesh, for lamps at a place
};

// rgba: 4 floats a point, of which the fourth has no meaning.
void shade_points(const CpuShading& shading, PointArrays& points, int count, float* rgba);

// Shades each point in the paints of so many parts, from its own on, which have one coat and one brushing, so that they
// meet the same light. rgba: 4 * kPointsAtOnce floats a paint. The parts of the points are changed.
void shade_paints(const CpuShading& shading, PointArrays& points, int count, int paints, float* rgba);

// Looks up one class of maps (a single map) in the directions toward which the points' v point, reversed.
void look_up_background(const InterleavedMaps& map, PointArrays& points, int count, float* rgba);

}  // namespace goniochrome::render
