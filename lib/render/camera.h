// A camera says where a picture is taken from, and gives the rays through its pixels. In the world's axes +Y is up.
// goniochrome-rendering(7), "Cameras".
#pragma once

#include "base/result.h"
#include "base/vec3.h"
#include "mesh/mesh.h"

namespace goniochrome::render {

// The direction of azimuth and elevation: azimuth 0 is +Z, growing toward +X; elevation 90 is +Y. Cameras and lights
// use it alike.
Vec3 orbit_direction(double azimuth_deg, double elevation_deg);

struct Camera {
  Vec3 eye{0, 0, 1}, target;
  Vec3 up{0, 1, 0};
  double fov_deg = 30;  // vertical

  bool operator==(const Camera&) const = default;
  // The camera on the orbit about the middle of the mesh's bounding box. At distance 1 the mesh just fits into a
  // picture of this aspect (width/height) from every azimuth; the distance is a factor.
  static Camera orbit(const mesh::Mesh& mesh, double azimuth_deg, double elevation_deg, double distance, double fov_deg,
                      double aspect);
};

// A camera as rays: the direction through the point (x, y) of a picture, in pixels from its upper left corner, is
// normalized(corner + x*right + y*down). Pixel centers are at +.5.
struct Rays {
  Vec3 corner, right, down;
  Vec3 eye = {};  // where they begin
  Vec3 direction(double x, double y) const { return normalized(corner + x * right + y * down); }
  // These rays with the sampled point of every pixel moved by dx, dy (pixels).
  Rays shifted(double dx, double dy) const { return {corner + dx * right + dy * down, right, down, eye}; }
};
// Error (usage): the eye is the target, or the fov is outside (0,180). An up vector along the line of sight is
// replaced.
Result<Rays> rays(const Camera& camera, int width, int height);

}  // namespace goniochrome::render
