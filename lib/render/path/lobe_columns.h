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

}  // namespace goniochrome::render
