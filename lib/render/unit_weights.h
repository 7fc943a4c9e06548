// The weights by which each column of a basis shows light: those of a paint with weight 1 in that column alone. What
// gathers light by columns reads maps and lamps by them as the engines do. goniochrome-rendering(7), "LAMPS".
#pragma once

#include <memory>
#include <vector>

#include "brdf/disc_light.h"
#include "envmap/cube_map.h"
#include "render/effects.h"

namespace goniochrome::render {

class UnitWeights {
 public:
  UnitWeights() = default;
  // The scene has one paint for each column: K_D, then K_DD and K_G of each exponent, then the mirror. All of them have
  // the coat of that index.
  UnitWeights(const Scene& scene, const Effects& effects, std::vector<double> exponents, double coat_index);

  // The channel of a slot of the column's paint, at a view with that cosine to the normal (0..1).
  double at(std::size_t column, int slot, double cos_o, int channel = 0) const;
  // The slot that the diffuse map or, under a coat, the coat's diffuse map is read by.
  int diffuse_slot() const;
  const WeightTable& table() const { return table_; }

  // Adds what the maps of an environment have: that of diffuse_slot(), and those of the exponents. Lobes are about a
  // mirror direction, and what the diffuse map knows of them is weighed with them.
  void add_diffuse(const color::Rgb& at_normal, double cos_o, double scale, color::Rgb* columns) const;
  void add_lobes(const std::vector<const envmap::CubeMap*>& maps, const color::Rgb& at_normal, const Vec3& normal,
                 const Vec3& mirrored, double cos_o, double scale, color::Rgb* columns) const;

  // A lamp that is a disc of some radius, with the tables of its lobes.
  struct Disc {
    Light light;
    std::vector<std::shared_ptr<const brdf::DiscLobeTable>> lobes;
  };
  Disc disc(const Light& light) const;
  // Add what a disc gives to the diffuse column, and to those of the lobes about a mirror direction: one part with the
  // cosine and the coat of the disc and one with those of the mirror direction. Mirror images are not added.
  void add_diffuse(const Disc& disc, const Vec3& normal, double cos_o, double scale, color::Rgb* columns) const;
  void add_lobes(const Disc& disc, const Vec3& normal, const Vec3& to_viewer, const Vec3& mirrored, double scale,
                 color::Rgb* columns) const;

 private:
  double irradiance(const Disc& disc, double cosine) const;

  WeightTable table_;
  std::vector<double> exponents_;
  std::size_t wide_ = 0;  // of them, the lobes that look by themselves
  double coat_index_ = 1;
  bool fresnel_ = false;
};

}  // namespace goniochrome::render
