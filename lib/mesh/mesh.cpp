#include "mesh/mesh.h"

#include <algorithm>
#include <filesystem>

#include "base/file.h"
#include "base/text.h"
#include "mesh/internal/polygons.h"

namespace goniochrome::mesh {

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

Result<Mesh> read_mesh(const std::string& path) {
  const std::filesystem::path file(path);
  const std::string extension = lower(file.extension().string());
  if (extension == ".obj" || path == "-") {
    GONIO_ASSIGN(const std::string text, file_content(path));
    GONIO_ASSIGN(const Polygons polygons, polygons_from_obj(text, path));
    return mesh_from_polygons(polygons, path);
  }
  if (extension == ".off" || extension == ".ply" || extension == ".stl") {
    GONIO_ASSIGN(const Polygons polygons, polygons_from_file(path, file.stem().string()));
    return mesh_from_polygons(polygons, path);
  }
  return input_error("{}: \"{}\" is no mesh format known here: give .obj (with parts), .off, .ply or .stl", path,
                     extension);
}

}  // namespace goniochrome::mesh
