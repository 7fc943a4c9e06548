#include <cmath>

#include "mesh/internal/polygons.h"

namespace goniochrome::mesh {

namespace {

struct Point2 {
  double x, y;
};

// Twice the signed area of a triangle, positive counter-clockwise.
double doubled_area(const Point2& a, const Point2& b, const Point2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool inside(const Point2& p, const Point2& a, const Point2& b, const Point2& c) {
  return doubled_area(a, b, p) >= 0 && doubled_area(b, c, p) >= 0 && doubled_area(c, a, p) >= 0;
}

// The polygon seen along its mean normal (Newell: the sum of the cross products about the first corner), where it turns
// counter-clockwise.
std::vector<Point2> flattened(const std::vector<Vec3>& ring) {
  Vec3 normal;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) normal += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
  const double size = length(normal);
  if (!(size > 0)) return {};
  const Vec3 z = (1 / size) * normal;
  const Vec3 x = normalized(std::abs(z.x) < 0.7 ? Vec3{0, z.z, -z.y} : Vec3{-z.z, 0, z.x});
  const Vec3 y = cross(z, x);
  std::vector<Point2> flat;
  for (const Vec3& p : ring) flat.push_back({dot(p - ring[0], x), dot(p - ring[0], y)});
  return flat;
}

// Whether the corner `at` of the remaining ring can be cut off: it turns left, and no other corner lies in the cut.
bool is_ear(const std::vector<Point2>& flat, const std::vector<std::uint32_t>& left, std::size_t at) {
  const std::size_t n = left.size(), before = (at + n - 1) % n, after = (at + 1) % n;
  const Point2 &a = flat[left[before]], &b = flat[left[at]], &c = flat[left[after]];
  if (doubled_area(a, b, c) <= 0) return false;
  for (std::size_t i = 0; i < n; ++i) {
    if (i == before || i == at || i == after) continue;
    if (inside(flat[left[i]], a, b, c)) return false;
  }
  return true;
}

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangulated(const std::vector<Vec3>& ring) {
  std::vector<std::uint32_t> left(ring.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  const std::vector<Point2> flat = ring.size() > 3 ? flattened(ring) : std::vector<Point2>{};
  std::vector<std::array<std::uint32_t, 3>> triangles;
  // A warped quad is folded along its shorter diagonal, if both are inside.
  std::size_t at = ring.size() == 4 && length(ring[2] - ring[0]) > length(ring[3] - ring[1]) ? 0 : 1;
  while (left.size() > 3) {
    if (!flat.empty()) {
      for (std::size_t tries = 0; tries < left.size() && !is_ear(flat, left, at); ++tries) at = (at + 1) % left.size();
    }
    const std::size_t n = left.size();
    triangles.push_back({left[(at + n - 1) % n], left[at], left[(at + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(at));
    at = (at + 1) % left.size();  // not the neighbor at once: even triangles instead of a fan of slivers
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace goniochrome::mesh
