// Normals for the corners of a mesh that have none.
#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "base/angles.h"
#include "base/parallel.h"
#include "mesh/internal/polygons.h"

namespace goniochrome::mesh {

namespace {

// Faces that meet at a sharper edge than this do not share a made normal.
const double kCreaseCosine = std::cos(60 * kDegree);

std::uint64_t hash_of(const Vec3& v) {
  std::uint64_t hash = 0;
  for (const double c : {v.x, v.y, v.z}) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9E3779B97F4A7C15U;  // + 0.0 joins -0 and 0
    hash ^= hash >> 29;
  }
  return hash;
}

// For each position the number of the first position with the same coordinates. It is found in an open table of twice
// the size, whose entries keep a part of the hash beside the number, so that other positions are seldom looked at.
std::vector<std::uint32_t> places_of(const std::vector<Vec3>& positions) {
  struct Entry {
    std::uint32_t mark = 0, position_plus_1 = 0;
  };
  const int bits = std::max(4, static_cast<int>(std::bit_width(2 * positions.size())));
  std::vector<Entry> table(std::size_t{1} << bits);
  std::vector<std::uint32_t> place(positions.size());
  for (std::uint32_t i = 0; i < positions.size(); ++i) {
    const std::uint64_t hash = hash_of(positions[i]);
    const auto mark = static_cast<std::uint32_t>(hash);
    for (std::size_t at = hash >> (64 - bits);; at = (at + 1) & (table.size() - 1)) {
      Entry& entry = table[at];
      if (entry.position_plus_1 == 0) entry = {mark, i + 1};
      const std::uint32_t first = entry.position_plus_1 - 1;
      if (entry.mark != mark || positions[first] != positions[i]) continue;
      place[i] = first;
      break;
    }
  }
  return place;
}

// The corners at each place, in the order of the triangles: those of place p are corners[first[p]] up to first[p + 1].
// A corner is 3 t + k, the corner k of the triangle t.
struct Incidence {
  std::vector<std::uint32_t> first, corners;
};

Incidence incidence_of(const std::vector<CornerTriangle>& triangles, const std::vector<std::uint32_t>& place) {
  Incidence incidence;
  incidence.first.resize(place.size() + 2);
  for (const CornerTriangle& t : triangles)
    for (const Polygons::Corner& corner : t.corners) ++incidence.first[place[corner.position] + 2];
  for (std::size_t p = 2; p < incidence.first.size(); ++p) incidence.first[p] += incidence.first[p - 1];
  incidence.corners.resize(3 * triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i)  // each first[p + 1] moves from the begin of p to its end
    for (std::uint32_t k = 0; k < 3; ++k)
      incidence.corners[incidence.first[place[triangles[i].corners[k].position] + 1]++] = 3 * i + k;
  incidence.first.pop_back();
  return incidence;
}

// A triangle at a vertex: its unit normal, and its normal times its angle there.
struct Share {
  Vec3 normal, weighted;
};

Share share_of(const CornerTriangle& triangle, std::size_t k, const std::vector<Vec3>& positions) {
  const auto at = [&](std::size_t i) { return positions[triangle.corners[i % 3].position]; };
  const Vec3 doubled = cross(at(1) - at(0), at(2) - at(0));
  const Vec3 normal = (1 / length(doubled)) * doubled;
  const Vec3 a = at(k + 1) - at(k), b = at(k + 2) - at(k);
  return {normal, std::atan2(length(cross(a, b)), dot(a, b)) * normal};
}

// True if all normals lie within half the crease angle of one axis, so that each lies within the crease angle of each.
bool is_smooth(const std::vector<Share>& shares) {
  static const double kHalfCosine = std::cos(30 * kDegree);
  Vec3 sum;
  for (const Share& share : shares) sum += share.weighted;
  const double least = (kHalfCosine + 1e-12) * length(sum);
  return std::all_of(shares.begin(), shares.end(), [&](const Share& s) { return dot(s.normal, sum) > least; });
}

// Sums over those of many normals that lie within the crease angle of a given one, in less than a step for each of
// them: a tree of cones. A cone that lies within the angle as a whole is added as a whole, and one beyond it is passed
// over.
class CreaseTree {
 public:
  explicit CreaseTree(const std::vector<Share>& shares) : shares_(shares), order_(shares.size()) {
    for (std::size_t i = 0; i < order_.size(); ++i) order_[i] = i;
    build(0, order_.size());
  }
  Vec3 sum_about(const Vec3& normal) const {
    Vec3 sum;
    add(0, normal, sum);
    return sum;
  }

 private:
  static constexpr std::size_t kLeaf = 8;
  static constexpr double kMargin_rad = 1e-7;  // beyond the rounding of the angles, within which each normal is tried
  struct Node {
    std::size_t begin, end, right;  // right: the number of the second half, 0 in a leaf; the first half comes next
    Vec3 axis, sum;
    double spread_rad;
  };
  static double angle_rad(const Vec3& a, const Vec3& b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

  std::size_t build(std::size_t begin, std::size_t end) {
    Node node{begin, end, 0, {0, 0, 1}, {}, 0};
    Vec3 low{1, 1, 1}, high{-1, -1, -1}, normals;
    for (std::size_t i = begin; i < end; ++i) {
      const Share& share = shares_[order_[i]];
      node.sum += share.weighted, normals += share.normal;
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], share.normal[k]);
        high[k] = std::max(high[k], share.normal[k]);
      }
    }
    if (length(normals) > 0) node.axis = normalized(normals);
    for (std::size_t i = begin; i < end; ++i)
      node.spread_rad = std::max(node.spread_rad, angle_rad(node.axis, shares_[order_[i]].normal));
    const std::size_t number = nodes_.size();
    nodes_.push_back(node);
    if (end - begin <= kLeaf) return number;
    int widest = 0;
    for (int k = 1; k < 3; ++k)
      if (high[k] - low[k] > high[widest] - low[widest]) widest = k;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::size_t i, std::size_t j) {
      const double x = shares_[i].normal[widest], y = shares_[j].normal[widest];
      return x < y || (x == y && i < j);
    });
    build(begin, middle);
    const std::size_t right = build(middle, end);
    nodes_[number].right = right;
    return number;
  }

  void add(std::size_t number, const Vec3& normal, Vec3& sum) const {
    const Node& node = nodes_[number];
    const double between = angle_rad(node.axis, normal);
    if (between - node.spread_rad > 60 * kDegree + kMargin_rad) return;
    if (between + node.spread_rad < 60 * kDegree - kMargin_rad) {
      sum += node.sum;
    } else if (node.right != 0) {
      add(number + 1, normal, sum);
      add(node.right, normal, sum);
    } else {
      for (std::size_t i = node.begin; i < node.end; ++i)
        if (dot(shares_[order_[i]].normal, normal) >= kCreaseCosine) sum += shares_[order_[i]].weighted;
    }
  }

  const std::vector<Share>& shares_;
  std::vector<std::size_t> order_;
  std::vector<Node> nodes_;
};

// The normals of the corners at one place, made in the order of the triangles. Equal ones are made once.
class PlaceNormals {
 public:
  // Appends new normals to `made` and gives each corner that has none -2 - (its number there).
  void make(const std::uint32_t* corners, std::size_t count, std::vector<CornerTriangle>& triangles,
            const std::vector<Vec3>& positions, std::vector<Vec3>& made) {
    const auto corner = [&](std::size_t i) -> Polygons::Corner& {
      return triangles[corners[i] / 3].corners[corners[i] % 3];
    };
    std::size_t missing = 0;
    for (std::size_t i = 0; i < count; ++i) missing += corner(i).normal == kNoNormal ? 1 : 0;
    if (missing == 0) return;
    shares_.clear();
    for (std::size_t i = 0; i < count; ++i)
      shares_.push_back(share_of(triangles[corners[i] / 3], corners[i] % 3, positions));
    const bool smooth = is_smooth(shares_);
    std::optional<CreaseTree> tree;
    if (!smooth && count > kMany) tree.emplace(shares_);
    const std::size_t before = made.size();
    for (std::size_t i = 0; i < count; ++i) {
      if (corner(i).normal != kNoNormal) continue;
      if (!smooth || made.size() == before)
        number_ = numbered(normalized(tree ? tree->sum_about(shares_[i].normal) : sum_about(i, smooth)), before, made);
      corner(i).normal = -2 - number_;
    }
  }

 private:
  // Corners at one place, from which on a tree is faster than a loop over all for each of them.
  static constexpr std::size_t kMany = 128;

  Vec3 sum_about(std::size_t i, bool smooth) const {
    Vec3 sum;
    for (const Share& other : shares_)
      if (smooth || dot(other.normal, shares_[i].normal) >= kCreaseCosine) sum += other.weighted;
    return sum;
  }
  // The number of this normal among those made last, from `before` on.
  static std::int32_t numbered(const Vec3& normal, std::size_t before, std::vector<Vec3>& made) {
    const std::size_t from = std::max(before, made.size() - std::min(made.size(), kMany));
    auto known = std::find(made.begin() + static_cast<std::ptrdiff_t>(from), made.end(), normal);
    if (known == made.end()) known = made.insert(known, normal);
    return static_cast<std::int32_t>(known - made.begin());
  }

  std::vector<Share> shares_;
  std::int32_t number_ = 0;
};

}  // namespace

void make_normals(std::vector<CornerTriangle>& triangles, const std::vector<Vec3>& positions,
                  std::vector<Vec3>& normals) {
  const auto lacks = [](const Polygons::Corner& corner) { return corner.normal == kNoNormal; };
  if (std::ranges::none_of(triangles, [&](const CornerTriangle& t) { return std::ranges::any_of(t.corners, lacks); }))
    return;
  const Incidence incidence = incidence_of(triangles, places_of(positions));
  constexpr std::size_t kPlaces = 1 << 14;
  const auto corners_of = [&](std::size_t place) {
    return std::pair{incidence.corners.data() + incidence.first[place],
                     std::size_t{incidence.first[place + 1] - incidence.first[place]}};
  };
  std::vector<std::vector<Vec3>> made((positions.size() + kPlaces - 1) / kPlaces);
  parallel_for(positions.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
    PlaceNormals place_normals;
    for (std::size_t place = begin; place < end; ++place) {
      const auto [corners, count] = corners_of(place);
      place_normals.make(corners, count, triangles, positions, made[begin / kPlaces]);
    }
  });
  std::vector<std::size_t> first(made.size());
  for (std::size_t chunk = 0; chunk < made.size(); ++chunk) {
    first[chunk] = normals.size();
    normals.insert(normals.end(), made[chunk].begin(), made[chunk].end());
    made[chunk] = {};
  }
  parallel_for(positions.size(), kPlaces, [&](std::size_t begin, std::size_t end) {
    const auto offset = static_cast<std::int32_t>(first[begin / kPlaces]);
    for (std::size_t place = begin; place < end; ++place) {
      const auto [corners, count] = corners_of(place);
      for (std::size_t i = 0; i < count; ++i) {
        std::int32_t& normal = triangles[corners[i] / 3].corners[corners[i] % 3].normal;
        if (normal < kNoNormal) normal = offset - 2 - normal;
      }
    }
  });
}

}  // namespace goniochrome::mesh
