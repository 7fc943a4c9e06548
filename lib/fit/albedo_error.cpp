#include "fit/albedo_error.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"

namespace goniochrome::fit {

namespace {

constexpr int kLights = 9, kRings = 60, kSpokes = 30;
constexpr double kLightStep_rad = kPi / 18;

// A direction of the viewer and the solid angle it stands for, both sides of the plane of incidence.
struct Patch {
  Vec3 view;
  double solid_angle_sr;
};

// Rings about the mirror direction, dense near it: the n-th begins at pi (n/rings)^2.
Patch patch_of(const Vec3& light, int ring, int spoke) {
  const double low = static_cast<double>(ring) / kRings, high = static_cast<double>(ring + 1) / kRings;
  const double begin = kPi * low * low, end = kPi * high * high, polar = (begin + end) / 2;
  const double azimuth = kPi * (spoke + 0.5) / kSpokes;
  const Vec3 mirror = {-light.x, 0, light.z}, up = {light.z, 0, light.x}, across = {0, 1, 0};
  return {std::cos(polar) * mirror + std::sin(polar) * (std::cos(azimuth) * up + std::sin(azimuth) * across),
          2 * kPi / kSpokes * (std::cos(begin) - std::cos(end))};
}

}  // namespace

Result<std::optional<double>> albedo_error(const brdf::MeasuredBrdf& measured, const BrdfModel& model) {
  if (measured.traits().format == "cornell") return std::optional<double>();
  GONIO_ASSIGN(const brdf::ChannelColorimeter meter, brdf::ChannelColorimeter::make(measured.traits(), {"D65", 2}));
  double sum = 0;
  for (int k = 0; k < kLights; ++k) {
    const Vec3 light = {std::sin(k * kLightStep_rad), 0, std::cos(k * kLightStep_rad)};
    for (int ring = 0; ring < kRings; ++ring)
      for (int spoke = 0; spoke < kSpokes; ++spoke) {
        const Patch patch = patch_of(light, ring, spoke);
        constexpr double kHorizon = 0.01;  // files divide by this cosine
        if (patch.view.z < kHorizon) continue;
        const brdf::MeasuredValue there = measured.value(light, patch.view);
        if (!there.measured || there.outside_deg > 0) continue;
        const color::Rgb f = color::rec709_from_rec2020(
            color::rgb_from_lab(color::lab_from_xyz(meter.xyz(there.f), meter.white()), meter.white()));
        const color::Rgb g = color::rec709_from_rec2020(model(light, patch.view));
        for (int c = 0; c < 3; ++c) sum += std::abs(g[c] - std::max(f[c], 0.0)) * patch.view.z * patch.solid_angle_sr;
      }
  }
  return std::optional(sum / (3 * kLights));
}

}  // namespace goniochrome::fit
