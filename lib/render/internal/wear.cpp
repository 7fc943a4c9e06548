#include "render/internal/wear.h"

#include <algorithm>

#include "brdf/coat_facets.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

namespace {

bool same_lobes(const std::vector<paint::Lobe>& a, const std::vector<paint::Lobe>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const paint::Lobe& x, const paint::Lobe& y) {
    return x.exponent == y.exponent && x.directional_diffuse == y.directional_diffuse && x.gloss == y.gloss;
  });
}

}  // namespace

double gloss_deg_of(const Scene& scene, std::size_t part) {
  return part < scene.gloss_deg.size() ? scene.gloss_deg[part] : 45;
}

paint::Anisotropy anisotropy_of(const Scene& scene, std::size_t part) {
  return part < scene.anisotropy.size() ? scene.anisotropy[part] : paint::Anisotropy{};
}

bool is_anisotropic(const paint::Anisotropy& alpha) {
  return alpha.alpha_x > 0 && alpha.alpha_x != alpha.alpha_y;
}

bool is_mapped(const Scene& scene, std::size_t part) {
  return scene.layer != nullptr && scene.layer->surface(static_cast<int>(part)).color_map != nullptr;
}

bool wears_rough_coat(const Scene& scene, std::size_t part) {
  const bool worn = scene.layer != nullptr && scene.layer->surface(static_cast<int>(part)).hides_paint();
  return !worn && !is_anisotropic(anisotropy_of(scene, part)) && brdf::stands_for_coat(scene.paints[part]);
}

bool same_wear(const Scene& scene, std::size_t a, std::size_t b) {
  const paint::LobeFit &x = scene.paints[a], &y = scene.paints[b];
  const paint::Anisotropy brushed_x = anisotropy_of(scene, a), brushed_y = anisotropy_of(scene, b);
  return x.diffuse == y.diffuse && x.coat_index == y.coat_index && x.tilts == y.tilts && same_lobes(x.lobes, y.lobes) &&
         gloss_deg_of(scene, a) == gloss_deg_of(scene, b) && brushed_x.alpha_x == brushed_y.alpha_x &&
         brushed_x.alpha_y == brushed_y.alpha_y &&
         std::equal(x.views.begin(), x.views.end(), y.views.begin(), y.views.end(),
                    [](const paint::ViewLobes& v, const paint::ViewLobes& w) {
                      return v.view_deg == w.view_deg && v.diffuse == w.diffuse && same_lobes(v.lobes, w.lobes);
                    });
}

}  // namespace goniochrome::render
