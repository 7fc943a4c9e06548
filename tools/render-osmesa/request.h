// The request of the command line, checked before anything is read.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "color/reflection.h"
#include "paints.h"
#include "render/engine.h"
#include "render/plan.h"
#include "setup.h"
#include "tool.h"

namespace goniochrome::tool {

struct Request {
  PictureSize size;  // with --gbuffer, that of the file, or of squares of its points
  int samples = 1;
  int samples_of_point = 1;  // whose mean a point of --gbuffer is, where that is a transport
  // How many points stand beside each other in a pixel.
  int points_across() const { return samples >= 16 ? 4 : samples >= 4 ? 2 : 1; }
  std::vector<render::Light> lights;
  std::vector<std::optional<color::Bands>> light_bands;  // of each that is named
  std::optional<double> stops;
  double stops_by(double automatic) const { return stops.value_or(png ? automatic : 0); }
  std::vector<std::string> aovs;
  bool transport = false;  // among the buffers
  bool png = false;        // whether pictures are as a display shows them: PNG or frames
  color::ReflectionOperator reflection;
  render::PlanRequest plan;
  bool quick = false;  // nobody asked how accurate the picture is to be, nor how long it may take
  const render::EngineInfo* engine = nullptr;  // null: the plan chooses
  bool traces() const { return engine != nullptr && engine->traces_rays; }
  bool smooths_paths = false;  // The scene needs the engine that traces rays, and nobody asked for it by name.
  FloorRequest floor;
  bool floor_named = false;  // whether it is asked for by name
  std::vector<Emission> emissions;
};

// Error (usage): values and combinations of options that cannot be.
Result<Request> request_of(const Options& options);

}  // namespace goniochrome::tool
