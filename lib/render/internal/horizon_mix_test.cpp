#include "render/internal/horizon_mix.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "base/angles.h"
#include "base/vec3.h"
#include "brdf/lobe_model.h"
#include "render/internal/lobe_curves.h"

namespace goniochrome::render::horizon_mix_test {
namespace {

constexpr int kSegments = 64;
const std::vector<double> kExponents = {1.3, 6, 20, 70};

double power(double cosine, double exponent) {
  return cosine > 0 ? std::pow(cosine, exponent) : 0;
}

Vec3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> even;
  return normalized({even(random), even(random), even(random)});
}

// An environment as its light from even directions, a Fibonacci spiral.
struct Light {
  std::vector<Vec3> directions;
  std::vector<double> radiance;

  explicit Light(const std::function<double(const Vec3&)>& sky) {
    constexpr int kDirections = 1500;
    for (int i = 0; i < kDirections; ++i) {
      const double y = 1 - (2 * i + 1.0) / kDirections, r = std::sqrt(1 - y * y), phi = i * kPi * (3 - std::sqrt(5.0));
      directions.push_back({r * std::cos(phi), y, r * std::sin(phi)});
      radiance.push_back(sky(directions.back()));
    }
  }
  // The mean, weighed.
  double mean(const std::function<double(const Vec3&)>& weight) const {
    double sum = 0, whole = 0;
    for (std::size_t i = 0; i < directions.size(); ++i) {
      const double here = weight(directions[i]);
      whole += here, sum += here * radiance[i];
    }
    return sum / whole;
  }
  double map(const Vec3& direction, double exponent) const {
    return mean([&](const Vec3& w) { return power(dot(w, direction), exponent); });
  }
};

// Lights differ: a bright horizon over dark ground, half a room in the dark, lamps overhead, lamps at the side.
std::vector<Light> lights() {
  return {Light([](const Vec3& w) { return w.y < 0 ? 0.1 : 0.4 + 2 * std::exp(-8 * w.y); }),
          Light([](const Vec3& w) { return w.x + 0.3 * w.y > 0.2 ? 1.0 : 0.1; }), Light([](const Vec3& w) {
            return dot(w, normalized({0.3, 1, 0.2})) > 0.9 ? 3.0 : w.y > 0 ? 0.3 : 0.15;
          }),
          Light([](const Vec3& w) {
            return dot(w, normalized({1, 0.3, -0.4})) > 0.85 ? 3.0 : 0.2;
          })};
}

// The root mean square error of one lobe over random normals and views, relative to its mean: by the mix, and by its
// own map alone.
struct Errors {
  double mixed = 0, alone = 0;
};
Errors errors(const Light& light, std::size_t lobe, bool gloss, HorizonMix::Diffuse diffuse) {
  const double coat_index = diffuse == HorizonMix::Diffuse::kCoated ? brdf::kCoatIndex : paint::kNoCoat;
  const HorizonMix mix(kExponents, kSegments, coat_index, diffuse, false);
  std::mt19937 random(7);
  constexpr int kPoints = 60;
  Errors sum;
  double mean = 0;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 n = random_direction(random);
    const Vec3 across = normalized(cross(n, random_direction(random)));
    const int node = 8 + static_cast<int>(random() % 56);
    const double cos_o = std::pow(static_cast<double>(node) / kSegments, 2);
    const Vec3 r = cos_o * n + std::sqrt(1 - cos_o * cos_o) * across;
    const LobeIntegrals whole =
        lobe_curve(kExponents[lobe], kSegments, true, coat_index)->at(static_cast<std::size_t>(node));
    const double truth = light.mean([&](const Vec3& w) {
      const double c = dot(n, w);
      if (c <= 0) return 0.0;
      return power(dot(r, w), kExponents[lobe]) * (gloss ? 1 : c * brdf::coat_transmission(c, coat_index));
    });
    std::vector<HorizonMix::Sent> sent(kExponents.size());
    (gloss ? sent[lobe].gloss : sent[lobe].flake) = {1, 1, 1};
    const HorizonMix::Weights weights = mix.at(sent, node);
    double mixed = weights.diffuse.x * light.mean([&](const Vec3& w) {
      const double c = std::max(0.0, dot(n, w));
      return c * brdf::coat_transmission(c, diffuse == HorizonMix::Diffuse::kCoated ? brdf::kCoatIndex : 1);
    });
    for (std::size_t j = 0; j < kExponents.size(); ++j)
      mixed += weights.lobes[j].x * light.map(normalized(r + weights.shifts[j] * n), kExponents[j]);
    const double alone =
        light.map(normalized(r + (gloss ? whole.plain_shift : whole.cosine_shift) * n), kExponents[lobe]);
    sum.mixed += (mixed - truth) * (mixed - truth), sum.alone += (alone - truth) * (alone - truth);
    mean += truth / kPoints;
  }
  return {std::sqrt(sum.mixed / kPoints) / mean, std::sqrt(sum.alone / kPoints) / mean};
}

TEST(HorizonMix, EvenLightIsExact) {
  for (const auto diffuse : {HorizonMix::Diffuse::kNone, HorizonMix::Diffuse::kBare, HorizonMix::Diffuse::kCoated}) {
    const HorizonMix mix(kExponents, kSegments, brdf::kCoatIndex, diffuse, true);
    for (int node = 0; node <= kSegments; ++node) {
      const HorizonMix::Weights weights =
          mix.at({{{0.5, 0.2, 0.1}, {}}, {}, {{0.1, 0.3, 0}, {0.2, 0.2, 0.2}}, {{}, {0.4, 0.4, 0.4}}}, node);
      color::Rgb sum = weights.diffuse;
      for (const color::Rgb& of_lobe : weights.lobes) sum += of_lobe;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c], (color::Rgb{1.2, 1.1, 0.7})[c], 1e-12);
      EXPECT_EQ(weights.diffuse == color::Rgb{}, diffuse == HorizonMix::Diffuse::kNone);
    }
  }
}

// The control is each lobe's own map, looked up where its light comes from. Sharp lobes are hardly cut: what the mix
// takes for the error of maps may cost them a few hundredths of their error.
TEST(HorizonMix, ErrsLessThanTheMapOfTheLobeAlone) {
  for (const auto diffuse : {HorizonMix::Diffuse::kNone, HorizonMix::Diffuse::kCoated}) {
    for (std::size_t lobe = 0; lobe < kExponents.size(); ++lobe) {
      for (const bool gloss : {false, true}) {
        Errors all;
        for (const Light& light : lights()) {
          const Errors here = errors(light, lobe, gloss, diffuse);
          EXPECT_LE(here.mixed, 1.05 * here.alone + 0.003) << kExponents[lobe] << " " << gloss;
          all.mixed += here.mixed, all.alone += here.alone;
        }
        if (lobe < 2 && !gloss) {
          EXPECT_LT(all.mixed, 0.67 * all.alone) << kExponents[lobe];
        }
      }
    }
  }
}

// With one map there is nothing to mix.
TEST(HorizonMix, ALoneLobeIsItsOwnMap) {
  const HorizonMix mix({6}, kSegments, paint::kNoCoat, HorizonMix::Diffuse::kNone, false);
  const HorizonMix::Weights weights = mix.at({{{0.5, 0.2, 0.1}, {}}}, 20);
  EXPECT_EQ(weights.lobes[0], (color::Rgb{0.5, 0.2, 0.1}));
  EXPECT_EQ(weights.shifts[0], lobe_curve(6, kSegments, true, paint::kNoCoat)->at(20).cosine_shift);
}

}  // namespace
}  // namespace goniochrome::render::horizon_mix_test
