// An engine turns what is visible into radiance. This header states what every engine can do, and names the table in
// which all engines are registered. Plans, options, help and reports take their engines from that table, so that a new
// engine is its own two files and one line in engines.cpp. goniochrome-rendering(7), "RENDERING".
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "image/image.h"
#include "render/effects.h"
#include "render/gbuffer.h"
#include "render/scene.h"

namespace goniochrome::rays {
class RayScene;
}

namespace goniochrome::render {

class Engine;
class GlContext;
class SeenPixels;

// How much trouble an engine takes that draws by random samples.
struct Effort {
  int bounces = kUsualBounces;  // How many surfaces of the mesh may pass light on before it reaches what is seen.
  double time_limit_s = 0;      // of one picture; 0: none
  std::uint64_t seed = 1;
  bool smooth = false;  // Light is smoothed along surfaces, and the noise is the error that is measured then.
  // Told after each round of samples: the noise of the picture so far (CIEDE2000, 95th percentile), and the seconds.
  std::function<void(double noise_de00, double seconds)> progress = {};
  static constexpr int kUsualBounces = 4;
};

// The random error of a picture that was drawn by samples.
struct Noise {
  double de00_p95 = 0, de00_mean = 0;  // over the visible pixels
  double samples_mean = 0;             // of a visible pixel
  double time_s = 0;
  bool reached = false;        // whether de00_p95 is within the tolerance
  double places_gain = 1;      // BrightPlaces::gain(); 1 where directions are drawn by lobes alone
  double white_luminance = 0;  // that the noise is judged by
  image::Image de00;           // of each pixel, one standard deviation; one channel
};

// A view as the renderer offers it to its engines. Sample 0 is the pixel centers; the samples of a picture are counted
// from 1.
class Sight {
 public:
  virtual ~Sight() = default;
  // The visible points of this sample of every pixel, with triangles unless the buffer was given. They are found when
  // first asked for, and kept if there is room. Positions on the mesh follow from it by mesh_point().
  virtual std::shared_ptr<const Gbuffer> gbuffer(int sample) = 0;
  // Where the pixels of that G-buffer lie on the textures of the scene; empty where the scene has none.
  virtual const std::vector<TexturePlace>& places(int sample) = 0;
  // Texture values of those pixels, kept from frame to frame; null where nothing is kept.
  virtual SeenPixels* seen_pixels(int) { return nullptr; }
  // The OpenGL context of the renderer; null where it has none.
  virtual const GlContext* gl() const = 0;
  // True if it shows the mesh of the scene, and not a G-buffer that was given.
  virtual bool shows_mesh() const { return false; }
  // The mesh as rays meet it, with the floor of the scene; null where a G-buffer was given.
  virtual std::shared_ptr<const rays::RayScene> traced_mesh() const { return nullptr; }
  virtual Effort effort() const { return {}; }
};

// The name of an engine, and facts about it that are known before it is made.
struct EngineInfo {
  const char* name;      // of --engine, in plans and in reports
  const char* sentence;  // what it does, for help
  // True if plans may choose it and leave effects out for it. Otherwise it is used when it is asked for by name, and it
  // draws all effects, because leaving one out saves no time.
  bool is_planned = false;
  bool needs_texels = false;  // It sums the image that the environment was made from: Scene::texels.
  bool traces_rays = false;   // It sees the mesh in the way of light: it draws shadows, floors and parts that shine.
  bool needs_opengl = false;  // It shades in the OpenGL context of the renderer.
  bool needs_mesh = false;    // It cannot shade a G-buffer that comes from a file.
  bool draws_placed_lamps = false;  // Lamps may stand at a place.
  std::unique_ptr<Engine> (*make)(Sight& sight);
};

// All engines, in the order in which they are listed. Plans choose the first that they may choose and that can shade
// the scene.
const std::vector<const EngineInfo*>& engines();

// The engine of that name. Error (usage): the names that there are.
Result<const EngineInfo*> engine_named(const std::string& name);

// The names that an option takes: "auto", which lets the plan choose, and those of all engines.
std::vector<std::string> engine_choices();

class Engine {
 public:
  virtual ~Engine() = default;

  virtual const EngineInfo& info() const = 0;

  // Checks that it can shade this scene. Error: what stands against it, with the remedy.
  virtual Result<void> can_shade(const Scene& scene) const = 0;

  // Takes in a scene with these effects: maps, programs, trees. What the scene points to must outlive the drawing.
  // Error: a lobe or the mirror part that the environment lacks, with the command that makes it; too many lobes.
  virtual Result<void> load(const Scene& scene, const Effects& effects) = 0;

  // Takes other paints, or other lights of the same number, for the scene and the effects that were loaded.
  virtual void load_paints(const Scene& scene) = 0;

  // Shades one sample of every pixel: radiance times `gain` in R G B, and coverage times `gain` in A. With `add` the
  // result is added to what the samples before made. The picture may be incomplete until finish().
  virtual Result<void> shade(Sight& sight, int sample, float gain, bool add, image::Image& rgba) = 0;
  // The noise of the picture that was drawn last; nothing from engines that do not draw by random samples.
  virtual const Noise* noise() const { return nullptr; }
  // Sentences about the loaded scene that whoever asked for the picture should read.
  virtual std::vector<std::string> remarks() const { return {}; }
  // Completes the picture after its last sample.
  virtual void finish(image::Image&) {}

  // Returns whether shade() includes textures and color maps. Otherwise the renderer adds them, see SurfaceLayer.
  virtual bool shades_layer() const { return false; }
};

}  // namespace goniochrome::render
