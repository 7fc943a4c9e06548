#include "brdf/highlight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/angles.h"
#include "brdf/disc_light.h"
#include "brdf/gloss.h"
#include "math/elementary.h"

namespace goniochrome::brdf {

namespace {

// The exponent of the lobe whose highlight under a disc of this radius falls to half at this angle: of
// cos^e(edge) = 1/2 under a point, and by bisection under a disc. An edge within the disc is that of a mirror.
double edge_exponent(double edge_rad, double radius_rad) {
  constexpr double kSharpest = 1e6;
  const double sine = math::sin(edge_rad);
  const double of_point = std::numbers::ln2 / std::max(-0.5 * math::log1p(-sine * sine), 1e-12);
  if (!(radius_rad > 0)) return std::min(kSharpest, of_point);
  const auto falls_before = [&](double exponent) {
    return lobe_of_disc(exponent, radius_rad, edge_rad).power < 0.5 * lobe_of_disc(exponent, radius_rad, 0).power;
  };
  double low = std::min(kSharpest, of_point), high = kSharpest;
  if (!falls_before(high)) return kSharpest;
  for (int i = 0; i < 60; ++i) {
    const double middle = std::sqrt(low * high);
    (falls_before(middle) ? high : low) = middle;
  }
  return std::sqrt(low * high);
}

}  // namespace

// The highlight falls to half at the edge, which gives the exponent of a single lobe. The total energy of the lobe is
// the Fresnel reflectance of the coat; see goniochrome-coats(7), "GLOSS".
Result<double> gloss_of_edge(double edge_deg, double meter_deg, double extent_deg) {
  const double exponent = edge_exponent(std::clamp(edge_deg, 0.0, 89.0) * kDegree, 0.5 * extent_deg * kDegree);
  const double energy = fresnel_dielectric(math::cos(meter_deg * kDegree), kCoatIndex);
  const double weight = energy * (exponent + 1) / (2 * kPi);
  const GlossTable table({exponent});
  GONIO_ASSIGN(const GlossColumns* meter, table.at(meter_deg));
  paint::LobeFit lobe;
  lobe.lobes.push_back({exponent, {}, {weight, weight, weight}});
  return std::clamp(gloss_units(table, *meter, lobe), 0.0, 100.0);
}

// Brightness falls with the angle, so that bisection finds the half of it. The mirror shows the disc and nothing
// beyond.
double highlight_edge_deg(const paint::LobeFit& fit, double extent_deg) {
  const double radius = 0.5 * extent_deg * kDegree;
  const auto brightness = [&](double angle_rad) {
    double sum = 0;
    for (const paint::Lobe& lobe : fit.lobes) {
      const double weight = color::luminance(lobe.gloss);
      if (!lobe.is_mirror())
        sum += weight * lobe_of_disc(lobe.exponent, radius, angle_rad).power;
      else if (angle_rad <= radius)
        sum += weight * disc_radiance(radius);
    }
    return sum;
  };
  const double half = 0.5 * brightness(0);
  if (!(half > 0)) return 0;
  double low = 0, high = kPi / 2;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (brightness(middle) > half ? low : high) = middle;
  }
  return high / kDegree;
}

}  // namespace goniochrome::brdf
