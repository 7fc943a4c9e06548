// The lobes that explain samples best, and the gloss that they are given.
#include "sketch/internal/sketch_lobes.h"

#include <gtest/gtest.h>

#include <random>

#include "brdf/lobe_model.h"
#include "sketch/internal/sketch_scene_for_test.h"
#include "sketch/sketch.h"

namespace goniochrome::sketch::sketch_lobes_test {
namespace {

const brdf::GlossTable& table() {
  static const brdf::GlossTable one(sketch_scene::basis().exponents);
  return one;
}

// A metallic under the coat that its gloss asks for.
paint::LobeFit glossy(double gloss_60_gu) {
  std::vector<color::Rgb> weights(search_columns(sketch_scene::basis()));
  weights[0] = {0.02, 0.03, 0.01}, weights[1] = {0.05, 0.02, 0.06}, weights[5] = {0.1, 0.05, 0.02};
  paint::LobeFit lobes = lobes_of(sketch_scene::basis(), weights, *brdf::coat_index_of({{60, gloss_60_gu}}));
  EXPECT_TRUE(brdf::set_gloss(table(), {{60, gloss_60_gu}}, lobes).ok());
  return lobes;
}

double mirror_of(const paint::LobeFit& lobes) {
  return lobes.lobes.back().gloss.y;
}

// The light was traced under the usual coat, and the paint has the coat that its reading asks for. Both are the same
// arithmetic, so that they agree to rounding. The control: the reading under the usual coat, which takes more mirror.
TEST(GiveGloss, IsThatOfAPaintUnderTheCoatThatItsReadingAsksFor) {
  for (const double gloss : {90.8, 91.3, 92.6}) {
    const paint::LobeFit paint = glossy(gloss);
    ASSERT_GT(paint.coat_index, brdf::kCoatIndex);
    const paint::LobeFit wanted = brdf::under_coat(paint, brdf::kCoatIndex);
    paint::LobeFit found = wanted, plain = wanted;
    for (paint::Lobe& lobe : found.lobes) lobe.gloss = {};
    ASSERT_TRUE(give_gloss(table(), gloss, found));
    EXPECT_EQ(found.coat_index, brdf::kCoatIndex);
    for (std::size_t j = 0; j < found.lobes.size(); ++j)
      EXPECT_NEAR(found.lobes[j].gloss.y, wanted.lobes[j].gloss.y, 1e-9 * (1 + wanted.lobes[j].gloss.y)) << gloss;
    ASSERT_TRUE(brdf::set_gloss(table(), {{60, gloss}}, plain).ok());
    EXPECT_GT(std::abs(mirror_of(plain) - mirror_of(wanted)), 0.01) << "the control must fail";
  }
}

// Light that the mirror sees far brighter than the lobes do, as that of a sun, tells the share of the mirror; a reading
// that is off by a hundredth of a unit shows. The control: the sections of find() alone.
TEST(FreeLobeFit, TheShareOfTheMirrorIsFoundToHalfAPercent) {
  std::mt19937_64 random(5);
  const formats::Basis& basis = sketch_scene::basis();
  SearchSamples samples;
  samples.columns = 2 * basis.exponents.size() + 2;
  samples.coat_index = brdf::kCoatIndex;
  const paint::LobeFit truth = brdf::under_coat(glossy(90.8), brdf::kCoatIndex);
  const std::vector<color::Rgb> weights = weights_of(basis, truth);
  std::uniform_real_distribution<double> light(0.2, 1.0);
  std::vector<color::Lab> target;
  for (int i = 0; i < 500; ++i) {
    for (std::size_t k = 0; k < samples.columns; ++k) {
      const double bright = k + 1 == samples.columns && i % 10 == 0 ? 5 : light(random);
      const double solid = k == 0 || k + 1 == samples.columns ? 1 : 2 * kPi / (basis.exponents[(k - 1) / 2] + 1);
      samples.light.push_back((k + 1 == samples.columns ? 0.04 * bright : solid * bright) * Vec3{1, 1, 1});
    }
    samples.seen.push_back(shown_light(samples.columns_of(static_cast<std::size_t>(i)), weights, {}));
    target.push_back(paint_lab(samples.seen.back()));
    samples.importance.push_back(1);
  }
  const FreeLobeFit fit(basis, table(), samples, target);
  const FreeLobes found = fit.find(), sharp = fit.sharpened(found);
  const auto off = [&](const FreeLobes& lobes) { return std::abs(lobes.weights.back().y - weights.back().y); };
  EXPECT_LT(off(sharp), 0.005);
  EXPECT_LE(sharp.cost, found.cost);
  EXPECT_GT(off(found), 2 * off(sharp)) << "the control must fail";
}

}  // namespace
}  // namespace goniochrome::sketch::sketch_lobes_test
