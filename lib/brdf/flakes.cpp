#include "brdf/flakes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "math/elementary.h"

namespace goniochrome::brdf {

namespace {

double chord_between(const Vec3& a, const Vec3& b) {
  return length(a - b);
}

}  // namespace

std::vector<double> flake_shares(const paint::LobeFit& fit) {
  std::vector<double> shares;
  double sum = 0;
  for (const paint::Lobe& lobe : fit.lobes) {
    const double light = lobe.is_mirror() ? 0 : color::luminance(lobe.directional_diffuse);
    shares.push_back(std::max(0.0, light) / (lobe.is_mirror() ? 1 : lobe.exponent + 1));
    sum += shares.back();
  }
  for (double& share : shares) share = sum > 0 ? share / sum : 0;
  return shares;
}

// A disc of radius R has the variance R^2/4 along each axis, and variances add where one spread follows the other.
double shown_radius(double disc_radius_rad, double flake_spread_deg) {
  return std::min(kWidestDisc_rad, math::hypot(disc_radius_rad, 2 * flake_spread_deg * kDegree));
}

FlakeLamp::FlakeLamp(std::vector<Lobe> of_lobes, double of_radius_rad, double spread_deg)
    : lobes(std::move(of_lobes)), radius_rad(of_radius_rad), shown_rad(shown_radius(radius_rad, spread_deg)) {
  for (Lobe& lobe : lobes)
    lobe.lit = disc_lobe_table(lobe.exponent, radius_rad), lobe.shown = disc_lobe_table(lobe.exponent, shown_rad);
}

// (E+1)/(2 pi) cos^E is the density of the directions that flakes show.
double FlakeLamp::part_that_shows(double chord) const {
  const double sine = math::sin(shown_rad);
  double part = 0;
  for (const Lobe& lobe : lobes) {
    const DiscLobeTable::Node node = lobe.shown->at(chord);
    const double power = std::max(0.0F, node.plain[0] + node.plain[1]);
    part += lobe.share * std::min(1.0, 0.5 * (lobe.exponent + 1) * sine * sine * power);
  }
  return std::min(1.0, part);
}

// The box holds as many flakes as the disc and is about as wide as high: it is as wide as a square of the disc's area.
FlakeBox tilts_that_show(const FlakeLamp& lamp, const Vec3& mirrored, const Vec3& across, const Vec3& toward) {
  const double cosine = dot(mirrored, toward), sine = cosine > 0 ? length(cross(mirrored, toward)) : 1,
               part = lamp.part_that_shows(chord_between(mirrored, toward));
  FlakeBox box;
  const double wide = std::sqrt(kPi) * lamp.shown_rad / std::max(1e-9, 2 * kPi * sine);
  box.tilts[1] = std::clamp(wide, std::min(1.0, part), 1.0);
  box.tilts[0] = std::min(1.0, part / box.tilts[1]);
  double middle = 0;
  if (cosine > 0)
    for (const FlakeLamp::Lobe& lobe : lamp.lobes) middle += lobe.share * math::pow(cosine, lobe.exponent + 1);
  box.tilt[0] = std::clamp(middle - 0.5 * box.tilts[0], 0.0, 1 - box.tilts[0]);
  const Vec3 x = across - dot(across, mirrored) * mirrored, y = cross(mirrored, x);
  box.tilt[1] = math::atan2(dot(toward, y), dot(toward, x)) / (2 * kPi) - 0.5 * box.tilts[1] + 1;
  return box;
}

double disc_light(const FlakeLamp& lamp, std::size_t lobe, const Vec3& normal, const Vec3& mirrored, const Vec3& toward,
                  double coat_index) {
  const double cosine = dot(normal, toward);
  if (!(cosine > 0)) return 0;
  const DiscLobeTable::Node node = lamp.lobes[lobe].lit->at(chord_between(mirrored, toward));
  const double gathered =
      node.cosine[0] * disc_irradiance(cosine, lamp.radius_rad) + node.cosine[1] * std::max(0.0, dot(normal, mirrored));
  return kPi * coat_transmission(cosine, coat_index) * std::max(0.0, gathered);
}

double disc_variance(const FlakeLamp& lamp, const Vec3& normal, const Vec3& mirrored, const Vec3& toward) {
  return 1 / std::max(0.0, lamp.part_that_shows(chord_between(mirrored, toward)) * dot(normal, toward));
}

}  // namespace goniochrome::brdf
