// This finds the texels of an image that a cell of another one covers, and how much of each, exactly, so that the
// mirror map keeps all flux. goniochrome-prefiltering(7), "The mirror".
#pragma once

#include <array>
#include <vector>

#include "base/vec3.h"
#include "envmap/sphere_grid.h"

namespace goniochrome::prefilter {

// A convex part of the sphere between four great circles; corners in order around it.
using SphereQuad = std::array<Vec3, 4>;

struct Overlap {
  int texel = 0;           // row * width + column
  double solid_angle = 0;  // sr
};

// Finds overlaps; keeps its memory from one cell to the next, so one for each thread.
class OverlapFinder {
 public:
  explicit OverlapFinder(const envmap::SphereGrid& grid);

  // Texels that the cell covers, with every texel once or more. Exact for lat-long maps and cubes; of an angular probe
  // the sides of the cell are taken in straight pieces of 5 mrad or an eighth.
  const std::vector<Overlap>& of(const SphereQuad& cell);

 private:
  void over_lat_long(const SphereQuad& cell);
  void find_breaks(const SphereQuad& cell, bool holds_pole);
  void add_column(double azimuth, double width, const std::array<Vec3, 4>& sides);
  void over_cube(const SphereQuad& cell);
  void over_disc(const SphereQuad& cell, int depth);
  envmap::SphereGrid grid_;
  std::vector<Overlap> found_;
  std::vector<double> row_heights_;  // of a lat-long map: cos of the polar angle of each row's edge
  std::vector<double> breaks_;       // azimuths
};

}  // namespace goniochrome::prefilter
