// A grid tells how the texels of an image lie on the sphere: their directions, their exact solid angles and which texel
// a direction meets. goniochrome-prefiltering(7), "ENVIRONMENTS".
#pragma once

#include <cstddef>
#include <vector>

#include "base/vec3.h"

namespace goniochrome::envmap {

// Continuous columns and rows: integers are texel edges, a texel's center is at +.5.
struct GridPosition {
  double column = 0, row = 0;
};

class SphereGrid {
 public:
  // kLatLong: axes are OpenEXR's, +Y up, image center +Z, longitude growing leftward to +X. kCube: OpenGL's faces as an
  // N x 6N strip. kCubeEdges: the same with texel centers on the face edges (spacing 2/(N-1)), as OpenEXR stores cubes:
  // its outermost cells are half as wide. kAngular: a disc in a square, the angle from +Z in proportion to the distance
  // from the middle, +Y up and +X to the left: what a mirror ball shows, unrolled; texels beyond the disc see nothing.
  enum class Layout { kLatLong, kCube, kCubeEdges, kAngular };

  SphereGrid() = default;
  SphereGrid(Layout layout, int width, int height) : layout_(layout), width_(width), height_(height) {}

  Layout layout() const { return layout_; }
  int width() const { return width_; }  // of the image: N of an N x 6N cube strip
  int height() const { return height_; }
  bool is_cube() const { return layout_ == Layout::kCube || layout_ == Layout::kCubeEdges; }

  double solid_angle(int column, int row) const { return solid_angle(column, row, column + 1, row + 1); }
  Vec3 direction(int column, int row) const { return direction_at(column + 0.5, row + 0.5); }  // unit

  // Exact solid angle of a part of one texel.
  double solid_angle(double column0, double row0, double column1, double row1) const;
  Vec3 direction_at(double column, double row) const;  // unit

  // d(solid angle)/d(column, row) at a point: what a quadrature over a part of a texel weighs it by.
  double solid_angle_density(double column, double row) const;

  // The turn of a lat-long map: the polar angle of a row and the longitude of a column. A quadrature that has many
  // points in a row or in a column finds their sines once, and then the direction and the density of solid angle from
  // them.
  struct Turn {
    double sine, cosine;
  };
  Turn polar_angle(double row) const;
  Turn longitude(double column) const;
  static Vec3 direction_at(const Turn& polar_angle, const Turn& longitude) {
    return {polar_angle.sine * longitude.sine, polar_angle.cosine, polar_angle.sine * longitude.cosine};
  }
  double solid_angle_density(const Turn& polar_angle) const;

  // A cube's continuous column, or row within a face, as the coordinate -1..1 of the face, and its derivative.
  double face_coordinate(double position) const;
  double face_slope(double position) const;

  // No point of that part of a texel is farther than this from the direction of its middle.
  double radius_rad(double column0, double row0, double column1, double row1) const;

  // No texel is wider or higher than this angle, in radians.
  double largest_texel_rad() const;

  // Where a direction falls. On a cube the row counts from the top of the strip.
  GridPosition position(const Vec3& direction) const;
  // The texel that a direction falls in, as row * width + column.
  int texel(const Vec3& direction) const;

 private:
  double disc_solid_angle(double column0, double row0, double column1, double row1) const;

  Layout layout_ = Layout::kLatLong;
  int width_ = 0, height_ = 0;
};

// The exact solid angles of all texels of a grid. The six faces of a cube have the same, and a row of a lat-long map
// has one.
class SolidAngles {
 public:
  explicit SolidAngles(const SphereGrid& grid);

  double at(int column, int row) const {
    return values_[static_cast<std::size_t>(row % rows_) * row_step_ + static_cast<std::size_t>(column) * column_step_];
  }

 private:
  int rows_ = 0;  // that differ
  std::size_t row_step_ = 0, column_step_ = 0;
  std::vector<double> values_;
};

}  // namespace goniochrome::envmap
