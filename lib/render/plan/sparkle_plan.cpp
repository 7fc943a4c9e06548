#include "render/plan/sparkle_plan.h"

#include <algorithm>
#include <cmath>

#include "base/text.h"
#include "math/statistics.h"
#include "mesh/unit.h"
#include "render/internal/seen.h"
#include "render/internal/sparkle.h"

namespace goniochrome::render {

namespace {

// The truth is measured at so many pixels to each side.
constexpr int kAround = 3;

constexpr const char* kNoFlakes = "no visible paint has flakes";

bool has_flakes(const Scene& scene) {
  return std::ranges::any_of(scene.flakes, [](const auto& flakes) { return flakes.has_value(); });
}

// The distance at which the deviation, which is as one part in the distance, has the size of the tolerance.
std::string seen_from(const Scene& scene, const std::vector<ProbePixel>& pixels, double part) {
  std::vector<double> distances;
  for (const ProbePixel& pixel : pixels)
    distances.push_back(
        length(mesh_point(*scene.mesh, *pixel.gbuffer, pixel.x, pixel.y).position - pixel.gbuffer->rays.eye));
  const double distance_m = mesh::length_unit(*scene.mesh).meters * math::median(std::move(distances));
  return fmt::format("seen up to some {:.2g} m away, and this is {:.2g} m", part * distance_m, distance_m);
}

}  // namespace

PlanItem sparkle_left_out(const Scene& scene, const char* engine) {
  if (!has_flakes(scene)) return unmeasured(kSparkleName, kNoFlakes);
  return unmeasured(
      kSparkleName,
      fmt::format("the engine {} draws the mean of all flakes; engines with prefiltered maps draw them", engine), true);
}

PlanItem sparkle_item(const Scene& scene, const std::vector<ProbePixel>& pixels, const PlanRequest& request,
                      Effects& effects) {
  if (!has_flakes(scene)) return unmeasured(kSparkleName, kNoFlakes);
  const std::optional<bool> forced = request.effects.forced_on(kSparkleName);
  // Flakes that nobody stated change no picture unasked, and cost nothing.
  if (!forced && std::ranges::none_of(scene.flakes, [](const auto& one) { return one && !one->assumed; }))
    return unmeasured(kSparkleName,
                      "flakes (assumed by class): no paint states its own, and +sparkle draws those assumed", true);
  const bool places = !pixels.empty() && std::ranges::none_of(pixels, [](const ProbePixel& pixel) {
    return pixel.gbuffer->triangles.empty();
  });
  if (scene.mesh == nullptr || scene.mesh->positions.empty() || !places)
    return unmeasured(kSparkleName, "buffers without their mesh: flakes have no places");
  const Sparkle sparkle(scene, effects);
  if (!sparkle.absent().empty()) return unmeasured(kSparkleName, sparkle.absent());
  std::vector<double> de00;
  for (const ProbePixel& pixel : pixels)
    de00.push_back(seen_difference(pixel.shown,
                                   pixel.shown + sparkle.deviation(*pixel.gbuffer, pixel.x, pixel.y, pixel.shown),
                                   request.white_luminance));
  const double change = percentile_95(std::move(de00));
  PlanItem item = unmeasured(
      kSparkleName, fmt::format("{}; {}", sparkle.reason(), seen_from(scene, pixels, change / request.tolerance_de00)),
      true);
  item.de00_p95 = change;
  const bool wanted = request.effects.start == Start::kAll ||
                      (request.effects.start == Start::kAuto && item.de00_p95 > request.tolerance_de00);
  item.on = effects.sparkle = forced.value_or(wanted);
  item.decision = decision_of(true, item.on, forced.has_value());
  return item;
}

double sparkle_truth(const Scene& scene, const Effects& effects, const std::vector<ProbePixel>& pixels,
                     double white_luminance) {
  const Sparkle sparkle(scene, effects);
  if (!sparkle.absent().empty()) return 0;
  std::vector<double> de00;
  for (const ProbePixel& pixel : pixels) {
    const Gbuffer& seen = *pixel.gbuffer;
    const int left = std::max(0, pixel.x - kAround), right = std::min(seen.width - 1, pixel.x + kAround),
              top = std::max(0, pixel.y - kAround), bottom = std::min(seen.height - 1, pixel.y + kAround);
    image::Image picture = image::even_image(seen.width, seen.height, 4, {"R", "G", "B", "A"});
    const auto visit = [&](const auto& at) {
      for (int y = top; y <= bottom; ++y)
        for (int x = left; x <= right; ++x)
          if (seen.part(x, y) == seen.part(pixel.x, pixel.y)) at(picture.pixel(x, y));
    };
    visit([&](float* rgba) {
      for (int c = 0; c < 3; ++c) rgba[c] = static_cast<float>(pixel.shown[c]);
      rgba[3] = 1;
    });
    sparkle.add(seen, nullptr, picture);
    double squares = 0, count = 0;
    visit([&](const float* rgba) {
      squares += std::pow(seen_difference(pixel.shown, {rgba[0], rgba[1], rgba[2]}, white_luminance), 2);
      ++count;
    });
    de00.push_back(std::sqrt(squares / count));
  }
  return percentile_95(std::move(de00));
}

}  // namespace goniochrome::render
