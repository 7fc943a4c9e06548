#include "materials/internal/dielectric_layer.h"

#include <algorithm>
#include <cmath>

#include "brdf/lobe_model.h"
#include "materials/internal/ggx.h"

namespace goniochrome::materials {

namespace {}  // namespace

double index_of(double strength) {
  const double r = std::sqrt(std::clamp(strength, 0.0, 0.9));
  return (1 + r) / (1 - r);
}

DielectricLayer dielectric_layer(double weight, double index, double alpha, const Vec3& light, const Vec3& view) {
  const FacetAlbedo albedo = quick_facet_albedo(alpha, view.z);
  const double normal = (index - 1) / (index + 1), f0 = normal * normal;
  const double fresnel = brdf::fresnel_dielectric(half_cosine(light, view), index);
  const double more = 1 + fresnel * (1 - albedo.all) / albedo.all;
  return {weight * fresnel * more * ggx(std::max(alpha, kSharpestAlpha), light, view),
          1 - weight * more * (f0 * (albedo.all - albedo.grazing) + albedo.grazing)};
}

}  // namespace goniochrome::materials
