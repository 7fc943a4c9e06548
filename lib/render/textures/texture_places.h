// Where on its texture each pixel lies, for the surfaces that have one. goniochrome-theory(7), SPATIALLY VARYING
// SURFACES.
#pragma once

#include <vector>

#include "mesh/mesh.h"
#include "render/gbuffer.h"
#include "render/internal/visible_point.h"

namespace goniochrome::render {

// A mesh laid out for textures. Texture coordinates are the mesh's own; where it has none, u runs once around the
// vertical axis through the middle of the bounding box and v upward in the same measure. Tangents run along u and are
// the means over the triangles at a vertex, by area, so that a smooth surface has smooth tangents.
class TextureLayout {
 public:
  // For these parts of the mesh, which must outlive it.
  TextureLayout(const mesh::Mesh& mesh, const std::vector<bool>& parts);

  // The places of what a G-buffer of the mesh shows, pixel by pixel; of other parts, and of nothing, they mean nothing.
  // Bit-identical for any number of threads.
  std::vector<TexturePlace> places(const Gbuffer& gbuffer) const;

 private:
  struct Corner {
    float u = 0, v = 0;
  };
  struct Face {
    std::uint32_t vertex[3];
    Corner uv[3];
    int part = 0;
  };
  class Canvas;

  const mesh::Mesh& mesh_;
  std::vector<Face> faces_;
  std::vector<Vec3> tangents_;  // of the vertices
};

}  // namespace goniochrome::render
