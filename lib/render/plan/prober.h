// The trial of effects on a sample of the visible points, by the engine cpu. goniochrome-plan(7), "PLAN".
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "render/cpu/cpu_engine.h"
#include "render/internal/seen.h"
#include "render/plan/effect_list.h"
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
  // The first `shown` points are those of the picture; highlight_points() follow. `component_wise` has the plain
  // product of colors; null where no other product is left out.
  Prober(const Scene& scene, const Effects& all, const std::vector<EffectSwitch>& switches,
         const std::vector<VisiblePoint>& points, const std::vector<VisiblePoint>& seen, std::size_t shown,
         double white, CpuEngine& engine, CpuEngine* component_wise)
      : shown_(shown),
        scene_(scene),
        all_(all),
        switches_(switches),
        points_(points),
        seen_(seen),
        white_(white > 0 ? white : 1),
        engine_(engine),
        component_wise_(component_wise) {}

  Effects effects(const std::vector<bool>& on) const {
    Effects effects = all_;
    for (std::size_t i = 0; i < switches_.size(); ++i) {
      if (!on[i]) switches_[i].turn_off(effects);
    }
    leave_out_idle(effects);
    return effects;
  }

  bool tries_operator() const { return component_wise_ != nullptr; }

  // Kept, since the same choices are tried again and again. The result holds as long as the prober.
  const std::vector<color::Rgb>& colors(std::vector<bool> on) {
    for (std::size_t i = 0; i < on.size(); ++i) on[i] = on[i] || !switches_[i].needed;
    const auto [known, is_new] = known_.try_emplace(std::move(on));
    if (is_new) known->second = colors(effects(known->first));
    return known->second;
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

 private:
  std::vector<color::Rgb> colors(const Effects& chosen) {
    CpuEngine& engine = chosen.reflection || component_wise_ == nullptr ? engine_ : *component_wise_;
    engine.load_paints(scene_, chosen);
    std::vector<color::Rgb> colors = engine.colors(points_);
    if (scene_.layer != nullptr) scene_.layer->add(seen_, chosen, colors);
    return colors;
  }

  std::size_t shown_;
  const Scene& scene_;
  const Effects& all_;
  const std::vector<EffectSwitch>& switches_;
  const std::vector<VisiblePoint>& points_;
  const std::vector<VisiblePoint>& seen_;  // the same, with the parts of the whole scene
  double white_;
  CpuEngine& engine_;
  CpuEngine* component_wise_;
  std::map<std::vector<bool>, std::vector<color::Rgb>> known_;
};

}  // namespace goniochrome::render
