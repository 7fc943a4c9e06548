#include "render/path/path_engine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/clock.h"
#include "base/parallel.h"
#include "render/panes.h"
#include "render/path/visible_white.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

namespace {

// The least time that a band has, whatever is left of the time limit.
constexpr double kLeastTime_s = 1e-3;
// The search for bright places takes up to 2 s. Within 5 s a room had the same error without it.
constexpr double kWorthSearch_s = 10;

}  // namespace

const EngineInfo PathEngine::kInfo = {
    .name = "path",
    .sentence = "follows light along rays, from surface to surface: shadows, floors and light that the mesh passes on",
    .needs_texels = true,
    .traces_rays = true,
    .needs_mesh = true,
    .draws_placed_lamps = true,
    .make = [](Sight& sight) -> std::unique_ptr<Engine> { return std::make_unique<PathEngine>(sight); }};

PathScene path_scene_of(const Scene& scene, std::shared_ptr<const rays::RayScene> rays) {
  PathScene path;
  path.scene = &scene;
  path.environment = scene.texels != nullptr ? &scene.texels->environment() : nullptr;
  path.emission = scene.emission;
  if (has_panes(scene)) path.eye = rays, rays = nullptr;
  path.ground = scene.ground;
  path.rays = std::move(rays);
  path.rough_coats = true;
  return path;
}

Result<void> PathEngine::can_shade(const Scene& scene) const {
  if (!sight_.shows_mesh() || scene.mesh == nullptr || scene.mesh->triangles.empty())
    return usage_error("the engine path traces rays through a mesh: a G-buffer that is given is shaded by cpu");
  if (scene.env != nullptr && scene.texels == nullptr)
    return usage_error(
        "the engine path traces rays to the image that the environment was made from, which is not given");
  if (scene.ground && scene.ground->kind == Ground::Kind::kShadow && scene.texels == nullptr)
    return usage_error("a floor that shows the ground of an environment needs an environment");
  return {};
}

Result<void> PathEngine::load(const Scene& scene, const Effects& effects) {
  scene_ = scene, effects_ = effects;
  white_luminance_ = diffuse_white(scene.env, scene.lights).luminance;
  transport_.reset(), aimed_.reset();
  PathScene path = path_scene_of(scene_, sight_.traced_mesh());
  path.tilt_tolerance = effects.tilt_tolerance;
  GONIO_ASSIGN(Transport transport, Transport::create(path));
  transport_.emplace(std::move(transport));
  return {};
}

std::vector<std::string> PathEngine::remarks() const {
  std::vector<std::string> all;
  if (!transport_) return all;
  constexpr int kMostNames = 6;
  std::string gaining;
  int named = 0;
  for (const int part : gaining_parts(scene_)) {
    const auto at = static_cast<std::size_t>(part);
    if (++named > kMostNames) continue;
    const bool floor = at >= scene_.mesh->parts.size();
    gaining += (gaining.empty() ? "" : ", ") + (floor ? "the floor" : scene_.mesh->parts[at].name);
  }
  if (named > kMostNames) gaining += fmt::format(", ... ({} in all)", named);
  if (!gaining.empty())
    all.push_back(
        fmt::format("the paint of {} sends back more light than it gets: between such surfaces light grows "
                    "with every bounce",
                    gaining));
  if (scene_.ground) {
    const mesh::Box box = bounding_box(*scene_.mesh);
    const double margin = 1e-6 * box.longest_side();
    if (scene_.ground->height > box.low.y + margin)
      all.push_back(
          fmt::format("the floor at height {:.6g} lies above the lowest point of the mesh, which is at {:.6g}: "
                      "what is below the floor is not seen",
                      scene_.ground->height, box.low.y));
  }
  return all;
}

void PathEngine::load_paints(const Scene& scene) {
  const Result<void> loaded = load(Scene(scene), effects_);
  failure_.reset();
  if (!loaded.ok()) failure_ = loaded.error();
}

// Behind everything: in each pixel the mean over its samples, that the scene then covers. Panes cover it in part.
void PathEngine::draw_background(const Rays& rays, int samples, image::Image& rgba) const {
  const auto shifts = sample_shifts(samples);
  const rays::Float3 eye = transport_->eye().local(rays.eye);
  const Backdrop backdrop{effects_.background, scene_.background_color,
                          scene_.texels != nullptr ? &scene_.texels->environment() : nullptr};
  for_pixels(rgba.width, rgba.height, [&](int x, int y) {
    color::Rgb sum;
    double clear = 0;
    for (const auto& [dx, dy] : shifts) {
      const Vec3 direction = rays.direction(x + 0.5 + dx, y + 0.5 + dy);
      const double share = transport_->clear_share(eye, rays::float3(direction));
      clear += share;
      if (share > 0) sum += share * backdrop.at(rays::float3(direction));
    }
    const auto count = static_cast<double>(shifts.size());
    float* pixel = rgba.pixel(x, y);
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<float>(sum[c] / count);
    pixel[3] = static_cast<float>(effects_.background == Background::kNone ? 1 - clear / count : 1);
  });
}

Result<void> PathEngine::shade(Sight& sight, int sample, float gain, bool add, image::Image& rgba) {
  if (failure_) return *failure_;
  if (add) return {};
  const int samples = sample == 0 ? 1 : static_cast<int>(std::lround(1 / gain));
  const std::shared_ptr<const Gbuffer> seen = sight.gbuffer(0);
  const Gbuffer g = visible_surface(transport_->eye(), seen->rays, seen->width, seen->height);
  const Effort effort = sight.effort();
  const Deadline deadline(effort.time_limit_s);
  if (const std::pair<int, std::uint64_t> wanted(effort.bounces, effort.seed);
      aimed_ != wanted && !(deadline.limit_s() > 0 && deadline.limit_s() < kWorthSearch_s))
    transport_->draw_toward(transport_->find_bright_places(effort.bounces, effort.seed)), aimed_ = wanted;
  PathRequest request;
  request.reconstruct = effort.smooth;
  request.options.bounces = effort.bounces;
  request.tolerance_de00 = effects_.tolerance_de00;
  request.seed = effort.seed;
  request.progress = effort.progress;
  request.white_luminance = white_luminance_;
  if (!(request.white_luminance > 0))
    request.white_luminance = visible_white(*transport_, g, effort.bounces, effort.seed);
  if (!(request.white_luminance > 0)) request.white_luminance = 1;
  request.pixel_samples = samples;
  rgba = image::even_image(g.width, g.height, 4);
  if (effects_.background != Background::kNone || has_panes(scene_)) draw_background(g.rays, samples, rgba);
  noise_ = Noise{.places_gain = transport_->bright_places() != nullptr ? transport_->bright_places()->gain() : 1,
                 .white_luminance = request.white_luminance,
                 .de00 = image::even_image(g.width, g.height, 1, {"error"})};
  CorrectionNoise drawn;
  for (const Band& band : effort.smooth ? bands_of(g, samples, true) : std::vector{whole_band(g.height)}) {
    if (deadline.limit_s() > 0)
      request.time_limit_s = std::max(kLeastTime_s, deadline.left_s()) / (band.count - band.number);
    if (drawn.points > 0) request.before = &drawn.drawn;
    draw_band(g, band, request, drawn, rgba);
  }
  std::vector<double> errors = std::move(drawn.drawn.mesh);
  errors.insert(errors.end(), drawn.drawn.floor.begin(), drawn.drawn.floor.end());
  noise_->de00_p95 = drawn.de00_p95;
  noise_->de00_mean = std::accumulate(errors.begin(), errors.end(), 0.0) / std::max<double>(1, errors.size());
  noise_->samples_mean = drawn.samples, noise_->time_s = 1e-3 * drawn.ms, noise_->reached = drawn.reached;
  return {};
}

void PathEngine::draw_band(const Gbuffer& whole, const Band& band, PathRequest request, CorrectionNoise& drawn,
                           image::Image& rgba) {
  const Gbuffer centers = rows_of(whole, band);
  std::vector<Gbuffer> surfaces;
  std::vector<const Gbuffer*> seen = {&centers};
  if (request.reconstruct && request.pixel_samples > 1) {
    surfaces = sampled_surface(transport_->eye(), centers, sample_shifts(request.pixel_samples)).samples;
    seen.clear();
    for (const Gbuffer& surface : surfaces) seen.push_back(&surface);
  }
  request.seed += static_cast<std::uint64_t>(band.first);
  request.first_points /= static_cast<std::size_t>(band.count);
  const PathPicture picture = path_picture(*transport_, seen, nullptr, request);
  drawn.add(picture, band.first_kept - band.first, band.last_kept - band.first);
  const bool covers = effects_.background == Background::kNone && !has_panes(scene_);
  for (const PathPoint& point : picture.points) {
    const int y = band.first + point.y;
    if (y < band.first_kept || y >= band.last_kept) continue;
    float* pixel = rgba.pixel(point.x, y);
    for (int c = 0; c < 3; ++c) pixel[c] += static_cast<float>(point.radiance[c]);
    if (covers) pixel[3] = point.coverage;
    *noise_->de00.pixel(point.x, y) = static_cast<float>(point.noise_de00);
  }
}

}  // namespace goniochrome::render
