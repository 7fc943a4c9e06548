#include "brdf/lobe_model.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/coat.h"
#include "math/cosine_power.h"
#include "math/elementary.h"
#include "math/quadrature.h"

namespace goniochrome::brdf {

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

double coat_transmission(double cosine, double coat_index) {
  return 1 - fresnel_dielectric(cosine, coat_index);
}

// With g = sqrt(n^2 - 1 + c^2) the amplitudes are r_s = (c - g)/(c + g) and r_p = (n^2 c - g)/(n^2 c + g), and dg/dc =
// c/g.
CoatedCosine coated_cosine(double cosine, double coat_index) {
  const double c = cosine, n2 = coat_index * coat_index, contrast = (coat_index - 1) * (coat_index + 1);
  const double g2 = contrast + c * c;
  if (contrast == 0 || g2 <= 0) return {contrast == 0 ? c : 0, contrast == 0 ? 1.0 : 0.0, 0};
  const double g = std::sqrt(g2), s = c + g, p = n2 * c + g, bent = c / g;
  const double r_s = (c - g) / s, r_p = (n2 * c - g) / p;
  const double slope_s = 2 * contrast / (g * s * s), slope_p = n2 * 2 * contrast / (g * p * p);
  const double bend_s = -slope_s * (c / g2 + 2 * (1 + bent) / s), bend_p = -slope_p * (c / g2 + 2 * (n2 + bent) / p);
  const double passed = 1 - 0.5 * (r_s * r_s + r_p * r_p);
  const double slope = -(r_s * slope_s + r_p * slope_p);
  const double bend = -(slope_s * slope_s + r_s * bend_s + slope_p * slope_p + r_p * bend_p);
  return {c * passed, passed + c * slope, 2 * slope + c * bend};
}

// The reflectance falls steeply near grazing: x = sqrt(cos) makes it smooth there, and 2 c dc = 4 x^3 dx.
double mean_coat_transmission(double coat_index) {
  static const std::vector<math::QuadraturePoint> points = math::gauss_legendre(24);
  double sum = 0;
  for (const auto& [position, weight] : points) {
    const double x = 0.5 * (1 + position);
    sum += 0.5 * weight * 4 * x * x * x * coat_transmission(x * x, coat_index);
  }
  return sum;
}

namespace {

constexpr double kInstrumentLight_deg = 45;

}  // namespace

double instrument_view_deg(double aspecular_deg) {
  constexpr double kSteepestView_deg = 65;
  return std::min(std::abs(kInstrumentLight_deg - aspecular_deg), kSteepestView_deg);
}

double coat_passages_to_reading(double coat_index, double aspecular_deg, double cos_i, double cos_o) {
  if (coat_index == paint::kNoCoat) return 1;
  return coat_passages(coat_index, std::clamp(cos_i, 0.0, 1.0), std::clamp(cos_o, 0.0, 1.0)) /
         coat_passages(coat_index, math::cos(kInstrumentLight_deg * kDegree),
                       math::cos(instrument_view_deg(aspecular_deg) * kDegree));
}

double coat_passages(double coat_index, double cos_i, double cos_o) {
  return coat_index == paint::kNoCoat ? 1 : coat_transmission(cos_i, coat_index) * coat_transmission(cos_o, coat_index);
}

namespace {

// From where the light falls by which bases under two coats are compared.
constexpr double kBase_deg = 45;

}  // namespace

double base_change(double cos_o, double from_index, double to_index) {
  const double cos_i = math::cos(kBase_deg * kDegree);
  return coat_passages(to_index, cos_i, cos_o) / coat_passages(from_index, cos_i, cos_o);
}

double mirror_change(double cos_o, double from_index, double to_index) {
  return fresnel_dielectric(cos_o, mirror_index(to_index)) / fresnel_dielectric(cos_o, mirror_index(from_index));
}

paint::LobeFit under_coat(const paint::LobeFit& fit, double coat_index) {
  paint::LobeFit other = fit;
  if (coat_index == fit.coat_index) return other;
  other.coat_index = coat_index;
  const double base = base_change(1, coat_index, fit.coat_index),
               mirror = mirror_change(math::cos(kMirrorReading_deg * kDegree), coat_index, fit.coat_index);
  const auto scale = [&](color::Rgb& diffuse, std::vector<paint::Lobe>& lobes) {
    diffuse = base * diffuse;
    for (paint::Lobe& lobe : lobes) {
      lobe.directional_diffuse = base * lobe.directional_diffuse;
      if (lobe.is_mirror()) lobe.gloss = mirror * lobe.gloss;
    }
  };
  scale(other.diffuse, other.lobes);
  for (paint::ViewLobes& view : other.views) scale(view.diffuse, view.lobes);
  return other;
}

namespace {

// The two views around an angle and the share of the upper one.
struct ViewPair {
  const paint::ViewLobes *low, *high;
  double share;
};

ViewPair views_around(const std::vector<paint::ViewLobes>& views, double view_deg) {
  const auto above = std::ranges::upper_bound(views, view_deg, {}, &paint::ViewLobes::view_deg);
  if (above == views.begin()) return {&views.front(), &views.front(), 0};
  if (above == views.end()) return {&views.back(), &views.back(), 0};
  const paint::ViewLobes &low = above[-1], &high = above[0];
  return {&low, &high, (view_deg - low.view_deg) / (high.view_deg - low.view_deg)};
}

// `base_scale` and `gloss_scale` are what a weight of 1 shows.
color::Rgb lobes_at(const color::Rgb& diffuse, const std::vector<paint::Lobe>& lobes, double angle_rad,
                    double base_scale, double gloss_scale) {
  color::Rgb f = base_scale * diffuse;
  const double log_cos = math::log_cosine(angle_rad);
  for (const paint::Lobe& lobe : lobes)
    if (!lobe.is_mirror())
      f += math::power_of_cosine(log_cos, lobe.exponent) *
           (base_scale * lobe.directional_diffuse + gloss_scale * lobe.gloss);
  return f;
}

color::Rgb brdf(const paint::LobeFit& fit, const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal,
                double fresnel) {
  const double cos_i = dot(normal, to_light), cos_o = dot(normal, to_viewer);
  if (cos_i <= 0 || cos_o <= 0) return {};
  const double view_rad = fit.views.empty() ? 0 : math::atan2(length(cross(normal, to_viewer)), cos_o);
  return brdf_by_angles(fit, paint::aspecular_angle_rad(to_light, to_viewer, normal), view_rad / kDegree,
                        coat_passages(fit.coat_index, std::min(cos_i, 1.0), std::min(cos_o, 1.0)), fresnel / cos_i);
}

void add_scaled(const paint::ViewLobes& view, double scale, paint::LobeFit& sum) {
  sum.diffuse += scale * view.diffuse;
  for (const paint::Lobe& lobe : view.lobes) {
    auto at = std::ranges::lower_bound(sum.lobes, lobe.exponent, {}, &paint::Lobe::exponent);
    if (at == sum.lobes.end() || at->exponent != lobe.exponent) at = sum.lobes.insert(at, {lobe.exponent, {}, {}});
    at->directional_diffuse += scale * lobe.directional_diffuse;
    at->gloss += scale * lobe.gloss;
  }
}

}  // namespace

paint::LobeFit at_view(const paint::LobeFit& fit, double view_deg) {
  paint::LobeFit result = fit;
  result.views.clear();
  if (fit.views.empty()) return result;
  result.diffuse = {};
  result.lobes.clear();
  const ViewPair around = views_around(fit.views, view_deg);
  add_scaled(*around.low, 1 - around.share, result);
  if (around.share > 0) add_scaled(*around.high, around.share, result);
  return result;
}

color::Rgb brdf_by_angles(const paint::LobeFit& fit, double aspecular_rad, double view_deg, double base_scale,
                          double gloss_scale) {
  if (fit.views.empty()) return lobes_at(fit.diffuse, fit.lobes, aspecular_rad, base_scale, gloss_scale);
  const auto [low, high, share] = views_around(fit.views, view_deg);
  color::Rgb f = (1 - share) * lobes_at(low->diffuse, low->lobes, aspecular_rad, base_scale, gloss_scale);
  if (share > 0) f += share * lobes_at(high->diffuse, high->lobes, aspecular_rad, base_scale, gloss_scale);
  return f;
}

color::Rgb brdf(const paint::LobeFit& fit, const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal) {
  return brdf(fit, to_light, to_viewer, normal, 1);
}

double coat_fresnel(double cos_half, double gloss_deg) {
  return fresnel_dielectric(std::min(cos_half, 1.0), kCoatIndex) /
         fresnel_dielectric(math::cos(gloss_deg * kDegree), kCoatIndex);
}

color::Rgb coated_brdf(const paint::LobeFit& fit, const Vec3& to_light, const Vec3& to_viewer, const Vec3& normal,
                       double gloss_deg) {
  return brdf(fit, to_light, to_viewer, normal, coat_fresnel(length(to_light + to_viewer) / 2, gloss_deg));
}

color::Rgb flake_reflectance_factor(const paint::LobeFit& fit, double aspecular_deg, double light_deg,
                                    double view_deg) {
  const double passages = coat_passages(fit.coat_index, std::max(0.0, math::cos(light_deg * kDegree)),
                                        std::max(0.0, math::cos(view_deg * kDegree)));
  return kPi * lobes_at(fit.diffuse, fit.lobes, aspecular_deg * kDegree, passages, 0);
}

color::Rgb flake_reflectance_factor(const paint::LobeFit& fit, double aspecular_deg) {
  return flake_reflectance_factor(fit, aspecular_deg, kInstrumentLight_deg, instrument_view_deg(aspecular_deg));
}

}  // namespace goniochrome::brdf
