#include "brdf/lafortune.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/angles.h"

namespace goniochrome::brdf {

// pow(x, n) overflows or vanishes before its factor can bring it back, and inf * 0 is no number. log x near 1 is good
// to an ulp of itself, being exact in its argument; n log x + log scale is at most 745 in size where the result is not
// 0.
double scaled_power(double scale, double x, double exponent) {
  if (!(x > 0) || scale == 0) return 0;
  const double largest = std::log(std::numeric_limits<double>::max());
  const double power = exponent * std::log(x) + std::log(std::abs(scale));
  return std::copysign(std::exp(std::min(power, largest)), scale);
}

namespace {

color::Rgb scaled_color(const color::Rgb& scale, double x, double exponent) {
  return {scaled_power(scale.x, x, exponent), scaled_power(scale.y, x, exponent), scaled_power(scale.z, x, exponent)};
}

}  // namespace

color::Rgb brdf(const Lafortune& surface, const Vec3& to_light, const Vec3& to_viewer) {
  if (to_light.z <= 0 || to_viewer.z <= 0) return {};
  color::Rgb f = surface.diffuse;
  for (const LafortuneLobe& lobe : surface.lobes)
    f += scaled_color(lobe.albedo, dot(lobe.axes * to_viewer, to_light), lobe.exponent);
  return f;
}

void widen(LafortuneLobe& lobe, double factor) {
  const double before = lobe.exponent, after = std::max((before + 1) * factor - 1, 0.5);
  lobe.exponent = after;
  lobe.albedo = ((after + 1) / (before + 1)) * lobe.albedo;
  for (const int axis : {0, 1}) {
    const double ratio = std::abs(lobe.axes[axis] / lobe.axes.z);
    if (lobe.axes.z != 0 && ratio > 1) lobe.axes[axis] *= std::sqrt(1 + (ratio * ratio - 1) * before / after) / ratio;
  }
}

// Normals whose mean has the length r have the variance (1 - r)/r along each axis. A normal that turns by an angle
// turns the middle of a mirroring lobe by twice as much, and others by Cz - Cx along x. 1/(n + 1) grows by their
// variance.
void widen_by_normals(LafortuneLobe& lobe, double mean_length) {
  const Vec3& c = lobe.axes;
  const double longest = std::max({std::abs(c.x), std::abs(c.y), std::abs(c.z)});
  constexpr double kEven = 1 - 1e-6;  // floats hold a unit vector to less
  if (!(longest > 0) || !(mean_length < kEven)) return;
  const double x = (c.z - c.x) / longest, y = (c.z - c.y) / longest;
  const double variance = 0.5 * (x * x + y * y) * (1 - mean_length) / std::max(mean_length, 1e-3);
  widen(lobe, 1 / (1 + (lobe.exponent + 1) * variance));
}

LobeFetch environment_fetch(const LafortuneLobe& lobe, const Vec3& to_viewer) {
  const Vec3 p = lobe.axes * to_viewer;
  const double size = std::hypot(p.x, p.y, p.z);
  if (!(size > 0) || p.z <= 0) return {};
  const double cosine = p.z / size, energy = 2 * kPi / (lobe.exponent + 1);
  return {{p.x / size, p.y / size, cosine}, scaled_color((cosine * energy) * lobe.albedo, size, lobe.exponent)};
}

// A float of a file stands for the number that it was made from, so that such a lobe is looked up in one map.
constexpr double kSameExponent = 1e-6;

ExponentBlend exponent_blend(double exponent, const std::vector<double>& stored) {
  const auto upper = std::upper_bound(stored.begin(), stored.end(), exponent);
  const int last = static_cast<int>(stored.size()) - 1;
  if (upper == stored.begin()) return {0, 0};
  if (upper == stored.end()) return {last, 0};
  const int lower = static_cast<int>(upper - stored.begin()) - 1;
  const double low = stored[static_cast<std::size_t>(lower)];
  if (low <= 0) return {lower, 0};
  const double weight = std::log(exponent / low) / std::log(*upper / low);
  if (weight > 1 - kSameExponent) return {lower + 1, 0};
  return {lower, weight < kSameExponent ? 0 : weight};
}

}  // namespace goniochrome::brdf
