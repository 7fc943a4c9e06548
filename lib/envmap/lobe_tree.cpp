#include "envmap/lobe_tree.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "envmap/patch.h"

// Over a block in front of the horizon the kernel K(t) = t^E is taken to first order around the block's axis, which
// integrates exactly with the block's flux F and moment M:
//   F K(t0) + K'(t0) (d.M - t0 F),   off by at most F max|K''| (t - t0)^2 / 2.
// A block is opened where that exceeds its share of the tolerance. All terms are positive, so an error relative to a
// block's own contribution is one relative to the sum; and a block may also err by its share of the whole sum C, the
// part of the sphere that it covers. Blocks cut by the horizon share a band of their own width, so their budget is
// larger by the sphere over the band. C comes from a first, coarse walk. For E = 1 the first order is exact and only
// blocks cut by the horizon are opened.

namespace goniochrome {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFloor = 1e-3;            // errors are relative to no less than this of the mean
constexpr double kCoarseTolerance = 0.05;  // of the first walk
constexpr float kRounding = 1e-6F;         // caps are kept a little wider than floats round

Vec3 vec(const float* v) {
  return {v[0], v[1], v[2]};
}

}  // namespace

struct LobeTree::Walk {
  Vec3 d;
  double exponent;
  double tolerance;
  Vec3 per_flux;  // 1 / C, per channel

  double power(double t) const { return cosine_power(t, exponent); }
};

LobeTree::LobeTree(const Environment& env) : env_(env), flux_(env.flux()) {
  if (!env.grid().is_cube())
    sheets_.push_back({0, env.width(), env.height(), {}});
  else
    for (int face = 0; face < 6; ++face) sheets_.push_back({face * env.width(), env.width(), env.width(), {}});
  for (Sheet& sheet : sheets_) build(sheet);
}

void LobeTree::build(Sheet& sheet) const {
  const auto half = [](int n) { return (n + 1) / 2; };
  for (int w = half(sheet.width), h = half(sheet.height);; w = half(w), h = half(h)) {
    Sheet::Level level = {w, h, std::vector<Block>(static_cast<std::size_t>(w) * h)};
    const Sheet::Level* finer = sheet.levels.empty() ? nullptr : &sheet.levels.back();
    parallel_for(static_cast<std::size_t>(h), 8, [&](std::size_t begin, std::size_t end) {
      for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
        for (int column = 0; column < w; ++column) {
          Block& block = level.blocks[static_cast<std::size_t>(row) * w + column];
          if (!finer) {
            block = block_of_texels(sheet, column, row);
            continue;
          }
          block = {};
          Vec3 axis;
          const auto each_child = [&](const auto& body) {
            for (int y = 2 * row; y < std::min(2 * row + 2, finer->height); ++y)
              for (int x = 2 * column; x < std::min(2 * column + 2, finer->width); ++x)
                body(finer->blocks[static_cast<std::size_t>(y) * finer->width + x]);
          };
          each_child([&](const Block& child) {
            axis += child.area * vec(child.axis);
            block.area += child.area;
            for (int c = 0; c < 3; ++c) {
              block.flux[c] += child.flux[c];
              for (int k = 0; k < 3; ++k) block.moment[c][k] += child.moment[c][k];
            }
          });
          axis = length(axis) > 1e-6 * block.area ? normalized(axis) : Vec3{0, 1, 0};
          double radius = 0;
          each_child([&](const Block& child) {
            radius = std::max(radius, angle_between(axis, vec(child.axis)) + std::atan2(child.sine, child.cosine));
          });
          radius = std::min(radius, kPi);
          for (int k = 0; k < 3; ++k) block.axis[k] = static_cast<float>(axis[k]);
          block.cosine = static_cast<float>(std::cos(radius)) - kRounding;
          block.sine = static_cast<float>(std::sin(radius)) + kRounding;
        }
    });
    sheet.levels.push_back(std::move(level));
    if (w == 1 && h == 1) break;
  }
}

LobeTree::Block LobeTree::block_of_texels(const Sheet& sheet, int column, int row) const {
  const int left = 2 * column, right = std::min(left + 2, sheet.width);
  const int top = sheet.row + 2 * row, bottom = std::min(top + 2, sheet.row + sheet.height);
  Block block = {};
  Vec3 axis;
  double moment[3][3] = {}, flux[3] = {}, area = 0;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const Vec3 w = moment_of_cell(env_, {double(x), double(y), x + 1.0, y + 1.0});
      const double texel = env_.solid_angle(x, y);
      const float* rgb = env_.radiance(x, y);
      axis += w;
      area += texel;
      for (int c = 0; c < 3; ++c) {
        flux[c] += texel * rgb[c];
        for (int k = 0; k < 3; ++k) moment[c][k] += rgb[c] * w[k];
      }
    }
  axis = length(axis) > 1e-6 * area ? normalized(axis) : Vec3{0, 1, 0};
  double radius = 0;
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x)
      radius = std::max(radius, angle_between(axis, env_.direction(x, y)) + env_.radius_rad(x, y, x + 1, y + 1));
  radius = std::min(radius, kPi);
  block.area = static_cast<float>(area);
  block.cosine = static_cast<float>(std::cos(radius)) - kRounding;
  block.sine = static_cast<float>(std::sin(radius)) + kRounding;
  for (int k = 0; k < 3; ++k) block.axis[k] = static_cast<float>(axis[k]);
  for (int c = 0; c < 3; ++c) {
    block.flux[c] = static_cast<float>(flux[c]);
    for (int k = 0; k < 3; ++k) block.moment[c][k] = static_cast<float>(moment[c][k]);
  }
  return block;
}

void LobeTree::visit(const Walk& walk, const Sheet& sheet, int level, int column, int row, Vec3& sum) const {
  const Sheet::Level& here = sheet.levels[static_cast<std::size_t>(level)];
  const Block& block = here.blocks[static_cast<std::size_t>(row) * here.width + column];
  double weight = 0;  // the block's flux over C, in the channel where that is largest
  for (int c = 0; c < 3; ++c) weight = std::max(weight, block.flux[c] * walk.per_flux[c]);
  if (weight == 0) return;

  // The cosines of the nearest and the farthest point of the cap.
  const double t0 = dot(walk.d, vec(block.axis)), s0 = std::sqrt(std::max(0.0, 1 - t0 * t0));
  const double cosine = block.cosine, sine = block.sine;
  const double high = t0 >= cosine ? 1 : t0 * cosine + s0 * sine;
  if (high <= 0) return;
  const double low = t0 <= -cosine || cosine < 0 ? -1 : t0 * cosine - s0 * sine;
  const double share = block.area / (4 * kPi), most = walk.power(high);
  const double budget = walk.tolerance * share;
  bool accepted = false;
  if (weight * most <= 0.1 * budget) return;  // all of them together: a tenth of the tolerance
  if (low <= 0) {
    if (cosine > 0.8 && weight * most <= budget / std::max(sine, 1e-9)) {
      // On average half of the block is above the horizon.
      sum += 0.5 * most / (walk.exponent + 1) * vec(block.flux);
      return;
    }
  } else {
    const double e = walk.exponent, least = walk.power(low);
    const double bend = e * std::fabs(e - 1) * std::max(least / (low * low), most / (high * high));
    const double step = std::max(high - t0, t0 - low), error = 0.5 * bend * step * step;
    accepted = error <= walk.tolerance * least || weight * error <= budget;
  }
  if (accepted) {
    const double k = walk.power(t0), slope = walk.exponent * k / t0;
    for (int c = 0; c < 3; ++c)
      sum[c] += block.flux[c] * k + slope * (dot(walk.d, vec(block.moment[c])) - t0 * block.flux[c]);
    return;
  }
  const int width = level > 0 ? sheet.levels[static_cast<std::size_t>(level) - 1].width : sheet.width;
  const int height = level > 0 ? sheet.levels[static_cast<std::size_t>(level) - 1].height : sheet.height;
  for (int y = 2 * row; y < std::min(2 * row + 2, height); ++y)
    for (int x = 2 * column; x < std::min(2 * column + 2, width); ++x) {
      if (level > 0)
        visit(walk, sheet, level - 1, x, y, sum);
      else
        visit_texel(walk, x, sheet.row + y, sum);
    }
}

void LobeTree::visit_texel(const Walk& walk, int column, int row, Vec3& sum) const {
  const float* rgb = env_.radiance(column, row);
  if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) return;
  double weight = 0;
  for (int c = 0; c < 3; ++c) weight = std::max(weight, rgb[c] * walk.per_flux[c] * env_.solid_angle(column, row));
  // A texel may err by a tenth of the tolerance of itself, or by a thousandth of that of the sum; those on the horizon
  // do so at random.
  const double allowed = 1e-3 * walk.tolerance / weight;
  const double relative = std::clamp(allowed, 0.1 * walk.tolerance, 1e-2);
  const double cut = std::pow(std::min(1.0, 2 * env_.largest_texel_rad()), walk.exponent);
  const Cell cell = {double(column), double(row), column + 1.0, row + 1.0};
  sum += lobe_over_cell(env_, cell, walk.d, walk.exponent, relative,
                        std::clamp(allowed / cut, 0.1 * walk.tolerance, 0.1)) *
         vec(rgb);
}

Vec3 LobeTree::walked(const Walk& walk) const {
  Vec3 sum;
  for (const Sheet& sheet : sheets_) visit(walk, sheet, static_cast<int>(sheet.levels.size()) - 1, 0, 0, sum);
  return sum;
}

Vec3 LobeTree::lobe(const Vec3& d, double exponent, double tolerance) const {
  const double scale = (exponent + 1) / (2 * kPi);
  // The least C that matters: P = scale C at the floor of the mean.
  Vec3 floor;
  for (int c = 0; c < 3; ++c)
    floor[c] = std::max({kFloor * flux_[c], kFloor * kFloor * std::max({flux_.x, flux_.y, flux_.z}), 1e-300}) /
               (4 * kPi * scale);
  const auto inverse = [](const Vec3& c) { return Vec3{1 / c.x, 1 / c.y, 1 / c.z}; };
  Walk walk = {d, exponent, kCoarseTolerance, inverse(floor)};
  if (tolerance < kCoarseTolerance) {
    const Vec3 coarse = walked(walk);
    Vec3 c;
    for (int k = 0; k < 3; ++k) c[k] = std::max(floor[k], 0.8 * coarse[k]);
    walk.per_flux = inverse(c);
    walk.tolerance = tolerance / 3;  // its own blocks, the far ones and the horizon may err by as much each
  }
  return scale * walked(walk);
}

}  // namespace goniochrome
