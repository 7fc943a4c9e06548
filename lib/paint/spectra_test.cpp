#include "paint/spectra.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "base/file.h"
#include "base/testdata_for_test.h"
#include "base/text.h"

namespace goniochrome::paint {
namespace {

SpectrumReading band(double center_nm, double width_nm, double height) {
  SpectrumReading spectrum{{.aspecular_deg = 15}, 400, 10, {}};
  for (double nm = 400; nm <= 700; nm += 10)
    spectrum.factors.push_back(0.05 + height * std::exp(-std::pow((nm - center_nm) / width_nm, 2)));
  return spectrum;
}

TEST(Spectra, AnotherLightMakesOtherRowsOfTheSameSpectra) {
  Measurement measurement{{"D65", 10}, "", {{{.aspecular_deg = 15}, {1, 2, 3}}, {{.aspecular_deg = 110}, {4, 5, 6}}}};
  EXPECT_FALSE(under_light(measurement, {"A", 10}).ok());
  measurement.spectra = {band(620, 40, 0.8)};
  const auto incandescent = under_light(measurement, {"A", 2});
  ASSERT_TRUE(incandescent.ok());
  EXPECT_EQ(incandescent->condition.illuminant, "A");
  ASSERT_EQ(incandescent->rows.size(), 1U);  // 45as110 has no spectrum
  EXPECT_EQ(incandescent->rows[0].geometry, measurement.spectra[0].geometry);
  // A red band is lighter in red light.
  EXPECT_GT(incandescent->rows[0].lab.L, under_light(measurement, {"D65", 2})->rows[0].lab.L + 3);
  EXPECT_FALSE(under_light(measurement, {"F4", 2}).ok());
  EXPECT_FALSE(under_light(measurement, {"A", 4}).ok());
}

// Gray is L* of its reflectance and neutral in every light.
TEST(Spectra, GrayIsGrayInEveryLight) {
  SpectrumReading gray{{.aspecular_deg = 45}, 400, 10, std::vector<double>(31, 0.184)};
  for (const char* illuminant : {"D65", "D50", "A", "C", "D55", "D75", "F2", "F7", "F11"})
    for (const int observer : {2, 10}) {
      const auto lab = lab_of(gray, {illuminant, observer});
      ASSERT_TRUE(lab.ok());
      EXPECT_NEAR(lab->L, 116 * std::cbrt(0.184) - 16, 1e-9);
      EXPECT_NEAR(std::hypot(lab->a, lab->b), 0, 1e-9);
    }
}

TEST(Spectra, OnlyEqualStepsMakeASpectrum) {
  EXPECT_TRUE(spectrum_of({}, {400, 410, 420}, {1, 2, 3}).has_value());
  EXPECT_FALSE(spectrum_of({}, {400, 410, 430}, {1, 2, 3}).has_value());
  EXPECT_FALSE(spectrum_of({}, {400}, {1}).has_value());
  EXPECT_FALSE(spectrum_of({}, {400, 410}, {1}).has_value());
}

// Illuminant A by its definition, CIE 15:2004, 3.1: S = 100 (560/l)^5 (e^(b/560) - 1)/(e^(b/l) - 1) with b
// = 1.435e7/2848.
TEST(Spectra, IlluminantAIsItsBlackBody) {
  const auto power = [](double nm) {
    const double b = 1.435e7 / 2848;
    return 100 * std::pow(560 / nm, 5) * (std::exp(b / 560) - 1) / (std::exp(b / nm) - 1);
  };
  // Under A a paint is what the paint times power(A)/power(D65) is under D65, up to the white: the X, Y and Z of both
  // sums are equal.
  const auto text = file_content(testdata("published-lights.csv"));
  ASSERT_TRUE(text.ok());
  const auto lines = split(*text, '\n');
  std::size_t daylight = 0;
  const auto marks = split(lines[1], ',');
  while (marks[daylight] != "daylight") ++daylight;
  SpectrumReading paint{{}, 380, 5, {}}, ratio = paint, relit = paint;
  for (std::size_t i = 2; i < 73; ++i) {
    const auto words = split(lines[i], ',');
    const double nm = *parse_number(words[0]);
    paint.factors.push_back(0.1 + 0.6 / (1 + std::exp((590 - nm) / 15)));
    ratio.factors.push_back(power(nm) / *parse_number(words[daylight]));
    relit.factors.push_back(paint.factors.back() * ratio.factors.back());
  }
  const color::Xyz d65 = *color::white_point({"D65", 10}), a = *color::white_point({"A", 10});
  const auto xyz = [](const SpectrumReading& s, const char* light, const color::Xyz& white) {
    return color::xyz_from_lab(*lab_of(s, {light, 10}), white);
  };
  const color::Xyz direct = xyz(paint, "A", a), light = xyz(ratio, "D65", d65), both = xyz(relit, "D65", d65);
  // The printed whites have five digits, and R is interpolated in another place: 2e-3 of the white.
  EXPECT_NEAR(direct.X / a.X, both.X / light.X, 2e-3);
  EXPECT_NEAR(direct.Y, both.Y / light.Y, 2e-3);
  EXPECT_NEAR(direct.Z / a.Z, both.Z / light.Z, 2e-3);
  EXPECT_GT(std::abs(direct.Y - xyz(paint, "D65", d65).Y), 0.03) << "the control: the same paint under D65";
}

}  // namespace
}  // namespace goniochrome::paint
