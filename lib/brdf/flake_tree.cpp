#include "brdf/flake_tree.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/elementary.h"

namespace goniochrome::brdf {

namespace {

// The mean count of a tile of all flakes, and of one of a range of tilts, of which a box holds few. The count of a box
// is its mean beyond so many tiles.
constexpr double kOfTile = 4096, kOfTiltedTile = 6;
constexpr double kMostTiles = 512;
// A node of no more flakes places them one by one.
constexpr double kFew = 16;
// A node of more flakes than these is not split any more where it is no wider than that many times the box.
constexpr double kMany = 32, kNarrow = 2;
constexpr double kMostCells = 64;  // of tilts, in each coordinate
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
double computed_quantile(double u) {
  const double p = std::min(u, 1 - u), t = std::sqrt(-2 * math::log(p));
  const double x =
      t - (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
  return u < 0.5 ? -x : x;
}

// The quantile is interpolated in a table, but for the tails.
double normal_quantile(double u) {
  constexpr int kSteps = 1024, kEnd = 16;
  static const std::array<double, kSteps + 1> table = [] {
    std::array<double, kSteps + 1> quantiles{};
    for (int i = kEnd; i <= kSteps - kEnd; ++i)
      quantiles[static_cast<std::size_t>(i)] = computed_quantile(1.0 * i / kSteps);
    return quantiles;
  }();
  const double at = u * kSteps;
  if (!(at >= kEnd && at < kSteps - kEnd)) return computed_quantile(u);
  const auto step = static_cast<std::size_t>(at);
  return table[step] + (at - static_cast<double>(step)) * (table[step + 1] - table[step]);
}

// A count of this mean, variance and skewness: the first terms of Cornish and Fisher.
double near_normal(double mean, double variance, double skewness, double u) {
  const double z = normal_quantile(u);
  return std::max(0.0, std::round(mean + std::sqrt(variance) * (z + skewness * (z * z - 1) / 6)));
}

// The number of bits that are 1. Without an instruction for it, std::popcount calls a function that looks up bytes.
int ones(std::uint64_t bits) {
  bits -= (bits >> 1) & 0x5555555555555555U;
  bits = (bits & 0x3333333333333333U) + ((bits >> 2) & 0x3333333333333333U);
  return static_cast<int>((((bits + (bits >> 4)) & 0x0F0F0F0F0F0F0F0FU) * 0x0101010101010101U) >> 56);
}

// The flakes of a node in one half: as many as random bits are 1, a binomial draw. Of very many flakes, a
// sum of 256 bits, dithered by half a bit, stands for the normal deviate.
double half_of(double count, std::uint64_t key) {
  if (count > 512) {
    double sum = unit(mixed(key, 7)) - 128.5;
    for (std::uint64_t word = 0; word < 4; ++word) sum += ones(mixed(key, 8 + word));
    constexpr double kDeviation = 8.005206;  // the root of 256/4 + 1/12
    return std::clamp(std::round(0.5 * count + 0.5 * std::sqrt(count) * sum / kDeviation), 0.0, count);
  }
  int left = static_cast<int>(count), sum = 0;
  for (std::uint64_t word = 0; left > 0; ++word, left -= 64) {
    const std::uint64_t bits = mixed(key, 8 + word);
    sum += ones(left >= 64 ? bits : bits >> (64 - left));
  }
  return sum;
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

namespace {

// Poisson draws of one mean by inversion, which a table begins near their end.
class TileCounts {
 public:
  explicit TileCounts(double mean) {
    const double reach = 8 * std::sqrt(mean) + 8;
    first_ = std::max(0.0, std::floor(mean - reach));
    double sum = 0;
    for (double count = first_; count <= mean + reach; ++count)
      cumulated_.push_back(sum += math::exp(count * math::log(mean) - mean - std::lgamma(count + 1)));
    for (std::size_t i = 0, count = 0; i < starts_.size(); ++i) {
      while (cumulated_[count] < static_cast<double>(i) / kStarts) ++count;
      starts_[i] = count;
    }
  }
  double at(double u) const {
    std::size_t count = starts_[static_cast<std::size_t>(u * kStarts)];
    while (count + 1 < cumulated_.size() && cumulated_[count] < u) ++count;
    return first_ + static_cast<double>(count);
  }

 private:
  static constexpr int kStarts = 256;
  double first_ = 0;
  std::vector<double> cumulated_;
  std::array<std::size_t, kStarts> starts_{};
};

double tile_count(bool tilted, double u) {
  static const TileCounts all(kOfTile), some(kOfTiltedTile);
  return (tilted ? some : all).at(u);
}

// A range of tilts in units of a cell of tilts. A range of turns that comes again to the cell has those below `again`
// too.
struct Window {
  std::array<double, 2> low = {0, 0}, high = {1, 1};
  double again = 0;

  double part() const {
    const auto overlap = [&](std::size_t d) { return std::max(0.0, std::min(high[d], 1.0) - std::max(low[d], 0.0)); };
    return overlap(0) * (overlap(1) + again);
  }
};

// A node of the tree, which is a unit square, and a box in units of it.
struct Node {
  std::uint64_t key = 0;
  double count = 0;
  int depth = 0;
  std::array<double, 2> low = {}, high = {};

  double overlap(std::size_t d) const { return std::max(0.0, std::min(high[d], 1.0) - std::max(low[d], 0.0)); }
};

// Flakes that are shown: those counted one by one or drawn, and those of whole nodes, of which a part is yet to be
// drawn.
struct Shown {
  double counted = 0, whole = 0;
  std::uint64_t key = 0;  // of the first whole node
};

// A range of a coordinate that has 16 bits.
struct Range {
  unsigned low, width;

  Range(double from, double to) : low(step(from)), width(step(to) - low) {}
  static unsigned step(double at) { return static_cast<unsigned>(65536 * std::clamp(at, 0.0, 1.0) + 0.5); }
  bool holds(std::uint64_t at) const { return static_cast<unsigned>(at & 0xFFFF) - low < width; }
};

// Adds the flakes of a node within a box and a window, of which some are shown: those of a small node over the edge of
// the box by binomial draws, since they are even in the node; those of a node with few of them one by one.
void count_node(const Node& node, const Window& window, double shown, Shown& sum) {
  const double x = node.overlap(0), y = node.overlap(1);
  if (node.count <= kFew) {
    const Range columns(node.low[0], node.high[0]), rows(node.low[1], node.high[1]),
        tilts(window.low[0], window.high[0]), turns(window.low[1], window.high[1]), again(0, window.again);
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(node.count); ++i) {
      const std::uint64_t own = mixed(node.key, 64 + i);
      if (static_cast<int>(columns.holds(own)) & static_cast<int>(rows.holds(own >> 16)) &
          static_cast<int>(tilts.holds(own >> 32)) &
          (static_cast<int>(turns.holds(own >> 48)) | static_cast<int>(again.holds(own >> 48))))
        sum.counted += unit(mixed(own, 0)) < shown ? 1 : 0;
    }
    return;
  }
  if (x * y >= 1) {
    if (sum.whole == 0) sum.key = node.key;
    sum.whole += node.count;
    return;
  }
  const auto narrow = [&](std::size_t d, double part) {
    return part >= 1 || kNarrow * (node.high[d] - node.low[d]) >= 1;
  };
  if (node.count > kMany && narrow(0, x) && narrow(1, y)) {
    sum.counted += binomial_draw(node.count, x * y * window.part() * shown, unit(mixed(node.key, 6)));
    return;
  }
  const auto d = static_cast<std::size_t>(node.depth & 1);
  double left = -1;
  for (int i = 0; i < 2; ++i) {
    Node half = node;
    half.low[d] = 2 * node.low[d] - i, half.high[d] = 2 * node.high[d] - i;
    if (half.overlap(d) == 0) continue;
    if (left < 0) left = half_of(node.count, node.key);
    half.count = i == 0 ? left : node.count - left;
    half.key = mixed(node.key, 2 + static_cast<std::uint64_t>(i));
    ++half.depth;
    count_node(half, window, shown, sum);
  }
}

std::uint64_t bits(double number) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(number));
}

}  // namespace

FlakeTree::FlakeTree(double density, std::uint64_t seed, double tilts)
    : density_(density),
      tile_m_(1),
      seed_(seed),
      cells_(std::clamp(std::floor(1 / std::sqrt(tilts)), 1.0, kMostCells)) {
  const double of_cell = density / (cells_ * cells_);
  if (density > 0) tile_m_ = std::sqrt((cells_ > 1 ? kOfTiltedTile : kOfTile) / of_cell);
}

double FlakeTree::count(const FlakeBox& box) const {
  const double mean = density_ * box.area() * box.part();
  if (!(mean > 0)) return 0;
  if (!(box.area() < kMostTiles * tile_m_ * tile_m_)) return mean;
  const bool all_turns = box.tilts[1] >= 1;
  const double turn = all_turns ? 0 : cells_ * (box.tilt[1] - std::floor(box.tilt[1])),
               turned = turn + cells_ * (all_turns ? 1 : box.tilts[1]), tilt = cells_ * box.tilt[0],
               tilted = tilt + cells_ * box.tilts[0];
  std::array<double, 2> low{}, high{};
  for (std::size_t d = 0; d < 2; ++d) low[d] = box.place[d] / tile_m_, high[d] = low[d] + box.size[d] / tile_m_;
  double sum = 0;
  for (double i = std::floor(tilt); i < std::min(tilted, cells_); ++i) {
    for (double j = std::floor(turn); j < std::min(turned, std::floor(turn) + cells_); ++j) {
      const Window window{{tilt - i, turn - j}, {tilted - i, turned - j}, std::clamp(turned - j - cells_, 0.0, 1.0)};
      Shown of_cell;
      const std::uint64_t cell = mixed(seed_, bits(i * cells_ + (j < cells_ ? j : j - cells_)));
      for (double row = std::floor(low[1]); row < high[1]; ++row) {
        for (double column = std::floor(low[0]); column < high[0]; ++column) {
          Node tile{mixed(mixed(cell, bits(column)), bits(row)),
                    0,
                    0,
                    {low[0] - column, low[1] - row},
                    {high[0] - column, high[1] - row}};
          tile.count = tile_count(cells_ > 1, unit(mixed(tile.key, 5)));
          count_node(tile, window, box.shown, of_cell);
        }
      }
      sum += of_cell.counted + binomial_draw(of_cell.whole, window.part() * box.shown, unit(mixed(of_cell.key, 9)));
    }
  }
  return sum;
}

}  // namespace goniochrome::brdf
