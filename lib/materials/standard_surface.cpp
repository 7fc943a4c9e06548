// The nearest parameters of Autodesk Standard Surface, as a document of MaterialX: a diffuse base under a dielectric
// lobe of a tint, a roughness and an index that may be high, under a coat. The model is the graph by which MaterialX
// defines that shader.
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/lobe_model.h"
#include "materials/internal/ggx.h"
#include "materials/internal/one_lobe.h"

namespace goniochrome::materials {

namespace {

constexpr double kSharpest = 1e-4, kCoatIndex = 1.5;

// The index whose reflectance along the normal is the strength.
double index_of(double strength) {
  const double r = std::sqrt(std::clamp(strength, 0.0, 0.9));
  return (1 + r) / (1 - r);
}

// A dielectric node: what it reflects, and what the node layer leaves to the one below.
struct Layer {
  double reflected, left;
};
Layer dielectric(double weight, double index, double alpha, const Vec3& light, const Vec3& view) {
  const FacetAlbedo albedo = quick_facet_albedo(alpha, view.z);
  const double normal = (index - 1) / (index + 1), f0 = normal * normal;
  const double fresnel = brdf::fresnel_dielectric(half_cosine(light, view), index);
  const double more = 1 + fresnel * (1 - albedo.all) / albedo.all;
  return {weight * fresnel * more * ggx(std::max(alpha, kSharpest), light, view),
          1 - weight * more * (f0 * (albedo.all - albedo.grazing) + albedo.grazing)};
}

color::Rgb seen(const OneLobe& p, const Vec3& light, const Vec3& view) {
  const Layer lobe = dielectric(1, index_of(p.strength), p.roughness * p.roughness, light, view);
  const Layer coat =
      p.clearcoat > 0 ? dielectric(p.clearcoat, kCoatIndex, p.clearcoat_roughness * p.clearcoat_roughness, light, view)
                      : Layer{0, 1};
  color::Rgb f;
  for (int c = 0; c < 3; ++c)
    f[c] = coat.reflected + coat.left * (p.specular[c] * lobe.reflected + lobe.left * p.base[c] / kPi);
  return f;
}

std::string written(const OneLobe& p, const Naming& naming) {
  std::string text = "<?xml version=\"1.0\"?>\n<materialx version=\"1.38\" colorspace=\"lin_rec709\" doc=\"" +
                     xml_escaped(naming.provenance) + "\">\n  <standard_surface name=\"" + naming.identifier +
                     "_surface\" type=\"surfaceshader\">\n";
  const auto number = [&](const char* name, double value) {
    text += fmt::format("    <input name=\"{}\" type=\"float\" value=\"{:.6g}\" />\n", name, value);
  };
  const auto color = [&](const char* name, const color::Rgb& rgb) {
    text += fmt::format("    <input name=\"{}\" type=\"color3\" value=\"{:.6g}, {:.6g}, {:.6g}\" />\n", name, rgb.x,
                        rgb.y, rgb.z);
  };
  number("base", 1);
  color("base_color", p.base);
  number("specular", 1);
  color("specular_color", p.specular);
  number("specular_roughness", p.roughness);
  number("specular_IOR", index_of(p.strength));
  number("coat", p.clearcoat);
  number("coat_roughness", p.clearcoat_roughness);
  number("coat_IOR", kCoatIndex);
  text += "  </standard_surface>\n  <surfacematerial name=\"" + naming.identifier + "\" type=\"material\" uiname=\"" +
          xml_escaped(naming.display) + "\">\n    <input name=\"surfaceshader\" type=\"surfaceshader\" nodename=\"" +
          naming.identifier + "_surface\" />\n  </surfacematerial>\n</materialx>\n";
  return text;
}

Result<Material> standard_surface_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const OneLobe p = rounded(nearest_one_lobe(paint, seen, true));
  return Material{written(p, naming), shown(paint, [&](const Vec3& light, const Vec3& view) {
                    return color::rec2020_from_rec709(seen(p, light, view));
                  })};
}

}  // namespace

const Target kStandardSurface = {"standard-surface", ".mtlx",
                                 "the nearest parameters of Autodesk Standard Surface, as MaterialX",
                                 standard_surface_material};

}  // namespace goniochrome::materials
