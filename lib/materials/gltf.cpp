// glTF 2.0: a sphere that wears the paint, as web viewers show it. The base is the dielectric of the core model, whose
// reflectance along the normal is a color of its own (KHR_materials_specular with the index 0 of KHR_materials_ior,
// which stands for a reflectance of 1), under KHR_materials_clearcoat. So face and flop have different colors, and one
// roughness. A film of KHR_materials_iridescence lies between them where it brings the colors nearer. Which parameters
// are the nearest is found by the color difference over all angles.
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "materials/internal/ggx.h"
#include "materials/internal/gltf_sphere.h"
#include "materials/internal/one_lobe.h"
#include "materials/internal/thin_film.h"

namespace goniochrome::materials {

namespace {

constexpr double kLeastGainByFilm = 0.1;  // of a film, in the mean difference

// The specification's model, its Appendix B and those of the extensions: the coat lies over the base by the reflectance
// that the viewer's angle has, and the base mixes a diffuse and a microfacet part by the largest channel of Fresnel's.
color::Rgb seen_by_gltf(const OneLobe& p, const Vec3& light, const Vec3& view) {
  const double grazing = schlick(half_cosine(light, view));
  const double facets = ggx(std::max(p.roughness * p.roughness, kSharpestAlpha), light, view);
  color::Rgb fresnel;
  for (int c = 0; c < 3; ++c) fresnel[c] = std::lerp(std::min(p.specular[c], 1.0) * p.strength, p.strength, grazing);
  if (p.film > 0) {
    color::Rgb normal;
    for (int c = 0; c < 3; ++c) normal[c] = std::min(p.specular[c], 1.0) * p.strength;
    const color::Rgb film = film_reflectance(p.film_index, p.film_nm, normal, half_cosine(light, view));
    fresnel = (1 - p.film) * fresnel + p.film * film;
  }
  const double diffuse = (1 - std::max({fresnel.x, fresnel.y, fresnel.z})) / kPi;
  const color::Rgb base = diffuse * p.base + facets * fresnel;
  if (p.clearcoat == 0) return base;
  const double coat = p.clearcoat * std::lerp(0.04, 1.0, schlick(view.z));
  const double shine = coat * ggx(std::max(p.clearcoat_roughness * p.clearcoat_roughness, kSharpestAlpha), light, view);
  return (1 - coat) * base + color::Rgb{shine, shine, shine};
}

std::string gltf_text(const OneLobe& p, const Naming& naming, const Shown& shown) {
  Json material = {
      {"name", naming.display},
      {"pbrMetallicRoughness",
       {{"baseColorFactor", {p.base.x, p.base.y, p.base.z, 1}},
        {"metallicFactor", 0},
        {"roughnessFactor", p.roughness}}},
      {"extensions",
       {{"KHR_materials_ior", {{"ior", 0}}},
        {"KHR_materials_specular",
         {{"specularFactor", p.strength}, {"specularColorFactor", {p.specular.x, p.specular.y, p.specular.z}}}}}},
      {"extras", gltf_extras(naming, shown)}};
  if (p.clearcoat > 0)
    material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", p.clearcoat},
                                                         {"clearcoatRoughnessFactor", p.clearcoat_roughness}};
  if (p.film > 0)
    material["extensions"]["KHR_materials_iridescence"] = {
        {"iridescenceFactor", p.film}, {"iridescenceIor", p.film_index}, {"iridescenceThicknessMaximum", p.film_nm}};
  return gltf_sphere(material, naming);
}

Result<Material> gltf_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  NearestLobe nearest = nearest_of(paint, seen_by_gltf, {Searched::kStrengthToo});
  // A film costs every viewer time, and what does not turn its hue has no use for it.
  if (nearest.shown.de00_mean > kLeastGainByFilm) {
    const OneLobe with_film = rounded(nearest_with_film(paint, seen_by_gltf, nearest.parameters));
    const Shown shown_with_film = shown_by(paint, seen_by_gltf, with_film);
    if (shown_with_film.de00_mean < nearest.shown.de00_mean - kLeastGainByFilm) nearest = {with_film, shown_with_film};
  }
  return Material{gltf_text(nearest.parameters, naming, nearest.shown), nearest.shown};
}

}  // namespace

const Target kGltf = {"gltf", ".gltf", "a sphere with the nearest parameters of glTF 2.0, for web viewers",
                      gltf_material};

}  // namespace goniochrome::materials
