// The nearest parameters of the Enterprise PBR Shading Model of Dassault Systemes, in the form that it documents: glTF
// whose material has the extensions of that model. The thin film of later versions has no place in that form.
#include <algorithm>
#include <optional>

#include "materials/internal/dielectric_layer.h"
#include "materials/internal/enterprise_model.h"
#include "materials/internal/gltf_sphere.h"

namespace goniochrome::materials {

namespace {

std::string enterprise_text(const OneLobe& p, const Naming& naming, const Shown& shown) {
  // The index of refraction reflects as the strongest channel does, and the tint has the ratios of the channels.
  color::Rgb tint = enterprise_normal_reflectance(p);
  const double strongest = std::max({tint.x, tint.y, tint.z});
  tint = strongest > 0 ? (1 / strongest) * tint : color::Rgb{1, 1, 1};
  Json extras = gltf_extras(naming, shown);
  extras["shading_model"] = "Enterprise PBR Shading Model 2022x";
  Json material = {{"name", naming.display},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", {p.base.x, p.base.y, p.base.z, 1}},
                     {"metallicFactor", p.metalness},
                     {"roughnessFactor", p.roughness}}},
                   {"extensions",
                    {{"KHR_materials_ior", {{"ior", rounded(index_of(strongest))}}},
                     {"KHR_materials_specular",
                      {{"specularFactor", p.strength},
                       {"specularColorFactor", {rounded(tint.x), rounded(tint.y), rounded(tint.z)}}}}}},
                   {"extras", extras}};
  Json used = {"KHR_materials_ior", "KHR_materials_specular"};
  if (p.clearcoat > 0) {
    material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", p.clearcoat},
                                                         {"clearcoatRoughnessFactor", p.clearcoat_roughness}};
    used.push_back("KHR_materials_clearcoat");
  }
  return gltf_sphere(material, used, naming);
}

Result<Material> enterprise_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  std::optional<OneLobe> nearest;
  Shown least;
  for (const Searched searched : {Searched::kStrengthToo, Searched::kMetalnessToo}) {
    const OneLobe p = rounded(nearest_one_lobe(paint, enterprise_seen, searched));
    const Shown now = shown(paint, [&](const Vec3& light, const Vec3& view) {
      return color::rec2020_from_rec709(enterprise_seen(p, light, view));
    });
    if (!nearest || now.de00_mean < least.de00_mean) nearest = p, least = now;
  }
  return Material{enterprise_text(*nearest, naming, least), least};
}

}  // namespace

const Target kEnterprise = {"enterprise", ".dspbr.gltf",
                            "a sphere with the nearest parameters of the Enterprise PBR Shading Model, as glTF",
                            enterprise_material};

}  // namespace goniochrome::materials
