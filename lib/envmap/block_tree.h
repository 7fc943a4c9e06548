// This is an environment as a tree of blocks of texels. Each block holds the sums over its texels. A walk over the tree
// starts at the largest blocks, and goes into a block only where the caller asks for its parts.
// goniochrome-prefiltering(7), "Blocks".
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "envmap/environment.h"

namespace goniochrome::envmap {

class BlockTree {
 public:
  // The texels of a block: inside the cap around `axis`; per channel the sum of L dw and of L w dw.
  struct Block {
    float axis[3];
    float cosine, sine;  // of the cap's radius
    float area;          // sr
    float flux[3];
    float moment[3][3];  // [channel][axis]
  };

  // The environment must outlive the tree.
  explicit BlockTree(const Environment& env);

  const Environment& environment() const { return *env_; }

  // From the coarsest blocks down: `opens(block)` takes a block in, or says that its parts are wanted; of the finest
  // blocks these are texels, which `texel(column, row)` takes in. In the same order at every walk.
  template <class Opens, class Texel>
  void walk(const Opens& opens, const Texel& texel) const {
    for (const Sheet& sheet : sheets_) visit(sheet, static_cast<int>(sheet.levels.size()) - 1, 0, 0, opens, texel);
  }

 private:
  // A rectangle of texels that nest: the whole lat-long map, or a face of a cube.
  struct Sheet {
    int row = 0, width = 0, height = 0;
    struct Level {
      int width = 0, height = 0;
      std::vector<Block> blocks;
    };
    std::vector<Level> levels;  // level k holds blocks of 2^(k+1) texels a side
  };

  void build(Sheet& sheet, const SolidAngles& solid_angles) const;
  static Block merged(const Sheet::Level& finer, int column, int row);
  Block block_of_texels(const Sheet& sheet, const SolidAngles& solid_angles, int column, int row) const;
  double radius_of_texels(const Vec3& axis, int left, int right, int top, int bottom) const;

  template <class Opens, class Texel>
  static void visit(const Sheet& sheet, int level, int column, int row, const Opens& opens, const Texel& texel) {
    const Sheet::Level& here = sheet.levels[static_cast<std::size_t>(level)];
    if (!opens(here.blocks[static_cast<std::size_t>(row) * here.width + column])) return;
    const int width = level > 0 ? sheet.levels[static_cast<std::size_t>(level) - 1].width : sheet.width;
    const int height = level > 0 ? sheet.levels[static_cast<std::size_t>(level) - 1].height : sheet.height;
    for (int y = 2 * row; y < std::min(2 * row + 2, height); ++y) {
      for (int x = 2 * column; x < std::min(2 * column + 2, width); ++x) {
        if (level > 0) {
          visit(sheet, level - 1, x, y, opens, texel);
        } else {
          texel(x, sheet.row + y);
        }
      }
    }
  }

  const Environment* env_;
  std::vector<Sheet> sheets_;
};

}  // namespace goniochrome::envmap
