#include "brdf/lobe_model.h"

#include <algorithm>
#include <cmath>

namespace goniochrome {

// pow(cos x, E) multiplies the relative error of cos x, half an ulp, by E: 1e-10 at E = 1e6. exp(E log cos x) needs
// log cos x to a few ulp of ITSELF: below 45 deg by log1p(-sin^2)/2, where sin^2 <= 1/2 keeps its digits; above, cos x
// is at most 0.71 and its logarithm is well conditioned. Where the power is not 0 in double precision the exponent is
// at most 745 in size, so that the few ulp become at most 5e-13.
double cos_power(double angle_rad, double exponent) {
  const double angle = std::abs(angle_rad);
  if (angle >= M_PI / 2) return 0;
  if (exponent == 0) return 1;
  const double s = std::sin(angle);
  const double log_cos = s * s <= 0.5 ? 0.5 * std::log1p(-s * s) : std::log(std::cos(angle));
  return std::exp(exponent * log_cos);
}

double cos_power_from_versine(double versine, double exponent) {
  if (versine >= 1) return 0;
  if (exponent == 0) return 1;
  return std::exp(exponent * std::log1p(-versine));
}

// With g = n cos_t = sqrt(n^2 - 1 + c^2) the amplitude ratios are
//
//   r_s = (c - g)/(c + g)            = -(n^2 - 1) / (c + g)^2
//   r_p = (n^2 c - g)/(n^2 c + g)    =  (n^2 - 1) ((n^2 + 1) c^2 - 1) / (n^2 c + g)^2
//
// and the right-hand forms do not cancel as n -> 1, where both are exactly 0.
double fresnel_dielectric(double cos_i, double index) {
  const double n2 = index * index, contrast = (index - 1) * (index + 1);
  if (contrast == 0) return 0;
  const double g2 = contrast + cos_i * cos_i;
  if (g2 <= 0) return 1;  // total reflection
  const double g = std::sqrt(g2), s = cos_i + g, p = n2 * cos_i + g;
  const double r_s = contrast / (s * s), r_p = contrast * ((n2 + 1) * cos_i * cos_i - 1) / (p * p);
  return 0.5 * (r_s * r_s + r_p * r_p);
}

namespace {

// The two views around an angle and the share of the upper one.
struct ViewPair {
  const ViewLobes *low, *high;
  double share;
};

ViewPair views_around(const std::vector<ViewLobes>& views, double view_deg) {
  const auto above = std::ranges::upper_bound(views, view_deg, {}, &ViewLobes::view_deg);
  if (above == views.begin()) return {&views.front(), &views.front(), 0};
  if (above == views.end()) return {&views.back(), &views.back(), 0};
  const ViewLobes &low = above[-1], &high = above[0];
  return {&low, &high, (view_deg - low.view_deg) / (high.view_deg - low.view_deg)};
}

Rgb lobes_at(const Rgb& diffuse, const std::vector<Lobe>& lobes, double angle_rad, double cos_i) {
  Rgb f = diffuse;
  for (const Lobe& lobe : lobes)
    if (std::isfinite(lobe.exponent))
      f += cos_power(angle_rad, lobe.exponent) * (lobe.directional_diffuse + (1 / cos_i) * lobe.gloss);
  return f;
}

void add_scaled(const ViewLobes& view, double scale, LobeFit& sum) {
  sum.diffuse += scale * view.diffuse;
  for (const Lobe& lobe : view.lobes) {
    auto at = std::ranges::lower_bound(sum.lobes, lobe.exponent, {}, &Lobe::exponent);
    if (at == sum.lobes.end() || at->exponent != lobe.exponent) at = sum.lobes.insert(at, {lobe.exponent, {}, {}});
    at->directional_diffuse += scale * lobe.directional_diffuse;
    at->gloss += scale * lobe.gloss;
  }
}

}  // namespace

LobeFit at_view(const LobeFit& fit, double view_deg) {
  LobeFit result = fit;
  result.views.clear();
  if (fit.views.empty()) return result;
  result.diffuse = {};
  result.lobes.clear();
  const ViewPair around = views_around(fit.views, view_deg);
  add_scaled(*around.low, 1 - around.share, result);
  if (around.share > 0) add_scaled(*around.high, around.share, result);
  return result;
}

Rgb brdf(const LobeFit& fit, const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal) {
  const double cos_i = dot(normal, to_light);
  if (cos_i <= 0 || dot(normal, to_viewer) <= 0) return {};
  const double angle_rad = aspecular_angle_rad(to_light, to_viewer, normal);
  if (fit.views.empty()) return lobes_at(fit.diffuse, fit.lobes, angle_rad, cos_i);
  const double view_rad = std::atan2(length(cross(normal, to_viewer)), dot(normal, to_viewer));
  const auto [low, high, share] = views_around(fit.views, view_rad * (180 / M_PI));
  Rgb f = (1 - share) * lobes_at(low->diffuse, low->lobes, angle_rad, cos_i);
  if (share > 0) f += share * lobes_at(high->diffuse, high->lobes, angle_rad, cos_i);
  return f;
}

Rgb flake_reflectance_factor(const LobeFit& fit, double aspecular_deg) {
  const double angle_rad = aspecular_deg * (M_PI / 180);
  Rgb f = fit.diffuse;
  for (const Lobe& lobe : fit.lobes)
    if (std::isfinite(lobe.exponent)) f += cos_power(angle_rad, lobe.exponent) * lobe.directional_diffuse;
  return M_PI * f;
}

}  // namespace goniochrome
