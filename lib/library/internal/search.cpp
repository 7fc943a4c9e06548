#include "library/internal/search.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "library/internal/search_bound.h"

// The inner loop, compiled for the machine's widest registers; the loader picks.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && defined(__OPTIMIZE__)
#define GONIO_WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define GONIO_WIDE
#endif

namespace goniochrome::library {

namespace {

// Bounds and fast distances are only used to leave paints out. They may differ from the true distance by rounding, and
// CIEDE2000 drops the hue difference of chromas below 1e-9, so a paint or a box is left out only if it is farther than
// the limit by more than this; the absolute part for each unit of weight.
constexpr double kRelativeSlack = 1e-9, kAbsoluteSlack = 1e-8;

// distances[i] += weight * sqrt((L-l)^2 + (a-a)^2 + (b-b)^2) for all paints of a leaf. `block` is the geometry's L.
GONIO_WIDE void add_de76(const double* __restrict block, double L, double a, double b, double weight,
                         double* __restrict distances) {
  for (std::size_t i = 0; i < kLeafSize; ++i) {
    const double dL = block[i] - L, da = block[kLeafSize + i] - a, db = block[2 * kLeafSize + i] - b;
    distances[i] += weight * std::sqrt(dL * dL + da * da + db * db);
  }
}

struct Pair {
  double left = 0, right = 0;
};

// The distances from a color to the nearest points of two boxes, both at once.
Pair de76_floors(const color::Lab& lab, const ChildBounds* bounds) {
  const double query[3] = {lab.L, lab.a, lab.b};
  double sum[2] = {0, 0};
  for (int c = 0; c < 3; ++c)
    for (int side = 0; side < 2; ++side) {
      const double gap = std::max(std::max(bounds[c].low[side] - query[c], query[c] - bounds[c].high[side]), 0.0);
      sum[side] += gap * gap;
    }
  return {std::sqrt(sum[0]), std::sqrt(sum[1])};
}

Pair de00_floors(const color::Lab& lab, const ChildBounds* bounds) {
  const auto box = [&](int side) {
    return LabBox{{bounds[0].low[side], bounds[1].low[side], bounds[2].low[side]},
                  {bounds[0].high[side], bounds[1].high[side], bounds[2].high[side]}};
  };
  return {de00_floor(lab, box(0)), de00_floor(lab, box(1))};
}

class Search {
 public:
  Search(const TreeView& tree, std::span<const SearchTerm> terms, ColorMetric metric, std::span<const LeafMask> masks,
         NearestMatches& best)
      : tree_(tree), terms_(terms), metric_(metric), masks_(masks), best_(best), paint_(terms.size()) {
    for (const SearchTerm& term : terms) slack_ += term.weight * kAbsoluteSlack;
  }

  // A node over `leaves` leaves from `first` on: the nearer child first, so that the limit falls early.
  void descend(std::size_t node, std::size_t first, std::size_t leaves) {
    if (leaves == 1) return look_at(first);
    const std::size_t left = leaves / 2;
    const Pair bound = bounds(node);
    const auto go_left = [&] {
      if (!out_of_reach(bound.left)) descend(node + 1, first, left);
    };
    const auto go_right = [&] {
      if (!out_of_reach(bound.right)) descend(node + left, first + left, leaves - left);
    };
    if (bound.left <= bound.right) {
      go_left();
      go_right();
    } else {
      go_right();
      go_left();
    }
  }

  void look_at(std::size_t leaf) {
    const LeafMask mask = masks_.empty() ? full_leaf(tree_, leaf) : masks_[leaf];
    if (mask == 0) return;
    std::array<double, kLeafSize> floors{};
    for (const SearchTerm& term : terms_) {
      const double* block = tree_.block(leaf) + 3 * term.geometry * kLeafSize;
      if (metric_ == ColorMetric::kDe76) {
        add_de76(block, term.lab.L, term.lab.a, term.lab.b, term.weight, floors.data());
      } else {
        for (LeafMask rest = mask; rest; rest &= rest - 1) {
          const int lane = std::countr_zero(rest);
          const color::Lab lab = color(block, lane);
          floors[lane] += term.weight * de00_floor(term.lab, {lab, lab});
        }
      }
    }
    for (LeafMask rest = mask; rest; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      if (!out_of_reach(floors[lane])) offer(leaf, lane);
    }
  }

 private:
  bool out_of_reach(double bound) const { return bound - bound * kRelativeSlack - slack_ > best_.limit(); }

  static color::Lab color(const double* block, int lane) {
    return {block[lane], block[kLeafSize + lane], block[2 * kLeafSize + lane]};
  }

  void offer(std::size_t leaf, int lane) {
    for (std::size_t i = 0; i < terms_.size(); ++i)
      paint_[i] = color(tree_.block(leaf) + 3 * terms_[i].geometry * kLeafSize, lane);
    const std::size_t place = leaf * kLeafSize + static_cast<std::size_t>(lane);
    best_.offer({search_distance(terms_, paint_, metric_), tree_.labels[place], static_cast<std::uint32_t>(place)});
  }

  // The distance is a sum of one part a geometry, so the sum of the parts' least values over a box bounds it.
  Pair bounds(std::size_t node) const {
    Pair sum;
    for (const SearchTerm& term : terms_) {
      const ChildBounds* children = tree_.children(node) + 3 * term.geometry;
      const Pair part =
          metric_ == ColorMetric::kDe76 ? de76_floors(term.lab, children) : de00_floors(term.lab, children);
      sum.left += term.weight * part.left;
      sum.right += term.weight * part.right;
    }
    return sum;
  }

  const TreeView& tree_;
  std::span<const SearchTerm> terms_;
  ColorMetric metric_;
  std::span<const LeafMask> masks_;
  NearestMatches& best_;
  std::vector<color::Lab> paint_;
  double slack_ = 0;
};

}  // namespace

SearchMethod faster_method(std::size_t paints, std::size_t passing) {
  return paints > kLeafSize && passing >= paints / kScanFraction ? SearchMethod::kTree : SearchMethod::kScan;
}

double search_distance(std::span<const SearchTerm> terms, std::span<const color::Lab> lab, ColorMetric metric) {
  double sum = 0;
  for (std::size_t i = 0; i < terms.size(); ++i)
    sum += terms[i].weight * (metric == ColorMetric::kDe76 ? color::delta_e_76(terms[i].lab, lab[i])
                                                           : color::delta_e_2000(terms[i].lab, lab[i]));
  return sum;
}

void NearestMatches::offer(const Match& match) {
  if (match.distance > limit_) return;
  if (list_.size() == count_) {
    if (count_ == 0 || !(match < list_.back())) return;
    list_.pop_back();
  }
  list_.insert(std::upper_bound(list_.begin(), list_.end(), match), match);
  if (list_.size() == count_) limit_ = std::min(limit_, list_.back().distance);
}

LeafMask full_leaf(const TreeView& tree, std::size_t leaf) {
  const std::size_t count = std::min(kLeafSize, tree.size - leaf * kLeafSize);
  return count == kLeafSize ? ~LeafMask{0} : (LeafMask{1} << count) - 1;
}

void find_nearest(const TreeView& tree, std::span<const SearchTerm> terms, ColorMetric metric, SearchMethod method,
                  std::span<const LeafMask> masks, NearestMatches& best) {
  if (tree.size == 0) return;
  Search search(tree, terms, metric, masks, best);
  if (method == SearchMethod::kTree) return search.descend(0, 0, tree.leaves());
  for (std::size_t leaf = 0; leaf < tree.leaves(); ++leaf) search.look_at(leaf);
}

}  // namespace goniochrome::library
