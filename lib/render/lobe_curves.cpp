#include "render/lobe_curves.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>
#include <tuple>

#include "brdf/lobe_model.h"
#include "math/quadrature.h"

namespace goniochrome {

namespace {

constexpr int kPolar = 24, kAround = 8;

// The part of the ring at angle t from the mirror direction that is above the horizon, as half its azimuth: n.w =
// a + b cos p with a = cos t cos_o, b = sin t sin_o.
double half_arc(double a, double b) {
  if (a >= b) return std::numbers::pi;
  return a <= -b ? 0 : std::acos(-a / b);
}

}  // namespace

// The lobe's own measure is made even by u = cos^(E+1) t, du = -(E+1) cos^E t sin t dt:
//
//   integral cos^E g dw = 1/(E+1) integral_0^1 du  integral_0^2pi g dp
//
// Around the ring, n.w integrates in closed form. The Fresnel reflectance wants the angle between light and viewer; the
// viewer is the mirror image of the lobe's axis, so that wo.w = cos t cos 2o + sin t sin 2o cos p.
LobeIntegrals lobe_integrals(double exponent, double cos_o, bool horizon) {
  const double whole = 2 * std::numbers::pi / (exponent + 1);
  if (!horizon) return {whole * cos_o, whole, whole * fresnel_dielectric(cos_o, kCoatIndex)};
  static const std::vector<QuadraturePoint> points = gauss_legendre(kPolar);
  const double sin_o = std::sqrt(std::max(0.0, 1 - cos_o * cos_o));
  const double cos_2o = 2 * cos_o * cos_o - 1, sin_2o = 2 * sin_o * cos_o;
  LobeIntegrals sum;
  for (const QuadraturePoint& point : points) {
    const double weight = 0.5 * point.weight;
    const double cos_t = std::pow(0.5 * (1 + point.position), 1 / (exponent + 1));
    const double sin_t = std::sqrt(std::max(0.0, 1 - cos_t * cos_t));
    const double a = cos_t * cos_o, b = sin_t * sin_o, arc = half_arc(a, b);
    sum.cosine += weight * 2 * (a * arc + b * std::sin(arc));
    sum.plain += weight * 2 * arc;
    for (int i = 0; i < kAround; ++i) {
      const double cos_between = cos_t * cos_2o + sin_t * sin_2o * std::cos(arc * (i + 0.5) / kAround);
      const double cos_half = std::sqrt(std::clamp(0.5 * (1 + cos_between), 0.0, 1.0));
      sum.fresnel += weight * 2 * arc / kAround * fresnel_dielectric(cos_half, kCoatIndex);
    }
  }
  const double scale = 1 / (exponent + 1);
  return {scale * sum.cosine, scale * sum.plain, scale * sum.fresnel};
}

const std::vector<LobeIntegrals>& lobe_curve(double exponent, int segments, bool horizon) {
  static std::map<std::tuple<double, int, bool>, std::vector<LobeIntegrals>> curves;
  static std::mutex mutex;
  const std::scoped_lock lock(mutex);
  std::vector<LobeIntegrals>& curve = curves[{exponent, segments, horizon}];
  for (int i = static_cast<int>(curve.size()); i <= segments; ++i) {
    const double x = static_cast<double>(i) / segments;
    curve.push_back(lobe_integrals(exponent, x * x, horizon));
  }
  return curve;
}

}  // namespace goniochrome
