#include "color/bands.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/testdata_for_test.h"
#include "base/text.h"
#include "color/spectrum.h"

namespace goniochrome::color::bands_test {
namespace {

struct Column {
  std::string name, set;
  std::vector<double> nm, values;
};

std::vector<Column> columns(const std::string& file) {
  const auto text = file_content(testdata(file));
  EXPECT_TRUE(text.ok());
  std::vector<Column> result;
  int row = 0;
  for (const std::string_view line : split(*text, '\n')) {
    if (line.empty()) continue;
    const auto words = split(line, ',');
    result.resize(words.size() - 1);
    for (std::size_t i = 1; i < words.size(); ++i) {
      Column& column = result[i - 1];
      if (row == 0) column.name = std::string(words[i]);
      if (row == 1) column.set = std::string(words[i]);
      if (row > 1) column.nm.push_back(*parse_number(words[0])), column.values.push_back(*parse_number(words[i]));
    }
    ++row;
  }
  return result;
}

TEST(Bands, DaylightIsWhite) {
  for (const int observer : {2, 10}) {
    const auto eye = BandObserver::make(observer);
    ASSERT_TRUE(eye.ok());
    const Rgb white = eye->rgb(even_bands(1));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(white[c], 1, 1e-12);
  }
  const Bands daylight = illuminant_bands("D65").value();
  for (const double band : daylight) EXPECT_NEAR(band, 1, 1e-12);
  EXPECT_FALSE(BandObserver::make(5).ok());
  EXPECT_FALSE(illuminant_bands("moon").ok());
}

// The CIE's whites of smooth lights and of lamps with lines.
TEST(Bands, LightsHaveTheirPublishedChromaticity) {
  const BandObserver eye = BandObserver::make().value();
  for (const char* name : {"A", "D50", "C", "D55", "D75", "F2", "F7", "F11"}) {
    const Xyz seen = xyz_d65_from_rgb(eye.rgb(illuminant_bands(name).value()));
    const Xyz printed = white_point({name, 2}).value();
    EXPECT_NEAR(seen.Y, xyz_d65_from_rgb({1, 1, 1}).Y, 1e-9) << name;
    const Xyz d65 = xyz_d65_from_rgb({1, 1, 1});
    const double apart = delta_e_2000(lab_from_xyz(seen, d65), lab_from_xyz(printed, d65));
    printf("%-4s dE00 %.3f\n", name, apart);
    EXPECT_LT(apart, name[0] == 'F' ? 0.7 : 0.2) << name;
  }
}

// Each patch and paint of the published tables in each light: 31 bands beside sums over the 5 nm of the tables. Steps
// of 10 nm blur the narrow peaks of LEDs and the lines of lamps. The bounds are what was measured, 0.41 and 0.51, and a
// fifth more.
TEST(Bands, AreNearToFinerSums) {
  const BandObserver eye = BandObserver::make().value();
  const auto lights = columns("published-lights.csv"), paints = columns("published-reflectances.csv");
  const Column& daylight = lights.front();
  ASSERT_EQ(daylight.set, "daylight");
  const SpectralColorimeter meter = SpectralColorimeter::make(daylight.nm, {"D65", 2}).value();
  const Xyz d65 = xyz_d65_from_rgb({1, 1, 1});
  std::vector<double> smooth, lines;
  for (const Column& light : lights) {
    const Bands of_light = light_bands(light.nm, light.values).value();
    std::vector<double> relative = light.values;
    for (std::size_t i = 0; i < relative.size(); ++i) relative[i] /= daylight.values[i];
    const double luminance = meter.xyz(relative).Y;
    for (const Column& paint : paints) {
      std::vector<double> sent = relative;
      for (std::size_t i = 0; i < sent.size(); ++i) sent[i] *= paint.values[i] / luminance;
      const Xyz fine = adapted(meter.xyz(sent), meter.white(), d65);
      const Xyz seen = xyz_d65_from_rgb(eye.rgb(product(of_light, reflectance_bands(paint.nm, paint.values).value())));
      const bool has_lines = light.name[0] == 'F' || light.name.starts_with("HP");
      (has_lines ? lines : smooth).push_back(delta_e_2000(lab_from_xyz(fine, d65), lab_from_xyz(seen, d65)));
    }
  }
  const auto tell = [](const char* what, std::vector<double>& all) {
    std::ranges::sort(all);
    double sum = 0;
    for (const double x : all) sum += x;
    printf("%s: %zu pairs, mean %.3f, p95 %.3f, max %.3f\n", what, all.size(), sum / static_cast<double>(all.size()),
           all[all.size() * 95 / 100], all.back());
    return all[all.size() * 95 / 100];
  };
  EXPECT_LT(tell("smooth lights and LEDs", smooth), 0.5);
  EXPECT_LT(tell("lamps with lines", lines), 0.62);
}

TEST(Bands, RefuseWhatIsNoSpectrum) {
  const std::vector<double> nm = {400, 550, 700}, falling = {700, 550, 400}, values = {1, 2, 3}, negative = {1, -2, 3},
                            none = {0, 0, 0}, within = {420, 550, 680};
  EXPECT_TRUE(light_bands(nm, values).ok());
  EXPECT_FALSE(light_bands(falling, values).ok());
  EXPECT_FALSE(light_bands(nm, negative).ok());
  EXPECT_FALSE(light_bands(nm, none).ok());
  EXPECT_FALSE(light_bands(within, values).ok());
  EXPECT_TRUE(reflectance_bands(within, values).ok());
  EXPECT_FALSE(reflectance_bands(std::vector<double>{500}, std::vector<double>{1}).ok());
  EXPECT_FALSE(reflectance_bands(nm, std::vector<double>{1, 2}).ok());
  // A straight line is met, and the outermost value is held.
  const Bands line = reflectance_bands(within, std::vector<double>{0.42, 0.55, 0.68}).value();
  EXPECT_NEAR(line[15], 0.55, 1e-12);
  EXPECT_NEAR(line[5], 0.45, 1e-12);
  EXPECT_NEAR(line[0], 0.42, 1e-12);
}

}  // namespace
}  // namespace goniochrome::color::bands_test
