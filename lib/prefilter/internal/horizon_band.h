// Texels along the horizon of a direction are summed one by one. goniochrome-prefiltering(7), "Horizon bands".
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/angles.h"
#include "envmap/environment.h"
#include "prefilter/internal/horizon_table.h"
#include "prefilter/internal/strip_map.h"

namespace goniochrome::prefilter {

// The rest of a clipped lat-long map or cube, laid out for sums over bands along great circles.
class HorizonBand {
 public:
  HorizonBand(const envmap::Environment& env, const envmap::Clip& clip);

  static bool serves(const envmap::Environment& env) { return env.layout() != envmap::SphereGrid::Layout::kAngular; }

  // For each direction d the integral of L times the function of the cosine to d whose second antiderivative is given.
  // Over every texel the cosine is taken as linear: a texel of radius r that the horizon cuts errs by r/5 of itself or
  // less.
  std::vector<Vec3> sums(const std::vector<Vec3>& directions, const SecondIntegral& band) const;

  // The width of a texel in the middle of the map.
  double side_rad() const { return grid_.is_cube() ? 2.0 / grid_.width() : kPi / grid_.height(); }

  // About how many texels a sum takes in.
  static double texels_beside(const envmap::Environment& env, double reach);

 private:
  void weigh_rows(const StripMap::Seat& seat, const SecondIntegral& band, Strips& strips) const;
  void add_faces(const Vec3& d, const SecondIntegral& band, double total[3]) const;

  envmap::SphereGrid grid_;
  std::optional<StripMap> strips_;  // of a lat-long map
  std::vector<float> rgb_;          // of a cube, in rows of stride_ texels
  std::size_t stride_ = 0;
  struct Row {
    double ring, level, area;  // distance of the centroids from the axis, height above the equator; solid angle
  };
  static Row row_of(const envmap::Environment& env, int row);
  std::vector<Row> rows_;  // of a lat-long map
  // Values of the columns. Lat-long: sine and cosine of the longitude. Cube: middle and width in the plane of the face.
  std::vector<double> first_, second_;
};

}  // namespace goniochrome::prefilter
