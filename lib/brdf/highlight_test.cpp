#include "brdf/highlight.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "brdf/disc_light.h"

namespace goniochrome::brdf::highlight_test {
namespace {

paint::LobeFit glossy(double exponent) {
  paint::LobeFit fit;
  fit.lobes.push_back({exponent, {}, {1, 1, 1}});
  return fit;
}

// Under a lamp that is nearly a point a lobe falls to half where cos^E is a half.
TEST(Highlight, EdgeOfALobeUnderASmallLampIsThatOfItsCosine) {
  for (const double exponent : {2.0, 30.0, 400.0, 5000.0}) {
    const double truth = std::acos(std::exp2(-1 / exponent)) / kDegree;
    // The disc of .002 deg changes the edge by the square of its share of the edge, below 1e-5.
    EXPECT_NEAR(highlight_edge_deg(glossy(exponent), 0.002), truth, 1e-5 * truth) << exponent;
  }
}

// A lobe much narrower than the lamp shows its image, which falls to half at the rim.
TEST(Highlight, EdgeOfAMirrorIsTheRimOfTheLamp) {
  EXPECT_NEAR(highlight_edge_deg(glossy(1e6), 10), 5, 0.05);
  paint::LobeFit mirror;
  mirror.lobes.push_back({paint::kMirrorExponent, {}, {0.04, 0.04, 0.04}});
  EXPECT_NEAR(highlight_edge_deg(mirror, 10), 5, 1e-6);
  EXPECT_EQ(highlight_edge_deg(paint::LobeFit(), 10), 0);
}

TEST(Highlight, WiderEdgesHaveLessGlossDownToTheLamp) {
  double last = 101;
  for (const double edge : {2.5, 4.0, 8.0, 16.0, 32.0}) {
    const auto gloss = gloss_of_edge(edge, 60, 4);
    ASSERT_TRUE(gloss.ok());
    EXPECT_LT(*gloss, last) << edge;
    last = *gloss;
  }
  EXPECT_EQ(*gloss_of_edge(0.5, 60, 4), *gloss_of_edge(1.5, 60, 4)) << "both lie within the lamp";
  EXPECT_FALSE(gloss_of_edge(5, 61, 4).ok());
}

}  // namespace
}  // namespace goniochrome::brdf::highlight_test
