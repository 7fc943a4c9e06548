// The few texels that outshine the rest (a sun, lamps) are convolved one by one, so that the rest has no peaks.
// goniochrome-prefiltering(7), "Bright texels".
#pragma once

#include <limits>
#include <vector>

#include "envmap/environment.h"
#include "prefilter/internal/kernel.h"

namespace goniochrome::prefilter {

constexpr int kMostBright = 1024;

// How many texels outshine the mean 50 times, at most kMostBright.
std::size_t bright_count(const envmap::Environment& env);

// A map split in two: rest() leaves the mean of the others in the place of every bright texel, in its color, and the
// bright texels are what exceeds that.
class BrightTexels {
 public:
  // Splits off at most `most` texels, those above 50 times the mean. The environment must outlive this.
  BrightTexels(const envmap::Environment& env, int most);

  std::size_t count() const { return texels_.size(); }
  const envmap::Clip& rest() const { return rest_; }

  // Their part of the map at d, each texel a constant patch. One that the edge of the kernel cuts is taken as flat
  // where that costs no more than `allowed` of any channel of the map, and else by recursion.
  Vec3 lobe(const Vec3& d, const ZonalKernel& kernel, double allowed = std::numeric_limits<double>::infinity()) const;

 private:
  struct Texel {
    Vec3 flux;                    // of the excess
    Vec3 centroid, across, down;  // mean direction, and how it changes from side to side
    double radius_rad;
    Vec3 excess;  // of radiance
    int column, row;
  };
  Vec3 beside_edge(const Vec3& d, const ZonalKernel& kernel, const Texel& texel, double allowed) const;

  const envmap::Environment* env_;
  envmap::Clip rest_;
  std::vector<Texel> texels_;
  double largest_radius_ = 0;
  // A texel as points, their flux as floats: its centroid, which is exact for E = 1 above the horizon, and four Gauss
  // points.
  struct Points {
    std::size_t per_texel = 1;
    std::vector<float> flux;
    std::vector<double> x, y, z;
    void add(const Vec3& at, const Vec3& rgb);
  };
  Points centroids_, gauss_;
};

}  // namespace goniochrome::prefilter
