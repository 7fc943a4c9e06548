// OFF, PLY and STL files, read by CGAL.
#include <CGAL/IO/polygon_soup_io.h>
#include <CGAL/Simple_cartesian.h>

#include <filesystem>

#include "mesh/internal/polygons.h"

namespace goniochrome::mesh {

Result<Polygons> polygons_from_file(const std::string& path, const std::string& part_name) {
  using Point = CGAL::Simple_cartesian<double>::Point_3;
  std::error_code status;
  if (std::filesystem::is_directory(path, status) || !std::filesystem::exists(path, status)) {
    return input_error("{}: cannot be read: {}", path, status ? status.message() : "no such file");
  }
  std::vector<Point> points;
  std::vector<std::vector<std::size_t>> faces;
  bool read = false;
  try {
    read = CGAL::IO::read_polygon_soup(path, points, faces, CGAL::parameters::verbose(false));
  } catch (const std::exception&) {
    read = false;
  }
  if (!read || faces.empty()) {
    return input_error("{}: not a whole {} mesh: export it again, or as OBJ, where errors can be told by line", path,
                       std::filesystem::path(path).extension().string().substr(1));
  }
  Polygons polygons;
  polygons.parts.push_back({part_name, ""});
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& p = points[i];
    if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z())) {
      return input_error("{}: vertex {} is not finite", path, i);
    }
    polygons.positions.push_back({p.x(), p.y(), p.z()});
  }
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i].size() < 3) return input_error("{}: face {} has fewer than three corners", path, i);
    polygons.faces.push_back({polygons.corners.size(), static_cast<std::uint32_t>(faces[i].size()), 0});
    for (const std::size_t index : faces[i]) {
      if (index >= points.size()) {
        return input_error("{}: face {} refers to vertex {}, but there are {}", path, i, index, points.size());
      }
      polygons.corners.push_back({static_cast<std::uint32_t>(index), kNoNormal});
    }
  }
  return polygons;
}

}  // namespace goniochrome::mesh
