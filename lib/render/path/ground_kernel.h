// Sums over a floor that shows the environment, in blocks: what the diffuse part and wide lobes gather of it at a
// point. Compiled for several instruction sets, of which the best that the processor has is chosen at run time.
// goniochrome-paths(7), "Open floor".
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "rays/float3.h"

namespace goniochrome::render {

using Places = std::array<std::vector<float>, 3>;

// Blocks one by one, each quantity by itself.
struct FloorBlocks {
  Places place;   // of the light of a block of floor, local
  Places sent;    // radiance times area
  Places toward;  // of the light that the environment has in the block's place below the horizon, unit
  Places hidden;  // its radiance times solid angle
};

// Blocks in tiles of so many. Dark ones fill the tiles that the horizon cuts.
struct GroundBlocks {
  static constexpr std::size_t kTile = 16;  // No kernel takes more blocks at once.
  static constexpr std::size_t kParts = 4;  // of a block

  FloorBlocks whole;
  std::vector<float> area;  // of a block
  FloorBlocks parts;        // of the blocks of a tile, one after the other
};

// A point with the lobes cos^E about its mirror direction.
struct GroundReceiver {
  static constexpr std::size_t kMostLobes = 8;

  rays::Float3 position, normal, to_viewer, mirrored;
  float coat_index = 1;  // paint::kNoCoat: none
  std::size_t lobes = 0;
  float exponents[kMostLobes] = {};
};

// Light of weight 1: the floor's less that of the environment behind it.
struct GroundColumns {
  rays::Float3 diffuse, flakes[GroundReceiver::kMostLobes], gloss[GroundReceiver::kMostLobes];
};

GroundColumns sum_ground(const GroundBlocks& blocks, const GroundReceiver& point);

}  // namespace goniochrome::render
