// The nearest paints in one tree, found exactly, and the lower bound of CIEDE2000 over a box of colors, with which the
// search leaves most paints out. goniochrome-search(7), "NEAREST PAINT".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "color/color_difference.h"
#include "library/internal/tree.h"

namespace goniochrome::library {

// A number that is not above delta_e_2000(color, y) for any y in `box`, except for rounding and for the 1e-9 of chroma
// that CIEDE2000 calls gray (a slack of 1e-9 relative and 1e-8 absolute is ample). The box may be a point.
double de00_floor(const color::Lab& color, const color::LabBox& box);

// The two formulas that searches know best.
inline constexpr color::DifferenceFormula kDe76{color::DifferenceFormula::Kind::kCie76};
inline constexpr color::DifferenceFormula kDe00{color::DifferenceFormula::Kind::kCiede2000};

enum class SearchMethod { kTree, kScan };

// The faster method for a tree of `paints`, of which `passing` are to be considered. library_bench measured it on
// random metallics at three geometries. The tree wins in both metrics as soon as there are two leaves (64 paints: 0.8
// us against 1.4), and 110-fold at 10^6. But where a filter lets fewer than about one paint in 2000 through, the tree
// looks for them in vain places, and the scan, which skips empty leaves, wins (10^6 paints, one in 10^4: 33 us against
// 540).
constexpr std::size_t kScanFraction = 2000;
SearchMethod faster_method(std::size_t paints, std::size_t passing);

// One geometry of a query: which of the tree's geometries it is compared with, and how much it counts (>= 0).
struct SearchTerm {
  std::size_t geometry = 0;  // channels 3 geometry, 3 geometry + 1, 3 geometry + 2
  color::Lab lab;
  double weight = 1;
  double aspecular_deg = 45;  // of that geometry, which DIN 6175 asks for
};

struct Match {
  double distance = 0;
  std::uint32_t label = 0;
  std::uint32_t place = 0;  // in the tree's order
  // Nearer first; of equals, the one that stands first in the library.
  friend bool operator<(const Match& x, const Match& y) {
    return x.distance < y.distance || (x.distance == y.distance && x.label < y.label);
  }
};

// The distance that all searches compare: the sum over the terms, in their order, of weight times color difference.
// `lab` has the other paint's color for each term. The query is the standard of formulas that are not symmetric.
double search_distance(std::span<const SearchTerm> terms, std::span<const color::Lab> lab,
                       const color::DifferenceFormula& metric);

// The best `count` matches offered so far, nearest first.
class NearestMatches {
 public:
  static constexpr double kNoLimit = 1e300;
  // Matches farther than `limit` are not wanted, not even the first ones.
  explicit NearestMatches(std::size_t count, double limit = kNoLimit) : count_(count), limit_(limit) {}
  // The distance above which no match is wanted any more.
  double limit() const { return limit_; }
  void offer(const Match& match);
  const std::vector<Match>& list() const { return list_; }

 private:
  std::size_t count_;
  double limit_;
  std::vector<Match> list_;
};

// The paints of a leaf that are to be considered, one bit for each.
using LeafMask = std::uint32_t;
static_assert(kLeafSize == 32);
// The mask of all paints of a leaf.
LeafMask full_leaf(const TreeView& tree, std::size_t leaf);

// Offers `best` every paint of the tree that can be among its nearest. `masks`, if not empty, has a word for each leaf.
// Both methods give the same answer to the last bit, ties included.
void find_nearest(const TreeView& tree, std::span<const SearchTerm> terms, const color::DifferenceFormula& metric,
                  SearchMethod method, std::span<const LeafMask> masks, NearestMatches& best);

}  // namespace goniochrome::library
