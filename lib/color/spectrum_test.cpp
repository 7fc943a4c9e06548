#include "color/spectrum.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "base/file.h"
#include "base/testdata_for_test.h"
#include "base/text.h"
#include "color/bands.h"
#include "color/internal/cie_tables.h"

namespace goniochrome::color::spectrum_test {
namespace {

std::vector<double> wavelengths(double first, double last, double step) {
  std::vector<double> result;
  for (double nm = first; nm <= last; nm += step) result.push_back(nm);
  return result;
}

SpectralColorimeter colorimeter(const std::vector<double>& nm, const ViewingCondition& condition) {
  auto made = SpectralColorimeter::make(nm, condition);
  EXPECT_TRUE(made.ok());
  return std::move(made).value();
}

TEST(Spectrum, PerfectDiffuserIsWhiteUnderEveryTable) {
  for (const char* illuminant : {"D65", "D50", "A"})
    for (int observer : {2, 10}) {
      const auto nm = wavelengths(400, 700, 10);
      const auto meter = colorimeter(nm, {illuminant, observer});
      const Lab lab = meter.lab(std::vector<double>(nm.size(), 1.0));
      // Sums of 421 rounded products and Lagrange weights: some hundred ulps of 100.
      EXPECT_NEAR(lab.L, 100, 1e-11);
      EXPECT_NEAR(lab.a, 0, 1e-10);
      EXPECT_NEAR(lab.b, 0, 1e-10);
    }
}

TEST(Spectrum, WhiteIsThePublishedOne) {
  const auto nm = wavelengths(380, 780, 5);
  // CIE 15:2004 table T.3, 4 digits of other sums over the same tables: they agree to two units of the last one.
  const std::map<std::pair<std::string, int>, std::pair<double, double>> published = {
      {{"D65", 2}, {0.9504, 1.0888}},  {{"D65", 10}, {0.9481, 1.0732}}, {{"D50", 2}, {0.9642, 0.8251}},
      {{"D50", 10}, {0.9672, 0.8143}}, {{"A", 2}, {1.0985, 0.3558}},    {{"A", 10}, {1.1114, 0.3520}}};
  // The whites that ASTM E308 prints, from sums by its own tables.
  for (const char* other : {"C", "D55", "D75", "F2", "F7", "F11"})
    for (const int observer : {2, 10}) {
      const Xyz sum = colorimeter(nm, {other, observer}).white();
      const auto printed = white_point({other, observer});
      ASSERT_TRUE(printed.ok());
      // C is printed from another table of its powers than that of CIE 15, and lamps with lines from sums over 5 nm.
      const bool is_other = std::string_view(other) == "C" || other[0] == 'F';
      EXPECT_NEAR(sum.X, printed->X, is_other ? 1.3e-3 : 3e-4) << other << observer;
      EXPECT_NEAR(sum.Z, printed->Z, is_other ? 1.3e-3 : 3e-4) << other << observer;
    }
  for (const auto& [condition, xz] : published) {
    const Xyz white = colorimeter(nm, {condition.first, condition.second}).white();
    EXPECT_NEAR(white.X, xz.first, 2e-4) << condition.first << condition.second;
    EXPECT_NEAR(white.Z, xz.second, 2e-4) << condition.first << condition.second;
    const auto known = white_point({condition.first, condition.second});
    ASSERT_TRUE(known.ok());
    EXPECT_NEAR(white.X, known->X, 2.5e-4);
    EXPECT_NEAR(white.Z, known->Z, 2.5e-4);
  }
}

// A smooth spectrum on 10 nm against the same on 5 nm: the cubic loses little where the straight line loses more.
TEST(Spectrum, CubicBetweenSamplesBeatsTheStraightLine) {
  const auto bump = [](double nm) { return 0.05 + 0.8 * std::exp(-std::pow((nm - 523) / 22, 2)); };
  const auto sampled = [&](const std::vector<double>& nm) {
    std::vector<double> values;
    for (double x : nm) values.push_back(bump(x));
    return values;
  };
  const auto fine_nm = wavelengths(360, 780, 5), coarse_nm = wavelengths(380, 780, 10);
  const auto coarse = sampled(coarse_nm);
  std::vector<double> straight;
  for (double nm : fine_nm) {
    const double at = std::clamp((nm - 380) / 10, 0.0, static_cast<double>(coarse.size()) - 1.001);
    const auto i = static_cast<std::size_t>(at);
    straight.push_back(std::lerp(coarse[i], coarse[i + 1], at - std::floor(at)));
  }
  const auto fine_meter = colorimeter(fine_nm, {"D65", 10});
  const Lab truth = fine_meter.lab(sampled(fine_nm));
  const double cubic_error = delta_e_76(colorimeter(coarse_nm, {"D65", 10}).lab(coarse), truth);
  EXPECT_LT(cubic_error, 0.1);
  EXPECT_GT(delta_e_76(fine_meter.lab(straight), truth), 3 * cubic_error);
}

TEST(Spectrum, SaysHowMuchWasHeldBeyondTheEnds) {
  EXPECT_EQ(colorimeter(wavelengths(360, 780, 10), {"A", 2}).held_share(), 0);
  const double held = colorimeter(wavelengths(400, 700, 10), {"A", 2}).held_share();
  EXPECT_GT(held, 0.001);
  EXPECT_LT(held, 0.02);
}

TEST(Spectrum, RefusesWhatItCannotIntegrate) {
  const std::vector<double> good = {400, 700}, twice = {400, 400, 700}, one = {400};
  EXPECT_NE(SpectralColorimeter::make(good, {"F4", 2})
                .error()
                .message.find("D65, D50, A, C, D55, D75, F2, F7, F11, F12, LED-B1"),
            std::string::npos);
  EXPECT_FALSE(SpectralColorimeter::make(good, {"D65", 4}).ok());
  EXPECT_FALSE(SpectralColorimeter::make(twice, {"D65", 2}).ok());
  EXPECT_FALSE(SpectralColorimeter::make(one, {"D65", 2}).ok());
}

// Blue light alone was the color of a white, and heat was a gray: the outermost value stood for all the rest.
TEST(Spectrum, RefusesWhatTheObserverDoesNotSee) {
  for (const auto& [from, to] :
       {std::pair{400.0, 440.0}, {360.0, 400.0}, {900.0, 980.0}, {400.0, 600.0}, {440.0, 700.0}}) {
    const auto meter = SpectralColorimeter::make(std::vector{from, to}, {"D65", 10});
    ASSERT_FALSE(meter.ok()) << from;
    EXPECT_NE(meter.error().message.find("of what the observer sees: measure 400 to 700 nm"), std::string::npos);
    EXPECT_FALSE(reflectance_bands(std::vector{from, to}, std::vector{0.1, 0.9}).ok());
  }
  for (const auto& [from, to] : {std::pair{400.0, 700.0}, {420.0, 680.0}, {430.0, 700.0}, {400.0, 650.0}})
    EXPECT_TRUE(SpectralColorimeter::make(std::vector{from, to}, {"D65", 10}).ok()) << from;
  EXPECT_LT(colorimeter(wavelengths(400, 700, 10), {"A", 2}).held_share(), kToldHeldShare);
  EXPECT_GT(colorimeter(wavelengths(420, 680, 10), {"A", 2}).held_share(), kToldHeldShare);
}

// The polynomial through these points at x, by Newton's divided differences.
double newton(std::vector<double> nodes, std::vector<double> values, double x) {
  for (std::size_t order = 1; order < nodes.size(); ++order)
    for (std::size_t i = nodes.size() - 1; i >= order; --i)
      values[i] = (values[i] - values[i - 1]) / (nodes[i] - nodes[i - order]);
  double result = values.back();
  for (std::size_t i = nodes.size() - 1; i-- > 0;) result = result * (x - nodes[i]) + values[i];
  return result;
}

// A table every `step` nm at x, held beyond its ends: by the two neighbors on either side, three in all at the ends.
double cubic_at(const std::vector<double>& table, double from, double step, double x) {
  const double place = std::clamp((x - from) / step, 0.0, static_cast<double>(table.size() - 1));
  const int interval = std::min(static_cast<int>(place), static_cast<int>(table.size()) - 2);
  std::vector<double> nodes, values;
  for (int k = std::max(0, interval - 1); k <= std::min(interval + 2, static_cast<int>(table.size()) - 1); ++k)
    nodes.push_back(k), values.push_back(table[static_cast<std::size_t>(k)]);
  return newton(nodes, values, place);
}

// Ten published reflectances under illuminant A, by direct sums with an interpolation that is written otherwise.
TEST(Spectrum, TenPaintsUnderAAreTheirDirectSums) {
  const auto text = file_content(testdata("published-reflectances.csv"));
  ASSERT_TRUE(text.ok());
  std::vector<std::vector<double>> paints(10);
  const auto lines = split(*text, '\n');
  for (std::size_t i = 2; i < lines.size() && !trimmed(lines[i]).empty(); ++i) {
    const auto cells = split(trimmed(lines[i]), ',');
    const double nm = *parse_number(cells[0]);
    if (nm < 400 || nm > 700 || std::fmod(nm, 10) != 0) continue;
    for (std::size_t k = 0; k < paints.size(); ++k) paints[k].push_back(*parse_number(cells[1 + k]));
  }
  for (const int observer_deg : {2, 10}) {
    const auto meter = colorimeter(wavelengths(400, 700, 10), {"A", observer_deg});
    for (const std::vector<double>& paint : paints) {
      ASSERT_EQ(paint.size(), 31U);
      std::vector<double> held(4, paint.front());  // 360 to 780 nm
      held.insert(held.end(), paint.begin(), paint.end());
      held.insert(held.end(), 8, paint.back());
      std::array<double, 3> sum{}, white{};
      for (int nm = 360; nm <= 780; ++nm) {
        const double place = (nm - kCieStart_nm) / kCieStep_nm;
        const auto low = std::min(static_cast<std::size_t>(place), kCieTable.size() - 2);
        const double power = std::lerp(kCieTable[low].illuminants[2], kCieTable[low + 1].illuminants[2],
                                       place - static_cast<double>(low));
        for (std::size_t c = 0; c < 3; ++c) {
          const CieObserver& observer = kCieObservers[static_cast<std::size_t>(nm - 360)];
          const double seen = power * (observer_deg == 2 ? observer.observer_2[c] : observer.observer_10[c]);
          white[c] += seen, sum[c] += seen * cubic_at(held, 360, 10, nm);
        }
      }
      const Lab direct = lab_from_xyz({sum[0] / white[1], sum[1] / white[1], sum[2] / white[1]},
                                      {white[0] / white[1], 1, white[2] / white[1]});
      EXPECT_LT(delta_e_76(meter.lab(paint), direct), 1e-9);
    }
  }
}

// Lab of a green, which the package colour-science 0.4.7 computes by the tables of ASTM E308 from 400 to 700 nm.
// Weights that held reflectance beyond the ends without a grid were up to .02 off.
TEST(Spectrum, WeightsAreThoseOfE308) {
  struct Case {
    const char* illuminant;
    int observer_deg, step_nm;
    Lab lab;
  };
  const Case cases[] = {
      {"D65", 10, 10, {71.529085, -41.847998, 42.171899}},
      {"D65", 10, 20, {71.522829, -41.743853, 42.104370}},
      {"A", 10, 10, {69.455060, -29.464868, 32.326332}},
      {"A", 10, 20, {69.457300, -29.405415, 32.260201}},
      {"F11", 10, 10, {71.472267, -34.733050, 45.453917}},
      {"F11", 10, 20, {71.507481, -34.850700, 45.467787}},
      {"F2", 2, 10, {69.750668, -34.280297, 39.947309}},
      {"F2", 2, 20, {69.778994, -34.253446, 39.960387}},
      {"F12", 10, 10, {70.422430, -31.431307, 43.636982}},
      {"F12", 10, 20, {70.453288, -31.553062, 43.649984}},
      {"LED-B3", 2, 10, {70.634793, -38.591344, 39.107129}},
      {"LED-B3", 2, 20, {70.635689, -38.507203, 39.094326}},
      {"LED-RGB1", 10, 10, {71.985761, -39.387379, 31.140730}},
      {"LED-RGB1", 10, 20, {71.948406, -39.245905, 31.071344}},
      {"ID65", 2, 10, {72.183517, -46.975299, 39.981441}},
      {"ID65", 2, 20, {72.174897, -46.847250, 39.903511}},
  };
  for (const Case& c : cases) {
    const std::vector<double> nm = wavelengths(400, 700, c.step_nm);
    std::vector<double> reflectance;
    for (const double x : nm)
      reflectance.push_back(.05 + .3 * (x - 400) / 300 + .5 * std::exp(-std::pow((x - 523) / 40, 2)));
    const Lab lab = colorimeter(nm, {c.illuminant, c.observer_deg}).lab(reflectance);
    EXPECT_LT(delta_e_76(lab, c.lab), 2e-6) << c.illuminant << " " << c.step_nm;
  }
}

// The published tables as files, one value column set per row: wavelength and the columns after it.
std::map<double, std::vector<double>> csv_rows(const std::string& name) {
  std::map<double, std::vector<double>> rows;
  const auto text = file_content(std::string(std::getenv("GONIOCHROME_DATA")) + "/cie/" + name);
  EXPECT_TRUE(text.ok());
  bool header = true;
  for (const auto line : split(*text, '\n')) {
    if (header || trimmed(line).empty()) {
      header = false;
      continue;
    }
    std::vector<double> values;
    for (const auto cell : split(trimmed(line), ',')) values.push_back(parse_number(cell).value());
    rows[values[0]] = {values.begin() + 1, values.end()};
  }
  return rows;
}

TEST(Spectrum, EmbeddedTablesAreThePublishedOnesRealData) {
  if (!std::getenv("GONIOCHROME_DATA")) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  auto two = csv_rows("cie1931_2deg_1nm.csv"), ten = csv_rows("cie1964_10deg_1nm.csv");
  auto d65 = csv_rows("illuminant_D65.csv"), d50 = csv_rows("illuminant_D50.csv"), a = csv_rows("illuminant_A.csv");
  for (const CieRow& row : kCieTable) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(row.observer_2[c], two[row.wavelength_nm].at(c));
      EXPECT_EQ(row.observer_10[c], ten[row.wavelength_nm].at(c));
    }
    EXPECT_EQ(row.illuminants[0], d65[row.wavelength_nm].at(0));
    EXPECT_EQ(row.illuminants[1], d50[row.wavelength_nm].at(0));
    EXPECT_EQ(row.illuminants[2], a[row.wavelength_nm].at(0));
  }
  for (std::size_t i = 0; i < kCieObservers.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(kCieObservers[i].observer_2[c], two[360.0 + static_cast<double>(i)].at(c));
      EXPECT_EQ(kCieObservers[i].observer_10[c], ten[360.0 + static_cast<double>(i)].at(c));
    }
}

// Sums over published tables at every nm, on the 24 patches of ISO 17321-1 (5 nm data, straight between).
TEST(Spectrum, PatchesAreTheirDirectSumsRealData) {
  if (!std::getenv("GONIOCHROME_DATA")) GTEST_SKIP() << "GONIOCHROME_DATA is not set";
  auto cmf = csv_rows("cie1964_10deg_1nm.csv"), light = csv_rows("illuminant_D65.csv");
  auto patches = csv_rows("colourchecker_ISO_17321-1.csv");
  const auto nm = wavelengths(360, 780, 1);
  const auto meter = colorimeter(nm, {"D65", 10});
  const auto linear_at = [](std::map<double, std::vector<double>>& table, double x, std::size_t column) {
    const double low = std::clamp(std::floor(x / 5) * 5, table.begin()->first, table.rbegin()->first - 5);
    return std::lerp(table[low].at(column), table[low + 5].at(column), std::clamp((x - low) / 5, 0.0, 1.0));
  };
  double worst = 0;
  for (std::size_t patch = 0; patch < 24; ++patch) {
    std::vector<double> reflectance;
    for (double x : nm) reflectance.push_back(linear_at(patches, x, patch));
    std::array<double, 3> sum{}, white{};
    for (double x = 360; x <= 780; ++x)
      for (std::size_t c = 0; c < 3; ++c) {
        const double power = linear_at(light, x, 0) * cmf[x].at(c);
        white[c] += power;
        sum[c] += power * linear_at(patches, x, patch);
      }
    const Lab fine = lab_from_xyz({sum[0] / white[1], sum[1] / white[1], sum[2] / white[1]},
                                  {white[0] / white[1], 1, white[2] / white[1]});
    worst = std::max(worst, delta_e_76(fine, meter.lab(reflectance)));
  }
  EXPECT_LT(worst, 1e-9);
}

}  // namespace
}  // namespace goniochrome::color::spectrum_test
