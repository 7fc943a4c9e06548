// Triangle meshes of named parts, read from OBJ, glTF 2.0, OFF, PLY and STL files and mended on the way.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"

namespace goniochrome::mesh {

// The look of a material, as far as the file says more than its name: one that light passes, or polished metal.
enum class Look : std::uint8_t { kUnknown, kClear, kPolishedMetal };

// Triangles of one part are contiguous: [first, first + count). The material is that of the part's first face.
struct MeshPart {
  std::string name;
  std::string material;
  std::size_t first = 0, count = 0;
  Look look = Look::kUnknown;
};

// Indexed triangles, counter-clockwise seen from outside; one unit normal per vertex.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<MeshPart> parts;

  struct Repairs {
    int normals_made = 0;                         // vertices without a normal, which got one
    int degenerate_dropped = 0;                   // triangles without area
    int polygons_split = 0;                       // faces of more than three corners
    int triangles_turned = 0;                     // wound against the file's own normals
    std::vector<std::string> parts_dropped = {};  // names of parts none of whose faces has an area
  } repairs;

  std::vector<std::array<float, 2>> texture = {};  // u v of each vertex, v up; empty where the file has none
  std::vector<std::string> remarks = {};           // what the file says of the mesh that is not understood here
  double unit_m = 0;                               // of its lengths, where the format states it, as glTF does; else 0
};

struct Box {
  Vec3 low, high;

  Vec3 size() const { return high - low; }
  Vec3 middle() const { return 0.5 * (low + high); }
  double longest_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
  // Grows to hold a point.
  void add(const Vec3& point) {
    for (int axis = 0; axis < 3; ++axis)
      low[axis] = std::min(low[axis], point[axis]), high[axis] = std::max(high[axis], point[axis]);
  }
};
inline constexpr Box kEmptyBox = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
Box bounding_box(const Mesh& mesh);

// The middle of a box that lies so far from the origin, as in surveyors' coordinates, that floats are coarser there
// than 1e-6 of its size; else the origin. Whatever narrows positions to floats subtracts it before.
Vec3 float_origin(const Box& box);

// Reads OBJ, whose parts are its objects (`o`) or else its groups (`g`; a name that comes twice is one part); glTF 2.0
// or GLB, also packed by Draco or meshoptimizer, without what KHR_node_visibility hides, whose parts are the nodes of
// the scene with meshes, by their own names or those of the meshes, so that nodes of one name and material are one part
// (of one name in another material they are a part NAME.MATERIAL), and whose meshes in several materials give a part
// NAME.MATERIAL for each; or OFF, PLY or STL as a single part. Vertices without a normal get one: the mean over the
// faces around them, weighted by angle and broken at edges sharper than 60 degrees. Triangles without area are dropped.
// Both are counted. The ending of the name tells the format; where there is none, as with pipes and standard input, the
// content does. Errors name file, line and remedy.
Result<Mesh> read_mesh(const std::string& path);

}  // namespace goniochrome::mesh
