// What lies beside the horizon of a direction is summed texel by texel. goniochrome-theory(7), PREFILTERING, Horizon
// bands.
#pragma once

#include <cstddef>
#include <vector>

#include "base/angles.h"
#include "envmap/environment.h"
#include "prefilter/internal/horizon_table.h"

namespace goniochrome::prefilter {

// What a clip leaves of a lat-long map or a cube, laid out for sums over bands beside great circles.
class HorizonBand {
 public:
  HorizonBand(const envmap::Environment& env, const envmap::Clip& clip);

  static bool serves(const envmap::Environment& env) { return env.layout() != envmap::SphereGrid::Layout::kAngular; }

  // The integral of L times the function of the cosine to d whose second antiderivative is given. Over every texel the
  // cosine is taken as linear: a texel of radius r that the horizon cuts errs by r/5 of itself or less.
  Vec3 sum(const Vec3& d, const SecondIntegral& band) const;

  // The width of a texel in the middle of the map.
  double side_rad() const { return grid_.is_cube() ? 2.0 / grid_.width() : kPi / grid_.height(); }

  // About how many texels a sum takes in.
  static double texels_beside(const envmap::Environment& env, double reach);

 private:
  void add_rows(const Vec3& d, const SecondIntegral& band, double total[3]) const;
  void add_faces(const Vec3& d, const SecondIntegral& band, double total[3]) const;

  envmap::SphereGrid grid_;
  std::vector<float> rgb_;  // rows of stride_ texels; the first of a row follow its last once more
  std::size_t stride_ = 0;
  struct Row {
    double ring, level, area;  // distance of the centroids from the axis, height above the equator; solid angle
  };
  static Row row_of(const envmap::Environment& env, int row);
  std::vector<Row> rows_;  // of a lat-long map
  // Of the columns. Lat-long: sine and cosine of the longitude. Cube: middle and width in the plane of the face.
  std::vector<double> first_, second_;
};

}  // namespace goniochrome::prefilter
