// The light that the diffuse part and the wide lobes of a basis gather of an environment where no surface is in the
// way, summed over the environment itself: where its prefiltered maps err by too much.
// goniochrome-transport(7), "Control variate".
#pragma once

#include <vector>

#include "envmap/block_tree.h"
#include "render/path/lobe_columns.h"

namespace goniochrome::render {

// A direction that lobes are about, and its share of them.
struct LobeAxis {
  Vec3 direction;
  double share = 1;
};

class SummedLight {
 public:
  // By blocks within a color difference at 95 of 100 points. The tree must outlive it.
  SummedLight(const envmap::BlockTree& tree, double tolerance_de00, const LobeColumns& columns);

  // The columns that are summed: the first ones.
  std::size_t count() const { return 1 + 2 * exponents_.size(); }
  // Writes the light of the diffuse column and of those of the wide lobes, with weight 1, at a point seen from there
  // under a coat of that index.
  void at(const Vec3& normal, const Vec3& to_viewer, const std::vector<LobeAxis>& axes, double coat_index,
          color::Rgb* light) const;

 private:
  const envmap::BlockTree* tree_;
  double spread_;
  std::vector<double> exponents_;  // of the wide lobes
};

}  // namespace goniochrome::render
