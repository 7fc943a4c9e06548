// The contents of a mesh file before it becomes a Mesh: polygons whose corners may lack normals.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "mesh/mesh.h"

namespace goniochrome::mesh {

constexpr std::int32_t kNoNormal = -1, kNoTexture = -1;

struct Polygons {
  struct Corner {
    std::uint32_t position = 0;
    std::int32_t normal = kNoNormal;
    std::int32_t texture = kNoTexture;
  };
  struct Face {
    std::size_t first = 0;  // of its corners
    std::uint32_t count = 0;
    std::uint32_t part = 0;
  };
  struct Part {
    std::string name, material;
    Look look = Look::kUnknown;
  };
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;                  // unit
  std::vector<std::array<float, 2>> texture;  // u v
  std::vector<Corner> corners;
  std::vector<Face> faces;
  std::vector<Part> parts;
  std::vector<std::string> remarks;
};

// Where the bytes of a mesh come from.
struct Source {
  std::string name;       // for messages
  std::string part_name;  // of the one part of a mesh that names none
};

// The polygons of an OBJ text. Errors name the line.
Result<Polygons> polygons_from_obj(std::string_view text, const Source& source);

// The polygons of the bytes of an OFF, PLY or STL file, as one part, with the normals of its vertices; those of STL are
// of faces and are not read. `extension` is ".off", ".ply" or ".stl".
Result<Polygons> polygons_from_soup(const std::string& content, const std::string& extension, const Source& source);

// The polygons of a glTF text or of the bytes of a GLB file. Files that it names lie in `folder`; "" is none. Errors
// name the element.
Result<Polygons> polygons_from_gltf(const std::string& content, const Source& source, const std::string& folder);

// Triangulates, drops what has no area, makes missing normals and turns triangles to their normals.
// Error: nothing is left, or there are more than 2^32 corners.
Result<Mesh> mesh_from_polygons(Polygons polygons, const std::string& path);

// A triangle of polygons, whose positions and normals it refers to.
struct CornerTriangle {
  std::array<Polygons::Corner, 3> corners;
  std::uint32_t part;
};

// Gives the corners without a normal one, which is appended to `normals`: the mean of the normals of the triangles that
// meet there within 60 degrees of its own triangle, each weighted by its angle at the vertex, which does not depend on
// how the surface was cut into triangles (Thuermer and Wuethrich 1998). Vertices at the same place are one vertex here,
// whatever their number in the file. Triangles must have an area.
void make_normals(std::vector<CornerTriangle>& triangles, const std::vector<Vec3>& positions,
                  std::vector<Vec3>& normals);

// The n-2 triangles of a simple polygon, as indices into `ring`, by ear clipping; concave ones included. A polygon that
// crosses itself still gives n-2 triangles.
std::vector<std::array<std::uint32_t, 3>> triangulated(const std::vector<Vec3>& ring);

}  // namespace goniochrome::mesh
