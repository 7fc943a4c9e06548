#include "envmap/environment.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace goniochrome::envmap {

// A cube with texel centers on its edges has cells of 2/(N-1), half as wide at the edges of a face: on a grid of
// 2(N-1) equal cells its cell i covers 2i-1 and 2i. In every other layout texels are cut where they are.
Environment Environment::cut_to(double most_rad) const {
  const double widest = grid_.largest_texel_rad();
  if (widest <= most_rad) return *this;
  const bool on_edges = layout() == Layout::kCubeEdges;
  const int parts = static_cast<int>(std::ceil((on_edges ? widest / 2 : widest) / most_rad));
  const auto whole = [&](int part) { return on_edges ? (part / parts + 1) / 2 : part / parts; };
  const int faces = grid_.is_cube() ? 6 : 1, old_rows = height() / faces;
  const int columns = parts * (on_edges ? 2 * (width() - 1) : width());
  const int rows = parts * (on_edges ? 2 * (old_rows - 1) : old_rows);
  Environment fine;
  fine.grid_ = SphereGrid(on_edges ? Layout::kCube : layout(), columns, faces * rows);
  fine.source_ = source_;
  fine.replaced_ = replaced_;
  fine.rgb_.reserve(3 * static_cast<std::size_t>(columns) * static_cast<std::size_t>(faces * rows));
  for (int face = 0; face < faces; ++face)
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        const float* rgb = radiance(whole(column), face * old_rows + whole(row));
        fine.rgb_.insert(fine.rgb_.end(), rgb, rgb + 3);
      }
  return fine;
}

Result<Environment> Environment::scaled(double factor) const {
  Environment brighter = *this;
  for (std::size_t i = 0; i < rgb_.size(); ++i) {
    brighter.rgb_[i] = static_cast<float>(factor * rgb_[i]);
    if (!std::isfinite(brighter.rgb_[i]))
      return input_error("{}: texel {},{} is {}: times {} it is more than a float holds: choose a smaller exposure",
                         source_, i / 3 % width(), i / 3 / width(), rgb_[i], factor);
  }
  return brighter;
}

Vec3 Environment::blended(const Vec3& direction) const {
  const bool cube = layout() == Layout::kCube;
  if (!cube && layout() != Layout::kLatLong) return vec3(lookup(direction));
  const int rows = cube ? width() : height();
  double column = 0, row = 0;
  int top = 0;
  if (cube) {
    const CubePosition at = cube_position(direction, width());
    column = std::clamp(at.column - 0.5, 0.0, width() - 1.0), row = at.row, top = at.face * width();
  } else {
    const GridPosition at = grid().position(direction);
    column = at.column - 0.5, row = at.row;
  }
  row = std::clamp(row - 0.5, 0.0, rows - 1.0);
  const double left = std::floor(column);
  const int x = (static_cast<int>(left) + width()) % width(), y = static_cast<int>(row);
  const int x1 = cube ? std::min(x + 1, width() - 1) : (x + 1) % width(), y1 = std::min(y + 1, rows - 1);
  const double s = column - left, t = row - y;
  return (1 - t) * ((1 - s) * texel(x, top + y) + s * texel(x1, top + y)) +
         t * ((1 - s) * texel(x, top + y1) + s * texel(x1, top + y1));
}

Environment Environment::above(double elevation_rad, const Rotation& turn) const {
  Environment upper = *this;
  for (int row = 0; row < height(); ++row)
    for (int column = 0; column < width(); ++column) {
      const Vec3 d = turn.to_world(direction(column, row));
      if (std::atan2(d.y, std::hypot(d.x, d.z)) >= elevation_rad) continue;
      std::fill_n(&upper.rgb_[3 * (static_cast<std::size_t>(row) * width() + column)], 3, 0.0F);
    }
  return upper;
}

Environment Environment::dimmed(const std::vector<Dimmed>& texels) const {
  Environment result = *this;
  for (const Dimmed& texel : texels) {
    float* rgb = &result.rgb_[3 * (static_cast<std::size_t>(texel.row) * width() + texel.column)];
    for (int c = 0; c < 3; ++c) rgb[c] = static_cast<float>(texel.factor * rgb[c]);
  }
  return result;
}

Vec3 Environment::flux(const Clip& clip) const {
  std::vector<Vec3> rows(static_cast<std::size_t>(height()));
  const SolidAngles solid_angles(grid_);
  parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const int y = static_cast<int>(row);
      for (int column = 0; column < width(); ++column) {
        const std::array<float, 3> rgb = clip.left_of(radiance(column, y));
        rows[row] += solid_angles.at(column, y) * Vec3{rgb[0], rgb[1], rgb[2]};
      }
    }
  });
  Vec3 sum;
  for (const Vec3& row : rows) sum += row;
  return sum;
}

}  // namespace goniochrome::envmap
