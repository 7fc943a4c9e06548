// OFF, PLY and STL files, read by CGAL. It reads a forged count as the size of an array, and is ended by a signal by a
// PLY file with a property before the first element, so it runs in a child process.
#include <CGAL/IO/OFF.h>
#include <CGAL/IO/PLY.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>
#include <cstring>
#include <sstream>

#include "base/child.h"
#include "base/text.h"
#include "mesh/internal/polygons.h"

namespace goniochrome::mesh {

namespace {

using Point = CGAL::Simple_cartesian<double>::Point_3;
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

// What the child hands over: the number of points and of faces, the coordinates, and each face as its number of corners
// and their indices.
void put(ChildOutput& output, const std::vector<Point>& points, const Faces& faces) {
  const std::uint64_t counts[] = {points.size(), faces.size()};
  output.write(counts, sizeof counts);
  constexpr std::size_t kBlock = 1 << 16;
  std::vector<double> coordinates;
  for (const Point& p : points) {
    coordinates.insert(coordinates.end(), {p.x(), p.y(), p.z()});
    if (coordinates.size() >= kBlock) output.write(coordinates.data(), 8 * coordinates.size()), coordinates.clear();
  }
  output.write(coordinates.data(), 8 * coordinates.size());
  std::vector<std::uint64_t> corners;
  for (const std::vector<std::size_t>& face : faces) {
    corners.push_back(face.size());
    corners.insert(corners.end(), face.begin(), face.end());
    if (corners.size() >= kBlock) output.write(corners.data(), 8 * corners.size()), corners.clear();
  }
  output.write(corners.data(), 8 * corners.size());
}

// Takes the numbers apart again, none of which is sure.
class Soup {
 public:
  Soup(std::string_view bytes, const std::string& path) : rest_(bytes), path_(path) {}

  Result<Polygons> polygons(const std::string& part_name) {
    std::uint64_t points = 0, faces = 0;
    if (!take(points) || !take(faces)) return lost();
    Polygons polygons;
    polygons.parts.push_back({part_name, ""});
    for (std::uint64_t i = 0; i < points; ++i) {
      Vec3 p;
      if (!take(p.x) || !take(p.y) || !take(p.z)) return lost();
      if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
        return input_error("{}: vertex {} is not finite", path_, i);
      polygons.positions.push_back(p);
    }
    for (std::uint64_t i = 0; i < faces; ++i) GONIO_TRY(take_face(i, polygons));
    return polygons;
  }

 private:
  template <class Number>
  bool take(Number& number) {
    if (rest_.size() < sizeof number) return false;
    std::memcpy(&number, rest_.data(), sizeof number);
    rest_.remove_prefix(sizeof number);
    return true;
  }
  Error lost() const {
    return input_error("{}: the library that reads it lost its way: the file is damaged: export it again", path_);
  }
  Result<void> take_face(std::uint64_t number, Polygons& polygons) {
    std::uint64_t count = 0;
    if (!take(count) || count > rest_.size() / 8) return lost();
    if (count < 3) return input_error("{}: face {} has fewer than three corners", path_, number);
    polygons.faces.push_back({polygons.corners.size(), static_cast<std::uint32_t>(count), 0});
    for (std::uint64_t corner = 0; corner < count; ++corner) {
      std::uint64_t index = 0;
      take(index);
      if (index >= polygons.positions.size())
        return input_error("{}: face {} refers to vertex {}, but there are {}", path_, number, index,
                           polygons.positions.size());
      polygons.corners.push_back({static_cast<std::uint32_t>(index), kNoNormal});
    }
    return {};
  }

  std::string_view rest_;
  const std::string& path_;
};

}  // namespace

Result<Polygons> polygons_from_soup(const std::string& content, const std::string& extension, const Source& source) {
  const std::string& path = source.name;
  GONIO_ASSIGN(
      const ChildBytes bytes, made_by_child(path, limits_for(content.size()), [&](ChildOutput& output) -> Result<void> {
        std::vector<Point> points;
        Faces faces;
        const bool is_ply = extension != ".ply" || content.starts_with("ply");
        if (!is_ply || !read_soup(content, extension, points, faces) || faces.empty())
          return input_error("{}: not a whole {} mesh: export it again, or as OBJ, where errors can be told by line",
                             path, extension.substr(1));
        put(output, points, faces);
        return {};
      }));
  return Soup(bytes.view(), path).polygons(source.part_name);
}

}  // namespace goniochrome::mesh
