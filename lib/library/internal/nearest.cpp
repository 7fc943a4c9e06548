#include "library/internal/nearest.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

// The inner loop, compiled for the machine's widest registers; the loader picks.
#if defined(__x86_64__) && defined(__gnu_linux__) && !defined(__SANITIZE_ADDRESS__) && defined(__OPTIMIZE__)
#define GONIO_WIDE __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define GONIO_WIDE
#endif

namespace goniochrome::library {

// CIEDE2000 [Sharma2005] between x and y, with the mean of a pair written with a bar:
//
//   G  = (1 - sqrt(Cb^7 / (Cb^7 + 25^7))) / 2, Cb the mean CIELAB chroma;  a' = (1 + G) a;  C', h' polar in (a', b)
//   X  = dC'/SC, Y = dH'/SH;  dE^2 = (dL/SL)^2 + X^2 + Y^2 + RT X Y
//   SL = 1 + .015 u^2/sqrt(20 + u^2), u = Lb - 50;  SC = 1 + .045 Cb';  SH = 1 + .015 Cb' T
//   T  = 1 - .17 cos(..) + .24 cos(..) + .32 cos(..) - .20 cos(..)
//   RT = -sin(2 theta) RC, theta = 30 deg exp(-((hb' - 275)/25)^2), RC = 2 sqrt(Cb'^7 / (Cb'^7 + 25^7))
//
// Claim. dE^2 >= (dL/SL)^2 + (1 - (sqrt(3)/4) RC) ((1 + G)^2 da^2 + db^2) / SC^2.
//
// 1. dC'^2 + dH'^2 = da'^2 + db^2 = (1 + G)^2 da^2 + db^2. For dH' = 2 sqrt(C1' C2') sin(dh'/2) gives dH'^2 = 2 C1' C2'
//    (1 - cos dh'), so the sum is C1'^2 + C2'^2 - 2 C1' C2' cos dh', the law of cosines in the (a', b) plane; both
//    colors of a pair share one G. If C1' C2' = 0, dH' is 0 and both sides are the square of the other chroma.
// 2. |T - 1| <= .17 + .24 + .32 + .20 = .93, so T <= 1.93 and .015 T < .045: 1 <= SH <= SC.
//    Hence X^2 + Y^2 >= (dC'^2 + dH'^2)/SC^2.
// 3. 0 < theta <= 30 deg, so 0 < sin(2 theta) <= sqrt(3)/2 and |RT| <= (sqrt(3)/2) RC. With |X Y| <= (X^2 + Y^2)/2:
//    X^2 + Y^2 + RT X Y >= (1 - (sqrt(3)/4) RC)(X^2 + Y^2), and the factor is positive since RC < 2.
// No step looks at the mean hue, so its jump at hues 180 deg apart does not matter.
//
// Over a box every factor is replaced by its own worst value, which keeps the bound since none is negative:
// 4. |dL|, |da|, |db| are least at the box's nearest point.
// 5. SL grows with |u| (its slope is .015 u (40 + u^2)/(20 + u^2)^1.5), and |u| is largest at an end of the box.
// 6. G falls with Cb. The chroma of y lies between that of the box's point nearest to the gray axis and that of a point
//    farthest from it, which bounds G on both sides: its least value in (1 + G)^2, its largest in Cb'.
// 7. Cb' grows with G and with the chroma of y; RC and SC grow with Cb'.
double de00_floor(const color::Lab& color, const color::LabBox& box) {
  const auto gap = [](double value, double low, double high) { return std::max({low - value, value - high, 0.0}); };
  const auto squared = [](double x) { return x * x; };
  const auto ratio7 = [&](double chroma) {  // sqrt(C^7/(C^7 + 25^7))
    const double c7 = squared(squared(chroma) * chroma) * chroma;
    return c7 < 1e280 ? std::sqrt(c7 / (c7 + 6103515625.0)) : 1;
  };
  const auto& [low, high] = box;
  const double u = std::max(std::abs((color.L + low.L) / 2 - 50), std::abs((color.L + high.L) / 2 - 50));
  const double SL = 1 + 0.015 * u * u / std::sqrt(20 + u * u);
  const double dL = gap(color.L, low.L, high.L), da = gap(color.a, low.a, high.a), db = gap(color.b, low.b, high.b);

  const double far_a = std::max(std::abs(low.a), std::abs(high.a));
  const double far_b = std::max(std::abs(low.b), std::abs(high.b));
  const double own = std::sqrt(squared(color.a) + squared(color.b));
  const double nearest = std::sqrt(squared(gap(0, low.a, high.a)) + squared(gap(0, low.b, high.b)));
  const double farthest = std::sqrt(squared(far_a) + squared(far_b));
  const double least_stretch = 1.5 - 0.5 * ratio7((own + farthest) / 2);  // 1 + G
  const double most_stretch = 1.5 - 0.5 * ratio7((own + nearest) / 2);
  const double mean_chroma = (std::sqrt(squared(most_stretch * color.a) + squared(color.b)) +
                              std::sqrt(squared(most_stretch * far_a) + squared(far_b))) /
                             2;
  const double SC = 1 + 0.045 * mean_chroma;
  const double turned = 1 - std::numbers::sqrt3 / 2 * ratio7(mean_chroma);  // RC = 2 ratio7
  return std::sqrt(squared(dL / SL) + turned * (squared(least_stretch * da) + squared(db)) / squared(SC));
}

namespace {

// Bounds and fast distances are only used to leave paints out. They may differ from the true distance by rounding, and
// CIEDE2000 drops the hue difference of chromas below 1e-9. So a paint or a box is left out only if it is farther than
// the limit by more than this slack, whose absolute part counts for each unit of weight.
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

// A number that no color of the box is nearer than, by any formula but CIE 1976.
double floor_of(const color::DifferenceFormula& metric, const SearchTerm& term, const color::LabBox& box) {
  return metric == kDe00 ? de00_floor(term.lab, box)
                         : color::difference_floor(metric, term.lab, box, term.aspecular_deg);
}

Pair floors(const color::DifferenceFormula& metric, const SearchTerm& term, const ChildBounds* bounds) {
  const auto box = [&](int side) {
    return color::LabBox{{bounds[0].low[side], bounds[1].low[side], bounds[2].low[side]},
                         {bounds[0].high[side], bounds[1].high[side], bounds[2].high[side]}};
  };
  return {floor_of(metric, term, box(0)), floor_of(metric, term, box(1))};
}

class Search {
 public:
  Search(const TreeView& tree, std::span<const SearchTerm> terms, const color::DifferenceFormula& metric,
         std::span<const LeafMask> masks, NearestMatches& best)
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
    std::array<double, kLeafSize> least{};
    for (const SearchTerm& term : terms_) {
      const double* block = tree_.block(leaf) + 3 * term.geometry * kLeafSize;
      if (metric_ == kDe76) {
        add_de76(block, term.lab.L, term.lab.a, term.lab.b, term.weight, least.data());
      } else {
        for (LeafMask rest = mask; rest; rest &= rest - 1) {
          const int lane = std::countr_zero(rest);
          const color::Lab lab = color(block, lane);
          least[lane] += term.weight * floor_of(metric_, term, {lab, lab});
        }
      }
    }
    for (LeafMask rest = mask; rest; rest &= rest - 1) {
      const int lane = std::countr_zero(rest);
      if (!out_of_reach(least[lane])) offer(leaf, lane);
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
      const Pair part = metric_ == kDe76 ? de76_floors(term.lab, children) : floors(metric_, term, children);
      sum.left += term.weight * part.left;
      sum.right += term.weight * part.right;
    }
    return sum;
  }

  const TreeView& tree_;
  std::span<const SearchTerm> terms_;
  color::DifferenceFormula metric_;
  std::span<const LeafMask> masks_;
  NearestMatches& best_;
  std::vector<color::Lab> paint_;
  double slack_ = 0;
};

}  // namespace

SearchMethod faster_method(std::size_t paints, std::size_t passing) {
  return paints > kLeafSize && passing >= paints / kScanFraction ? SearchMethod::kTree : SearchMethod::kScan;
}

double search_distance(std::span<const SearchTerm> terms, std::span<const color::Lab> lab,
                       const color::DifferenceFormula& metric) {
  double sum = 0;
  for (std::size_t i = 0; i < terms.size(); ++i)
    sum += terms[i].weight * color::difference(metric, terms[i].lab, lab[i], terms[i].aspecular_deg);
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

void find_nearest(const TreeView& tree, std::span<const SearchTerm> terms, const color::DifferenceFormula& metric,
                  SearchMethod method, std::span<const LeafMask> masks, NearestMatches& best) {
  if (tree.size == 0) return;
  Search search(tree, terms, metric, masks, best);
  if (method == SearchMethod::kTree) return search.descend(0, 0, tree.leaves());
  for (std::size_t leaf = 0; leaf < tree.leaves(); ++leaf) search.look_at(leaf);
}

}  // namespace goniochrome::library
