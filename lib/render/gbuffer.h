// A G-buffer holds what is visible at one point of every pixel. Rays find it once for a view; then every engine
// shades it. What it does not store of a point on the mesh follows from the triangle and the ray through the pixel.
// goniochrome-rendering(7), "RENDERING".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "base/vec3.h"
#include "mesh/mesh.h"
#include "render/camera.h"

namespace goniochrome::render {

// Where a point lies on its texture.
struct TexturePlace {
  float u = 0, v = 0;
  std::array<float, 3> tangent = {};  // world, along growing u; of about unit length, or 0 where it is not known
  // The footprint: how far u and v go from one pixel to the next, to the right and downward; 0 where it is not known.
  float across[2] = {0, 0}, down[2] = {0, 0};
  bool mirrored = false;  // whether v grows against n x tangent, n being the normal to the viewer
  // The share of the texture, which is shown here as far as the places on it that are blended have this one. 0: not at
  // all.
  float share = 1;
};

// A visible point that is shaded alone.
struct VisiblePoint {
  Vec3 normal, to_viewer;  // unit, on the same side
  int part = 0;
  bool placed = false;  // whether its place on a texture is known
  TexturePlace place = {};
  std::vector<TexturePlace> over = {};  // on the textures that lie over that of `place`, the uppermost last
  Vec3 position = {};                   // on the mesh, for lamps at a place
};

// The entry of a G-buffer in the place of a triangle's number where the mesh is not seen.
constexpr std::uint32_t kNoTriangle = std::numeric_limits<std::uint32_t>::max();

// One flag for each pixel.
using PixelFlags = std::vector<std::uint8_t>;

// The visible points of every pixel at one sample; row 0 is at the top.
struct Gbuffer {
  int width = 0, height = 0;
  std::vector<float> data;  // 4 a pixel: unit normal turned to the viewer, part + 1 (negative: seen from inside), or 0
  Rays rays;                // through the points: their shift within the pixel is in the corner
  // A triangle of the mesh, rays::kFloor or kNoTriangle, pixel by pixel. Empty where the buffer comes from a file.
  std::vector<std::uint32_t> triangles = {};
  // Pixels that are shaded; empty: all. Engines may shade others as well.
  PixelFlags wanted = {};

  std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width + x; }
  const float* at(int x, int y) const { return &data[index(x, y) * 4]; }
  bool wants(int x, int y) const { return wanted.empty() || wanted[index(x, y)] != 0; }
  // The part seen, or -1.
  int part(int x, int y) const;
  // True if any pixel shows the mesh from inside.
  bool shows_inside() const;
  Vec3 normal(int x, int y) const;
  Vec3 to_viewer(int x, int y) const { return -rays.direction(x + 0.5, y + 0.5); }
  // The visible point of this pixel, with its place on each texture that `places` tells of: as many a pixel as there
  // are, those of all pixels on one texture after those on the texture below. Its position is that on the mesh, if that
  // is given and the buffer has triangles.
  VisiblePoint point(int x, int y, const std::vector<TexturePlace>& places = {},
                     const mesh::Mesh* mesh = nullptr) const;
};

// Calls visit(x, y) for each pixel of a picture of this size, on all cores.
template <class Visit>
void for_pixels(int width, int height, const Visit& visit) {
  parallel_each(static_cast<std::size_t>(height), 8, [&](std::size_t y) {
    for (int x = 0; x < width; ++x) visit(x, static_cast<int>(y));
  });
}

// Pixels of one part whose normals have at least the first cosine lie on one piece of surface; with the second, it is
// so flat that one of them tells the light of the other.
constexpr float kSamePiece = 0.96F, kFlatPiece = 0.998F;
// True if two entries of G-buffers show one part from one side, with normals of at least this cosine.
inline bool are_one_piece(const float* a, const float* b, float cosine) {
  return a[3] != 0 && a[3] == b[3] && a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > cosine;
}

// Calls visit(x, y, part) for each pixel that shows the mesh and is wanted, row by row.
template <class Visit>
void for_seen(const Gbuffer& g, const Visit& visit) {
  for (int y = 0; y < g.height; ++y)
    for (int x = 0; x < g.width; ++x)
      if (const int part = g.part(x, y); part >= 0 && g.wants(x, y)) visit(x, y, part);
}

// A point of a mesh, in the mesh's own coordinates.
struct MeshPoint {
  std::uint32_t triangle = kNoTriangle;
  std::array<double, 3> shares = {};  // barycentric: of the triangle's corners, none below 0, together 1
  Vec3 position;
  Vec3 face;  // the unit normal of the triangle, to the side from which its corners run counter-clockwise
};

// Where a ray meets the plane of a triangle, as shares of its corners, which may be below 0 and together are 1; and
// whether it meets it ahead. The middle of the triangle where the ray runs along the plane.
struct PlaneHit {
  std::array<double, 3> shares = {1.0 / 3, 1.0 / 3, 1.0 / 3};
  bool ahead = false;
};
PlaneHit plane_hit(const std::array<Vec3, 3>& corners, const Vec3& origin, const Vec3& direction);

// The nearest place within a triangle, by shares of its corners.
std::array<double, 3> within(const std::array<double, 3>& shares);

// Where a ray meets the plane of a triangle of the mesh. If that is outside of the triangle, as it may be by rounding,
// it is the nearest place within by shares of the corners; if the ray runs along the plane, the middle of the triangle.
MeshPoint mesh_point(const mesh::Mesh& mesh, std::uint32_t triangle, const Vec3& origin, const Vec3& direction);

// The point of the mesh that a pixel of the G-buffer shows. The pixel must show something, and the G-buffer must have
// triangles.
MeshPoint mesh_point(const mesh::Mesh& mesh, const Gbuffer& gbuffer, int x, int y);

// Where the samples of a pixel lie, from its center: a grid turned so that no two share a row or a column, which
// resolves edges that are nearly upright or level in as many steps as there are samples.
std::vector<std::array<double, 2>> sample_shifts(int samples);

}  // namespace goniochrome::render
