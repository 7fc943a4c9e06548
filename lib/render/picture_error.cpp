#include "render/picture_error.h"

#include <algorithm>

#include "base/clock.h"
#include "render/exact.h"
#include "render/internal/seen.h"
#include "render/panes.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

// `count` of the n numbers 0..n-1, evenly drawn, in ascending order (Fisher-Yates on splitmix64).
std::vector<std::size_t> drawn(std::size_t n, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> all(n);
  for (std::size_t i = 0; i < n; ++i) all[i] = i;
  for (std::size_t i = 0; i < std::min(count, n); ++i) {
    std::uint64_t z = (seed += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    z ^= z >> 31;
    std::swap(all[i], all[i + z % (n - i)]);
  }
  all.resize(std::min(count, n));
  std::sort(all.begin(), all.end());
  return all;
}

}  // namespace

PixelSample sampled_pixels(const Gbuffer& g, const Scene& scene, int count, std::uint64_t seed) {
  std::vector<std::array<int, 2>> visible;
  for_seen(g, [&](int x, int y, int part) {
    if (!is_pane(scene, static_cast<std::size_t>(part))) visible.push_back({x, y});
  });
  std::vector<TexturePlace> places;
  if (scene.layer != nullptr) places = scene.layer->filtered_places(g);
  PixelSample sample{{}, {}, visible.size()};
  for (const std::size_t i : drawn(visible.size(), static_cast<std::size_t>(count), seed)) {
    const auto [x, y] = visible[i];
    sample.places.push_back(visible[i]);
    sample.points.push_back(g.point(x, y, places, scene.mesh));
  }
  return sample;
}

PictureError error_of(const PixelSample& sample, const std::vector<double>& de00) {
  PictureError error;
  error.checked_pixels = static_cast<int>(de00.size());
  error.visible_pixels = sample.visible;
  if (de00.empty()) return error;
  const auto worst = std::ranges::max_element(de00);
  const std::array<int, 2>& place = sample.places[static_cast<std::size_t>(worst - de00.begin())];
  error.worst_x = place[0], error.worst_y = place[1];
  error.de00_mean = math::mean(de00), error.de00_max = *worst;
  error.de00_p95 = percentile_95(de00);
  error.p95_range = math::percentile_95_range(de00, sample.visible);
  return error;
}

PictureError picture_error(const Frame& frame, const Scene& scene, const Surroundings& around, double white_luminance,
                           int count, std::uint64_t seed) {
  const Stopwatch clock;
  const PixelSample sample = sampled_pixels(*frame.gbuffer, scene, count, seed);
  const std::vector<color::Rgb> truth = exact_radiance(sample.points, scene, effects_of(scene), around);
  std::vector<double> de00;
  for (std::size_t i = 0; i < truth.size(); ++i)
    de00.push_back(seen_difference(vec3(sample.pixel(frame.centers, i)), truth[i], white_luminance));
  PictureError error = error_of(sample, de00);
  error.time_s = clock.elapsed_s();
  return error;
}

}  // namespace goniochrome::render
