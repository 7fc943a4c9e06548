#include "render/trim.h"

#include <gtest/gtest.h>

#include "base/angles.h"
#include "brdf/lobe_model.h"

namespace goniochrome::render::trim_test {
namespace {

double albedo(const char* name, const char* material = "") {
  const auto finish = trim_of({name, material, 0, 1}, true);
  // As read at 45 and 0 deg, through the coat where there is one.
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

TEST(Trim, MirrorsOnlyWhereThatIsWanted) {
  EXPECT_EQ(trim_of({"Glass", "", 0, 1}, true)->lobes.size(), 1U);
  EXPECT_TRUE(trim_of({"Glass", "", 0, 1}, false)->lobes.empty());
  EXPECT_TRUE(trim_of({"Seams", "", 0, 1}, true)->lobes.empty());
}

}  // namespace
}  // namespace goniochrome::render::trim_test
