// OFF, PLY and STL files, read by CGAL. It reads a forged count as the size of an array, and is ended by a signal by a
// PLY file with a property before the first element, so it runs in a child process.
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/IO/read_off_points.h>
#include <CGAL/IO/read_ply_points.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/property_map.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

#include "base/child.h"
#include "base/text.h"
#include "mesh/internal/polygons.h"
#include "mesh/internal/polygons_bytes.h"

namespace goniochrome::mesh {

namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
using Vector = CGAL::Simple_cartesian<double>::Vector_3;
using Faces = std::vector<std::vector<std::size_t>>;

// Addresses for a mesh: CGAL's own, and what its arrays take. A face of a binary PLY file has 4 bytes at least and
// takes 80 here, which a growing array doubles and which the child hands over once more.
ChildLimits limits_for(std::size_t file_bytes) {
  constexpr std::size_t kOwn = std::size_t{128} << 20, kArraysAByte = 64;
  return {kOwn + kArraysAByte * file_bytes, 60 + static_cast<int>(file_bytes >> 20)};
}

bool read_soup(const std::string& content, const std::string& extension, std::vector<Point>& points, Faces& faces) {
  std::istringstream stream(content);
  const auto quiet = CGAL::parameters::verbose(false);
  if (extension == ".off") return CGAL::IO::read_OFF(stream, points, faces, quiet);
  if (extension == ".ply") return CGAL::IO::read_PLY(stream, points, faces, quiet);
  return CGAL::IO::read_STL(stream, points, faces, quiet);
}

// True where the header of a PLY file gives its vertices one of these properties.
bool has_property(std::string_view ply, std::initializer_list<std::string_view> names) {
  const std::string_view header = ply.substr(0, ply.find("end_header"));
  return std::ranges::any_of(split(header, '\n'), [&](std::string_view line) {
    line = trimmed(line);
    return line.starts_with("property") && std::ranges::find(names, line.substr(line.rfind(' ') + 1)) != names.end();
  });
}

// The normals at the vertices, as the file has them; none where it has none.
std::vector<Vector> read_normals(const std::string& content, const std::string& extension) {
  std::istringstream stream(content);
  std::vector<Vector> normals;
  if (extension == ".ply" && has_property(content, {"nx"})) {
    if (!CGAL::IO::read_PLY_with_properties<Vector>(
            stream, std::back_inserter(normals),
            CGAL::IO::make_ply_normal_reader(CGAL::Identity_property_map<Vector>())))
      normals.clear();
  } else if (extension == ".off" && content.starts_with("NOFF")) {
    using Oriented = std::pair<Point, Vector>;
    std::vector<Oriented> read;
    const auto maps = CGAL::parameters::point_map(CGAL::First_of_pair_property_map<Oriented>())
                          .normal_map(CGAL::Second_of_pair_property_map<Oriented>());
    if (CGAL::IO::read_OFF<Oriented>(stream, std::back_inserter(read), maps))
      for (const Oriented& vertex : read) normals.push_back(vertex.second);
  }
  return normals;
}

// Gives each corner the normal of its vertex, if that has a length; the others have theirs made.
void take_normals(const std::vector<Vector>& normals, Polygons& polygons) {
  if (normals.size() != polygons.positions.size()) return;
  polygons.normals.reserve(normals.size());
  for (const Vector& n : normals) {
    const double size = std::hypot(n.x(), n.y(), n.z());
    const bool usable = size > 0 && std::isfinite(size);
    polygons.normals.push_back(usable ? Vec3{n.x() / size, n.y() / size, n.z() / size} : Vec3{});
  }
  for (Polygons::Corner& corner : polygons.corners)
    if (!(polygons.normals[corner.position] == Vec3{})) corner.normal = static_cast<std::int32_t>(corner.position);
}

// The points and faces as polygons of one part.
Result<Polygons> polygons_of(const std::vector<Point>& points, const Faces& faces, const Source& source) {
  Polygons polygons;
  polygons.parts.push_back({source.part_name, ""});
  polygons.positions.reserve(points.size());
  for (const Point& p : points) {
    if (!std::isfinite(p.x()) || !std::isfinite(p.y()) || !std::isfinite(p.z()))
      return input_error("{}: vertex {} is not finite", source.name, polygons.positions.size());
    polygons.positions.push_back({p.x(), p.y(), p.z()});
  }
  polygons.faces.reserve(faces.size());
  for (const std::vector<std::size_t>& face : faces) {
    const std::size_t number = polygons.faces.size();
    if (face.size() < 3) return input_error("{}: face {} has fewer than three corners", source.name, number);
    polygons.faces.push_back({polygons.corners.size(), static_cast<std::uint32_t>(face.size()), 0});
    for (const std::size_t index : face) {
      if (index >= points.size())
        return input_error("{}: face {} refers to vertex {}, but there are {}", source.name, number, index,
                           points.size());
      polygons.corners.push_back({static_cast<std::uint32_t>(index), kNoNormal});
    }
  }
  return polygons;
}

}  // namespace

Result<Polygons> polygons_from_soup(const std::string& content, const std::string& extension, const Source& source) {
  const std::string& path = source.name;
  GONIO_ASSIGN(
      const ChildBytes bytes, made_by_child(path, limits_for(content.size()), [&](ChildOutput& output) -> Result<void> {
        std::vector<Point> points;
        Faces faces;
        const bool is_ply = extension != ".ply" || content.starts_with("ply");
        if (!is_ply || !read_soup(content, extension, points, faces) || faces.empty())
          return input_error(
              "{}: not a whole {} mesh, or one of number types that are not read: export it again, or as OBJ, where "
              "errors can be told by line",
              path, extension.substr(1));
        GONIO_ASSIGN(Polygons polygons, polygons_of(points, faces, source));
        take_normals(read_normals(content, extension), polygons);
        if (extension == ".ply" && has_property(content, {"s", "u", "texture_u", "texcoord"}))
          polygons.remarks.emplace_back("texture coordinates of PLY are not read: export OBJ or glTF to keep them");
        put(output, polygons);
        return {};
      }));
  return polygons_of_bytes(bytes.view(), path);
}

}  // namespace goniochrome::mesh
