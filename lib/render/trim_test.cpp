#include "render/trim.h"

#include <gtest/gtest.h>

#include "base/angles.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render::trim_test {
namespace {

double albedo(const char* name, const char* material = "") {
  const auto finish = trim_of({name, material, 0, 1}, true);
  // The reading at 45 and 0 deg, through the coat where there is one.
  return finish ? brdf::flake_reflectance_factor(*finish, 45).x : -1;
}

TEST(Trim, IsKnownByWholeWordsOfNameOrMaterial) {
  EXPECT_NEAR(albedo("Glass"), 0.005, 1e-12);
  EXPECT_NEAR(albedo("Window_FL"), 0.005, 1e-12);
  EXPECT_NEAR(albedo("Tire_FR"), 0.03, 1e-12);
  EXPECT_NEAR(albedo("part 7", "Rubber_Black"), 0.03, 1e-12);
  EXPECT_NEAR(albedo("RIM-2"), 0.2, 1e-12);
  EXPECT_NEAR(albedo("Tire_FR", "Glass"), 0.03, 1e-12) << "the name is meant before the material";
  // Controls: words that only begin like these, and painted parts.
  for (const char* painted : {"Hood", "Rimini", "Fiberglass", "Entire", "Steamer", ""}) EXPECT_EQ(albedo(painted), -1);
}

// Names of public cars. As whole words between other signs than letters none of them was known.
TEST(Trim, WordsBeginAtCapitalsToo) {
  for (const char* glass : {"WindowGlass", "CarWindow", "WindowTransparent1", "Window2Left", "glass", "GLASS", "Glass1",
                            "FRONTGlass", "rearWindow", "SideWindows"})
    EXPECT_NEAR(albedo(glass), 0.005, 1e-12) << glass;
  for (const char* black : {"TireRubber", "TyreFL", "RubberSeals"}) EXPECT_NEAR(albedo(black), 0.03, 1e-12) << black;
  for (const char* metal : {"ChromeTrim", "RIMFront", "WheelRim2"}) EXPECT_NEAR(albedo(metal), 0.2, 1e-12) << metal;
  for (const char* painted : {"FiberGlass", "fibre_glass", "MetallicPaint", "BodyPanel", "carwindowless", "RIMINI"})
    EXPECT_EQ(albedo(painted), -1) << painted;
}

TEST(Trim, LooksOfMaterialsTellWhereNamesDoNot) {
  const auto kind = [](const char* name, mesh::Look look) { return trim_kind({name, "", 0, 1, look}); };
  EXPECT_EQ(kind("Object7", mesh::Look::kClear), TrimKind::kGlass);
  EXPECT_EQ(kind("Object7", mesh::Look::kPolishedMetal), TrimKind::kMetal);
  EXPECT_EQ(kind("Tire", mesh::Look::kPolishedMetal), TrimKind::kBlack) << "the name is meant before the look";
  EXPECT_EQ(kind("CarPaint", mesh::Look::kPolishedMetal), std::nullopt);
  EXPECT_EQ(kind("Object7", mesh::Look::kUnknown), std::nullopt);
}

TEST(Trim, MirrorsOnlyWhereThatIsWanted) {
  EXPECT_EQ(trim_of({"Glass", "", 0, 1}, true)->lobes.size(), 1U);
  EXPECT_TRUE(trim_of({"Glass", "", 0, 1}, false)->lobes.empty());
  EXPECT_TRUE(trim_of({"Seams", "", 0, 1}, true)->lobes.empty());
}

}  // namespace
}  // namespace goniochrome::render::trim_test
