#include "envmap/block_tree.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "envmap/patch.h"

namespace goniochrome::envmap {

namespace {

constexpr float kRounding = 1e-6F;  // caps are kept a little wider than floats round

void set_cap(const Vec3& axis, double radius_rad, BlockTree::Block& block) {
  const double radius = std::min(radius_rad, kPi);
  for (int k = 0; k < 3; ++k) block.axis[k] = static_cast<float>(axis[k]);
  block.cosine = static_cast<float>(std::cos(radius)) - kRounding;
  block.sine = static_cast<float>(std::sin(radius)) + kRounding;
}

}  // namespace

BlockTree::BlockTree(const Environment& env) : env_(&env) {
  if (!env.grid().is_cube())
    sheets_.push_back({0, env.width(), env.height(), {}});
  else
    for (int face = 0; face < 6; ++face) sheets_.push_back({face * env.width(), env.width(), env.width(), {}});
  const SolidAngles solid_angles(env.grid());
  for (Sheet& sheet : sheets_) build(sheet, solid_angles);
}

// Children into their parent: sums add up, caps are wrapped.
BlockTree::Block BlockTree::merged(const Sheet::Level& finer, int column, int row) {
  Block block = {};
  Vec3 axis;
  const auto each_child = [&](const auto& body) {
    for (int y = 2 * row; y < std::min(2 * row + 2, finer.height); ++y)
      for (int x = 2 * column; x < std::min(2 * column + 2, finer.width); ++x)
        body(finer.blocks[static_cast<std::size_t>(y) * finer.width + x]);
  };
  each_child([&](const Block& child) {
    axis += child.area * vec3(child.axis);
    block.area += child.area;
    for (int c = 0; c < 3; ++c) {
      block.flux[c] += child.flux[c];
      for (int k = 0; k < 3; ++k) block.moment[c][k] += child.moment[c][k];
    }
  });
  axis = length(axis) > 1e-6 * block.area ? normalized(axis) : Vec3{0, 1, 0};
  double radius = 0;
  each_child([&](const Block& child) {
    radius = std::max(radius, angle_between(axis, vec3(child.axis)) + std::atan2(child.sine, child.cosine));
  });
  set_cap(axis, radius, block);
  return block;
}

void BlockTree::build(Sheet& sheet, const SolidAngles& solid_angles) const {
  const auto half = [](int n) { return (n + 1) / 2; };
  for (int w = half(sheet.width), h = half(sheet.height);; w = half(w), h = half(h)) {
    Sheet::Level level = {w, h, std::vector<Block>(static_cast<std::size_t>(w) * h)};
    const Sheet::Level* finer = sheet.levels.empty() ? nullptr : &sheet.levels.back();
    parallel_for(static_cast<std::size_t>(h), 8, [&](std::size_t begin, std::size_t end) {
      for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
        for (int column = 0; column < w; ++column)
          level.blocks[static_cast<std::size_t>(row) * w + column] =
              finer != nullptr ? merged(*finer, column, row) : block_of_texels(sheet, solid_angles, column, row);
    });
    sheet.levels.push_back(std::move(level));
    if (w == 1 && h == 1) break;
  }
}

// A corner is the farthest point of a rectangle on a cube's face.
double BlockTree::radius_of_texels(const Vec3& axis, int left, int right, int top, int bottom) const {
  const SphereGrid& grid = env_->grid();
  double radius = 0;
  if (grid.is_cube()) {
    const int face = top / grid.width(), first = face * grid.width();
    for (const int column : {left, right})
      for (const int row : {top - first, bottom - first})
        radius = std::max(radius, angle_between(axis, cube_direction(face, grid.face_coordinate(column) + 1,
                                                                     grid.face_coordinate(row) + 1, 2)));
    return radius;
  }
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x)
      radius = std::max(radius, angle_between(axis, env_->direction(x, y)) + env_->radius_rad(x, y, x + 1, y + 1));
  return radius;
}

BlockTree::Block BlockTree::block_of_texels(const Sheet& sheet, const SolidAngles& solid_angles, int column,
                                            int row) const {
  const int left = 2 * column, right = std::min(left + 2, sheet.width);
  const int top = sheet.row + 2 * row, bottom = std::min(top + 2, sheet.row + sheet.height);
  Block block = {};
  Vec3 axis;
  double moment[3][3] = {}, flux[3] = {}, area = 0;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const Vec3 w = moment_of_cell(*env_, {double(x), double(y), x + 1.0, y + 1.0});
      const double texel = solid_angles.at(x, y);
      const float* rgb = env_->radiance(x, y);
      axis += w;
      area += texel;
      for (int c = 0; c < 3; ++c) {
        flux[c] += texel * rgb[c];
        for (int k = 0; k < 3; ++k) moment[c][k] += rgb[c] * w[k];
      }
    }
  axis = length(axis) > 1e-6 * area ? normalized(axis) : Vec3{0, 1, 0};
  set_cap(axis, radius_of_texels(axis, left, right, top, bottom), block);
  block.area = static_cast<float>(area);
  for (int c = 0; c < 3; ++c) {
    block.flux[c] = static_cast<float>(flux[c]);
    for (int k = 0; k < 3; ++k) block.moment[c][k] = static_cast<float>(moment[c][k]);
  }
  return block;
}

}  // namespace goniochrome::envmap
