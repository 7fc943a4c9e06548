#include "color/color.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "base/text.h"
#include "color/acescg.h"
#include "color/spectrum.h"

namespace goniochrome::color::color_test {
namespace {

const Xyz kD65_10 = *white_point({"D65", 10});

double difference(const Lab& x, const Lab& y) {
  return std::max({std::abs(x.L - y.L), std::abs(x.a - y.a), std::abs(x.b - y.b)});
}

// The matrix of S-2014-004 has XYZ relative to the white of ACES; the control leaves the whites apart.
TEST(Acescg, IsThatOfTheStandard) {
  const Xyz aces_white{0.9526460746, 1, 1.0088251844}, d65 = xyz_d65_from_rgb({1, 1, 1});
  const Rgb acescg = acescg_from_rec2020({0.2, 0.5, 0.1});
  const Xyz xyz = adapted(xyz_d65_from_rgb({0.2, 0.5, 0.1}), d65, aces_white), off = xyz_d65_from_rgb({0.2, 0.5, 0.1});
  const auto red = [](const Xyz& c) { return 1.6410233797 * c.X - 0.3248032942 * c.Y - 0.2364246952 * c.Z; };
  EXPECT_NEAR(acescg.x, red(xyz), 1e-7);
  EXPECT_GT(std::abs(acescg.x - red(off)), 1e-3);
  const Rgb back = rec2020_from_acescg(acescg);
  EXPECT_NEAR(back.x, 0.2, 1e-12);
  EXPECT_NEAR(back.y, 0.5, 1e-12);
  EXPECT_NEAR(back.z, 0.1, 1e-12);
}

TEST(Color, WhitePointsHaveThePublishedChromaticity) {
  // CIE 15, 2 deg observer, to the digits printed there.
  struct {
    const char* illuminant;
    double x, y, digits;
  } const table[] = {{"A", 0.44757, 0.40745, 1e-4},   {"C", 0.31006, 0.31616, 1e-4},   {"D50", 0.34567, 0.35850, 1e-4},
                     {"D55", 0.33242, 0.34743, 1e-4}, {"D65", 0.31272, 0.32903, 1e-4}, {"D75", 0.29902, 0.31485, 1e-4},
                     {"F2", 0.3721, 0.3751, 1e-4},    {"F7", 0.3129, 0.3292, 1e-4},    {"F11", 0.3805, 0.3769, 1e-4}};
  for (const auto& row : table) {
    const Xyz white = *white_point({row.illuminant, 2});
    const double sum = white.X + white.Y + white.Z;
    EXPECT_NEAR(white.X / sum, row.x, row.digits) << row.illuminant;
    EXPECT_NEAR(white.Y / sum, row.y, row.digits) << row.illuminant;
  }
}

TEST(Color, AnUnknownWhiteIsRefusedAndTheKnownOnesNamed) {
  EXPECT_EQ(white_point({"D93", 2}).error().message,
            "illuminant \"D93\" is not known: give one of " + spectral_illuminants());
  EXPECT_EQ(white_point({"D65", 4}).error().message, "observer 4 is not known: give 2 or 10 (degrees)");
}

// The tables of the color-matching functions (1 nm) and of the illuminants, summed over 360-780 nm, the range both
// have. The printed white points were summed to 830 nm: that and their rounding to 1e-5 leave 4e-4, most for A, whose
// light grows toward the red.
TEST(Color, WhitePointsAgainstTheCieTablesRealData) {
  const char* data = std::getenv("GONIOCHROME_DATA");
  if (!data) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  const auto table = [&](const std::string& name) {
    std::ifstream file(std::string(data) + "/cie/" + name);
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(file, line);) {
      std::vector<double> row;
      for (const auto cell : split(trimmed(line), ','))
        if (const auto number = parse_number(cell)) row.push_back(*number);
      if (row.size() > 1) rows.push_back(row);
    }
    return rows;
  };
  for (const int observer : {2, 10}) {
    const auto matching = table(observer == 2 ? "cie1931_2deg_1nm.csv" : "cie1964_10deg_1nm.csv");
    ASSERT_GT(matching.size(), 400u);
    for (const std::string illuminant : {"D65", "D50", "A"}) {
      const auto light = table("illuminant_" + illuminant + ".csv");
      ASSERT_GT(light.size(), 90u);
      Vec3 sum;
      for (const auto& row : matching) {
        const auto above = std::ranges::find_if(light, [&](const auto& l) { return l[0] >= row[0]; });
        if (above == light.end()) break;
        const auto below = (*above)[0] > row[0] ? above - 1 : above;
        const double part = above == below ? 0 : (row[0] - (*below)[0]) / ((*above)[0] - (*below)[0]);
        sum += std::lerp((*below)[1], (*above)[1], part) * Vec3{row[1], row[2], row[3]};
      }
      const Xyz white = *white_point({illuminant, observer});
      EXPECT_NEAR(sum.x / sum.y, white.X, 4e-4) << illuminant << "/" << observer;
      EXPECT_NEAR(sum.z / sum.y, white.Z, 4e-4) << illuminant << "/" << observer;
    }
  }
}

TEST(Color, LabOfAKnownColorIsThePublishedOne) {
  // X = Z = 0.5 of the white, Y = 0.18: F = 0.5^(1/3) and 0.18^(1/3).
  const double half = std::cbrt(0.5), y = std::cbrt(0.18);
  const Lab lab = lab_from_xyz({0.5 * kD65_10.X, 0.18, 0.5 * kD65_10.Z}, kD65_10);
  EXPECT_DOUBLE_EQ(lab.L, 116 * y - 16);
  EXPECT_DOUBLE_EQ(lab.a, 500 * (half - y));
  EXPECT_DOUBLE_EQ(lab.b, 200 * (y - half));
}

TEST(Color, WhiteIsOneInTheWorkingSpaceForEveryWhite) {
  for (const char* illuminant : {"D65", "D50", "A", "F11"})
    for (const int observer : {2, 10}) {
      const Xyz white = *white_point({illuminant, observer});
      const Rgb rgb = rgb_from_lab({100, 0, 0}, white);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(rgb[i], 1, 4e-15) << illuminant << observer;
    }
}

TEST(Color, GrayHasEqualChannels) {
  const Rgb rgb = rgb_from_lab({50, 0, 0}, kD65_10);
  EXPECT_NEAR(rgb.x, rgb.y, 1e-15);
  EXPECT_NEAR(rgb.y, rgb.z, 1e-15);
  EXPECT_NEAR(rgb.y, std::pow((50 + 16) / 116.0, 3), 1e-15);
}

TEST(Color, Rec709PrimariesLieInsideRec2020) {
  // BT.2087, table of the conversion from Rec.709 to Rec.2020, four digits.
  const double expected[3][3] = {{0.6274, 0.3293, 0.0433}, {0.0691, 0.9195, 0.0114}, {0.0164, 0.0880, 0.8956}};
  for (int column = 0; column < 3; ++column) {
    Rgb primary;
    primary[column] = 1;
    const Rgb rgb = rec2020_from_rec709(primary);
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(rgb[row], expected[row][column], 5e-5);
    const Rgb back = rec709_from_rec2020(rgb);
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(back[row], primary[row], 1e-15);
  }
}

TEST(Color, AdaptationToTheSameWhiteChangesNothingAndMapsWhiteToWhite) {
  const Xyz d65 = *white_point({"D65", 2}), a = *white_point({"A", 10});
  const Xyz same = adapted({0.3, 0.2, 0.1}, a, a);
  EXPECT_NEAR(same.X, 0.3, 1e-15);
  EXPECT_NEAR(same.Z, 0.1, 1e-15);
  const Xyz moved = adapted(a, a, d65);
  EXPECT_NEAR(moved.X, d65.X, 1e-15);
  EXPECT_NEAR(moved.Y, d65.Y, 1e-15);
  EXPECT_NEAR(moved.Z, d65.Z, 1e-15);
}

// The textbook forms: the cube root alone, by pow; the hue by the quotient b/a.
double textbook_lightness(double Y) {
  return 116 * std::pow(Y, 1.0 / 3.0) - 16;
}
double textbook_hue_deg(double a, double b) {
  return std::atan(b / a) / kDegree;
}

// Lab has magnitudes up to 160 and, in a*, differences of two numbers near 1.5 times 500: an ulp of those is 1.7e-13,
// and a round trip passes four roundings of it, below 1e-12.
TEST(HardCase, LabExtremes) {
  std::mt19937_64 random(7);
  int linear = 0, cubic = 0, negative = 0;
  double worst = 0;
  for (int i = 0; i < 200000; ++i) {
    const Lab lab{std::uniform_real_distribution(-2.0, 160.0)(random),
                  std::uniform_real_distribution(-150.0, 150.0)(random),
                  std::uniform_real_distribution(-150.0, 150.0)(random)};
    const Xyz xyz = xyz_from_lab(lab, kD65_10);
    worst = worst_of(worst, difference(lab_from_xyz(xyz, kD65_10), lab));
    (xyz.Y > 0.008856 ? cubic : linear)++;
    negative += xyz.X < 0 || xyz.Z < 0;
  }
  EXPECT_GT(linear, 1000);
  EXPECT_GT(cubic, 1000);
  EXPECT_GT(negative, 1000);
  for (const double L : {0.0, 8.0, std::nextafter(8.0, 0.0), std::nextafter(8.0, 9.0), 100.0, 160.0}) {
    const Lab lab{L, 0, 0};
    EXPECT_LE(difference(lab_from_xyz(xyz_from_lab(lab, kD65_10), kD65_10), lab), 1e-12) << L;
    // The way into the working space and back has two 3x3 matrices and their inverses more.
    EXPECT_LE(difference(lab_from_rgb(rgb_from_lab(lab, kD65_10), kD65_10), lab), 1e-12) << L;
  }
  const Xyz slightly_negative{-1e-4, -1e-9, -1e-3};
  const Xyz back = xyz_from_lab(lab_from_xyz(slightly_negative, kD65_10), kD65_10);
  EXPECT_NEAR(back.X, slightly_negative.X, 1e-16);
  EXPECT_NEAR(back.Y, slightly_negative.Y, 1e-16);
  EXPECT_NEAR(back.Z, slightly_negative.Z, 1e-16);
  hard_case("lab-extremes", {.what = "round trip through XYZ, negative included",
                             .textbook = textbook_lightness(-1e-9) - lab_from_xyz({0, -1e-9, 0}, kD65_10).L,
                             .ours = worst,
                             .bound = 1e-12,
                             .unit = "L*"});
  for (const double a : {1e-17, -1e-17, 0.0, -0.0})
    for (const double b : {1e-17, -1e-17, 0.0, -0.0}) {
      EXPECT_EQ(hue_deg({50, a, b}), 0);
      EXPECT_LE(chroma({50, a, b}), 2e-17);
    }
  EXPECT_TRUE(std::isnan(textbook_hue_deg(0, 0)));
  EXPECT_DOUBLE_EQ(hue_deg({50, -1, 0}), 180);
  EXPECT_DOUBLE_EQ(hue_deg({50, -1, -0.0}), 180);
  EXPECT_DOUBLE_EQ(hue_deg({50, 0, -3}), 270);
  // Opposite hues, one answer.
  hard_case("lab-extremes", {.what = "hue of a* = -1 and b* = 1e-30",
                             .textbook = std::abs(textbook_hue_deg(-1, 1e-30) - 180),
                             .ours = std::abs(hue_deg({50, -1, 1e-30}) - 180),
                             .bound = 1e-13,
                             .unit = "deg"});
  EXPECT_LT(hue_deg({50, 1, -1e-17}), 360);
}

}  // namespace
}  // namespace goniochrome::color::color_test
