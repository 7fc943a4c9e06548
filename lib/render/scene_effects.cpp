#include "render/scene_effects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/coat_facets.h"
#include "brdf/lobe_model.h"
#include "brdf/tilted_lobes.h"
#include "math/elementary.h"
#include "render/internal/horizon_mix.h"
#include "render/internal/lobe_curves.h"
#include "render/internal/tilt_table.h"
#include "render/internal/wear.h"
#include "render/panes.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

// The value of every slot of a part at one view.
class SlotValues {
 public:
  using Texel = std::array<double, 4>;

  // With `mapped`, K_D in image light is that of a color map, which was measured through the coat.
  SlotValues(const WeightTable& table, const Effects& effects, double gloss_deg, double coat_index, bool mapped)
      : table_(table),
        effects_(effects),
        coat_index_(coat_index),
        mapped_(mapped),
        even_(brdf::mean_coat_transmission(coat_index)),
        values_(static_cast<std::size_t>(table.slots)) {
    if (effects.fresnel)
      fresnel_scale_ = 1 / brdf::fresnel_dielectric(math::cos(gloss_deg * kDegree), brdf::kCoatIndex);
    // Maps of lobes that are left out have no part in the mix: a picture does not load them.
    std::vector<double> wide;
    for (std::size_t j = 0; j < effects.lobes.size(); ++j) {
      if (!is_mixed(effects.lobes[j])) continue;
      wide.push_back(effects.lobes[j].exponent);
      mixed_.push_back(j);
    }
    const auto diffuse = !effects.diffuse ? HorizonMix::Diffuse::kNone
                         : is_bare()      ? HorizonMix::Diffuse::kBare
                                          : HorizonMix::Diffuse::kCoated;
    if (!wide.empty()) mix_.emplace(wide, table.segments, coat_index, diffuse, effects.fresnel);
  }

  // `lit` is what lights meet. `node` counts the ends of the segments; a table of one segment has the view cos_o = 0 at
  // its start and 1 at its end.
  const std::vector<Texel>& at(const paint::LobeFit& paint, const paint::LobeFit& lit, double cos_o, int node) {
    std::fill(values_.begin(), values_.end(), Texel{});
    const double let_out = brdf::coat_transmission(cos_o, coat_index_);
    if (effects_.diffuse) {
      set(diffuse_slot(), (is_bare() ? kPi : let_out * even_ * kPi) * paint.diffuse);
      set(table_.light_slot(), let_out * lit.diffuse);
    }
    values_[static_cast<std::size_t>(table_.light_slot())][3] = coat_index_ * coat_index_;
    std::vector<HorizonMix::Sent> wide;
    for (std::size_t j = 0; j < effects_.lobes.size(); ++j) {
      const Effects::LobeUse& use = effects_.lobes[j];
      const bool is_wide = is_mixed(use);
      if (is_wide) wide.emplace_back();
      const paint::Lobe* lobe = find_lobe(paint, use.exponent);
      if (lobe == nullptr) continue;
      const color::Rgb flake = use.directional_diffuse ? let_out * lobe->directional_diffuse : color::Rgb{};
      const color::Rgb gloss = use.gloss ? fresnel_scale_ * lobe->gloss : color::Rgb{};
      const LobeIntegrals seen =
          table_.segments > 1 ? lobe_curve(use.exponent, table_.segments, effects_.horizon, coat_index_)->at(node)
                              : lobe_integrals(use.exponent, cos_o, false);
      const color::Rgb by_flake = seen.cosine * flake,
                       by_gloss = (effects_.fresnel ? seen.fresnel : seen.plain) * gloss;
      if (is_wide) {
        wide.back() = {by_flake, by_gloss};
      } else {
        set(WeightTable::lobe_slot(j), by_flake + by_gloss);
      }
      const paint::Lobe* met = find_lobe(lit, use.exponent);
      if (met == nullptr) continue;
      if (use.directional_diffuse) set(table_.directional_diffuse_slot(j), let_out * met->directional_diffuse);
      if (use.gloss) set(table_.gloss_slot(j), fresnel_scale_ * met->gloss);
    }
    if (mix_) set_mixed(mix_->at(wide, node));
    const paint::Lobe* mirror = effects_.mirror ? find_lobe(paint, paint::kMirrorExponent) : nullptr;
    const double seen_cos = effects_.fresnel ? cos_o : std::numbers::sqrt2 / 2;
    if (mirror != nullptr) {
      const color::Rgb weight = brdf::fresnel_dielectric(seen_cos, brdf::mirror_index(coat_index_)) * mirror->gloss;
      set(table_.mirror_slot(), weight);
      set(table_.lamp_mirror_slot(), weight);
    }
    return values_;
  }

 private:
  void set(int slot, const color::Rgb& value) {
    for (std::size_t c = 0; c < 3; ++c) values_[static_cast<std::size_t>(slot)][c] = value[static_cast<int>(c)];
  }
  bool is_mixed(const Effects::LobeUse& use) const {
    return is_shifted(effects_, use.exponent) && (use.directional_diffuse || use.gloss);
  }
  void set_mixed(const HorizonMix::Weights& mixed) {
    for (std::size_t k = 0; k < mixed.lobes.size(); ++k) {
      const std::size_t j = mixed_[k];
      set(WeightTable::lobe_slot(j), mixed.lobes[k]);
      values_[static_cast<std::size_t>(table_.shift_slot(j))][j % 4] = mixed.shifts[k];
    }
    Texel& diffuse = values_[static_cast<std::size_t>(diffuse_slot())];
    for (std::size_t c = 0; c < 3; ++c) diffuse[c] += mixed.diffuse[static_cast<int>(c)];
  }
  // True if the diffuse part is that of the bare map.
  bool is_bare() const { return mapped_ || coat_index_ == paint::kNoCoat; }
  int diffuse_slot() const { return is_bare() ? WeightTable::diffuse_slot() : table_.coat_diffuse_slot(); }

  const WeightTable& table_;
  const Effects& effects_;
  double coat_index_;
  bool mapped_;
  double even_;  // what is left of even light on its way in
  double fresnel_scale_ = 1;
  std::optional<HorizonMix> mix_;   // of wide lobes, with the effect horizon
  std::vector<std::size_t> mixed_;  // the numbers of these lobes
  std::vector<Texel> values_;
};

// The rest of a paint in image light where tilted lobes stand for its flakes: gloss and mirror, and K_D of the set.
paint::LobeFit beside_tilts(paint::LobeFit paint, const paint::TiltedLobes& set, double view_deg) {
  paint.diffuse = brdf::at_view(set, view_deg).diffuse;
  for (paint::Lobe& lobe : paint.lobes) lobe.directional_diffuse = {};
  return paint;
}

// The rest of a paint where other lobes stand for the gloss of its rough coat. The mirror is none of them.
paint::LobeFit beside_stretch(paint::LobeFit paint) {
  for (paint::Lobe& lobe : paint.lobes)
    if (!lobe.is_mirror()) lobe.gloss = {};
  return paint;
}

void fill_part(const Scene& scene, const Effects& effects, std::size_t part, bool stretched, const WeightTable& table,
               float* rows) {
  const paint::LobeFit paint = effects.coat ? scene.paints[part] : brdf::under_coat(scene.paints[part], paint::kNoCoat);
  const bool with_views = effects.views && !paint.views.empty();
  const paint::TiltedLobes* tilts = drawn_tilts(paint, effects);
  SlotValues values(table, effects, gloss_deg_of(scene, part), paint.coat_index, tilts != nullptr);
  std::vector<SlotValues::Texel> before;
  for (int node = 0; node <= table.segments; ++node) {
    const double x = static_cast<double>(node) / table.segments, cos_o = table.segments > 1 ? x * x : x;
    paint::LobeFit here_paint = with_views ? brdf::at_view(paint, math::acos(cos_o) / kDegree) : paint;
    if (stretched) here_paint = beside_stretch(std::move(here_paint));  // bright spots stand in the maps of those lobes
    const std::vector<SlotValues::Texel>& here =
        values.at(tilts != nullptr ? beside_tilts(here_paint, *tilts, math::acos(cos_o) / kDegree) : here_paint,
                  effects.maps ? paint : here_paint, cos_o, node);
    if (node > 0) {
      for (std::size_t slot = 0; slot < here.size(); ++slot, rows += 8) {
        for (std::size_t c = 0; c < 4; ++c) {
          rows[c] = static_cast<float>(before[slot][c]);
          rows[4 + c] = static_cast<float>(here[slot][c] - before[slot][c]);
        }
      }
    }
    before = here;
  }
}

// True if the extent of a lamp changes what a paint shows. A lobe of exponent E falls by E R^2/4 in its middle, and a
// wide disc is cut by the horizon.
bool is_seen_as_disc(const Light& light, const Effects& effects) {
  constexpr double kFall = 1e-3, kWide_rad = 0.02;
  const double radius = light.radius_rad;
  return radius > kWide_rad || (!effects.lobes.empty() && effects.lobes.back().exponent * radius * radius / 4 > kFall);
}

}  // namespace

Effects effects_of(const Scene& scene) {
  Effects effects;
  effects.environment = scene.env != nullptr;
  const bool discs = std::ranges::any_of(scene.lights, [](const Light& light) { return light.radius_rad > 0; });
  effects.mirror = (effects.environment || discs) && has_mirror(scene.paints);
  effects.lights = scene.lights.size();
  effects.placed = has_placed_lamps(scene);
  effects.background = scene.background;
  bool gloss = effects.mirror;
  for (const double exponent : lobe_exponents(scene.paints)) {
    Effects::LobeUse use{exponent, false, false};
    for (const paint::LobeFit& paint : scene.paints) {
      use.directional_diffuse |= wears_lobe(paint, exponent, LobeWeight::kDirectionalDiffuse);
      use.gloss |= wears_lobe(paint, exponent, LobeWeight::kGloss);
    }
    gloss |= use.gloss;
    effects.lobes.push_back(use);
  }
  effects.fresnel = gloss;
  effects.extent = effects.mirror && discs;
  for (const Light& light : scene.lights) effects.extent |= is_seen_as_disc(light, effects);
  effects.coat =
      std::ranges::any_of(scene.paints, [](const paint::LobeFit& paint) { return paint.coat_index != paint::kNoCoat; });
  effects.horizon = effects.environment && !effects.lobes.empty();
  effects.views = std::ranges::any_of(scene.paints, [](const paint::LobeFit& paint) { return !paint.views.empty(); });
  for (std::size_t part = 0; part < scene.paints.size(); ++part)
    effects.satin = effects.satin || wears_rough_coat(scene, part);
  effects.stretch = effects.satin && effects.environment && effects.lights == 0;
  effects.anisotropy = !effects.lobes.empty() && std::ranges::any_of(scene.anisotropy, is_anisotropic);
  effects.tilt_tolerance = scene.tilt_error, effects.most_tilts = scene.most_tilts;
  if (effects.environment) {
    for (std::size_t part = 0; part < scene.paints.size(); ++part) {
      effects.tilt_level = std::max(effects.tilt_level, static_cast<int>(scene.paints[part].tilts.size()));
      effects.image_maps = effects.image_maps || is_mapped(scene, part);
    }
  }
  // Color maps and tilted lobes stand for the light of all the maps.
  const bool maps_alone = effects.tilt_level > 0 || (scene.layer != nullptr && scene.layer->mapped());
  if (effects.horizon && !maps_alone) effects.spots = scene.env->spots.size();
  effects.texture = effects.texture_filter = scene.layer != nullptr && scene.layer->textured();
  effects.maps = scene.layer != nullptr && scene.layer->mapped();
  effects.panes = has_panes(scene);
  effects.reflection = scene.reflection.k != color::component_wise().k;
  return effects;
}

std::vector<Light> single_lights(const Scene& scene, const Effects& effects) {
  std::vector<Light> lights = lights_of(scene, effects);
  for (std::size_t i = 0; i < effects.spots; ++i) lights.push_back(light_of(scene.env->spots[i]));
  return lights;
}

paint::LobeFit with_effects(const paint::LobeFit& paint, const Effects& effects) {
  paint::LobeFit result = effects.coat ? paint : brdf::under_coat(paint, paint::kNoCoat);
  if (!effects.views) result.views.clear();
  const auto strip = [&](color::Rgb& diffuse, std::vector<paint::Lobe>& lobes) {
    if (!effects.diffuse) diffuse = {};
    std::erase_if(lobes, [&](paint::Lobe& lobe) {
      if (lobe.is_mirror()) return !effects.mirror;
      const auto use = std::ranges::find(effects.lobes, lobe.exponent, &Effects::LobeUse::exponent);
      if (use == effects.lobes.end()) return true;
      if (!use->directional_diffuse) lobe.directional_diffuse = {};
      if (!use->gloss) lobe.gloss = {};
      return false;
    });
  };
  strip(result.diffuse, result.lobes);
  for (paint::ViewLobes& view : result.views) strip(view.diffuse, view.lobes);
  return result;
}

brdf::TiltSet tilts_of(const Scene& scene, const Effects& effects, std::size_t part) {
  const brdf::TiltSet level = {{{{0, 0, 1}, 1}}, 0, 0};
  if (part >= scene.anisotropy.size()) return level;
  const paint::Anisotropy& alpha = scene.anisotropy[part];
  double sharpest = 0;
  for (const Effects::LobeUse& use : effects.lobes) {
    const paint::LobeFit& paint = scene.paints[part];
    if (wears_lobe(paint, use.exponent, LobeWeight::kDirectionalDiffuse) ||
        wears_lobe(paint, use.exponent, LobeWeight::kGloss))
      sharpest = use.exponent;
  }
  if (!(alpha.alpha_x > 0) || sharpest == 0) return level;
  // The tilts must be close enough for the sharpest lobe, which may be narrower than the surface's narrow side: the
  // same spread, wide^2 - narrow^2, about that lobe.
  const double low = std::min(alpha.alpha_x, alpha.alpha_y), high = std::max(alpha.alpha_x, alpha.alpha_y);
  const double narrow = std::min(low, brdf::lobe_alpha(sharpest)),
               wide = std::sqrt(high * high - low * low + narrow * narrow);
  const paint::Anisotropy fine =
      alpha.alpha_x < alpha.alpha_y ? paint::Anisotropy{narrow, wide} : paint::Anisotropy{wide, narrow};
  auto set = brdf::ward_tilts(fine, narrow, effects.tilt_tolerance, effects.most_tilts);
  return set.ok() ? *std::move(set) : level;
}

std::vector<std::vector<brdf::Tilt>> tilts_of(const Scene& scene, const Effects& effects) {
  std::vector<std::vector<brdf::Tilt>> tilts;
  for (std::size_t part = 0; part < scene.paints.size(); ++part) tilts.push_back(tilts_of(scene, effects, part).tilts);
  return tilts;
}

WeightTable weight_table(const Scene& scene, const Effects& effects, const std::vector<bool>& stretched) {
  WeightTable table = slots_of(effects);
  const auto is_stretched = [&](std::size_t part) { return !stretched.empty() && stretched[part]; };
  const auto is_like_last = [&](std::size_t part) {
    return same_wear(scene, part, part - 1) && is_stretched(part) == is_stretched(part - 1);
  };
  std::vector<std::size_t> first;  // part of each row
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    if (part == 0 || !is_like_last(part)) first.push_back(part);
    table.rows.push_back(static_cast<int>(first.size()) - 1);
  }
  table.rgba.assign(table.row_floats() * first.size(), 0.0F);
  parallel_each(first.size(), 1, [&](std::size_t row) {
    fill_part(scene, effects, first[row], is_stretched(first[row]), table, &table.rgba[row * table.row_floats()]);
  });
  return table;
}

std::vector<int> gaining_parts(const Scene& scene) {
  constexpr double kMost = 1.01, kSteepCosine = 0.04;  // at grazing views every smooth surface is a mirror
  Effects effects = effects_of(scene);
  effects.tilt_level = 0, effects.horizon = !effects.lobes.empty();
  const WeightTable table = weight_table(scene, effects);
  const int first = static_cast<int>(std::sqrt(kSteepCosine) * table.segments);
  const auto gains = [&](int row, int segment, int channel) {
    double share = 0;  // of even light, at the end of the segment; the slots from light_slot() on are those of lamps
    for (int slot = 0; slot < table.light_slot(); ++slot) {
      const float* w = table.at(row, segment, slot);
      share += w[channel] + w[4 + channel];
    }
    return share > kMost;
  };
  std::vector<int> parts;
  for (int part = 0; part < static_cast<int>(table.rows.size()); ++part) {
    const PartSurface* surface = scene.layer != nullptr ? &scene.layer->surface(part) : nullptr;
    if (surface != nullptr && (surface->hides_paint() || surface->color_map != nullptr)) continue;
    bool any = false;
    for (int segment = first; segment < table.segments; ++segment)
      for (int channel = 0; channel < 3; ++channel)
        any = any || gains(table.rows[static_cast<std::size_t>(part)], segment, channel);
    if (any) parts.push_back(part);
  }
  return parts;
}

Result<void> draws_placed_lamps(const Scene& scene, const char* engine) {
  const bool any = std::ranges::any_of(
      scene.lights, [](const Light& light) { return light.place.has_value() && light.radius_rad > 0; });
  if (!any || !effects_of(scene).extent) return {};
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    const paint::LobeFit& paint = scene.paints[part];
    if (paint.lobes.empty() && paint.views.empty() && paint.diffuse == color::Rgb{}) continue;
    if (scene.layer != nullptr && scene.layer->surface(static_cast<int>(part)).hides_paint()) continue;
    return usage_error(
        "the engine {} draws a lamp at a place that shines on paint as a point: write @0 behind the lamp, or take the "
        "engine path, which draws it with its extent",
        engine);
  }
  return {};
}

std::vector<float> tilt_texels(const std::vector<std::vector<brdf::Tilt>>& tilts) {
  std::size_t most = 1;
  for (const std::vector<brdf::Tilt>& part : tilts) most = std::max(most, part.size());
  std::vector<float> texels(4 * most * tilts.size(), 0.0F);
  for (std::size_t part = 0; part < tilts.size(); ++part) {
    float* to = &texels[4 * most * part];
    for (const brdf::Tilt& tilt : tilts[part]) {
      for (int c = 0; c < 3; ++c) *to++ = static_cast<float>(tilt.normal[c]);
      *to++ = static_cast<float>(tilt.weight);
    }
  }
  return texels;
}

}  // namespace goniochrome::render
