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

// Near the normal the shift has a limit.
double sine_of(double cos_o) {
  return std::sqrt(std::max(1e-8, 1 - cos_o * cos_o));
}

// With n = cos_o r + sin_o e, the multiple of n that is added to r: the first moment of the light lies along r and e.
double shift_of(double along, double across, double cos_o) {
  const double toward = across / sine_of(cos_o);
  return toward / (along - cos_o * toward);
}

}  // namespace

// The lobe's own measure is made even by u = cos^(E+1) t, du = -(E+1) cos^E t sin t dt:
//
//   integral cos^E g dw = 1/(E+1) integral_0^1 du  integral_0^2pi g dp
//
// On the ring w = cos t r + sin t cos p e + ..., n.w = a + b cos p is positive for |p| < acos(-a/b). The viewer is the
// mirror image of the lobe's axis, so that wo.w = cos t cos 2o + sin t sin 2o cos p.
std::vector<LobeSample> lobe_samples(double exponent, double cos_o, double coat_index) {
  static const std::vector<math::QuadraturePoint> polar = math::gauss_legendre(24), around = math::gauss_legendre(12);
  const double sin_o = sine_of(cos_o), cos_2o = 2 * cos_o * cos_o - 1, sin_2o = 2 * sin_o * cos_o;
  std::vector<LobeSample> samples;
  for (const math::QuadraturePoint& ring : polar) {
    const double cos_t = math::pow(0.5 * (1 + ring.position), 1 / (exponent + 1));
    const double sin_t = std::sqrt(std::max(0.0, 1 - cos_t * cos_t));
    const double a = cos_t * cos_o, b = sin_t * sin_o;
    if (a <= -b) continue;
    const double arc = a >= b ? kPi : math::acos(-a / b);
    for (const math::QuadraturePoint& part : around) {
      const double weight = 0.5 * ring.weight * arc * part.weight / (exponent + 1);
      const double cos_p = math::cos(0.5 * arc * (1 + part.position)), c = std::clamp(a + b * cos_p, 0.0, 1.0);
      const double cos_between = cos_t * cos_2o + sin_t * sin_2o * cos_p;
      const double cos_half = std::sqrt(std::clamp(0.5 * (1 + cos_between), 0.0, 1.0));
      samples.push_back({cos_t, sin_t * cos_p, weight * c * brdf::coat_transmission(c, coat_index), weight,
                         weight * brdf::fresnel_dielectric(cos_half, brdf::kCoatIndex)});
    }
  }
  return samples;
}

LobeIntegrals lobe_integrals(double exponent, double cos_o, bool horizon, double coat_index) {
  const double whole = 2 * kPi / (exponent + 1);
  if (!horizon)
    return {whole * cos_o * brdf::coat_transmission(cos_o, coat_index), whole,
            whole * brdf::fresnel_dielectric(cos_o, brdf::kCoatIndex)};
  LobeIntegrals sum;
  double along_cosine = 0, across_cosine = 0, along_plain = 0, across_plain = 0;
  for (const LobeSample& sample : lobe_samples(exponent, cos_o, coat_index)) {
    sum.cosine += sample.cosine, sum.plain += sample.plain, sum.fresnel += sample.fresnel;
    along_cosine += sample.along * sample.cosine, across_cosine += sample.across * sample.cosine;
    along_plain += sample.along * sample.plain, across_plain += sample.across * sample.plain;
  }
  sum.cosine_shift = shift_of(along_cosine, across_cosine, cos_o);
  sum.plain_shift = shift_of(along_plain, across_plain, cos_o);
  return sum;
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
