#include "brdf/band_lobes.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "paint/spectra.h"

namespace goniochrome::brdf::band_lobes_test {
namespace {

using color::Bands;
using color::kBands;

color::BandObserver eye() {
  return color::BandObserver::make().value();
}

// A made reflectance at a geometry.
template <class Function>
paint::SpectrumReading spectrum(const char* geometry, const Function& function) {
  paint::SpectrumReading reading{paint::parse_geometry(geometry).value(), 400, 10, {}};
  for (int b = 0; b < kBands; ++b) reading.factors.push_back(function(color::band_nm(b)));
  return reading;
}

double red(double nm) {
  return 0.05 + 0.6 / (1 + std::exp((590 - nm) / 12));
}

double blue(double nm) {
  return 0.04 + 0.4 * std::exp(-std::pow((nm - 460) / 35, 2));
}

// With the rows that its spectra give.
paint::Paint measured(const std::vector<paint::SpectrumReading>& spectra) {
  paint::Paint paint;
  paint.measurement = paint::Measurement{{"D65", 2}, "", {}, spectra};
  for (const paint::SpectrumReading& reading : spectra)
    paint.measurement->rows.push_back({reading.geometry, paint::lab_of(reading, {"D65", 2}).value()});
  return paint;
}

TEST(BandLobes, AMattPaintHasItsOwnSpectrum) {
  paint::Paint paint = measured({spectrum("45as45", red)});
  paint.lobes.emplace();
  Bands reflectance{};
  for (std::size_t b = 0; b < reflectance.size(); ++b) reflectance[b] = red(color::band_nm(static_cast<int>(b)));
  paint.lobes->diffuse = (1 / kPi) * eye().rgb(reflectance);
  const auto lobes = band_lobes(paint, eye());
  ASSERT_TRUE(lobes.ok()) << lobes.error().message;
  // The colors are equal to the last bits, so that the mixture is the spectrum; its color counts a thousandfold.
  for (std::size_t b = 0; b < reflectance.size(); ++b)
    EXPECT_NEAR(kPi * lobes->views.front().diffuse[b], reflectance[b], 1e-5) << b;
  EXPECT_LT(lobes->misfit_de00, 0.01);
  EXPECT_LT(lobes->readings_de00.front(), 0.01);
}

// A paint that travels from one spectrum to another, whose true weights in bands are known: its three channels and what
// an instrument reads of it are enough to find them again, as far as other lamps show. The control knows only a
// spectrum that tells nothing, so that it has smooth spectra of the right colors.
TEST(BandLobes, FollowTheSpectraOfAPaintThatTravels) {
  const auto mixed = [](double of_red, double of_blue) {
    Bands bands{};
    for (std::size_t b = 0; b < bands.size(); ++b) {
      const double nm = color::band_nm(static_cast<int>(b));
      bands[b] = (of_red * red(nm) + of_blue * blue(nm)) / kPi;
    }
    return bands;
  };
  const std::vector<double> exponents = {4, 12, 60};
  const Bands diffuse = mixed(0.03, 0.6);
  const std::vector<Bands> lobes = {mixed(0.1, 0.5), mixed(0.6, 0.3), mixed(1.5, 0)};
  std::vector<paint::SpectrumReading> spectra;
  for (const char* name : {"45as15", "45as25", "45as45", "45as75", "45as110"}) {
    const double aspecular = paint::aspecular_angle_deg(paint::parse_geometry(name).value()) * kDegree;
    std::size_t b = 0;
    spectra.push_back(spectrum(name, [&](double) {
      double sum = diffuse[b];
      for (std::size_t j = 0; j < exponents.size(); ++j)
        if (std::cos(aspecular) > 0) sum += std::pow(std::cos(aspecular), exponents[j]) * lobes[j][b];
      return ++b, kPi * sum;
    }));
  }
  paint::Paint paint = measured(spectra);
  paint.lobes.emplace();
  paint.lobes->diffuse = eye().rgb(diffuse);
  for (std::size_t j = 0; j < exponents.size(); ++j)
    paint.lobes->lobes.push_back({exponents[j], eye().rgb(lobes[j]), {}});
  const auto found = band_lobes(paint, eye());
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_LT(found->misfit_de00, 0.02);
  ASSERT_EQ(found->readings_de00.size(), 5U);

  paint::Paint alone = paint;
  for (paint::SpectrumReading& reading : alone.measurement->spectra) reading.factors.assign(kBands, 1.0);
  const auto smooth = band_lobes(alone, eye());
  ASSERT_TRUE(smooth.ok());
  // Under illuminant A, each weight beside the true one.
  const Bands lamp = color::illuminant_bands("A").value();
  const color::Xyz d65 = color::xyz_d65_from_rgb({1, 1, 1});
  const auto apart = [&](const Bands& x, const Bands& y) {
    const double size = 0.5 / color::xyz_d65_from_rgb(eye().rgb(x)).Y;
    return color::delta_e_2000(color::lab_from_rgb(size * eye().rgb(color::product(lamp, x)), d65),
                               color::lab_from_rgb(size * eye().rgb(color::product(lamp, y)), d65));
  };
  double control = 0;
  for (std::size_t j = 0; j < lobes.size(); ++j) {
    EXPECT_LT(apart(lobes[j], found->views.front().directional_diffuse[j]), 0.3) << j;
    control = std::max(control, apart(lobes[j], smooth->views.front().directional_diffuse[j]));
  }
  EXPECT_LT(apart(diffuse, found->views.front().diffuse), 0.3);
  EXPECT_GT(control, 1);
  for (const double de00 : found->readings_de00) EXPECT_LT(de00, 0.3);
}

TEST(BandLobes, GrayAsksForNoSpectrumAndColorDoes) {
  paint::Paint paint;
  EXPECT_FALSE(band_lobes(paint, eye()).ok());
  paint.lobes.emplace();
  paint.lobes->diffuse = {0.2, 0.2, 0.2};
  paint.lobes->lobes = {{30, {1, 1, 1}, {0.5, 0.5, 0.5}}, {paint::kMirrorExponent, {}, {0.4, 0.4, 0.4}}};
  const auto gray = band_lobes(paint, eye());
  ASSERT_TRUE(gray.ok());
  for (std::size_t b = 0; b < static_cast<std::size_t>(kBands); ++b) {
    EXPECT_EQ(gray->views.front().diffuse[b], 0.2);
    EXPECT_EQ(gray->views.front().directional_diffuse.front()[b], 1);
    EXPECT_EQ(gray->views.front().gloss.front()[b], 0.5);
    EXPECT_EQ(gray->views.front().mirror[b], 0.4);
  }
  paint::Paint colored = paint;
  colored.lobes->diffuse.x = 0.3;
  EXPECT_FALSE(band_lobes(colored, eye()).ok());
  colored.measurement = paint::Measurement{{"D65", 2}, "", {}, {spectrum("45as45", red)}};
  EXPECT_TRUE(band_lobes(colored, eye()).ok());
  colored.lobes->lobes.back().gloss.x = 0.5;  // a colored mirror
  EXPECT_FALSE(band_lobes(colored, eye()).ok());
  // Guessed spectra have the colors of the weights.
  colored.measurement.reset();
  const auto guessed = band_lobes(colored, eye(), NoSpectrum::kGuessed);
  ASSERT_TRUE(guessed.ok()) << guessed.error().message;
  EXPECT_LE(length(eye().rgb(guessed->views.front().diffuse) - color::Rgb{0.3, 0.2, 0.2}), 1e-5);
  EXPECT_LE(length(eye().rgb(guessed->views.front().mirror) - color::Rgb{0.5, 0.4, 0.4}), 1e-5);
  EXPECT_LT(guessed->misfit_de00, 0.01);
  paint.color_map = paint::ColorMapReference{"map.exr", 1.5};
  EXPECT_FALSE(band_lobes(paint, eye()).ok());
  EXPECT_FALSE(band_lobes(paint, eye(), NoSpectrum::kGuessed).ok());
}

}  // namespace
}  // namespace goniochrome::brdf::band_lobes_test
