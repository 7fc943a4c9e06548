#include "render/integral/integral_engine.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "render/exact.h"

namespace goniochrome::render {

namespace {

// Points that are summed together: enough that no thread waits, few enough to hold.
constexpr std::size_t kTogether = 1 << 14;

// Points that a frame is timed by, and how long that may take.
constexpr std::size_t kTimed = 256;
constexpr double kEnough_s = 0.05;

std::vector<color::Rgb> integrals(const std::vector<VisiblePoint>& points, const Scene& scene, const Effects& effects) {
  if (scene.texels == nullptr) return exact_radiance(points, scene, effects, nullptr);
  return exact_radiance(points, scene, effects, Surroundings(*scene.texels, spread_for(effects.tolerance_de00)));
}

// At most `count` of the points, evenly spread.
std::vector<VisiblePoint> thinned(const std::vector<VisiblePoint>& points, std::size_t count) {
  std::vector<VisiblePoint> few;
  const std::size_t step = std::max<std::size_t>(1, points.size() / count);
  for (std::size_t i = 0; i < points.size(); i += step) few.push_back(points[i]);
  return few;
}

// Seconds that one of these points takes on all cores together.
double seconds_per_point(const std::vector<VisiblePoint>& points, const Scene& scene, const Effects& effects) {
  if (points.empty()) return 0;
  const Stopwatch clock;
  std::size_t done = 0;
  for (std::size_t few = 32; done < points.size() && clock.elapsed_s() < kEnough_s; few *= 2) {
    const std::size_t end = std::min(points.size(), done + few);
    integrals({points.begin() + static_cast<std::ptrdiff_t>(done), points.begin() + static_cast<std::ptrdiff_t>(end)},
              scene, effects);
    done = end;
  }
  return clock.elapsed_s() / static_cast<double>(done);
}

}  // namespace

const EngineInfo IntegralEngine::kInfo = {
    .name = "integral",
    .sentence = "sums the image that the environment was made from at every visible point, without prefiltered maps",
    .where = "by the integral",
    .is_planned = false,
    .needs_texels = true,
    .traces_rays = false,
    .needs_opengl = false,
    .needs_mesh = false,
    .draws_placed_lamps = false,
    .make = [](Sight&) -> std::unique_ptr<Engine> { return std::make_unique<IntegralEngine>(); }};

double spread_for(double tolerance_de00) {
  return std::clamp(0.8 * std::sqrt(tolerance_de00), 0.05, 1.0);
}

Result<void> IntegralEngine::can_shade(const Scene& scene) const {
  if (scene.env == nullptr || scene.texels != nullptr) return {};
  return usage_error("the engine integral sums the image that the environment was made from, which is not given");
}

Result<void> IntegralEngine::load(const Scene& scene, const Effects& effects) {
  scene_ = scene, effects_ = effects;
  Effects background;
  background.environment = effects.background == Background::kEnvironment;
  background.diffuse = false, background.background = effects.background;
  return behind_.load(scene, background);
}

void IntegralEngine::load_paints(const Scene& scene) {
  scene_ = scene;
  behind_.load_paints(scene);
}

Result<std::vector<color::Rgb>> IntegralEngine::shade(const std::vector<VisiblePoint>& points) const {
  return integrals(points, scene_, effects_);
}

Result<void> IntegralEngine::shade(Sight& sight, int sample, float gain, bool add, image::Image& rgba) {
  const std::shared_ptr<const Gbuffer> seen = sight.gbuffer(sample);
  behind_.shade(*seen, gain, add, rgba);
  const std::vector<TexturePlace>& places = sight.places(sample);
  std::vector<VisiblePoint> points;
  std::vector<float*> pixels;
  const auto flush = [&] {
    const std::vector<color::Rgb> colors = integrals(points, scene_, effects_);
    for (std::size_t i = 0; i < colors.size(); ++i) {
      for (int c = 0; c < 3; ++c) pixels[i][c] += gain * static_cast<float>(colors[i][c]);
    }
    points.clear(), pixels.clear();
  };
  for (int y = 0; y < seen->height; ++y) {
    for (int x = 0; x < seen->width; ++x) {
      if (seen->part(x, y) < 0) continue;
      points.push_back(seen->point(x, y, places));
      pixels.push_back(rgba.pixel(x, y));
      if (points.size() == kTogether) flush();
    }
  }
  flush();
  return {};
}

Price IntegralEngine::price(const Workload& work, const Effects& effects) const {
  return {.frame_ms = 1000 * seconds_per_point(thinned(*work.probe, kTimed), *work.scene, effects) * work.points};
}

}  // namespace goniochrome::render
