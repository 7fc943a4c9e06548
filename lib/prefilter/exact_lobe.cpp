#include "prefilter/exact_lobe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "base/angles.h"
#include "base/parallel.h"
#include "math/quadrature.h"
#include "prefilter/internal/kernel.h"
#include "prefilter/internal/lobe_patch.h"

namespace goniochrome::prefilter {

namespace {

constexpr double kRelative = 1e-8;    // of the pieces that need recursion
constexpr double kEdgeShare = 1e-10;  // of the flux; some 1e3 texels on an edge err at random
constexpr double kCoarse = 0.05;      // rad: texels beyond this are no small patches

// The rule has as many nodes across a texel as a lobe sqrt(E) times narrower than a radian wants: with v = texel
// sqrt(E), two points err by v^4/4320, three by v^6/2e6, four by v^8/1.8e9 times Hermite polynomials of the distance in
// lobe widths; 5 widths out (e^-12 of the peak) that is 1e-7 of the value there at the limits below.
math::GaussRule nodes_for(double texel_rad, double sharpness) {
  const double v = texel_rad * sharpness;
  if (v <= 0.03) return math::gauss_rule(2, 1);
  if (v <= 0.15) return math::gauss_rule(3, 1);
  return math::gauss_rule(4, std::max(1, static_cast<int>(std::ceil(v / 0.4))));
}

// d.w at the middles of a row of texels, quickly: a turn from column to column on a lat-long map, a line on a face.
class RowCosines {
 public:
  RowCosines(const envmap::Environment& env, const Vec3& d, int row)
      : flat_(env.layout() == envmap::Environment::Layout::kLatLong) {
    const Vec3 first = env.direction(0, row);
    if (flat_) {
      const double theta = kPi * (row + 0.5) / env.height();
      level_ = d.y * first.y;
      // Longitude falls by 2 pi/W a column from pi (1 - 1/W) on.
      const double start = kPi * (1 - 1.0 / env.width());
      re_ = std::sin(theta) * (d.z * std::cos(start) + d.x * std::sin(start));
      im_ = std::sin(theta) * (d.z * std::sin(start) - d.x * std::cos(start));
      cosine_ = std::cos(2 * kPi / env.width());
      sine_ = std::sin(2 * kPi / env.width());
    } else {
      env_ = &env, d_ = d, row_ = row;
    }
  }
  // Columns in order.
  double at(int column) {
    if (!flat_) return dot(d_, env_->direction(column, row_));
    const double t = level_ + re_, re = re_ * cosine_ + im_ * sine_;
    im_ = im_ * cosine_ - re_ * sine_;
    re_ = re;
    return t;
  }

 private:
  bool flat_;
  double level_ = 0, re_ = 0, im_ = 0, cosine_ = 1, sine_ = 0;
  const envmap::Environment* env_ = nullptr;
  Vec3 d_;
  int row_ = 0;
};

// The part of itself that a texel which the edge cuts may be off by, so that no more flux than `allowed` is; no less
// than `least`.
double at_edge(const envmap::Environment& env, const envmap::Cell& cell, const float* rgb, const ZonalKernel& kernel,
               double allowed, double least) {
  const double radius = env.radius_rad(cell.column0, cell.row0, cell.column1, cell.row1);
  const double share = std::max({rgb[0], rgb[1], rgb[2]}) *
                       env.solid_angle(cell.column0, cell.row0, cell.column1, cell.row1) * kernel.near_edge(2 * radius);
  return std::clamp(allowed / share, least, 0.1);
}

// The texels of a row whose quadrature the edge of the kernel spoils, summed one by one; rest() is the row without
// them.
class EdgeRow {
 public:
  // `allowed` is the flux that a texel may be off by.
  EdgeRow(const envmap::Environment& env, const Vec3& d, const ZonalKernel& kernel, int row, double allowed) {
    // The band along the edge is this part of the whole: of a sharp cosine lobe, nothing.
    const double radius = env.largest_texel_rad();
    if (!kernel.edge().exists() || 2 * radius * kernel.near_edge(2 * radius) < 1e-11) return;
    const double margin = kernel.bends_beside_edge() ? 4 : 1, edge = kernel.edge().angle_rad;
    RowCosines cosine(env, d, row);
    for (int column = 0; column < env.width(); ++column) {
      const double t = cosine.at(column);
      if (std::fabs(t - kernel.edge().cosine) > margin * radius) continue;
      const double cell = env.radius_rad(column, row, column + 1, row + 1);
      const double theta = envmap::angle_between(d, env.direction(column, row));
      if (theta - cell >= edge || theta + margin * cell <= edge) continue;
      if (rgb_.empty())
        rgb_.assign(env.radiance(0, row), env.radiance(0, row) + 3 * static_cast<std::size_t>(env.width()));
      float* rgb = &rgb_[3 * static_cast<std::size_t>(column)];
      if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) continue;
      const envmap::Cell whole = {double(column), double(row), double(column + 1), double(row + 1)};
      const double k =
          lobe_over_cell(env, whole, d, kernel, kRelative, at_edge(env, whole, rgb, kernel, allowed, 10 * kRelative));
      sum_ += k * Vec3{rgb[0], rgb[1], rgb[2]};
      std::fill(rgb, rgb + 3, 0.0F);
    }
  }
  // The row without them.
  const float* rest(const envmap::Environment& env, int row) const {
    return rgb_.empty() ? env.radiance(0, row) : rgb_.data();
  }
  const Vec3& sum() const { return sum_; }

 private:
  std::vector<float> rgb_;
  Vec3 sum_;
};

// The sum over all texels at any direction; the nodes and their directions are made once.
class Summation {
 public:
  Summation(const envmap::Environment& env, const ZonalKernel& kernel)
      : env_(env),
        kernel_(kernel),
        coarse_(env.layout() == envmap::Environment::Layout::kAngular ||
                env.largest_texel_rad() > std::min(kCoarse, 2 / kernel.sharpness())) {
    const Vec3 flux = env.flux();
    allowed_ = kEdgeShare * std::max({flux.x, flux.y, flux.z, 1e-300}) / (2 * kPi * kernel.scale());
    if (coarse_) return;
    nodes_ = nodes_for(env.largest_texel_rad(), kernel.sharpness());
    const std::size_t n = static_cast<std::size_t>(env.width());
    for (std::size_t k = 0; k < nodes_.at.size(); ++k) {
      std::vector<double> a(n), b(n);
      for (std::size_t j = 0; j < n; ++j) {
        const double column = static_cast<double>(j) + nodes_.at[k];
        if (env.layout() == envmap::Environment::Layout::kLatLong) {
          a[j] = std::sin(2 * kPi * (0.5 - column / env.width()));
          b[j] = std::cos(2 * kPi * (0.5 - column / env.width()));
        } else {
          a[j] = env.grid().face_coordinate(column);
          b[j] = env.grid().face_slope(column);
        }
      }
      first_.push_back(std::move(a));
      second_.push_back(std::move(b));
    }
  }

  // Row by row. Step 1: rows beyond the support add nothing. Step 2: the texels that the edge spoils, one by one. Step
  // 3: the rest of the row, summed at every node of the quadrature across its texels.
  Vec3 at(const Vec3& d) const {
    Vec3 sum;
    const bool flat = env_.layout() == envmap::Environment::Layout::kLatLong;
    const double support = kernel_.support_rad(), theta_d = std::atan2(std::hypot(d.x, d.z), d.y);
    for (int row = 0; row < env_.height(); ++row) {
      if (flat && std::fabs((row + 0.5) * kPi / env_.height() - theta_d) > support + kPi / env_.height()) continue;
      if (coarse_) {
        sum += recursive_row(d, row);
        continue;
      }
      const EdgeRow edge(env_, d, kernel_, row, allowed_);
      sum += edge.sum();
      for (std::size_t j = 0; j < nodes_.at.size(); ++j)
        sum += flat ? lat_long_row(d, row, edge.rest(env_, row), j) : cube_row(d, row, edge.rest(env_, row), j);
    }
    return kernel_.scale() * sum;
  }

 private:
  Vec3 recursive_row(const Vec3& d, int row) const {
    Vec3 sum;
    for (int column = 0; column < env_.width(); ++column) {
      const float* rgb = env_.radiance(column, row);
      if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) continue;
      const envmap::Cell cell = {double(column), double(row), column + 1.0, row + 1.0};
      sum += lobe_over_cell(env_, cell, d, kernel_, kRelative,
                            at_edge(env_, cell, rgb, kernel_, allowed_, 100 * kRelative)) *
             Vec3{rgb[0], rgb[1], rgb[2]};
    }
    return sum;
  }

  Vec3 lat_long_row(const Vec3& d, int row, const float* rgb, std::size_t j) const {
    const double theta = kPi * (row + nodes_.at[j]) / env_.height(), ring = std::sin(theta);
    const double weight = nodes_.weight[j] * ring * kPi / env_.height() * 2 * kPi / env_.width();
    Vec3 sum;
    for (std::size_t i = 0; i < nodes_.at.size(); ++i) {
      double rgb_sum[3] = {0, 0, 0};
      kernel_.add_lat_long_row(rgb, static_cast<std::size_t>(env_.width()), first_[i].data(), second_[i].data(),
                               d.y * std::cos(theta), d.x * ring, d.z * ring, rgb_sum);
      sum += weight * nodes_.weight[i] * Vec3{rgb_sum[0], rgb_sum[1], rgb_sum[2]};
    }
    return sum;
  }

  Vec3 cube_row(const Vec3& d, int row, const float* rgb, std::size_t j) const {
    const int n = env_.width(), face = row / n;
    const double at = row % n + nodes_.at[j], t = env_.grid().face_coordinate(at);
    // The face's frame: its middle, and its column and row axes as OpenGL has them.
    const Vec3 middle = envmap::cube_direction(face, 1, 1, 2);
    const Vec3 s_axis = std::sqrt(2.0) * envmap::cube_direction(face, 2, 1, 2) - middle;
    const Vec3 t_axis = std::sqrt(2.0) * envmap::cube_direction(face, 1, 2, 2) - middle;
    const double weight = nodes_.weight[j] * env_.grid().face_slope(at);
    Vec3 sum;
    for (std::size_t i = 0; i < nodes_.at.size(); ++i) {
      double rgb_sum[3] = {0, 0, 0};
      kernel_.add_cube_row(rgb, static_cast<std::size_t>(n), first_[i].data(), second_[i].data(),
                           dot(d, middle + t * t_axis), dot(d, s_axis), 1 + t * t, rgb_sum);
      sum += weight * nodes_.weight[i] * Vec3{rgb_sum[0], rgb_sum[1], rgb_sum[2]};
    }
    return sum;
  }

  const envmap::Environment& env_;
  const ZonalKernel& kernel_;
  bool coarse_;         // texels so large or odd, or a lobe so narrow, that every texel is done by recursion
  double allowed_ = 0;  // flux that a texel on the edge may be off by
  math::GaussRule nodes_;
  std::vector<std::vector<double>> first_, second_;  // lat-long: sin and cos of the longitude; cube: s and ds/dcolumn
};

Vec3 mean_of(const envmap::SphereGrid& grid, const std::vector<float>& texels) {
  Vec3 sum;
  const float* rgb = texels.data();
  const envmap::SolidAngles solid_angles(grid);
  for (int row = 0; row < grid.height(); ++row)
    for (int column = 0; column < grid.width(); ++column, rgb += 3)
      sum += solid_angles.at(column, row) * Vec3{rgb[0], rgb[1], rgb[2]};
  return (1 / (4 * kPi)) * sum;
}

// The texels to look at: random ones, and the brightest and the darkest by the sum of their channels.
std::vector<std::size_t> chosen_texels(const envmap::CubeMap& map, int count, int extremes, std::uint64_t seed) {
  const std::size_t texels = map.texels.size() / 3;
  std::vector<std::size_t> chosen;
  std::mt19937_64 random(seed);
  for (int i = 0; i < count; ++i) chosen.push_back(random() % texels);
  if (extremes <= 0) return chosen;
  const std::size_t each = std::min(texels, static_cast<std::size_t>(extremes));
  std::vector<std::size_t> order(texels);
  for (std::size_t i = 0; i < texels; ++i) order[i] = i;
  const auto value = [&](std::size_t i) { return map.texels[3 * i] + map.texels[3 * i + 1] + map.texels[3 * i + 2]; };
  const auto darker = [&](std::size_t a, std::size_t b) { return value(a) != value(b) ? value(a) < value(b) : a < b; };
  std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(each - 1), order.end(), darker);
  chosen.insert(chosen.end(), order.begin(), order.begin() + static_cast<std::ptrdiff_t>(each));
  std::nth_element(order.begin(), order.end() - static_cast<std::ptrdiff_t>(each), order.end(), darker);
  chosen.insert(chosen.end(), order.end() - static_cast<std::ptrdiff_t>(each), order.end());
  return chosen;
}

// The mean radiance over parts of a texel, found by looking alone: a part is quartered until its corners and middle see
// one texel, or two that a line parts; where the line meets the sides is found by bisection.
class MirrorSearch {
 public:
  MirrorSearch(const envmap::Environment& env, const envmap::SphereGrid& grid, const envmap::Rotation& turn)
      : env_(env), grid_(grid), turn_(turn) {}

  // The integral over columns s0..s1 and rows t0..t1 within one texel. Step 1: what the middle and the corners see.
  // Step 2: all the same, or so deep that it does not matter: the part is done. Step 3: one line through it: both sides
  // by their areas. Step 4: else its quarters.
  Vec3 integral(double s0, double t0, double s1, double t1, int depth) const {
    // A texel's corner may lie unseen between the five points of a larger part, and edges bend.
    constexpr int kLeast = 7, kMost = 20;
    const double s = (s0 + s1) / 2, t = (t0 + t1) / 2;
    const double area = grid_.solid_angle(s0, t0, s1, t1);
    // Just inside: an edge of the part may be an edge of a texel. Around: (s0,t0) (s1,t0) (s1,t1) (s0,t1).
    const double i = (1 - 1e-9) * (s1 - s), j = (1 - 1e-9) * (t1 - t);
    const std::array<std::array<double, 2>, 4> corner = {
        {{s - i, t - j}, {s + i, t - j}, {s + i, t + j}, {s - i, t + j}}};
    const float* middle = seen({s, t});
    std::array<const float*, 4> sees;
    for (std::size_t k = 0; k < 4; ++k) sees[k] = seen(corner[k]);
    const auto same = [&](const float* rgb) { return std::count(sees.begin(), sees.end(), rgb); };
    if (depth >= kMost || (depth >= kLeast && same(middle) == 4)) return area * vec3(middle);
    // One corner, or two neighbors, on the far side of a line.
    const float* other = nullptr;
    for (const float* rgb : sees)
      if (rgb != middle) other = rgb;
    const bool two = depth >= kLeast && other && same(middle) + same(other) == 4;
    const bool crossed = two && same(other) == 2 && sees[0] == sees[2];
    if (two && !crossed && same(other) <= 2) {
      const double part = far_part(corner, sees, other);
      return area * ((1 - part) * vec3(middle) + part * vec3(other));
    }
    return integral(s0, t0, s, t, depth + 1) + integral(s, t0, s1, t, depth + 1) + integral(s0, t, s, t1, depth + 1) +
           integral(s, t, s1, t1, depth + 1);
  }

 private:
  const float* seen(const std::array<double, 2>& at) const {
    return env_.lookup(turn_.to_environment(grid_.direction_at(at[0], at[1])));
  }

  // The part (of solid angle) on the side of `other`: its corners and the crossings of the sides as a polygon.
  double far_part(const std::array<std::array<double, 2>, 4>& corner, const std::array<const float*, 4>& sees,
                  const float* other) const {
    constexpr std::array<std::array<double, 2>, 4> kUnit = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
    std::vector<std::array<double, 2>> polygon;
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t next = (k + 1) % 4;
      if (sees[k] == other) polygon.push_back(kUnit[k]);
      if ((sees[k] == other) == (sees[next] == other)) continue;
      double low = 0, high = 1;
      const auto between = [&](const auto& points, double x) {
        return std::array<double, 2>{points[k][0] + x * (points[next][0] - points[k][0]),
                                     points[k][1] + x * (points[next][1] - points[k][1])};
      };
      for (int step = 0; step < 24; ++step) {
        const double x = (low + high) / 2;
        ((seen(between(corner, x)) == other) == (sees[k] == other) ? low : high) = x;
      }
      polygon.push_back(between(kUnit, (low + high) / 2));
    }
    double part = 0, x = 0, y = 0;  // area and first moments
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const auto &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
      const double wedge = (a[0] * b[1] - a[1] * b[0]) / 2;
      part += wedge, x += wedge * (a[0] + b[0]) / 3, y += wedge * (a[1] + b[1]) / 3;
    }
    // Each side weighs what the density of solid angle is at its centroid.
    const auto weight = [&](double share, double mx, double my) {
      if (share < 1e-12) return 0.0;
      return share * grid_.solid_angle_density(corner[0][0] + mx / share * (corner[2][0] - corner[0][0]),
                                               corner[0][1] + my / share * (corner[2][1] - corner[0][1]));
    };
    const double far = weight(part, x, y), near = weight(1 - part, 0.5 - x, 0.5 - y);
    return far / (far + near);
  }

  const envmap::Environment& env_;
  const envmap::SphereGrid& grid_;
  const envmap::Rotation& turn_;
};

// The error of some texels of a map against truth(column, row).
template <class Truth>
LobeError map_error(const envmap::PrefilteredLobe& lobe, const envmap::SphereGrid& grid, int count, int extremes,
                    std::uint64_t seed, const Truth& truth) {
  const envmap::CubeMap& map = lobe.map;
  const std::vector<std::size_t> texels = chosen_texels(map, count, extremes, seed);
  const Vec3 mean = mean_of(grid, map.texels);
  const double gray = std::max({mean.x, mean.y, mean.z});
  std::vector<double> errors(texels.size());
  parallel_for(texels.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t index = texels[i], width = static_cast<std::size_t>(grid.width());
      const int column = static_cast<int>(index % width), row = static_cast<int>(index / width);
      const Vec3 wanted = truth(column, row);
      for (int c = 0; c < 3; ++c) {
        const double scale = std::max({wanted[c], kErrorFloor * mean[c], kErrorFloor * kErrorFloor * gray, 1e-300});
        errors[i] = std::max(errors[i], std::fabs(map.texels[3 * index + c] - wanted[c]) / scale);
      }
    }
  });
  LobeError result;
  result.texels = static_cast<int>(errors.size());
  for (const double error : errors) {
    result.max = std::max(result.max, error);
    result.mean += error / static_cast<double>(errors.size());
  }
  return result;
}

}  // namespace

Vec3 reference_lobe(const envmap::Environment& env, const Vec3& d, double exponent) {
  if (!paint::is_mirror(exponent)) return reference_lobe(env, d, CosineKernel(exponent));
  return vec3(env.lookup(d));
}

Vec3 reference_lobe(const envmap::Environment& env, const Vec3& d, const ZonalKernel& kernel) {
  return Summation(env, kernel).at(d);
}

Vec3 reference_mirror(const envmap::Environment& env, const envmap::SphereGrid& grid, const envmap::Rotation& turn,
                      int column, int row) {
  return (1 / grid.solid_angle(column, row)) *
         MirrorSearch(env, grid, turn).integral(column, row, column + 1, row + 1, 0);
}

LobeError lobe_error(const envmap::Environment& env, const envmap::PrefilteredLobe& lobe, int count, int extremes,
                     std::uint64_t seed, const envmap::Rotation& turn) {
  if (!lobe.is_mirror()) return lobe_error(env, lobe, CosineKernel(lobe.exponent), count, extremes, seed, turn);
  const envmap::SphereGrid grid = envmap::map_grid(lobe.layout, lobe.map.size);
  return map_error(lobe, grid, count, extremes, seed,
                   [&](int column, int row) { return reference_mirror(env, grid, turn, column, row); });
}

LobeError lobe_error(const envmap::Environment& env, const envmap::PrefilteredLobe& lobe, const ZonalKernel& kernel,
                     int count, int extremes, std::uint64_t seed, const envmap::Rotation& turn) {
  const envmap::SphereGrid grid = envmap::map_grid(lobe.layout, lobe.map.size);
  const Summation summation(env, kernel);
  return map_error(lobe, grid, count, extremes, seed,
                   [&](int column, int row) { return summation.at(turn.to_environment(grid.direction(column, row))); });
}

}  // namespace goniochrome::prefilter
