#include "mesh/mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <unordered_map>

#include "base/angles.h"
#include "base/file.h"
#include "base/paths.h"
#include "base/text.h"
#include "mesh/internal/polygons.h"

namespace goniochrome::mesh {

// From polygons to triangles with a normal at every vertex.
namespace {

struct Point2 {
  double x, y;
};

// Twice the signed area of a triangle, positive counter-clockwise.
double doubled_area(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool inside(const Point2& p, const Point2& a, const Point2& b, const Point2& c) {
  return doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0;
}

// The polygon in the plane across its mean normal, from where it turns counter-clockwise. The normal is Newell's, the
// sum of the cross products about the first corner.
std::vector<Point2> flattened(const std::vector<Vec3>& ring) {
  Vec3 normal;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) normal += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  const double size = length(normal);
  if (!(size > 0)) return {};
  const Vec3 z = (1 / size) * normal;
  const Vec3 x = normalized(std::abs(z.x) < 0.7 ? Vec3{0, z.z, -z.y} : Vec3{-z.z, 0, z.x});
  const Vec3 y = cross(z, x);
  std::vector<Point2> flat;
  for (const Vec3& p : ring) flat.push_back({dot(p - ring[0], x), dot(p - ring[0], y)});
  return flat;
}

// Whether the corner `at` of the remaining ring can be cut off: it turns left, and no other corner lies in the cut.
bool is_ear(const std::vector<Point2>& flat, const std::vector<std::uint32_t>& left, std::size_t at) {
  const std::size_t n = left.size(), before = (at + n - 1) % n, after = (at + 1) % n;
  const Point2 &a = flat[left[before]], &b = flat[left[at]], &c = flat[left[after]];
  if (doubled_area(a, b, c) <= 0) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (i == before || i == at || i == after) continue;
    if (inside(flat[left[i]], a, b, c)) return false;
  }
  return true;
}

// Faces that meet at a sharper edge than this do not share a made normal.
const double kCreaseCosine = std::cos(60 * kDegree);

// A triangle whose height is less than this part of its longest edge has no area: its direction is rounding noise.
constexpr double kFlatness = 1e-10;

struct Triangle {
  std::array<Polygons::Corner, 3> corners;
  std::uint32_t part;
  Vec3 normal;  // unit, from the winding
};

struct HashVec3 {
  std::size_t operator()(const Vec3& v) const {
    std::size_t hash = 0;
    for (const double c : {v.x, v.y, v.z}) {
      hash = (hash ^ std::bit_cast<std::uint64_t>(c + 0.0)) * 0x9E3779B97F4A7C15U;  // + 0.0 joins -0 and 0
      hash ^= hash >> 29;
    }
    return hash;
  }
};

// Corners that agree in these are one vertex.
struct VertexKey {
  std::uint64_t position_and_normal;
  std::int32_t texture;
  friend bool operator==(const VertexKey&, const VertexKey&) = default;
};
struct HashVertexKey {
  std::size_t operator()(const VertexKey& key) const {
    std::size_t hash = (key.position_and_normal ^ static_cast<std::uint32_t>(key.texture)) * 0x9E3779B97F4A7C15U;
    return hash ^ (hash >> 29);
  }
};

std::vector<Triangle> triangles_of(const Polygons& polygons, Mesh::Repairs& repairs) {
  std::vector<Triangle> triangles;
  std::vector<Vec3> ring;
  for (const Polygons::Face& face : polygons.faces) {
    ring.clear();
    for (std::uint32_t i = 0; i < face.count; ++i) {
      ring.push_back(polygons.positions[polygons.corners[face.first + i].position]);
    }
    if (face.count > 3) ++repairs.polygons_split;
    for (const auto& [i, j, k] : triangulated(ring)) {
      const Vec3 a = ring[j] - ring[i], b = ring[k] - ring[i], c = ring[k] - ring[j];
      const Vec3 doubled = cross(a, b);
      const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
      const double size = length(doubled);
      if (!(size > kFlatness * longest)) {
        ++repairs.degenerate_dropped;
        continue;
      }
      triangles.push_back(
          {{polygons.corners[face.first + i], polygons.corners[face.first + j], polygons.corners[face.first + k]},
           face.part,
           (1 / size) * doubled});
    }
  }
  return triangles;
}

// The file's normals say which side is outside; a triangle wound against them is turned.
void turn_to_normals(std::vector<Triangle>& triangles, const std::vector<Vec3>& normals, Mesh::Repairs& repairs) {
  for (Triangle& t : triangles) {
    double agreement = 0;
    for (const auto& corner : t.corners) {
      if (corner.normal != kNoNormal) agreement += dot(t.normal, normals[static_cast<std::size_t>(corner.normal)]);
    }
    if (agreement >= 0) continue;
    std::swap(t.corners[1], t.corners[2]);
    t.normal = -t.normal;
    ++repairs.triangles_turned;
  }
}

// Normals for the corners that have none: the mean of the normals of the triangles that meet there within the crease
// angle, each weighted by its angle at the vertex, which does not depend on how the surface was cut into triangles
// (Thuermer and Wuethrich 1998). Vertices at the same place are one vertex here, whatever their number in the file.
void make_normals(std::vector<Triangle>& triangles, const std::vector<Vec3>& positions, std::vector<Vec3>& normals) {
  struct Incident {
    std::size_t triangle;
    double angle_rad;
  };
  std::unordered_map<Vec3, std::vector<Incident>, HashVec3> around;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = positions[triangles[i].corners[k].position];
      const Vec3 a = positions[triangles[i].corners[(k + 1) % 3].position] - p;
      const Vec3 b = positions[triangles[i].corners[(k + 2) % 3].position] - p;
      around[p].push_back({i, std::atan2(length(cross(a, b)), dot(a, b))});
    }
  }
  std::unordered_map<Vec3, std::int32_t, HashVec3> index_of;  // equal normals are stored once
  for (Triangle& t : triangles) {
    for (auto& corner : t.corners) {
      if (corner.normal != kNoNormal) continue;
      Vec3 sum;
      for (const Incident& other : around[positions[corner.position]]) {
        const Vec3& n = triangles[other.triangle].normal;
        if (dot(n, t.normal) >= kCreaseCosine) sum += other.angle_rad * n;
      }
      const Vec3 normal = normalized(sum);
      const auto [entry, is_new] = index_of.try_emplace(normal, static_cast<std::int32_t>(normals.size()));
      if (is_new) normals.push_back(normal);
      corner.normal = entry->second;
    }
  }
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulated(const std::vector<Vec3>& ring) {
  std::vector<std::uint32_t> left(ring.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  const std::vector<Point2> flat = ring.size() > 3 ? flattened(ring) : std::vector<Point2>{};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // A warped quad is folded along its shorter diagonal, if both are inside.
  std::size_t at = ring.size() == 4 && length(ring[2] - ring[0]) > length(ring[3] - ring[1]) ? 0 : 1;
  while (left.size() > 3) {
    if (!flat.empty()) {
      for (std::size_t tries = 0; tries < left.size() && !is_ear(flat, left, at); ++tries) at = (at + 1) % left.size();
    }
    const std::size_t n = left.size();
    triangles.push_back({left[(at + n - 1) % n], left[at], left[(at + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    at = (at + 1) % left.size();  // not the neighbor at once: even triangles instead of a fan of slivers
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

Result<Mesh> mesh_from_polygons(const Polygons& polygons, const std::string& path) {
  Mesh mesh;
  std::vector<Triangle> triangles = triangles_of(polygons, mesh.repairs);
  if (triangles.empty()) {
    return input_error("{}: none of its {} faces has an area: check the units of the export", path,
                       polygons.faces.size());
  }
  turn_to_normals(triangles, polygons.normals, mesh.repairs);
  std::vector<Vec3> normals = polygons.normals;
  make_normals(triangles, polygons.positions, normals);

  std::vector<std::vector<std::size_t>> members(polygons.parts.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) members[triangles[i].part].push_back(i);
  std::unordered_map<VertexKey, std::uint32_t, HashVertexKey> vertex_of;
  for (std::size_t part = 0; part < members.size(); ++part) {
    if (members[part].empty()) continue;
    mesh.parts.push_back(
        {polygons.parts[part].name, polygons.parts[part].material, mesh.triangles.size(), members[part].size()});
    for (const std::size_t i : members[part]) {
      std::array<std::uint32_t, 3> triangle;
      for (int k = 0; k < 3; ++k) {
        const Polygons::Corner& corner = triangles[i].corners[k];
        const VertexKey key = {std::uint64_t{corner.position} << 32 | static_cast<std::uint32_t>(corner.normal),
                               corner.texture};
        const auto [entry, is_new] = vertex_of.try_emplace(key, static_cast<std::uint32_t>(mesh.positions.size()));
        triangle[k] = entry->second;
        if (!is_new) continue;
        const auto normal = static_cast<std::size_t>(corner.normal);
        mesh.positions.push_back(polygons.positions[corner.position]);
        mesh.normals.push_back(normals[normal]);
        if (!polygons.texture.empty())
          mesh.texture.push_back(corner.texture == kNoTexture
                                     ? std::array<float, 2>{}
                                     : polygons.texture[static_cast<std::size_t>(corner.texture)]);
        if (normal >= polygons.normals.size()) ++mesh.repairs.normals_made;
      }
      mesh.triangles.push_back(triangle);
    }
  }
  return mesh;
}

Box bounding_box(const Mesh& mesh) {
  if (mesh.positions.empty()) return {};
  Box box{mesh.positions.front(), mesh.positions.front()};
  for (const Vec3& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], p[axis]);
      box.high[axis] = std::max(box.high[axis], p[axis]);
    }
  }
  return box;
}

namespace {

// The keyword of an OFF file: OFF, behind letters for what else each vertex has (ST, C, N, 4, n).
bool is_off_keyword(std::string_view word) {
  if (!word.ends_with("OFF")) return false;
  word.remove_suffix(3);
  if (word.starts_with("ST")) word.remove_prefix(2);
  return word.size() <= 4 && word.find_first_not_of("CN4n") == std::string_view::npos;
}

// A binary STL file has a header of 80 bytes, the number of triangles, and 50 bytes for each of them. Its header may
// begin with "solid" as the text form does.
bool is_binary_stl(std::string_view content) {
  std::uint32_t triangles = 0;
  if (content.size() < 84) return false;
  std::memcpy(&triangles, content.data() + 80, sizeof triangles);
  return content.size() == 84 + std::size_t{50} * triangles;
}

// The ending that a mesh of this content would have. OBJ is what is left, since it has no mark of its own.
std::string extension_by_content(std::string_view content) {
  if (content.starts_with("ply\n") || content.starts_with("ply\r")) return ".ply";
  std::string_view first = content;
  while (first.starts_with('#') || first.starts_with('\n') || first.starts_with('\r'))
    first.remove_prefix(std::min(first.size(), first.starts_with('#') ? first.find('\n') : 1));
  first = first.substr(0, first.find_first_of(" \t\r\n"));
  if (is_off_keyword(first)) return ".off";
  return first == "solid" || is_binary_stl(content) ? ".stl" : ".obj";
}

}  // namespace

Result<Mesh> read_mesh(const std::string& path) {
  const std::filesystem::path file(path);
  std::string extension = lower(file.extension().string());
  constexpr std::array kKnown = {"", ".obj", ".off", ".ply", ".stl"};
  if (std::ranges::find(kKnown, extension) == kKnown.end())
    return input_error("{}: \"{}\" is no mesh format known here: give .obj (with parts), .off, .ply or .stl", path,
                       extension);
  if (path.empty()) return input_error("the name of a mesh is empty: name a file");
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::string content, input.rest(std::string::npos));
  if (extension.empty()) extension = extension_by_content(content);
  const Source source{input.name(), is_plain_file(path) ? file.stem().string() : "mesh"};
  GONIO_ASSIGN(const Polygons polygons, extension == ".obj" ? polygons_from_obj(content, source)
                                                            : polygons_from_soup(content, extension, source));
  return mesh_from_polygons(polygons, source.name);
}

}  // namespace goniochrome::mesh
