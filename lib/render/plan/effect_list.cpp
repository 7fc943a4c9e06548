#include "render/plan/effect_list.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "color/color.h"
#include "render/panes.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

constexpr double kGrazingCos = 0.5;  // beyond 60 deg the reflectance of a coat leaves 4 %

constexpr double kWhiteChroma = 1e-3;  // of light kept in single precision

// The share of the points (percent) for which it holds.
template <class Condition>
double percent(const std::vector<VisiblePoint>& points, Condition holds) {
  const auto count = std::count_if(points.begin(), points.end(), holds);
  return points.empty() ? 0 : 100.0 * static_cast<double>(count) / static_cast<double>(points.size());
}

double cos_o(const VisiblePoint& point) {
  return dot(point.normal, point.to_viewer);
}

void remove_weight(Effects& effects, double exponent, bool gloss) {
  for (Effects::LobeUse& use : effects.lobes) {
    if (use.exponent == exponent) (gloss ? use.gloss : use.directional_diffuse) = false;
  }
}

int wearing(const Scene& scene, double exponent, bool gloss) {
  return static_cast<int>(std::ranges::count_if(scene.paints, [&](const paint::LobeFit& paint) {
    return wears_lobe(paint, exponent, gloss ? LobeWeight::kGloss : LobeWeight::kDirectionalDiffuse);
  }));
}

void add_lobes(const Scene& scene, const Effects& all, bool gloss, std::vector<EffectSwitch>& list) {
  const std::string group = gloss ? "gloss" : "lobes";
  const std::size_t before = list.size();
  for (const Effects::LobeUse& use : all.lobes) {
    if (!(gloss ? use.gloss : use.directional_diffuse)) continue;
    const double exponent = use.exponent;
    const int parts = wearing(scene, exponent, gloss);
    list.push_back({fmt::format("{}-{}", gloss ? "gloss" : "lobe", shortest(exponent)), group, true,
                    fmt::format("{} on {} visible part{}", gloss ? "gloss" : "flake", parts, parts == 1 ? "" : "s"),
                    [=](Effects& e) {
                      remove_weight(e, exponent, gloss);
                      if (gloss) e.satin = e.stretch = false;
                    }});
    list.back().left_to_tilts = !gloss && std::ranges::any_of(scene.paints, [&](const paint::LobeFit& paint) {
      return !paint.tilts.empty() && wears_lobe(paint, exponent, LobeWeight::kDirectionalDiffuse);
    });
  }
  if (list.size() == before) {
    list.push_back({group, group, false, gloss ? "no visible paint has gloss lobes" : "solid paints: no flake lobes",
                    [](Effects&) {}});
  }
}

// Half of a lobe's peak is left at this angle; the share of points where it reaches below the horizon.
std::string horizon_reason(const Effects& all, const std::vector<VisiblePoint>& seen) {
  if (!all.horizon) return all.lobes.empty() ? "no lobes" : "no image light: lights are exact";
  const double widest = all.lobes.front().exponent;
  const double half_rad = std::acos(std::pow(0.5, 1 / std::max(widest, 1.0)));
  return fmt::format("the lobe of exponent {} reaches below the horizon in {:.0f} % of what is seen", shortest(widest),
                     percent(seen, [&](const VisiblePoint& p) { return cos_o(p) < std::sin(half_rad); }));
}

std::string spots_reason(const Scene& scene, const Effects& all) {
  if (!all.horizon) return "no horizon to cut light from all around";
  if (scene.env->spots.empty()) return "no small part of the environment is bright";
  if (all.spots == 0) return "color maps stand for the light of the maps";
  return fmt::format("{} bright spot{} of the environment, each cut by the horizon by itself", all.spots,
                     all.spots == 1 ? "" : "s");
}

std::string anisotropy_reason(const Scene& scene, const Effects& all) {
  if (!all.anisotropy) return "no visible paint is brushed";
  brdf::TiltSet most;
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    brdf::TiltSet set = tilts_of(scene, all, part);
    if (set.tilts.size() > most.tilts.size()) most = std::move(set);
  }
  return fmt::format("brushed paint: {} tilted normals, within {:.2g} of the lobes' peak", most.tilts.size(),
                     most.error);
}

std::string extent_reason(const Scene& scene, const Effects& all) {
  if (all.lights == 0) return "no lamps";
  double widest = 0;
  for (const Light& light : scene.lights) widest = std::max(widest, light.radius_rad);
  if (widest == 0) return "lamps are points";
  if (!all.extent) return "no lobe is narrow enough to tell the lamps from points";
  return fmt::format("lamps up to {:.2g} deg wide, in lobes up to exponent {}{}", 2 * widest / kDegree,
                     all.lobes.empty() ? "0" : shortest(all.lobes.back().exponent),
                     all.mirror ? " and in the mirror" : "");
}

// The chroma of the colors of light, as of a white diffuser in it.
double light_chroma(const Scene& scene, const Effects& all) {
  double most = 0;
  const auto meet = [&](const color::Rgb& rgb) {
    const double y = color::luminance(rgb);
    if (y > 0)
      most = std::max(most, color::chroma(color::lab_from_rgb((1 / y) * rgb, color::xyz_d65_from_rgb({1, 1, 1}))));
  };
  if (all.environment) {
    const envmap::CubeMap& map = scene.env->diffuse.map;
    for (std::size_t i = 0; i + 2 < map.texels.size(); i += 3)
      meet({map.texels[i], map.texels[i + 1], map.texels[i + 2]});
  }
  if (all.lights > 0) {
    for (const Light& light : scene.lights) meet(light.white);
  }
  return most;
}

std::string reflection_reason(const Scene& scene, const Effects& all) {
  if (!all.reflection) return "the operator is the component-wise product";
  const double most = light_chroma(scene, all);
  if (most <= kWhiteChroma) return "white light: the operator changes nothing";
  return fmt::format("colored light, up to C* {:.2g} on a white diffuser", most);
}

std::string texture_reason(const Scene& scene, const Effects& all, const std::vector<VisiblePoint>& seen) {
  if (!all.texture) return "no part has a texture";
  return fmt::format("{:.0f} % of what is seen is textured: beside its mean texel",
                     percent(seen, [&](const auto& p) { return !scene.layer->surface(p.part).textures.empty(); }));
}

// The most texels that a pixel covers.
double most_covered(const Scene& scene, const std::vector<VisiblePoint>& seen) {
  double most = 1;
  for (const VisiblePoint& point : seen) most = std::max(most, scene.layer->covered_texels(point));
  return most;
}

// The sets of tilted lobes, the coarsest first. Each set but the first is drawn in the place of the one before it.
void add_tilts(const Scene& scene, const Effects& all, std::vector<EffectSwitch>& list) {
  int before = -1;
  for (int level = 1; level <= all.tilt_level; ++level) {
    int most = 0;
    for (const paint::LobeFit& paint : scene.paints) {
      if (paint.tilts.empty()) continue;
      const auto set = std::min(paint.tilts.size(), static_cast<std::size_t>(level)) - 1;
      most = std::max(most, paint.tilts[set].lookups());
    }
    EffectSwitch effect{
        fmt::format("tilts-{}", level), "tilts", true,
        fmt::format("{} image light by {} tilted look-ups", level == 1 ? "a color map in" : "the map closer in", most),
        [=](Effects& e) {
          e.tilt_level = std::min(e.tilt_level, level - 1);
          if (level == 1) e.image_maps = false;
        }};
    effect.needs = before;
    effect.refines = level > 1;
    before = static_cast<int>(list.size());
    list.push_back(std::move(effect));
  }
  if (all.tilt_level > 0) return;
  list.push_back({"tilts", "tilts", false,
                  all.image_maps
                      ? "a color map in image light; maps of lobes cannot show it, as the paint has no tilted "
                        "lobes: fit it with fit-paint --tilts"
                      : "no visible paint has a color map in image light",
                  [](Effects&) {}});
}

// The lobes of textures by number, those of all textures together.
void add_texture_lobes(const Scene& scene, const Effects& all, std::vector<EffectSwitch>& list) {
  const int lobes = all.texture ? scene.layer->lobes() : 0;
  for (int lobe = 0; lobe < lobes; ++lobe) {
    list.push_back({fmt::format("texture-{}", lobe), "texture-lobes", true, fmt::format("lobe{} of the textures", lobe),
                    [=](Effects& e) { e.texture_lobes &= ~(1U << lobe); }});
  }
  if (lobes == 0) list.push_back({"texture-lobes", "texture-lobes", false, "no texture has lobes", [](Effects&) {}});
}

}  // namespace

const std::vector<std::string>& ray_effect_names() {
  static const std::vector<std::string> names = {"shadow", "self", "bounce", "floor"};
  return names;
}

std::vector<EffectSwitch> effect_switches(const Scene& scene, const Effects& all,
                                          const std::vector<VisiblePoint>& seen) {
  std::vector<EffectSwitch> list;
  const auto add = [&](const char* name, bool needed, const std::string& reason, std::function<void(Effects&)> off) {
    list.push_back({name, name, needed, reason, std::move(off)});
  };
  const bool diffuse =
      std::ranges::any_of(scene.paints, [](const paint::LobeFit& p) { return p.diffuse != color::Rgb{}; });
  add("diffuse", diffuse, diffuse ? "paints have a constant part" : "no visible paint has a constant part",
      [](Effects& e) { e.diffuse = false; });
  add_lobes(scene, all, false, list);
  add_lobes(scene, all, true, list);
  add("mirror", all.mirror,
      !all.mirror        ? (all.environment || all.extent ? "no visible paint has a mirror lobe" : "no light to mirror")
      : !all.environment ? "a smooth coat mirrors the lamps"
      : all.extent       ? "a smooth coat mirrors the environment and the lamps"
                         : "a smooth coat mirrors the environment",
      [](Effects& e) { e.mirror = e.satin = false; });
  const double grazing = percent(seen, [](const VisiblePoint& p) { return cos_o(p) < kGrazingCos; });
  add("fresnel", all.fresnel,
      !all.fresnel  ? "neither gloss lobes nor mirror"
      : grazing > 0 ? fmt::format("{:.0f} % of what is seen lies beyond 60 deg", grazing)
                    : "nothing is seen beyond 60 deg",
      [](Effects& e) { e.fresnel = e.satin = e.stretch = false; });
  add("coat", all.coat,
      !all.coat     ? "no visible paint has a coat"
      : grazing > 0 ? fmt::format("the coat takes light from the base, {:.0f} % of what is seen beyond 60 deg", grazing)
                    : "the coat takes light from the base",
      [](Effects& e) { e.coat = false; });
  add("horizon", all.horizon, horizon_reason(all, seen), [](Effects& e) {
    e.horizon = false;
    e.spots = 0;
  });
  const int horizon = static_cast<int>(list.size()) - 1;
  add("spots", all.spots > 0, spots_reason(scene, all), [](Effects& e) { e.spots = 0; });
  list.back().needs = horizon;
  list.back().refines = true;
  add("anisotropy", all.anisotropy, anisotropy_reason(scene, all), [](Effects& e) { e.anisotropy = false; });
  add("travel", all.views || all.maps,
      all.views && all.maps ? "weights change with the view, and a color map under lights"
      : all.views           ? "weights change with the view"
      : all.maps            ? "a color map under lights"
                            : "no visible paint has a color map or weights for several views",
      [](Effects& e) { e.views = e.maps = e.satin = e.stretch = false; });
  add("satin", all.satin,
      all.satin ? "a rough coat as facets, in the place of its round lobes" : "no visible paint has a rough coat",
      [](Effects& e) { e.satin = false; });
  list.back().beyond_maps = true;
  add("stretch", all.stretch,
      all.stretch ? "the light of a rough coat, which is wider in the plane of incidence than across it"
      : all.satin ? "lamps light the rough coat: the lobes that they see stand for it"
                  : "no visible paint has a rough coat",
      [](Effects& e) { e.stretch = false; });
  list.back().refines = true;
  add_tilts(scene, all, list);
  add("texture", all.texture, texture_reason(scene, all, seen), [](Effects& e) { e.texture = false; });
  const int texture = static_cast<int>(list.size()) - 1;
  const double covered = all.texture_filter ? most_covered(scene, seen) : 1;
  add("texture-filter", covered > 1,
      covered > 1 ? fmt::format("pixels cover up to {:.3g} texels", covered) : "no pixel covers more than a texel",
      [](Effects& e) { e.texture_filter = false; });
  list.back().needs = texture;
  add_texture_lobes(scene, all, list);
  add("operator", all.reflection && light_chroma(scene, all) > kWhiteChroma, reflection_reason(scene, all),
      [](Effects& e) { e.reflection = false; });
  add("panes", all.panes,
      all.panes
          ? fmt::format("{:.0f} % of what is seen is glass, and what lies behind it is seen",
                        percent(seen, [&](const auto& p) { return is_pane(scene, static_cast<std::size_t>(p.part)); }))
          : "no part is a pane of glass",
      [](Effects& e) { e.panes = false; });
  add("lights", all.lights > 0,
      fmt::format("{} {}light{}", all.lights, all.placed ? "" : "directional ", all.lights == 1 ? "" : "s"),
      [](Effects& e) {
        e.lights = 0;
        e.maps = false;
      });
  add("extent", all.extent, extent_reason(scene, all), [](Effects& e) { e.extent = false; });
  return list;
}

}  // namespace goniochrome::render
