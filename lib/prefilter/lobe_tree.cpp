#include "prefilter/lobe_tree.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/internal/kernel.h"
#include "prefilter/internal/lobe_patch.h"

// Over a block inside the edge the kernel K(t) is taken to first order around the block's axis, which integrates
// exactly with the block's flux F and moment M:
//   F K(t0) + K'(t0) (d.M - t0 F),   off by at most F max|K''| (t - t0)^2 / 2.
// A block is opened where that exceeds its share of the tolerance. All terms are positive, so an error relative to a
// block's own contribution is one relative to the sum; and a block may also err by its share of the whole sum C, the
// part of the sphere that it covers. Blocks cut by the horizon share a band of their own width, so their budget is
// larger by the sphere over the band. C comes from a first, coarse walk. For E = 1 the first order is exact and only
// blocks cut by the horizon are opened.

namespace goniochrome::prefilter {

namespace {

constexpr double kCoarseTolerance = 0.05;  // of the first walk

}  // namespace

struct LobeTree::Walk {
  Vec3 d;
  const ZonalKernel& kernel;
  double tolerance;
  Vec3 per_flux;  // 1 / C, per channel
};

// Adds what a block gives, where that is known well enough; else says that its parts are wanted.
bool LobeTree::opens(const Walk& walk, const envmap::BlockTree::Block& block, Vec3& sum) {
  double weight = 0;  // the block's flux over C, in the channel where that is largest
  for (int c = 0; c < 3; ++c) weight = std::max(weight, block.flux[c] * walk.per_flux[c]);
  if (weight == 0) return false;

  // The cosines of the nearest and the farthest point of the cap.
  const double t0 = dot(walk.d, vec3(block.axis)), s0 = std::sqrt(std::max(0.0, 1 - t0 * t0));
  const double cosine = block.cosine, sine = block.sine;
  const double high = t0 >= cosine ? 1 : t0 * cosine + s0 * sine;
  const ZonalKernel& kernel = walk.kernel;
  const double edge = kernel.edge().cosine;
  if (high <= edge) return false;
  const double low = t0 <= -cosine || cosine < 0 ? -1 : t0 * cosine - s0 * sine;
  const double share = block.area / (4 * kPi), most = kernel.value(high);
  const double budget = walk.tolerance * share;
  if (weight * most <= 0.1 * budget) return false;  // all of them together: a tenth of the tolerance
  if (low <= edge) {
    if (!(cosine > 0.8 && weight * most <= budget / std::max(sine, 1e-9))) return true;
    // On average half of the block is inside the edge.
    sum += 0.5 * kernel.mean_to_edge(most) * vec3(block.flux);
    return false;
  }
  const double least = kernel.value(low);
  const double step = std::max(high - t0, t0 - low), error = 0.5 * kernel.bend(low, high, least, most) * step * step;
  if (error > walk.tolerance * least && weight * error > budget) return true;
  const double k = kernel.value(t0), slope = kernel.slope(t0, k);
  for (int c = 0; c < 3; ++c)
    sum[c] += block.flux[c] * k + slope * (dot(walk.d, vec3(block.moment[c])) - t0 * block.flux[c]);
  return false;
}

void LobeTree::add_texel(const Walk& walk, int column, int row, Vec3& sum) const {
  const envmap::Environment& env = tree_.environment();
  const float* rgb = env.radiance(column, row);
  if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) return;
  double weight = 0;
  for (int c = 0; c < 3; ++c) weight = std::max(weight, rgb[c] * walk.per_flux[c] * env.solid_angle(column, row));
  // A texel may err by a tenth of the tolerance of itself, or by a thousandth of that of the sum; those on the horizon
  // do so at random.
  const double allowed = 1e-3 * walk.tolerance / weight;
  const double relative = std::clamp(allowed, 0.1 * walk.tolerance, 1e-2);
  const double cut = walk.kernel.near_edge(2 * env.largest_texel_rad());
  const envmap::Cell cell = {double(column), double(row), column + 1.0, row + 1.0};
  sum +=
      lobe_over_cell(env, cell, walk.d, walk.kernel, relative, std::clamp(allowed / cut, 0.1 * walk.tolerance, 0.1)) *
      vec3(rgb);
}

Vec3 LobeTree::walked(const Walk& walk) const {
  Vec3 sum;
  tree_.walk([&](const envmap::BlockTree::Block& block) { return opens(walk, block, sum); },
             [&](int column, int row) { add_texel(walk, column, row, sum); });
  return sum;
}

Vec3 LobeTree::lobe(const Vec3& d, double exponent, double tolerance) const {
  return lobe(d, CosineKernel(exponent), tolerance);
}

Vec3 LobeTree::lobe(const Vec3& d, const ZonalKernel& kernel, double tolerance) const {
  const double scale = kernel.scale();
  // The least C that matters: P = scale C at the floor of the mean.
  Vec3 floor;
  for (int c = 0; c < 3; ++c)
    floor[c] =
        std::max({kErrorFloor * flux_[c], kErrorFloor * kErrorFloor * std::max({flux_.x, flux_.y, flux_.z}), 1e-300}) /
        (4 * kPi * scale);
  const auto inverse = [](const Vec3& c) { return Vec3{1 / c.x, 1 / c.y, 1 / c.z}; };
  Walk walk = {d, kernel, kCoarseTolerance, inverse(floor)};
  if (tolerance < kCoarseTolerance) {
    const Vec3 coarse = walked(walk);
    Vec3 c;
    for (int k = 0; k < 3; ++k) c[k] = std::max(floor[k], 0.8 * coarse[k]);
    walk.per_flux = inverse(c);
    walk.tolerance = tolerance / 3;  // its own blocks, the far ones and the horizon may err by as much each
  }
  return scale * walked(walk);
}

}  // namespace goniochrome::prefilter
