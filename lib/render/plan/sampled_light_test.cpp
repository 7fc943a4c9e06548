// Light that few samples tell, against the light that they are drawn from.
#include "render/plan/sampled_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "render/internal/seen.h"

namespace goniochrome::render::sampled_light_test {
namespace {

constexpr int kSide = 32;

struct Plate {
  std::vector<RayPoint> points;
  std::vector<double> light;  // true, into the diffuse part
  std::vector<SampledLight> sampled;
};

// A level plate, point by point along a curve that fills it. Light falls on it from one corner and, where `edge` is
// set, ends at a sharp line.
Plate plate(bool edge) {
  Plate plate;
  for (unsigned code = 0; code < kSide * kSide; ++code) {
    unsigned x = 0, y = 0;
    for (unsigned k = 0; k < 5; ++k) x |= (code >> (2 * k) & 1U) << k, y |= (code >> (2 * k + 1) & 1U) << k;
    RayPoint point;
    point.spot.position = {static_cast<float>(x) / kSide, 0, static_cast<float>(y) / kSide};
    point.spot.shading = {0, 1, 0};
    plate.points.push_back(point);
    const double away = std::hypot(x, y) / kSide;
    plate.light.push_back(edge && x >= kSide / 2 ? 0 : 1 - 0.3 * away);
  }
  return plate;
}

// Two fans, whose mean is the light: of each so many in 32 samples find all of it.
void sample(Plate& plate, int found, unsigned seed) {
  std::mt19937 random(seed);
  std::binomial_distribution<int> hits(32, found / 32.0);
  for (const double light : plate.light) {
    SampledLight one;
    for (int fan = 0; fan < 2; ++fan) {
      const double value = found == 32 ? light : light * hits(random) / found;
      one.fans.push_back({{}, {}, color::Rgb{value, value, value}});
    }
    plate.sampled.push_back(std::move(one));
  }
  tell_lights(plate.points, 1, plate.sampled);
}

double percentile_of(const Plate& plate, const std::function<double(std::size_t)>& value) {
  std::vector<double> values(plate.light.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = value(i);
  return percentile_95(std::move(values));
}

// Where four samples in 32 find the light, the means of two fans scatter by a third of it, and those of 16 points by a
// twelfth, which moves a percentile of 95 by 1.6 times as much. The percentile of what is told is the true one within a
// fifth; the control, that of the means, is farther off.
TEST(SampledLight, ThePercentileIsToldFromFewSamples) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Plate dim = plate(false);
    sample(dim, 4, seed);
    const double truth = percentile_of(dim, [&](std::size_t i) { return dim.light[i]; });
    const double told = percentile_of(dim, [&](std::size_t i) { return dim.sampled[i].told.into_diffuse.y; });
    const double mean = percentile_of(dim, [&](std::size_t i) { return dim.sampled[i].mean().into_diffuse.y; });
    EXPECT_NEAR(told, truth, 0.2 * truth) << seed;
    EXPECT_GT(mean, 1.25 * truth) << seed;
  }
}

// What has no noise is left as it is, on both sides of an edge.
TEST(SampledLight, LightWithoutNoiseIsLeftAsItIs) {
  Plate sharp = plate(true);
  sample(sharp, 32, 1);
  for (std::size_t i = 0; i < sharp.light.size(); ++i) {
    EXPECT_EQ(sharp.sampled[i].told.into_diffuse.y, sharp.light[i]);
  }
}

// The light of points of another part, and of points whose light is certain, says nothing of a point.
TEST(SampledLight, OnlyPointsThatAreAlikeAreAsked) {
  Plate two = plate(false);
  std::mt19937 random(3);
  for (std::size_t i = 0; i < two.points.size(); ++i) {
    two.points[i].spot.part = static_cast<int>(random() % 2);
    SampledLight one;
    one.certain = random() % 4 == 0;
    const double light = one.certain ? 0 : 1 + two.points[i].spot.part;
    for (const double noise : {-0.5, 0.5})
      if (!one.certain) one.fans.push_back({{light + noise, light, light}, {}, {}});
    two.sampled.push_back(std::move(one));
  }
  tell_lights(two.points, 1, two.sampled);
  for (std::size_t i = 0; i < two.points.size(); ++i) {
    const SampledLight& light = two.sampled[i];
    const double truth = light.certain ? 0 : 1 + two.points[i].spot.part;
    EXPECT_NEAR(light.told.direct.x, truth, 1e-12);
    EXPECT_NEAR(light.told.direct.y, truth, 1e-12);
    EXPECT_EQ(light.alike_count > 1, !light.certain);
  }
}

// The noise that is told is what the mean of the fans scatters by about its own mean over many tries, within a quarter:
// 400 tries tell a variance to 7 %. The control is that of a single fan.
TEST(SampledLight, ItsNoiseIsTold) {
  constexpr unsigned kTries = 400;
  constexpr std::size_t kPoint = 200;
  double sum = 0, squares = 0, predicted = 0, of_fan = 0;
  for (unsigned seed = 0; seed < kTries; ++seed) {
    Plate dim = plate(false);
    sample(dim, 4, seed);
    const double mean = dim.sampled[kPoint].mean().into_diffuse.y;
    sum += mean, squares += mean * mean;
    predicted += covariance(dim.sampled[kPoint], {true, true, true}, {})[1] / kTries;
    of_fan += dim.sampled[kPoint].scatter[2][1] / kTries;
  }
  const double variance = squares / kTries - (sum / kTries) * (sum / kTries);
  EXPECT_NEAR(predicted, variance, 0.25 * variance);
  EXPECT_GT(of_fan, 1.5 * variance);
}

}  // namespace
}  // namespace goniochrome::render::sampled_light_test
