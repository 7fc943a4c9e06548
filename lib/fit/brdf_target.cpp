#include "fit/brdf_target.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "base/angles.h"
#include "paint/curve.h"

namespace goniochrome::fit {

namespace {

const color::ViewingCondition kWorkingCondition = {"D65", 2};

double from_normal_deg(const Vec3& direction) {
  return std::atan2(std::hypot(direction.x, direction.y), direction.z) / kDegree;
}

// The quadrature of albedo_error(): lights, and rings and spokes of viewers about the mirror direction of each.
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

// The spherical triangle of mirror direction, viewer and normal gives the azimuth between light and viewer.
paint::DirectionPair directions_of(const BrdfSample& sample) {
  const double light = sample.light_deg * kDegree, view = sample.view_deg * kDegree;
  const double across = std::sin(light) * std::sin(view);
  const double cosine = across > 0 ? (std::cos(light) * std::cos(view) - std::cos(sample.aspecular_rad)) / across : 1;
  const double azimuth = std::acos(std::clamp(cosine, -1.0, 1.0));
  return {{std::sin(light), 0, std::cos(light)},
          {std::sin(view) * std::cos(azimuth), std::sin(view) * std::sin(azimuth), std::cos(view)}};
}

// r(wi).wo = 2 (n.wi)(n.wo) - wi.wo, and wi.wo = 2 cos^2 - 1 of half the angle.
double half_angle_cosine(const BrdfSample& sample) {
  const double normals = std::cos(sample.light_deg * kDegree) * std::cos(sample.view_deg * kDegree);
  return std::sqrt(std::clamp((1 + 2 * normals - std::cos(sample.aspecular_rad)) / 2, 0.0, 1.0));
}

Result<BrdfTarget> brdf_target(const std::string& name, const brdf::MeasuredBrdf& brdf) {
  BrdfTarget target;
  target.paint.name = name;
  GONIO_ASSIGN(const brdf::ChannelColorimeter meter, brdf::ChannelColorimeter::make(brdf.traits(), kWorkingCondition));
  const color::Xyz white = meter.white();
  for (const paint::DirectionPair& pair : brdf.samples()) {
    brdf::MeasuredValue value = brdf.value(pair.light, pair.view);
    if (!value.measured || value.outside_deg > 0) continue;
    for (double& f : value.f) f *= kPi;
    const color::Lab lab = color::lab_from_xyz(meter.xyz(value.f), white);
    if (!std::isfinite(lab.L + lab.a + lab.b))
      return input_error("{}: its data give a value that is not finite: the file is damaged", name);
    const color::Rgb rgb = color::rgb_from_lab(lab, white);
    target.samples.push_back({paint::aspecular_angle_rad(pair.light, pair.view, {0, 0, 1}), from_normal_deg(pair.light),
                              from_normal_deg(pair.view), rgb});
  }
  if (target.samples.empty()) return input_error("{}: holds no value that a fit could use", name);

  brdf::MeasuredColorOptions options{.geometries = {}, .condition = kWorkingCondition};
  for (const double angle : paint::kExportAngles_deg) options.geometries.push_back({.aspecular_deg = angle});
  GONIO_ASSIGN(const brdf::MeasuredColor color, brdf::measured_color(brdf, options));
  paint::Measurement& measurement = target.paint.measurement.emplace();
  measurement.condition = kWorkingCondition;
  for (const brdf::MeasuredReading& reading : color.readings)
    measurement.rows.push_back({reading.geometry, reading.lab});
  if (measurement.rows.empty()) target.paint.measurement.reset();
  return target;
}

Result<BrdfTarget> read_brdf_target(InputFile& file) {
  std::string bytes;
  for (;;) {
    constexpr std::size_t kPiece = std::size_t{1} << 22;
    GONIO_ASSIGN(const std::size_t count, file.read(bytes, kPiece));
    if (count == 0) break;
  }
  GONIO_ASSIGN(auto brdf, brdf::read_measured(file.name(), bytes));
  const bool is_stream = file.name() == "standard input";
  GONIO_ASSIGN(BrdfTarget target,
               brdf_target(is_stream ? "measured" : std::filesystem::path(file.name()).stem().string(), *brdf));
  target.remarks = brdf::checks(*brdf, kWorkingCondition).warnings;
  target.source = std::move(brdf);
  return target;
}

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
