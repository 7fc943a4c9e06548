#include "paint/inferred_class.h"

#include <gtest/gtest.h>

namespace goniochrome::paint::inferred_class_test {
namespace {

std::optional<PaintClass> inferred(const color::Lab& at_15, const color::Lab& at_45, const color::Lab& at_110,
                                   std::vector<TextureReading> textures = {}) {
  Paint paint;
  paint.measurement =
      Measurement{{},
                  "",
                  {{{.aspecular_deg = 15}, at_15}, {{.aspecular_deg = 45}, at_45}, {{.aspecular_deg = 110}, at_110}},
                  {},
                  std::move(textures)};
  return inferred_class(paint, *metrics(paint));
}

// Readings of a solid panel, and of typical effect paints.
TEST(InferredClass, FollowsFromFlopHueTravelAndSparkle) {
  EXPECT_EQ(inferred({43, 60, 35}, {42.2, 58, 34}, {41.7, 57, 33}), PaintClass::kSolid);
  EXPECT_EQ(inferred({4.1, 0.3, 0.4}, {2.3, 0.3, 0.3}, {1.7, 0.3, 0.3}), PaintClass::kSolid);
  EXPECT_EQ(inferred({117, -0.5, 0.7}, {67, -0.7, 0.2}, {40, -0.5, -1}), PaintClass::kMetallic);
  EXPECT_EQ(inferred({55, 13, -40}, {34, 11, -37}, {22, 12, -34}), PaintClass::kPearl);
  EXPECT_EQ(inferred({62, -40, -25}, {32, -5, -40}, {12, 25, -20}), PaintClass::kInterference);
  EXPECT_EQ(inferred({43, 60, 35}, {42.2, 58, 34}, {41.7, 57, 33}, {{"Sparkle Grade", "15d", "", 3.1}}), std::nullopt);
}

TEST(InferredClass, IsUnknownWhereReadingsDoNotDecide) {
  EXPECT_EQ(inferred({101, 0, 16}, {92, 1, 8}, {89, 1, 3}), std::nullopt);      // a white pearl looks much like a solid
  EXPECT_EQ(inferred({34, -2, -7}, {11, -1, -6}, {3.9, 0, -3}), std::nullopt);  // a dark metallic or a dark pearl
  EXPECT_EQ(inferred({50, -5, -46}, {22, 8, -40}, {8, 14, -28}),
            std::nullopt);  // a blue turns its hue without pigments
  Paint paint;
  paint.measurement = Measurement{{}, "", {{{.aspecular_deg = 45}, {50, 0, 0}}}};
  EXPECT_EQ(inferred_class(paint, *metrics(paint)), std::nullopt);
}

}  // namespace
}  // namespace goniochrome::paint::inferred_class_test
