// An environment: radiance from every direction, as it came from its file, without resampling. [McAllister2002] 6.1 for
// cubes; goniochrome-theory(7), ENVIRONMENTS.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "envmap/cube_map.h"
#include "image/image.h"

namespace goniochrome {

// Piecewise constant radiance: one value, one exact solid angle and one center direction per texel. Working space.
// Lat-long axes are OpenEXR's: +Y up, image center +Z, longitude growing leftward to +X.
class Environment {
 public:
  // kCube: OpenGL's faces as an N x 6N strip. kCubeEdges: the same with texel centers on the face edges (spacing
  // 2/(N-1)), as OpenEXR stores cubes: its outermost cells are half as wide.
  enum class Layout { kLatLong, kCube, kCubeEdges };
  enum class BadPixels { kError, kZero };
  struct Counts {
    int nan = 0, infinite = 0, negative = 0;
    int out_of_gamut = 0;  // negative only in the working space; set to zero
    int total() const { return nan + infinite + negative; }
  };

  // Reads any supported image; linear Rec.709 unless tagged. Its shape says the layout: 2:1 (within one texel)
  // lat-long; 1:6 and 6:1 six faces +X -X +Y -Y +Z -Z; 4:3 and 3:4 a cross; an OpenEXR `envmap` attribute wins. A path
  // with `{face}` stands for six files (see face_paths()). BadPixels::kError refuses the first texel that is not finite
  // or is negative, by name; kZero sets such texels to zero and counts them.
  static Result<Environment> read(const std::string& path, BadPixels bad_pixels);

  // The same from six files, in the order +X -X +Y -Y +Z -Z, in OpenGL's orientation.
  static Result<Environment> read_faces(const std::vector<std::string>& paths, BadPixels bad_pixels);

  // From pixels that are in the working space already.
  static Result<Environment> from_lat_long(Image rgb, BadPixels bad_pixels, const std::string& name);
  static Environment from_cube(const CubeMap& map, const std::string& name);
  // The same map with every texel scaled so that no channel exceeds `most`.
  Environment clipped(float most) const;
  static Result<Environment> from_cube_edges(Image strip, BadPixels bad_pixels, const std::string& name);

  Layout layout() const { return layout_; }
  int width() const { return width_; }  // of the lat-long image or of the N x 6N cube strip
  int height() const { return height_; }
  const Counts& replaced() const { return replaced_; }
  const std::string& source() const { return source_; }

  // Texel by column and row of the stored layout.
  const float* radiance(int column, int row) const {
    return &rgb_[3 * (static_cast<std::size_t>(row) * width_ + column)];
  }
  double solid_angle(int column, int row) const { return solid_angle(column, row, column + 1, row + 1); }
  Vec3 direction(int column, int row) const { return direction_at(column + 0.5, row + 0.5); }  // unit

  // Exact solid angle of a part of one texel, in continuous columns and rows; integers are texel edges.
  double solid_angle(double column0, double row0, double column1, double row1) const;
  Vec3 direction_at(double column, double row) const;  // unit

  // d(solid angle)/d(column, row) at a point: what a quadrature over a part of a texel weighs it by.
  double solid_angle_density(double column, double row) const;

  // A cube's continuous column, or row within a face, as the coordinate -1..1 of the face, and its derivative.
  double face_coordinate(double position) const;
  double face_slope(double position) const;

  // No point of that part of a texel is farther than this from the direction of its middle.
  double radius_rad(double column0, double row0, double column1, double row1) const;

  // No texel is wider or higher than this angle, in radians.
  double largest_texel_rad() const;

  // The texel that a direction falls in: the mirror lobe and the reference integrator.
  const float* lookup(const Vec3& direction) const;

  // sum of radiance * solid angle, per channel.
  Vec3 flux() const;

 private:
  friend class EnvironmentReader;

  Layout layout_ = Layout::kLatLong;
  int width_ = 0, height_ = 0;
  std::vector<float> rgb_;
  std::string source_;
  Counts replaced_;
};

// The six paths that a pattern with `{face}` stands for, in the order +X -X +Y -Y +Z -Z: the first of the spellings
// px.., posx.., right.., +x.., 0.. whose first file exists. Error: what was tried.
Result<std::vector<std::string>> face_paths(const std::string& pattern);

}  // namespace goniochrome
