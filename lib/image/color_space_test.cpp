// Color spaces that a picture states, and what contradicts them.
#include "image/color_space.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(ColorSpace, LogarithmsAreRefusedWithChromaticitiesToo) {
  for (const std::string space : {"KodakLog", "ACEScct"}) {
    const auto image = read_as(space);
    ASSERT_FALSE(image.ok()) << space;
    EXPECT_THAT(image.error().message, HasSubstr("its color space is \"" + space + "\", which is not known"));
  }
}

}  // namespace
}  // namespace goniochrome::image::color_space_test
