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
constexpr double kMostCells = 4096;  // of tilts, in each coordinate
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

const TileCounts& tile_counts(bool tilted) {
  static const TileCounts all(kOfTile), some(kOfTiltedTile);
  return tilted ? some : all;
}

// A range in units of a cell or node.
struct Interval {
  double low = 0, high = 1;

  double begin() const { return std::max(low, 0.0); }
  double end() const { return std::min(high, 1.0); }
  double overlap() const { return std::max(0.0, end() - begin()); }
  Interval within(std::int64_t cell) const {
    return {low - static_cast<double>(cell), high - static_cast<double>(cell)};
  }
};

// Ranges of up to four coordinates, of 15 bits in every 16. A range may begin anew at the end of its coordinate.
struct Ranges {
  std::uint64_t low = 0, width = 0;

  static constexpr std::uint64_t kTops = 0x8000800080008000U;
  void set(int coordinate, double from, double to) {
    const std::uint64_t begin = step(from), end = step(to);
    low |= (begin & 0x7FFF) << (16 * coordinate), width |= (end - begin) << (16 * coordinate);
  }
  void set(int coordinate, const Interval& interval) {
    set(coordinate, interval.begin(), std::max(interval.begin(), interval.end()));
  }
  static std::uint64_t step(double at) { return static_cast<std::uint64_t>(0x8000 * at + 0.5); }
  // The top bits keep each difference from borrowing of the next coordinate.
  bool hold(std::uint64_t at) const {
    const std::uint64_t above = ((at | kTops) - low) & ~kTops;
    return (((above | kTops) - width) & kTops) == 0;
  }
};

// The tilts of a cell that are seen, as the upper two coordinates, and the part of them that is shown.
struct Window {
  Ranges tilts;
  double part, shown;
};

// A node of the tree, which is a unit square, and a box in units of it.
struct Node {
  std::uint64_t key = 0;
  double count = 0;
  int depth = 0;
  std::array<Interval, 2> box;
};

// Flakes that are shown: those counted one by one or drawn, and those of whole nodes, of which a part is yet to be
// drawn.
struct Shown {
  double counted = 0, whole = 0;
  std::uint64_t key = 0;  // of the first whole node
};

int count_few(const Node& node, const Window& window) {
  Ranges ranges = window.tilts;
  ranges.set(0, node.box[0]), ranges.set(1, node.box[1]);
  int sum = 0;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(node.count); ++i)
    if (const std::uint64_t own = mixed(node.key, 64 + i); ranges.hold(own))
      sum += unit(mixed(own, 0)) < window.shown ? 1 : 0;
  return sum;
}

// Adds the flakes of a node within a box and a window, of which some are shown: those of a small node over the edge of
// the box by binomial draws, since they are even in the node; those of a node with few of them one by one.
void count_node(const Node& node, const Window& window, Shown& sum) {
  if (node.count <= kFew) {
    sum.counted += count_few(node, window);
    return;
  }
  const double x = node.box[0].overlap(), y = node.box[1].overlap();
  if (x * y >= 1) {
    if (sum.whole == 0) sum.key = node.key;
    sum.whole += node.count;
    return;
  }
  const auto narrow = [](const Interval& box, double part) {
    return part >= 1 || kNarrow * (box.high - box.low) >= 1;
  };
  if (node.count > kMany && narrow(node.box[0], x) && narrow(node.box[1], y)) {
    // Boxes that meet in the node draw by themselves.
    const std::uint64_t side = (node.box[0].low > 0 ? 1 : 0) + (node.box[1].low > 0 ? 2 : 0);
    sum.counted += binomial_draw(node.count, x * y * window.part * window.shown, unit(mixed(node.key, 16 + side)));
    return;
  }
  const auto d = static_cast<std::size_t>(node.depth & 1);
  double left = -1;
  for (int i = 0; i < 2; ++i) {
    Node half = node;
    half.box[d] = {2 * node.box[d].low - i, 2 * node.box[d].high - i};
    if (half.box[d].overlap() == 0) continue;
    if (left < 0) left = half_of(node.count, node.key);
    half.count = i == 0 ? left : node.count - left;
    half.key = mixed(node.key, 2 + static_cast<std::uint64_t>(i));
    ++half.depth;
    count_node(half, window, sum);
  }
}

// The number of cells, a power of 2, that are as wide as a range of tilts or up to twice as wide.
double cells_for(double tilts) {
  double cells = 1;
  while (cells < kMostCells && 2 * cells * tilts <= 1) cells *= 2;
  return cells;
}

}  // namespace

double FlakeTree::count(const FlakeBox& box) const {
  const double mean = density_ * box.area() * box.part();
  if (!(mean > 0)) return 0;
  const std::array<double, 2> cells{cells_for(box.tilts[0]), cells_for(box.tilts[1])};
  const bool tilted = cells[0] * cells[1] > 1;
  const double tile_m = std::sqrt((tilted ? kOfTiltedTile : kOfTile) * cells[0] * cells[1] / density_);
  if (!(box.area() < kMostTiles * tile_m * tile_m)) return mean;
  const TileCounts& counts = tile_counts(tilted);
  std::array<Interval, 2> place;
  std::array<std::int64_t, 2> first{}, last{};
  for (std::size_t d = 0; d < 2; ++d) {
    place[d] = {box.place[d] / tile_m, (box.place[d] + box.size[d]) / tile_m};
    first[d] = static_cast<std::int64_t>(std::floor(place[d].low));
    last[d] = static_cast<std::int64_t>(std::ceil(place[d].high));
  }
  const double tilt = cells[0] * box.tilt[0], tilt_end = tilt + cells[0] * box.tilts[0],
               turn = cells[1] * (box.tilt[1] - std::floor(box.tilt[1])),
               turn_end = turn + cells[1] * std::min(1.0, box.tilts[1]);
  const std::uint64_t seed = mixed(seed_, static_cast<std::uint64_t>(cells[0] * 2 * kMostCells + cells[1]));
  const auto some = static_cast<std::int64_t>(cells[1]);
  double sum = 0;
  for (auto i = static_cast<std::int64_t>(tilt); static_cast<double>(i) < std::min(tilt_end, cells[0]); ++i) {
    // One cell of turns holds a range that begins anew; of more cells, none does.
    for (auto j = static_cast<std::int64_t>(turn); static_cast<double>(j) < (some > 1 ? turn_end : 1); ++j) {
      const Interval tilts = Interval{tilt, tilt_end}.within(i), turns = Interval{turn, turn_end}.within(j);
      Window window{{}, tilts.overlap() * turns.overlap(), box.shown};
      window.tilts.set(2, tilts);
      if (some > 1) {
        window.tilts.set(3, turns);
      } else {
        window.tilts.set(3, turn, turn_end), window.part = tilts.overlap() * (turn_end - turn);
      }
      Shown of_cell;
      const std::uint64_t cell = mixed(seed, static_cast<std::uint64_t>(i * some + j % some));
      for (std::int64_t row = first[1]; row < last[1]; ++row) {
        const std::uint64_t of_row = mixed(cell, static_cast<std::uint64_t>(row));
        const Interval rows = place[1].within(row);
        for (std::int64_t column = first[0]; column < last[0]; ++column) {
          const std::uint64_t key = mixed(of_row, static_cast<std::uint64_t>(column));
          count_node({key, counts.at(unit(key)), 0, {place[0].within(column), rows}}, window, of_cell);
        }
      }
      sum += of_cell.counted + binomial_draw(of_cell.whole, window.part * box.shown, unit(mixed(of_cell.key, 9)));
    }
  }
  return sum;
}

}  // namespace goniochrome::brdf
