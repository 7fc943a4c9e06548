#include "prefilter/internal/overlap.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "envmap/cube_map.h"
#include "math/quadrature.h"

namespace goniochrome::prefilter {

namespace {

double azimuth_of(const Vec3& d) {
  return std::atan2(d.x, -d.z);
}

// The inward normals of the sides; zero where two corners are one.
std::array<Vec3, 4> sides_of(const SphereQuad& cell) {
  const Vec3 middle = cell[0] + cell[1] + cell[2] + cell[3];
  std::array<Vec3, 4> sides;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 normal = cross(cell[i], cell[(i + 1) % 4]);
    sides[i] = dot(normal, middle) < 0 ? -normal : normal;
    if (dot(normal, normal) < 1e-28) sides[i] = {};
  }
  return sides;
}

// The solid angle of the triangle seen through three points of a plane that misses the origin.
double triangle_solid_angle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double la = length(a), lb = length(b), lc = length(c);
  return 2 *
         std::atan2(std::fabs(dot(a, cross(b, c))), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

Vec3 mix(const Vec3& a, const Vec3& b, double x) {
  return (1 - x) * a + x * b;
}
envmap::GridPosition mix(const envmap::GridPosition& a, const envmap::GridPosition& b, double x) {
  return {(1 - x) * a.column + x * b.column, (1 - x) * a.row + x * b.row};
}

// The part of a polygon where `value`, which is linear, is not negative.
template <class P, class Value>
std::vector<P> clipped(const std::vector<P>& polygon, const Value& value) {
  std::vector<P> left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const P &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double va = value(a), vb = value(b);
    if (va >= 0) left.push_back(a);
    if ((va >= 0) != (vb >= 0)) left.push_back(mix(a, b, va / (va - vb)));
  }
  return left;
}

using Polygon = std::vector<envmap::GridPosition>;

// Calls emit(column, row, part) for the parts of a polygon that lie in one cell: cell i reaches from edge(i) to
// edge(i+1) both ways, i < n, and cell_of() finds it.
template <class Edge, class CellOf, class Emit>
void cut_into_cells(const Polygon& polygon, int n, const Edge& edge, const CellOf& cell_of, const Emit& emit) {
  const auto range = [&](const Polygon& from, double envmap::GridPosition::*coordinate) {
    double low = 1e9, high = -1e9;
    for (const envmap::GridPosition& p : from) low = std::min(low, p.*coordinate), high = std::max(high, p.*coordinate);
    return std::array<int, 2>{std::clamp(cell_of(low), 0, n - 1), std::clamp(cell_of(high), 0, n - 1)};
  };
  const auto between = [&](const Polygon& from, double envmap::GridPosition::*coordinate, int cell) {
    const double low = edge(cell), high = edge(cell + 1);
    return clipped(clipped(from, [&](const envmap::GridPosition& p) { return p.*coordinate - low; }),
                   [&](const envmap::GridPosition& p) { return high - p.*coordinate; });
  };
  const auto [top, bottom] = range(polygon, &envmap::GridPosition::row);
  for (int row = top; row <= bottom; ++row) {
    const Polygon strip = between(polygon, &envmap::GridPosition::row, row);
    if (strip.size() < 3) continue;
    const auto [left, right] = range(strip, &envmap::GridPosition::column);
    for (int column = left; column <= right; ++column) {
      const Polygon part = between(strip, &envmap::GridPosition::column, column);
      if (part.size() >= 3) emit(column, row, part);
    }
  }
}

}  // namespace

OverlapFinder::OverlapFinder(const envmap::SphereGrid& grid) : grid_(grid) {
  if (grid.layout() == envmap::SphereGrid::Layout::kLatLong)
    for (int row = 0; row <= grid.height(); ++row) row_heights_.push_back(std::cos(kPi * row / grid.height()));
}

const std::vector<Overlap>& OverlapFinder::of(const SphereQuad& cell) {
  found_.clear();
  if (grid_.is_cube())
    over_cube(cell);
  else if (grid_.layout() == envmap::SphereGrid::Layout::kLatLong)
    over_lat_long(cell);
  else
    over_disc(cell, 0);
  return found_;
}

// Where the azimuth of the cell begins and ends, and where its corners, the columns of the map and the crossings of its
// sides with the parallels between rows lie between. The side of normal n meets the parallel at the polar angle t where
// |(nx,nz)| cos(p - p0) = -ny cot(t), p0 the azimuth of n.
void OverlapFinder::find_breaks(const SphereQuad& cell, bool holds_pole) {
  const double center = holds_pole ? 0 : azimuth_of(cell[0] + cell[1] + cell[2] + cell[3]);
  double first = holds_pole ? -kPi : 1e9, last = holds_pole ? kPi : -1e9;
  double highest = kPi, lowest = 0, widest = 0;  // polar angles; the longest side
  breaks_.clear();
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 &d = cell[i], &next = cell[(i + 1) % 4];
    const double ring = std::hypot(d.x, d.z), theta = std::atan2(ring, d.y);
    highest = std::min(highest, theta), lowest = std::max(lowest, theta);
    widest = std::max(widest, length(next - d));
    if (ring < 1e-12) continue;  // the pole has no azimuth
    const double azimuth = center + std::remainder(azimuth_of(d) - center, 2 * kPi);
    breaks_.push_back(azimuth);
    if (!holds_pole) first = std::min(first, azimuth), last = std::max(last, azimuth);
  }
  const double step = 2 * kPi / grid_.width();
  for (double k = std::ceil(first / step); k * step < last; ++k) breaks_.push_back(k * step);
  // A side of length w bends away from its ends by less than w/2.
  const int rows = grid_.height();
  const int top = std::max(1, static_cast<int>(std::floor((highest - widest / 2) / kPi * rows)));
  const int bottom = std::min(rows - 1, static_cast<int>(std::ceil((lowest + widest / 2) / kPi * rows)));
  const auto add = [&](double azimuth) {
    const double turned = first + std::remainder(azimuth - first - kPi, 2 * kPi) + kPi;
    if (turned > first && turned < last) breaks_.push_back(turned);
  };
  for (const Vec3& normal : sides_of(cell)) {
    const double ring = std::hypot(normal.x, normal.z);
    if (ring < 1e-15) continue;
    const double middle = azimuth_of(normal);
    for (int row = holds_pole ? 1 : top; row <= (holds_pole ? rows - 1 : bottom); ++row) {
      const double height = row_heights_[static_cast<std::size_t>(row)];
      const double cosine = -normal.y * height / (ring * std::sqrt(1 - height * height));
      if (std::fabs(cosine) > 1) continue;
      const double away = std::acos(cosine);
      add(middle + away);
      add(middle - away);
    }
  }
  breaks_.push_back(first);
  breaks_.push_back(last);
  std::sort(breaks_.begin(), breaks_.end());
}

// The meridian at an azimuth lies inside the side of normal n where A sin(t) + B cos(t) >= 0, A = n.(its equator),
// B = n.y: above cos(t) = -A/|(A,B)| for B >= 0, below A/|(A,B)| else.
void OverlapFinder::add_column(double azimuth, double width, const std::array<Vec3, 4>& sides) {
  const Vec3 equator = {std::sin(azimuth), 0, -std::cos(azimuth)};
  double low = -1, high = 1;
  for (const Vec3& n : sides) {
    const double a = dot(n, equator), b = n.y, norm = std::hypot(a, b);
    if (norm == 0) continue;
    if (b >= 0)
      low = std::max(low, -a / norm);
    else
      high = std::min(high, a / norm);
  }
  if (high <= low) return;
  const double turn = azimuth / (2 * kPi);
  const int columns = grid_.width(), rows = grid_.height();
  const int column = std::clamp(static_cast<int>((turn - std::floor(turn)) * columns), 0, columns - 1);
  int row = std::clamp(static_cast<int>(std::acos(std::clamp(high, -1.0, 1.0)) / kPi * rows), 0, rows - 1);
  for (double top = high; row < rows && top > low; ++row) {
    const double bottom = std::max(low, row_heights_[static_cast<std::size_t>(row) + 1]);
    if (bottom >= top) continue;
    found_.push_back({row * columns + column, width * (top - bottom)});
    top = bottom;
  }
}

// Between two breaks the cell's ends are smooth in the azimuth, and two Gauss points integrate them; along the meridian
// the overlap with each row is exact.
void OverlapFinder::over_lat_long(const SphereQuad& cell) {
  const std::array<Vec3, 4> sides = sides_of(cell);
  const auto all = [&](double sign) {
    return std::all_of(sides.begin(), sides.end(), [&](const Vec3& n) { return sign * n.y > 0; });
  };
  find_breaks(cell, all(1) || all(-1));
  for (std::size_t i = 1; i < breaks_.size(); ++i) {
    const double width = breaks_[i] - breaks_[i - 1];
    if (width < 1e-13) continue;
    for (const double at : math::kGaussPair) add_column(breaks_[i - 1] + at * width, width / 2, sides);
  }
}

// Face by face: what of the cell lies in front of it, in the plane of the face, cut at the texels' sides.
void OverlapFinder::over_cube(const SphereQuad& cell) {
  const int n = grid_.width();
  const auto edge = [this](int i) { return grid_.face_coordinate(i); };
  const auto cell_of = [&](double s) {
    const double steps =
        grid_.layout() == envmap::SphereGrid::Layout::kCube ? (s + 1) / 2 * n : (s + 1) / 2 * (n - 1) + 0.5;
    return static_cast<int>(std::floor(steps));
  };
  for (int face = 0; face < 6; ++face) {
    const Vec3 axis = envmap::cube_direction(face, 1, 1, 2);
    const Vec3 across = std::sqrt(2.0) * envmap::cube_direction(face, 2, 1, 2) - axis;
    const Vec3 down = std::sqrt(2.0) * envmap::cube_direction(face, 1, 2, 2) - axis;
    std::vector<Vec3> part(cell.begin(), cell.end());
    for (const Vec3& inward : {axis + across, axis - across, axis + down, axis - down})
      part = clipped(part, [&](const Vec3& d) { return dot(d, inward); });
    if (part.size() < 3) continue;
    Polygon polygon;
    for (const Vec3& d : part) polygon.push_back({dot(d, across) / dot(d, axis), dot(d, down) / dot(d, axis)});
    cut_into_cells(polygon, n, edge, cell_of, [&](int column, int row, const Polygon& piece) {
      const auto on_face = [&](std::size_t i) { return Vec3{piece[i].column, piece[i].row, 1}; };
      double sum = 0;
      for (std::size_t i = 2; i < piece.size(); ++i)
        sum += triangle_solid_angle(on_face(0), on_face(i - 1), on_face(i));
      found_.push_back({(face * n + row) * n + column, sum});
    });
  }
}

// In the image of the probe, the sides in straight pieces. Cells that wrap about the rim are quartered; one about the
// very point behind the probe counts as the texel of its middle.
void OverlapFinder::over_disc(const SphereQuad& cell, int depth) {
  const Vec3 middle = normalized(cell[0] + cell[1] + cell[2] + cell[3]);
  const double behind = std::atan2(std::hypot(middle.x, middle.y), -middle.z);
  const double radius = length(cell[0] - middle) + length(cell[1] - middle);
  if (behind < 2 * radius) {
    if (depth >= 8) {
      const double area =
          triangle_solid_angle(cell[0], cell[1], cell[2]) + triangle_solid_angle(cell[0], cell[2], cell[3]);
      found_.push_back({grid_.texel(middle), area});
      return;
    }
    for (std::size_t i = 0; i < 4; ++i)
      over_disc({cell[i], normalized(cell[i] + cell[(i + 1) % 4]), middle, normalized(cell[i] + cell[(i + 3) % 4])},
                depth + 1);
    return;
  }
  Polygon polygon;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 &from = cell[i], &to = cell[(i + 1) % 4];
    const int pieces = std::max(8, static_cast<int>(std::ceil(length(to - from) / 0.005)));
    for (int k = 0; k < pieces; ++k) polygon.push_back(grid_.position(normalized(mix(from, to, double(k) / pieces))));
  }
  const auto edge = [](int i) { return double(i); };
  const auto cell_of = [](double x) { return static_cast<int>(std::floor(x)); };
  cut_into_cells(polygon, grid_.width(), edge, cell_of, [&](int column, int row, const Polygon& piece) {
    double area = 0, x = 0, y = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      const envmap::GridPosition &a = piece[i], &b = piece[(i + 1) % piece.size()];
      const double wedge = (a.column * b.row - a.row * b.column) / 2;
      area += wedge, x += wedge * (a.column + b.column) / 3, y += wedge * (a.row + b.row) / 3;
    }
    if (std::fabs(area) < 1e-14) return;
    found_.push_back({row * grid_.width() + column, std::fabs(area) * grid_.solid_angle_density(x / area, y / area)});
  });
}

}  // namespace goniochrome::prefilter
