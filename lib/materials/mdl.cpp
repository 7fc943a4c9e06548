// MDL: a material of two files. The table of the base is a measured BSDF (.mbsdf), as Omniverse, V-Ray, Iray and
// Substance read it; the material (.mdl) lays the mirror of the coat over it, as a fresnel_layer.
//
// The container is that of brdf/measured.h: a grid over both polar angles and the azimuth between them, whose values
// are f at the centers of cells. A fresnel_layer of weight k leaves 1 - k max(F(theta_i), F(theta_o)) to what lies
// below it, as NVIDIA's implementation has it. The table is divided by that, so that base and layer together show the
// paint.
//
// Neither file says what its colors are. Renderers that read them work in Rec.709, or in ACEScg where they are told to,
// and there is a target for each. A table cannot hold light below 0, so that in Rec.709 a color outside of it is the
// nearest inside.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <optional>
#include <vector>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "brdf/measured.h"
#include "materials/internal/color_space.h"
#include "materials/internal/documents.h"
#include "materials/internal/rec709_gamut.h"
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

// The lobes of all views.
std::vector<paint::Lobe> at_any_view(const paint::LobeFit& lobes) {
  std::vector<paint::Lobe> all = lobes.lobes;
  for (const paint::ViewLobes& view : lobes.views) all.insert(all.end(), view.lobes.begin(), view.lobes.end());
  return all;
}

// The light that the layer leaves to the base.
double left_by_layer(double weight, double index, double cos_i, double cos_o) {
  return 1 - weight * std::max(brdf::fresnel_dielectric(std::min(cos_i, 1.0), index),
                               brdf::fresnel_dielectric(std::min(cos_o, 1.0), index));
}

void put(std::string& bytes, std::uint32_t value) {
  static_assert(std::endian::native == std::endian::little, "the format is little-endian");
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// A function of one number from 0 to 1, linear between even steps. A lobe of exponent 1000 is wrong by 1e-5 of its
// height at most.
template <class Value>
class EvenSteps {
 public:
  explicit EvenSteps(const std::function<Value(double)>& function) {
    for (std::size_t i = 0; i <= kSteps; ++i) values_.push_back(function(static_cast<double>(i) / kSteps));
  }
  Value at(double x) const {
    const double place = std::clamp(x, 0.0, 1.0) * kSteps;
    const std::size_t i = std::min(static_cast<std::size_t>(place), kSteps - 1);
    return values_[i] + (place - static_cast<double>(i)) * (values_[i + 1] - values_[i]);
  }

 private:
  static constexpr std::size_t kSteps = 4096;
  std::vector<Value> values_;
};

// The color of lobes at one angle of the viewer, in the space of the file, over the sine of half of the aspecular angle
// relative to that of 45 deg; beyond there all lobes are 0. Steps are finest where lobes are.
struct SeenLobes {
  EvenSteps<color::Rgb> base, gloss;

  SeenLobes(const paint::LobeFit& lobes, double view_deg, ColorSpace space)
      : base([&](double x) { return at(lobes, view_deg, space, x, 1, 0); }),
        gloss([&](double x) { return at(lobes, view_deg, space, x, 0, 1); }) {}

  static double place(double aspecular_cosine) { return std::sqrt(std::max(0.0, 1 - aspecular_cosine)); }

 private:
  static color::Rgb at(const paint::LobeFit& lobes, double view_deg, ColorSpace space, double place, double base_scale,
                       double gloss_scale) {
    const double aspecular_rad = 2 * std::asin(place * std::sqrt(0.5));
    return into_space(space, brdf::brdf_by_angles(lobes, aspecular_rad, view_deg, base_scale, gloss_scale));
  }
};

// A table, and whether colors of the paint are outside of its space.
struct Table {
  std::string bytes;
  bool cut = false;
};

Table table(const paint::Paint& paint, double weight, double index, ColorSpace space, const Naming& naming) {
  const paint::LobeFit lobes = without_mirror(*paint.lobes);
  Table result;
  std::string& bytes = result.bytes;
  bytes = "NVIDIA ARC MBSDF V1\n";
  bytes += "name=" + quoted(naming.display) + "\nprovenance=" + quoted(naming.provenance) +
           "\ncolorspace=" + quoted(name_of(space)) + "\n";
  bytes += "MBSDF_DATA_REFLECTION=\n";
  constexpr std::uint32_t kRgbType = 1;
  put(bytes, kRgbType);
  put(bytes, kTheta);
  put(bytes, kPhi);
  const std::size_t header = bytes.size();
  constexpr std::size_t kRow = kPhi * 3 * sizeof(float);
  bytes.resize(header + kTheta * kTheta * kRow);
  const auto row_at = [&](std::size_t i, std::size_t o) { return bytes.data() + header + (i * kTheta + o) * kRow; };

  const auto polar = [](std::size_t i) { return (static_cast<double>(i) + 0.5) * kPi / 2 / kTheta; };
  std::array<double, kTheta> sine{}, cosine{};
  for (std::size_t i = 0; i < kTheta; ++i) sine[i] = std::sin(polar(i)), cosine[i] = std::cos(polar(i));
  std::array<double, kPhi> azimuth{};
  for (std::size_t k = 0; k < kPhi; ++k) azimuth[k] = std::cos((static_cast<double>(k) + 0.5) * kPi / kPhi);
  std::vector<SeenLobes> views;
  for (std::size_t o = 0; o < (lobes.views.empty() ? 1 : kTheta); ++o)
    views.emplace_back(lobes, polar(o) / kDegree, space);
  // Gloss has 1/cos(theta_i), and views have weights of their own; the rest is the same both ways.
  const bool glossy =
      std::ranges::any_of(at_any_view(lobes), [](const paint::Lobe& lobe) { return !(lobe.gloss == color::Rgb{}); });
  const bool reciprocal = lobes.views.empty() && !glossy;
  const EvenSteps<double> fresnel([](double half_cosine) { return brdf::coat_fresnel(half_cosine); });
  const auto white = color::white_point(paint::condition_of(paint));
  std::optional<NearestInRec709> nearest;  // made where it is needed
  std::array<float, 3 * kPhi> row{};
  for (std::size_t i = 0; i < kTheta; ++i)
    for (std::size_t o = 0; o < kTheta; ++o) {
      if (reciprocal && o < i) {
        std::memcpy(row_at(i, o), row_at(o, i), kRow);
        continue;
      }
      const SeenLobes& seen = views[lobes.views.empty() ? 0 : o];
      const double left = left_by_layer(weight, index, cosine[i], cosine[o]);
      const double passages = brdf::coat_passages(lobes.coat_index, cosine[i], cosine[o]);
      const double along = cosine[i] * cosine[o], across = sine[i] * sine[o];
      for (std::size_t k = 0; k < kPhi; ++k) {
        const double place = SeenLobes::place(along - across * azimuth[k]);
        color::Rgb f = passages * seen.base.at(place);
        if (glossy) {
          const double half_cosine = std::sqrt((1 + along + across * azimuth[k]) / 2);
          f += fresnel.at(half_cosine) / cosine[i] * seen.gloss.at(place);
        }
        const double least = std::min({f.x, f.y, f.z});
        if (least < 0) {
          constexpr double kNoticed = 1e-3;
          result.cut = result.cut || least < -kNoticed * std::max({f.x, f.y, f.z});
          if (space == ColorSpace::kRec709) {
            if (!nearest) nearest.emplace(white.ok() ? *white : color::Xyz{1, 1, 1});
            f = into_space(space, (*nearest)(from_space(space, f)));
          }
        }
        for (int c = 0; c < 3; ++c)
          row[3 * k + static_cast<std::size_t>(c)] = static_cast<float>(std::max(f[c], 0.0) / left);
      }
      std::memcpy(row_at(i, o), row.data(), kRow);
    }
  return result;
}

std::string module(double weight, double index, ColorSpace space, const Naming& naming) {
  const std::string base = "df::measured_bsdf(\n                measurement: bsdf_measurement(" +
                           quoted("./" + naming.file_stem + kMdl.companion) +
                           "),\n                mode: df::scatter_reflect)";
  const std::string told = space == ColorSpace::kRec709 ? "" : " Its colors are for a renderer that works in ACEScg.";
  return "mdl 1.3;\n\nimport ::anno::*;\nimport ::df::*;\nimport ::state::*;\n\nexport material " + naming.identifier +
         "()\n[[\n    ::anno::display_name(" + quoted(naming.display) + "),\n    ::anno::description(" +
         quoted(naming.provenance + told) + ")\n]]\n= material(\n    surface: material_surface(\n        scattering: " +
         (weight > 0
              ? fmt::format("df::fresnel_layer(\n            ior: {:.6g},\n            weight: {:.6g},\n"
                            "            layer: df::specular_bsdf(mode: df::scatter_reflect),\n            base: ",
                            index, weight) +
                    base + ")"
              : base) +
         "));\n";
}

Result<Material> material_in(ColorSpace space, const paint::Paint& fitted, const Naming& naming) {
  GONIO_ASSIGN(const paint::Paint paint, exported(fitted));
  const double weight = mirror_weight(*paint.lobes), index = brdf::mirror_index(paint.lobes->coat_index);
  Material material;
  Table made = table(paint, weight, index, space, naming);
  material.companion = std::move(made.bytes);
  GONIO_ASSIGN(const auto read, brdf::read_measured(naming.identifier + kMdl.companion, material.companion));
  material.shown = shown(paint, [&](const Vec3& light, const Vec3& view) {
    const std::vector<double> f = read->value(light, view).f;
    return left_by_layer(weight, index, light.z, view.z) * color::rec2020_from_rec709({f[0], f[1], f[2]});
  });
  material.bytes = module(weight, index, space, naming);
  if (made.cut) {
    material.left_out.emplace_back(space == ColorSpace::kRec709 ? "the part of its colors outside of Rec.709"
                                                                : "the part of its colors outside of ACEScg");
  }
  return material;
}

Result<Material> mdl_material(const paint::Paint& paint, const Naming& naming) {
  return material_in(ColorSpace::kRec709, paint, naming);
}
Result<Material> mdl_acescg_material(const paint::Paint& paint, const Naming& naming) {
  return material_in(ColorSpace::kAcescg, paint, naming);
}

}  // namespace

const Target kMdl = {"mdl", ".mdl",
                     "a material of MDL and its measured table (.mbsdf), for Omniverse, V-Ray, Iray and Substance",
                     mdl_material, ".mbsdf"};
const Target kMdlAcescg = {"mdl-acescg", ".mdl", "the same with a table in ACEScg, for renderers that work in it",
                           mdl_acescg_material, ".mbsdf"};

}  // namespace goniochrome::materials
