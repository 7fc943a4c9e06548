#include "sketch/internal/sketch_icc.h"

#include <gmock/gmock.h>

#include <cmath>

namespace goniochrome::sketch {
namespace {

using testing::HasSubstr;

void put32(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes[at + i] = static_cast<char>(value >> (24 - 8 * i));
}

// A profile with Display P3's colorants and a gamma of 2.
std::string p3_profile() {
  const double xyz[3][3] = {{0.51512, 0.2412, -0.00105}, {0.29198, 0.69225, 0.04189}, {0.1571, 0.06657, 0.78407}};
  std::string bytes(132 + 6 * 12 + 3 * 20 + 14, '\0');
  bytes.replace(16, 4, "RGB "), bytes.replace(36, 4, "acsp");
  put32(bytes, 128, 6);
  const std::size_t data = 132 + 6 * 12;
  const char* names[] = {"rXYZ", "gXYZ", "bXYZ", "rTRC", "gTRC", "bTRC"};
  for (int i = 0; i < 6; ++i) {
    bytes.replace(132 + 12 * i, 4, names[i]);
    put32(bytes, 136 + 12 * i, static_cast<std::uint32_t>(data + (i < 3 ? 20 * i : 60)));
    put32(bytes, 140 + 12 * i, i < 3 ? 20 : 14);
  }
  for (int i = 0; i < 3; ++i) {
    bytes.replace(data + 20 * i, 4, "XYZ ");
    for (int c = 0; c < 3; ++c)
      put32(bytes, data + 20 * i + 8 + 4 * c, static_cast<std::uint32_t>(std::lround(xyz[i][c] * 65536)));
  }
  bytes.replace(data + 60, 4, "curv");
  put32(bytes, data + 68, 1);
  bytes[data + 72] = 2, bytes[data + 73] = 0;
  return bytes;
}

// The white of the working space to the rounding of the profile's own numbers, 1/65536 and five digits.
TEST(SketchIcc, FollowsAMatrixProfile) {
  const auto profile = parse_icc(p3_profile(), "p3.png");
  ASSERT_TRUE(profile.ok()) << profile.error().message;
  const color::Rgb white = profile->rgb(1, 1, 1), gray = profile->rgb(0.5F, 0.5F, 0.5F), red = profile->rgb(1, 0, 0);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(white[c], 1, 1e-3);
    EXPECT_NEAR(gray[c], 0.25, 1e-3);
  }
  const color::Rgb srgb_red = color::rec2020_from_rec709({1, 0, 0});
  EXPECT_GT(red.x, srgb_red.x);  // P3's red is purer
  EXPECT_LT(red.y, srgb_red.y);
}

TEST(SketchIcc, RefusesOtherProfilesWithTheRemedy) {
  std::string cmyk = p3_profile(), lut = p3_profile();
  cmyk.replace(16, 4, "CMYK"), lut.replace(132, 4, "A2B0");
  for (const auto& [bytes, words] : {std::pair<std::string, std::string>{cmyk, "is for CMYK"},
                                     {lut, "maps by tables"},
                                     {p3_profile().substr(0, 100), "damaged"},
                                     {std::string(200, 'x'), "damaged"}}) {
    const auto profile = parse_icc(bytes, "a.png");
    ASSERT_FALSE(profile.ok());
    EXPECT_THAT(profile.error().message, HasSubstr("a.png: "));
    EXPECT_THAT(profile.error().message, HasSubstr(words));
    EXPECT_THAT(profile.error().message, HasSubstr("convert the image to sRGB"));
  }
}

TEST(SketchIcc, NeverReadsPastTheEndOfACutProfile) {
  const std::string whole = p3_profile();
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto profile = parse_icc(whole.substr(0, size), "cut.png");
    EXPECT_TRUE(!profile.ok() || std::isfinite(profile->rgb(1, 1, 1).x));
  }
}

}  // namespace
}  // namespace goniochrome::sketch
