#include "envmap/mirror.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/parallel.h"

namespace goniochrome {

namespace {

constexpr double kPi = std::numbers::pi;

struct FaceCell {
  int face;
  double s0, s1, t0, t1;
};

// In the frame of a face: the direction (s,t) as x, y, z up to length.
Vec3 on_face(int face, double s, double t) {
  return cube_direction(face, s + 1, t + 1, 2);
}

double azimuth_of(const Vec3& d) {
  return std::atan2(d.x, -d.z);
}

// The meridian at an azimuth crosses a cell from cos(polar angle) = high down to low. On a side face a meridian is a
// column, s fixed; on top and bottom it is a ray from the middle.
struct Crossing {
  double low = 0, high = 0;
};
Crossing crossing(const FaceCell& cell, double azimuth) {
  const double sine = std::sin(azimuth), cosine = std::cos(azimuth);  // direction (r sine, y, -r cosine)
  if (cell.face / 2 != 1) {
    // Ends of the column: y = -t where the distance from the axis is 1/|component along the face's normal|.
    const double normal = cell.face == 0 ? sine : cell.face == 1 ? -sine : cell.face == 4 ? -cosine : cosine;
    const double ring = 1 / normal;
    const auto height = [ring](double t) { return -t / std::sqrt(ring * ring + t * t); };
    return {height(cell.t1), height(cell.t0)};
  }
  // Top: (s,t) = r (sine, -cosine); bottom: r (sine, cosine).
  const double along_s = sine, along_t = cell.face == 2 ? -cosine : cosine;
  double near = 0, far = 2;
  const auto clip = [&](double along, double a, double b) {
    if (std::fabs(along) < 1e-15) {
      if (a > 0 || b < 0) far = -1;
      return;
    }
    near = std::max(near, std::min(a / along, b / along));
    far = std::min(far, std::max(a / along, b / along));
  };
  clip(along_s, cell.s0, cell.s1);
  clip(along_t, cell.t0, cell.t1);
  if (far <= near) return {};
  const auto height = [](double r) { return 1 / std::sqrt(1 + r * r); };
  return cell.face == 2 ? Crossing{height(far), height(near)} : Crossing{-height(near), -height(far)};
}

// Where the edge of a cell meets the parallels of the map's rows, as azimuths. On a side face the edge t is at
// tan(polar angle) = -ring/t, ring = 1/cos(azimuth - face); on top and bottom an edge at distance c from the middle
// meets the circle of radius R where the cosine to the edge's normal is c/R.
void add_row_breaks(const FaceCell& cell, int rows, double first, double last, std::vector<double>& breaks) {
  const auto add = [&](double azimuth) {
    const double turned = first + std::remainder(azimuth - first - kPi, 2 * kPi) + kPi;
    if (turned > first && turned < last) breaks.push_back(turned);
  };
  const auto each_row_between = [&](double theta0, double theta1, const auto& body) {
    const double low = std::min(theta0, theta1) / kPi * rows, high = std::max(theta0, theta1) / kPi * rows;
    for (int row = std::max(1, static_cast<int>(std::floor(low)));
         row <= std::min(rows - 1, static_cast<int>(std::ceil(high))); ++row)
      body(kPi * row / rows);
  };
  if (cell.face / 2 != 1) {
    const double middle = azimuth_of(on_face(cell.face, 0, 0));
    const double nearest = cell.s0 < 0 && cell.s1 > 0 ? 0 : std::min(std::fabs(cell.s0), std::fabs(cell.s1));
    const double farthest = std::max(std::fabs(cell.s0), std::fabs(cell.s1));
    for (const double t : {cell.t0, cell.t1})
      each_row_between(std::atan2(std::hypot(1, nearest), -t), std::atan2(std::hypot(1, farthest), -t),
                       [&](double theta) {
                         const double ring = -t * std::tan(theta);
                         if (!(ring >= 1)) return;
                         add(middle + std::acos(1 / ring));
                         add(middle - std::acos(1 / ring));
                       });
    return;
  }
  const auto edge = [&](double c, double side0, double side1, double normal) {
    const double nearest = side0 < 0 && side1 > 0 ? 0 : std::min(std::fabs(side0), std::fabs(side1));
    const double farthest = std::max(std::fabs(side0), std::fabs(side1));
    const double down = cell.face == 2 ? 1 : -1;
    each_row_between(std::atan2(std::hypot(c, nearest), down), std::atan2(std::hypot(c, farthest), down),
                     [&](double theta) {
                       const double cosine = c / std::fabs(std::tan(theta));
                       if (std::fabs(cosine) > 1) return;
                       add(normal + std::acos(cosine));
                       add(normal - std::acos(cosine));
                     });
  };
  // The azimuths of the directions of growing s and t.
  const double along_s = kPi / 2, along_t = cell.face == 2 ? kPi : 0;
  for (const double s : {cell.s0, cell.s1}) edge(s, cell.t0, cell.t1, along_s);
  for (const double t : {cell.t0, cell.t1}) edge(t, cell.s0, cell.s1, along_t);
}

// Where the azimuth of a cell begins and ends, and where its corners, the columns of the map and the ends of its rows
// lie between.
void find_azimuth_breaks(const FaceCell& cell, int columns, int rows, std::vector<double>& breaks) {
  const Vec3 middle = on_face(cell.face, (cell.s0 + cell.s1) / 2, (cell.t0 + cell.t1) / 2);
  const bool holds_pole = cell.face / 2 == 1 && cell.s0 < 0 && cell.s1 > 0 && cell.t0 < 0 && cell.t1 > 0;
  const double center = holds_pole ? 0 : azimuth_of(middle);
  breaks.clear();
  double first = holds_pole ? -kPi : 1e9, last = holds_pole ? kPi : -1e9;
  for (const double s : {cell.s0, cell.s1})
    for (const double t : {cell.t0, cell.t1}) {
      if (cell.face / 2 == 1 && std::fabs(s) + std::fabs(t) < 1e-12) continue;  // the pole has no azimuth
      const double azimuth = center + std::remainder(azimuth_of(on_face(cell.face, s, t)) - center, 2 * kPi);
      breaks.push_back(azimuth);
      if (!holds_pole) first = std::min(first, azimuth), last = std::max(last, azimuth);
    }
  const double step = 2 * kPi / columns;
  for (double k = std::ceil(first / step); k * step < last; ++k) breaks.push_back(k * step);
  breaks.push_back(first);
  breaks.push_back(last);
  add_row_breaks(cell, rows, first, last, breaks);
  std::sort(breaks.begin(), breaks.end());
}

// Between two breaks a cell's ends are smooth in the azimuth, and two Gauss points integrate them; along the meridian
// the overlap with each row is exact.
Vec3 lat_long_mean(const Environment& env, const std::vector<double>& row_heights, const FaceCell& cell,
                   std::vector<double>& breaks) {
  find_azimuth_breaks(cell, env.width(), env.height(), breaks);
  Vec3 sum;
  double area = 0;
  for (std::size_t i = 1; i < breaks.size(); ++i) {
    const double width = breaks[i] - breaks[i - 1];
    if (width < 1e-13) continue;
    const double turn = (breaks[i] + breaks[i - 1]) / 2 / (2 * kPi);
    const int column = std::clamp(static_cast<int>((turn - std::floor(turn)) * env.width()), 0, env.width() - 1);
    for (const double at : {.21132486540518713, .78867513459481287}) {
      const Crossing c = crossing(cell, breaks[i - 1] + at * width);
      if (c.high <= c.low) continue;
      int row = std::clamp(static_cast<int>(std::acos(std::clamp(c.high, -1.0, 1.0)) / kPi * env.height()), 0,
                           env.height() - 1);
      for (double top = c.high; row < env.height() && top > c.low; ++row) {
        const double bottom = std::max(c.low, row_heights[static_cast<std::size_t>(row) + 1]);
        if (bottom >= top) continue;
        const float* rgb = env.radiance(column, row);
        sum += width / 2 * (top - bottom) * Vec3{rgb[0], rgb[1], rgb[2]};
        area += width / 2 * (top - bottom);
        top = bottom;
      }
    }
  }
  return (1 / area) * sum;
}

// Cells of two cubes overlap in rectangles of the same face.
Vec3 cube_mean(const Environment& env, const FaceCell& cell) {
  const int n = env.width();
  const auto first = [&](double x) {
    int i = std::clamp(static_cast<int>((x + 1) / 2 * n) - 1, 0, n - 1);
    while (i + 1 < n && env.face_coordinate(i + 1) <= x) ++i;
    return i;
  };
  Vec3 sum;
  for (int row = first(cell.t0); row < n && env.face_coordinate(row) < cell.t1; ++row)
    for (int column = first(cell.s0); column < n && env.face_coordinate(column) < cell.s1; ++column) {
      const double s0 = std::max(cell.s0, env.face_coordinate(column));
      const double s1 = std::min(cell.s1, env.face_coordinate(column + 1));
      const double t0 = std::max(cell.t0, env.face_coordinate(row));
      const double t1 = std::min(cell.t1, env.face_coordinate(row + 1));
      const float* rgb = env.radiance(column, cell.face * n + row);
      sum += cube_cell_solid_angle(s0, s1, t0, t1) * Vec3{rgb[0], rgb[1], rgb[2]};
    }
  return (1 / cube_cell_solid_angle(cell.s0, cell.s1, cell.t0, cell.t1)) * sum;
}

}  // namespace

CubeMap mirror_map(const Environment& env, int n) {
  const bool flat = env.layout() == Environment::Layout::kLatLong;
  std::vector<double> row_heights;
  for (int row = 0; row <= env.height(); ++row) row_heights.push_back(std::cos(kPi * row / env.height()));
  CubeMap map(n);
  parallel_for(static_cast<std::size_t>(6 * n), 4, [&](std::size_t begin, std::size_t end) {
    std::vector<double> breaks;
    for (int line = static_cast<int>(begin); line < static_cast<int>(end); ++line)
      for (int column = 0; column < n; ++column) {
        const int face = line / n, row = line % n;
        const FaceCell cell = {face, 2.0 * column / n - 1, 2.0 * (column + 1) / n - 1, 2.0 * row / n - 1,
                               2.0 * (row + 1) / n - 1};
        const Vec3 mean = flat ? lat_long_mean(env, row_heights, cell, breaks) : cube_mean(env, cell);
        for (int c = 0; c < 3; ++c) map.at(face, row, column)[c] = static_cast<float>(mean[c]);
      }
  });
  return map;
}

}  // namespace goniochrome
