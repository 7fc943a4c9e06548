#include "sketch/internal/sketch_gloss.h"

#include <gtest/gtest.h>

#include "base/angles.h"
#include "brdf/gloss.h"
#include "math/cosine_power.h"

namespace goniochrome::sketch::sketch_gloss_test {
namespace {

TEST(SketchGloss, ContrastMapsTo0And100) {
  std::vector<double> flat(50, 0.4), half, full;
  for (int i = 0; i < 100; ++i) half.push_back(i < 50 ? 0.25 : 0.5), full.push_back(i < 50 ? 0.1 : 0.9);
  EXPECT_EQ(contrast_gloss(flat), 0);
  EXPECT_NEAR(contrast_gloss(half), 50, 1e-12);
  EXPECT_EQ(contrast_gloss(full), 100);  // the control, without its cap, is 160
  std::vector<double> one = {0.3}, none;
  EXPECT_EQ(contrast_gloss(one), 0);
  EXPECT_EQ(contrast_gloss(none), 0);
}

// A highlight of one lobe reads what the simulated meter reads on that lobe; its own exponent lies between two of the
// fit's, whose mixture differs by some percent.
TEST(SketchGloss, HighlightReadsLikeItsLobe) {
  for (const double exponent : {90.0, 400.0, 1500.0}) {
    const double weight = 0.04 * (exponent + 1) / (2 * kPi);
    std::vector<HighlightSample> samples;
    for (double t = 0.1; t < 15; t += 0.05)
      samples.push_back({t, kPi * weight * math::cos_power(t * kDegree, exponent)});
    const brdf::GlossTable table({exponent});
    paint::LobeFit lobe;
    lobe.lobes.push_back({exponent, {}, {weight, weight, weight}});
    const double meter = brdf::gloss_units(table, **table.at(60), lobe);
    const auto found = highlight_gloss(samples);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, meter, 0.1 * meter) << exponent;
  }
}

TEST(SketchGloss, NoHighlightIsNoReading) {
  std::vector<HighlightSample> dark, far;
  for (double t = 0; t < 15; t += 0.1) dark.push_back({t, 0}), far.push_back({t + 3, 1});
  EXPECT_FALSE(highlight_gloss(dark));
  EXPECT_FALSE(highlight_gloss(far));
  EXPECT_FALSE(highlight_gloss({}));
}

}  // namespace
}  // namespace goniochrome::sketch::sketch_gloss_test
