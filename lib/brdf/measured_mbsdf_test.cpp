// Headers and parts of MBSDF files, made here; their grids are tested in measured_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "brdf/measured.h"

namespace goniochrome::brdf::measured_mbsdf_test {
namespace {

using testing::Contains;
using testing::HasSubstr;

void put(std::string& bytes, std::uint32_t value) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(value >> 8 * i & 0xff);
}

// A green whose f is the same in all directions.
std::string file(const std::string& header, const std::string& mark = "MBSDF_DATA_REFLECTION=\n") {
  constexpr std::uint32_t kSteps = 10;
  std::string bytes = "NVIDIA ARC MBSDF V1\n" + header + mark;
  for (const std::uint32_t n : {1u, kSteps, kSteps}) put(bytes, n);
  for (std::uint32_t i = 0; i < kSteps * kSteps * kSteps; ++i)
    for (const float f : {.05F, .1F, .05F}) put(bytes, std::bit_cast<std::uint32_t>(f));
  return bytes;
}

std::vector<double> straight_back(std::string_view bytes) {
  const auto brdf = read_measured("a.mbsdf", bytes);
  EXPECT_TRUE(brdf.ok()) << brdf.error().message;
  return brdf.ok() ? (*brdf)->value({0, 0, 1}, {0, 0, 1}).f : std::vector<double>{};
}

// The mark of files that hold reflection alone was refused as a file without reflection.
TEST(Mbsdf, ReflectionHasTwoMarks) {
  EXPECT_EQ(straight_back(file("", "MBSDF_DATA=\n")), straight_back(file("")));
}

// Any colorspace but acescg was read as Rec.709.
TEST(Mbsdf, StatedColorspaceIsHeard) {
  EXPECT_EQ(straight_back(file("colorspace=\"lin_rec709\"\n")), straight_back(file("")));
  EXPECT_NE(straight_back(file("colorspace=\"acescg\"\n")), straight_back(file("")));
  const auto other = read_measured("a.mbsdf", file("colorspace=\"lin_rec2020\"\n"));
  ASSERT_FALSE(other.ok());
  EXPECT_EQ(
      other.error().message,
      "a.mbsdf: its colorspace is \"lin_rec2020\", and lin_rec709 and acescg are read: convert it to one of them");
}

TEST(Mbsdf, DescriptionAndTransmissionAreTold) {
  const auto brdf = read_measured("a.mbsdf", file("description=\"silver\"\n"));
  ASSERT_TRUE(brdf.ok());
  EXPECT_EQ((*brdf)->traits().description, "silver");
  const auto both = read_measured("a.mbsdf", file("") + "MBSDF_DATA_TRANSMISSION=\n" + file("", "").substr(20));
  ASSERT_TRUE(both.ok());
  EXPECT_THAT(checks(**both).warnings, Contains(HasSubstr("light that goes through are left out")));
  const auto through = read_measured("a.mbsdf", file("", "MBSDF_DATA_TRANSMISSION=\n"));
  ASSERT_FALSE(through.ok());
  EXPECT_THAT(through.error().message, HasSubstr("export a measurement of reflected light"));
}

}  // namespace
}  // namespace goniochrome::brdf::measured_mbsdf_test
