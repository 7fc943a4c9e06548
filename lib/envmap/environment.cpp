#include "envmap/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace goniochrome {

namespace {
constexpr double kPi = std::numbers::pi;
}

// A cube whose texel centers lie on the face edges has its cell edges half way between them, at (i-.5)/(N-1), and at
// the face edges.
double Environment::face_coordinate(double position) const {
  if (layout_ == Layout::kCube) return 2 * position / width_ - 1;
  const double last = width_ - 1;
  const double whole = std::clamp(std::floor(position), 0.0, last), part = position - whole;
  const double low = std::clamp(whole - 0.5, 0.0, last), high = std::clamp(whole + 0.5, 0.0, last);
  return 2 * (low + part * (high - low)) / last - 1;
}

double Environment::face_slope(double position) const {
  const double whole = std::clamp(std::floor(position), 0.0, width_ - 1.0);
  return face_coordinate(whole + 1) - face_coordinate(whole);
}

// A lat-long cell between the polar angles t0 < t1: dphi (cos t0 - cos t1), as a product so that nothing cancels.
double Environment::solid_angle(double column0, double row0, double column1, double row1) const {
  if (layout_ == Layout::kLatLong) {
    const double middle = kPi * (row0 + row1) / (2 * height_), half = kPi * (row1 - row0) / (2 * height_);
    return 2 * kPi * (column1 - column0) / width_ * 2 * std::sin(middle) * std::sin(half);
  }
  const double face = std::floor(row0 / width_) * width_;
  return cube_cell_solid_angle(face_coordinate(column0), face_coordinate(column1), face_coordinate(row0 - face),
                               face_coordinate(row1 - face));
}

Vec3 Environment::direction_at(double column, double row) const {
  if (layout_ == Layout::kLatLong) {
    const double theta = kPi * row / height_, longitude = 2 * kPi * (0.5 - column / width_);
    const double ring = std::sin(theta);
    return {ring * std::sin(longitude), std::cos(theta), ring * std::cos(longitude)};
  }
  const int face = std::clamp(static_cast<int>(std::floor(row / width_)), 0, 5);
  return cube_direction(face, face_coordinate(column) + 1, face_coordinate(row - face * width_) + 1, 2);
}

// On a face at distance 1 the density of solid angle is (1 + s^2 + t^2)^(-3/2).
double Environment::solid_angle_density(double column, double row) const {
  if (layout_ == Layout::kLatLong) return 2 * kPi / width_ * kPi / height_ * std::sin(kPi * row / height_);
  const double face_row = row - std::floor(row / width_) * width_;
  const double s = face_coordinate(column), t = face_coordinate(face_row);
  const double norm2 = 1 + s * s + t * t;
  return face_slope(column) * face_slope(face_row) / (norm2 * std::sqrt(norm2));
}

// Half the way along a meridian and half the way along the longest parallel is a bound on any lat-long cell; a cell of
// a face is a spherical quadrilateral, farthest at a corner.
double Environment::radius_rad(double column0, double row0, double column1, double row1) const {
  if (layout_ == Layout::kLatLong) {
    const double up = kPi * (row1 - row0) / (2 * height_), middle = kPi * (row0 + row1) / (2 * height_);
    const double ring = std::fabs(middle - kPi / 2) < up ? 1 : std::max(std::sin(middle - up), std::sin(middle + up));
    return std::min(kPi, up + ring * kPi * (column1 - column0) / width_);
  }
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

double Environment::largest_texel_rad() const {
  switch (layout_) {
    case Layout::kLatLong:
      return std::max(2 * kPi / width_, kPi / height_);
    case Layout::kCube:
      return 2.0 / width_;
    case Layout::kCubeEdges:
      return 2.0 / (width_ - 1);
  }
  return kPi;
}

const float* Environment::lookup(const Vec3& d) const {
  const auto inside = [](double x, int n) { return std::clamp(static_cast<int>(std::floor(x)), 0, n - 1); };
  if (layout_ == Layout::kLatLong) {
    const double longitude = std::atan2(d.x, d.z), theta = std::atan2(std::hypot(d.x, d.z), d.y);
    return radiance(inside(width_ * (0.5 - longitude / (2 * kPi)), width_), inside(height_ * theta / kPi, height_));
  }
  if (layout_ == Layout::kCube) {
    const CubePosition p = cube_position(d, width_);
    return radiance(inside(p.column, width_), p.face * width_ + inside(p.row, width_));
  }
  const CubePosition p = cube_position(d, width_ - 1);
  return radiance(inside(p.column + 0.5, width_), p.face * width_ + inside(p.row + 0.5, width_));
}

Environment Environment::clipped(float most) const {
  Environment rest = *this;
  for (std::size_t i = 0; i < rest.rgb_.size(); i += 3) {
    float* rgb = &rest.rgb_[i];
    const float largest = std::max({rgb[0], rgb[1], rgb[2]});
    if (largest > most)
      for (int c = 0; c < 3; ++c) rgb[c] *= most / largest;
  }
  return rest;
}

Vec3 Environment::flux() const {
  std::vector<Vec3> rows(static_cast<std::size_t>(height_));
  parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
      double area = solid_angle(0, y);  // of every texel of a lat-long row
      for (int column = 0; column < width_; ++column) {
        if (layout_ != Layout::kLatLong) area = solid_angle(column, y);
        const float* rgb = radiance(column, y);
        rows[row] += area * Vec3{rgb[0], rgb[1], rgb[2]};
      }
    }
  });
  Vec3 sum;
  for (const Vec3& row : rows) sum += row;
  return sum;
}

}  // namespace goniochrome
