#include "render/camera.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace goniochrome::render {

namespace {

constexpr double kBorder = 1.04;  // air around a mesh that "just fits"

// Right, down and forward, unit.
struct Axes {
  Vec3 right, down, forward;
};

Axes axes_of(const Camera& camera) {
  const Vec3 forward = normalized(camera.target - camera.eye);
  Vec3 side = cross(forward, camera.up);
  if (length(side) < 1e-9 * length(camera.up))
    side = cross(forward, std::abs(forward.z) < 0.9 ? Vec3{0, 0, -1} : Vec3{0, 1, 0});
  const Vec3 right = normalized(side);
  return {right, cross(forward, right), forward};
}

}  // namespace

Vec3 orbit_direction(double azimuth_deg, double elevation_deg) {
  const double a = azimuth_deg * kDegree, e = elevation_deg * kDegree;
  return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

// The mesh is enclosed by the upright cylinder about the middle of its box, so that the distance does not breathe while
// the camera goes around. A point at (x, y) across and z toward the eye is in the picture where
// distance >= z + max(|x|/(aspect t), |y|/t), t = tan(fov/2).
Camera Camera::orbit(const mesh::Mesh& mesh, double azimuth_deg, double elevation_deg, double distance, double fov_deg,
                     double aspect) {
  const mesh::Box box = mesh::bounding_box(mesh);
  const Vec3 middle = box.middle();
  double radius = 0;
  for (const Vec3& p : mesh.positions) radius = std::max(radius, std::hypot(p.x - middle.x, p.z - middle.z));
  const double half_height = 0.5 * (box.high.y - box.low.y);
  const double t = std::tan(0.5 * fov_deg * kDegree);
  const Vec3 toward = orbit_direction(0, elevation_deg), up = orbit_direction(180, 90 - elevation_deg);
  double fitting = 0;
  for (int step = 0; step < 360; ++step) {
    for (const double side : {-1.0, 1.0}) {
      const double a = step * kDegree;
      const Vec3 p{radius * std::sin(a), side * half_height, radius * std::cos(a)};
      fitting = std::max(fitting,
                         dot(p, toward) + kBorder * std::max(std::abs(p.x) / (aspect * t), std::abs(dot(p, up)) / t));
    }
  }
  Camera camera;
  camera.target = middle;
  camera.eye = middle + distance * fitting * orbit_direction(azimuth_deg, elevation_deg);
  // Straight from above or below, the top of the picture is where the camera came from.
  camera.up =
      std::abs(elevation_deg) > 89.9 ? orbit_direction(azimuth_deg + (elevation_deg > 0 ? 180 : 0), 0) : Vec3{0, 1, 0};
  camera.fov_deg = fov_deg;
  return camera;
}

Result<Rays> rays(const Camera& camera, int width, int height) {
  if (!(camera.fov_deg > 0 && camera.fov_deg < 180)) {
    return usage_error("a field of view of {} degrees: it must lie between 0 and 180", camera.fov_deg);
  }
  if (!(length(camera.target - camera.eye) > 0)) return usage_error("the camera's eye and target are the same point");
  const Axes axes = axes_of(camera);
  const double pixel = 2 * std::tan(0.5 * camera.fov_deg * kDegree) / height;
  return Rays{axes.forward - (0.5 * width * pixel) * axes.right - (0.5 * height * pixel) * axes.down,
              pixel * axes.right, pixel * axes.down, camera.eye};
}

}  // namespace goniochrome::render
