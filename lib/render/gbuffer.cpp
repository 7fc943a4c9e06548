#include "render/gbuffer.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::render {

int Gbuffer::part(int x, int y) const {
  return static_cast<int>(std::abs(at(x, y)[3])) - 1;
}

bool Gbuffer::shows_inside() const {
  for (std::size_t i = 3; i < data.size(); i += 4)
    if (data[i] < 0) return true;
  return false;
}

Vec3 Gbuffer::normal(int x, int y) const {
  return normalized(vec3(at(x, y)));
}

VisiblePoint Gbuffer::point(int x, int y, const std::vector<TexturePlace>& places, const mesh::Mesh* mesh) const {
  VisiblePoint point{normal(x, y), to_viewer(x, y), part(x, y)};
  if (mesh != nullptr && !triangles.empty()) point.position = mesh_point(*mesh, *this, x, y).position;
  if (places.empty()) return point;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  point.placed = true, point.place = places[index(x, y)];
  for (std::size_t i = index(x, y) + pixels; i < places.size(); i += pixels) point.over.push_back(places[i]);
  return point;
}

// By Cramer's rule from the origin's place beside the first corner: in the edges a and b, the ray meets the plane at
// (share of a, share of b) = (d x b . s, d . s x a)/(d x b . a).
PlaneHit plane_hit(const std::array<Vec3, 3>& corners, const Vec3& origin, const Vec3& direction) {
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0], s = origin - corners[0],
             across = cross(direction, b);
  const double determinant = dot(across, a);
  PlaneHit hit;
  if (determinant == 0) return hit;
  const Vec3 turned = cross(s, a);
  const double v = dot(across, s) / determinant, w = dot(direction, turned) / determinant;
  hit.shares = {1 - v - w, v, w};
  hit.ahead = dot(b, turned) / determinant > 0;
  return hit;
}

std::array<double, 3> within(const std::array<double, 3>& shares) {
  std::array<double, 3> result = shares;
  double sum = 0;
  for (double& share : result) share = std::max(0.0, share), sum += share;
  for (double& share : result) share /= sum;
  return result;
}

MeshPoint mesh_point(const mesh::Mesh& mesh, std::uint32_t triangle, const Vec3& origin, const Vec3& direction) {
  const auto& [p, q, r] = mesh.triangles[triangle];
  const std::array<Vec3, 3> corners{mesh.positions[p], mesh.positions[q], mesh.positions[r]};
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
  MeshPoint point{triangle, within(plane_hit(corners, origin, direction).shares), {}, normalized(cross(a, b))};
  point.position = corners[0] + point.shares[1] * a + point.shares[2] * b;
  return point;
}

MeshPoint mesh_point(const mesh::Mesh& mesh, const Gbuffer& gbuffer, int x, int y) {
  return mesh_point(mesh, gbuffer.triangles[gbuffer.index(x, y)], gbuffer.rays.eye,
                    gbuffer.rays.direction(x + 0.5, y + 0.5));
}

std::vector<std::array<double, 2>> sample_shifts(int samples) {
  const int k = static_cast<int>(std::lround(std::sqrt(samples)));
  std::vector<std::array<double, 2>> shifts;
  for (int i = 0; i < k; ++i) {
    for (int j = 0; j < k; ++j) {
      shifts.push_back({(i * k + (k - 1 - j) + 0.5) / samples - 0.5, (j * k + i + 0.5) / samples - 0.5});
    }
  }
  return shifts;
}

}  // namespace goniochrome::render
