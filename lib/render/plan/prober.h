// The trial of effects on a sample of the visible points, by the engine cpu. goniochrome-theory(7), PLAN.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/clock.h"
#include "render/cpu/cpu_engine.h"
#include "render/internal/seen.h"
#include "render/plan/effect_list.h"
#include "render/plan/pane_probe.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

// Turns off what draws nothing without lobes, or without gloss.
inline void leave_out_idle(Effects& effects) {
  const auto used = [](const auto& use) { return use.directional_diffuse || use.gloss; };
  const bool lobes = std::ranges::any_of(effects.lobes, used);
  effects.fresnel = effects.fresnel && (effects.mirror || std::ranges::any_of(effects.lobes, &Effects::LobeUse::gloss));
  effects.horizon = effects.horizon && lobes;
  if (!effects.horizon) effects.spots = 0;
  effects.anisotropy = effects.anisotropy && lobes;
  effects.texture_filter = effects.texture_filter && effects.texture;
}

// Shades the probe with any choice of effects.
class Prober {
 public:
  // The first `shown` points are those of the picture; highlight_points() follow. `panes`, unless null, tells what is
  // behind the first of the points; the points behind them come last.
  Prober(const Scene& scene, const Effects& all, const std::vector<EffectSwitch>& switches,
         const std::vector<VisiblePoint>& points, const std::vector<VisiblePoint>& seen, std::size_t shown,
         double white, CpuEngine& engine, CpuEngine& component_wise, const PaneProbe* panes = nullptr)
      : shown_(shown),
        scene_(scene),
        all_(all),
        switches_(switches),
        points_(points),
        seen_(seen),
        white_(white > 0 ? white : 1),
        engine_(engine),
        component_wise_(component_wise),
        panes_(panes) {}

  Effects effects(const std::vector<bool>& on) const {
    Effects effects = all_;
    for (std::size_t i = 0; i < switches_.size(); ++i) {
      if (!on[i]) switches_[i].turn_off(effects);
    }
    leave_out_idle(effects);
    return effects;
  }

  std::vector<color::Rgb> colors(const std::vector<bool>& on) { return colors(effects(on)); }

  // The same without what is behind panes.
  std::vector<color::Rgb> front_colors(const std::vector<bool>& on) {
    Effects chosen = effects(on);
    chosen.panes = false;
    return colors(chosen);
  }

  double difference(const std::vector<color::Rgb>& a, const std::vector<color::Rgb>& b) const {
    std::vector<double> de00;
    for (std::size_t i = 0; i < shown_; ++i) de00.push_back(seen_difference(a[i], b[i], white_));
    return percentile_95(std::move(de00));
  }

  // The largest difference at the points of the picture and at highlights, which may lie between them.
  double most(const std::vector<color::Rgb>& a, const std::vector<color::Rgb>& b) const {
    double most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, seen_difference(a[i], b[i], white_));
    return most;
  }

  // Seconds that a point takes on all cores together, the best of a few runs, each long enough that starting the
  // threads does not count.
  double seconds_per_point() const {
    if (points_.empty()) return 0;
    constexpr double kLong_s = 2e-4, kSlow_s = 2e-3, kEnough_s = 2e-2;
    std::vector<VisiblePoint> many = points_;
    const Stopwatch clock_once;
    const auto first = engine_.colors(points_);
    const double once_s = clock_once.elapsed_s();
    if (once_s > kSlow_s) {  // again nevertheless: the machine may have been busy
      double least_s = once_s, all_s = once_s;
      for (int i = 0; i < 2 && (i == 0 || all_s < kEnough_s); ++i) {
        const Stopwatch clock;
        const auto again = engine_.colors(points_);
        least_s = std::min(least_s, clock.elapsed_s()), all_s += clock.elapsed_s();
      }
      return least_s / static_cast<double>(points_.size());
    }
    for (double s = once_s; s < kLong_s && many.size() < 8192; s += once_s)
      many.insert(many.end(), points_.begin(), points_.end());
    double best = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const Stopwatch clock;
      const auto colors = engine_.colors(many);
      best = std::min(best, clock.elapsed_s());
    }
    return best / static_cast<double>(many.size());
  }

 private:
  std::vector<color::Rgb> colors(const Effects& chosen) {
    CpuEngine& engine = chosen.reflection ? engine_ : component_wise_;
    engine.load_paints(scene_, chosen);
    std::vector<color::Rgb> colors = engine.colors(points_);
    if (scene_.layer != nullptr) scene_.layer->add(seen_, chosen, colors);
    if (panes_ == nullptr) return colors;
    const auto behind = colors.end() - static_cast<std::ptrdiff_t>(panes_->behind.size());
    const std::vector<color::Rgb> of_behind(behind, colors.end());
    colors.erase(behind, colors.end());
    if (chosen.panes) panes_->add(of_behind, colors);
    return colors;
  }

  std::size_t shown_;
  const Scene& scene_;
  const Effects& all_;
  const std::vector<EffectSwitch>& switches_;
  const std::vector<VisiblePoint>& points_;
  const std::vector<VisiblePoint>& seen_;  // the same, with the parts of the whole scene
  double white_;
  CpuEngine &engine_, &component_wise_;
  const PaneProbe* panes_;
};

}  // namespace goniochrome::render
