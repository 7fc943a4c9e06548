// An environment is the radiance from every direction, kept as it came from its file, without resampling.
// [McAllister2002] 6.1 for cubes; goniochrome-prefiltering(7), "ENVIRONMENTS".
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "envmap/cube_map.h"
#include "envmap/rotation.h"
#include "envmap/sphere_grid.h"
#include "image/image.h"

namespace goniochrome::envmap {

// A clip takes away the excess of a texel: one above `most` in some channel is scaled so that its largest channel is
// `to`.
struct Clip {
  float most = std::numeric_limits<float>::infinity(), to = 0;

  std::array<float, 3> left_of(const float* rgb) const {
    const float largest = std::max({rgb[0], rgb[1], rgb[2]});
    if (!(largest > most)) return {rgb[0], rgb[1], rgb[2]};
    const float scale = to / largest;
    return {scale * rgb[0], scale * rgb[1], scale * rgb[2]};
  }
};

// The outline of a mirror ball in a photograph: texels from its upper left corner.
struct BallDisc {
  double x = 0, y = 0, radius = 0;
};

// Piecewise constant radiance: one value, one exact solid angle and one center direction per texel. Working space.
// How the texels lie is told in sphere_grid.h.
class Environment {
 public:
  using Layout = SphereGrid::Layout;
  enum class BadPixels { kError, kZero };
  struct Counts {
    int nan = 0, infinite = 0, negative = 0;
    int out_of_gamut = 0;  // negative only in the working space; set to zero
    int total() const { return nan + infinite + negative; }
  };

  // Reads any supported image; linear Rec.709 unless tagged. Its shape says the layout: 2:1 (within one texel)
  // lat-long; 1:6 and 6:1 six faces +X -X +Y -Y +Z -Z; 4:3 and 3:4 a cross; 1:1 an angular probe; an OpenEXR `envmap`
  // attribute wins. A path with `{face}` stands for six files (see face_paths()). BadPixels::kError refuses the first
  // texel that is not finite or is negative, by name; kZero sets such texels to zero and counts them.
  static Result<Environment> read(const std::string& path, BadPixels bad_pixels);

  // A photograph of a mirror ball as a lat-long map: see unrolled_ball(). Without an outline, ball_disc() finds it.
  static Result<Environment> read_ball(const std::string& path, const std::optional<BallDisc>& outline,
                                       BadPixels bad_pixels);

  // Reads six files, in the order +X -X +Y -Y +Z -Z, in OpenGL's orientation.
  static Result<Environment> read_faces(const std::vector<std::string>& paths, BadPixels bad_pixels);

  // From pixels that are in the working space already.
  static Result<Environment> from_lat_long(image::Image rgb, BadPixels bad_pixels, const std::string& name);
  static Result<Environment> from_angular(image::Image rgb, BadPixels bad_pixels, const std::string& name);
  static Environment from_cube(const CubeMap& map, const std::string& name);
  static Result<Environment> from_cube_edges(image::Image strip, BadPixels bad_pixels, const std::string& name);

  // Copies the radiance to finer texels, none wider or higher than `most_rad`: each texel is cut into equal parts, so
  // nothing changes on the sphere. What is that fine already comes back as it is.
  Environment cut_to(double most_rad) const;
  // With every value times `factor`. Error: the first texel whose value a float cannot hold.
  Result<Environment> scaled(double factor) const;
  // With black in the place of every texel whose center, turned by `turn`, lies below the elevation (radians).
  Environment above(double elevation_rad, const Rotation& turn) const;

  const SphereGrid& grid() const { return grid_; }
  Layout layout() const { return grid_.layout(); }
  int width() const { return grid_.width(); }
  int height() const { return grid_.height(); }
  const Counts& replaced() const { return replaced_; }
  const std::string& source() const { return source_; }
  // The outline of the mirror ball that it was unrolled from, if it was.
  const std::optional<BallDisc>& ball() const { return ball_; }
  // True if it was read as an angular probe whose corners hold light, which suits the photograph of a ball better.
  bool lit_corners() const { return lit_corners_; }
  const std::vector<float>& values() const { return rgb_; }  // row by row, three to a texel

  // Texel by column and row of the stored layout.
  const float* radiance(int column, int row) const {
    return &rgb_[3 * (static_cast<std::size_t>(row) * width() + column)];
  }
  Vec3 texel(int column, int row) const { return vec3(radiance(column, row)); }
  double solid_angle(int column, int row) const { return grid_.solid_angle(column, row); }
  Vec3 direction(int column, int row) const { return grid_.direction(column, row); }
  double solid_angle(double column0, double row0, double column1, double row1) const {
    return grid_.solid_angle(column0, row0, column1, row1);
  }
  Vec3 direction_at(double column, double row) const { return grid_.direction_at(column, row); }
  double solid_angle_density(double column, double row) const { return grid_.solid_angle_density(column, row); }
  double radius_rad(double column0, double row0, double column1, double row1) const {
    return grid_.radius_rad(column0, row0, column1, row1);
  }
  double largest_texel_rad() const { return grid_.largest_texel_rad(); }

  // The texel that a direction falls in.
  const float* lookup(const Vec3& direction) const {
    return &rgb_[3 * static_cast<std::size_t>(grid_.texel(direction))];
  }

  // Radiance bilinear between the centers of texels, as a mirror shows it. The texels at the edges of a cube's faces
  // and those of an angular map are not blended.
  Vec3 blended(const Vec3& direction) const;

  // With single texels scaled: by column and row, and a factor of 0 or more.
  struct Dimmed {
    int column = 0, row = 0;
    double factor = 1;
  };
  Environment dimmed(const std::vector<Dimmed>& texels) const;

  // sum of radiance * solid angle, per channel, of what `clip` leaves.
  Vec3 flux(const Clip& clip = {}) const;

 private:
  friend class EnvironmentReader;

  SphereGrid grid_;
  std::vector<float> rgb_;
  std::string source_;
  Counts replaced_;
  std::optional<BallDisc> ball_;
  bool lit_corners_ = false;
};

// The six paths that a pattern with `{face}` stands for, in the order +X -X +Y -Y +Z -Z: the first of the spellings
// px.., posx.., right.., +x.., 0.. whose first file exists. Error: what was tried.
Result<std::vector<std::string>> face_paths(const std::string& pattern);

}  // namespace goniochrome::envmap
