#include "prefilter/internal/mirror.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "envmap/cube_map.h"
#include "prefilter/internal/overlap.h"

namespace goniochrome::prefilter {

namespace {

// The cell of a cube.
SphereQuad cube_cell(const envmap::SphereGrid& grid, int column, int line) {
  const int face = line / grid.width(), row = line % grid.width();
  const auto corner = [&](int i, int j) {
    return envmap::cube_direction(face, grid.face_coordinate(column + i) + 1, grid.face_coordinate(row + j) + 1, 2);
  };
  return {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
}

// A lat-long cell in pieces over which a parallel is all but a great circle: an eighth of a texel, at most 5 mrad.
int lat_long_pieces(const envmap::SphereGrid& grid) {
  return std::max(8, static_cast<int>(std::ceil(2 * kPi / grid.width() / 0.005)));
}
SphereQuad lat_long_piece(const envmap::SphereGrid& grid, int column, int row, int piece, int pieces) {
  const double left = column + double(piece) / pieces, right = column + double(piece + 1) / pieces;
  return {grid.direction_at(left, row), grid.direction_at(right, row), grid.direction_at(right, row + 1),
          grid.direction_at(left, row + 1)};
}

// Sums of radiance over overlaps.
struct Mean {
  Vec3 sum;
  double area = 0;

  void add(const float* rgb, double solid_angle) {
    sum += solid_angle * Vec3{rgb[0], rgb[1], rgb[2]};
    area += solid_angle;
  }
  void store(float* rgb) const {
    for (int c = 0; c < 3; ++c) rgb[c] = area > 0 ? static_cast<float>(sum[c] / area) : 0.0F;
  }
};

void any_overlaps(const envmap::Environment& env, const envmap::SphereGrid& grid, const envmap::Rotation& turn,
                  std::vector<float>& values) {
  const int pieces = grid.is_cube() ? 1 : lat_long_pieces(grid);
  parallel_for(static_cast<std::size_t>(grid.height()), 4, [&](std::size_t begin, std::size_t end) {
    OverlapFinder finder(env.grid());
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
      for (int column = 0; column < grid.width(); ++column) {
        Mean mean;
        for (int piece = 0; piece < pieces; ++piece) {
          SphereQuad cell =
              grid.is_cube() ? cube_cell(grid, column, row) : lat_long_piece(grid, column, row, piece, pieces);
          for (Vec3& corner : cell) corner = turn.to_environment(corner);
          for (const Overlap& o : finder.of(cell))
            mean.add(&env.values()[3 * static_cast<std::size_t>(o.texel)], o.solid_angle);
        }
        mean.store(&values[3 * (static_cast<std::size_t>(row) * grid.width() + column)]);
      }
  });
}

// Two lat-long maps: rows overlap in rows and columns in columns.
void flat_overlaps(const envmap::Environment& env, const envmap::SphereGrid& grid, std::vector<float>& values) {
  const auto first = [](double begin, int n) { return std::min(static_cast<int>(begin * n + 1e-9), n - 1); };
  parallel_for(static_cast<std::size_t>(grid.height()), 4, [&](std::size_t begin, std::size_t end) {
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
      for (int column = 0; column < grid.width(); ++column) {
        const double y0 = double(row) / grid.height(), y1 = double(row + 1) / grid.height();
        const double x0 = double(column) / grid.width(), x1 = double(column + 1) / grid.width();
        Mean mean;
        for (int y = first(y0, env.height()); y < env.height() && y < y1 * env.height() - 1e-9; ++y) {
          const double top = std::max(y0, double(y) / env.height()), bottom = std::min(y1, (y + 1.0) / env.height());
          const double height = 2 * std::sin(kPi * (top + bottom) / 2) * std::sin(kPi * (bottom - top) / 2);
          for (int x = first(x0, env.width()); x < env.width() && x < x1 * env.width() - 1e-9; ++x) {
            const double left = std::max(x0, double(x) / env.width()), right = std::min(x1, (x + 1.0) / env.width());
            mean.add(env.radiance(x, y), height * (right - left));
          }
        }
        mean.store(&values[3 * (static_cast<std::size_t>(row) * grid.width() + column)]);
      }
  });
}

// A texel of the environment, with all that one cell has of it.
struct Share {
  int column = 0, row = 0;
  double solid_angle = 0;
};

std::vector<Share> shares(OverlapFinder& finder, const SphereQuad& cell, int columns) {
  std::vector<Overlap> overlaps = finder.of(cell);
  std::sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) { return a.texel < b.texel; });
  std::vector<Share> merged;
  for (const Overlap& o : overlaps) {
    const int column = o.texel % columns, row = o.texel / columns;
    if (merged.empty() || merged.back().column != column || merged.back().row != row)
      merged.push_back({column, row, 0});
    merged.back().solid_angle += o.solid_angle;
  }
  return merged;
}

// A cube seen from a lat-long map whose quarters and halves fall between texels: a quarter of one side face and of the
// top serve all cells, by turns of a quarter (W/4 columns) and by mirroring east to west and top to bottom.
class Symmetric {
 public:
  Symmetric(const envmap::Environment& env, int n, std::vector<float>& values) : env_(env), n_(n), values_(values) {}

  // The cell's overlaps go to its images: on the side faces for a cell of +X, on top and bottom for one of +Y.
  void spread_side(const std::vector<Share>& part, int column, int row) const {
    constexpr std::array<int, 4> kFaces = {0, 1, 4, 5};
    constexpr std::array<int, 4> kQuarters = {0, 2, 1, 3};  // from +X, eastward
    for (std::size_t k = 0; k < 4; ++k)
      for (const bool mirrored : {false, true})
        for (const bool flipped : {false, true})
          put(part, kFaces[k], mirrored ? n_ - 1 - column : column, flipped ? n_ - 1 - row : row,
              {kQuarters[k] * env_.width() / 4, mirrored ? env_.width() / 2 - 1 : -1, flipped});
  }
  void spread_pole(const std::vector<Share>& part, int column, int row) const {
    for (int quarter = 0; quarter < 4; ++quarter) {
      const int shift = quarter * env_.width() / 4;
      put(part, 2, column, row, {shift, -1, false});
      put(part, 3, column, n_ - 1 - row, {shift, -1, true});
      const int turned = n_ - 1 - row;  // (s,t) to (-t,s)
      row = column, column = turned;
    }
  }

 private:
  // Columns c become mirror - c (unless mirror is -1), then move by `shift`; rows are flipped or not.
  struct Image {
    int shift = 0, mirror = -1;
    bool flipped = false;
  };
  void put(const std::vector<Share>& part, int face, int column, int row, const Image& image) const {
    Mean mean;
    const int w = env_.width();
    for (const Share& s : part) {
      const int x = ((image.mirror < 0 ? s.column : image.mirror - s.column) + image.shift + 2 * w) % w;
      mean.add(env_.radiance(x, image.flipped ? env_.height() - 1 - s.row : s.row), s.solid_angle);
    }
    mean.store(&values_[3 * ((static_cast<std::size_t>(face) * n_ + row) * n_ + column)]);
  }

  const envmap::Environment& env_;
  int n_;
  std::vector<float>& values_;
};

void symmetric_overlaps(const envmap::Environment& env, const envmap::SphereGrid& grid, std::vector<float>& values) {
  const int n = grid.width();
  const Symmetric images(env, n, values);
  parallel_for(static_cast<std::size_t>(n / 2), 1, [&](std::size_t begin, std::size_t end) {
    OverlapFinder finder(env.grid());
    for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
      for (int column = 0; column < n / 2; ++column) {
        images.spread_side(shares(finder, cube_cell(grid, column, row), env.width()), column, row);
        images.spread_pole(shares(finder, cube_cell(grid, column, 2 * n + row), env.width()), column, row);
      }
  });
}

}  // namespace

bool mirror_is_symmetric(const envmap::Environment& env, const envmap::SphereGrid& grid, const envmap::Rotation& turn) {
  return turn.is_identity() && grid.is_cube() && env.layout() == envmap::SphereGrid::Layout::kLatLong &&
         env.width() % 4 == 0 && env.height() % 2 == 0 && grid.width() % 2 == 0;
}

std::vector<float> mirror_values(const envmap::Environment& env, const envmap::SphereGrid& grid,
                                 const envmap::Rotation& turn) {
  using Layout = envmap::SphereGrid::Layout;
  std::vector<float> values(static_cast<std::size_t>(grid.width()) * grid.height() * 3);
  if (mirror_is_symmetric(env, grid, turn))
    symmetric_overlaps(env, grid, values);
  else if (turn.is_identity() && grid.layout() == Layout::kLatLong && env.layout() == Layout::kLatLong)
    flat_overlaps(env, grid, values);
  else
    any_overlaps(env, grid, turn, values);
  return values;
}

}  // namespace goniochrome::prefilter
