#include "run.h"

#include <cmath>
#include <filesystem>

#include "base/text.h"
#include "envmap/environment.h"
#include "mesh/mesh.h"
#include "paints.h"
#include "render/aov.h"
#include "render/display.h"
#include "render/reference.h"
#include "render/renderer.h"
#include "setup.h"

namespace goniochrome {

namespace {

// What the command line says, checked before anything is read.
struct Request {
  PictureSize size;
  std::vector<Light> lights;
  std::optional<double> stops;
  std::vector<std::string> aovs;
  bool png = false;
};

Result<Request> request_of(const RenderOptions& options) {
  Request request;
  GONIO_ASSIGN(request.size, parse_size(options.size));
  for (const std::string& text : options.lights) {
    GONIO_ASSIGN(const Light light, parse_light(text));
    request.lights.push_back(light);
  }
  GONIO_ASSIGN(request.stops, parse_exposure(options.exposure));
  request.aovs = aov_names(options.aovs);
  const std::string extension = lower(std::filesystem::path(options.output).extension().string());
  request.png = extension == ".png";
  if (!request.png && extension != ".exr" && options.output != "-") {
    return usage_error("--output is \"{}\": write a name that ends in .exr or .png", options.output);
  }
  if (options.env.empty() && request.lights.empty())
    return usage_error("there is no light: give --env, --light or both");
  if (options.samples != 1 && options.samples != 4 && options.samples != 16) {
    return usage_error("--samples is {}: give 1, 4 or 16", options.samples);
  }
  if (request.png && !request.aovs.empty()) return usage_error("a PNG holds no --aov buffers: write an .exr");
  if (!request.png && !options.view.empty()) return usage_error("--view is for a PNG: an EXR stays scene-linear");
  Image unused{0, 0, 0, {}, {}};
  for (const std::string& aov : request.aovs) GONIO_TRY(add_aov(unused, {}, aov, {}));
  return request;
}

void tell_mesh(const Mesh& mesh, const DressedMesh& dress, cli::Session& session) {
  const Mesh::Repairs& repairs = mesh.repairs;
  Json& results = session.results();
  results["triangles"] = mesh.triangles.size();
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    const Json paint = dress.names[i].empty() ? Json(nullptr) : Json(dress.names[i]);
    results["parts"].push_back({{"name", mesh.parts[i].name}, {"material", mesh.parts[i].material}, {"paint", paint}});
  }
  results["repairs"] = {{"normals_made", repairs.normals_made},
                        {"degenerate_dropped", repairs.degenerate_dropped},
                        {"polygons_split", repairs.polygons_split},
                        {"triangles_turned", repairs.triangles_turned}};
  if (repairs.normals_made > 0) {
    session.say(fmt::format("{} of {} vertices had no normal and got one", repairs.normals_made, mesh.normals.size()));
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

// A camera that sees the mesh from inside, or not at all, is legal and hardly ever meant.
void tell_visibility(const Gbuffer& gbuffer, cli::Session& session) {
  std::size_t seen = 0, from_inside = 0;
  for (std::size_t i = 3; i < gbuffer.data.size(); i += 4) {
    seen += gbuffer.data[i] != 0;
    from_inside += gbuffer.data[i] < 0;
  }
  if (seen == 0) {
    session.warn("the mesh is not in the picture: check --camera or --orbit");
  } else if (2 * from_inside > seen) {
    session.warn(
        fmt::format("{} % of what is seen are back sides: the camera is inside the mesh, or its faces are turned",
                    100 * from_inside / seen));
  }
}

std::string explanation(const Mesh& mesh, const DressedMesh& dress, const Scene& scene, const std::string& shader) {
  std::string text = fmt::format("mesh: {} triangles, {} parts\n", mesh.triangles.size(), mesh.parts.size());
  for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
    text += fmt::format("  {:24} {}\n", mesh.parts[i].name, dress.names[i].empty() ? "(gray)" : dress.names[i]);
  }
  std::string lobes;
  for (const double exponent : lobe_exponents(scene.paints)) lobes += " " + shortest(exponent);
  text += fmt::format("lobes with weight:{}{}\n", lobes.empty() ? " none" : lobes,
                      has_mirror(scene.paints) ? ", and the mirror" : "");
  text += "left out against the reference: the horizon below a lobe, and the light's own cosine within it\n";
  return text + "program:\n" + shader;
}

struct CheckSource {
  std::optional<Environment> environment;
  std::string name;
};

// The image that the environment was made from: as named, or beside the environment; else its mirror part.
Result<CheckSource> check_source(const RenderOptions& options, const Scene& scene, cli::Session& session) {
  if (scene.env == nullptr) return CheckSource{};
  std::vector<std::string> candidates = {options.check_source};
  if (options.check_source.empty()) {
    candidates = {scene.env->source, (std::filesystem::path(options.env).parent_path() / scene.env->source).string()};
  }
  for (const std::string& path : candidates) {
    std::error_code status;
    const bool is_pattern = path.find("{face}") != std::string::npos;
    const bool there = is_pattern ? face_paths(path).ok() : std::filesystem::is_regular_file(path, status);
    if (!there && options.check_source.empty()) continue;
    GONIO_ASSIGN(Environment environment, Environment::read(path, Environment::BadPixels::kZero));
    return CheckSource{std::move(environment), path};
  }
  if (scene.env->mirror.map.size == 0) {
    return input_error(
        "{}: its source \"{}\" is not there, and it has no mirror part: name the image by --check-source", options.env,
        scene.env->source);
  }
  session.warn(fmt::format("the source \"{}\" of {} is not there: checked against its mirror part instead",
                           scene.env->source, options.env));
  return CheckSource{Environment::from_cube(scene.env->mirror.map, options.env), options.env + " (mirror part)"};
}

void check(const RenderOptions& options, const Frame& frame, const Scene& scene, const CheckSource& source,
           double white, cli::Session& session) {
  session.progress(fmt::format("checking {} pixels", options.check));
  const Environment* environment = source.environment ? &*source.environment : nullptr;
  const PictureError error = picture_error(frame, scene, environment, white, options.check, session.common().seed);
  session.results()["error"] = {{"de00_mean", json_number(error.de00_mean)},
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

Attributes provenance(const cli::Session& session) {
  return {{"goniochrome:tool", session.tool()},
          {"goniochrome:version", std::string(cli::Session::version())},
          {"goniochrome:command", session.command_line()}};
}

std::string spelled(const Vec3& v) {
  return fmt::format("{},{},{}", shortest(v.x), shortest(v.y), shortest(v.z));
}

// What one must know to shade the buffers again: the rays through the pixels, and the light.
void describe_view(const RenderOptions& options, const Rays& rays, const std::vector<Light>& lights,
                   Attributes& attributes) {
  attributes["goniochrome:rays"] =
      fmt::format("{};{};{}", spelled(rays.corner), spelled(rays.right), spelled(rays.down));
  std::string all;
  for (const Light& light : lights)
    all += fmt::format("{}{},{}", all.empty() ? "" : ";", spelled(light.direction), spelled(light.white));
  attributes["goniochrome:lights"] = all;
  attributes["goniochrome:environment"] = options.env;
}

Result<void> write_exr_picture(const RenderOptions& options, const Request& request, const Frame& frame,
                               const Scene& scene, const DiffuseWhite& white, double stops,
                               const cli::Session& session) {
  ImagePart part{"picture", frame.picture, provenance(session), PixelType::kHalf};
  const float gain = static_cast<float>(std::exp2(stops));
  for (std::size_t i = 0; i < part.image.data.size(); ++i) part.image.data[i] *= i % 4 == 3 ? 1 : gain;
  part.attributes["colorInteropID"] = "lin_rec2020_scene";
  part.attributes["chromaticities"] =
      std::vector<float>{0.708F, 0.292F, 0.170F, 0.797F, 0.131F, 0.046F, 0.3127F, 0.3290F};
  part.attributes["goniochrome:exposure"] = static_cast<float>(stops);
  part.attributes["goniochrome:whiteLuminance"] = static_cast<float>(white.luminance);
  if (!request.aovs.empty()) {
    const Vec3 to_light = scene.lights.empty() ? white.direction : scene.lights.front().direction;
    for (const std::string& aov : request.aovs) GONIO_TRY(add_aov(part.image, *frame.gbuffer, aov, to_light));
    part.type = PixelType::kFloat;
    part.attributes["goniochrome:aovLight"] = spelled(to_light);
    describe_view(options, frame.gbuffer->rays, scene.lights, part.attributes);
    Json names = Json::array();
    for (const MeshPart& mesh_part : scene.mesh->parts) names.push_back(mesh_part.name);
    part.attributes["goniochrome:parts"] = names.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  return write_exr(options.output, {part});
}

// Everything that a picture is made from; the scene points into it.
struct Stage {
  Mesh mesh;
  DressedMesh dress;
  PrefilteredEnvironment env;
  Scene scene;
  CheckSource check;
};

Result<void> set_stage(const RenderOptions& options, const Request& request, Stage& stage, cli::Session& session) {
  GONIO_ASSIGN(stage.mesh, read_mesh(options.mesh));
  GONIO_ASSIGN(stage.dress, dressed(stage.mesh, options));
  tell_mesh(stage.mesh, stage.dress, session);
  Scene& scene = stage.scene;
  scene.mesh = &stage.mesh;
  scene.paints = stage.dress.paints;
  scene.lights = request.lights;
  if (!options.env.empty()) {
    GONIO_ASSIGN(stage.env, read_env(options.env));
    scene.env = &stage.env;
  }
  if (options.check > 0) {
    GONIO_ASSIGN(stage.check, check_source(options, scene, session));
  }
  return set_background(scene, options.background);
}

}  // namespace

Result<cli::Verdict> run(const RenderOptions& options, cli::Session& session) {
  GONIO_ASSIGN(const Request request, request_of(options));
  std::optional<Display> display;
  if (request.png) {
    GONIO_ASSIGN(Display made, Display::make(options.view));
    display.emplace(std::move(made));
    session.results()["view"] = display->name();
  }
  Stage stage;
  GONIO_TRY(set_stage(options, request, stage, session));
  const Scene& scene = stage.scene;
  GONIO_ASSIGN(const Camera camera, camera_of(options, stage.mesh, request.size));

  GONIO_ASSIGN(Renderer renderer, Renderer::create());
  if (auto loaded = renderer.load(scene); !loaded.ok()) {
    return Error{loaded.error().kind, (options.env.empty() ? "" : options.env + ": ") + loaded.error().message};
  }
  session.explain(explanation(stage.mesh, stage.dress, scene, renderer.shader()));
  GONIO_ASSIGN(const Frame frame,
               renderer.draw(camera, request.size.width, request.size.height, options.samples, options.check > 0));
  tell_visibility(*frame.gbuffer, session);
  const DiffuseWhite white = diffuse_white(scene.env, scene.lights);
  const double automatic = request.png && white.luminance > 0 ? -std::log2(white.luminance) : 0;
  const double stops = request.stops.value_or(automatic);
  Json& results = session.results();
  results["engine"] = renderer.opengl();
  results["gbuffer_ms"] = frame.gbuffer_ms;
  results["frame_ms"] = frame.frame_ms;
  results["exposure_stops"] = stops;
  results["white_luminance"] = json_number(white.luminance);

  if (display) {
    GONIO_ASSIGN(const Image shown, display->image(frame.picture, stops));
    GONIO_TRY(write_png(options.output, shown, provenance(session)));
  } else {
    GONIO_TRY(write_exr_picture(options, request, frame, scene, white, stops, session));
  }
  session.say(fmt::format(
      "{}: {} x {}, {} samples a pixel, drawn in {:.0f} ms (one rasterization {:.0f} ms), exposure {:+.2f}{}",
      options.output == "-" ? "standard output" : options.output, request.size.width, request.size.height,
      options.samples, frame.frame_ms, frame.gbuffer_ms, stops, display ? ", " + display->name() : ""));
  if (options.check > 0) check(options, frame, scene, stage.check, white.luminance, session);
  return cli::Verdict::kDone;
}

}  // namespace goniochrome
