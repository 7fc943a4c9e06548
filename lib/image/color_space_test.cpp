// Color spaces that a picture states, and what contradicts them.
#include "image/color_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace goniochrome::image::color_space_test {
namespace {

using testing::HasSubstr;

// One gray pixel of floats, with primaries and the name of a color space.
Result<Image> read_as(const std::string& space) {
  ImagePart part;
  part.image = {1, 1, 3, {.5F, .5F, .5F}, {"R", "G", "B"}};
  part.attributes["chromaticities"] = std::vector<float>{.708F, .292F, .17F, .797F, .131F, .046F, .3127F, .329F};
  part.attributes["oiio:ColorSpace"] = space;
  return working_space_rgb(std::move(part), "x.exr");
}

// Chromaticities made floats linear, whatever curve their space has.
TEST(ColorSpace, ChromaticitiesLeaveTheCurve) {
  for (const auto& [space, wanted] :
       {std::pair<std::string, double>{"linear", .5}, {"sRGB", .21404}, {"Gamma2", .25}, {"a space of its own", .5}}) {
    const auto image = read_as(space);
    ASSERT_TRUE(image.ok()) << image.error().message;
    EXPECT_NEAR(image->data[1], wanted, 1e-4) << space;
  }
}

// White was D65 for any adoptedNeutral of a file.
// A red of .5 behind an alpha of .5 is stored as .25 or becomes it in a reader. Its curve bends .5 and not .25.
TEST(ColorSpace, ACurveTakesSignalsWithoutTheirAlpha) {
  constexpr double kLight = .21404114048223255;  // of the sRGB signal .5
  const auto light = [](float red, float alpha) {
    ImagePart part{"", {1, 1, 4, {red, red, red, alpha}, {"R", "G", "B", "A"}}, {}};
    part.attributes["goniochrome:integer"] = 1;
    return working_space_rgb(part, "x.png").value().data[1];
  };
  EXPECT_NEAR(light(.25F, .5F), .5 * kLight, 1e-6);
  EXPECT_GT(std::fabs(kLight * .5 - light(.25F, 1)), .05) << "control";
  EXPECT_NEAR(light(.5F, 0), kLight, 1e-6) << "light without a surface stays";
  EXPECT_NEAR(light(.5F, .25F), kLight, 1e-6) << "and so does a pixel brighter than its alpha";
}

TEST(ColorSpace, TheAdoptedNeutralBecomesWhite) {
  const auto read = [](std::vector<float> neutral) {
    ImagePart part;
    // Light of the chromaticity of D50 and Y = .5 in linear Rec.709. [IEC 61966-2-1]
    const double x = .3457, y = .3585, X = .5 * x / y, Z = .5 * (1 - x - y) / y;
    part.image = {1, 1, 3, {}, {"R", "G", "B"}};
    for (const auto& [r, g, b] : {std::array{3.24097, -1.53738, -.49861}, std::array{-.96924, 1.87597, .04156},
                                  std::array{.05563, -.20398, 1.05697}})
      part.image.data.push_back(static_cast<float>(r * X + g * .5 + b * Z));
    if (!neutral.empty()) part.attributes["adoptedNeutral"] = std::move(neutral);
    return working_space_rgb(std::move(part), "x.exr");
  };
  const auto gray = read({.3457F, .3585F}), yellow = read({});
  ASSERT_TRUE(gray.ok() && yellow.ok());
  for (const float value : gray->data) EXPECT_NEAR(value, .5, 1e-4);
  EXPECT_GT(yellow->data[0] - yellow->data[2], .05);
  EXPECT_THAT(read({.5F, 0}).error().message, HasSubstr("x.exr: its adoptedNeutral is 0.5,0"));
}

TEST(ColorSpace, LogarithmsAreRefusedWithChromaticitiesToo) {
  for (const std::string space : {"KodakLog", "ACEScct"}) {
    const auto image = read_as(space);
    ASSERT_FALSE(image.ok()) << space;
    EXPECT_THAT(image.error().message, HasSubstr("its color space is \"" + space + "\", which is not known"));
  }
}

}  // namespace
}  // namespace goniochrome::image::color_space_test
