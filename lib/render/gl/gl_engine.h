// Shades G-buffers with OpenGL, by a program written for the scene. goniochrome-theory(7), RENDERING.
#pragma once

#include <string>
#include <vector>

#include "image/image.h"
#include "render/effects.h"
#include "render/gl/gl.h"
#include "render/internal/maps.h"
#include "render/internal/product_forms.h"

namespace goniochrome::render {

class GlEngine {
 public:
  // The context must outlive it.
  explicit GlEngine(const GlContext& gl) : gl_(&gl) {}

  // Uploads maps and weights, and compiles the program if it is another. Error: more maps than texture units.
  Result<void> load(const Scene& scene, const Effects& effects, const SceneMaps& maps);
  // Other paints, or other lights of the same number, for the effects loaded.
  void load_paints(const Scene& scene, const WeightTable& table);

  Result<void> resize(int width, int height);
  // Shades the texture of a G-buffer; `add` adds to what was shaded before.
  void shade(GLuint gbuffer_texture, const Rays& rays, bool add);
  void read(image::Image& rgba) const;

  const std::string& program() const { return text_; }

 private:
  void upload_tilts(const std::vector<std::vector<brdf::Tilt>>& tilts);
  void upload(const envmap::CubeMap& map, const std::string& sampler);

  const GlContext* gl_;
  Effects effects_;
  ProductForms forms_;
  std::string text_;
  GLuint program_ = 0, weights_ = 0, tilts_ = 0, no_vertices_ = 0, texture_ = 0, target_ = 0;
  std::vector<std::pair<std::string, GLuint>> cubes_;  // by the name of their sampler
  std::vector<Light> lights_;
  color::Rgb background_color_;
  int width_ = 0, height_ = 0;
};

}  // namespace goniochrome::render
