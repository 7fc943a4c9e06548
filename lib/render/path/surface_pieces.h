// The triangles of a scene cut into pieces that are small beside it. goniochrome-paths(7), "Bright places".
#pragma once

#include <cstdint>
#include <vector>

#include "rays/ray_scene.h"

namespace goniochrome::render {

// Pieces are counted from 0. A triangle whose longest edge is above kPiece is cut into n^2 equal ones by lines along
// its edges. A floor has no pieces.
class SurfacePieces {
 public:
  static constexpr std::uint32_t kNone = ~0U;
  static constexpr float kPiece = 1.0F / 12;  // local: about a twenty-fourth of the mesh

  // The scene must outlive the pieces.
  explicit SurfacePieces(const rays::RayScene& scene);

  std::uint32_t count() const { return static_cast<std::uint32_t>(triangle_.size()); }
  std::uint32_t triangle(std::uint32_t piece) const { return triangle_[piece]; }
  // The piece at a place of a triangle; kNone on the floor.
  std::uint32_t at(std::uint32_t triangle, float u, float v) const;
  double area(std::uint32_t piece) const;  // local
  // The middle and the unit normal of a piece, local; the normal of what has no area is 0.
  struct Placed {
    rays::Float3 middle, normal;
  };
  Placed placed(std::uint32_t piece) const;
  // A point drawn evenly from a piece by numbers in [0,1), without a distance.
  rays::Hit drawn(std::uint32_t piece, double u, double v) const;
  rays::Float3 position(const rays::Hit& hit) const;  // local

 private:
  const rays::RayScene& scene_;
  std::vector<std::uint32_t> first_;  // piece of each triangle
  std::vector<std::uint16_t> cuts_;   // n of each triangle
  std::vector<std::uint32_t> triangle_;
};

}  // namespace goniochrome::render
