#include "envmap/sphere_grid.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "envmap/cube_map.h"
#include "math/quadrature.h"

namespace goniochrome::envmap {

// A cube whose texel centers lie on the face edges has its cell edges half way between them, at (i-.5)/(N-1), and at
// the face edges.
double SphereGrid::face_coordinate(double position) const {
  if (layout_ == Layout::kCube) return 2 * position / width_ - 1;
  const double last = width_ - 1;
  const double whole = std::clamp(std::floor(position), 0.0, last), part = position - whole;
  const double low = std::clamp(whole - 0.5, 0.0, last), high = std::clamp(whole + 0.5, 0.0, last);
  return 2 * (low + part * (high - low)) / last - 1;
}

double SphereGrid::face_slope(double position) const {
  const double whole = std::clamp(std::floor(position), 0.0, width_ - 1.0);
  return face_coordinate(whole + 1) - face_coordinate(whole);
}

// The density of a disc is smooth over a texel, so two Gauss points a side are exact to h^4/4320; a texel that the rim
// cuts is summed in equal parts (the density falls to zero there).
double SphereGrid::disc_solid_angle(double column0, double row0, double column1, double row1) const {
  const auto inside = [this](double column, double row) {
    return std::hypot(2 * column / width_ - 1, 2 * row / height_ - 1) <= 1;
  };
  const bool whole = inside(column0, row0) && inside(column0, row1) && inside(column1, row0) && inside(column1, row1);
  const int parts = whole ? std::max(1, 64 / width_) : 16;
  const double width = (column1 - column0) / parts, height = (row1 - row0) / parts;
  double sum = 0;
  for (int j = 0; j < parts; ++j)
    for (int i = 0; i < parts; ++i)
      for (const double x : math::kGaussPair)
        for (const double y : math::kGaussPair)
          sum += solid_angle_density(column0 + (i + x) * width, row0 + (j + y) * height) / 4;
  return sum * width * height;
}

// A lat-long cell between the polar angles t0 < t1: dphi (cos t0 - cos t1), as a product so that nothing cancels.
double SphereGrid::solid_angle(double column0, double row0, double column1, double row1) const {
  if (layout_ == Layout::kLatLong) {
    const double middle = kPi * (row0 + row1) / (2 * height_), half = kPi * (row1 - row0) / (2 * height_);
    return 2 * kPi * (column1 - column0) / width_ * 2 * std::sin(middle) * std::sin(half);
  }
  if (layout_ == Layout::kAngular) return disc_solid_angle(column0, row0, column1, row1);
  const double face = std::floor(row0 / width_) * width_;
  return cube_cell_solid_angle(face_coordinate(column0), face_coordinate(column1), face_coordinate(row0 - face),
                               face_coordinate(row1 - face));
}

SphereGrid::Turn SphereGrid::polar_angle(double row) const {
  const double angle = kPi * row / height_;
  return {std::sin(angle), std::cos(angle)};
}

SphereGrid::Turn SphereGrid::longitude(double column) const {
  const double angle = 2 * kPi * (0.5 - column / width_);
  return {std::sin(angle), std::cos(angle)};
}

double SphereGrid::solid_angle_density(const Turn& polar_angle) const {
  return 2 * kPi / width_ * kPi / height_ * polar_angle.sine;
}

Vec3 SphereGrid::direction_at(double column, double row) const {
  if (layout_ == Layout::kLatLong) return direction_at(polar_angle(row), longitude(column));
  if (layout_ == Layout::kAngular) {
    const double u = 1 - 2 * column / width_, v = 1 - 2 * row / height_, r = std::hypot(u, v);
    if (r < 1e-12) return {0, 0, 1};
    const double angle = kPi * std::min(r, 1.0), scale = std::sin(angle) / r;
    return {scale * u, scale * v, std::cos(angle)};
  }
  const int face = std::clamp(static_cast<int>(std::floor(row / width_)), 0, 5);
  return cube_direction(face, face_coordinate(column) + 1, face_coordinate(row - face * width_) + 1, 2);
}

// On a face at distance 1 the density of solid angle is (1 + s^2 + t^2)^(-3/2); on the disc, with the angle pi r from
// its middle, sin(pi r) pi / r for each unit of area.
double SphereGrid::solid_angle_density(double column, double row) const {
  if (layout_ == Layout::kLatLong) return solid_angle_density(polar_angle(row));
  if (layout_ == Layout::kAngular) {
    const double r = std::hypot(1 - 2 * column / width_, 1 - 2 * row / height_);
    if (r >= 1) return 0;
    return 4.0 / width_ / height_ * kPi * (r < 1e-9 ? kPi : std::sin(kPi * r) / r);
  }
  const double face_row = row - std::floor(row / width_) * width_;
  const double s = face_coordinate(column), t = face_coordinate(face_row);
  const double norm2 = 1 + s * s + t * t;
  return face_slope(column) * face_slope(face_row) / (norm2 * std::sqrt(norm2));
}

// Half the way along a meridian and half the way along the longest parallel is a bound on any lat-long cell; a cell of
// a face is a spherical quadrilateral, farthest at a corner; unrolling the disc stretches nothing beyond pi.
double SphereGrid::radius_rad(double column0, double row0, double column1, double row1) const {
  if (layout_ == Layout::kLatLong) {
    const double up = kPi * (row1 - row0) / (2 * height_), middle = kPi * (row0 + row1) / (2 * height_);
    const double ring = std::fabs(middle - kPi / 2) < up ? 1 : std::max(std::sin(middle - up), std::sin(middle + up));
    return std::min(kPi, up + ring * kPi * (column1 - column0) / width_);
  }
  if (layout_ == Layout::kAngular) return kPi * std::hypot((column1 - column0) / width_, (row1 - row0) / height_);
  const double face = std::floor(row0 / width_) * width_;
  const double s0 = face_coordinate(column0), s1 = face_coordinate(column1);
  const double t0 = face_coordinate(row0 - face), t1 = face_coordinate(row1 - face);
  // direction_at() the middle of the position, which is the middle of the cell but where a cell is halved at an edge.
  const Vec3 middle = normalized({(s0 + s1) / 2, (t0 + t1) / 2, 1});
  double farthest = 0;
  for (const double s : {s0, s1})
    for (const double t : {t0, t1}) {
      const Vec3 corner = normalized({s, t, 1});
      farthest = std::max(farthest, std::atan2(length(cross(middle, corner)), dot(middle, corner)));
    }
  return farthest;
}

double SphereGrid::largest_texel_rad() const {
  switch (layout_) {
    case Layout::kLatLong:
      return std::max(2 * kPi / width_, kPi / height_);
    case Layout::kCube:
      return 2.0 / width_;
    case Layout::kCubeEdges:
      return 2.0 / (width_ - 1);
    case Layout::kAngular:
      return 2 * kPi / width_;
  }
  return kPi;
}

GridPosition SphereGrid::position(const Vec3& d) const {
  if (layout_ == Layout::kLatLong) {
    const double longitude = std::atan2(d.x, d.z), theta = std::atan2(std::hypot(d.x, d.z), d.y);
    return {width_ * (0.5 - longitude / (2 * kPi)), height_ * theta / kPi};
  }
  if (layout_ == Layout::kAngular) {
    const double ring = std::hypot(d.x, d.y), scale = ring > 0 ? std::atan2(ring, d.z) / (kPi * ring) : 0;
    return {width_ * (1 - scale * d.x) / 2, height_ * (1 - scale * d.y) / 2};
  }
  const auto inside = [this](double x) { return std::clamp(x, 0.0, std::nextafter(width_, 0)); };
  if (layout_ == Layout::kCube) {
    const CubePosition p = cube_position(d, width_);
    return {inside(p.column), p.face * width_ + inside(p.row)};
  }
  // The outermost cells are half as wide.
  const double last = width_ - 1;
  const CubePosition p = cube_position(d, width_ - 1);
  const auto cell = [&](double x) {
    return inside(x < 0.5 ? 2 * x : x > last - 0.5 ? last + 2 * (x - last + 0.5) : x + 0.5);
  };
  return {cell(p.column), p.face * width_ + cell(p.row)};
}

int SphereGrid::texel(const Vec3& d) const {
  const GridPosition p = position(d);
  const auto inside = [](double x, int n) { return std::clamp(static_cast<int>(std::floor(x)), 0, n - 1); };
  return inside(p.row, height_) * width_ + inside(p.column, width_);
}

// A cube's texels are the alternating sums of its corners, each of which four of them share.
SolidAngles::SolidAngles(const SphereGrid& grid) {
  const auto width = static_cast<std::size_t>(grid.width());
  if (grid.layout() == SphereGrid::Layout::kLatLong) {
    rows_ = grid.height(), row_step_ = 1;
    for (int row = 0; row < rows_; ++row) values_.push_back(grid.solid_angle(0, row));
    return;
  }
  rows_ = grid.is_cube() ? grid.width() : grid.height();
  row_step_ = width, column_step_ = 1;
  values_.resize(width * static_cast<std::size_t>(rows_));
  std::vector<double> corners((width + 1) * (width + 1));
  for (std::size_t j = 0; grid.is_cube() && j <= width; ++j)
    for (std::size_t i = 0; i <= width; ++i)
      corners[j * (width + 1) + i] = cube_corner_solid_angle(grid.face_coordinate(static_cast<double>(i)),
                                                             grid.face_coordinate(static_cast<double>(j)));
  for (std::size_t row = 0; row < static_cast<std::size_t>(rows_); ++row)
    for (std::size_t column = 0; column < width; ++column) {
      const double* upper = &corners[row * (width + 1) + column];
      values_[row * width + column] = grid.is_cube()
                                          ? upper[0] - upper[1] - upper[width + 1] + upper[width + 2]
                                          : grid.solid_angle(static_cast<int>(column), static_cast<int>(row));
    }
}

}  // namespace goniochrome::envmap
