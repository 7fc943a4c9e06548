#include "color/bands.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "color/spectrum.h"

namespace goniochrome::color {

namespace {

std::vector<double> band_wavelengths_nm() {
  std::vector<double> all;
  for (int b = 0; b < kBands; ++b) all.push_back(band_nm(b));
  return all;
}

Result<void> check(std::span<const double> wavelengths_nm, std::span<const double> values) {
  if (wavelengths_nm.size() < 2 || values.size() != wavelengths_nm.size())
    return input_error("a spectrum needs at least two wavelengths, and a value for each");
  if (!std::is_sorted(wavelengths_nm.begin(), wavelengths_nm.end(), std::less_equal<>()))
    return input_error("wavelengths must ascend");
  if (!std::ranges::all_of(values, [](double v) { return std::isfinite(v); }))
    return input_error("a value of the spectrum is not finite");
  return {};
}

// Along straight lines between the wavelengths, 0 beyond them.
double linear(std::span<const double> wavelengths_nm, std::span<const double> values, double nm) {
  if (nm < wavelengths_nm.front() || nm > wavelengths_nm.back()) return 0;
  const auto above = std::upper_bound(wavelengths_nm.begin(), wavelengths_nm.end(), nm);
  const auto i = std::clamp<std::ptrdiff_t>(above - wavelengths_nm.begin(), 1,
                                            static_cast<std::ptrdiff_t>(wavelengths_nm.size()) - 1);
  const auto high = static_cast<std::size_t>(i), low = high - 1;
  const double share = (nm - wavelengths_nm[low]) / (wavelengths_nm[high] - wavelengths_nm[low]);
  return std::lerp(values[low], values[high], share);
}

// The power in each band, every nanometer of it weighed as a triangle; at the ends of the range half a triangle.
Bands power_in_bands(const std::function<double(double nm)>& power) {
  Bands bands{};
  for (int b = 0; b < kBands; ++b) {
    double sum = 0, weights = 0;
    for (double shift = 1 - kBandStep_nm; shift < kBandStep_nm; ++shift) {
      const double nm = band_nm(b) + shift, weight = 1 - std::abs(shift) / kBandStep_nm;
      if (nm < kFirstBand_nm || nm > band_nm(kBands - 1)) continue;
      sum += weight * power(nm), weights += weight;
    }
    bands[static_cast<std::size_t>(b)] = sum / weights;
  }
  return bands;
}

// Relative to daylight, luminance 1.
Result<Bands> light_of(const Bands& power) {
  static const Bands kDaylight = power_in_bands([](double nm) { return *illuminant_power(nm, "D65"); });
  GONIO_ASSIGN(const BandObserver eye, BandObserver::make());
  Bands relative{};
  for (std::size_t b = 0; b < relative.size(); ++b) relative[b] = power[b] / kDaylight[b];
  const double luminance = xyz_d65_from_rgb(eye.rgb(relative)).Y / xyz_d65_from_rgb({1, 1, 1}).Y;
  if (!(luminance > 0)) return input_error("a light without power between 400 and 700 nm");
  return scaled(1 / luminance, relative);
}

}  // namespace

Bands even_bands(double value) {
  Bands bands;
  bands.fill(value);
  return bands;
}

double mean(const Bands& bands) {
  double sum = 0;
  for (const double value : bands) sum += value;
  return sum / kBands;
}

Bands scaled(double factor, const Bands& bands) {
  Bands result{};
  for (std::size_t b = 0; b < bands.size(); ++b) result[b] = factor * bands[b];
  return result;
}

Bands product(const Bands& x, const Bands& y) {
  Bands result{};
  for (std::size_t b = 0; b < x.size(); ++b) result[b] = x[b] * y[b];
  return result;
}

Result<Bands> reflectance_bands(std::span<const double> wavelengths_nm, std::span<const double> values) {
  GONIO_TRY(check(wavelengths_nm, values));
  if (wavelengths_nm.front() > kFirstBand_nm || wavelengths_nm.back() < band_nm(kBands - 1)) {
    const auto covered = SpectralColorimeter::make(wavelengths_nm, {"D65", 2});
    if (!covered.ok()) return covered.error();
  }
  Bands bands{};
  for (int b = 0; b < kBands; ++b)
    bands[static_cast<std::size_t>(b)] = std::max(0.0, interpolated(wavelengths_nm, values, band_nm(b)));
  return bands;
}

Result<Bands> light_bands(std::span<const double> wavelengths_nm, std::span<const double> power) {
  GONIO_TRY(check(wavelengths_nm, power));
  if (wavelengths_nm.front() > kFirstBand_nm || wavelengths_nm.back() < band_nm(kBands - 1))
    return input_error("a light from {} to {} nm: its power must be known from {} to {} nm", wavelengths_nm.front(),
                       wavelengths_nm.back(), kFirstBand_nm, band_nm(kBands - 1));
  if (!std::ranges::all_of(power, [](double p) { return p >= 0; })) return input_error("power cannot be negative");
  return light_of(power_in_bands([&](double nm) { return linear(wavelengths_nm, power, nm); }));
}

Result<Bands> illuminant_bands(const std::string& name) {
  if (const auto known = illuminant_power(kFirstBand_nm, name); !known.ok()) return known.error();
  return light_of(power_in_bands([&](double nm) { return *illuminant_power(nm, name); }));
}

// The weights of SpectralColorimeter under D65, whose white becomes that of the working space by Bradford's transform.
Result<BandObserver> BandObserver::make(int observer_deg) {
  const std::vector<double> nm = band_wavelengths_nm();
  GONIO_ASSIGN(const SpectralColorimeter meter, SpectralColorimeter::make(nm, {"D65", observer_deg}));
  BandObserver observer;
  observer.observer_deg_ = observer_deg;
  const Xyz d65 = xyz_d65_from_rgb({1, 1, 1});
  for (std::size_t b = 0; b < observer.weights_.size(); ++b) {
    Bands single{};
    single[b] = 1;
    observer.weights_[b] = rgb_from_xyz_d65(adapted(meter.xyz(single), meter.white(), d65));
  }
  return observer;
}

Rgb BandObserver::rgb(const Bands& relative) const {
  Rgb sum;
  for (std::size_t b = 0; b < relative.size(); ++b) sum += relative[b] * weights_[b];
  return sum;
}

}  // namespace goniochrome::color
