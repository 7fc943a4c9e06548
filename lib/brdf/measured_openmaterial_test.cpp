// Tables of OpenMATERIAL 3D, made here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "brdf/measured.h"

namespace goniochrome::brdf::measured_openmaterial_test {
namespace {

using testing::HasSubstr;

std::string refusal(std::string_view bytes) {
  const auto brdf = read_measured("a.xompt", bytes);
  EXPECT_FALSE(brdf.ok());
  return brdf.ok() ? "" : brdf.error().message;
}

// A flake-like lobe, twice as strong at 400 as at 550 nm, as a table, wavelength by wavelength.
double lobe(const Vec3& light, const Vec3& view, int channel) {
  return (0.02 + 0.3 * std::exp(-3 * paint::aspecular_angle_rad(light, view, {0, 0, 1}))) / (1 << channel);
}

std::string openmaterial_text() {
  std::string rows;
  for (const int channel : {0, 1, 2})
    for (double in = .2; in < 1; in += .2)
      for (double out = 0; out < 1.2; out += .1)
        for (const double azimuth : {0.0, kPi / 2, kPi}) {
          const Vec3 light = {std::sin(in), 0, std::cos(in)};
          const Vec3 view = {std::sin(out) * std::cos(azimuth), std::sin(out) * std::sin(azimuth), std::cos(out)};
          rows += fmt::format("{}[{},{},{},{},{}]", rows.empty() ? "" : ",", (400 + 150 * channel) * 1e-9, in, out,
                              azimuth, lobe(light, view, channel));
        }
  return R"({"$schema":"https://x/OpenMATERIAL-3D/s.json","metadata":{"name":"lab"},"brdf":{"wavelengths":[],"lookupTable":[)" +
         rows + "]}}";
}

TEST(OpenMaterial, GivesItsOwnSamplesBack) {
  const auto brdf = read_measured("a.xompt", openmaterial_text());
  ASSERT_TRUE(brdf.ok()) << brdf.error().message;
  EXPECT_EQ((*brdf)->traits().format, "openmaterial");
  EXPECT_EQ((*brdf)->traits().description, "lab");
  EXPECT_EQ((*brdf)->traits().wavelengths_nm, (std::vector<double>{400, 550, 700}));
  for (const paint::DirectionPair& pair : (*brdf)->samples()) {
    const MeasuredValue value = (*brdf)->value(pair.light, pair.view);
    for (const int k : {0, 1, 2})
      EXPECT_NEAR(value.f[static_cast<std::size_t>(k)], lobe(pair.light, pair.view, k), 1e-5);
    EXPECT_EQ(value.outside_deg, 0);
  }
}

// The first of rows that contradict each other was taken in silence.
TEST(OpenMaterial, ContradictionsAreTold) {
  std::string text = openmaterial_text();
  text.insert(text.size() - 3,
              fmt::format(",[4e-7,0.2,0,0,9],[7e-7,0.2,0,0,{}]", lobe({std::sin(.2), 0, std::cos(.2)}, {0, 0, 1}, 2)));
  const auto brdf = read_measured("a.xompt", text);
  ASSERT_TRUE(brdf.ok()) << brdf.error().message;
  EXPECT_THAT((*brdf)->traits().findings,
              testing::ElementsAre(HasSubstr("1 rows repeat a wavelength and its directions with another BRDF")));
}

// A table of version 2.0.0 and a list of other wavelengths than those of the rows were read in silence.
TEST(OpenMaterial, ItsVersionAndItsListOfWavelengthsAreHeard) {
  const std::string text = openmaterial_text();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    return other.replace(other.find(from), from.size(), to);
  };
  const auto version = [&](const char* number) {
    return with(R"("name":"lab")", fmt::format(R"("name":"lab","openMaterial3dVersion":"{}")", number));
  };
  EXPECT_TRUE(read_measured("a.xompt", version("1.1.0")).ok());
  EXPECT_THAT(refusal(version("2.0.0")), HasSubstr("is of OpenMATERIAL 3D 2.0.0, and versions 1.x are read"));
  const auto found = [&](const char* list) {
    const auto brdf = read_measured("a.xompt", with(R"("wavelengths":[])", list));
    EXPECT_TRUE(brdf.ok());
    return brdf.ok() ? (*brdf)->traits().findings : std::vector<std::string>();
  };
  EXPECT_THAT(found(R"("wavelengths":[7e-7,4e-7,5.5e-7])"), testing::IsEmpty());
  EXPECT_THAT(found(R"("wavelengths":[4e-7,5e-7,7e-7])"),
              testing::ElementsAre("500 nm stands in its list of wavelengths and in no row of its table: the table "
                                   "counts"));
  EXPECT_THAT(found(R"("wavelengths":[4e-7,7e-7])"),
              testing::ElementsAre("550 nm stands in its table and not in its list of wavelengths: the table counts"));
}

TEST(OpenMaterial, RefusalsNameTheRow) {
  const std::string whole = openmaterial_text();
  const auto with = [&](const std::string& row) {
    return R"({"$schema":"OpenMATERIAL","brdf":{"lookupTable":[)" + row + "]}}";
  };
  EXPECT_THAT(refusal(whole.substr(0, whole.size() / 2)), HasSubstr("is no whole JSON: it breaks off at byte"));
  EXPECT_THAT(refusal(with("[4e-7,0,0,0]")), HasSubstr("row 1 of lookupTable has 4 numbers, and 5 make a row"));
  EXPECT_THAT(refusal(with("[4e-7,0,0,0,1],[4e-7,2,0,0,1]")),
              HasSubstr("row 2 of lookupTable has the incidence 2: give radians from the normal"));
  EXPECT_THAT(refusal(with("[4e-7,0,0,0,\"1\"]")), HasSubstr("holds a text where a number stands"));
  EXPECT_THAT(refusal(with("[400,0,0,0,1]")), HasSubstr("has the wavelength 400: give meters"));
  EXPECT_THAT(refusal(with("[4e-7,0,0,0,1]")), HasSubstr("has 1 wavelength"));
  EXPECT_THAT(refusal(with("[4e-7,0,0,0,null]")), HasSubstr("has null in every row of its lookupTable"));
  EXPECT_THAT(refusal(with("")), HasSubstr("has no brdf with a lookupTable"));
}

}  // namespace
}  // namespace goniochrome::brdf::measured_openmaterial_test
