#include "brdf/flake_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/elementary.h"

namespace goniochrome::brdf {

namespace {

// The mean count of a tile, the side of which is a power of two of a meter. The count of a box is its mean beyond so
// many tiles: there the relative deviation of all flakes is below 2e-4.
constexpr double kOfTile = 1 << 16;
constexpr double kMostTiles = 512;
// A node of no more flakes places them one by one.
constexpr double kFew = 8;
// A node of more flakes than these is not split any more where it is no wider than that many times the box.
constexpr double kMany = 32, kNarrow = 2;
// In a node of more flakes than these the box may be narrower in tilts, which are not split any more.
constexpr double kVeryMany = 1024;
constexpr int kMostTiltSplits = 12;
// Means up to here are drawn by summing probabilities; the others by the normal quantile with its skewness.
constexpr double kSummed = 24;

constexpr std::uint64_t mixed(std::uint64_t a, std::uint64_t b) {
  std::uint64_t z = a + 0x9E3779B97F4A7C15U * (b + 1);
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31);
}

double unit(std::uint64_t bits) {
  return (static_cast<double>(bits >> 11) + 0.5) * 0x1p-53;
}

// The normal quantile by a rational approximation with an absolute error of 4.5e-4.
double normal_quantile(double u) {
  const double p = std::min(u, 1 - u), t = std::sqrt(-2 * math::log(p));
  const double x =
      t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  return u < 0.5 ? -x : x;
}

// A count of this mean, variance and skewness: the first terms of Cornish and Fisher.
double near_normal(double mean, double variance, double skewness, double u) {
  const double z = normal_quantile(u);
  return std::max(0.0, std::round(mean + std::sqrt(variance) * (z + skewness * (z * z - 1) / 6)));
}

// The flakes of a node in one half: as many as random bits are 1, a binomial draw. Of very many flakes, a
// sum of 256 bits, dithered by half a bit, stands for the normal deviate.
double half_of(double count, std::uint64_t key) {
  if (count > 512) {
    double sum = unit(mixed(key, 7)) - 128.5;
    for (std::uint64_t word = 0; word < 4; ++word) sum += std::popcount(mixed(key, 8 + word));
    constexpr double kDeviation = 8.005206;  // the root of 256/4 + 1/12
    return std::clamp(std::round(0.5 * count + 0.5 * std::sqrt(count) * sum / kDeviation), 0.0, count);
  }
  int left = static_cast<int>(count), sum = 0;
  for (std::uint64_t word = 0; left > 0; ++word, left -= 64) {
    const std::uint64_t bits = mixed(key, 8 + word);
    sum += std::popcount(left >= 64 ? bits : bits >> (64 - left));
  }
  return sum;
}

// An even number.
int tilt_splits_of(double tilts) {
  return 2 * static_cast<int>(std::clamp(-0.5 * math::log(tilts) / math::log(2), 0.0, 0.5 * kMostTiltSplits));
}

}  // namespace

double poisson_draw(double mean, double u) {
  if (!(mean > 0)) return 0;
  if (mean > kSummed) return near_normal(mean, mean, 1 / std::sqrt(mean), u);
  double probability = math::exp(-mean), sum = probability, count = 0;
  for (; u > sum && count < 200; sum += probability) probability *= mean / ++count;
  return count;
}

double binomial_draw(double count, double part, double u) {
  if (part >= 1) return count;
  if (!(part > 0) || !(count > 0)) return 0;
  if (part > 0.5) return count - binomial_draw(count, 1 - part, 1 - u);
  const double mean = count * part, variance = mean * (1 - part);
  if (mean > kSummed) return std::min(count, near_normal(mean, variance, (1 - 2 * part) / std::sqrt(variance), u));
  const double odds = part / (1 - part);
  double probability = math::exp(count * math::log1p(-part)), sum = probability, drawn = 0;
  for (; u > sum && drawn < count && drawn < 200; sum += probability) {
    probability *= odds * (count - drawn) / (drawn + 1);
    ++drawn;
  }
  return drawn;
}

// A box of flakes in units of a tile: place, place, tilt, tilt.
struct FlakeTree::Corners {
  std::array<double, 4> low, high;

  bool holds(const std::array<double, 5>& flake) const {
    for (std::size_t d = 0; d < 3; ++d)
      if (flake[d] < low[d] || flake[d] >= high[d]) return false;
    return (flake[3] >= low[3] && flake[3] < high[3]) || flake[3] + 1 < high[3];
  }
};

// A box of the tree in units of its tile: place, place, tilt, tilt.
struct FlakeTree::Node {
  std::array<double, 4> low = {0, 0, 0, 0}, size = {1, 1, 1, 1};
  double count = 0;
  std::uint64_t key = 0;
  int tilt_splits = 0, depth = 0;

  // The part of it that lies between two values in that dimension. Angles come again after a turn.
  double overlap(std::size_t d, const Corners& box) const {
    const auto part = [&](double at) {
      return std::clamp((std::min(box.high[d], at + size[d]) - std::max(box.low[d], at)) / size[d], 0.0, 1.0);
    };
    return part(low[d]) + (d == 3 ? part(low[d] + 1) : 0);
  }
  double overlap(const Corners& box) const {
    return overlap(0, box) * overlap(1, box) * overlap(2, box) * overlap(3, box);
  }
  std::array<Node, 2> halves() const {
    const std::size_t d = static_cast<std::size_t>(depth & 1) + (depth < tilt_splits ? 2 : 0);
    std::array<Node, 2> halves = {*this, *this};
    const double left = half_of(count, key);
    for (std::size_t i = 0; i < 2; ++i) {
      Node& half = halves[i];
      half.size[d] *= 0.5;
      if (i == 1) half.low[d] += half.size[d];
      half.count = i == 0 ? left : count - left;
      half.key = mixed(key, 2 + i);
      ++half.depth;
    }
    return halves;
  }
  // Where its flake of that number lies, and the number in [0,1) that decides whether it is shown.
  std::array<double, 5> flake(int number) const {
    std::array<double, 5> at{};
    const std::uint64_t own = mixed(key, 64 + static_cast<std::uint64_t>(number));
    for (std::size_t d = 0; d < 5; ++d) at[d] = unit(mixed(own, d));
    for (std::size_t d = 0; d < 4; ++d) at[d] = low[d] + size[d] * at[d];
    return at;
  }
};

namespace {

// The flakes of a node within a box, and those of them within a narrower range of turns: those of a small node over the
// edge of the box by binomial draws, since they are even in the node, first by place and then by tilt; all others one
// by one.
template <class Node, class Corners>
FlakeCounts counted(const Node& node, const Corners& box, const Corners& inner, double shown) {
  if (node.count == 0 || node.overlap(box) == 0) return {};
  FlakeCounts sum;
  if (node.count <= kFew) {
    for (int i = 0; i < static_cast<int>(node.count); ++i) {
      const std::array<double, 5> flake = node.flake(i);
      if (!(flake[4] < shown) || !box.holds(flake)) continue;
      sum += {1, inner.holds(flake) ? 1.0 : 0};
    }
    return sum;
  }
  bool narrow = node.count > kMany;
  std::uint64_t window = 4;  // of tilts that are narrower than a node: the draw is another one where they move
  for (std::size_t d = 0; d < 4 && narrow; ++d) {
    const double wide = box.high[d] - box.low[d];
    if (node.size[d] <= kNarrow * wide || node.overlap(d, box) >= 1) continue;
    narrow = d > 1 && node.depth >= node.tilt_splits && node.count > kVeryMany;
    window = mixed(window, static_cast<std::uint64_t>(box.low[d] / wide));
  }
  if (!narrow) {
    for (const Node& half : node.halves()) sum += counted(half, box, inner, shown);
    return sum;
  }
  const double turns = node.overlap(3, box);
  const auto drawn = [&](double count, double part, std::uint64_t number) {
    return binomial_draw(count, part, unit(mixed(node.key, number)));
  };
  const double placed = drawn(node.count, node.overlap(0, box) * node.overlap(1, box) * shown, 6);
  sum.all = drawn(placed, node.overlap(2, box) * turns, window);
  sum.inner = drawn(sum.all, node.overlap(3, inner) / turns, 3);
  return sum;
}

template <class Node, class Corners, class Visit>
void enumerate(const Node& node, const Corners& box, const Visit& visit) {
  if (node.count == 0 || node.overlap(box) == 0) return;
  if (node.count > kFew) {
    for (const Node& half : node.halves()) enumerate(half, box, visit);
    return;
  }
  for (int i = 0; i < static_cast<int>(node.count); ++i) {
    const std::array<double, 5> flake = node.flake(i);
    if (box.holds(flake)) visit(flake);
  }
}

}  // namespace

FlakeTree::FlakeTree(double density, std::uint64_t seed, double tilts)
    : density_(density), tile_m_(1), seed_(seed), tilt_splits_(tilt_splits_of(tilts)) {
  if (density > 0)
    tile_m_ = std::ldexp(1.0, static_cast<int>(std::lround(0.5 * math::log(kOfTile / density) / math::log(2))));
}

FlakeTree::Node FlakeTree::root(std::int64_t column, std::int64_t row) const {
  Node node;
  node.tilt_splits = tilt_splits_;
  node.key = mixed(mixed(seed_, static_cast<std::uint64_t>(column)), static_cast<std::uint64_t>(row));
  node.count = poisson_draw(density_ * tile_m_ * tile_m_, unit(mixed(node.key, 5)));
  return node;
}

// The tiles that the box meets, with its corners in units of each.
template <class Visit>
void FlakeTree::visit_tiles(const FlakeBox& box, const Visit& visit) const {
  const double turn = box.tilt[1] - std::floor(box.tilt[1]);
  std::array<std::int64_t, 2> first{}, last{};
  for (std::size_t d = 0; d < 2; ++d) {
    first[d] = static_cast<std::int64_t>(std::floor(box.place[d] / tile_m_));
    last[d] = static_cast<std::int64_t>(std::floor((box.place[d] + box.size[d]) / tile_m_));
  }
  for (std::int64_t row = first[1]; row <= last[1]; ++row) {
    for (std::int64_t column = first[0]; column <= last[0]; ++column) {
      const double x = box.place[0] / tile_m_ - static_cast<double>(column),
                   y = box.place[1] / tile_m_ - static_cast<double>(row);
      visit(root(column, row),
            Corners{{x, y, box.tilt[0], turn},
                    {x + box.size[0] / tile_m_, y + box.size[1] / tile_m_, box.tilt[0] + box.tilts[0],
                     turn + std::min(1.0, box.tilts[1])}},
            column, row);
    }
  }
}

FlakeCounts FlakeTree::counts(const FlakeBox& box, const FlakeBox& inner) const {
  const double mean = density_ * box.area() * box.part();
  if (!(mean > 0)) return {};
  if (!(box.area() < kMostTiles * tile_m_ * tile_m_)) return {mean, mean * inner.tilts[1] / box.tilts[1]};
  FlakeCounts sum;
  visit_tiles(box, [&](const Node& tile, const Corners& corners, std::int64_t, std::int64_t) {
    Corners within = corners;
    within.low[3] = inner.tilt[1] - std::floor(inner.tilt[1]), within.high[3] = within.low[3] + inner.tilts[1];
    sum += counted(tile, corners, within, box.shown);
  });
  return sum;
}

std::vector<FlakeTree::Flake> FlakeTree::flakes(const FlakeBox& box) const {
  std::vector<Flake> found;
  visit_tiles(box, [&](const Node& tile, const Corners& corners, std::int64_t column, std::int64_t row) {
    enumerate(tile, corners, [&](const std::array<double, 5>& flake) {
      found.push_back(
          {{(static_cast<double>(column) + flake[0]) * tile_m_, (static_cast<double>(row) + flake[1]) * tile_m_},
           {flake[2], flake[3]}});
    });
  });
  return found;
}

}  // namespace goniochrome::brdf
