#include "render/textures/texture_filter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "base/angles.h"
#include "base/random_for_test.h"

namespace goniochrome::render::texture_filter_test {
namespace {

constexpr int kWidth = 7, kHeight = 5;

// A footprint of so many texels along each side, turned by `angle_rad`.
TexturePlace footprint(double u, double v, double across, double down, double angle_rad) {
  TexturePlace place;
  place.u = static_cast<float>(u), place.v = static_cast<float>(v);
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  place.across[0] = static_cast<float>(across * c / kWidth), place.across[1] = static_cast<float>(across * s / kHeight);
  place.down[0] = static_cast<float>(-down * s / kWidth), place.down[1] = static_cast<float>(down * c / kHeight);
  return place;
}

// The contribution of a texel of so many to a pixel's mean, by a fine grid.
double true_share(const TexturePlace& place, std::size_t texel) {
  constexpr int kSteps = 80;
  const FilterProbes grid{0, kSteps, kSteps};
  double sum = 0;
  for (int i = 0; i < grid.count(); ++i) {
    const TexturePlace at = probe_place(place, 1, grid, i);
    for (const brdf::TextureTap& tap : brdf::texture_taps(kWidth, kHeight, at.u, at.v))
      if (static_cast<std::size_t>(tap.row * kWidth + tap.column) == texel) sum += tap.weight;
  }
  return sum / grid.count();
}

// Footprints of up to three texels: the shares of all texels are those of the true mean. The control is one probe a
// texel, as it would be without looking for edges.
TEST(TextureFilter, SharesOfTexelsAreThoseOfTheMean) {
  TestNumbers random(3);
  double worst = 0, control = 0;
  int between = 0, across_edges = 0;
  SeenTexels seen, of_coarse;
  const auto length = [&] { return 0.05 + 3 * std::pow(random(), 3); };
  for (int i = 0; i < 60; ++i) {
    const TexturePlace place = footprint(random(), random(), length(), length(), 2 * kPi * random());
    const FilterProbes probes = filter_probes(place, 1, kWidth, kHeight, 3);
    ASSERT_EQ(probes.level, 0);
    (is_between_texels(place, 1, kWidth, kHeight) ? between : across_edges) += 1;
    const auto texels = [&](const float* step) { return std::hypot(step[0] * kWidth, step[1] * kHeight); };
    const FilterProbes coarse{0, static_cast<int>(std::ceil(texels(place.across))),
                              static_cast<int>(std::ceil(texels(place.down)))};
    for (const auto& [grid, error] : {std::pair{&probes, &worst}, {&coarse, &control}}) {
      SeenTexels& by = grid == &probes ? seen : of_coarse;
      std::set<std::size_t> met;
      double whole = 0;
      for (const TexelShare& one : by.of(place, 1, *grid, kWidth, kHeight)) {
        EXPECT_TRUE(met.insert(one.texel).second);
        whole += one.share;
        *error = std::max(*error, std::abs(one.share - true_share(place, one.texel)));
      }
      EXPECT_NEAR(whole, 1, 1e-5);
    }
  }
  EXPECT_GT(between, 5);
  EXPECT_GT(across_edges, 20);
  EXPECT_LT(worst, 0.04) << "of 1";  // half of it where a turned footprint lies between texels: the bilinear part
  EXPECT_GT(control, 3 * worst);
}

TEST(TextureFilter, OneProbeWhereNoEdgeIs) {
  // The middle of texel 3 is at u = 3.5/7; between it and the next lie footprints shorter than a texel.
  EXPECT_EQ(filter_probes(footprint(4.0 / kWidth, 3.0 / kHeight, 0.9, 0.9, 0), 1, kWidth, kHeight, 3).count(), 1);
  EXPECT_GT(filter_probes(footprint(3.5 / kWidth, 3.0 / kHeight, 0.9, 0.9, 0), 1, kWidth, kHeight, 3).count(), 4);
  // One texel is the same everywhere, and so is one column from left to right.
  EXPECT_EQ(filter_probes(footprint(0.5, 0.5, 60, 60, 0), 1, 1, 1, 0).count(), 1);
  EXPECT_TRUE(is_between_texels(footprint(0.5, 3.0 / kHeight, 60, 0.9, 0), 1, 1, kHeight));
}

// However long a footprint is, there are no more probes than kMostProbes, and no more texels than they can show.
TEST(TextureFilter, ProbesAreBounded) {
  TestNumbers random(11);
  SeenTexels seen;
  std::set<int> levels;
  for (int i = 0; i < 2000; ++i) {
    const TexturePlace place = footprint(random(), random(), std::exp(9 * random() - 3), std::exp(9 * random() - 3), 0);
    const FilterProbes probes = filter_probes(place, 1, kWidth, kHeight, 2);
    EXPECT_LE(probes.count(), kMostProbes);
    EXPECT_GE(probes.count(), 1);
    levels.insert(probes.level);
    EXPECT_LE(seen.of(place, 1, probes, kWidth >> probes.level, std::max(kHeight >> probes.level, 1)).size(),
              static_cast<std::size_t>(kWidth * kHeight));
  }
  EXPECT_EQ(levels.size(), 3U);
}

}  // namespace
}  // namespace goniochrome::render::texture_filter_test
