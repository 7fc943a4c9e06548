#include "mesh/seam.h"

#include <CGAL/AABB_segment_primitive.h>
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/angles.h"
#include "mesh/internal/seam_rim.h"

namespace goniochrome::mesh {

namespace {

using Kernel = CGAL::Simple_cartesian<double>;
using Point = Kernel::Point_3;
using Segments = std::vector<Kernel::Segment_3>;
using Triangles = std::vector<Kernel::Triangle_3>;
using SegmentTree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_segment_primitive<Kernel, Segments::const_iterator>>>;
using TriangleTree =
    CGAL::AABB_tree<CGAL::AABB_traits<Kernel, CGAL::AABB_triangle_primitive<Kernel, Triangles::const_iterator>>>;

Point point(const Vec3& v) {
  return {v.x, v.y, v.z};
}
Vec3 vec(const Point& p) {
  return {p.x(), p.y(), p.z()};
}

// The edges of a part, and the nearest of them to a point.
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

// Everything that can lie over a seam.
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

// Leaves of every edge the sides that can be seen from outside, their normals turned outward; edges without one go.
// Returns how many sides were turned.
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

// The two sides that continue each other best.
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

const double kLeastCosine = std::cos(30 * kPi / 180);  // sides further apart are not meant to be one surface
constexpr double kFacing = 0.7;  // of the way from edge to edge, across the first one; less is around a corner

void measure(SeamPoint& p, double unit_m) {
  const Vec3 apart = p.b - p.a;
  const double flush = dot(apart, p.normal_a);
  p.flush_mm = flush * unit_m * 1e3;
  p.gap_mm = length(apart - flush * p.normal_a) * unit_m * 1e3;
  p.angle_deg = std::atan2(length(cross(p.normal_a, p.normal_b)), dot(p.normal_a, p.normal_b)) * 180 / kPi;
  p.fold_deg = std::atan2(dot(p.normal_b, p.across), dot(p.normal_b, p.normal_a)) * 180 / kPi;
}

// Points in the order in which one meets them along the seam: from an end, always on to the nearest one left; a leap
// begins a new run.
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
      // An end: the point of the run at hand that is furthest from where one happened to land.
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
  std::vector<std::string> names;
  for (const MeshPart& part : mesh.parts) names.push_back(part.name);
  return input_error("the mesh has no part \"{}\": it has {}", name, fmt::join(names, ", "));
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
      // The smooth normal need not be the face's own: the way across is made perpendicular to it.
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
  const double size = length(box.high - box.low), spacing = size / 1000;
  Seam seam;
  seam.unit_guessed = !(options.unit_m > 0);
  seam.unit_m = seam.unit_guessed ? (size > 30 ? 1e-3 : 1) : options.unit_m;
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
