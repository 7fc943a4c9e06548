// A scene for rays: a mesh and, on request, a level floor under it. Embree is inside. goniochrome-paths(7), "RAYS".
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/result.h"
#include "mesh/mesh.h"
#include "rays/float3.h"

namespace goniochrome::rays {

// A floor that reaches to the horizon: the plane y = height, in the units of the mesh.
struct Floor {
  double height = 0;
};

// The numbers that a hit has in place of a triangle's.
constexpr std::uint32_t kNothing = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kFloor = kNothing - 1;

// Where a ray meets the scene. The point is (1 - u - v) a + u b + v c of the triangle's corners a, b, c.
struct Hit {
  std::uint32_t triangle = kNothing;
  float u = 0, v = 0;
  float distance = std::numeric_limits<float>::infinity();  // in local units
  bool any() const { return triangle != kNothing; }
};

// A point of the surface as a ray meets it. Both normals are unit and look to the side that the ray came from.
struct Spot {
  Float3 position;            // local
  Float3 start;               // local; where rays that leave the surface begin
  Float3 geometric, shading;  // normals: of the triangle, and interpolated between its vertices
  std::uint32_t triangle = kNothing;
  int part = 0;         // of the mesh; the floor is the part after the last
  bool inside = false;  // whether it was met from its back
  float u = 0, v = 0;   // of the hit
};

// Eight rays from one point. Rays whose bit of `wanted` is 0 are not traced.
struct Fan {
  Float3 origin;
  alignas(32) float x[8], y[8], z[8];  // directions, unit
  unsigned wanted = 0;
  // Where occluded() stops to look, in local units.
  float reach = std::numeric_limits<float>::infinity();
  // True if the rays go nearly the same way, as those to a lamp do: they are then traced together, which is faster.
  bool narrow = false;
};

// Immutable; every function may be called from any thread, and what it returns does not depend on the number of threads
// that built the scene.
//
// Kernels work in local coordinates: the mesh, moved and scaled by a power of two so that the larger half of its box is
// between 1/2 and 1. All tolerances are thereby relative to the size of the mesh. Directions are the same in both.
class RayScene {
 public:
  // Error: a vertex that is not finite, a triangle that refers to no vertex, parts that do not cover the triangles, no
  // triangle at all, a floor whose height is not finite, or Embree's own word where it fails.
  // Rays pass the parts of the mesh that are named in `passed` as if they were not there; their spots are known.
  static Result<RayScene> create(const mesh::Mesh& mesh, const std::optional<Floor>& floor = {},
                                 const std::vector<bool>& passed = {});
  // Copies the mesh over this floor, whose height is finite. The tree of the mesh is shared.
  RayScene over(const Floor& floor) const;
  RayScene(RayScene&&) noexcept;
  RayScene& operator=(RayScene&&) noexcept;
  ~RayScene();

  int parts() const;  // of the mesh, and the floor as one more
  bool has_floor() const;
  std::size_t triangles() const;

  // Local coordinates = scale * (world - middle).
  double scale() const;
  const Vec3& middle() const;
  Float3 local(const Vec3& world) const { return float3(scale() * (world - middle())); }
  Vec3 world(const Float3& at) const { return middle() + (1 / scale()) * vec3(at); }

  // In local coordinates; directions are unit.
  Hit closest(const Float3& origin, const Float3& direction) const;
  bool occluded(const Float3& origin, const Float3& direction,
                float distance = std::numeric_limits<float>::infinity()) const;
  // The bits of those wanted rays of the fan that meet anything.
  unsigned occluded(const Fan& fan) const;
  // The nearest hits of those wanted rays of the fan; the others are left alone.
  void closest(const Fan& fan, Hit* hits) const;

  // How far along the ray the floor is, whatever lies before it; infinite where the ray does not meet it.
  float floor_distance(const Float3& origin, const Float3& direction) const;

  // The surface at a hit that `direction` led to. Vertices of the triangle are read, so that the point does not depend
  // on the distance's rounding.
  Spot spot(const Hit& hit, const Float3& origin, const Float3& direction) const;
  // The corners of a triangle, local.
  std::array<Float3, 3> corners(std::uint32_t triangle) const;
  // Twice the area of a triangle times its normal, local.
  Vec3 doubled_area(std::uint32_t triangle) const;
  // The density by solid angle of a density of 1 by area where a ray of this direction meets a triangle at this
  // distance, local: distance^2/cos; 0 along the triangle.
  double by_solid_angle(std::uint32_t triangle, const Float3& direction, float distance) const;
  int part(std::uint32_t triangle) const;
  // True if any vertex of the mesh lies more than `margin` above the plane through the point. A point from which none
  // does sees its whole hemisphere, the floor apart.
  bool any_above(const Float3& point, const Float3& normal, float margin) const;
  // True if the mesh lies below the planes of all of its triangles, so that it blocks no light that reaches its
  // outside.
  bool is_convex() const;

 private:
  struct State;
  RayScene(std::shared_ptr<const State> state, std::optional<float> floor);

  std::shared_ptr<const State> state_;
  std::optional<float> floor_;  // local height
};

// Rays that leave a surface start this far above it, in local units: more than four roundings of a float between 1 and
// 2, which bound the error of a distance from a triangle's plane; less than a hundred thousandth of the mesh.
constexpr float kLift = 0x1p-19F;

}  // namespace goniochrome::rays
