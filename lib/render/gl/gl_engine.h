// The engine gl shades G-buffers with OpenGL, by a program that is written for the scene.
// goniochrome-rendering(7), "Engines".
#pragma once

#include <string>
#include <vector>

#include "render/engine.h"
#include "render/gl/gl.h"
#include "render/internal/maps.h"

namespace goniochrome::render {

class GlEngine : public Engine {
 public:
  static const EngineInfo kInfo;

  // The context must outlive the engine. Where it is null the engine can shade nothing.
  explicit GlEngine(const GlContext* gl) : gl_(gl) {}

  const EngineInfo& info() const override { return kInfo; }
  // Error: there is no OpenGL, because the renderer was given a G-buffer.
  Result<void> can_shade(const Scene& scene) const override;
  // Uploads maps and weights, and compiles the program if it is another. Error: as scene_maps(), tilted lobes, and
  // more maps than there are texture units.
  Result<void> load(const Scene& scene, const Effects& effects) override;
  void load_paints(const Scene& scene) override;
  // Samples are summed in OpenGL; finish() reads their sum back and applies the gain.
  Result<void> shade(Sight& sight, int sample, float gain, bool add, image::Image& rgba) override;
  void finish(image::Image& rgba) override;

 private:
  Result<void> resize(int width, int height);
  void set_lamps();
  void upload(const envmap::CubeMap& map, const std::string& sampler);

  const GlContext* gl_;
  Effects effects_;
  std::string text_;
  GLuint program_ = 0, weights_ = 0, tilts_ = 0, discs_ = 0, no_vertices_ = 0, texture_ = 0, target_ = 0;
  std::vector<std::pair<std::string, GLuint>> cubes_;  // by the name of their sampler
  GLuint gbuffer_ = 0;                                 // of the sample that was shaded last
  std::vector<Light> lights_;
  color::Rgb background_color_;
  int width_ = 0, height_ = 0;
  float gain_ = 1;
};

}  // namespace goniochrome::render
