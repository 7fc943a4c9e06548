// MDL: a material of two files. The table of the base is a measured BSDF (.mbsdf), as Omniverse, V-Ray, Iray and
// Substance read it; the material (.mdl) lays the mirror of the coat over it, as a fresnel_layer.
//
// The container is that of brdf/measured.h: a grid over both polar angles and the azimuth between them, whose values
// are f at the centers of cells. A fresnel_layer of weight k leaves 1 - k max(F(theta_i), F(theta_o)) to what lies
// below it, as NVIDIA's implementation has it. The table is divided by that, so that base and layer together show the
// paint.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "brdf/measured.h"
#include "materials/internal/documents.h"
#include "materials/internal/shown.h"
#include "materials/internal/widened_mirror.h"

namespace goniochrome::materials {

namespace {

constexpr std::size_t kTheta = 90, kPhi = 180;  // cells of 1 deg

// The mirror of the coat, with what sharp lobes reflect, as a share of Fresnel's reflectance.
double mirror_weight(const paint::LobeFit& lobes) {
  paint::LobeFit sharp = lobes;
  std::erase_if(sharp.lobes, [](const paint::Lobe& lobe) { return lobe.exponent < kSharpestInCells; });
  const CoatGloss gloss = coat_gloss(sharp);
  return std::min(gloss.mirror + gloss.satin, 1.0);
}

// The paint without the gloss of these lobes.
paint::LobeFit without_mirror(paint::LobeFit lobes) {
  const auto clear = [](std::vector<paint::Lobe>& all) {
    for (paint::Lobe& lobe : all)
      if (lobe.exponent >= kSharpestInCells) lobe.gloss = {};
  };
  clear(lobes.lobes);
  for (paint::ViewLobes& view : lobes.views) clear(view.lobes);
  return lobes;
}

// What the layer leaves to the base.
double left_by_layer(double weight, double index, double cos_i, double cos_o) {
  return 1 - weight * std::max(brdf::fresnel_dielectric(std::min(cos_i, 1.0), index),
                               brdf::fresnel_dielectric(std::min(cos_o, 1.0), index));
}

void put(std::string& bytes, std::uint32_t value) {
  static_assert(std::endian::native == std::endian::little, "the format is little-endian");
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string table(const paint::LobeFit& lobes, double weight, double index, const Naming& naming) {
  std::string bytes = "NVIDIA ARC MBSDF V1\n";
  bytes += "name=" + quoted(naming.display) + "\nprovenance=" + quoted(naming.provenance) + "\n";
  bytes += "MBSDF_DATA_REFLECTION=\n";
  constexpr std::uint32_t kRgbType = 1;
  put(bytes, kRgbType);
  put(bytes, kTheta);
  put(bytes, kPhi);
  const auto polar = [](std::size_t i) { return (static_cast<double>(i) + 0.5) * kPi / 2 / kTheta; };
  std::vector<float> values(kTheta * kTheta * kPhi * 3);
  // Gloss has 1/cos(theta_i), and views have weights of their own; the rest is the same both ways.
  const bool reciprocal = lobes.views.empty() && std::ranges::all_of(lobes.lobes, [](const paint::Lobe& lobe) {
                            return lobe.gloss == color::Rgb{};
                          });
  for (std::size_t i = 0; i < kTheta; ++i)
    for (std::size_t o = 0; o < kTheta; ++o) {
      float* row = &values[(i * kTheta + o) * kPhi * 3];
      if (reciprocal && o < i) {
        std::memcpy(row, &values[(o * kTheta + i) * kPhi * 3], kPhi * 3 * sizeof(float));
        continue;
      }
      const Vec3 light = direction(polar(i), 0);
      const double left = left_by_layer(weight, index, light.z, std::cos(polar(o)));
      for (std::size_t k = 0; k < kPhi; ++k) {
        const Vec3 view = direction(polar(o), (static_cast<double>(k) + 0.5) * kPi / kPhi);
        const color::Rgb f = color::rec709_from_rec2020((1 / left) * brdf::coated_brdf(lobes, light, view, {0, 0, 1}));
        for (int c = 0; c < 3; ++c) row[3 * k + static_cast<std::size_t>(c)] = static_cast<float>(std::max(f[c], 0.0));
      }
    }
  bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  return bytes;
}

std::string module(double weight, double index, const Naming& naming) {
  const std::string base = "df::measured_bsdf(\n                measurement: bsdf_measurement(" +
                           quoted("./" + naming.file_stem + kMdl.companion) +
                           "),\n                mode: df::scatter_reflect)";
  return "mdl 1.3;\n\nimport ::anno::*;\nimport ::df::*;\nimport ::state::*;\n\nexport material " + naming.identifier +
         "()\n[[\n    ::anno::display_name(" + quoted(naming.display) + "),\n    ::anno::description(" +
         quoted(naming.provenance) + ")\n]]\n= material(\n    surface: material_surface(\n        scattering: " +
         (weight > 0
              ? fmt::format("df::fresnel_layer(\n            ior: {:.6g},\n            weight: {:.6g},\n"
                            "            layer: df::specular_bsdf(mode: df::scatter_reflect),\n            base: ",
                            index, weight) +
                    base + ")"
              : base) +
         "));\n";
}

Result<Material> mdl_material(const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const double weight = mirror_weight(*paint.lobes), index = brdf::mirror_index(paint.lobes->coat_index);
  Material material;
  material.companion = table(without_mirror(*paint.lobes), weight, index, naming);
  GONIO_ASSIGN(const auto read, brdf::read_measured(naming.identifier + kMdl.companion, material.companion));
  material.shown = shown(paint, [&](const Vec3& light, const Vec3& view) {
    const std::vector<double> f = read->value(light, view).f;
    return left_by_layer(weight, index, light.z, view.z) * color::rec2020_from_rec709({f[0], f[1], f[2]});
  });
  material.bytes = module(weight, index, naming);
  return material;
}

}  // namespace

const Target kMdl = {"mdl", ".mdl",
                     "a material of MDL and its measured table (.mbsdf), for Omniverse, V-Ray, Iray and Substance",
                     mdl_material, ".mbsdf"};

}  // namespace goniochrome::materials
