// The nearest parameters of the Enterprise PBR Shading Model of Dassault Systemes, in the form that it documents: glTF
// whose material has the extensions of that model. The thin film of later versions has no place in that form.
#include <algorithm>

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
  if (p.clearcoat > 0)
    material["extensions"]["KHR_materials_clearcoat"] = {{"clearcoatFactor", p.clearcoat},
                                                         {"clearcoatRoughnessFactor", p.clearcoat_roughness}};
  return gltf_sphere(material, naming);
}

Result<Material> enterprise_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const NearestLobe nearest = nearest_of(paint, enterprise_seen, {Searched::kStrengthToo, Searched::kMetalnessToo});
  return Material{enterprise_text(nearest.parameters, naming, nearest.shown), nearest.shown};
}

}  // namespace

const Target kEnterprise = {"enterprise", ".dspbr.gltf",
                            "a sphere with the nearest parameters of the Enterprise PBR Shading Model, as glTF",
                            enterprise_material};

}  // namespace goniochrome::materials
