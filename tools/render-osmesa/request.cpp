#include "request.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "base/text.h"
#include "render/aov.h"

namespace goniochrome::tool {

namespace {

// --aov transport is no channel: it is traced, and brings the buffers that it is read with.
Result<void> take_transport(const Options& options, Request& request) {
  request.transport = std::erase(request.aovs, "transport") > 0;
  if (!request.transport) return {};
  for (const char* needed : {"normal", "aspecular", "lambert", "mask", "part"})
    if (std::ranges::find(request.aovs, needed) == request.aovs.end()) request.aovs.emplace_back(needed);
  const std::pair<const char*, bool> given[] = {{"gbuffer", !options.gbuffer.empty()},
                                                {"split", !options.split.empty()},
                                                {"turntable", options.turntable > 0},
                                                {"light-sweep", options.light_sweep > 0}};
  for (const auto& [name, is_given] : given)
    if (is_given) return usage_error("--aov transport traces one view of a mesh: leave out --{}", name);
  return {};
}

}  // namespace

Result<Request> request_of(const Options& options) {
  Request request;
  GONIO_TRY(check_surfaces(options));
  GONIO_ASSIGN(request.size, parse_size(options.size));
  for (const std::string& text : options.lights) {
    std::optional<color::Bands> bands;
    GONIO_ASSIGN(const render::Light light, parse_light(text, bands));
    request.lights.push_back(light), request.light_bands.push_back(bands);
  }
  GONIO_ASSIGN(request.stops, parse_exposure(options.exposure));
  request.aovs = aov_names(options.aovs);
  GONIO_TRY(take_transport(options, request));
  const std::string extension = lower(std::filesystem::path(options.output).extension().string());
  request.png = extension == ".png" || (!options.to.empty() && options.to != "exr");
  if (!options.to.empty() && options.output != "-")
    return usage_error("--to {} goes on standard output: give -o -", options.to);
  if (!request.png && extension != ".exr" && options.output != "-") {
    return usage_error("--output is \"{}\": write a name that ends in .exr or .png", options.output);
  }
  GONIO_ASSIGN(request.emissions, parse_emissions(options.emissions));
  if (options.env.empty() && request.lights.empty() && request.emissions.empty() && options.gbuffer.empty())
    return usage_error("there is no light: give --env, --light or both");
  if (options.samples != 0 && options.samples != 1 && options.samples != 4 && options.samples != 16) {
    return usage_error("--samples is {}: give 1, 4 or 16", options.samples);
  }
  GONIO_ASSIGN(request.reflection, color::chosen_operator(options.reflection));
  request.plan.effects = options.effects;
  request.samples = options.samples > 0 ? options.samples : options.gbuffer.empty() ? 4 : 1;
  request.plan.samples = request.samples;
  GONIO_ASSIGN(const FloorRequest named, parse_floor(options.floor, false));
  const bool has_floor = named.kind != FloorRequest::Kind::kNone;
  const bool places = std::ranges::any_of(request.lights, [](const render::Light& l) { return l.place.has_value(); });
  // Only one engine has parts that shine, floors that wear a paint, and floors where no effects of rays are drawn. It
  // also draws the extent of lamps at a place on every paint.
  const bool spectral = options.needs_bands();
  const bool wants_rays = !request.emissions.empty() || spectral || named.kind == FloorRequest::Kind::kPaint ||
                          (has_floor && options.effects.leave_out_rays());
  const char* of_rays = !request.emissions.empty() ? "emit"
                        : spectral                 ? "spectral"
                        : places && !wants_rays    ? "light place:..."
                                                   : "floor";
  const auto tracer = std::ranges::find_if(render::engines(), [](const auto* engine) { return engine->traces_rays; });
  request.smooths_paths = options.engine == "auto" && (wants_rays || places);
  const std::string engine = request.smooths_paths ? (*tracer)->name : options.engine;
  if (engine != "auto") {
    GONIO_ASSIGN(request.engine, render::engine_named(engine));
    request.plan.engine = engine;
  }
  GONIO_ASSIGN(request.floor,
               parse_floor(options.floor, options.background == "env" && (request.traces() || !options.env.empty())));
  request.floor_named = has_floor;
  if (wants_rays && !request.traces())
    return usage_error("--engine {} draws neither parts that shine nor {}: leave out --{}, or take --engine path",
                       options.engine,
                       named.kind == FloorRequest::Kind::kPaint ? "floors that wear a paint"
                       : spectral                               ? "light in bands"
                                                                : "floors without effects of rays",
                       of_rays);
  if ((wants_rays || places || has_floor) && !options.gbuffer.empty())
    return usage_error("--{} needs the mesh: --gbuffer holds one view of surfaces without it", of_rays);
  if (!options.split.empty() && options.check > 0) return usage_error("--split and --check exclude each other");
  if (options.print_shader && options.output == "-")
    return usage_error("--print-shader and a picture both want standard output");
  if (request.png && !request.aovs.empty()) return usage_error("a PNG holds no --aov buffers: write an .exr");
  if (!request.png && !options.view.empty()) return usage_error("--view is for a PNG: an EXR stays scene-linear");
  image::Image unused{0, 0, 0, {}, {}};
  for (const std::string& aov : request.aovs) {
    if (aov != "error") GONIO_TRY(render::add_aov(unused, {}, aov, {}));
    if (aov == "error" && !request.traces())
      return usage_error("--aov error is of pictures by samples: take --engine path");
  }
  return request;
}

}  // namespace goniochrome::tool
