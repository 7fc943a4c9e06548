// From the words of the command line to a scene's numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "color/bands.h"
#include "color/reflection.h"
#include "render/camera.h"
#include "render/scene.h"
#include "tool.h"

namespace goniochrome::tool {

constexpr const char* kGpu = "gpu";  // the engine gl on a GPU

// The options with what --camera, --check, --effects, --tilts and --engine gpu say, each of which says several things.
// Error (usage): a value that cannot be.
Result<Options> settled(const Options& asked);

// Checks that there are surfaces to draw: --mesh, or --gbuffer with nothing that would need the mesh. Error (usage):
// what is missing, or what excludes each other.
Result<void> check_surfaces(const Options& options);

struct PictureSize {
  int width = 0, height = 0;
};
// "1280x720", each from 1 to `most`; nothing where the text is none.
std::optional<PictureSize> width_by_height(const std::string& text, int most);
// "1280x720", or "auto", which is that. Errors of all of these are usage errors that name the option, its value and
// what it takes.
Result<PictureSize> parse_size(const std::string& text);

// AZ,EL or X,Y,Z, then R,G,B or a light by its name if it is not 1,1,1. Of a light by its name `bands` is told.
Result<render::Light> parse_light(const std::string& text, std::optional<color::Bands>& bands);
// Gives lamps at a place the direction and the distance that they have from the middle of the mesh. Error (usage): a
// lamp stands there.
Result<void> stand_lamps(const mesh::Mesh& mesh, std::vector<render::Light>& lights);

// --camera, which is settled.
Result<render::Camera> camera_of(const Options& options, const mesh::Mesh& mesh, const PictureSize& size);

// The requests of --emit and --floor, before the mesh is read.
struct FloorRequest {
  enum class Kind { kNone, kShadow, kPaint } kind = Kind::kNone;
  std::string paint;             // with kPaint
  std::optional<double> height;  // none: the lowest point of the mesh
  double eye = 0;                // above the floor, that the environment was seen from; 0: a third of the mesh
};
// "auto" is the floor shadow where `usual`, else none.
Result<FloorRequest> parse_floor(const std::string& text, bool usual);
struct Emission {
  std::string part;
  color::Rgb radiance;
  std::optional<color::Bands> bands = {};  // where a light is named: relative to daylight
};
Result<std::vector<Emission>> parse_emissions(const std::vector<std::string>& texts);

// The floor of the scene, whose mesh is set. `paint` is that of the floor, if it wears one.
Result<void> set_ground(const FloorRequest& request, const std::optional<paint::Paint>& paint, render::Scene& scene);

// One picture of a sequence.
struct Shot {
  render::Camera camera;
  std::vector<render::Light> lights;
  std::string output;
};
// The files that they are written to. A sequence on standard output has names all the same.
std::vector<std::string> shot_names(const Options& options);
// The pictures that --turntable or --light-sweep ask for, else the one. Error: an EXR sequence on standard output, both
// at once, or a sweep without a light.
Result<std::vector<Shot>> shots_of(const Options& options, const mesh::Mesh& mesh, const PictureSize& size,
                                   const std::vector<render::Light>& lights);

// The background of `scene` as --background has it.
Result<void> set_background(render::Scene& scene, const std::string& text);

// --exposure in stops, or nothing for "auto".
Result<std::optional<double>> parse_exposure(const std::string& text);

// The names of --aov, each given once.
std::vector<std::string> aov_names(const std::vector<std::string>& options);

}  // namespace goniochrome::tool
