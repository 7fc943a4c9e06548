// The nearest parameters of OpenPBR, as a document of MaterialX and as a material of USD. The model is the graph by
// which MaterialX 1.39 defines that shader: a mixture of a metal and of a diffuse base under a dielectric lobe, of one
// roughness, under a coat. The base color is that of the diffuse part and of the metal along the normal.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "materials/internal/dielectric_layer.h"
#include "materials/internal/documents.h"
#include "materials/internal/ggx.h"
#include "materials/internal/one_lobe.h"

namespace goniochrome::materials {

namespace {

constexpr double kOpenPbrCoat = 1.5;

double power4(double x) {
  return x * x * x * x;
}

// The index of the lobe and its weight, by which its reflectance along the normal is the strength. The lobe lies in the
// coat, where it has an index relative to that of the coat; below the least index the weight lowers it.
struct Specular {
  double index, weight;
};
Specular specular_of(const OneLobe& p) {
  const double share = (1 - p.clearcoat) + p.clearcoat / kOpenPbrCoat, wanted = index_of(p.strength);
  const double least = share * kOpenPbrCoat, root = (least - 1) / (least + 1);
  if (wanted >= least) return {wanted / share, 1};
  return {kOpenPbrCoat, p.strength / (root * root)};
}

// Schlick's reflectance of a metal, less what lowers it to a share `at82` of that at 82 deg [Kutz2021].
constexpr double kEdgeCosine = 1.0 / 7;
double schlick_rise(double normal, double cosine) {
  return std::lerp(normal, 1.0, schlick(cosine));
}
double edge_shape(double cosine) {
  const double rest = std::clamp(1 - cosine, 0.0, 1.0);
  return cosine * rest * schlick(cosine) / (kEdgeCosine * (1 - kEdgeCosine) * schlick(kEdgeCosine));
}
double metal_reflectance(double normal, double at82, double cosine) {
  return schlick_rise(normal, cosine) - schlick_rise(normal, kEdgeCosine) * (1 - at82) * edge_shape(cosine);
}

// The least share at 82 deg with which a metal of that color reflects nothing below 0 at any angle.
double least_at82(double normal) {
  constexpr std::size_t kColors = 257, kCosines = 200;
  static const std::array<double, kColors> table = [] {
    std::array<double, kColors> least{};
    for (std::size_t i = 0; i < kColors; ++i)
      for (std::size_t j = 1; j < kCosines; ++j) {
        const double color = static_cast<double>(i) / (kColors - 1), cosine = static_cast<double>(j) / kCosines;
        least[i] = std::max(least[i],
                            1 - schlick_rise(color, cosine) / (schlick_rise(color, kEdgeCosine) * edge_shape(cosine)));
      }
    return least;
  }();
  const double x = std::clamp(normal, 0.0, 1.0) * (kColors - 1);
  const std::size_t i = std::min(static_cast<std::size_t>(x), kColors - 2);
  return std::lerp(table[i], table[i + 1], x - static_cast<double>(i));
}

// The search has the specular color as a share of the range that a metal leaves to it.
color::Rgb specular_color(const OneLobe& p) {
  color::Rgb color = p.specular;
  if (p.metalness > 0)
    for (int c = 0; c < 3; ++c) color[c] = std::lerp(least_at82(p.base[c]), 1.0, color[c]);
  return color;
}

color::Rgb seen_by_openpbr(const OneLobe& p, const Vec3& light, const Vec3& view) {
  const double coated = std::pow(std::min(1.0, 2 * power4(p.clearcoat_roughness) + power4(p.roughness)), 0.25);
  const double roughness = std::lerp(p.roughness, coated, p.clearcoat), alpha = roughness * roughness;
  const DielectricLayer lobe = dielectric_layer(1, index_of(p.strength), alpha, light, view);
  const DielectricLayer coat =
      p.clearcoat > 0
          ? dielectric_layer(p.clearcoat, kOpenPbrCoat, p.clearcoat_roughness * p.clearcoat_roughness, light, view)
          : DielectricLayer();
  const double cosine = half_cosine(light, view), all = quick_facet_albedo(alpha, view.z).all;
  const double facets = specular_of(p).weight * ggx(std::max(alpha, kSharpestAlpha), light, view);
  const color::Rgb tint = specular_color(p);
  color::Rgb f;
  for (int c = 0; c < 3; ++c) {
    double base = tint[c] * lobe.reflected + lobe.left * p.base[c] / kPi;
    if (p.metalness > 0) {
      const double fresnel = metal_reflectance(p.base[c], tint[c], cosine);
      base = std::lerp(base, facets * fresnel * (1 + fresnel * (1 - all) / all), p.metalness);
    }
    f[c] = coat.reflected + coat.left * base;
  }
  return f;
}

ShaderInputs inputs_of(const OneLobe& p) {
  const Specular specular = specular_of(p);
  const color::Rgb tint = specular_color(p);
  return {{"base_weight", {1}},
          {"base_color", {p.base.x, p.base.y, p.base.z}},
          {"base_metalness", {p.metalness}},
          {"specular_weight", {specular.weight}},
          {"specular_color", {tint.x, tint.y, tint.z}},
          {"specular_roughness", {p.roughness}},
          {"specular_ior", {specular.index}},
          {"coat_weight", {p.clearcoat}},
          {"coat_roughness", {p.clearcoat_roughness}},
          {"coat_ior", {kOpenPbrCoat}},
          {"coat_darkening", {0}}};  // the colors are those below the coat already
}

Result<Material> openpbr_material(const paint::Paint& fitted, const Naming& naming, bool usd) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const NearestLobe nearest = nearest_of(paint, seen_by_openpbr, {Searched::kStrengthToo, Searched::kMetalnessToo});
  const ShaderInputs inputs = inputs_of(nearest.parameters);
  return Material{usd ? usda_of_shader("ND_open_pbr_surface_surfaceshader", "mtlx:surface", "", inputs, naming)
                      : mtlx_of_shader("open_pbr_surface", "1.39", inputs, naming),
                  nearest.shown};
}

}  // namespace

const Target kOpenPbr = {
    "openpbr", ".mtlx", "the nearest parameters of OpenPBR, as MaterialX 1.39",
    [](const paint::Paint& paint, const Naming& naming) { return openpbr_material(paint, naming, false); }};

const Target kOpenPbrUsd = {
    "openpbr-usda", ".usda", "a material of USD with the same parameters of OpenPBR",
    [](const paint::Paint& paint, const Naming& naming) { return openpbr_material(paint, naming, true); }};

}  // namespace goniochrome::materials
