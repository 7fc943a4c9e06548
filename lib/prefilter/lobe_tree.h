// Filters an environment at single directions by a walk over a tree of texel blocks: right for any kernel and any
// environment, and fast where the lobe is narrow. goniochrome-prefiltering(7), "Blocks".
#pragma once

#include "envmap/block_tree.h"

namespace goniochrome::prefilter {

class ZonalKernel;

class LobeTree {
 public:
  // The environment must outlive the tree.
  explicit LobeTree(const envmap::Environment& env) : tree_(env), flux_(env.flux()) {}

  // P_E(d) per channel, within about `tolerance` of the larger of its value and 1e-3 of the channel's mean.
  Vec3 lobe(const Vec3& d, double exponent, double tolerance) const;
  // The lobe of any kernel (internal/kernel.h).
  Vec3 lobe(const Vec3& d, const ZonalKernel& kernel, double tolerance) const;

 private:
  struct Walk;
  static bool opens(const Walk& walk, const envmap::BlockTree::Block& block, Vec3& sum);
  void add_texel(const Walk& walk, int column, int row, Vec3& sum) const;
  Vec3 walked(const Walk& walk) const;

  envmap::BlockTree tree_;
  Vec3 flux_;
};

}  // namespace goniochrome::prefilter
