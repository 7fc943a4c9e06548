// The lobes of a basis one by one: with light, surface and view fixed, what a point shows is the sum over these columns
// of light times weight. goniochrome-transport(7), "TRANSPORT".
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/result.h"
#include "paint/paint.h"
#include "render/path/traced_paint.h"
#include "render/scene.h"

namespace goniochrome::render {

// The columns of a basis of lobes: K_D, then K_DD and K_G of each exponent, then the mirror.
struct LobeColumns {
  std::vector<double> exponents;  // finite, ascending

  std::size_t count() const { return 2 * exponents.size() + 2; }
  static constexpr std::size_t diffuse() { return 0; }
  static constexpr std::size_t flake(std::size_t lobe) { return 1 + 2 * lobe; }
  static constexpr std::size_t gloss(std::size_t lobe) { return 2 + 2 * lobe; }
  std::size_t mirror() const { return count() - 1; }
  // True if the column is light off the coat: gloss or the mirror.
  bool is_gloss(std::size_t column) const { return column > 0 && (column % 2 == 0 || column == mirror()); }
  // "diffuse", "flake-1.3", "gloss-1.3" or "mirror".
  std::string name(std::size_t column) const;

  bool operator==(const LobeColumns&) const = default;
};

// The columns of the scene: the lobes of its environment, those of its paints where it has none. Error: more lobes than
// kMostTracedLobes.
Result<LobeColumns> lobe_columns(const Scene& scene);

// The weights of a paint's own lobes, or of those at one of its views, in these columns; those of gloss hold at normal
// Fresnel reflectance 1, as light off the coat has its reflectance in it. Error: a lobe that the columns lack, with the
// exponents that they have.
Result<std::vector<color::Rgb>> column_weights(const LobeColumns& columns, const color::Rgb& diffuse,
                                               const std::vector<paint::Lobe>& lobes, double gloss_deg);

// The gray paint by which the noise of a column is judged: K_D and K_DD send half of even light back to a viewer in
// front; gloss and mirror send what Fresnel's equations leave, before a diffuse gray of kNominalGray.
constexpr double kNominalGray = 0.18;
double nominal_weight(const LobeColumns& columns, std::size_t column);

// The columns at one point: what each sends to the viewer from a direction, and directions drawn for all of them.
class LobeKernels {
 public:
  // The arguments must outlive it.
  LobeKernels(const LobeColumns& columns, const PaintedPoint& point);

  // Writes f cos_i of weight 1 for each column, under the coat of the point and the mirror's 0, and returns the density
  // (1/sr) by which drawn() gives the direction. Where the direction is below the horizon both are 0.
  float at(const rays::Float3& to_light, float* values) const;
  // The values integrated over the disc of a lamp that has no place, relative to pi sin^2 of its radius; the mirror's
  // is 0. Whether there is anything above the horizon. `tabled` as in PaintedPoint::toward_disc().
  bool toward_disc(const Light& light, bool tabled, float* values) const;
  // A direction drawn evenly from the cosine and the lobes, by numbers in [0,1). It may lie below the horizon.
  rays::Float3 direction(double choice, double u, double v) const;
  // The coat's Fresnel reflectance to the viewer: what the mirror sends back.
  float mirror() const { return mirror_; }

 private:
  const LobeColumns& columns_;
  const PaintedPoint& point_;
  rays::Frame frame_;
  float mirror_ = 0, axes_total_ = 1;
};

}  // namespace goniochrome::render
