#include "render/internal/lobe_curves.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/angles.h"
#include "base/kept_values.h"
#include "brdf/lobe_model.h"
#include "math/elementary.h"
#include "math/quadrature.h"

namespace goniochrome::render {

namespace {

constexpr int kPolar = 24, kAround = 8, kAroundCoat = 16;

// The first moment of what is gathered: along r, and along e, the direction across r toward the normal.
struct Moment {
  double along = 0, across = 0;

  // With n = cos_o r + sin_o e, the multiple of n that is added to r.
  double shift(double cos_o, double sin_o) const {
    const double toward = across / sin_o;
    return toward / (along - cos_o * toward);
  }
};

}  // namespace

double half_arc(double a, double b) {
  if (a >= b) return kPi;
  return a <= -b ? 0 : math::acos(-a / b);
}

// The lobe's own measure is made even by u = cos^(E+1) t, du = -(E+1) cos^E t sin t dt:
//
//   integral cos^E g dw = 1/(E+1) integral_0^1 du  integral_0^2pi g dp
//
// Around the ring, n.w and the moments integrate in closed form, w = cos t r + sin t cos p e + ... The Fresnel
// reflectance wants the angle between light and viewer; the viewer is the mirror image of the lobe's axis, so that wo.w
// = cos t cos 2o + sin t sin 2o cos p.
LobeIntegrals lobe_integrals(double exponent, double cos_o, bool horizon, double coat_index) {
  const double whole = 2 * kPi / (exponent + 1);
  if (!horizon)
    return {whole * cos_o * brdf::coat_transmission(cos_o, coat_index), whole,
            whole * brdf::fresnel_dielectric(cos_o, brdf::kCoatIndex)};
  static const std::vector<math::QuadraturePoint> points = math::gauss_legendre(kPolar);
  const double sin_o = std::sqrt(std::max(1e-8, 1 - cos_o * cos_o));  // along the normal the shift has a limit
  const double cos_2o = 2 * cos_o * cos_o - 1, sin_2o = 2 * sin_o * cos_o;
  LobeIntegrals sum;
  Moment cosine, plain;
  for (const math::QuadraturePoint& point : points) {
    const double weight = 0.5 * point.weight;
    const double cos_t = math::pow(0.5 * (1 + point.position), 1 / (exponent + 1));
    const double sin_t = std::sqrt(std::max(0.0, 1 - cos_t * cos_t));
    const double a = cos_t * cos_o, b = sin_t * sin_o, arc = half_arc(a, b);
    const double chord = math::sin(arc), with_cosine = weight * 2 * (a * arc + b * chord);
    sum.plain += weight * 2 * arc;
    if (coat_index == paint::kNoCoat) {
      sum.cosine += with_cosine;
      cosine.along += cos_t * with_cosine;
      cosine.across += sin_t * weight * (2 * a * chord + b * (arc + chord * math::cos(arc)));
    }
    for (int i = 0; coat_index != paint::kNoCoat && i < kAroundCoat; ++i) {
      const double cos_p = math::cos(arc * (i + 0.5) / kAroundCoat), c = std::clamp(a + b * cos_p, 0.0, 1.0);
      const double let_in = weight * 2 * arc / kAroundCoat * c * brdf::coat_transmission(c, coat_index);
      sum.cosine += let_in;
      cosine.along += cos_t * let_in;
      cosine.across += sin_t * cos_p * let_in;
    }
    plain.along += cos_t * weight * 2 * arc;
    plain.across += sin_t * weight * 2 * chord;
    for (int i = 0; i < kAround; ++i) {
      const double cos_between = cos_t * cos_2o + sin_t * sin_2o * math::cos(arc * (i + 0.5) / kAround);
      const double cos_half = std::sqrt(std::clamp(0.5 * (1 + cos_between), 0.0, 1.0));
      sum.fresnel += weight * 2 * arc / kAround * brdf::fresnel_dielectric(cos_half, brdf::kCoatIndex);
    }
  }
  const double scale = 1 / (exponent + 1);
  return {scale * sum.cosine, scale * sum.plain, scale * sum.fresnel, cosine.shift(cos_o, sin_o),
          plain.shift(cos_o, sin_o)};
}

std::shared_ptr<const LobeCurve> lobe_curve(double exponent, int segments, bool horizon, double coat_index) {
  static KeptValues<std::tuple<double, int, bool, double>, LobeCurve> kept;
  return kept.get({exponent, segments, horizon, coat_index}, [&] {
    LobeCurve curve;
    for (int i = 0; i <= segments; ++i) {
      const double x = static_cast<double>(i) / segments;
      curve.push_back(lobe_integrals(exponent, x * x, horizon, coat_index));
    }
    return curve;
  });
}

}  // namespace goniochrome::render
