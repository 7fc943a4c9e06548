// Draws scenes with OpenGL on OSMesa, in float: rasterizes normals and parts, then shades them with a program written
// for the scene. goniochrome-theory(7), RENDERING.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "image/image.h"
#include "render/camera.h"
#include "render/scene.h"

namespace goniochrome {

// What is visible at the center of every pixel; row 0 at the top.
struct Gbuffer {
  int width = 0, height = 0;
  std::vector<float> data;  // 4 a pixel: unit normal turned to the viewer, part + 1 (negative: seen from inside), or 0
  Rays rays;

  const float* at(int x, int y) const { return &data[(static_cast<std::size_t>(y) * width + x) * 4]; }
  // The part seen, or -1.
  int part(int x, int y) const;
  Vec3 normal(int x, int y) const;
  Vec3 to_viewer(int x, int y) const { return -rays.direction(x + 0.5, y + 0.5); }
};

struct Frame {
  Image picture;  // R G B A, scene-linear radiance, premultiplied
  Image centers;  // the same, of the pixel centers alone; empty unless asked for
  Gbuffer gbuffer;
  double gbuffer_ms = 0;  // one rasterization
  double frame_ms = 0;    // everything but uploads
};

class Renderer {
 public:
  // Error: no OpenGL on this machine.
  static Result<Renderer> create();
  Renderer(Renderer&&) noexcept;
  ~Renderer();

  // Uploads what the scene needs and writes its program. The scene must outlive the drawing. Error: a lobe or the
  // mirror part that the environment lacks, with the command that makes it.
  Result<void> load(const Scene& scene);

  // The picture, as the mean of 1, 4 or 16 samples a pixel.
  Result<Frame> draw(const Camera& camera, int width, int height, int samples, bool with_centers = false);

  // "llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string engine() const;
  // The shading program in use.
  const std::string& shader() const;

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace goniochrome
