#include "mesh/mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>

#include "base/encoding.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/paths.h"
#include "base/text.h"
#include "mesh/internal/polygons.h"
#include "mesh/unit.h"

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

// True if the corner `at` of the remaining ring can be cut off: it turns left, and no other corner lies in the cut.
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

// A triangle whose height is less than this part of its longest edge has no area: its direction is rounding noise.
constexpr double kFlatness = 1e-10;

// Triangles of the faces [begin, end).
struct Triangles {
  std::vector<CornerTriangle> triangles;
  Mesh::Repairs repairs;
};

// The file's normals say which side is outside; a triangle wound against them is turned.
bool is_against(const CornerTriangle& t, const Vec3& normal, const std::vector<Vec3>& normals) {
  double agreement = 0;
  for (const Polygons::Corner& corner : t.corners)
    if (corner.normal != kNoNormal) agreement += dot(normal, normals[static_cast<std::size_t>(corner.normal)]);
  return agreement < 0;
}

Triangles triangles_of(const Polygons& polygons, std::size_t begin, std::size_t end) {
  Triangles made;
  made.triangles.reserve(end - begin);
  const std::vector<std::array<std::uint32_t, 3>> alone = {{0, 1, 2}};
  std::vector<Vec3> ring;
  for (std::size_t f = begin; f < end; ++f) {
    const Polygons::Face& face = polygons.faces[f];
    const Polygons::Corner* corners = &polygons.corners[face.first];
    ring.clear();
    for (std::uint32_t i = 0; i < face.count; ++i) ring.push_back(polygons.positions[corners[i].position]);
    if (face.count > 3) ++made.repairs.polygons_split;
    for (const auto& [i, j, k] : face.count == 3 ? alone : triangulated(ring)) {
      const Vec3 a = ring[j] - ring[i], b = ring[k] - ring[i], c = ring[k] - ring[j];
      const Vec3 doubled = cross(a, b);
      const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
      const double size = length(doubled);
      if (!(size > kFlatness * longest)) {
        ++made.repairs.degenerate_dropped;
        continue;
      }
      CornerTriangle triangle = {{corners[i], corners[j], corners[k]}, face.part};
      if (is_against(triangle, (1 / size) * doubled, polygons.normals)) {
        std::swap(triangle.corners[1], triangle.corners[2]);
        ++made.repairs.triangles_turned;
      }
      made.triangles.push_back(triangle);
    }
  }
  return made;
}

// The triangles of all faces, in their order. The corners and faces are given up.
std::vector<CornerTriangle> triangles_of(Polygons& polygons, Mesh::Repairs& repairs) {
  constexpr std::size_t kFaces = 1 << 15;
  const std::size_t faces = polygons.faces.size();
  std::vector<Triangles> chunks((faces + kFaces - 1) / kFaces);
  parallel_for(faces, kFaces, [&](std::size_t begin, std::size_t end) {
    chunks[begin / kFaces] = triangles_of(polygons, begin, end);
  });
  polygons.corners = {}, polygons.faces = {};
  std::size_t count = 0;
  for (const Triangles& chunk : chunks) count += chunk.triangles.size();
  std::vector<CornerTriangle> triangles;
  triangles.reserve(count);
  for (Triangles& chunk : chunks) {
    triangles.insert(triangles.end(), chunk.triangles.begin(), chunk.triangles.end());
    repairs.degenerate_dropped += chunk.repairs.degenerate_dropped;
    repairs.polygons_split += chunk.repairs.polygons_split;
    repairs.triangles_turned += chunk.repairs.triangles_turned;
    chunk = {};
  }
  return triangles;
}

// Numbers the vertices of a mesh: corners that agree in position, normal and texture are one vertex. The vertices of a
// position stand in a list, since there are few of them; where there are many, a table finds the rest.
class VertexNumbers {
 public:
  explicit VertexNumbers(std::size_t positions) : first_of_(positions, kNone) {}

  struct Number {
    std::uint32_t vertex;
    bool is_new;
  };
  Number number(const Polygons::Corner& corner) {
    std::uint32_t* link = &first_of_[corner.position];
    for (int steps = 0; steps < kMostSteps; ++steps) {
      if (*link == kNone) {
        *link = static_cast<std::uint32_t>(vertices_.size());
        return {add(corner), true};
      }
      Vertex& vertex = vertices_[*link];
      if (vertex.normal == corner.normal && vertex.texture == corner.texture) return {*link, false};
      link = &vertex.next;
    }
    const auto [entry, is_new] = others_.try_emplace({corner.position, corner.normal, corner.texture},
                                                     static_cast<std::uint32_t>(vertices_.size()));
    if (is_new) add(corner);
    return {entry->second, is_new};
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  static constexpr int kMostSteps = 16;
  struct Vertex {
    std::int32_t normal, texture;
    std::uint32_t next;
  };
  std::uint32_t add(const Polygons::Corner& corner) {
    vertices_.push_back({corner.normal, corner.texture, kNone});
    return static_cast<std::uint32_t>(vertices_.size() - 1);
  }

  std::vector<std::uint32_t> first_of_;  // of each position
  std::vector<Vertex> vertices_;
  std::map<std::array<std::int64_t, 3>, std::uint32_t> others_;
};

// The numbers of the triangles, part by part, and in each part in order.
std::vector<std::uint32_t> ordered_by_part(const std::vector<CornerTriangle>& triangles,
                                           std::vector<std::size_t>& count_of) {
  for (const CornerTriangle& t : triangles) ++count_of[t.part];
  std::vector<std::size_t> at(count_of.size());
  for (std::size_t part = 1; part < at.size(); ++part) at[part] = at[part - 1] + count_of[part - 1];
  std::vector<std::uint32_t> order(triangles.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) order[at[triangles[i].part]++] = static_cast<std::uint32_t>(i);
  return order;
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

Result<Mesh> mesh_from_polygons(Polygons polygons, const std::string& path) {
  Mesh mesh;
  mesh.remarks = std::move(polygons.remarks);
  const std::size_t faces = polygons.faces.size();
  if (polygons.corners.size() > std::numeric_limits<std::uint32_t>::max() / 3)
    return input_error("{}: its faces have {} corners, and {} are the most: split it", path, polygons.corners.size(),
                       std::numeric_limits<std::uint32_t>::max() / 3);
  std::vector<CornerTriangle> triangles = triangles_of(polygons, mesh.repairs);
  if (triangles.empty()) {
    return input_error("{}: none of its {} faces has an area: check the units of the export", path, faces);
  }
  const std::size_t given = polygons.normals.size();
  make_normals(triangles, polygons.positions, polygons.normals);

  std::vector<std::size_t> count_of(polygons.parts.size());
  const std::vector<std::uint32_t> order = ordered_by_part(triangles, count_of);
  for (std::size_t part = 0, first = 0; part < count_of.size(); first += count_of[part++]) {
    if (count_of[part] > 0) {
      const Polygons::Part& named = polygons.parts[part];
      mesh.parts.push_back({named.name, named.material, first, count_of[part], named.look});
    } else {
      mesh.repairs.parts_dropped.push_back(polygons.parts[part].name);
    }
  }
  const std::size_t guess = polygons.positions.size();
  mesh.positions.reserve(guess), mesh.normals.reserve(guess), mesh.triangles.reserve(triangles.size());
  VertexNumbers numbers(polygons.positions.size());
  for (const std::uint32_t i : order) {
    std::array<std::uint32_t, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) {
      const Polygons::Corner& corner = triangles[i].corners[k];
      const auto [vertex, is_new] = numbers.number(corner);
      triangle[k] = vertex;
      if (!is_new) continue;
      const auto normal = static_cast<std::size_t>(corner.normal);
      mesh.positions.push_back(polygons.positions[corner.position]);
      mesh.normals.push_back(polygons.normals[normal]);
      if (!polygons.texture.empty())
        mesh.texture.push_back(corner.texture == kNoTexture
                                   ? std::array<float, 2>{}
                                   : polygons.texture[static_cast<std::size_t>(corner.texture)]);
      if (normal >= given) ++mesh.repairs.normals_made;
    }
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

Box bounding_box(const Mesh& mesh) {
  if (mesh.positions.empty()) return {};
  Box box{mesh.positions.front(), mesh.positions.front()};
  for (const Vec3& position : mesh.positions) box.add(position);
  return box;
}

// Up to 8 sizes from the origin a float is within 2^-24 8 = 5e-7 sizes.
Vec3 float_origin(const Box& box) {
  constexpr double kNear = 8;
  return length(box.middle()) > kNear * length(box.size()) ? box.middle() : Vec3{};
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

// A text without the mark that editors write before it, and in UTF-8 where it is in UTF-16; other bytes as they are.
std::string plain_text(std::string content) {
  if (content.starts_with("\xff\xfe") || content.starts_with("\xfe\xff")) content = as_utf8(content);
  if (content.starts_with("\xef\xbb\xbf")) content.erase(0, 3);
  return content;
}

// Formats that other programs turn into one that is read here: an error that names the command.
Result<void> check_convertible(const std::string& path, const std::string& extension) {
  const std::string without = std::filesystem::path(path).replace_extension("").string();
  const std::string_view ending = extension;
  if (ending == ".usd" || ending == ".usda" || ending == ".usdc" || ending == ".usdz")
    return input_error(
        "{}: is USD, which is not read here: convert it to glTF, as with: blender -b --python-expr \"import bpy; "
        "bpy.ops.wm.usd_import(filepath='{}'); bpy.ops.export_scene.gltf(filepath='{}.glb')\"",
        path, path, without);
  if (ending == ".step" || ending == ".stp" || ending == ".iges" || ending == ".igs")
    return input_error(
        "{}: is {}, whose surfaces are no triangles yet: convert it to a mesh, as with: gmsh -2 -clcurv 40 {} -o "
        "{}.stl",
        path, ending.starts_with(".s") ? "STEP" : "IGES", path, without);
  return {};
}

// The ending that a mesh of this content would have. OBJ is what is left, since it has no mark of its own.
std::string extension_by_content(std::string_view content) {
  if (content.starts_with("ply\n") || content.starts_with("ply\r")) return ".ply";
  if (content.starts_with("glTF")) return ".glb";
  if (content.starts_with("#usda ") || content.starts_with("PXR-USDC")) return ".usd";
  if (content.starts_with("ISO-10303-21;")) return ".step";
  const std::size_t begin = content.find_first_not_of(" \t\r\n");
  if (begin != std::string_view::npos && content[begin] == '{') return ".gltf";
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
  constexpr std::array kKnown = {"", ".obj", ".gltf", ".glb", ".off", ".ply", ".stl"};
  GONIO_TRY(check_convertible(path, extension));
  if (std::ranges::find(kKnown, extension) == kKnown.end())
    return input_error(
        "{}: \"{}\" is no mesh format known here: give .obj, .gltf or .glb (with parts), .off, .ply or .stl", path,
        extension);
  if (path.empty()) return input_error("the name of a mesh is empty: name a file");
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(std::string content, input.rest(std::string::npos));
  if (!is_binary_stl(content)) content = plain_text(std::move(content));
  if (extension.empty()) extension = extension_by_content(content);
  GONIO_TRY(check_convertible(path, extension));
  const Source source{input.name(), is_plain_file(path) ? file.stem().string() : "mesh"};
  const bool is_gltf = extension == ".gltf" || extension == ".glb";
  const std::filesystem::path beside = file.has_parent_path() ? file.parent_path() : std::filesystem::path(".");
  const std::string folder = is_plain_file(path) ? beside.string() : "";
  GONIO_ASSIGN(Polygons polygons, extension == ".obj" ? polygons_from_obj(content, source)
                                  : is_gltf           ? polygons_from_gltf(content, source, folder)
                                                      : polygons_from_soup(content, extension, source));
  const double unit_m = is_gltf ? 1 : stated_unit_m(content);
  content = std::string();  // its memory is needed
  GONIO_ASSIGN(Mesh mesh, mesh_from_polygons(std::move(polygons), source.name));
  mesh.unit_m = unit_m;
  return mesh;
}

}  // namespace goniochrome::mesh
