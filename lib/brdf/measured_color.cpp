// Readings that a multi-angle instrument would have made: reflectance factor pi f, then Lab.
// goniochrome-fitting(7), "MEASURED BRDFS".
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/measured.h"

namespace goniochrome::brdf {

namespace {

// A detector's directions and weights: the center, or seven points whose mean over a disc is exact for polynomials to
// degree 5 (Stroud, S2: 5-1).
struct ApertureSample {
  Vec3 view;
  double weight;
};
std::vector<ApertureSample> aperture_samples(const Vec3& view, double aperture_deg) {
  if (aperture_deg == 0) return {{view, 1}};
  const double radius = std::tan(aperture_deg / 2 * kDegree) * std::sqrt(2.0 / 3);
  const Vec3 other = std::abs(view.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0};
  const Vec3 across = normalized(cross(other, view)), up = cross(view, across);
  std::vector<ApertureSample> samples = {{view, 0.25}};
  for (int k = 0; k < 6; ++k) {
    const double turn = k * kPi / 3;
    samples.push_back({normalized(view + (radius * std::cos(turn)) * across + (radius * std::sin(turn)) * up), 0.125});
  }
  return samples;
}

// The aperture's mean value; `measured` is false where any of it is not.
Result<MeasuredValue> seen_value(const MeasuredBrdf& brdf, const paint::Geometry& geometry, double aperture_deg) {
  const paint::DirectionPair pair = paint::directions(geometry);
  MeasuredValue mean;
  for (const ApertureSample& sample : aperture_samples(pair.view, aperture_deg)) {
    if (pair.light.z <= 0 || sample.view.z <= 0)
      return input_error("geometry {} looks from below the surface{}", paint::geometry_name(geometry),
                         aperture_deg > 0 ? ", at least with a part of its aperture" : "");
    const MeasuredValue value = brdf.value(pair.light, sample.view);
    mean.f.resize(value.f.size());
    for (std::size_t k = 0; k < value.f.size(); ++k) mean.f[k] += sample.weight * value.f[k];
    mean.gap_deg = std::max(mean.gap_deg, value.gap_deg);
    mean.outside_deg = std::max(mean.outside_deg, value.outside_deg);
    mean.measured = mean.measured && value.measured;
  }
  return mean;
}

}  // namespace

Result<ChannelColorimeter> ChannelColorimeter::make(const MeasuredTraits& traits,
                                                    const color::ViewingCondition& condition) {
  ChannelColorimeter result;
  if (traits.wavelengths_nm.empty()) {
    if (condition != color::ViewingCondition{"D65", 2})
      return input_error("its RGB is what the 2 deg observer sees under D65: {}/{} would need spectra",
                         condition.illuminant, condition.observer_deg);
    return result;
  }
  GONIO_ASSIGN(result.meter_, color::SpectralColorimeter::make(traits.wavelengths_nm, condition));
  return result;
}

color::Xyz ChannelColorimeter::xyz(const std::vector<double>& reflectance) const {
  if (meter_) return meter_->xyz(reflectance);
  return color::xyz_d65_from_rgb(color::rec2020_from_rec709({reflectance[0], reflectance[1], reflectance[2]}));
}

bool take_off_noise(const MeasuredTraits& traits, std::vector<double>& factors) {
  if (traits.wavelengths_nm.empty() && !traits.noisy) return false;
  bool noise = false;
  for (double& factor : factors) noise = noise || factor < 0, factor = std::max(factor, 0.0);
  return noise;
}

Result<MeasuredColor> measured_color(const MeasuredBrdf& brdf, const MeasuredColorOptions& options) {
  GONIO_ASSIGN(const ChannelColorimeter color, ChannelColorimeter::make(brdf.traits(), options.condition));
  MeasuredColor result{options.condition, color.held_share(), {}, {}};
  for (const paint::Geometry& geometry : options.geometries) {
    GONIO_ASSIGN(MeasuredValue value, seen_value(brdf, geometry, options.aperture_deg));
    if (!value.measured) {
      result.unmeasured.push_back(geometry);
      continue;
    }
    MeasuredReading reading{geometry, {}, {}, value.gap_deg, value.outside_deg};
    for (double& f : value.f) f *= kPi;
    reading.negative = take_off_noise(brdf.traits(), value.f);
    reading.factors = value.f;
    const color::Xyz xyz = color.xyz(value.f);
    reading.noise = xyz.Y < options.noise_floor;
    reading.lab = color::lab_from_xyz(xyz, color.white());
    if (!std::isfinite(reading.lab.L + reading.lab.a + reading.lab.b))
      return input_error("its data give no finite value at {}: the file is damaged", paint::geometry_name(geometry));
    // Paints with such values are not read.
    if (std::max({std::abs(reading.lab.L), std::abs(reading.lab.a), std::abs(reading.lab.b)}) > 1e4)
      return input_error("its data give a CIELAB value beyond 10000 at {}: the file is damaged",
                         paint::geometry_name(geometry));
    result.readings.push_back(reading);
  }
  return result;
}

}  // namespace goniochrome::brdf
