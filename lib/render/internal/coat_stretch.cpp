#include "render/internal/coat_stretch.h"

#include <algorithm>
#include <optional>
#include <vector>

#include "base/angles.h"
#include "base/kept_values.h"
#include "brdf/coat_facets.h"
#include "brdf/coat_tilts.h"
#include "brdf/gloss.h"
#include "brdf/lobe_model.h"
#include "math/elementary.h"
#include "render/internal/wear.h"

namespace goniochrome::render {

namespace {

using Set = std::shared_ptr<const paint::TiltedLobes>;

// All that a set depends on.
std::vector<double> gloss_of(const paint::LobeFit& paint, double gloss_deg) {
  std::vector<double> gloss = {paint.coat_index, gloss_deg};
  for (const paint::ViewLobes& view : paint.views) {
    gloss.push_back(view.view_deg);
    for (const paint::Lobe& lobe : view.lobes) gloss.push_back(lobe.exponent), gloss.push_back(lobe.gloss.x);
  }
  return gloss;
}

Set made(const paint::LobeFit& paint, double gloss_deg) {
  const std::optional<brdf::RoughCoat> coat = brdf::coat_of_lobes(paint, gloss_deg);
  std::vector<double> exponents;
  for (const paint::ViewLobes& view : paint.views)
    for (const paint::Lobe& lobe : view.lobes)
      if (!lobe.is_mirror() && lobe.gloss != color::Rgb{}) exponents.push_back(lobe.exponent);
  std::ranges::sort(exponents);
  exponents.erase(std::ranges::unique(exponents).begin(), exponents.end());
  if (!coat || exponents.empty()) return nullptr;
  const double index = brdf::mirror_index(paint.coat_index);
  std::vector<double> mirrored;
  for (const double view_deg : brdf::kCoatViews_deg) {
    const paint::LobeFit seen = brdf::at_view(paint, view_deg);
    double share = 0;
    for (const paint::Lobe& lobe : seen.lobes)
      if (lobe.is_mirror()) share = lobe.gloss.x * brdf::fresnel_dielectric(math::cos(view_deg * kDegree), index);
    mirrored.push_back(share);
  }
  return std::make_shared<const paint::TiltedLobes>(brdf::coat_tilts(*coat, index, exponents, mirrored));
}

}  // namespace

std::shared_ptr<const paint::TiltedLobes> drawn_stretch(const Scene& scene, const Effects& effects, std::size_t part) {
  static KeptValues<std::vector<double>, Set> kept;
  if (!effects.stretch || !effects.environment || effects.lights > 0 || !wears_rough_coat(scene, part)) return nullptr;
  const paint::LobeFit& paint = scene.paints[part];
  const double gloss_deg = gloss_deg_of(scene, part);
  return *kept.get(gloss_of(paint, gloss_deg), [&] { return made(paint, gloss_deg); });
}

std::vector<bool> stretched_parts(const Scene& scene, const Effects& effects) {
  std::vector<bool> parts;
  for (std::size_t part = 0; part < scene.paints.size(); ++part)
    parts.push_back(drawn_stretch(scene, effects, part) != nullptr);
  return parts;
}

}  // namespace goniochrome::render
