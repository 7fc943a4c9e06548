#include "transport_view.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/clock.h"
#include "base/parallel.h"
#include "base/text.h"
#include "envmap/cube_map.h"
#include "render/aov.h"
#include "render/effects.h"
#include "render/panes.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::tool {

namespace {

// How the open light of a transport was told.
struct OpenBySums {
  double maps_miss_de00 = 0;
  bool summed = false;
};

// Points of the mesh that are evenly spread over what is seen.
std::vector<render::VisiblePoint> seen_points(const render::Gbuffer& seen, const render::WornPaints& worn) {
  constexpr std::size_t kMost = 256;
  std::vector<render::VisiblePoint> all, few;
  for (int y = 0; y < seen.height; ++y)
    for (int x = 0; x < seen.width; ++x)
      if (seen.part(x, y) >= 0 && !worn.is_projected(seen.part(x, y))) all.push_back(seen.point(x, y));
  const std::size_t count = std::min(all.size(), kMost);
  for (std::size_t i = 0; i < count; ++i) few.push_back(all[(2 * i + 1) * all.size() / (2 * count)]);
  return few;
}

// Noise has the tolerance for itself: half of it passes for what the maps err by, else the wide lobes are summed,
// within kFine however large the tolerance is, since coarser sums take hardly less time and tell nothing of the maps.
OpenBySums sum_where_maps_miss(const envmap::BlockTree& tree, const render::LobeColumns& columns,
                               const std::vector<render::VisiblePoint>& points, double white_luminance,
                               double tolerance_de00, render::OpenLight& open) {
  constexpr double kFine = 0.25;
  const double most = 0.5 * tolerance_de00;
  render::OpenLight summed = open;
  summed.sum(tree, std::min(most, kFine));
  OpenBySums result{render::open_difference_de00(open, summed, columns, points, white_luminance)};
  result.summed = result.maps_miss_de00 > most;
  if (result.summed) open = std::move(summed);
  return result;
}

void report_traced(const render::TracedLobes& traced, const render::TransportParts& file,
                   const std::optional<OpenBySums>& open, cli::Session& session) {
  const double per_point = file.bytes_per_point;
  session.results()["transport"] = {{"points", traced.transport.places.size()},
                                    {"columns", traced.transport.columns.count()},
                                    {"noise_de00_p95", json_number(traced.noise_p95_de00)},
                                    {"noise_de00_mean", json_number(traced.noise_mean_de00)},
                                    {"shown_noise_de00_p95", json_number(traced.shown_p95_de00)},
                                    {"samples_mean", traced.samples_mean},
                                    {"open_share", traced.free_share},
                                    {"trace_s", traced.time_s},
                                    {"bytes_per_point", per_point},
                                    {"float_parts", file.float_parts},
                                    {"half_error_de00", json_number(file.half_error_de00)},
                                    {"reached", traced.reached}};
  if (open) {
    session.results()["transport"]["maps_miss_de00"] = json_number(open->maps_miss_de00);
    session.results()["transport"]["summed"] = open->summed;
    if (open->summed)
      session.say(fmt::format(
          "transport: maps miss {:.2f} dE00 of the open light (p95 of the gray paint of each lobe), so that wide lobes "
          "are summed",
          open->maps_miss_de00));
  }
  session.say(
      fmt::format("transport: {} points by {} columns, errors dE00 {:.2f} (p95) in these paints, noise {:.2f} in "
                  "the worst gray paint of one lobe, after {:.0f} directions a point and {:.1f} s; {:.0f} bytes a "
                  "point, {} parts as floats",
                  traced.transport.places.size(), traced.transport.columns.count(), traced.shown_p95_de00,
                  traced.noise_p95_de00, traced.samples_mean, traced.time_s, per_point, file.float_parts));
  if (!traced.reached)
    session.warn(fmt::format("the error of the transport is {:.2f} dE00, above --tolerance {}: {}", traced.error_de00(),
                             shortest(session.common().tolerance),
                             session.common().time_limit_s > 0
                                 ? "give more --time-limit"
                                 : "some points have as many samples as one can have: give a larger --tolerance"));
}

bool same_light(const std::vector<image::AovLight>& kept, const std::vector<render::Light>& lights) {
  return std::ranges::equal(lights, kept, [](const render::Light& a, const image::AovLight& b) {
    return length(a.direction - b.direction) < 1e-9 && a.white == b.white &&
           std::abs(a.radius_rad - render::light_of(b).radius_rad) < 1e-9 && a.place.has_value() == b.is_placed;
  });
}

// The background around the mesh.
void put_background(const render::Gbuffer& gbuffer, const render::Scene& scene, image::Image& picture) {
  if (scene.background == render::Background::kNone) return;
  render::for_pixels(picture.width, picture.height, [&](int x, int y) {
    if (gbuffer.part(x, y) >= 0) return;
    const Vec3 color = scene.background == render::Background::kColor
                           ? scene.background_color
                           : envmap::bilinear(scene.env->mirror.map, -gbuffer.to_viewer(x, y));
    float* pixel = picture.pixel(x, y);
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(color[c]);
    pixel[3] = 1;
  });
}

}  // namespace

Result<void> can_trace_view(const render::Scene& scene) {
  if (scene.layer != nullptr && scene.layer->textured())
    return usage_error("--aov transport holds light by the lobes of paints: leave out --texture");
  if (render::has_panes(scene))
    return usage_error("--aov transport holds the light of one surface a pixel: leave glass out of --part");
  render::PathScene path;
  path.scene = &scene, path.emission = scene.emission, path.ground = scene.ground;
  GONIO_ASSIGN(const render::LobeColumns columns, render::lobe_columns(scene));
  const auto worn = render::worn_paints(columns, path);
  if (!worn.ok()) return worn.error();
  return {};
}

Result<TracedView> traced_view(const render::Scene& scene, const envmap::Environment* environment, bool with_maps,
                               const render::Gbuffer& seen, int samples, double white_luminance, int bounces,
                               cli::Session& session) {
  render::PathScene path;
  path.scene = &scene, path.environment = environment;
  path.emission = scene.emission, path.ground = scene.ground;
  GONIO_ASSIGN(const render::LobeColumns columns, render::lobe_columns(scene));
  GONIO_ASSIGN(const render::WornPaints worn, render::worn_paints(columns, path));
  GONIO_ASSIGN(render::Transport transport, render::Transport::create(path));
  if (transport.emitters().empty())
    transport.shade_ground(
        render::ground_request(session.common().tolerance, session.common().seed, session.common().time_limit_s),
        bounces);
  std::optional<render::OpenLight> open;
  if (scene.env != nullptr && with_maps) {
    render::Scene unlit = scene;
    unlit.lights.clear();
    GONIO_ASSIGN(open, render::OpenLight::create(unlit, columns, worn.coats));
  }
  render::Gbuffer surface = render::visible_surface(transport.rays(), seen.rays, seen.width, seen.height);
  std::optional<envmap::BlockTree> tree;
  std::optional<OpenBySums> sums;
  if (open && environment != nullptr) {
    tree.emplace(*environment);
    sums = sum_where_maps_miss(*tree, columns, seen_points(surface, worn), white_luminance, session.common().tolerance,
                               *open);
  }
  render::LobeTransportRequest request;
  request.tolerance_de00 = session.common().tolerance;
  request.white_luminance = white_luminance > 0 ? white_luminance : 1;
  request.seed = session.common().seed;
  request.bounces = bounces;
  request.pixel_samples = samples;
  request.time_limit_s = session.common().time_limit_s;
  request.progress = [&](double error, double seconds) {
    session.progress(fmt::format("transport: error {:.2f} dE00 after {:.1f} s", error, seconds));
  };
  const render::TracedLobes traced =
      render::traced_lobes(transport, surface, columns, worn, open ? &*open : nullptr, request);
  TracedView view{std::make_shared<const render::Gbuffer>(std::move(surface)),
                  render::transport_parts(traced.transport), traced.reached};
  report_traced(traced, view.file, sums, session);
  return view;
}

Result<std::optional<KeptTransport>> kept_transport(image::AovFile file, const Options& options,
                                                    const std::vector<render::Light>& lights, cli::Session& session) {
  GONIO_ASSIGN(auto light, render::transport_of(file));
  if (!light) return std::optional<KeptTransport>();
  if ((!options.env.empty() && options.env != file.environment) ||
      (!lights.empty() && !same_light(file.lights, lights))) {
    session.warn(
        fmt::format("{} holds the light of {} and {} lights, and the command line has other light: the "
                    "picture has no shadows: leave out --env and --light, or trace the transport again",
                    file.path, file.environment.empty() ? "no environment" : file.environment, file.lights.size()));
    return std::optional<KeptTransport>();
  }
  file.image = {}, file.layers.clear();
  return std::optional(KeptTransport{*std::move(light), std::move(file)});
}

ViewShader::ViewShader(const KeptTransport& kept, const render::Gbuffer& gbuffer, const render::Scene& scene)
    : kept_(kept), gbuffer_(gbuffer), scene_(scene), scaler_(kept.light, render::operator_or_null(scene.reflection)) {}

// Lays the light out, once, and once more where a paint comes that changes with the view.
void ViewShader::lay_out(bool with_views) {
  if (shader_ && (with_views_ || !with_views)) return;
  const Stopwatch laying;
  with_views_ = with_views;
  shader_ = std::make_unique<render::TransportShader>(
      kept_.light, with_views ? render::view_angles_deg(kept_.light, {&gbuffer_}) : std::vector<float>());
  load_ms_ = 1000 * laying.elapsed_s();
}

Result<ShadedPaint> ViewShader::shade(const DressedMesh& dress, image::Image& picture) {
  const render::LobeTransport& light = kept_.light;
  std::vector<render::PartPaint> parts;
  for (std::size_t part = 0; part < dress.paints.size(); ++part)
    parts.push_back({&dress.paints[part], dress.anisotropy[part], dress.gloss_deg[part], dress.names[part],
                     scene_.mesh->parts[part].name});
  GONIO_ASSIGN(const render::ShownPaints shown, render::shown_paints(light.columns, light.worn, parts));
  ShadedPaint result;
  result.coat_changed = shown.coat_changed;
  if (kept_.file.reflection.k != scene_.reflection.k && light.bounces > 0)
    return usage_error("--operator is another than that of --gbuffer: bounced light was traced with that one");
  const color::ReflectionOperator* reflection = render::operator_or_null(scene_.reflection);
  lay_out(shown.with_views);
  const Stopwatch judging;
  const render::BounceScale scale = scaler_.scale(shown.weights);
  result.scale_ms = 1000 * judging.elapsed_s();
  result.scaled = scale.changed, result.bounced_de00_p95 = scale.error_p95_de00;
  const std::size_t floats = 4 * static_cast<std::size_t>(gbuffer_.width) * static_cast<std::size_t>(gbuffer_.height);
  if (picture.data.size() != floats) {  // else it has the background, and shading changes all other pixels
    picture = {gbuffer_.width, gbuffer_.height, 4, {}, {"R", "G", "B", "A"}};
    picture.data.assign(floats, 0);
    put_background(gbuffer_, scene_, picture);
  }
  const Stopwatch shading;
  shader_->shade(shown.paints, reflection, scale, 1, picture);
  result.frame_ms = 1000 * shading.elapsed_s();
  return result;
}

Json ViewShader::figures(const ShadedPaint& shaded, double tolerance) const {
  const double points = static_cast<double>(kept_.light.places.size());
  return {{"points", kept_.light.places.size()},
          {"columns", kept_.light.columns.count()},
          {"bytes_per_point", static_cast<double>(shader_->bytes()) / std::max<double>(1, points)},
          {"load_ms", load_ms_},
          {"scale_ms", shaded.scale_ms},
          {"bounced_de00_p95", json_number(shaded.bounced_de00_p95)},
          {"trace_again", shaded.bounced_de00_p95 > tolerance}};
}

void tell_coat(cli::Session& session) {
  session.warn(
      "a paint has a coat and took the place of one without it, or the other way round: toward grazing the picture "
      "is that of the paint whose light was traced");
}

Result<ShadedPaint> shaded_view(const KeptTransport& kept, const render::Gbuffer& gbuffer, const DressedMesh& dress,
                                const render::Scene& scene, image::Image& picture, cli::Session& session) {
  ViewShader shader(kept, gbuffer, scene);
  GONIO_ASSIGN(const ShadedPaint shaded, shader.shade(dress, picture));
  if (shaded.coat_changed) tell_coat(session);
  const double tolerance = session.common().tolerance;
  session.results()["transport"] = shader.figures(shaded, tolerance);
  if (!shaded.scaled) {
    session.say("bounced light is that of these paints");
  } else if (shaded.bounced_de00_p95 <= tolerance) {
    session.say(fmt::format("bounced light was traced in other paints and scaled to these: off by {:.2f} dE00 (p95)",
                            shaded.bounced_de00_p95));
  } else {
    session.warn(fmt::format(
        "bounced light was traced in other paints; scaled to these it is off by {:.2f} dE00 (p95), above --tolerance "
        "{}: trace again with --aov transport in these paints",
        shaded.bounced_de00_p95, tolerance));
  }
  return shaded;
}

}  // namespace goniochrome::tool
