// The nearest parameters of Autodesk Standard Surface, as a document of MaterialX: a diffuse base under a dielectric
// lobe of a tint, a roughness and an index that may be high, under a coat. The model is the graph by which MaterialX
// defines that shader.
#include "base/angles.h"
#include "materials/internal/dielectric_layer.h"
#include "materials/internal/documents.h"
#include "materials/internal/one_lobe.h"

namespace goniochrome::materials {

namespace {

constexpr double kStandardCoat = 1.5;

color::Rgb seen_by_standard(const OneLobe& p, const Vec3& light, const Vec3& view) {
  const DielectricLayer lobe = dielectric_layer(1, index_of(p.strength), p.roughness * p.roughness, light, view);
  const DielectricLayer coat =
      p.clearcoat > 0
          ? dielectric_layer(p.clearcoat, kStandardCoat, p.clearcoat_roughness * p.clearcoat_roughness, light, view)
          : DielectricLayer();
  color::Rgb f;
  for (int c = 0; c < 3; ++c)
    f[c] = coat.reflected + coat.left * (p.specular[c] * lobe.reflected + lobe.left * p.base[c] / kPi);
  return f;
}

std::string standard_text(const OneLobe& p, const Naming& naming) {
  return mtlx_of_shader("standard_surface", "1.38",
                        {{"base", {1}},
                         {"base_color", {p.base.x, p.base.y, p.base.z}},
                         {"specular", {1}},
                         {"specular_color", {p.specular.x, p.specular.y, p.specular.z}},
                         {"specular_roughness", {p.roughness}},
                         {"specular_IOR", {index_of(p.strength)}},
                         {"coat", {p.clearcoat}},
                         {"coat_roughness", {p.clearcoat_roughness}},
                         {"coat_IOR", {kStandardCoat}}},
                        naming);
}

Result<Material> standard_surface_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const NearestLobe nearest = nearest_of(paint, seen_by_standard, {Searched::kStrengthToo});
  return Material{standard_text(nearest.parameters, naming), nearest.shown};
}

}  // namespace

const Target kStandardSurface = {"standard-surface", ".mtlx",
                                 "the nearest parameters of Autodesk Standard Surface, as MaterialX",
                                 standard_surface_material};

}  // namespace goniochrome::materials
