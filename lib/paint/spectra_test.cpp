#include "paint/spectra.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/file.h"
#include "base/testdata_for_test.h"
#include "base/text.h"
#include "color/spectrum.h"

namespace goniochrome::paint::spectra_test {
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

double largest(const Result<std::vector<DifferenceAt>>& differences) {
  double most = 0;
  for (const DifferenceAt& difference : *differences) most = std::max(most, difference.value);
  return most;
}

Measurement measured(std::vector<double> factors, const Geometry& geometry = {.aspecular_deg = 45}) {
  return {{"D65", 10}, "", {}, {SpectrumReading{geometry, 400, 10, std::move(factors)}}};
}

TEST(Spectra, GrayIsConstantInEveryLightAndAReddishPaintIsNot) {
  const std::pair<color::ViewingCondition, color::ViewingCondition> gray_in[] = {
      {{"D65", 10}, {"A", 10}}, {{"D65", 2}, {"F11", 2}}, {{"D50", 10}, {"F2", 10}}};
  for (const auto& [reference, test] : gray_in) {
    // The inverse of the transform is exact to rounding.
    EXPECT_LT(largest(inconstancy(measured(std::vector<double>(31, 0.3)), reference, test)), 1e-10);
  }
  EXPECT_GT(largest(inconstancy({{}, "", {}, {band(600, 30, 0.8)}}, {"D65", 10}, {"A", 10})), 1);
  EXPECT_FALSE(inconstancy({}, {"D65", 10}, {"A", 10}).ok());
}

// The corresponding color by the inverse matrix that is published beside the transform [Li, Luo, Rigg and Hunt 2002].
TEST(Spectra, InconstancyIsThatOfThePublishedTransform) {
  constexpr double kForward[3][3] = {{0.7982, 0.3389, -0.1371}, {-0.5918, 1.5512, 0.0406}, {0.0008, 0.0239, 0.9753}};
  constexpr double kInverse[3][3] = {{1.07645005, -0.23766239, 0.16121234},
                                     {0.41096433, 0.5543418, 0.03469387},
                                     {-0.01095377, -0.01338936, 1.02434312}};
  const color::ViewingCondition day{"D65", 10}, lamp{"A", 10};
  // White points of the same sums as those of the colors: XYZ of a paint that reflects everything.
  std::vector<double> nm;
  for (int i = 0; i < 31; ++i) nm.push_back(400 + 10 * i);
  const auto by_day = color::SpectralColorimeter::make(nm, day), by_lamp = color::SpectralColorimeter::make(nm, lamp);
  ASSERT_TRUE(by_day.ok() && by_lamp.ok());
  for (const double center_nm : {450.0, 520.0, 590.0, 650.0}) {
    const SpectrumReading paint = band(center_nm, 40, 0.7);
    const color::Xyz lit = by_lamp->xyz(paint.factors), from = by_lamp->white(), to = by_day->white();
    double adapted[3];
    for (int i = 0; i < 3; ++i) {
      const auto response = [&](const color::Xyz& x) {
        return kForward[i][0] * x.X + kForward[i][1] * x.Y + kForward[i][2] * x.Z;
      };
      adapted[i] = response(lit) * response(to) / response(from);
    }
    const auto back = [&](int i) {
      return kInverse[i][0] * adapted[0] + kInverse[i][1] * adapted[1] + kInverse[i][2] * adapted[2];
    };
    const double expected =
        color::delta_e_2000(by_day->lab(paint.factors), color::lab_from_xyz({back(0), back(1), back(2)}, to));
    // The inverse is printed to 8 digits.
    EXPECT_NEAR(largest(inconstancy({{}, "", {}, {paint}}, day, lamp)), expected, 1e-5) << center_nm;
  }
}

// A pair that matches exactly by daylight: the second is the first plus a spectrum that daylight does not see, which is
// made by taking from a ripple what the three weighted observers see of it.
TEST(Spectra, MetamerismIsTheDifferenceOfAnExactPairUnderTheOtherLight) {
  const color::ViewingCondition day{"D65", 10}, lamp{"A", 10};
  std::vector<double> nm;
  for (int i = 0; i < 31; ++i) nm.push_back(400 + 10 * i);
  const auto by_day = color::SpectralColorimeter::make(nm, day), by_lamp = color::SpectralColorimeter::make(nm, lamp);
  std::array<std::vector<double>, 3> weights;
  for (std::size_t i = 0; i < nm.size(); ++i) {
    std::vector<double> unit(nm.size(), 0.0);
    unit[i] = 1;
    const color::Xyz xyz = by_day->xyz(unit);
    weights[0].push_back(xyz.X), weights[1].push_back(xyz.Y), weights[2].push_back(xyz.Z);
  }
  const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
  };
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < k; ++j) {
      const double share = product(weights[k], weights[j]) / product(weights[j], weights[j]);
      for (std::size_t i = 0; i < nm.size(); ++i) weights[k][i] -= share * weights[j][i];
    }
  std::vector<double> ripple;
  for (const double l : nm) ripple.push_back(0.1 * std::sin(l / 17));
  for (int pass = 0; pass < 2; ++pass)
    for (const std::vector<double>& seen : weights) {
      const double share = product(ripple, seen) / product(seen, seen);
      for (std::size_t i = 0; i < nm.size(); ++i) ripple[i] -= share * seen[i];
    }
  const std::vector<double> first = band(560, 60, 0.5).factors;
  std::vector<double> second = first;
  for (std::size_t i = 0; i < nm.size(); ++i) second[i] += ripple[i];
  ASSERT_LT(color::delta_e_2000(by_day->lab(first), by_day->lab(second)), 1e-10);
  const double expected = color::delta_e_2000(by_lamp->lab(first), by_lamp->lab(second));
  ASSERT_GT(expected, 0.5);
  EXPECT_NEAR(largest(metamerism(measured(second), measured(first), day, lamp)), expected, 1e-9);
  // The index does not count what the pair differs by under both lights: a lighter sample of the same kind has 0, while
  // the plain difference under the other light is large.
  std::vector<double> lighter = first;
  for (double& factor : lighter) factor *= 1.2;
  EXPECT_LT(largest(metamerism(measured(lighter), measured(first), day, lamp)), 1e-9);
  EXPECT_GT(color::delta_e_2000(by_lamp->lab(first), by_lamp->lab(lighter)), 3) << "the control";
  // Black against black is no pair that differs; black against color has no index.
  const std::vector<double> black(31, 0.0);
  EXPECT_EQ(largest(metamerism(measured(black), measured(black), day, lamp)), 0);
  EXPECT_TRUE(std::isnan(metamerism(measured(black), measured(first), day, lamp)->at(0).value));
  // Geometries that only one of them has are left out.
  EXPECT_TRUE(metamerism(measured(first), measured(first, {.aspecular_deg = 15}), day, lamp)->empty());
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
}  // namespace goniochrome::paint::spectra_test
