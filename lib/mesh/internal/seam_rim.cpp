#include "mesh/internal/seam_rim.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <set>

#include "base/angles.h"

namespace goniochrome::mesh {

namespace {

constexpr double kFold_rad = 30 * kPi / 180;
constexpr double kFlat_rad = 2 * kPi / 180;  // less is rounding of the file, whatever the size of the faces
constexpr double kLeastPatch = 0.01;         // of the part's area

using Index = std::uint32_t;

// Numbers for places, so that vertices which a file holds several times become one.
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

Vec3 face_normal(const Mesh& mesh, std::size_t triangle) {
  const auto& [i, j, k] = mesh.triangles[triangle];
  return normalized(cross(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i]));
}

double face_area(const Mesh& mesh, std::size_t triangle) {
  const auto& [i, j, k] = mesh.triangles[triangle];
  return length(cross(mesh.positions[j] - mesh.positions[i], mesh.positions[k] - mesh.positions[i])) / 2;
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

// Faces that hang together without a fold or a tight bend between them.
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

// Whether the surface goes on over an edge of two faces. Two sides that run the same way belong to faces of opposite
// sense: then their normals are compared as lines.
bool goes_on(const Mesh& mesh, const std::vector<Side>& sides, double size, Places& places) {
  const Vec3 a = face_normal(mesh, sides[0].triangle), b = face_normal(mesh, sides[1].triangle);
  const auto start = [&](const Side& s) { return places.at(mesh.positions[mesh.triangles[s.triangle][s.corner]]); };
  const double along = start(sides[0]) == start(sides[1]) ? -dot(a, b) : dot(a, b);
  const double angle = std::atan2(length(cross(a, b)), along);
  const double height = std::min(height_over(mesh, sides[0]), height_over(mesh, sides[1]));
  return angle < kFlat_rad || (angle < kFold_rad && height / angle > size / 200);
}

}  // namespace

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

}  // namespace goniochrome::mesh
