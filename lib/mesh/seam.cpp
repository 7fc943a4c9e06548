#include "mesh/seam.h"

#include <CGAL/AABB_tree.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/version.h>
#if CGAL_VERSION_MAJOR >= 6
#include <CGAL/AABB_segment_primitive_3.h>
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#else
#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "base/angles.h"
#include "base/text.h"
#include "mesh/unit.h"

namespace goniochrome::mesh {

namespace {

// The rim of a part is where its skin ends. Each of its edges has one face or more: the smooth normals of a face at
// both ends of the edge, and the direction into the face.
struct RimFace {
  Vec3 normal0, normal1;
  Vec3 inward;  // unit, in the face, perpendicular to the edge
};

struct RimEdge {
  Vec3 p0, p1;
  std::vector<RimFace> faces;
};

struct Rim {
  std::vector<RimEdge> edges;
  int duplicate_faces = 0, non_manifold_edges = 0;
};

constexpr double kFold_rad = 30 * kDegree;
constexpr double kFlat_rad = 2 * kDegree;  // less is rounding of the file, whatever the size of the faces
constexpr double kLeastPatch = 0.01;       // of the part's area

using Index = std::uint32_t;

// Gives each place a number, so that vertices which a file holds several times become one.
class Places {
 public:
  explicit Places(double grid) : grid_(grid) {}
  Index at(const Vec3& p) {
    const std::array<std::int64_t, 3> key{std::llround(p.x / grid_), std::llround(p.y / grid_),
                                          std::llround(p.z / grid_)};
    return numbers_.try_emplace(key, static_cast<Index>(numbers_.size())).first->second;
  }

 private:
  double grid_;
  std::map<std::array<std::int64_t, 3>, Index> numbers_;
};

// A side of a triangle: which one, and from which corner it starts.
struct Side {
  std::size_t triangle;
  int corner;
};

// Along the normal of a face, twice as long as the face is large.
Vec3 doubled_area(const Mesh& mesh, std::size_t triangle) {
  const auto& [i, j, k] = mesh.triangles[triangle];
  return cross(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i]);
}

double face_area(const Mesh& mesh, std::size_t triangle) {
  return length(doubled_area(mesh, triangle)) / 2;
}

// How far the face reaches from one of its sides.
double height_over(const Mesh& mesh, const Side& side) {
  const auto& corners = mesh.triangles[side.triangle];
  const Vec3 way = mesh.positions[corners[(side.corner + 1) % 3]] - mesh.positions[corners[side.corner]];
  return 2 * face_area(mesh, side.triangle) / length(way);
}

RimFace rim_face(const Mesh& mesh, const Side& side, bool from_low) {
  const auto& corners = mesh.triangles[side.triangle];
  const Index from = corners[side.corner], to = corners[(side.corner + 1) % 3], third = corners[(side.corner + 2) % 3];
  const Vec3 edge = normalized(mesh.positions[to] - mesh.positions[from]);
  const Vec3 into = mesh.positions[third] - mesh.positions[from];
  RimFace face{mesh.normals[from], mesh.normals[to], normalized(into - dot(into, edge) * edge)};
  if (!from_low) std::swap(face.normal0, face.normal1);
  return face;
}

// Sets of faces that are connected without a fold or a tight bend between them.
class Patches {
 public:
  explicit Patches(const MeshPart& part) : first_(part.first), root_(part.count), area_(part.count, 0.0) {
    std::iota(root_.begin(), root_.end(), std::size_t{0});
  }
  void join(std::size_t triangle, std::size_t other) { root_[find(triangle - first_)] = find(other - first_); }
  void weigh(const Mesh& mesh) {
    for (std::size_t t = 0; t < root_.size(); ++t) area_[find(t)] += face_area(mesh, first_ + t);
    total_ = std::accumulate(area_.begin(), area_.end(), 0.0);
  }
  bool is_skin(std::size_t triangle) { return area_[find(triangle - first_)] >= kLeastPatch * total_; }
  bool same(std::size_t a, std::size_t b) { return find(a - first_) == find(b - first_); }

 private:
  std::size_t find(std::size_t t) {
    while (root_[t] != t) t = root_[t] = root_[root_[t]];
    return t;
  }
  std::size_t first_;
  std::vector<std::size_t> root_;
  std::vector<double> area_;
  double total_ = 0;
};

using Edges = std::map<std::pair<Index, Index>, std::vector<Side>>;

// True if the surface goes on over an edge of two faces. Two sides that run the same way belong to faces of opposite
// sense: then their normals are compared as lines.
bool goes_on(const Mesh& mesh, const std::vector<Side>& sides, double size, Places& places) {
  const Vec3 a = normalized(doubled_area(mesh, sides[0].triangle));
  const Vec3 b = normalized(doubled_area(mesh, sides[1].triangle));
  const auto start = [&](const Side& s) { return places.at(mesh.positions[mesh.triangles[s.triangle][s.corner]]); };
  const double along = start(sides[0]) == start(sides[1]) ? -dot(a, b) : dot(a, b);
  const double angle = std::atan2(length(cross(a, b)), along);
  const double height = std::min(height_over(mesh, sides[0]), height_over(mesh, sides[1]));
  return angle < kFlat_rad || (angle < kFold_rad && height / angle > size / 200);
}

// The skin of a panel is what bends gently. It ends at open edges, at edges of more than two faces, and where it turns
// down into the gap: at folds of more than 30 degrees, and at bends of a radius below size/200, such as the first edge
// of a rounded or rolled border. Patches of less than a hundredth of the part's area are not skin. Only faces of the
// skin are listed. Vertices within a millionth of `size` are taken as one.
Rim rim_of(const Mesh& mesh, const MeshPart& part, double size) {
  Rim rim;
  Places places(1e-6 * size);
  Edges edges;
  std::set<std::array<Index, 3>> faces;
  for (std::size_t t = part.first; t < part.first + part.count; ++t) {
    std::array<Index, 3> at;
    for (int c = 0; c < 3; ++c) at[c] = places.at(mesh.positions[mesh.triangles[t][c]]);
    std::array<Index, 3> sorted = at;
    std::ranges::sort(sorted);
    if (sorted[0] == sorted[1] || sorted[1] == sorted[2]) continue;  // collapsed by the grid
    if (!faces.insert(sorted).second) {
      ++rim.duplicate_faces;
      continue;
    }
    for (int c = 0; c < 3; ++c) {
      const Index from = at[c], to = at[(c + 1) % 3];
      edges[{std::min(from, to), std::max(from, to)}].push_back({t, c});
    }
  }
  Patches patches(part);
  for (const auto& [ends, sides] : edges)
    if (sides.size() == 2 && goes_on(mesh, sides, size, places)) patches.join(sides[0].triangle, sides[1].triangle);
  patches.weigh(mesh);

  for (const auto& [ends, sides] : edges) {
    if (sides.size() == 2 && patches.same(sides[0].triangle, sides[1].triangle)) continue;
    rim.non_manifold_edges += sides.size() > 2;
    RimEdge edge;
    for (const Side& side : sides) {
      if (!patches.is_skin(side.triangle)) continue;
      const auto& corners = mesh.triangles[side.triangle];
      const Vec3 &from = mesh.positions[corners[side.corner]], &to = mesh.positions[corners[(side.corner + 1) % 3]];
      const bool from_low = places.at(from) == ends.first;
      edge.p0 = from_low ? from : to, edge.p1 = from_low ? to : from;
      edge.faces.push_back(rim_face(mesh, side, from_low));
    }
    if (!edge.faces.empty()) rim.edges.push_back(std::move(edge));
  }
  return rim;
}

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Segments = std::vector<Kernel::Segment_3>;
using Triangles = std::vector<Kernel::Triangle_3>;
// CGAL 6 names its trees by their dimension.
#if CGAL_VERSION_MAJOR >= 6
using OfSegments = CGAL::AABB_traits_3<Kernel, CGAL::AABB_segment_primitive_3<Kernel, Segments::const_iterator>>;
using OfTriangles = CGAL::AABB_traits_3<Kernel, CGAL::AABB_triangle_primitive_3<Kernel, Triangles::const_iterator>>;
#else
using OfSegments = CGAL::AABB_traits<Kernel, CGAL::AABB_segment_primitive<Kernel, Segments::const_iterator>>;
using OfTriangles = CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>;
#endif
using SegmentTree = CGAL::AABB_tree<OfSegments>;
using TriangleTree = CGAL::AABB_tree<OfTriangles>;

Point point(const Vec3& v) {
  return {v.x, v.y, v.z};
}
Vec3 vec(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

// The rim of a part, and which of its edges is nearest to a point.
class RimTree {
 public:
  explicit RimTree(Rim rim) : rim_(std::move(rim)) {
    for (const RimEdge& edge : rim_.edges) segments_.emplace_back(point(edge.p0), point(edge.p1));
    tree_.rebuild(segments_.cbegin(), segments_.cend());
    tree_.accelerate_distance_queries();
  }
  RimTree(const RimTree&) = delete;

  const Rim& rim() const { return rim_; }

  struct Nearest {
    Vec3 at;
    const RimEdge* edge;
  };
  Nearest nearest(const Vec3& p) const {
    const auto [at, segment] = tree_.closest_point_and_primitive(point(p));
    return {vec(at), &rim_.edges[static_cast<std::size_t>(segment - segments_.cbegin())]};
  }

 private:
  Rim rim_;
  Segments segments_;
  SegmentTree tree_;
};

// All triangles of the mesh: whatever can cover a seam.
class Cover {
 public:
  explicit Cover(const Mesh& mesh) {
    for (const auto& [i, j, k] : mesh.triangles)
      triangles_.emplace_back(point(mesh.positions[i]), point(mesh.positions[j]), point(mesh.positions[k]));
    tree_.rebuild(triangles_.cbegin(), triangles_.cend());
  }
  Cover(const Cover&) = delete;

  bool lies_over(const Vec3& from, const Vec3& direction) const {
    return tree_.do_intersect(Kernel::Ray_3(point(from), Kernel::Vector_3(direction.x, direction.y, direction.z)));
  }

 private:
  Triangles triangles_;
  TriangleTree tree_;
};

// Keeps the sides of every edge that can be seen from outside, and turns their normals outward. Edges without such a
// side go. Returns how many sides were turned.
int keep_what_is_seen(Rim& rim, const Cover& cover, double size) {
  int turned = 0;
  const double off = 1e-4 * size;
  for (RimEdge& edge : rim.edges) {
    std::erase_if(edge.faces, [&](RimFace& face) {
      const Vec3 at = 0.5 * (edge.p0 + edge.p1) + off * face.inward, n = normalized(face.normal0 + face.normal1);
      if (!cover.lies_over(at + off * n, n)) return false;
      if (cover.lies_over(at - off * n, -n)) return true;
      face.normal0 = -face.normal0, face.normal1 = -face.normal1;
      ++turned;
      return false;
    });
  }
  std::erase_if(rim.edges, [](const RimEdge& edge) { return edge.faces.empty(); });
  return turned;
}

// The two sides, one of each edge, whose normals differ least.
struct Pair {
  Vec3 normal_a, normal_b, inward_a;
  double cosine = -2;
};
Vec3 normal_at(const RimEdge& edge, const RimFace& face, const Vec3& at) {
  const Vec3 way = edge.p1 - edge.p0;
  const double part = std::clamp(dot(at - edge.p0, way) / dot(way, way), 0.0, 1.0);
  return normalized((1 - part) * face.normal0 + part * face.normal1);
}
Pair best_pair(const RimEdge& a, const Vec3& at_a, const RimEdge& b, const Vec3& at_b) {
  Pair best;
  for (const RimFace& x : a.faces)
    for (const RimFace& y : b.faces) {
      const Vec3 n = normal_at(a, x, at_a), m = normal_at(b, y, at_b);
      if (dot(n, m) > best.cosine) best = {n, m, x.inward, dot(n, m)};
    }
  return best;
}

const double kLeastCosine = std::cos(30 * kDegree);  // sides further apart are not meant to be one surface
constexpr double kFacing = 0.7;  // of the way from edge to edge, across the first one; less is around a corner

void measure(SeamPoint& p, double unit_m) {
  const Vec3 apart = p.b - p.a;
  const double flush = dot(apart, p.normal_a);
  p.flush_mm = flush * unit_m * 1e3;
  p.gap_mm = length(apart - flush * p.normal_a) * unit_m * 1e3;
  p.angle_deg = std::atan2(length(cross(p.normal_a, p.normal_b)), dot(p.normal_a, p.normal_b)) / kDegree;
  p.fold_deg = std::atan2(dot(p.normal_b, p.across), dot(p.normal_b, p.normal_a)) / kDegree;
}

// The points in their order along the seam: from an end always on to the nearest point that is left. Where that one is
// far away, a new run begins.
std::vector<SeamPoint> in_order(std::vector<SeamPoint> points, double spacing) {
  std::vector<SeamPoint> ordered;
  const auto nearest_to = [&](const Vec3& p) {
    return std::ranges::min_element(points, {}, [&](const SeamPoint& q) { return length(q.a - p); });
  };
  int run = -1;
  while (!points.empty()) {
    auto next = points.begin();
    bool leap = true;
    if (!ordered.empty()) {
      next = nearest_to(ordered.back().a);
      leap = length(next->a - ordered.back().a) > 6 * spacing;
    }
    if (leap) {
      // An end of this run is the point that is furthest from any of its points. Twice, for a better one.
      for (int i = 0; i < 2; ++i) {
        const Vec3 from = next->a;
        double furthest = -1;
        std::vector<Vec3> reached = {from};
        std::vector<bool> seen(points.size(), false);
        for (std::size_t r = 0; r < reached.size(); ++r)
          for (std::size_t q = 0; q < points.size(); ++q) {
            if (seen[q] || length(points[q].a - reached[r]) > 6 * spacing) continue;
            seen[q] = true;
            reached.push_back(points[q].a);
            if (length(points[q].a - from) > furthest)
              furthest = length(points[q].a - from), next = points.begin() + static_cast<std::ptrdiff_t>(q);
          }
      }
      ++run;
    }
    next->run = run;
    next->distance_m = leap ? 0 : ordered.back().distance_m + length(next->a - ordered.back().a);
    ordered.push_back(*next);
    points.erase(next);
  }
  return ordered;
}

Result<const MeshPart*> part_of(const Mesh& mesh, const std::string& name) {
  for (const MeshPart& part : mesh.parts)
    if (part.name == name) return &part;
  return input_error("the mesh has no part \"{}\": it has {}", name, joined(mesh.parts, ", ", &MeshPart::name));
}

double nearest_distance(const RimTree& a, const RimTree& b) {
  double least = std::numeric_limits<double>::infinity();
  for (const RimEdge& edge : a.rim().edges)
    for (const Vec3& p : {edge.p0, edge.p1, 0.5 * (edge.p0 + edge.p1)})
      least = std::min(least, length(b.nearest(p).at - p));
  return least;
}

// The two rims as they are seen from outside; notes what was repaired.
Result<std::array<Rim, 2>> seen_rims(const Mesh& mesh, const std::array<const MeshPart*, 2>& parts, double size,
                                     Seam::Repairs& repairs) {
  const Cover cover(mesh);
  std::array<Rim, 2> rims;
  for (std::size_t i = 0; i < 2; ++i) {
    Rim& rim = rims[i] = rim_of(mesh, *parts[i], size);
    if (rim.edges.empty())
      return input_error(
          "part \"{}\" has no open edge, fold or tight bend where its skin ends: there is nothing to make a seam of",
          parts[i]->name);
    repairs.duplicate_faces += rim.duplicate_faces;
    repairs.non_manifold_edges += rim.non_manifold_edges;
    repairs.turned += keep_what_is_seen(rim, cover, size);
    if (rim.edges.empty())
      return input_error("every edge of part \"{}\" is covered by other surfaces: there is no seam to be seen",
                         parts[i]->name);
  }
  return rims;
}

// The places `spacing` apart where edges face each other across at most `limit`, not in order.
std::vector<SeamPoint> facing_points(const RimTree& rim_a, const RimTree& rim_b, double limit, double spacing,
                                     Seam& seam) {
  std::vector<SeamPoint> points;
  for (const RimEdge& edge : rim_a.rim().edges) {
    const Vec3 way = edge.p1 - edge.p0;
    const double edge_length = length(way);
    const int pieces = std::max(1, static_cast<int>(std::ceil(edge_length / spacing)));
    for (int i = 0; i < pieces; ++i) {
      const Vec3 at = edge.p0 + ((i + 0.5) / pieces) * way;
      const RimTree::Nearest other = rim_b.nearest(at);
      const double apart = length(other.at - at);
      // They face each other where each is the other's nearest, within half their distance.
      if (apart > limit || length(rim_a.nearest(other.at).at - at) > 0.5 * apart + 0.01 * spacing) continue;
      const Pair pair = best_pair(edge, at, *other.edge, other.at);
      if (pair.cosine < kLeastCosine) {
        ++seam.not_continued;
        continue;
      }
      SeamPoint p{at, other.at, pair.normal_a, pair.normal_b, (1 / edge_length) * way, -pair.inward_a};
      // The smooth normal may differ from the face's own, so the direction across is made perpendicular to it.
      p.across = normalized(p.across - dot(p.across, p.normal_a) * p.normal_a);
      const Vec3 between = (other.at - at) - dot(other.at - at, p.normal_a) * p.normal_a;
      if (length(between) > 0.01 * spacing && dot(between, p.across) < kFacing * length(between)) continue;
      measure(p, seam.unit_m);
      points.push_back(p);
    }
  }
  return points;
}

Error no_seam(const MeshPart& a, const MeshPart& b, double nearest_mm, double limit_mm) {
  if (nearest_mm > limit_mm)
    return input_error(
        "\"{}\" and \"{}\" do not touch: their edges are {:.4g} mm apart at the nearest, and a gap up to {:.4g} mm is "
        "a seam",
        a.name, b.name, nearest_mm, limit_mm);
  return input_error(
      "the surfaces of \"{}\" and \"{}\" come near each other and nowhere continue each other within 30 deg: there is "
      "nothing to match",
      a.name, b.name);
}

}  // namespace

Result<Seam> seam_between(const Mesh& mesh, const std::string& part_a, const std::string& part_b,
                          const SeamOptions& options) {
  if (part_a == part_b) return input_error("the seam is between \"{}\" and itself: name two parts", part_a);
  GONIO_ASSIGN(const MeshPart* a, part_of(mesh, part_a));
  GONIO_ASSIGN(const MeshPart* b, part_of(mesh, part_b));
  const Box box = bounding_box(mesh);
  const double size = length(box.size()), spacing = size / 1000;
  Seam seam;
  seam.unit_guessed = !(options.unit_m > 0) && !(mesh.unit_m > 0);
  seam.unit_m = options.unit_m > 0 ? options.unit_m : length_unit(mesh).meters;
  const double unit_mm = seam.unit_m * 1e3, limit = options.max_gap_mm > 0 ? options.max_gap_mm / unit_mm : size / 100;

  GONIO_ASSIGN(auto rims, seen_rims(mesh, {a, b}, size, seam.repairs));
  const RimTree rim_a(std::move(rims[0])), rim_b(std::move(rims[1]));
  std::vector<SeamPoint> points = facing_points(rim_a, rim_b, limit, spacing, seam);
  if (points.empty()) return no_seam(*a, *b, nearest_distance(rim_a, rim_b) * unit_mm, limit * unit_mm);
  seam.points = in_order(std::move(points), spacing);
  for (std::size_t i = 0; i < seam.points.size(); ++i) {
    seam.points[i].distance_m *= seam.unit_m;
    if (i + 1 == seam.points.size() || seam.points[i + 1].run != seam.points[i].run)
      seam.length_m += seam.points[i].distance_m;
  }
  return seam;
}

}  // namespace goniochrome::mesh
