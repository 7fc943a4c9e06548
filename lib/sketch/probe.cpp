#include "sketch/probe.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace goniochrome::sketch {

namespace {

// The angle of two unit vectors; exact for small angles too.
double angle_deg(const Vec3& a, const Vec3& b) {
  return std::atan2(length(cross(a, b)), dot(a, b)) / kDegree;
}

}  // namespace

Result<Probe> probe(const image::AovFile& file, int x, int y) {
  const image::Image& image = file.image;
  if (x < 0 || y < 0 || x >= image.width || y >= image.height)
    return usage_error("the pixel {},{} lies outside of {}, which has {} x {}: columns and rows are counted from 0", x,
                       y, file.path, image.width, image.height);
  GONIO_ASSIGN(const int part, file.channel("part"));
  GONIO_ASSIGN(const int nx, file.channel("normal.X"));
  GONIO_ASSIGN(const int ny, file.channel("normal.Y"));
  GONIO_ASSIGN(const int nz, file.channel("normal.Z"));
  const float* pixel = image.pixel(x, y);
  Probe probe;
  probe.x = x, probe.y = y;
  const double gain = std::exp2(-file.exposure_stops);
  probe.rgb = gain * color::Rgb{pixel[0], pixel[1], pixel[2]};
  const double white = file.white_luminance > 0 ? file.white_luminance : 1;
  probe.lab = color::lab_from_rgb((1 / white) * probe.rgb, color::xyz_d65_from_rgb({1, 1, 1}));
  const auto number = static_cast<std::size_t>(std::max(0.0F, std::round(pixel[part])));
  probe.on_mesh = number > 0;
  if (!probe.on_mesh) return probe;
  if (number <= file.parts.size()) probe.part = file.parts[number - 1];
  if (number <= file.materials.size()) probe.material = file.materials[number - 1];
  const Vec3 to_viewer = file.to_viewer(x, y);
  probe.normal = normalized(Vec3{pixel[nx], pixel[ny], pixel[nz]});
  probe.view_deg = angle_deg(probe.normal, to_viewer);
  const Vec3 mirrored = 2 * dot(probe.normal, to_viewer) * probe.normal - to_viewer;
  for (const image::AovLight& light : file.lights) probe.aspecular_deg.push_back(angle_deg(mirrored, light.direction));
  if (file.lights.empty()) probe.aspecular_deg.push_back(angle_deg(mirrored, file.light));
  return probe;
}

}  // namespace goniochrome::sketch
