#include "render/path/lobe_columns.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/text.h"
#include "brdf/lobe_model.h"
#include "math/elementary.h"

namespace goniochrome::render {

namespace {

constexpr double kSame = 1e-6;  // relative, of two exponents

}  // namespace

std::string LobeColumns::name(std::size_t column) const {
  if (column == diffuse()) return "diffuse";
  if (column == mirror()) return "mirror";
  return (column % 2 == 1 ? "flake-" : "gloss-") + shortest(exponents[(column - 1) / 2]);
}

Result<LobeColumns> lobe_columns(const Scene& scene) {
  LobeColumns columns;
  if (scene.env != nullptr) {
    for (const envmap::PrefilteredLobe& lobe : scene.env->lobes) columns.exponents.push_back(lobe.exponent);
  } else {
    columns.exponents = lobe_exponents(scene.paints);
  }
  if (columns.exponents.size() > kMostTracedLobes)
    return input_error("a basis of {} lobes: a transport has at most {}: take a smaller basis",
                       columns.exponents.size(), kMostTracedLobes);
  return columns;
}

Result<std::vector<color::Rgb>> column_weights(const LobeColumns& columns, const color::Rgb& diffuse,
                                               const std::vector<paint::Lobe>& lobes, double gloss_deg) {
  const double gloss_scale = 1 / brdf::fresnel_dielectric(math::cos(gloss_deg * kDegree), brdf::kCoatIndex);
  std::vector<color::Rgb> weights(columns.count());
  weights[LobeColumns::diffuse()] = diffuse;
  for (const paint::Lobe& lobe : lobes) {
    if (lobe.directional_diffuse == color::Rgb{} && lobe.gloss == color::Rgb{}) continue;
    if (lobe.is_mirror()) {
      weights[columns.mirror()] = lobe.gloss;
      continue;
    }
    const auto found = std::ranges::find_if(
        columns.exponents, [&](double e) { return std::abs(e - lobe.exponent) <= kSame * lobe.exponent; });
    if (found == columns.exponents.end()) {
      return input_error(
          "a paint has a lobe of exponent {}, and the transport has those of {}: fit the paint to that basis, or "
          "trace with this one",
          shortest(lobe.exponent), columns.exponents.empty() ? "no lobes" : joined(columns.exponents, ", ", shortest));
    }
    const auto j = static_cast<std::size_t>(found - columns.exponents.begin());
    weights[LobeColumns::flake(j)] = lobe.directional_diffuse;
    weights[LobeColumns::gloss(j)] = gloss_scale * lobe.gloss;
  }
  return weights;
}

// Over the hemisphere of a viewer in front, cos^E cos_i has the integral 2 pi/(E + 2), and cos^E has 2 pi/(E + 1).
double nominal_weight(const LobeColumns& columns, std::size_t column) {
  constexpr double kHalf = 0.5, kTwoPi = 2 * kPi;
  if (column == LobeColumns::diffuse()) return kHalf / kPi;
  if (column == columns.mirror()) return 1;
  const double exponent = columns.exponents[(column - 1) / 2];
  return columns.is_gloss(column) ? (exponent + 1) / kTwoPi : kHalf * (exponent + 2) / kTwoPi;
}

}  // namespace goniochrome::render
