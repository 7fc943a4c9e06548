#include "render/path/ray_correction.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "render/internal/seen.h"
#include "render/path/ray_points.h"

namespace goniochrome::render {

namespace {

constexpr std::size_t kCorrectedRowsAtOnce = 8;
// The part of the tolerance that the effects may make up which the first pass shows to change so little.
constexpr double kStopShare = 0.35;

}  // namespace

int corrected_together(int width, int height) {
  constexpr double kMostBytes = 4e8, kBytesOfPixel = sizeof(rays::Hit) + 4 * sizeof(float) + sizeof(std::uint32_t);
  return std::clamp(static_cast<int>(kMostBytes / (kBytesOfPixel * width * height)), 4, 16);
}

VisibleSurface drawn_surface(const mesh::Mesh& mesh, const Gbuffer& gbuffer) {
  VisibleSurface surface;
  surface.gbuffer = gbuffer;
  surface.hits.resize(static_cast<std::size_t>(gbuffer.width) * static_cast<std::size_t>(gbuffer.height));
  parallel_for(static_cast<std::size_t>(gbuffer.height), kCorrectedRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < gbuffer.width; ++x) {
        if (gbuffer.part(x, y) < 0) continue;
        const MeshPoint at = mesh_point(mesh, gbuffer, x, y);
        surface.hits[gbuffer.index(x, y)] = {at.triangle, static_cast<float>(at.shares[1]),
                                             static_cast<float>(at.shares[2]), 0};
      }
    }
  });
  return surface;
}

color::Rgb Backdrop::at(const rays::Float3& direction) const {
  if (background == Background::kColor) return color;
  if (background == Background::kNone || environment == nullptr) return {};
  return environment->blended(rays::vec3(direction));
}

double floor_change(const Transport& transport, const Gbuffer& gbuffer, const Backdrop& backdrop,
                    const RayEffects& effects, double white_luminance) {
  constexpr std::size_t kPoints = 1024;
  std::vector<double> de00;
  for (const RayPoint& point : floor_points(transport.rays(), gbuffer, kPoints))
    de00.push_back(seen_difference(transport.shaded_ground(point.spot).shown(effects), backdrop.at(-point.to_viewer),
                                   white_luminance > 0 ? white_luminance : 1));
  return percentile_95(std::move(de00));
}

namespace {

// A pixel beside which the light changes by more than this part shows an edge, such as that of a shadow on the floor.
constexpr float kSmoothStep = 1.0F / 32;

// Calls visit(pixel, light) for each pixel of a sample that shows no mesh but a floor or a background, if it is wanted.
template <class Wanted, class Visit>
void visit_surroundings(const Transport& transport, const Gbuffer& g, const Backdrop& backdrop,
                        const RayEffects& effects, const Wanted& wanted, const Visit& visit) {
  const rays::RayScene& scene = transport.rays();
  const rays::Float3 eye = scene.local(g.rays.eye);
  parallel_for(static_cast<std::size_t>(g.height), kCorrectedRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < g.width; ++x) {
        if (g.part(x, y) >= 0 || !wanted(g.index(x, y))) continue;
        const rays::Float3 direction = -rays::float3(g.to_viewer(x, y));
        const rays::Hit hit = floor_hit(scene, eye, direction);
        if (!hit.any() && backdrop.background == Background::kNone) continue;
        visit(g.index(x, y), hit.any() ? transport.shaded_ground(scene.spot(hit, eye, direction)).shown(effects)
                                       : backdrop.at(direction));
      }
    }
  });
}

void add_light(const color::Rgb& light, float gain, std::size_t at, image::Image& picture) {
  float* pixel = &picture.data[at * static_cast<std::size_t>(picture.channels)];
  if (picture.channels > 3) pixel[3] += gain;
  for (int c = 0; c < 3; ++c) pixel[c] += gain * static_cast<float>(light[c]);
}

bool is_smooth(const std::vector<rays::Float3>& light, const std::vector<bool>& open, int width, int height, int x,
               int y) {
  const auto at = [&](int to_x, int to_y) {
    return static_cast<std::size_t>(to_y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(to_x);
  };
  const std::size_t own = at(x, y);
  const auto beside = [&](int to_x, int to_y) {
    if (to_x < 0 || to_y < 0 || to_x >= width || to_y >= height) return true;
    const std::size_t other = at(to_x, to_y);
    if (!open[other]) return false;
    const rays::Float3 &a = light[own], &b = light[other];
    const auto near = [](float p, float q) { return std::abs(p - q) <= kSmoothStep * std::max(p, q); };
    return near(a.x, b.x) && near(a.y, b.y) && near(a.z, b.z);
  };
  return open[own] && beside(x - 1, y) && beside(x + 1, y) && beside(x, y - 1) && beside(x, y + 1);
}

}  // namespace

void CorrectionNoise::add(const PathPicture& one, int groups) {
  const double of_mean = 1 / (std::sqrt(groups) * groups);
  de00_p95 += of_mean * one.noise_p95_de00, error_de00_p95 += of_mean * one.error_p95_de00;
  free_share += one.free_share / groups;
  samples += one.samples_mean, ms += 1000 * one.time_s;
  reached = reached && one.reached, dark = dark && one.dark;
}

std::vector<const Gbuffer*> gbuffers_of(const std::vector<VisibleSurface>& samples) {
  std::vector<const Gbuffer*> gbuffers;
  for (const VisibleSurface& sample : samples) gbuffers.push_back(&sample.gbuffer);
  return gbuffers;
}

void add_surroundings(const Transport& transport, const std::vector<const Gbuffer*>& samples, const Backdrop& backdrop,
                      const RayEffects& effects, float gain, image::Image& picture) {
  const Gbuffer& first = *samples.front();
  const std::size_t pixels = first.data.size() / 4;
  std::vector<rays::Float3> light(pixels);
  std::vector<std::uint8_t> shown(pixels, 0);
  visit_surroundings(
      transport, first, backdrop, effects, [](std::size_t) { return true; },
      [&](std::size_t at, const color::Rgb& seen) { light[at] = rays::float3(seen), shown[at] = 1; });
  std::vector<bool> open(pixels, true);
  for (const Gbuffer* sample : samples)
    for (std::size_t i = 0; i < pixels; ++i)
      if (sample->data[4 * i + 3] != 0) open[i] = false;
  std::vector<std::uint8_t> smooth(pixels, 0);
  parallel_for(static_cast<std::size_t>(first.height), kCorrectedRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < first.width; ++x) {
        const std::size_t at = first.index(x, y);
        smooth[at] = is_smooth(light, open, first.width, first.height, x, y) ? 1 : 0;
        if (shown[at] != 0)
          add_light(rays::vec3(light[at]), smooth[at] != 0 ? gain * static_cast<float>(samples.size()) : gain, at,
                    picture);
      }
    }
  });
  for (std::size_t sample = 1; sample < samples.size(); ++sample)
    visit_surroundings(
        transport, *samples[sample], backdrop, effects, [&](std::size_t at) { return smooth[at] == 0; },
        [&](std::size_t at, const color::Rgb& seen) { add_light(seen, gain, at, picture); });
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

PathPicture add_correction(const Transport& transport, const std::vector<VisibleSurface>& samples,
                           const PathRequest& request, const image::Image& before, float gain, image::Image& picture) {
  PathPicture drawn = path_picture(transport, samples, &before, request);
  for (const PathPoint& point : drawn.points) {
    float* pixel =
        &picture.data[samples.front().gbuffer.index(point.x, point.y) * static_cast<std::size_t>(picture.channels)];
    for (int c = 0; c < 3; ++c) pixel[c] += gain * static_cast<float>(point.radiance[c]);
  }
  return drawn;
}

}  // namespace goniochrome::render
