#include "render/internal/wear.h"

#include "brdf/coat_facets.h"
#include "render/surface_layer.h"

namespace goniochrome::render {

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
  return x.diffuse == y.diffuse && x.coat_index == y.coat_index && x.tilts == y.tilts && x.lobes == y.lobes &&
         x.views == y.views && gloss_deg_of(scene, a) == gloss_deg_of(scene, b) &&
         anisotropy_of(scene, a) == anisotropy_of(scene, b);
}

}  // namespace goniochrome::render
