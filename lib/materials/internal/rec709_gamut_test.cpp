#include "materials/internal/rec709_gamut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "base/angles.h"

namespace goniochrome::materials::rec709_gamut_test {
namespace {

const color::Xyz kWhite{0.95047, 1, 1.08883};

color::Rgb cut(const color::Rgb& rec709) {
  return {std::max(rec709.x, 0.0), std::max(rec709.y, 0.0), std::max(rec709.z, 0.0)};
}

double difference(const color::Rgb& f, const color::Rgb& rec709) {
  return color::delta_e_2000(color::lab_from_rgb(kPi * f, kWhite),
                             color::lab_from_rgb(kPi * color::rec2020_from_rec709(rec709), kWhite));
}

// The control is a search by chance around the color whose channels below 0 are set to 0.
double least_difference(const color::Rgb& f, std::mt19937& random) {
  std::normal_distribution<double> normal;
  color::Rgb at = cut(color::rec709_from_rec2020(f));
  double best = difference(f, at), step = 0.5;
  for (int round = 0; round < 4000; ++round) {
    color::Rgb tried = at;
    for (int c = 0; c < 3; ++c)
      tried[c] = std::max(0.0, tried[c] * std::exp(step * normal(random)) + 1e-4 * step * normal(random));
    const double now = difference(f, tried);
    if (now < best) best = now, at = tried;
    if (round % 100 == 99) step *= 0.85;
  }
  return best;
}

// Setting channels to 0 is the failing control: what it loses more than has to be lost is several times as much.
TEST(NearestInRec709, LosesLittleMoreThanHasToBeLost) {
  NearestInRec709 nearest(kWhite);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  int outside = 0;
  double found = 0, simple = 0, least = 0;
  for (int i = 0; i < 1000 && outside < 100; ++i) {
    const double bright = 0.003 * std::pow(60, share(random));
    const color::Rgb f{bright * share(random), bright * share(random), bright * share(random)};
    const color::Rgb rec709 = color::rec709_from_rec2020(f);
    if (difference(f, cut(rec709)) < 2) continue;
    ++outside;
    const color::Rgb here = color::rec709_from_rec2020(nearest(f));
    EXPECT_GE(std::min({here.x, here.y, here.z}), -1e-12);
    const double lost = difference(f, here), best = least_difference(f, random);
    EXPECT_LE(lost, best + 0.4);
    found += lost, simple += difference(f, cut(rec709)), least += best;
  }
  ASSERT_EQ(outside, 100);
  EXPECT_LE(found, 1.02 * least);
  EXPECT_GE(simple - least, 4 * (found - least));
}

TEST(NearestInRec709, LeavesWhatIsInside) {
  NearestInRec709 nearest(kWhite);
  const color::Rgb f = color::rec2020_from_rec709({0.1, 0, 0.02});
  const color::Rgb same = nearest(f);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(same[c], f[c], 1e-12);
}

}  // namespace
}  // namespace goniochrome::materials::rec709_gamut_test
