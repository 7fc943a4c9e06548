#include "render/left_out.h"

#include <algorithm>
#include <limits>

#include "math/statistics.h"
#include "render/internal/seen.h"
#include "render/plan/effect_list.h"
#include "render/plan/ray_plan.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

namespace {

constexpr int kRounds = 2, kFrames = 2;  // the two take turns, so that a busy moment meets both
constexpr double kLong_ms = 500;         // slower frames are drawn once

Result<void> draw_fastest(Renderer& renderer, const View& view, Frame& frame, double& least_ms) {
  GONIO_TRY(renderer.draw(view, frame));  // shaders are compiled and maps touched by the first
  if (frame.frame_ms > kLong_ms) {
    least_ms = std::min(least_ms, frame.frame_ms);
    return {};
  }
  for (int i = 0; i < kFrames; ++i) {
    GONIO_TRY(renderer.draw(view, frame));
    least_ms = std::min(least_ms, frame.frame_ms);
  }
  return {};
}

void compare(const Frame& planned, const Frame& full, double white, LeftOut& result) {
  std::vector<double> de00;
  for_seen(*full.gbuffer, [&](int x, int y, int) {
    de00.push_back(seen_difference(vec3(planned.picture.pixel(x, y)), vec3(full.picture.pixel(x, y)), white));
  });
  if (de00.empty()) return;
  result.de00_mean = math::mean(de00), result.de00_max = std::ranges::max(de00);
  result.de00_p95 = percentile_95(std::move(de00));
}

}  // namespace

Result<LeftOut> left_out(Renderer& renderer, const Scene& scene, const Plan& plan, View view, double white_luminance) {
  view.samples = 1, view.with_centers = false;
  LeftOut result;
  result.planned_ms = result.full_ms = std::numeric_limits<double>::infinity();
  Effects drawn = plan.effects, all = effects_of(scene);
  drawn.rays = all.rays = {}, drawn.sums = false;
  const auto& by_rays = ray_effect_names();
  const bool whole = std::ranges::none_of(plan.items, [&](const PlanItem& item) {
    return item.needed && !item.on && item.effect != kSumsName &&
           std::ranges::find(by_rays, item.effect) == by_rays.end();
  });
  Frame planned, full;
  for (int round = 0; round < kRounds; ++round) {
    if (round > 0 && result.planned_ms > kLong_ms) break;
    if (!whole) {
      GONIO_TRY(renderer.load(scene, all, plan.engine));
      GONIO_TRY(draw_fastest(renderer, view, full, result.full_ms));
    }
    if (round == 0 || !whole) GONIO_TRY(renderer.load(scene, drawn, plan.engine));
    GONIO_TRY(draw_fastest(renderer, view, planned, result.planned_ms));
  }
  if (whole) result.full_ms = result.planned_ms;
  if (!whole) compare(planned, full, white_luminance, result);
  GONIO_TRY(renderer.load(scene, plan.effects, plan.engine));
  return result;
}

}  // namespace goniochrome::render
