#include "materials/internal/seen_paint.h"

#include <cmath>

#include "base/angles.h"
#include "materials/internal/ggx.h"
#include "math/cosine_power.h"

namespace goniochrome::materials {

namespace {

// Linear between two views, and constant beyond the ends.
paint::BandWeights weights_at(const paint::BandLobes& lobes, double view_deg) {
  const auto above = std::ranges::upper_bound(lobes.views, view_deg, {}, &paint::BandWeights::view_deg);
  if (above == lobes.views.begin()) return lobes.views.front();
  if (above == lobes.views.end()) return lobes.views.back();
  const paint::BandWeights &low = above[-1], &high = above[0];
  const double share = (view_deg - low.view_deg) / (high.view_deg - low.view_deg);
  paint::BandWeights mixed = low;
  const auto mix = [share](color::Bands& a, const color::Bands& b) {
    for (std::size_t k = 0; k < a.size(); ++k) a[k] = std::lerp(a[k], b[k], share);
  };
  mix(mixed.diffuse, high.diffuse);
  mix(mixed.mirror, high.mirror);
  for (std::size_t e = 0; e < lobes.exponents.size(); ++e) {
    mix(mixed.directional_diffuse[e], high.directional_diffuse[e]);
    mix(mixed.gloss[e], high.gloss[e]);
  }
  return mixed;
}

}  // namespace

// A direction below the horizon, raised to it; others stay.
Vec3 raised(const Vec3& light) {
  constexpr double kLowest = 1e-3;
  if (light.z >= kLowest) return light;
  const double across = std::hypot(light.x, light.y), level = std::sqrt(1 - kLowest * kLowest);
  if (across < 1e-9) return {level, 0, kLowest};  // straight down
  return {light.x * level / across, light.y * level / across, kLowest};
}

SeenRgb::SeenRgb(const paint::LobeFit& lobes, double view_rad) : SeenPaint(lobes.coat_index, view_rad), lobes_(lobes) {
  for (const paint::Lobe& lobe : brdf::at_view(lobes, view_rad / kDegree).lobes)
    if (lobe.is_mirror()) mirror_ = lobe.gloss;
}

SeenRgb::Values SeenRgb::values(const Vec3& light, double mirror) const {
  const color::Rgb rgb =
      color::rec709_from_rec2020(light.z * brdf::coated_brdf(lobes_, light, view(), {0, 0, 1}) + mirror * mirror_);
  return {rgb.x, rgb.y, rgb.z};
}

SeenBands::SeenBands(const paint::BandLobes& lobes, double view_rad)
    : SeenPaint(lobes.coat_index, view_rad), lobes_(lobes), weights_(weights_at(lobes, view_rad / kDegree)) {}

color::Bands SeenBands::without_mirror(const Vec3& light) const {
  return color::scaled(1 / light.z, values(light, 0));
}

// f cos(theta_light) = cos T T (K_D + sum K_DD cos^E) + F(theta_h)/F(45) sum K_G cos^E, band by band.
SeenBands::Values SeenBands::values(const Vec3& light, double mirror) const {
  const double base = light.z * brdf::coat_passages(lobes_.coat_index, std::min(light.z, 1.0), view().z);
  const double gloss = brdf::coat_fresnel(half_cosine(light, view()));
  const double log_cos = math::log_cosine(paint::aspecular_angle_rad(light, view(), {0, 0, 1}));
  Values sum{};
  const auto add = [&sum](double scale, const color::Bands& weights) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += scale * weights[k];
  };
  add(base, weights_.diffuse);
  add(mirror, weights_.mirror);
  for (std::size_t e = 0; e < lobes_.exponents.size(); ++e) {
    const double power = math::power_of_cosine(log_cos, lobes_.exponents[e]);
    add(base * power, weights_.directional_diffuse[e]);
    add(gloss * power, weights_.gloss[e]);
  }
  return sum;
}

}  // namespace goniochrome::materials
