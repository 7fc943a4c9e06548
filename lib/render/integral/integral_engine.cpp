#include "render/integral/integral_engine.h"

#include <algorithm>
#include <cmath>

#include "render/exact.h"

namespace goniochrome::render {

namespace {

// Points that are summed together: enough that no thread waits, few enough to hold.
constexpr std::size_t kTogether = 1 << 14;

std::vector<color::Rgb> integrals(const std::vector<VisiblePoint>& points, const Scene& scene, const Effects& effects) {
  if (scene.texels == nullptr) return exact_radiance(points, scene, effects, nullptr);
  return exact_radiance(points, scene, effects, Surroundings(*scene.texels, spread_for(effects.tolerance_de00)));
}

}  // namespace

const EngineInfo IntegralEngine::kInfo = {
    .name = "integral",
    .sentence = "sums the image that the environment was made from at every visible point, without prefiltered maps",
    .needs_texels = true,
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
  for_seen(*seen, [&](int x, int y, int) {
    points.push_back(seen->point(x, y, places));
    pixels.push_back(rgba.pixel(x, y));
    if (points.size() == kTogether) flush();
  });
  flush();
  return {};
}

}  // namespace goniochrome::render
