#include "sight.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::tool {

namespace {

void tell_visibility(const render::Gbuffer& gbuffer, const mesh::Mesh& mesh, cli::Session& session) {
  constexpr std::size_t kMany = 20;  // fewer pixels may be those of a rim
  std::size_t seen = 0, from_inside = 0;
  std::vector<std::size_t> fronts(mesh.parts.size()), backs(mesh.parts.size());
  for (std::size_t i = 3; i < gbuffer.data.size(); i += 4) {
    seen += gbuffer.data[i] != 0;
    from_inside += gbuffer.data[i] < 0;
    if (gbuffer.data[i] == 0) continue;
    const auto part = static_cast<std::size_t>(std::abs(gbuffer.data[i])) - 1;
    ++(gbuffer.data[i] < 0 ? backs : fronts)[part];
  }
  std::vector<std::string> turned;
  for (std::size_t part = 0; part < backs.size(); ++part)
    if (backs[part] >= kMany && fronts[part] <= backs[part] / 100) turned.push_back(mesh.parts[part].name);
  const std::size_t count = turned.size();
  if (count > 0 && 2 * from_inside <= seen) {
    session.warn(fmt::format("{} show{} {} back{} alone: {} faces may be turned inside out", first_names(turned),
                             count == 1 ? "s" : "", count == 1 ? "its" : "their", count == 1 ? "" : "s",
                             count == 1 ? "its" : "their"));
  }
  if (seen == 0) {
    session.warn("the mesh is not in the picture: check --camera");
  } else if (2 * from_inside > seen) {
    session.warn(
        fmt::format("{} % of what is seen are back sides: the camera is inside the mesh, or its faces are turned",
                    100 * from_inside / seen));
  }
}

}  // namespace

render::Effort effort_of(const Options& options, const Request& request, cli::Session& session) {
  render::Effort effort;
  effort.bounces = options.bounces;
  effort.time_limit_s = request.quick ? kQuick_s : session.common().time_limit_s;
  effort.seed = session.common().seed;
  effort.smooth = request.smooths_paths;
  effort.progress = [&session](double noise, double seconds) {
    session.progress(fmt::format("noise {:.2f} dE00 after {:.1f} s", noise, seconds));
  };
  return effort;
}

Result<render::Renderer> make_renderer(const Options& options, const Request& request, const Stage& stage,
                                       cli::Session& session) {
  const auto ready = [&](render::Renderer renderer) {
    renderer.set_effort(effort_of(options, request, session));
    if (stage.rays) renderer.set_rays(*stage.rays);
    return Result<render::Renderer>(std::move(renderer));
  };
  if (stage.gbuffer) return ready(render::Renderer::shading(stage.gbuffer));
  if (request.traces()) return ready(render::Renderer::tracing(stage.scene.ground));
  if (request.engine == nullptr || !request.engine->needs_opengl) return ready(render::Renderer::tracing());
  GONIO_ASSIGN(render::Renderer renderer,
               render::Renderer::create(options.gpu ? render::OpenGlBy::kGpu : render::OpenGlBy::kSoftware));
  return ready(std::move(renderer));
}

void Exposure::meter(double white_luminance, const Request& request) {
  is_metered = white_luminance > 0;
  automatic = is_metered ? -std::log2(white_luminance) : 0;
  stops = request.stops_by(automatic);
}

Exposure begin_sight(const render::Renderer& renderer, const render::Gbuffer& seen, const Stage& stage,
                     Request& request, cli::Session& session) {
  tell_visibility(seen, stage.mesh, session);
  const std::string device = renderer.opengl(), library = renderer.opengl_library();
  session.results()["opengl"] = device.empty() ? Json(nullptr) : Json(device);
  session.results()["opengl_library"] = library.empty() ? Json(nullptr) : Json(library);
  if (!device.empty()) session.explain(fmt::format("OpenGL: {}, by {}\n", device, library));
  const render::Scene& scene = stage.scene;
  Exposure exposure{render::diffuse_white(scene.env, scene.lights)};
  request.plan.white_luminance = exposure.white.luminance;
  request.plan.tolerance_de00 = session.common().tolerance;
  const Vec3 to_camera = -seen.rays.direction(0.5 * seen.width, 0.5 * seen.height);
  exposure.meter(render::metered_white(scene.env, scene.lights, to_camera), request);
  return exposure;
}

double white_by_gray(const render::Frame& frame) {
  double sum = 0;
  std::size_t count = 0;
  for_seen(*frame.gbuffer, [&](int x, int y, int) {
    sum += color::luminance(vec3(frame.picture.pixel(x, y))) / color::luminance({1, 1, 1});
    ++count;
  });
  constexpr double kMiddleGray = 0.18;
  return count > 0 ? sum / static_cast<double>(count) / kMiddleGray : 0;
}

void report_pictures(const render::Plan& plan, const Exposure& exposure, std::size_t count, double gbuffer_ms,
                     double frame_ms, cli::Session& session) {
  Json& results = session.results();
  results["engine"] = plan.engine, results["engine_reason"] = plan.engine_reason;
  results["gbuffer_ms"] = gbuffer_ms, results["frame_ms"] = frame_ms, results["frames"] = count;
  results["exposure_stops"] = exposure.stops, results["white_luminance"] = json_number(exposure.white.luminance);
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

}  // namespace goniochrome::tool
