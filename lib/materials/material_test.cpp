#include "materials/material.h"

#include <gtest/gtest.h>

#include "materials/internal/paints_for_test.h"

namespace goniochrome::materials::material_test {
namespace {

TEST(Identifiers, HoldNothingThatAFormatOrAFileSystemMinds) {
  Identifiers names;
  EXPECT_EQ(names.of("candy_red"), "candy_red");
  EXPECT_EQ(names.of("../../evil"), "_evil");
  EXPECT_EQ(names.of("9 lives"), "_9_lives");
  EXPECT_EQ(names.of("Gr\xc3\xbcn"), "Gr_n");
  EXPECT_EQ(names.of(""), "paint");
  EXPECT_EQ(names.of(std::string(1000, 'n')).size(), 64U);
  EXPECT_EQ(names.of(std::string("a\0b", 3)), "a_b");
}

TEST(Identifiers, AreAllDifferent) {
  Identifiers names;
  EXPECT_EQ(names.of("a b"), "a_b");
  EXPECT_EQ(names.of("a/b"), "a_b_2");
  EXPECT_EQ(names.of("a_b_2"), "a_b_2_2");
  EXPECT_EQ(names.of("A_B"), "A_B_3");
}

TEST(Material, EveryTargetRefusesAPaintWithoutLobes) {
  paint::Paint bare;
  bare.name = "bare";
  for (const Target* target : targets()) {
    const auto material = target->material(bare, {"bare", "bare", "test", {}});
    ASSERT_FALSE(material.ok());
    EXPECT_EQ(material.error().message, "paint \"bare\" has no lobes: fit it by fit-paint first");
  }
}

// A lobe of GGX is narrower than a cosine lobe beside the plane of the viewer. Graphs with round lobes alone were 8
// dE00 off there in the mean over many paints.
TEST(Material, AGraphHoldsBesideThePlaneOfIncidence) {
  const auto graph = kMaterialX.material(silver_for_test(), {"a", "a", "test", {}});
  ASSERT_TRUE(graph.ok());
  const auto& all = graph->shown.by_geometry;
  const auto beside = std::ranges::find_if(all, [](const DifferenceAt& at) { return at.geometry.out_of_plane; });
  ASSERT_NE(beside, all.end());
  EXPECT_LE(beside->de00, 3.5);
}

// Tints are not below 0, so that a graph in Rec.709 cannot show such a blue.
TEST(Material, AGraphKeepsColorsOutsideOfRec709) {
  const paint::Paint paint =
      paint_for_test("blue", {0.001, 0.01, 0.04}, {{6, {0, 0.02, 0.15}, {}}, {20, {0, 0.03, 0.3}, {}}}, 1.5);
  const auto graph = kMaterialX.material(paint, {"blue", "blue", "test", {}});
  ASSERT_TRUE(graph.ok());
  EXPECT_NE(graph->bytes.find("colorspace=\"acescg\""), std::string::npos);
  EXPECT_LE(graph->shown.de00_mean, 2);
}

// A table cannot hold light below 0. In Rec.709 such a blue is cut, and that is told; ACEScg has it.
TEST(Material, ATableOfMdlInAcescgHasColorsOutsideOfRec709) {
  const paint::Paint paint =
      paint_for_test("blue", {0.001, 0.01, 0.04}, {{6, {0, 0.02, 0.15}, {}}, {20, {0, 0.03, 0.3}, {}}}, 1.5);
  const auto narrow = kMdl.material(paint, {"blue", "blue", "test", {}}),
             wide = kMdlAcescg.material(paint, {"blue", "blue", "test", {}});
  ASSERT_TRUE(narrow.ok() && wide.ok());
  EXPECT_LE(wide->shown.de00_mean, 0.3);
  EXPECT_TRUE(wide->left_out.empty());
  EXPECT_GT(narrow->shown.de00_mean, 3);
  EXPECT_EQ(narrow->left_out, std::vector<std::string>{"the part of its colors outside of Rec.709"});
}

// Gloss counts by the light alone, and weights by views by the viewer: both are tables of their own.
TEST(Material, ATableOfMdlHoldsGlossAndViews) {
  paint::Paint paint = satin_for_test();
  paint::LobeFit& lobes = *paint.lobes;
  for (const double view_deg : {0.0, 60.0}) {
    paint::ViewLobes view{view_deg, lobes.diffuse, lobes.lobes};
    for (paint::Lobe& lobe : view.lobes) lobe.directional_diffuse = (1 + view_deg / 30) * lobe.directional_diffuse;
    lobes.views.push_back(view);
  }
  const auto table = kMdl.material(paint, {"satin", "satin", "test", {}});
  ASSERT_TRUE(table.ok());
  EXPECT_LE(table->shown.de00_mean, 0.3);
}

// A surface has to have a node, also where nothing is reflected.
TEST(Material, AGraphOfBlackHasANode) {
  const auto graph =
      kMaterialX.material(paint_for_test("black", {}, {}, paint::kNoCoat), {"black", "black", "test", {}});
  ASSERT_TRUE(graph.ok());
  EXPECT_EQ(graph->shown.de00_max, 0);
  EXPECT_NE(graph->bytes.find("type=\"BSDF\" nodename=\"black_diffuse1_tint\""), std::string::npos);
}

// The mixture of a metal and a dielectric is what OpenPBR has beside Standard Surface.
TEST(Material, OpenPbrIsAsNearAsStandardSurface) {
  const auto one = kStandardSurface.material(silver_for_test(), {"a", "a", "test", {}}),
             both = kOpenPbr.material(silver_for_test(), {"a", "a", "test", {}});
  ASSERT_TRUE(one.ok() && both.ok());
  EXPECT_LE(both->shown.de00_mean, one->shown.de00_mean + 0.05);
}

// A diffuse paint without a coat is the same in every model here: each of them has a diffuse part of its own.
TEST(Material, ADiffusePaintIsExactInEveryTarget) {
  const paint::Paint paint = paint_for_test("matt", {0.1, 0.12, 0.09}, {}, paint::kNoCoat);
  for (const Target* target : targets()) {
    if (target == &kRglSpectral || target == &kOpenMaterial) continue;  // a colored paint has to have spectra
    const auto material = target->material(paint, {"matt", "matt", "test", {}});
    ASSERT_TRUE(material.ok());
    EXPECT_LE(material->shown.de00_max, 0.3) << target->name;
  }
}

// Stated flakes are attributes of a graph; other targets say that they have none.
TEST(Material, AGraphStatesTheFlakes) {
  paint::Paint paint = silver_for_test();
  const Naming naming{"a", "a", "test", {}};
  EXPECT_EQ(kMaterialX.material(paint, naming)->bytes.find("flake_"), std::string::npos);
  paint.flakes = paint::Flakes{25, 0.4, 0.7};
  const std::string bytes = kMaterialX.material(paint, naming)->bytes;
  EXPECT_NE(bytes.find("flake_diameter_um=\"25\" flake_coverage=\"0.4\" flake_spread_deg=\"0.7\">"), std::string::npos);
  EXPECT_TRUE(left_out(paint, kMaterialX).empty());
  EXPECT_EQ(left_out(paint, kGltf), std::vector<std::string>{"its flakes"});
}

// A graph has many lobes, of which each has its color; glTF has one roughness. The readings between face and flop need
// several.
TEST(Material, AGraphIsNearerThanTheParametersOfOneLobe) {
  const paint::Paint paint = silver_for_test();
  const auto graph = kMaterialX.material(paint, {"a", "a", "test", {}}),
             one = kGltf.material(paint, {"a", "a", "test", {}});
  ASSERT_TRUE(graph.ok() && one.ok());
  EXPECT_LT(graph->shown.de00_mean, one->shown.de00_mean);
}

}  // namespace
}  // namespace goniochrome::materials::material_test
