#include "materials/internal/shown.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/angles.h"
#include "brdf/lobe_model.h"

namespace goniochrome::materials {

Vec3 direction(double polar_rad, double azimuth_rad) {
  const double s = std::sin(polar_rad);
  return {s * std::cos(azimuth_rad), s * std::sin(azimuth_rad), std::cos(polar_rad)};
}

const std::vector<paint::Geometry>& compared_geometries() {
  static const std::vector<paint::Geometry> geometries = [] {
    std::vector<paint::Geometry> list;
    for (const double as : {-15, 15, 25, 45, 75, 110}) list.push_back({45, as});
    for (const double as : {-45, -15, 15, 45, 80}) list.push_back({15, as});
    for (const double as : {15, 25, 45, 75, 110}) list.push_back({65, as});
    list.push_back({45, 25, true, 90});
    return list;
  }();
  return geometries;
}

Result<paint::Paint> exported(paint::Paint paint) {
  if (!paint.lobes) return input_error("paint \"{}\" has no lobes: fit it by fit-paint first", paint.name);
  if (paint.gloss.empty()) return paint;
  const double scale = brdf::coat_fresnel(std::cos(brdf::kGlossIncidence_deg * kDegree), paint.gloss.front().angle_deg);
  const auto scale_all = [scale](std::vector<paint::Lobe>& lobes) {
    for (paint::Lobe& lobe : lobes)
      if (!lobe.is_mirror()) lobe.gloss = scale * lobe.gloss;
  };
  scale_all(paint.lobes->lobes);
  for (paint::ViewLobes& view : paint.lobes->views) scale_all(view.lobes);
  return paint;
}

Shown shown(const paint::Paint& paint, const Reflection& target) {
  // The condition of a paint that was read is known.
  const auto white = color::white_point(paint::condition_of(paint));
  const auto seen = [&](const color::Rgb& f) {
    return color::lab_from_rgb(kPi * f, white.ok() ? *white : color::Xyz{});
  };
  const Vec3 normal{0, 0, 1};
  Shown result;
  for (const paint::Geometry& geometry : compared_geometries()) {
    const auto [light, view] = paint::directions(geometry);
    const double de00 =
        color::delta_e_2000(seen(brdf::coated_brdf(*paint.lobes, light, view, normal)), seen(target(light, view)));
    result.by_geometry.push_back({geometry, de00});
    result.de00_mean += de00 / static_cast<double>(compared_geometries().size());
    result.de00_max = std::max(result.de00_max, de00);
  }
  double sum = 0;
  int readings = 0;
  constexpr double kGlare_deg = 10;
  for (const paint::LabReading& row : paint.measurement ? paint.measurement->rows : std::vector<paint::LabReading>()) {
    const auto [light, view] = paint::directions(row.geometry);
    if (paint::aspecular_angle_deg(row.geometry) < kGlare_deg || light.z <= 0 || view.z <= 0) continue;
    sum += color::delta_e_2000(row.lab, seen(target(light, view)));
    ++readings;
  }
  if (readings > 0) result.readings_de00_mean = sum / readings;
  return result;
}

std::vector<FitSample> with_geometries(std::vector<FitSample> samples) {
  double sum = 0;
  for (const FitSample& sample : samples) sum += sample.weight;
  for (FitSample& sample : samples) sample.weight *= 0.5 / sum;
  for (const paint::Geometry& geometry : compared_geometries()) {
    const auto [light, view] = paint::directions(geometry);
    samples.push_back({light, view, 0.5 / static_cast<double>(compared_geometries().size()), {}});
  }
  return samples;
}

std::vector<FitSample> reflected(std::vector<FitSample> samples, const paint::LobeFit& lobes) {
  for (FitSample& sample : samples) sample.f = brdf::coated_brdf(lobes, sample.light, sample.view, {0, 0, 1});
  return samples;
}

std::vector<FitSample> fit_samples(const paint::LobeFit& lobes) {
  static const std::vector<FitSample> directions = [] {
    std::vector<FitSample> list;
    constexpr double kGlare_deg = 13, kAngles_deg[] = {0, 15, 30, 45, 60, 70};
    for (const double view : kAngles_deg)
      for (const double light : kAngles_deg)
        for (const double azimuth : {0, 30, 60, 90, 135, 180}) {
          if (azimuth > 0 && (view == 0 || light == 0)) continue;
          const FitSample sample{direction(light * kDegree, azimuth * kDegree), direction(view * kDegree, 0), 1, {}};
          if (paint::aspecular_angle_rad(sample.light, sample.view, {0, 0, 1}) >= kGlare_deg * kDegree)
            list.push_back(sample);
        }
    return with_geometries(std::move(list));
  }();
  return reflected(directions, lobes);
}

// The light that a lobe K_G cos^E reflects of even light is 2 pi K_G / (E + 1), of which F(45) is Fresnel's. A GGX is
// as wide as the lobe at half of its height where alpha = tan(t/2) / sqrt(sqrt(2) - 1), t = acos(2^(-1/E)).
CoatGloss coat_gloss(const paint::LobeFit& lobes) {
  CoatGloss gloss;
  const double fresnel = brdf::fresnel_dielectric(std::cos(brdf::kGlossIncidence_deg * kDegree), brdf::kCoatIndex);
  double log_alpha = 0;
  for (const paint::Lobe& lobe : lobes.lobes) {
    const double weight = (lobe.gloss.x + lobe.gloss.y + lobe.gloss.z) / 3;
    if (weight <= 0) continue;
    if (lobe.is_mirror()) {
      gloss.mirror += weight;
      continue;
    }
    const double share = 2 * kPi * weight / ((lobe.exponent + 1) * fresnel);
    const double half_width = std::acos(std::exp2(-1 / lobe.exponent));
    gloss.satin += share;
    log_alpha += share * std::log(std::tan(half_width / 2) / std::sqrt(std::sqrt(2) - 1));
  }
  gloss.mirror = std::min(gloss.mirror, 1.0);
  if (gloss.satin > 0) gloss.satin_alpha = std::clamp(std::exp(log_alpha / gloss.satin), 1e-3, 1.0);
  gloss.satin = std::min(gloss.satin, 1 - gloss.mirror);
  return gloss;
}

}  // namespace goniochrome::materials
