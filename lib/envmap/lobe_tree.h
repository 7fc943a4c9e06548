// One lobe at one direction by a walk over a tree of texel blocks: right for any exponent and any environment, and fast
// where the lobe is narrow. goniochrome-theory(7), PREFILTERING, Blocks.
#pragma once

#include <vector>

#include "envmap/environment.h"

namespace goniochrome {

class LobeTree {
 public:
  explicit LobeTree(const Environment& env);

  // P_E(d) per channel, within about `tolerance` of the larger of its value and 1e-3 of the channel's mean.
  Vec3 lobe(const Vec3& d, double exponent, double tolerance) const;

 private:
  // The texels of a block: inside the cap around `axis`; per channel the sum of L dw and of L w dw.
  struct Block {
    float axis[3];
    float cosine, sine;  // of the cap's radius
    float area;          // sr
    float flux[3];
    float moment[3][3];  // [channel][axis]
  };
  // A rectangle of texels that nest: the whole lat-long map, or a face of a cube.
  struct Sheet {
    int row = 0, width = 0, height = 0;
    struct Level {
      int width = 0, height = 0;
      std::vector<Block> blocks;
    };
    std::vector<Level> levels;  // level k holds blocks of 2^(k+1) texels a side
  };
  struct Walk;

  void build(Sheet& sheet) const;
  Block block_of_texels(const Sheet& sheet, int column, int row) const;
  void visit(const Walk& walk, const Sheet& sheet, int level, int column, int row, Vec3& sum) const;
  void visit_texel(const Walk& walk, int column, int row, Vec3& sum) const;
  Vec3 walked(const Walk& walk) const;

  const Environment& env_;
  std::vector<Sheet> sheets_;
  Vec3 flux_;
};

}  // namespace goniochrome
