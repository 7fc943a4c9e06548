#include "render/integral/integral_engine.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "render/exact.h"

namespace goniochrome::render {

namespace {

// Points that are summed together: enough that no thread waits, few enough to hold.
constexpr std::size_t kTogether = 1 << 14;

std::vector<color::Rgb> integrals(const std::vector<VisiblePoint>& points, const Scene& scene, const Effects& effects) {
  return exact_radiance(points, scene, effects,
                        scene.texels != nullptr ? Surroundings(*scene.texels, effects.spread) : Surroundings(nullptr));
}

}  // namespace

double spread_for(double tolerance_de00) {
  return std::clamp(0.55 * std::sqrt(tolerance_de00), 0.05, 1.0);
}

double integral_seconds_per_point(const std::vector<VisiblePoint>& points, const Scene& scene, const Effects& effects) {
  if (points.empty()) return 0;
  constexpr double kEnough_s = 0.05;
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

void add_integral(const Gbuffer& gbuffer, const std::vector<TexturePlace>& places, const Scene& scene,
                  const Effects& effects, float gain, image::Image& rgba) {
  std::vector<VisiblePoint> points;
  std::vector<float*> pixels;
  const auto flush = [&] {
    const std::vector<color::Rgb> colors = integrals(points, scene, effects);
    for (std::size_t i = 0; i < colors.size(); ++i) {
      for (int c = 0; c < 3; ++c) pixels[i][c] += gain * static_cast<float>(colors[i][c]);
    }
    points.clear(), pixels.clear();
  };
  for (int y = 0; y < gbuffer.height; ++y) {
    for (int x = 0; x < gbuffer.width; ++x) {
      if (gbuffer.part(x, y) < 0) continue;
      points.push_back({gbuffer.normal(x, y), gbuffer.to_viewer(x, y), gbuffer.part(x, y)});
      if (!places.empty()) {
        points.back().placed = true;
        points.back().place =
            places[static_cast<std::size_t>(y) * static_cast<std::size_t>(gbuffer.width) + static_cast<std::size_t>(x)];
      }
      pixels.push_back(rgba.pixel(x, y));
      if (points.size() == kTogether) flush();
    }
  }
  flush();
}

}  // namespace goniochrome::render
