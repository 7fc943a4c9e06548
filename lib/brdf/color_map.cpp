#include "brdf/color_map.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::brdf {

ColorMap color_map_of_size(int size, double index) {
  return {size, index, std::vector<float>(static_cast<std::size_t>(size) * size * 6)};
}

namespace {

Vec3 in_plane(double cosine, double side) {
  return {side * std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine};
}

}  // namespace

MapDirections map_directions(int size, int column, int row) {
  const double height = 1 - (row + 0.5) / size;  // 1 opposite, 0 at the normal, -1 on the same side
  return {in_plane((column + 0.5) / size, 1), in_plane(1 - std::abs(height), height > 0 ? -1 : 1)};
}

MapPlace map_place(const InPlane& pair, int size) {
  return {pair.cos_far * size, pair.same_side ? (2 - pair.cos_near) * size : pair.cos_near * size};
}

color::Rgb fetched(const ColorMap& map, const MapPlace& place) {
  const double x = std::clamp(place.x - 0.5, 0.0, map.size - 1.0),
               y = std::clamp(place.y - 0.5, 0.0, 2.0 * map.size - 1);
  const int left = std::min(static_cast<int>(x), std::max(map.size - 2, 0));
  const int top = std::min(static_cast<int>(y), 2 * map.size - 2);
  const int right = std::min(left + 1, map.size - 1);
  const double u = x - left, v = y - top;
  color::Rgb result;
  for (int c = 0; c < 3; ++c)
    result[c] = (1 - v) * ((1 - u) * map.texel(left, top)[c] + u * map.texel(right, top)[c]) +
                v * ((1 - u) * map.texel(left, top + 1)[c] + u * map.texel(right, top + 1)[c]);
  return result;
}

// With the light at the angle t whose cosine is the center of the first column, the viewer at `aspecular - t` from the
// normal, on the side of the light where that is positive, sees this aspecular angle. Its cosine falls linearly with
// small aspecular angles, so that texels are dense where the color changes most.
MapPlace aspecular_place(double aspecular_rad, int size) {
  const double first = 0.5 / size, view_rad = aspecular_rad - std::acos(first),
               cosine = std::max(std::cos(view_rad), 0.0);
  return {0.5, view_rad >= 0 ? (2 - cosine) * size : cosine * size};
}

MapPlace place_of_pair(const ColorMap& map, const Vec3& to_light, const Vec3& to_viewer, CriticalAngle treatment) {
  if (!map.aspecular) return map_place(equivalent_in_plane(to_light, to_viewer, map.index, treatment), map.size);
  const Vec3 mirror = {-to_light.x, -to_light.y, to_light.z};
  return aspecular_place(std::atan2(length(cross(mirror, to_viewer)), dot(mirror, to_viewer)), map.size);
}

color::Rgb reflectance_factor(const ColorMap& map, const Vec3& to_light, const Vec3& to_viewer,
                              CriticalAngle treatment) {
  if (to_light.z <= 0 || to_viewer.z <= 0) return {};
  return fetched(map, place_of_pair(map, to_light, to_viewer, treatment));
}

}  // namespace goniochrome::brdf
