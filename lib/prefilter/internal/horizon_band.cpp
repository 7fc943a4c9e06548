#include "prefilter/internal/horizon_band.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.h"
#include "prefilter/internal/lobe_rows.h"

namespace goniochrome::prefilter {

namespace {

// A texel's change of the cosine along one of its axes is taken as no less than this part of its height. A mean over so
// little more is the same, and the second differences keep nine digits.
constexpr double kLeastChange = 1e-3;

}  // namespace

// A texel beside a pole is much wider at its far end, so that its centroid and not its middle stands for it. Where the
// horizon runs through the poles, the middles would leave a bias of (h^2/12) L^-E of the mean.
HorizonBand::Row HorizonBand::row_of(const envmap::Environment& env, int row) {
  const double from = kPi * row / env.height(), to = kPi * (row + 1) / env.height();
  const double turn = kPi / env.width(), area = std::cos(from) - std::cos(to);  // half of a column
  const double sin_from = std::sin(from), sin_to = std::sin(to);
  const double sine = (to - from - (sin_to * std::cos(to) - sin_from * std::cos(from))) / 2;
  return {sine / area * std::sin(turn) / turn, (sin_to * sin_to - sin_from * sin_from) / 2 / area, 2 * turn * area};
}

HorizonBand::HorizonBand(const envmap::Environment& env, const envmap::Clip& clip)
    : grid_(env.grid()), stride_(static_cast<std::size_t>(env.width()) + rows::kPadding) {
  const std::size_t width = static_cast<std::size_t>(env.width());
  if (grid_.is_cube()) {
    rgb_.resize(3 * stride_ * static_cast<std::size_t>(env.height()));
    parallel_for(static_cast<std::size_t>(env.height()), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t row = begin; row < end; ++row)
        for (std::size_t column = 0; column < width; ++column) {
          const std::array<float, 3> left = clip.left_of(env.radiance(static_cast<int>(column), static_cast<int>(row)));
          std::copy(left.begin(), left.end(), &rgb_[3 * (row * stride_ + column)]);
        }
    });
  } else {
    strips_.emplace(env, clip);
    for (int row = 0; row < env.height(); ++row) rows_.push_back(row_of(env, row));
  }
  for (std::size_t j = 0; j < stride_; ++j) {
    const double column = static_cast<double>(j % width);
    if (grid_.is_cube()) {
      const double low = grid_.face_coordinate(column), slope = grid_.face_slope(column);
      first_.push_back(low + slope / 2), second_.push_back(slope);
    } else {
      const double longitude = 2 * kPi * (0.5 - (column + 0.5) / env.width());
      first_.push_back(std::sin(longitude)), second_.push_back(std::cos(longitude));
    }
  }
}

double HorizonBand::texels_beside(const envmap::Environment& env, double reach) {
  const double across = std::sqrt(4 * kPi / (static_cast<double>(env.width()) * env.height()));
  return 4 * kPi * (reach + 0.7 * across) / (across * across);
}

std::vector<Vec3> HorizonBand::sums(const std::vector<Vec3>& directions, const SecondIntegral& band) const {
  if (band.reach == 0) return std::vector<Vec3>(directions.size());
  if (strips_)
    return strips_->sums(directions,
                         [&](const StripMap::Seat& seat, Strips& strips) { weigh_rows(seat, band, strips); });
  std::vector<Vec3> result(directions.size());
  parallel_for(directions.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      double total[3] = {0, 0, 0};
      add_faces(directions[i], band, total);
      result[i] = {total[0], total[1], total[2]};
    }
  });
  return result;
}

// At the polar angle of a row the cosine is A + B cos q, with q the difference of longitudes: the band is where cos q
// lies between two bounds, on both sides of the direction. Columns run against the longitude.
void HorizonBand::weigh_rows(const StripMap::Seat& seat, const SecondIntegral& band, Strips& strips) const {
  const int width = grid_.width(), height = grid_.height();
  const Vec3& d = seat.d;
  const double row_rad = kPi / height, column_rad = 2 * kPi / width, across = std::hypot(d.x, d.z);
  const double middle = seat.column - 0.5;  // the column that looks along d
  struct Run {
    int row, begin, count;
    std::size_t from;  // of its weights
  };
  thread_local std::vector<Run> runs;
  thread_local std::vector<float> weights;
  thread_local rows::CutTexels cut;
  runs.clear(), cut.count = 0;
  std::size_t used = 0;
  for (int row = 0; row < height; ++row) {
    const auto [ring, level, area] = rows_[static_cast<std::size_t>(row)];
    const double a = d.y * level, b = across * ring;
    // Half of a texel reaches into the band from outside.
    const double margin = 0.5 * (row_rad + ring * column_rad), reach = band.reach + margin;
    if (a + b < -reach || a - b > reach) continue;
    const double near = b > 0 ? std::acos(std::clamp((reach - a) / b, -1.0, 1.0)) : 0;
    const double far = b > 0 ? std::acos(std::clamp((-reach - a) / b, -1.0, 1.0)) : kPi;
    rows::LatLongBand part = {a,
                              d.x * ring,
                              d.z * ring,
                              column_rad,
                              -d.y * ring * row_rad,
                              d.x * level * row_rad,
                              d.z * level * row_rad,
                              kLeastChange * row_rad,
                              area,
                              0};
    // Columns first, first + 1, ..., around the row.
    const auto add = [&](double first, double last) {
      int begin = static_cast<int>(std::ceil(first));
      int count = std::min(width, static_cast<int>(std::floor(last)) - begin + 1);
      begin = ((begin % width) + width) % width;
      while (count > 0) {
        const int piece = std::min(count, width - begin);
        const std::size_t column = static_cast<std::size_t>(begin);
        part.columns = static_cast<std::size_t>(piece);
        if (weights.size() < used + part.columns + rows::kPadding)
          weights.resize(2 * (used + part.columns + rows::kPadding));
        rows::lat_long_band_weights(&first_[column], &second_[column], part, band, weights.data(), used, cut);
        runs.push_back({row, begin, piece, used});
        used += part.columns;
        count -= piece, begin = 0;
      }
    };
    const double nearest = near / column_rad, farthest = far / column_rad;
    if (near <= 0 && far >= kPi)
      add(0, width - 1);
    else if (near <= 0)
      add(middle - farthest, middle + farthest);
    else if (far >= kPi)
      add(middle + nearest, middle + width - nearest);
    else
      add(middle + nearest, middle + farthest), add(middle - farthest, middle - nearest);
  }
  rows::cut_band_weights(cut, band, weights.data());
  for (const Run& run : runs) strips.add(run.row, run.begin, &weights[run.from], static_cast<std::size_t>(run.count));
}

// On a row of a face the cosine is (p + q s) / n with n^2 = m + s^2, so that |p + q s| is at most the reach times the
// largest n.
void HorizonBand::add_faces(const Vec3& d, const SecondIntegral& band, double total[3]) const {
  const int n = grid_.width();
  for (int row = 0; row < grid_.height(); ++row) {
    const int face = row / n;
    const Vec3 middle = envmap::cube_direction(face, 1, 1, 2);
    const Vec3 s_axis = std::sqrt(2.0) * envmap::cube_direction(face, 2, 1, 2) - middle;
    const Vec3 t_axis = std::sqrt(2.0) * envmap::cube_direction(face, 1, 2, 2) - middle;
    const double down = grid_.face_slope(row % n), t = grid_.face_coordinate(row % n) + down / 2;
    const double p = dot(d, middle) + t * dot(d, t_axis), q = dot(d, s_axis), m = 1 + t * t;
    const double widest = 2.0 / (n - (grid_.layout() == envmap::SphereGrid::Layout::kCubeEdges ? 1 : 0));
    const double reach = (band.reach + widest) * std::sqrt(m + 1);
    double low = -1, high = 1;
    if (std::fabs(q) > 1e-9) {
      low = std::max(low, (-p - std::copysign(reach, q)) / q);
      high = std::min(high, (-p + std::copysign(reach, q)) / q);
    } else if (std::fabs(p) > reach + 1e-9) {
      continue;
    }
    if (low >= high) continue;
    // Half of a texel more on either side serves both kinds of cubes.
    const int begin = std::clamp(static_cast<int>((low + 1) / 2 * n - 1), 0, n);
    const int end = std::clamp(static_cast<int>((high + 1) / 2 * n + 2), 0, n);
    if (begin >= end) continue;
    const rows::CubeBand at = {p, q, m, t, dot(d, t_axis), down, kLeastChange * widest};
    rows::add_cube_band(&rgb_[3 * (static_cast<std::size_t>(row) * stride_ + static_cast<std::size_t>(begin))],
                        static_cast<std::size_t>(end - begin), &first_[static_cast<std::size_t>(begin)],
                        &second_[static_cast<std::size_t>(begin)], at, band, total);
  }
}

}  // namespace goniochrome::prefilter
