#include "render/path/ray_correction.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "render/internal/seen.h"

namespace goniochrome::render {

namespace {

// The part of the tolerance that the effects may make up which the first pass shows to change so little.
constexpr double kStopShare = 0.35;

}  // namespace

color::Rgb Backdrop::at(const rays::Float3& direction) const {
  if (background == Background::kColor) return color;
  if (background == Background::kNone || environment == nullptr) return {};
  return environment->blended(rays::vec3(direction));
}

double MeshSurroundings::floor_change(const Gbuffer& gbuffer, double white_luminance) const {
  constexpr std::size_t kPoints = 1024;
  std::vector<double> de00;
  for (const RayPoint& point : floor_points(transport.rays(), gbuffer, kPoints))
    de00.push_back(seen_difference(transport.shaded_ground(point.spot).shown(effects), backdrop.at(-point.to_viewer),
                                   white_luminance));
  return percentile_95(std::move(de00));
}

void CorrectionNoise::add(const PathPicture& one, int first, int last) {
  const double before = points, added = static_cast<double>(one.points.size()), all = before + added;
  if (before == 0) dark = true, found = one.found;
  points = all, ms += 1000 * one.time_s;
  de00_p95 = one.noise_p95_de00, error_de00_p95 = one.error_p95_de00, reached = one.reached;
  dark = dark && one.dark;
  for (const PathPoint& point : one.points)
    if (point.y >= first && point.y < last) (point.floor ? drawn.floor : drawn.mesh).push_back(point.noise_de00);
  for (std::size_t i = 0; i < found.size(); ++i) {
    found[i].de00_p95 = std::max(found[i].de00_p95, one.found[i].de00_p95);
    found[i].stopped = found[i].stopped && one.found[i].stopped;
  }
  if (added == 0) return;
  const auto take_in = [&](double& mean, double value) { mean += added / all * (value - mean); };
  take_in(free_share, one.free_share), take_in(samples, one.samples_mean);
}

std::optional<color::Rgb> MeshSurroundings::at(const Gbuffer& g, int x, int y) const {
  if (g.part(x, y) >= 0) return std::nullopt;
  const rays::RayScene& scene = transport.rays();
  const rays::Float3 eye = scene.local(g.rays.eye), direction = -rays::float3(g.to_viewer(x, y));
  const rays::Hit hit = floor_hit(scene, eye, direction);
  if (hit.any()) return transport.shaded_ground(scene.spot(hit, eye, direction)).shown(effects);
  if (backdrop.background == Background::kNone) return std::nullopt;
  return backdrop.at(direction);
}

color::Rgb MeshSurroundings::mean(PixelSamples samples, int x, int y) const {
  color::Rgb sum;
  for (const Gbuffer* sample : samples) sum += at(*sample, x, y).value_or(color::Rgb{});
  return (1.0 / static_cast<double>(samples.size())) * sum;
}

void MeshSurroundings::add(PixelSamples samples, float gain, image::Image& picture) const {
  const Gbuffer& first = *samples.front();
  for_pixels(first.width, first.height, [&](int x, int y) {
    float* pixel = &picture.data[first.index(x, y) * static_cast<std::size_t>(picture.channels)];
    for (const Gbuffer* sample : samples) {
      if (!sample->wants(x, y)) return;
      const std::optional<color::Rgb> light = at(*sample, x, y);
      if (!light) continue;
      if (picture.channels > 3) pixel[3] += gain;
      for (int c = 0; c < 3; ++c) pixel[c] += gain * static_cast<float>((*light)[c]);
    }
  });
}

PathRequest correction_request(const RayEffects& effects, int bounces, double tolerance_de00) {
  PathRequest paths;
  paths.options.bounces = effects.self || effects.bounce ? bounces : 0;
  paths.options.into_lobes = effects.self;
  paths.options.into_diffuse = effects.bounce;
  paths.options.correction = true;
  paths.reconstruct = true;
  paths.tolerance_de00 = tolerance_de00, paths.stop_de00 = kStopShare * tolerance_de00;
  return paths;
}

PathPicture add_correction(const Transport& transport, PixelSamples samples, const PathRequest& request,
                           const image::Image& before, image::Image& picture) {
  PathPicture drawn = path_picture(transport, samples, &before, request);
  for (const PathPoint& point : drawn.points) {
    float* pixel = &picture.data[samples.front()->index(point.x, point.y) * static_cast<std::size_t>(picture.channels)];
    for (int c = 0; c < 3; ++c) pixel[c] += static_cast<float>(point.radiance[c]);
  }
  return drawn;
}

}  // namespace goniochrome::render
