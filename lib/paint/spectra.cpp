#include "paint/spectra.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "color/illuminant.h"
#include "color/spectrum.h"
#include "paint/curve.h"

namespace goniochrome::paint {

namespace {

// Integrates spectra under one condition. The weights stay those of the last spectrum while the wavelengths do.
class Meter {
 public:
  explicit Meter(color::ViewingCondition condition) : condition_(std::move(condition)) {}

  Result<color::Xyz> xyz(const SpectrumReading& spectrum) {
    if (!colorimeter_ || spectrum.from_nm != from_nm_ || spectrum.step_nm != step_nm_ ||
        spectrum.factors.size() != count_) {
      std::vector<double> wavelengths_nm;
      for (std::size_t i = 0; i < spectrum.factors.size(); ++i)
        wavelengths_nm.push_back(spectrum.from_nm + spectrum.step_nm * static_cast<double>(i));
      GONIO_ASSIGN(colorimeter_, color::SpectralColorimeter::make(wavelengths_nm, condition_));
      from_nm_ = spectrum.from_nm, step_nm_ = spectrum.step_nm, count_ = spectrum.factors.size();
    }
    return colorimeter_->xyz(spectrum.factors);
  }
  // The white of the spectrum that was integrated last.
  const color::Xyz& white() const { return colorimeter_->white(); }

 private:
  color::ViewingCondition condition_;
  std::optional<color::SpectralColorimeter> colorimeter_;
  double from_nm_ = 0, step_nm_ = 0;
  std::size_t count_ = 0;
};

Result<void> check_spectra(const Measurement& measurement, const color::ViewingCondition& condition) {
  if (!measurement.spectra.empty()) return {};
  return input_error("it has no spectra: its readings under {}/{} say nothing about {}/{}",
                     measurement.condition.illuminant, measurement.condition.observer_deg, condition.illuminant,
                     condition.observer_deg);
}

// The responses of CMCCAT2000 [Li, Luo, Rigg and Hunt 2002].
constexpr std::array<Vec3, 3> kCmccat2000 = {Vec3{0.7982, 0.3389, -0.1371}, Vec3{-0.5918, 1.5512, 0.0406},
                                             Vec3{0.0008, 0.0239, 0.9753}};

// The XYZ that looks under the light of `to` as `xyz` does under that of `from`, to eyes that have adapted completely.
color::Xyz corresponding(const color::Xyz& xyz, const color::Xyz& from, const color::Xyz& to) {
  const auto responses = [](const color::Xyz& x) {
    const Vec3 v{x.X, x.Y, x.Z};
    return Vec3{dot(kCmccat2000[0], v), dot(kCmccat2000[1], v), dot(kCmccat2000[2], v)};
  };
  const Vec3 color = responses(xyz), source = responses(from), target = responses(to);
  const Vec3 adapted{color.x * target.x / source.x, color.y * target.y / source.y, color.z * target.z / source.z};
  // The responses are solved for XYZ by Cramer's rule.
  const auto& [r, g, b] = kCmccat2000;
  const Vec3 solution =
      (1 / dot(r, cross(g, b))) * (adapted.x * cross(g, b) + adapted.y * cross(b, r) + adapted.z * cross(r, g));
  return {solution.x, solution.y, solution.z};
}

}  // namespace

Result<color::Lab> lab_of(const SpectrumReading& spectrum, const color::ViewingCondition& condition) {
  Meter meter(condition);
  GONIO_ASSIGN(const color::Xyz xyz, meter.xyz(spectrum));
  return color::lab_from_xyz(xyz, meter.white());
}

Result<Measurement> under_light(const Measurement& measurement, const color::ViewingCondition& stated) {
  const color::ViewingCondition condition = color::condition_of(stated.illuminant, stated.observer_deg);
  GONIO_TRY(check_spectra(measurement, condition));
  Measurement result{condition,        measurement.instrument, {}, measurement.spectra, measurement.textures,
                     measurement.date, measurement.serial};
  Meter meter(condition);
  for (const SpectrumReading& spectrum : measurement.spectra) {
    GONIO_ASSIGN(const color::Xyz xyz, meter.xyz(spectrum));
    result.rows.push_back({spectrum.geometry, color::lab_from_xyz(xyz, meter.white())});
  }
  return Result(std::move(result));
}

Result<Paint> in_light(Paint paint, const color::ViewingCondition& stated) {
  const color::ViewingCondition condition = color::condition_of(stated.illuminant, stated.observer_deg);
  if (!paint.measurement) return input_error("it has no readings, and so nothing tells its color in other light");
  if (paint.measurement->condition == condition) return Result(std::move(paint));
  GONIO_ASSIGN(paint.measurement, under_light(*paint.measurement, condition));
  if (paint.appearance) {
    GONIO_ASSIGN(const AppearanceFit fit, appearance_from_rows(paint.measurement->rows));
    paint.appearance = fit.appearance;
  }
  paint.lobes.reset(), paint.color_map.reset();
  return Result(std::move(paint));
}

Result<std::vector<DifferenceAt>> inconstancy(const Measurement& measurement, const color::ViewingCondition& reference,
                                              const color::ViewingCondition& test,
                                              const color::DifferenceFormula& formula) {
  GONIO_TRY(check_spectra(measurement, test));
  Meter at_reference(reference), at_test(test);
  std::vector<DifferenceAt> result;
  for (const SpectrumReading& spectrum : measurement.spectra) {
    GONIO_ASSIGN(const color::Xyz before, at_reference.xyz(spectrum));
    GONIO_ASSIGN(const color::Xyz after, at_test.xyz(spectrum));
    const color::Xyz& white = at_reference.white();
    result.push_back(
        {spectrum.geometry, color::difference(formula, color::lab_from_xyz(before, white),
                                              color::lab_from_xyz(corresponding(after, at_test.white(), white), white),
                                              aspecular_angle_deg(spectrum.geometry))});
  }
  return Result(std::move(result));
}

Result<std::vector<DifferenceAt>> metamerism(const Measurement& sample, const Measurement& standard,
                                             const color::ViewingCondition& reference,
                                             const color::ViewingCondition& test,
                                             const color::DifferenceFormula& formula) {
  GONIO_TRY(check_spectra(sample, test));
  GONIO_TRY(check_spectra(standard, test));
  Meter at_reference(reference), at_test(test);
  const auto scale = [](double sample_value, double standard_value) {
    if (sample_value == standard_value) return 1.0;
    return sample_value > 0 ? standard_value / sample_value : std::numeric_limits<double>::quiet_NaN();
  };
  std::vector<DifferenceAt> result;
  for (const SpectrumReading& spectrum : sample.spectra) {
    const auto other = std::ranges::find(standard.spectra, spectrum.geometry, &SpectrumReading::geometry);
    if (other == standard.spectra.end()) continue;
    GONIO_ASSIGN(const color::Xyz is, at_reference.xyz(spectrum));
    GONIO_ASSIGN(const color::Xyz should, at_reference.xyz(*other));
    GONIO_ASSIGN(color::Xyz shows, at_test.xyz(spectrum));
    GONIO_ASSIGN(const color::Xyz standard_shows, at_test.xyz(*other));
    shows.X *= scale(is.X, should.X), shows.Y *= scale(is.Y, should.Y), shows.Z *= scale(is.Z, should.Z);
    const color::Xyz& white = at_test.white();
    result.push_back({spectrum.geometry,
                      color::difference(formula, color::lab_from_xyz(standard_shows, white),
                                        color::lab_from_xyz(shows, white), aspecular_angle_deg(spectrum.geometry))});
  }
  return Result(std::move(result));
}

std::optional<SpectrumReading> spectrum_of(const Geometry& geometry, const std::vector<double>& wavelengths_nm,
                                           const std::vector<double>& factors) {
  if (wavelengths_nm.size() < 2 || wavelengths_nm.size() != factors.size()) return std::nullopt;
  const double step = wavelengths_nm[1] - wavelengths_nm[0];
  for (std::size_t i = 0; i < wavelengths_nm.size(); ++i)
    if (std::abs(wavelengths_nm[i] - wavelengths_nm[0] - step * static_cast<double>(i)) > 1e-6 * step)
      return std::nullopt;
  return SpectrumReading{geometry, wavelengths_nm[0], step, factors};
}

}  // namespace goniochrome::paint
