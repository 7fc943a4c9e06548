// Where on its texture each pixel lies, for the parts that have one. goniochrome-surfaces(7), "Drawing".
#pragma once

#include <array>
#include <vector>

#include "mesh/mesh.h"
#include "render/gbuffer.h"
#include "render/textures/projection.h"

namespace goniochrome::render {

// A mesh laid out for textures. Unless a part is projected, texture coordinates are the mesh's own; where it has none,
// u runs once around the vertical axis through the middle of the bounding box and v upward in the same measure.
// Tangents run along u and are the means over the triangles at a vertex, by area, so that a smooth surface has smooth
// tangents; those of a texture and of its mirror image are not mixed.
class TextureLayout {
 public:
  // For these parts of the mesh, which must outlive it. Each is laid as `layings` has it, and in the way of the mesh
  // where there are fewer.
  TextureLayout(const mesh::Mesh& mesh, const std::vector<bool>& parts, std::vector<TextureLaying> layings = {});

  // The places of what a G-buffer of the mesh shows, pixel by pixel; those of other parts, and of nothing, are left at
  // 0, and so are footprints. The G-buffer must have triangles. Bit-identical for any number of threads.
  std::vector<TexturePlace> places(const Gbuffer& gbuffer) const;
  // Places with footprints, which take longer. Their middles, which become the places, lie so far from the points, in
  // pixels to the right and downward.
  std::vector<TexturePlace> filtered_places(const Gbuffer& gbuffer, const std::array<double, 2>& middle = {}) const;
  // The place of one pixel, which shows one of the parts.
  TexturePlace place(const Gbuffer& gbuffer, int x, int y, bool footprint = true) const;

  // The place of a point of the mesh, of which the triangle and the shares are read. The triangle is one of a part that
  // the layout was made for. `inside`: whether it is seen from its back.
  TexturePlace place(int part, const MeshPoint& point, bool inside) const;

 private:
  using Corners = std::array<std::array<float, 2>, 3>;  // u and v of each corner
  TexturePlace place(const MeshPoint& point, const Corners& corners) const;
  TexturePlace place(int part, const MeshPoint& point) const;
  template <class PlaceAt>
  std::vector<TexturePlace> each_pixel(const Gbuffer& gbuffer, const PlaceAt& place_at) const;
  void add_footprint(const Gbuffer& gbuffer, int x, int y, const MeshPoint& point, TexturePlace& place) const;

  const mesh::Mesh& mesh_;
  std::vector<TextureLaying> layings_;       // of each part
  std::vector<std::vector<Corners>> faces_;  // of the triangles of each part, in order; none of parts without a texture
  std::vector<Vec3>
      tangents_;  // of the vertices, each in triangles whose texture is not mirrored and in those where it is
};

}  // namespace goniochrome::render
