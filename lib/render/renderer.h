// The renderer draws scenes into pictures of scene-linear radiance. Rays find what a view shows; then one of the
// engines shades it. The renderer keeps what the next picture can use again: the tree of the mesh, the G-buffers of the
// last view, and the engines. goniochrome-rendering(7), "RENDERING".
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "image/image.h"
#include "render/camera.h"
#include "render/effects.h"
#include "render/engine.h"
#include "render/gbuffer.h"
#include "render/gl/driver.h"
#include "render/path/ray_correction.h"
#include "render/plan.h"
#include "render/scene.h"

namespace goniochrome::render {

// The view of a picture: from where, and how finely.
struct View {
  Camera camera;
  int width = 0, height = 0;
  int samples = 1;            // 1, 4 or 16 a pixel
  bool with_centers = false;  // also the pixel centers alone
};

struct Frame {
  image::Image picture;                    // R G B A, scene-linear radiance, premultiplied
  image::Image centers;                    // the same, of the pixel centers alone; empty unless asked for
  std::shared_ptr<const Gbuffer> gbuffer;  // of the pixel centers
  double gbuffer_ms = 0;       // to find what one sample shows, perhaps for a plan; 0 where the G-buffer is given
  double frame_ms = 0;         // everything but uploads of the scene
  std::optional<Noise> noise;  // of the picture; none of engines that do not draw by random samples
  image::Image open_centers;   // of the pixel centers before rays change the mesh; empty unless centers are asked for
  CorrectionNoise rays;        // of the effects of rays in `picture`; 0 where none are drawn
  FoundMaps maps;              // what the maps miss; of engines without maps nothing
};

class Renderer {
 public:
  // With OpenGL, for any engine. Error: no such OpenGL on this machine.
  static Result<Renderer> create(OpenGlBy by = OpenGlBy::kSoftware);
  // A renderer without mesh and OpenGL, which shades this G-buffer again and again. Every view that it draws shows the
  // G-buffer, and the camera of the view is ignored; of the mesh of the scene only the parts are used. Its other
  // functions fail for engines that need the mesh, for textures, and for more than one sample.
  static Renderer shading(std::shared_ptr<const Gbuffer> gbuffer);
  // Without OpenGL, for all engines but gl. Rays that find what a view shows meet this floor, too.
  static Renderer tracing(std::optional<Ground> ground = {});
  Renderer(Renderer&&) noexcept;
  ~Renderer();

  // From now on plans have the effects of rays, and pictures are drawn with those that are on. The environment must
  // outlive the drawing. Without this call, no rays are traced.
  void set_rays(const RaySetup& setup);

  // Uploads what the scene needs for the engine of that name, with the effects given or, without them, with all that
  // it calls for. The scene must outlive the drawing. Error: no such engine; what the engine cannot shade; a lobe or
  // the mirror part that the environment lacks, with the command that makes it.
  Result<void> load(const Scene& scene, const std::string& engine = "gl");
  Result<void> load(const Scene& scene, const Effects& effects, const std::string& engine);

  // Decides what to shade with, and by which engine, for views like those of the G-buffers (of one mesh), and loads it.
  // Error: as above, and a word of request.effects that names no effect.
  Result<Plan> load(const Scene& scene, const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers,
                    const PlanRequest& request);

  // Takes other paints or lights for the scene and the effects that were loaded: what an edit of a paint costs.
  void load_paints(const Scene& scene);

  // Draws into `frame`, whose storage is used again. G-buffers of the view drawn last are kept, as far as they are
  // small enough. Error: nothing was loaded, or as rays().
  Result<void> draw(const View& view, Frame& frame);
  Result<Frame> draw(const Camera& camera, int width, int height, int samples, bool with_centers = false);

  // For all pictures from now on, by engines that draw by random samples. The time limit of the next one begins anew.
  void set_effort(Effort effort);

  // The mesh as it will be seen, before anything is shaded.
  Result<std::shared_ptr<const Gbuffer>> look(const mesh::Mesh& mesh, const View& view);

  // "llvmpipe (LLVM 15.0.6, 256 bits)"; "" without OpenGL
  std::string opengl() const;
  // The library that OpenGL comes from, "OSMesa" or "EGL"; "" without OpenGL.
  std::string opengl_library() const;
  // Remarks of the engine on the scene that was loaded.
  std::vector<std::string> remarks() const;
  // The program by which the engine gl shades the scene and effects loaded, whatever engine they were loaded for.
  std::string shader() const;

 private:
  struct State;
  explicit Renderer(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace goniochrome::render
