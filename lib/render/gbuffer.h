// What is visible: rasterized once for a view, then shaded by either engine. goniochrome-theory(7), RENDERING.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/result.h"
#include "base/vec3.h"
#include "mesh/mesh.h"
#include "render/camera.h"

namespace goniochrome::render {

class GlContext;

// What is visible at one point of every pixel; row 0 at the top.
struct Gbuffer {
  int width = 0, height = 0;
  std::vector<float> data;  // 4 a pixel: unit normal turned to the viewer, part + 1 (negative: seen from inside), or 0
  Rays rays;                // of the points: their shift within the pixel is in the corner

  const float* at(int x, int y) const { return &data[(static_cast<std::size_t>(y) * width + x) * 4]; }
  // The part seen, or -1.
  int part(int x, int y) const;
  Vec3 normal(int x, int y) const;
  Vec3 to_viewer(int x, int y) const { return -rays.direction(x + 0.5, y + 0.5); }
};

// Where the samples of a pixel lie, from its center: a grid turned so that no two share a row or a column, which
// resolves edges that are nearly upright or level in as many steps as there are samples.
std::vector<std::array<double, 2>> sample_shifts(int samples);

// Draws G-buffers with OpenGL.
class Rasterizer {
 public:
  // The context must outlive it. Error: see GlContext.
  static Result<Rasterizer> create(const GlContext& gl);

  // The mesh must outlive the drawing.
  void upload(const mesh::Mesh& mesh);
  Result<void> resize(int width, int height);

  // Draws the points of all pixels that `rays`, without their shift, and the shift (in pixels) name. The result stays
  // in texture().
  void draw(const Camera& camera, const Rays& rays, double shift_x, double shift_y);
  // Reads back what was drawn last.
  void read(Gbuffer& gbuffer) const;

  unsigned texture() const { return texture_; }
  const Rays& drawn_rays() const { return drawn_; }

 private:
  explicit Rasterizer(const GlContext& gl) : gl_(&gl) {}

  const GlContext* gl_;
  const mesh::Mesh* mesh_ = nullptr;
  Rays drawn_;
  unsigned program_ = 0, vertex_array_ = 0, positions_ = 0, normals_ = 0, indices_ = 0;
  unsigned texture_ = 0, depth_ = 0, target_ = 0;
  int width_ = 0, height_ = 0;
  mesh::Box box_;
};

}  // namespace goniochrome::render
