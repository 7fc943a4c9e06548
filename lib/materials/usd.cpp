// USD: a material with the nearest parameters of UsdPreviewSurface, which every renderer of USD has. Its lighting is
// only sketched in its specification; the model here is that of the reference viewer, hdStorm: the diffuse part gives
// way to the lobe by 1 - F, channel by channel, and the clear coat is added on top.
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "materials/internal/documents.h"
#include "materials/internal/ggx.h"
#include "materials/internal/one_lobe.h"

namespace goniochrome::materials {

namespace {

constexpr double kLeastRoughness = 0.001, kCoatReflectance = 0.04;  // an index of 1.5

// D G/(4 cos_i cos_o) with the facets of GGX and Schlick's masking c/(c (1 - k) + k), k = alpha/2.
double facets(double roughness, const Vec3& light, const Vec3& view) {
  const double alpha = std::max(roughness, kLeastRoughness) * std::max(roughness, kLeastRoughness), k = alpha / 2;
  const Vec3 half = normalized(light + view);
  const double d = half.x * half.x + half.y * half.y + alpha * alpha * half.z * half.z;
  const double masking = (light.z * (1 - k) + k) * (view.z * (1 - k) + k);
  return alpha * alpha / (kPi * d * d) / (4 * masking);
}

color::Rgb seen_by_usd(const OneLobe& p, const Vec3& light, const Vec3& view) {
  const double grazing = schlick(half_cosine(light, view));
  const double lobe = facets(p.roughness, light, view);
  const double coat =
      p.clearcoat * std::lerp(kCoatReflectance, 1.0, grazing) * facets(p.clearcoat_roughness, light, view);
  color::Rgb f;
  for (int c = 0; c < 3; ++c) {
    const double fresnel = std::lerp(p.specular[c], 1.0, grazing);
    f[c] = (1 - fresnel) * p.base[c] / kPi + fresnel * lobe + coat;
  }
  return f;
}

std::string usd_text(const OneLobe& p, const Naming& naming) {
  return usda_of_shader("UsdPreviewSurface", "surface", "        int inputs:useSpecularWorkflow = 1\n",
                        {{"diffuseColor", {p.base.x, p.base.y, p.base.z}},
                         {"specularColor", {p.specular.x, p.specular.y, p.specular.z}},
                         {"roughness", {p.roughness}},
                         {"clearcoat", {p.clearcoat}},
                         {"clearcoatRoughness", {p.clearcoat_roughness}},
                         {"ior", {1.5}}},
                        naming);
}

Result<Material> usd_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const NearestLobe nearest = nearest_of(paint, seen_by_usd, {Searched::kColorsAndRoughness});
  return Material{usd_text(nearest.parameters, naming), nearest.shown};
}

}  // namespace

const Target kUsd = {"usda", ".usda", "a material of USD with the nearest parameters of UsdPreviewSurface",
                     usd_material};

}  // namespace goniochrome::materials
