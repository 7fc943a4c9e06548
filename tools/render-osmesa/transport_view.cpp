#include "transport_view.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
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
  for_seen(seen, [&](int x, int y, int part) {
    if (!worn.is_projected(part)) all.push_back(seen.point(x, y));
  });
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
                                    {"shown_noise_de00_p95", json_number(traced.error_p95_de00)},
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
                  traced.transport.places.size(), traced.transport.columns.count(), traced.error_p95_de00,
                  traced.noise_p95_de00, traced.samples_mean, traced.time_s, per_point, file.float_parts));
  if (!traced.reached)
    session.warn(fmt::format("the error of the transport is {:.2f} dE00, above --tolerance {}: {}",
                             traced.error_p95_de00, shortest(session.common().tolerance),
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

// The background around the mesh of a sample whose rows begin at `top`.
void put_background(const render::Gbuffer& gbuffer, const render::Scene& scene, int top, image::Image& picture) {
  if (scene.background == render::Background::kNone) return;
  render::for_pixels(gbuffer.width, gbuffer.height, [&](int x, int y) {
    if (gbuffer.part(x, y) >= 0) return;
    const Vec3 color = scene.background == render::Background::kColor
                           ? scene.background_color
                           : envmap::bilinear(scene.env->mirror.map, -gbuffer.to_viewer(x, y));
    float* pixel = picture.pixel(x, top + y);
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

Result<std::optional<KeptTransport>> kept_transport(std::optional<render::LobeTransport> points, image::AovFile file,
                                                    const Options& options, const Request& request,
                                                    cli::Session& session) {
  if (!points) return std::optional<KeptTransport>();
  if ((!options.env.empty() && options.env != file.environment) ||
      (!request.lights.empty() && !same_light(file.lights, request.lights))) {
    session.warn(
        fmt::format("{} holds the light of {} and {} lights, and the command line has other light: the "
                    "picture has no shadows: leave out --env and --light, or trace the transport again",
                    file.path, file.environment.empty() ? "no environment" : file.environment, file.lights.size()));
    return std::optional<KeptTransport>();
  }
  if (file.reflection.k != request.reflection.k && points->bounces > 0)
    return usage_error("--operator is another than that of --gbuffer: bounced light was traced with that one");
  file.image = {};
  return std::optional(KeptTransport{*std::move(points), std::move(file)});
}

namespace {

Result<render::ShownPaints> shown_in(const DressedMesh& dress, const mesh::Mesh& mesh,
                                     const render::LobeTransport& light) {
  std::vector<render::PartPaint> parts;
  for (std::size_t part = 0; part < dress.paints.size(); ++part)
    parts.push_back(
        {&dress.paints[part], dress.anisotropy[part], dress.gloss_deg[part], dress.names[part], mesh.parts[part].name});
  return render::shown_paints(light.columns, light.worn, parts);
}

}  // namespace

Result<void> read_light(const DressedMesh* dress, const mesh::Mesh& mesh, KeptTransport& transport) {
  std::vector<bool> wanted;
  if (dress != nullptr) {
    GONIO_ASSIGN(const render::ShownPaints shown, shown_in(*dress, mesh, transport.light));
    wanted = render::weighed_columns(shown);
  }
  GONIO_TRY(render::read_light(transport.file, wanted, transport.light));
  transport.file.layer = {};
  return {};
}

ViewShader::ViewShader(const render::LobeTransport& light, std::vector<const render::Gbuffer*> samples,
                       const render::Scene& scene)
    : light_(light),
      samples_(std::move(samples)),
      scene_(scene),
      shader_(light, render::view_angles_deg(light, samples_)),
      load_ms_(1000 * laying_.elapsed_s()),
      scaler_(light, render::operator_or_null(scene.reflection)) {}

Result<ShadedPaint> ViewShader::shade(const DressedMesh& dress, image::Image& picture) {
  GONIO_ASSIGN(const render::ShownPaints shown, shown_in(dress, *scene_.mesh, light_));
  ShadedPaint result;
  result.coat_changed = shown.coat_changed;
  const Stopwatch judging;
  const render::BounceScale scale = scaler_.scale(shown.weights);
  result.scale_ms = 1000 * judging.elapsed_s();
  result.scaled = scale.changed, result.bounced_de00_p95 = scale.error_p95_de00;
  const std::size_t floats = 4 * static_cast<std::size_t>(light_.width) * static_cast<std::size_t>(light_.height);
  if (picture.data.size() != floats) {  // else it has the background, and shading changes all other pixels
    picture = image::even_image(light_.width, light_.height, 4, {"R", "G", "B", "A"});
    int top = 0;
    for (const render::Gbuffer* sample : samples_)
      put_background(*sample, scene_, std::exchange(top, top + sample->height), picture);
  }
  const Stopwatch shading;
  shader_.shade(shown.paints, render::operator_or_null(scene_.reflection), scale, 1, picture);
  result.frame_ms = 1000 * shading.elapsed_s();
  return result;
}

Json ViewShader::figures(const ShadedPaint& shaded, double tolerance) const {
  const std::size_t points = light_.places.size();
  return {{"points", points},
          {"columns", light_.columns.count()},
          {"bytes_per_point", static_cast<double>(shader_.bytes()) / std::max<double>(1, static_cast<double>(points))},
          {"load_ms", load_ms_},
          {"scale_ms", shaded.scale_ms},
          {"bounced_de00_p95", json_number(shaded.bounced_de00_p95)},
          {"trace_again", shaded.bounced_de00_p95 > tolerance}};
}

}  // namespace goniochrome::tool
