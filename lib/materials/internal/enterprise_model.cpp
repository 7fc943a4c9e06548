#include "materials/internal/enterprise_model.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "materials/internal/ggx.h"

namespace goniochrome::materials {

namespace {

constexpr double kLeastLost = 1e-4;  // share of light that facets lose, which a quotient has below the line
constexpr double kMostFresnel = 0.9;

// The Schlick reflectance that light has after several reflections between facets of that mean albedo.
double several_reflections(double normal, double grazing, double mean_albedo) {
  const double mean = std::lerp(normal, grazing, 1.0 / 21);
  return mean * mean * mean_albedo / (1 - mean * (1 - mean_albedo));
}

// The light that the lobe leaves to the diffuse part, where it is strongest, for one viewer or for all.
double left_by(double normal, const FacetAlbedo& albedo, double mean_albedo) {
  return 1 - std::lerp(albedo.grazing, albedo.all, normal) -
         several_reflections(normal, 1, mean_albedo) * (1 - albedo.all);
}

double coat_fresnel(double cosine) {
  return std::lerp(0.04, 1.0, schlick(cosine));
}

}  // namespace

color::Rgb enterprise_normal_reflectance(const OneLobe& p) {
  return kMostFresnel * p.specular;
}

color::Rgb enterprise_seen(const OneLobe& p, const Vec3& light, const Vec3& view) {
  const double alpha = p.roughness * p.roughness, cosine = half_cosine(light, view);
  const FacetAlbedo at_light = quick_facet_albedo(alpha, light.z), at_view = quick_facet_albedo(alpha, view.z),
                    mean = quick_facet_average(alpha);
  const double facets = ggx(std::max(alpha, kSharpestAlpha), light, view);
  const double several = (1 - at_light.all) * (1 - at_view.all) / (kPi * std::max(1 - mean.all, kLeastLost));
  const color::Rgb tinted = enterprise_normal_reflectance(p);
  const double strongest = std::max({tinted.x, tinted.y, tinted.z});
  const double left = left_by(strongest, at_light, mean.all) * left_by(strongest, at_view, mean.all) /
                      std::max(left_by(strongest, mean, mean.all), kLeastLost);
  const double diffuse = (1 - p.metalness) * std::lerp(1.0, left, p.strength) / kPi;
  const double grazing = std::lerp(p.strength, 1.0, p.metalness);
  color::Rgb f;
  for (int c = 0; c < 3; ++c) {
    const double normal = std::lerp(p.strength * tinted[c], p.base[c], p.metalness);
    f[c] = facets * std::lerp(normal, grazing, schlick(cosine)) +
           several * several_reflections(normal, grazing, mean.all) + diffuse * p.base[c];
  }
  if (p.clearcoat == 0) return f;
  const double shine = p.clearcoat * coat_fresnel(cosine) *
                       ggx(std::max(p.clearcoat_roughness * p.clearcoat_roughness, kSharpestAlpha), light, view);
  return (1 - p.clearcoat * coat_fresnel(std::min(light.z, view.z))) * f + color::Rgb{shine, shine, shine};
}

}  // namespace goniochrome::materials
