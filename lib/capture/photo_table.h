// The table of the photographs of a surface: which file, where the light and the camera were, and the exposure.
// fit-sbrdf(1).
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"

namespace goniochrome::capture {

// A light or a camera: a place, or a direction from which parallel rays come.
struct Station {
  Vec3 where;  // a point, or a unit vector where the rays are parallel
  bool parallel = false;

  // The unit direction to it from a point, and the distance; 1 where the rays are parallel.
  Vec3 direction(const Vec3& from) const { return parallel ? where : normalized(where - from); }
  double distance(const Vec3& from) const { return parallel ? 1 : length(where - from); }
};

// A place in a photograph, in pixels from the upper left edge of it: the middle of the first pixel is at .5, .5.
struct ImagePlace {
  double x = 0, y = 0;
};

// The corners of the plate in a photograph: upper left, upper right, lower right, lower left. A lens moves what is at
// the distance r from the middle, in half diagonals, to r (1 + k1 r^2).
struct Corners {
  std::array<ImagePlace, 4> at;
  double k1 = 0;
};

struct Photo {
  std::string image;  // its path
  int line = 0;       // of the table
  Station light, camera;
  double exposure = 1;                  // linear value of a white matte surface that faces a light at distance 1
  std::optional<Corners> corners = {};  // of the surface; none where the photograph shows nothing else
};

struct PhotoTable {
  std::string path;
  std::vector<Photo> photos;
};

// Reads a table in text (CSV), whose first row names its columns: image, light_x, light_y, light_z, camera_x, camera_y,
// camera_z and exposure, in any order; and light_distance or camera_distance, with which x, y and z are a direction
// (inf: the rays are parallel); and corner1_x, corner1_y to corner4_y and k1, see Corners. Paths of images are relative
// to the table. Lines that begin with # are remarks. Error: file, line and value.
Result<PhotoTable> read_photo_table(const std::string& path);

// True if these photographs can tell how the surface reflects. `width` and `height` are those of the surface, whose
// middle is the origin and whose normal is z. Error: a light or a camera that is not above the surface; fewer
// photographs than `least`; all from one side of the highlight; or all lights in one place.
Result<void> check_stations(const PhotoTable& table, double width, double height, int least);

}  // namespace goniochrome::capture
