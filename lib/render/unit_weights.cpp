#include "render/unit_weights.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/scene_effects.h"

namespace goniochrome::render {

UnitWeights::UnitWeights(const Scene& scene, const Effects& effects, std::vector<double> exponents, double coat_index)
    : table_(weight_table(scene, effects)),
      exponents_(std::move(exponents)),
      coat_index_(coat_index),
      fresnel_(effects.fresnel) {
  wide_ = static_cast<std::size_t>(
      std::ranges::count_if(exponents_, [&](double exponent) { return is_shifted(effects, exponent); }));
}

double UnitWeights::at(std::size_t column, int slot, double cos_o, int channel) const {
  const double x = table_.segments > 1 ? std::sqrt(cos_o) * table_.segments : cos_o;
  const int segment = std::min(static_cast<int>(x), table_.segments - 1);
  const float* w = table_.at(static_cast<int>(column), segment, slot);
  return w[channel] + w[4 + channel] * (x - segment);
}

int UnitWeights::diffuse_slot() const {
  return coat_index_ == paint::kNoCoat ? WeightTable::diffuse_slot() : table_.coat_diffuse_slot();
}

void UnitWeights::add_diffuse(const color::Rgb& at_normal, double cos_o, double scale, color::Rgb* columns) const {
  columns[0] += scale * at(0, diffuse_slot(), cos_o) * at_normal;
}

// A wide lobe is looked up in two directions: that of gloss for its own column, and that of flakes for all others.
void UnitWeights::add_lobes(const std::vector<const envmap::CubeMap*>& maps, const color::Rgb& at_normal,
                            const Vec3& normal, const Vec3& mirrored, double cos_o, double scale,
                            color::Rgb* columns) const {
  const std::size_t of_wide = 1 + 2 * wide_;
  for (std::size_t k = 1; k < of_wide; ++k) columns[k] += scale * at(k, diffuse_slot(), cos_o) * at_normal;
  for (std::size_t j = 0; j < exponents_.size(); ++j) {
    const int slot = WeightTable::lobe_slot(j);
    const std::size_t flake = 1 + 2 * j, gloss = flake + 1;
    const auto toward = [&](std::size_t column) {
      const double shift = at(column, table_.shift_slot(j), cos_o, static_cast<int>(j % 4));
      return scale * envmap::bilinear(*maps[j], mirrored + shift * normal);
    };
    const color::Rgb by_flake = toward(flake), by_gloss = j < wide_ ? toward(gloss) : by_flake;
    columns[gloss] += at(gloss, slot, cos_o) * by_gloss;
    if (j >= wide_) columns[flake] += at(flake, slot, cos_o) * by_flake;
    for (std::size_t k = 1; j < wide_ && k < of_wide; ++k)
      if (k != gloss) columns[k] += at(k, slot, cos_o) * by_flake;
  }
}

UnitWeights::Disc UnitWeights::disc(const Light& light) const {
  Disc disc{light, {}};
  for (const double exponent : exponents_) disc.lobes.push_back(brdf::disc_lobe_table(exponent, light.radius_rad));
  return disc;
}

// Through the coat, at the mean cosine of what is seen of the disc.
double UnitWeights::irradiance(const Disc& disc, double cosine) const {
  const double above = brdf::disc_above(cosine, disc.light.radius_rad);
  if (!(above > 0)) return 0;
  const double bare = brdf::disc_irradiance(cosine, disc.light.radius_rad);
  return bare * brdf::coat_transmission(std::clamp(bare / above, 0.0, 1.0), coat_index_);
}

void UnitWeights::add_diffuse(const Disc& disc, const Vec3& normal, double cos_o, double scale,
                              color::Rgb* columns) const {
  const double weight = at(0, table_.light_slot(), cos_o);
  columns[0] += (scale * kPi * irradiance(disc, dot(normal, disc.light.direction)) * weight) * disc.light.white;
}

void UnitWeights::add_lobes(const Disc& disc, const Vec3& normal, const Vec3& to_viewer, const Vec3& mirrored,
                            double scale, color::Rgb* columns) const {
  const Light& light = disc.light;
  const double cosine = dot(normal, light.direction);
  if (cosine <= -std::sin(light.radius_rad)) return;
  const double cos_o = std::clamp(dot(normal, to_viewer), 0.0, 1.0), cos_r = std::max(0.0, dot(normal, mirrored));
  const double at_disc = irradiance(disc, cosine),
               at_mirror = cos_r * brdf::coat_transmission(std::min(cos_r, 1.0), coat_index_);
  const auto coat = [&](const Vec3& toward) {
    const double cos_half = std::sqrt(std::max(0.0, 0.5 + 0.5 * dot(toward, to_viewer)));
    return fresnel_ ? brdf::fresnel_dielectric(std::min(1.0, cos_half), brdf::kCoatIndex) : 1;
  };
  const double coat_l = brdf::disc_above(cosine, light.radius_rad) * coat(light.direction), coat_r = coat(mirrored);
  const double chord = length(mirrored - light.direction);
  const color::Rgb white = (scale * kPi) * light.white;
  for (std::size_t j = 0; j < exponents_.size(); ++j) {
    const brdf::DiscLobeTable::Node of = disc.lobes[j]->at(chord);
    const std::size_t flake = 1 + 2 * j, gloss = flake + 1;
    columns[flake] += (of.cosine[0] * at_disc + of.cosine[1] * at_mirror) *
                      at(flake, table_.directional_diffuse_slot(j), cos_o) * white;
    columns[gloss] += (of.plain[0] * coat_l + of.plain[1] * coat_r) * at(gloss, table_.gloss_slot(j), cos_o) * white;
  }
}

}  // namespace goniochrome::render
