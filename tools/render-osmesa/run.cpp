#include "tool.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "base/paths.h"
#include "base/text.h"
#include "display/display.h"
#include "envmap/environment.h"
#include "mesh/mesh.h"
#include "paints.h"
#include "plan_text.h"
#include "prefilter/lobe_tree.h"
#include "render/aov.h"
#include "render/engine.h"
#include "render/exact.h"
#include "render/left_out.h"
#include "render/renderer.h"
#include "render/surface_layer.h"
#include "setup.h"
#include "transport_view.h"
#include "truth_check.h"

namespace goniochrome::tool {

namespace {

// Pixels that the truth of each effect is measured at; it takes an integration for each of them.
constexpr int kMostTruth = 100;

// What the command line says, checked before anything is read.
struct Request {
  PictureSize size;  // with --gbuffer, that of the file
  int samples = 1;
  std::vector<render::Light> lights;
  std::optional<double> stops;
  std::vector<std::string> aovs;
  bool transport = false;  // among the buffers
  bool png = false;
  color::ReflectionOperator reflection;
  render::PlanRequest plan;
  const render::EngineInfo* engine = nullptr;  // null: the plan chooses
  FloorRequest floor;
  std::vector<Emission> emissions;
};

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

Result<Request> request_of(const Options& options) {
  Request request;
  GONIO_TRY(check_surfaces(options));
  GONIO_ASSIGN(request.size, parse_size(options.size));
  for (const std::string& text : options.lights) {
    GONIO_ASSIGN(const render::Light light, parse_light(text));
    request.lights.push_back(light);
  }
  GONIO_ASSIGN(request.stops, parse_exposure(options.exposure));
  request.aovs = aov_names(options.aovs);
  GONIO_TRY(take_transport(options, request));
  const std::string extension = lower(std::filesystem::path(options.output).extension().string());
  request.png = extension == ".png";
  if (!request.png && extension != ".exr" && options.output != "-") {
    return usage_error("--output is \"{}\": write a name that ends in .exr or .png", options.output);
  }
  GONIO_ASSIGN(request.emissions, parse_emissions(options.emissions));
  if (options.env.empty() && request.lights.empty() && request.emissions.empty() && options.gbuffer.empty())
    return usage_error("there is no light: give --env, --light or both");
  if (options.samples != 0 && options.samples != 1 && options.samples != 4 && options.samples != 16) {
    return usage_error("--samples is {}: give 1, 4 or 16", options.samples);
  }
  GONIO_ASSIGN(request.reflection, parse_operator(options.reflection));
  GONIO_TRY(render::check_effects(options.effects));
  request.plan.effects = options.effects;
  request.plan.budget_ms = options.budget_ms;
  request.samples = !options.gbuffer.empty() ? 1 : options.samples > 0 ? options.samples : 4;
  request.plan.samples = request.samples;
  const bool wants_rays =
      !request.emissions.empty() || (options.floor != "auto" && options.floor != "none");  // only one engine has them
  const std::string engine = options.engine == "auto" && wants_rays ? "path" : options.engine;
  if (engine != "auto") {
    GONIO_ASSIGN(request.engine, render::engine_named(engine));
    request.plan.engine = engine;
    if (!request.engine->is_planned && options.budget_ms > 0)
      return usage_error("--budget chooses effects of prefiltered maps: leave it out, or --engine {}", options.engine);
  }
  const bool traces = request.engine != nullptr && request.engine->traces_rays;
  GONIO_ASSIGN(request.floor, parse_floor(options.floor, traces && options.background == "env"));
  if (wants_rays && !traces)
    return usage_error("--engine {} draws neither floors nor parts that shine: leave out --{}, or take --engine path",
                       options.engine, request.emissions.empty() ? "floor" : "emit");
  if (wants_rays && !options.gbuffer.empty())
    return usage_error("--{} needs the mesh: --gbuffer holds one view of surfaces without it",
                       request.emissions.empty() ? "floor" : "emit");
  if (!options.split.empty() && options.check > 0) return usage_error("--split and --check exclude each other");
  if (options.print_shader && options.output == "-")
    return usage_error("--print-shader and a picture both want standard output");
  if (request.png && !request.aovs.empty()) return usage_error("a PNG holds no --aov buffers: write an .exr");
  if (!request.png && !options.view.empty()) return usage_error("--view is for a PNG: an EXR stays scene-linear");
  image::Image unused{0, 0, 0, {}, {}};
  for (const std::string& aov : request.aovs) {
    if (aov != "error") GONIO_TRY(render::add_aov(unused, {}, aov, {}));
    if (aov == "error" && !traces) return usage_error("--aov error is of pictures by samples: take --engine path");
  }
  return request;
}

void tell_repairs(const mesh::Mesh& mesh, cli::Session& session) {
  const mesh::Mesh::Repairs& repairs = mesh.repairs;
  session.results()["triangles"] = mesh.triangles.size();
  session.results()["repairs"] = {{"normals_made", repairs.normals_made},
                                  {"degenerate_dropped", repairs.degenerate_dropped},
                                  {"polygons_split", repairs.polygons_split},
                                  {"triangles_turned", repairs.triangles_turned}};
  if (repairs.normals_made > 0) {
    session.say(fmt::format("{} of {} vertices had no normal and got one", repairs.normals_made, mesh.normals.size()));
  }
}

void tell_parts(const mesh::Mesh& mesh, const DressedMesh& dress, cli::Session& session) {
  Json& results = session.results();
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    const Json paint = dress.names[i].empty() ? Json(nullptr) : Json(dress.names[i]);
    results["parts"].push_back({{"name", mesh.parts[i].name}, {"material", mesh.parts[i].material}, {"paint", paint}});
  }
  if (dress.unpainted.empty()) return;
  std::string names;
  for (std::size_t i = 0; i < std::min<std::size_t>(6, dress.unpainted.size()); ++i) {
    names += (i == 0 ? "" : ", ") + dress.unpainted[i];
  }
  session.warn(fmt::format("{} of {} parts have no paint and are matt gray: {}{}: give --paint or --part",
                           dress.unpainted.size(), mesh.parts.size(), names,
                           dress.unpainted.size() > 6 ? ", ..." : ""));
}

// A camera that sees the mesh from inside, or not at all, is legal and hardly ever meant; and so are single parts of
// which only back sides are seen.
void tell_visibility(const render::Gbuffer& gbuffer, const mesh::Mesh& mesh, cli::Session& session) {
  constexpr std::size_t kMany = 20, kMostNames = 6;  // fewer pixels may be those of a rim
  std::size_t seen = 0, from_inside = 0;
  std::vector<std::size_t> fronts(mesh.parts.size()), backs(mesh.parts.size());
  for (std::size_t i = 3; i < gbuffer.data.size(); i += 4) {
    seen += gbuffer.data[i] != 0;
    from_inside += gbuffer.data[i] < 0;
    if (gbuffer.data[i] == 0) continue;
    const auto part = static_cast<std::size_t>(std::abs(gbuffer.data[i])) - 1;
    ++(gbuffer.data[i] < 0 ? backs : fronts)[part];
  }
  std::string turned;
  std::size_t count = 0;
  for (std::size_t part = 0; part < backs.size(); ++part) {
    if (backs[part] < kMany || fronts[part] > backs[part] / 100) continue;
    if (++count <= kMostNames) turned += (turned.empty() ? "" : ", ") + mesh.parts[part].name;
  }
  if (count > kMostNames) turned += ", ...";
  if (count > 0 && 2 * from_inside <= seen) {
    session.warn(fmt::format("{} show{} {} back{} alone: {} faces may be turned inside out", turned,
                             count == 1 ? "s" : "", count == 1 ? "its" : "their", count == 1 ? "" : "s",
                             count == 1 ? "its" : "their"));
  }
  if (seen == 0) {
    session.warn("the mesh is not in the picture: check --camera or --orbit");
  } else if (2 * from_inside > seen) {
    session.warn(
        fmt::format("{} % of what is seen are back sides: the camera is inside the mesh, or its faces are turned",
                    100 * from_inside / seen));
  }
}

std::string explanation(const Options& options, const mesh::Mesh& mesh, const DressedMesh& dress) {
  std::string text = options.gbuffer.empty()
                         ? fmt::format("mesh: {} triangles, {} parts\n", mesh.triangles.size(), mesh.parts.size())
                         : fmt::format("buffers of {}: {} parts\n", options.gbuffer, mesh.parts.size());
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    text += fmt::format("  {:24} {}\n", mesh.parts[i].name, dress.names[i].empty() ? "(gray)" : dress.names[i]);
  }
  return text;
}

struct Source {
  std::optional<envmap::Environment> environment;
  std::string name;
};

// Whether the image holds the light of the environment, which may have been turned, brightened or cut since: their
// irradiance agrees about the middle of each face.
bool is_same_light(const envmap::Environment& image, const envmap::PrefilteredEnvironment& env) {
  constexpr double kApart = 0.03;  // of the largest; the tolerance of the diffuse map is at most a tenth in use
  const envmap::CubeMap& map = env.diffuse.map;
  if (map.size == 0) return true;  // nothing to tell by
  const prefilter::LobeTree exact(image);
  const int middle = map.size / 2;
  double largest = 0, apart = 0;
  for (int face = 0; face < 6; ++face) {
    const Vec3 truth = exact.lobe(envmap::cube_direction(face, middle + 0.5, middle + 0.5, map.size), 1, 1e-3);
    for (int c = 0; c < 3; ++c) {
      largest = std::max(largest, truth[c]);
      apart = std::max(apart, std::abs(truth[c] - map.at(face, middle, middle)[c]));
    }
  }
  return apart <= (kApart + env.diffuse.tolerance) * largest;
}

// The image that the environment was made from: as named, or beside the environment, if
// it holds the same light; else its mirror part.
Result<Source> source_of(const Options& options, const render::Scene& scene, cli::Session& session) {
  if (scene.env == nullptr) return Source{};
  std::vector<std::string> candidates = {options.check_source};
  if (options.check_source.empty()) {
    candidates = {scene.env->source, (std::filesystem::path(options.env).parent_path() / scene.env->source).string()};
  }
  std::string missing = "is not there";
  for (const std::string& path : candidates) {
    const bool is_pattern = path.find("{face}") != std::string::npos;
    const bool there = is_pattern ? envmap::face_paths(path).ok() : is_plain_file(path);
    if (!there && options.check_source.empty()) continue;
    GONIO_ASSIGN(envmap::Environment environment,
                 envmap::Environment::read(path, envmap::Environment::BadPixels::kZero));
    if (is_same_light(environment, *scene.env)) return Source{std::move(environment), path};
    missing = "is turned, brightened or cut there";
    break;
  }
  if (scene.env->mirror.map.size == 0) {
    return input_error(
        "{}: its source \"{}\" {}, and it has no mirror part: name the image by --check-source, or make it with a "
        "mirror",
        options.env, scene.env->source, missing);
  }
  session.warn(fmt::format("the source \"{}\" of {} {}: its mirror part takes its place", scene.env->source,
                           options.env, missing));
  return Source{envmap::Environment::from_cube(scene.env->mirror.map, options.env), options.env + " (mirror part)"};
}

void check(const Options& options, const render::Frame& frame, const render::Scene& scene, const Source& source,
           double white, cli::Session& session) {
  session.progress(fmt::format("checking {} pixels", options.check));
  const envmap::Environment* environment = source.environment ? &*source.environment : nullptr;
  const render::PictureError error =
      render::picture_error(frame, scene, environment, white, options.check, session.common().seed);
  session.results()["error"] = {{"against", "model"},
                                {"de00_mean", json_number(error.de00_mean)},
                                {"de00_p95", json_number(error.de00_p95)},
                                {"de00_max", json_number(error.de00_max)},
                                {"checked_pixels", error.checked_pixels},
                                {"worst_x", error.worst_x},
                                {"worst_y", error.worst_y},
                                {"time_s", error.time_s},
                                {"source", source.name}};
  session.say(fmt::format("dE00 to the reference: mean {:.2f}, p95 {:.2f}, max {:.2f} at {},{} ({} pixels, {:.1f} s)",
                          error.de00_mean, error.de00_p95, error.de00_max, error.worst_x, error.worst_y,
                          error.checked_pixels, error.time_s));
}

// Beside the plan's estimates, what they are worth here: how far the picture is from that of all effects, and its time.
Result<void> measure_plan(render::Renderer& renderer, const render::Scene& scene, const render::Plan& plan,
                          const render::View& view, double white, cli::Session& session) {
  GONIO_ASSIGN(const render::LeftOut measured, render::left_out(renderer, scene, plan, view, white));
  const double predicted_ms = plan.predicted_ms();
  session.results()["left_out"] = {
      {"de00_mean", json_number(measured.de00_mean)}, {"de00_p95", json_number(measured.de00_p95)},
      {"de00_max", json_number(measured.de00_max)},   {"shading_ms", measured.planned_ms},
      {"shading_all_ms", measured.full_ms},           {"predicted_ms", predicted_ms / view.samples}};
  session.say(fmt::format(
      "left out: dE00 p95 {:.2f} to the picture of all effects (predicted {:.2f}); shading {:.1f} ms a sample of each "
      "pixel (predicted {:.1f}), with all effects {:.1f}",
      measured.de00_p95, plan.de00_p95, measured.planned_ms, predicted_ms / view.samples, measured.full_ms));
  return {};
}

image::Attributes provenance(const cli::Session& session) {
  return {{"goniochrome:tool", session.tool()},
          {"goniochrome:version", std::string(cli::Session::version())},
          {"goniochrome:command", session.command_line()}};
}

std::string spelled(const Vec3& v) {
  return fmt::format("{},{},{}", shortest(v.x), shortest(v.y), shortest(v.z));
}

// What one must know to shade the buffers again: the rays through the pixels, and the light.
void describe_view(const Options& options, const render::Rays& rays, const std::vector<render::Light>& lights,
                   image::Attributes& attributes) {
  attributes["goniochrome:rays"] =
      fmt::format("{};{};{}", spelled(rays.corner), spelled(rays.right), spelled(rays.down));
  std::string all;
  for (const render::Light& light : lights)
    all += fmt::format("{}{},{}", all.empty() ? "" : ";", spelled(light.direction), spelled(light.white));
  attributes["goniochrome:lights"] = all;
  attributes["goniochrome:environment"] = options.env;
}

// The 27 coefficients, the last index running fastest.
std::string spelled(const color::ReflectionOperator& reflection) {
  std::string all;
  for (const auto& matrix : reflection.k)
    for (const auto& row : matrix)
      for (const double value : row) all += (all.empty() ? "" : ",") + shortest(value);
  return all;
}

Result<void> write_exr_picture(const Options& options, const Request& request, const Shot& shot,
                               const render::Frame& frame, const render::Scene& scene, const render::Plan& plan,
                               const render::DiffuseWhite& white, double stops, double automatic,
                               const render::TransportParts* transport, const cli::Session& session) {
  image::ImagePart part{"picture", frame.picture, provenance(session), image::PixelType::kHalf};
  part.attributes["goniochrome:plan"] = plan_rows(plan, false).dump(-1, ' ', false, Json::error_handler_t::replace);
  part.attributes["goniochrome:engine"] = plan.engine;
  const float gain = static_cast<float>(std::exp2(stops));
  for (std::size_t i = 0; i < part.image.data.size(); ++i) part.image.data[i] *= i % 4 == 3 ? 1 : gain;
  part.attributes["colorInteropID"] = "lin_rec2020_scene";
  part.attributes["chromaticities"] =
      std::vector<float>{0.708F, 0.292F, 0.170F, 0.797F, 0.131F, 0.046F, 0.3127F, 0.3290F};
  part.attributes["goniochrome:exposure"] = static_cast<float>(stops);
  part.attributes["goniochrome:whiteLuminance"] = static_cast<float>(white.luminance);
  part.attributes["goniochrome:automaticExposure"] = static_cast<float>(automatic);
  if (!request.aovs.empty()) {
    const Vec3 to_light = scene.lights.empty() ? white.direction : scene.lights.front().direction;
    for (const std::string& aov : request.aovs) {
      if (aov == "error") {
        render::add_error(part.image, frame.noise.value());
      } else {
        GONIO_TRY(render::add_aov(part.image, *frame.gbuffer, aov, to_light));
      }
    }
    part.type = image::PixelType::kFloat;
    part.attributes["goniochrome:aovLight"] = spelled(to_light);
    describe_view(options, frame.gbuffer->rays, scene.lights, part.attributes);
    part.attributes["goniochrome:operator"] = spelled(scene.reflection);
    part.attributes["goniochrome:samples"] = request.samples;
    Json names = Json::array(), materials = Json::array();
    for (const mesh::MeshPart& mesh_part : scene.mesh->parts) {
      names.push_back(mesh_part.name);
      materials.push_back(mesh_part.material);
    }
    if (transport != nullptr && scene.ground) names.push_back("floor"), materials.push_back("");
    part.attributes["goniochrome:parts"] = names.dump(-1, ' ', false, Json::error_handler_t::replace);
    part.attributes["goniochrome:materials"] = materials.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  std::vector<image::ImagePart> parts;
  if (transport != nullptr) part.attributes[render::kTransportAttribute] = transport->header;
  parts.push_back(std::move(part));
  if (transport != nullptr) parts.insert(parts.end(), transport->parts.begin(), transport->parts.end());
  return image::write_exr(shot.output, parts);
}

// Everything that a picture is made from; the scene points into it.
struct Stage {
  mesh::Mesh mesh;                                 // of its parts alone where there are buffers of it
  std::shared_ptr<const render::Gbuffer> gbuffer;  // of --gbuffer, or none
  std::optional<KeptTransport> transport;          // of --gbuffer, or none
  std::vector<DressedMesh> dresses;                // one, or those of --split
  envmap::PrefilteredEnvironment env;
  render::Scene scene;
  std::optional<render::MipCube> mip;
  std::unique_ptr<render::SurfaceLayer> layer;
  Source source;                            // where the picture is checked, or sums it
  std::optional<envmap::BlockTree> texels;  // of the source
  std::optional<envmap::Environment> sky;   // that rays meet: the environment at the resolution of its mirror part
  std::optional<render::RaySetup> rays;     // none: not asked for
};

void wear(const DressedMesh& dress, const Options& options, Stage& stage) {
  render::Scene& scene = stage.scene;
  scene.paints = dress.paints;
  scene.gloss_deg = dress.gloss_deg;
  scene.anisotropy = dress.anisotropy;
  stage.layer = std::make_unique<render::SurfaceLayer>(
      scene, dress.surfaces, brdf::critical_angle_of(options.critical_angle).value_or(brdf::CriticalAngle::kSlide),
      stage.mip ? &*stage.mip : nullptr);
  scene.layer = stage.layer->empty() ? nullptr : stage.layer.get();
}

Result<void> dress_stage(const Options& options, Stage& stage) {
  if (options.split.empty()) {
    GONIO_ASSIGN(DressedMesh dress, dressed(stage.mesh, options));
    stage.dresses.push_back(std::move(dress));
    return {};
  }
  std::vector<std::string> paints;
  for (const std::string& text : options.split) {
    for (const std::string_view paint : split(text, ',')) paints.emplace_back(trimmed(paint));
  }
  if (paints.size() != 2)
    return usage_error("--split names {} paints: write two, A.xml#NAME,B.xml#NAME", paints.size());
  for (const std::string& paint : paints) {
    GONIO_ASSIGN(DressedMesh dress, dressed_in(stage.mesh, options, paint));
    stage.dresses.push_back(std::move(dress));
  }
  return {};
}

// The buffers of --gbuffer, and a mesh that has their parts.
Result<void> set_gbuffer(const Options& options, const Request& request, Stage& stage, cli::Session& session) {
  GONIO_ASSIGN(const image::AovFile buffers, image::read_aov_file(options.gbuffer));
  GONIO_ASSIGN(render::Gbuffer gbuffer, render::gbuffer_of(buffers));
  stage.gbuffer = std::make_shared<const render::Gbuffer>(std::move(gbuffer));
  GONIO_ASSIGN(stage.transport, kept_transport(buffers, options, request.lights, session));
  // A floor keeps the paint that it wore.
  const std::size_t floors = stage.transport && stage.transport->light.worn.has_floor ? 1 : 0;
  for (std::size_t i = 0; i + floors < buffers.parts.size(); ++i)
    stage.mesh.parts.push_back({buffers.parts[i], buffers.materials[i], 0, 0});
  if (!stage.transport && options.env.empty() && request.lights.empty())
    return usage_error("there is no light: give --env, --light or both");
  if (stage.transport && options.check > 0)
    return usage_error("--check compares with light that nothing blocks: leave it out, or give --mesh");
  if (stage.transport && !options.split.empty())
    return usage_error("--split is not drawn from a transport: draw two pictures");
  return {};
}

// The light that rays meet, where --effects names any effect of rays. Prefiltered environments hold it in their mirror
// part, unless that was left out.
void set_rays(const Options& options, const Request& request, Stage& stage) {
  const auto named = [&](const char* name) { return options.effects.find(name) != std::string::npos; };
  if (request.engine != nullptr && request.engine->traces_rays) return;
  if (!named("+rays") && !named("+shadow") && !named("+self") && !named("+bounce")) return;
  render::RaySetup& rays = stage.rays.emplace();
  if (!options.gbuffer.empty()) {
    rays.absent = "buffers without their mesh: what it blocks is not known";
  } else if (!options.env.empty() && stage.env.mirror.map.size == 0) {
    rays.absent = "the environment has no mirror part, which rays would meet: make it without --no-mirror";
  } else if (!options.env.empty()) {
    stage.sky.emplace(envmap::Environment::from_cube(stage.env.mirror.map, options.env));
    rays.environment = &*stage.sky;
  }
}

Result<void> set_stage(const Options& options, const Request& request, Stage& stage, cli::Session& session) {
  if (options.gbuffer.empty()) {
    GONIO_ASSIGN(stage.mesh, mesh::read_mesh(options.mesh));
    tell_repairs(stage.mesh, session);
  } else {
    GONIO_TRY(set_gbuffer(options, request, stage, session));
  }
  GONIO_TRY(dress_stage(options, stage));
  tell_parts(stage.mesh, stage.dresses.front(), session);
  render::Scene& scene = stage.scene;
  scene.mesh = &stage.mesh;
  scene.lights = request.lights;
  scene.reflection = request.reflection;
  if (!options.env.empty()) {
    GONIO_ASSIGN(stage.env, envmap::read_env(options.env));
    scene.env = &stage.env;
    if (options.texture_maps == "mip") {
      GONIO_ASSIGN(stage.mip, render::mip_cube(stage.env));
    }
  }
  wear(stage.dresses.front(), options, stage);
  set_rays(options, request, stage);
  const bool summed = request.engine != nullptr && request.engine->needs_texels;
  if (options.check > 0 || summed || request.transport) {
    GONIO_ASSIGN(stage.source, source_of(options, scene, session));
  }
  if (summed && stage.source.environment) scene.texels = &stage.texels.emplace(*stage.source.environment);
  GONIO_TRY(set_ground(request.floor, options, scene));
  GONIO_ASSIGN(scene.emission, emission_of(stage.mesh, request.emissions));
  return set_background(scene, options.background);
}

// The right half of `other` takes the place of the picture's.
void put_right_half(const render::Frame& other, render::Frame& frame) {
  for (int y = 0; y < frame.picture.height; ++y) {
    for (int x = frame.picture.width / 2; x < frame.picture.width; ++x) {
      std::copy_n(other.picture.pixel(x, y), 4, frame.picture.pixel(x, y));
    }
  }
}

constexpr double kMiddleGray = 0.18;

// Of what is seen of the mesh: what a scene that only its own parts light is exposed by.
double mean_luminance(const render::Frame& frame) {
  double sum = 0;
  std::size_t count = 0;
  for (int y = 0; y < frame.gbuffer->height; ++y) {
    for (int x = 0; x < frame.gbuffer->width; ++x) {
      if (frame.gbuffer->part(x, y) < 0) continue;
      const float* rgb = frame.picture.pixel(x, y);
      sum += color::xyz_d65_from_rgb({rgb[0], rgb[1], rgb[2]}).Y / color::xyz_d65_from_rgb({1, 1, 1}).Y;
      ++count;
    }
  }
  return count > 0 ? sum / static_cast<double>(count) : 0;
}

// A run that draws: its shots share one context and one upload.
class Shooting {
 public:
  Shooting(const Options& options, Request request, Stage& stage, cli::Session& session)
      : options_(options), request_(std::move(request)), stage_(stage), session_(session) {}

  Result<cli::Verdict> shoot(const std::optional<display::Display>& display);

 private:
  render::View view(const Shot& shot, int shrink) const {
    return {shot.camera, std::max(1, request_.size.width / shrink), std::max(1, request_.size.height / shrink),
            shrink > 1 ? 1 : request_.samples, shrink == 1 && options_.check > 0};
  }
  Result<render::Renderer> make_renderer();
  void tell_noise();
  Result<void> look(render::Renderer& renderer);
  Result<render::Plan> load(render::Renderer& renderer, const DressedMesh& dress);
  Result<void> draw(render::Renderer& renderer, const Shot& shot, bool first);
  Result<cli::Verdict> shade_transport(const std::optional<display::Display>& display);
  Result<void> write(const Shot& shot, const std::optional<display::Display>& display, double stops);
  Result<cli::Verdict> check_picture();
  void tell_plan(render::Plan plan, const std::string& shader);

  const Options& options_;
  Request request_;
  Stage& stage_;
  cli::Session& session_;
  std::vector<Shot> shots_;
  std::vector<std::shared_ptr<const render::Gbuffer>> looks_;
  render::DiffuseWhite white_;
  render::Plan plan_;
  render::Frame frame_;
  double automatic_stops_ = 0;  // of a PNG
  bool stopped_ = false;        // by the time limit
};

// A sequence is planned on small pictures from some of its places, a single picture on itself.
Result<void> Shooting::look(render::Renderer& renderer) {
  constexpr std::size_t kLooks = 8;
  const int shrink = shots_.size() > 1 ? 4 : 1;
  const std::size_t step = (shots_.size() + kLooks - 1) / kLooks;
  for (std::size_t i = 0; i < shots_.size(); i += step) {
    GONIO_ASSIGN(std::shared_ptr<const render::Gbuffer> seen, renderer.look(stage_.mesh, view(shots_[i], shrink)));
    looks_.push_back(std::move(seen));
    if (options_.turntable == 0) break;
  }
  return {};
}

Result<render::Plan> Shooting::load(render::Renderer& renderer, const DressedMesh& dress) {
  wear(dress, options_, stage_);
  auto plan = renderer.load(stage_.scene, looks_, request_.plan);
  if (plan.ok()) return plan;
  return Error{plan.error().kind, (options_.env.empty() ? "" : options_.env + ": ") + plan.error().message};
}

void Shooting::tell_plan(render::Plan plan, const std::string& shader) {
  Json& results = session_.results();
  for (Json& row : plan_rows(plan, true)) results["plan"].push_back(std::move(row));
  results["plan_de00_p95"] = json_number(plan.de00_p95);
  results["plan_ms"] = plan.time_ms;
  results["engine"] = plan.engine;
  results["engine_reason"] = plan.engine_reason;
  session_.explain(plan_table(plan));
  if (options_.print_shader) std::fputs(shader.c_str(), stdout);
  plan_ = std::move(plan);
}

Result<void> Shooting::draw(render::Renderer& renderer, const Shot& shot, bool first) {
  stage_.scene.lights = shot.lights;
  for (std::size_t i = 0; i < stage_.dresses.size(); ++i) {
    render::Frame other;
    if (stage_.dresses.size() > 1 || first) {
      GONIO_ASSIGN(render::Plan plan, load(renderer, stage_.dresses[i]));
      if (first && options_.check > 0 && session_.common().explain) {
        const envmap::Environment* environment = stage_.source.environment ? &*stage_.source.environment : nullptr;
        const auto sample = render::sampled_pixels(*looks_.front(), stage_.scene, std::min(options_.check, kMostTruth),
                                                   session_.common().seed);
        render::add_truth(plan, render::seen_scene(stage_.scene, looks_), sample.points, environment, white_.luminance);
      }
      if (first) {
        tell_plan(std::move(plan), renderer.shader());
        for (const std::string& remark : renderer.remarks()) session_.warn(remark);
      }
    } else {
      wear(stage_.dresses[i], options_, stage_);
      renderer.load_paints(stage_.scene);
    }
    GONIO_TRY(renderer.draw(view(shot, 1), i == 0 ? frame_ : other));
    if (i == 1) put_right_half(other, frame_);
  }
  return {};
}

Result<void> Shooting::write(const Shot& shot, const std::optional<display::Display>& display, double stops) {
  if (!display) {
    std::optional<TracedView> traced;
    if (request_.transport) {
      const envmap::Environment* environment = stage_.source.environment ? &*stage_.source.environment : nullptr;
      GONIO_ASSIGN(traced,
                   traced_view(stage_.scene, environment, request_.engine == nullptr || request_.engine->is_planned,
                               *frame_.gbuffer, white_.luminance, options_.bounces, session_));
      frame_.gbuffer = traced->gbuffer;
    }
    return write_exr_picture(options_, request_, shot, frame_, stage_.scene, plan_, white_, stops, automatic_stops_,
                             traced ? &traced->file : nullptr, session_);
  }
  GONIO_ASSIGN(const image::Image shown, display->image(frame_.picture, stops));
  return image::write_png(shot.output, shown, provenance(session_));
}

// Other paints in the light that was traced; nothing is planned, since all is there.
Result<cli::Verdict> Shooting::shade_transport(const std::optional<display::Display>& display) {
  const KeptTransport& kept = *stage_.transport;
  GONIO_ASSIGN(ShadedView view, shaded_view(kept, *stage_.gbuffer, stage_.dresses.front(), stage_.scene, session_));
  frame_.picture = std::move(view.picture), frame_.gbuffer = stage_.gbuffer;
  white_ = {kept.white_luminance, {0, 1, 0}};
  plan_.engine = "transport", plan_.engine_reason = options_.gbuffer + " holds the light by lobes";
  stage_.scene.lights.clear();
  for (const image::AovLight& light : kept.lights) stage_.scene.lights.push_back({light.direction, light.white});
  automatic_stops_ = kept.automatic_stops;
  const double stops = request_.stops.value_or(request_.png ? automatic_stops_ : 0);
  GONIO_TRY(write({{}, {}, options_.output}, display, stops));
  Json& results = session_.results();
  results["engine"] = plan_.engine, results["engine_reason"] = plan_.engine_reason;
  results["gbuffer_ms"] = 0, results["frame_ms"] = view.frame_ms, results["frames"] = 1;
  results["exposure_stops"] = stops, results["white_luminance"] = json_number(white_.luminance);
  session_.say(fmt::format("{}: {} x {}, shaded in {:.1f} ms from the light of {}, exposure {:+.2f}{}",
                           options_.output == "-" ? "standard output" : options_.output, request_.size.width,
                           request_.size.height, view.frame_ms, options_.gbuffer, stops,
                           display ? ", " + display->name() : ""));
  return view.trace_again ? cli::Verdict::kNegative : cli::Verdict::kDone;
}

// Rays find what is visible for the engine that traces them, and where there is no OpenGL.
Result<render::Renderer> Shooting::make_renderer() {
  render::Effort effort;
  effort.bounces = options_.bounces;
  effort.time_limit_s = session_.common().time_limit_s;
  effort.seed = session_.common().seed;
  effort.progress = [this](double noise, double seconds) {
    session_.progress(fmt::format("noise {:.2f} dE00 after {:.1f} s", noise, seconds));
  };
  const auto ready = [&](render::Renderer renderer) {
    renderer.set_effort(std::move(effort));
    if (stage_.rays) renderer.set_rays(*stage_.rays);
    return Result<render::Renderer>(std::move(renderer));
  };
  if (stage_.gbuffer) return ready(render::Renderer::shading(stage_.gbuffer));
  if (request_.engine != nullptr && request_.engine->traces_rays)
    return ready(render::Renderer::tracing(stage_.scene.ground));
  auto renderer = render::Renderer::create();
  if (renderer.ok()) return ready(*std::move(renderer));
  if (request_.engine != nullptr && std::string_view(request_.engine->name) == "gl") return renderer;
  session_.say(fmt::format("{}: rays find what is visible", renderer.error().message));
  return ready(render::Renderer::tracing());
}

void Shooting::tell_noise() {
  if (!frame_.noise) return;
  const render::Noise& noise = *frame_.noise;
  stopped_ |= !noise.reached;
  Json& results = session_.results();
  results["noise_de00_p95"] = json_number(noise.de00_p95);
  results["noise_de00_mean"] = json_number(noise.de00_mean);
  results["noise_reached"] = !stopped_;
  results["samples_mean"] = noise.samples_mean;
  results["path_s"] = noise.time_s;
  results["bounces"] = options_.bounces;
  session_.say(fmt::format(
      "noise: dE00 p95 {:.2f}, mean {:.2f} after {:.0f} samples a pixel in {:.1f} s{}", noise.de00_p95, noise.de00_mean,
      noise.samples_mean, noise.time_s,
      noise.reached ? "" : fmt::format(", stopped before it was within {}", shortest(session_.common().tolerance))));
}

Result<cli::Verdict> Shooting::shoot(const std::optional<display::Display>& display) {
  if (stage_.transport) return shade_transport(display);
  GONIO_ASSIGN(shots_, shots_of(options_, stage_.mesh, request_.size, request_.lights));
  GONIO_ASSIGN(render::Renderer renderer, make_renderer());
  GONIO_TRY(look(renderer));
  tell_visibility(*looks_.front(), stage_.mesh, session_);
  white_ = render::diffuse_white(stage_.scene.env, stage_.scene.lights);
  request_.plan.white_luminance = white_.luminance;
  request_.plan.tolerance_de00 = session_.common().tolerance;
  request_.plan.frames = static_cast<int>(shots_.size());
  request_.plan.pixels = static_cast<double>(request_.size.width) * request_.size.height;
  session_.explain(explanation(options_, stage_.mesh, stage_.dresses.front()));
  const render::Rays& through = looks_.front()->rays;
  const Vec3 to_camera = -through.direction(0.5 * looks_.front()->width, 0.5 * looks_.front()->height);
  double metered = render::metered_white(stage_.scene.env, stage_.scene.lights, to_camera);
  double stops = 0;
  double frame_ms = 0;
  for (const Shot& shot : shots_) {
    GONIO_TRY(draw(renderer, shot, &shot == &shots_.front()));
    frame_ms += frame_.frame_ms / static_cast<double>(shots_.size());
    tell_noise();
    if (&shot == &shots_.front()) {
      if (!(metered > 0)) metered = mean_luminance(frame_) / kMiddleGray;
      automatic_stops_ = metered > 0 ? -std::log2(metered) : 0;
      stops = request_.stops.value_or(request_.png ? automatic_stops_ : 0);
    }
    if (stage_.scene.ground && shot.camera.eye.y <= stage_.scene.ground->height)
      session_.warn(fmt::format("the camera of {} is below the floor, which is black from there", shot.output));
    session_.progress(shot.output);
    GONIO_TRY(write(shot, display, stops));
  }
  Json& results = session_.results();
  results["opengl"] = stage_.gbuffer || renderer.traces() ? Json(nullptr) : Json(renderer.opengl());
  results["gbuffer_ms"] = frame_.gbuffer_ms;
  results["frame_ms"] = frame_ms;
  results["frames"] = shots_.size();
  results["exposure_stops"] = stops;
  results["white_luminance"] = json_number(white_.luminance);
  const std::string name = options_.output == "-" ? "standard output" : shots_.front().output;
  session_.say(fmt::format(
      "{}{}: {} x {}, {} samples a pixel, drawn in {:.0f} ms by {} (one rasterization {:.0f} ms), exposure {:+.2f}{}",
      name, shots_.size() > 1 ? fmt::format(" and {} more", shots_.size() - 1) : "", request_.size.width,
      request_.size.height, request_.samples, frame_ms, plan_.engine, frame_.gbuffer_ms, stops,
      display ? ", " + display->name() : ""));
  if (plan_.effects.rays.any()) {
    results["rays"] = {{"noise_de00_p95", json_number(frame_.rays.de00_p95)},
                       {"samples", frame_.rays.samples},
                       {"free_share", frame_.rays.free_share},
                       {"ms", frame_.rays.ms},
                       {"predicted_ms", plan_.rays_ms}};
    session_.say(fmt::format("rays: {:.0f} samples a point in {:.0f} ms (predicted {:.0f}), noise dE00 {:.2f} (p95)",
                             frame_.rays.samples, frame_.rays.ms, plan_.rays_ms, frame_.rays.de00_p95));
  }
  cli::Verdict verdict = cli::Verdict::kDone;
  if (options_.check > 0) {
    GONIO_ASSIGN(verdict, check_picture());
    GONIO_TRY(measure_plan(renderer, render::seen_scene(stage_.scene, looks_), plan_, view(shots_.back(), 1),
                           white_.luminance, session_));
  }
  return stopped_ ? cli::Verdict::kStopped : verdict;
}

Result<cli::Verdict> Shooting::check_picture() {
  if (options_.check_against == "model" || stage_.gbuffer) {
    check(options_, frame_, stage_.scene, stage_.source, white_.luminance, session_);
    return cli::Verdict::kDone;
  }
  session_.progress(fmt::format("checking {} pixels", options_.check));
  render::TruthRequest request;
  request.environment = stage_.source.environment ? &*stage_.source.environment : nullptr;
  request.white_luminance = white_.luminance;
  request.count = options_.check;
  request.bounces = options_.bounces;
  request.seed = session_.common().seed;
  request.whole = request_.engine != nullptr && request_.engine->traces_rays;
  GONIO_ASSIGN(const render::TruthError error, render::truth_error(frame_, stage_.scene, plan_.effects.rays, request));
  tell_truth(error, stage_.source.name, session_.common().tolerance, session_);
  return error.total.de00_p95 > session_.common().tolerance ? cli::Verdict::kNegative : cli::Verdict::kDone;
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  GONIO_ASSIGN(Request request, request_of(options));
  std::optional<display::Display> display;
  if (request.png) {
    GONIO_ASSIGN(display::Display made, display::Display::make(options.view));
    display.emplace(std::move(made));
    session.results()["view"] = display->name();
  }
  Stage stage;
  GONIO_TRY(set_stage(options, request, stage, session));
  if (stage.gbuffer) request.size = {stage.gbuffer->width, stage.gbuffer->height};
  return Shooting(options, std::move(request), stage, session).shoot(display);
}

}  // namespace goniochrome::tool
