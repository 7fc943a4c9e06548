// render-osmesa draws a mesh in its paints under image light and lamps, on the processor.
#pragma once

#include <string>
#include <vector>

#include "cli/tool.h"
#include "color/reflection_file.h"
#include "render/effect_words.h"
#include "render/engine.h"

namespace goniochrome::tool {

struct Options {
  cli::CommonOptions common;
  std::string mesh, gbuffer, paint, basis, env, output;
  std::string sheet, to;
  std::vector<std::string> parts, lights, emissions;
  std::string floor = "auto";
  bool trim = false;
  int bounces = render::Effort::kUsualBounces;
  std::string size = "auto";
  std::vector<double> camera = {35, 12};  // settled: empty, or six numbers of places
  int samples = 0;
  std::string exposure = "auto";
  std::string view;
  std::string background = "none";
  std::vector<std::string> aovs;
  std::string effects_text = "auto", engine = "auto";
  bool rays_are_refused = false;  // whether --effects says so, in a stream, whose effects are others
  std::string reflection = color::kDefaultOperator;
  std::string spectral = "auto";
  bool needs_bands() const { return spectral == "on" || spectral == "guess"; }
  std::string critical_angle = "slide";
  std::string tilts = "0.005";
  std::vector<std::string> textures;
  std::string texture_maps = "cubes";
  bool print_shader = false;
  std::vector<std::string> split;
  int turntable = 0, light_sweep = 0;
  std::string check_text = "0";
  bool no_cache = false;
  std::string check_source;

  // Values that settled() takes out of --camera, --check, --effects, --engine and --tilts.
  std::vector<double> orbit;
  double fov_deg = 30;
  double tilt_error = 0;  // 0: most_tilts of them
  int most_tilts = 0;
  int check = 0;
  std::string check_against = "auto";
  render::EffectWords effects;
  bool gpu = false;
};

cli::ToolSpec tool_spec(Options& options);
Result<cli::Verdict> run(const Options& options, cli::Session& session);

}  // namespace goniochrome::tool
