// Light that is reconstructed: nearer to the truth than its samples, by as much as is told, and never mixed across
// edges.
#include "render/path/reconstruction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "base/hard_case_for_test.h"
#include "base/parallel.h"
#include "render/path/noise.h"

namespace goniochrome::render::reconstruction_test {
namespace {

constexpr int kWidth = 96, kHeight = 64;
const color::Rgb kBeside{0.3, 0.3, 0.3};

using Light = std::function<color::Rgb(const ShownPoint& point)>;

struct Stage {
  std::vector<ShownPoint> points;
  std::vector<color::Rgb> truth;
  std::vector<Halves> halves;
  std::vector<color::Rgb> beside;

  Reconstruction reconstructed() const { return reconstruction(points, halves, beside, 1); }
};

// A bent sheet of two parts that meet at a third of the picture. Each half has noise of this standard deviation, which
// one in `rare` samples carries alone.
Stage sheet(const Light& light, double noise, int rare = 1) {
  Stage stage;
  std::mt19937 numbers(7);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<int> one_of(1, rare);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const float bend = 0.5F * static_cast<float>(x) / kWidth;
      ShownPoint point{x, y, {3 * x < kWidth ? 0 : 1, {std::sin(bend), 0, std::cos(bend)}, {}}};
      point.piece.position = {2 * std::sin(bend), static_cast<float>(y) / kWidth, 2 * std::cos(bend)};
      stage.points.push_back(point);
      stage.truth.push_back(light(point));
      stage.beside.push_back(kBeside);
      Halves halves;
      for (color::Rgb& half : halves) {
        const double spread = one_of(numbers) == 1 ? noise * std::sqrt(static_cast<double>(rare)) : 0;
        half = stage.truth.back() + spread * normal(numbers) * color::Rgb{1, 1, 1};
      }
      stage.halves.push_back(halves);
    }
  }
  return stage;
}

color::Rgb smooth(const ShownPoint& point) {
  const double value = -0.1 * std::exp(-0.002 * (point.x - 50) * (point.x - 50)) - 0.0005 * point.y;
  return {value, value, 0.9 * value};
}
// The edge of a shadow across the sheet.
color::Rgb edge(const ShownPoint& point) {
  return point.y + 0.2 * point.x > 40 ? color::Rgb{-0.2, -0.2, -0.2} : color::Rgb{};
}
// Two parts in different light.
color::Rgb parted(const ShownPoint& point) {
  return point.piece.part == 0 ? color::Rgb{-0.2, -0.2, -0.2} : color::Rgb{0.1, 0.1, 0.1};
}

double de00(const Stage& stage, std::size_t n, const color::Rgb& light) {
  return length(SeenRows(kBeside + stage.truth[n], 1).along(light - stage.truth[n]));
}

struct Told {
  double error = 0, told = 0, sampled = 0;  // root mean squares over the points, dE00
};
Told told(const Stage& stage) {
  const Reconstruction found = stage.reconstructed();
  Told sum;
  const auto count = static_cast<double>(stage.points.size());
  for (std::size_t n = 0; n < stage.points.size(); ++n) {
    const color::Rgb mean = 0.5 * (stage.halves[n][0] + stage.halves[n][1]);
    sum.error += std::pow(de00(stage, n, found.light[n]), 2) / count;
    sum.told += std::pow(found.error_de00[n], 2) / count;
    sum.sampled += std::pow(de00(stage, n, mean), 2) / count;
  }
  return {std::sqrt(sum.error), std::sqrt(sum.told), std::sqrt(sum.sampled)};
}

// Smooth light needs a tenth of the samples or fewer: the error of filtered light is below a third of that of its
// samples. The control is the mean of the samples.
TEST(Reconstruction, SmoothLightHasAThirdOfTheErrorOfItsSamples) {
  for (const double noise : {0.02, 0.1}) {
    const Told of = told(sheet(smooth, noise));
    EXPECT_LT(of.error, of.sampled / 3) << noise;
  }
}

// Light that no filter smooths, with 64 times the samples in the lower half of the picture: beside the border their
// error is their own, and not that of the few above. Numbers that are not told are the control.
TEST(Reconstruction, SamplesErrByTheirNumberWhateverNeighborsHave) {
  std::mt19937 numbers(11);
  std::uniform_real_distribution<double> any(-0.1, 0.1);
  std::vector<double> pattern(static_cast<std::size_t>(kWidth * kHeight));
  for (double& value : pattern) value = any(numbers);
  const auto rough = [&](const ShownPoint& point) {
    return pattern[static_cast<std::size_t>(kWidth * point.y + point.x)] * color::Rgb{1, 1, 1};
  };
  Stage stage = sheet(rough, 0.05);
  std::vector<float> samples;
  for (std::size_t n = 0; n < stage.points.size(); ++n) {
    const bool has_many = 2 * stage.points[n].y >= kHeight;
    samples.push_back(has_many ? 64 : 1);
    for (color::Rgb& half : stage.halves[n])
      if (has_many) half = stage.truth[n] + 0.125 * (half - stage.truth[n]);
  }
  const auto told_of_found = [&](const Reconstruction& found) {
    double told = 0, error = 0;
    for (std::size_t n = 0; n < stage.points.size(); ++n) {
      if (2 * stage.points[n].y < kHeight || 2 * stage.points[n].y > kHeight + 12) continue;
      told += std::pow(found.error_de00[n], 2), error += std::pow(de00(stage, n, found.light[n]), 2);
    }
    return std::sqrt(told / error);
  };
  const double of_numbers = told_of_found(reconstruction(stage.points, stage.halves, stage.beside, 1, samples));
  EXPECT_GT(of_numbers, 0.8);
  EXPECT_LT(of_numbers, 2);
  EXPECT_GT(told_of_found(stage.reconstructed()), 3) << "control";
}

// Errors are measured from the halves alone. What is told of a bias is never negative, so that more is told than there
// is where light is flat: 2.8 times where all noise of samples counts as the bias of the smallest filter. Less must not
// be told.
TEST(Reconstruction, TellsNoLessThanItsError) {
  for (const Light& light : {Light(smooth), Light(edge), Light(parted)}) {
    const Told of = told(sheet(light, 0.05));
    EXPECT_GT(of.told, 0.8 * of.error);
    EXPECT_LT(of.told, 2.5 * of.error);
    EXPECT_LT(of.error, 0.6 * of.sampled);
  }
}

// A dark line of one pixel, four times as deep as the noise of a half. The smallest filter loses it already, so that
// the next one hardly differs and does not tell its bias: by that alone, .42 of the error was told.
TEST(Reconstruction, TellsALineOfOnePixel) {
  const Told of = told(sheet(
      [](const ShownPoint& point) {
        const double below = point.y + 0.2 * point.x - 40;
        return below > 0 && below < 1 ? color::Rgb{-0.2, -0.2, -0.2} : color::Rgb{};
      },
      0.05));
  EXPECT_GT(of.told, 0.6 * of.error);
  EXPECT_LT(of.error, 0.8 * of.sampled);
}

// Two kinds of points, drawn: the size that 5 of 100 errors exceed is found. The control is the 95th percentile of the
// standard deviations, which is far from it.
TEST(Reconstruction, LargestErrorsAreThoseOfNormalNumbers) {
  constexpr std::size_t kPoints = 200000;
  std::mt19937 numbers(3);
  std::normal_distribution<double> normal;
  std::vector<double> deviations(kPoints), sizes(kPoints);
  for (std::size_t n = 0; n < kPoints; ++n)
    deviations[n] = n % 3 == 0 ? 2 : 0.5, sizes[n] = std::abs(deviations[n] * normal(numbers));
  std::ranges::sort(sizes);
  const double drawn = sizes[kPoints * 95 / 100];
  EXPECT_NEAR(largest_errors(deviations), drawn, 0.02 * drawn);
  EXPECT_GT(drawn, 1.4 * 2);
  EXPECT_EQ(largest_errors({}), 0);
  EXPECT_EQ(largest_errors({0, 0}), 0);
}

// Errors of another cause meet those of noise by chance. The control is the root of the sum of squares of both
// percentiles, which is none of the whole.
TEST(Reconstruction, LargestErrorsHaveThoseOfOtherCauses) {
  constexpr std::size_t kPoints = 200000;
  std::mt19937 numbers(5);
  std::normal_distribution<double> normal;
  std::exponential_distribution<double> missed(2);
  std::vector<double> deviations(kPoints), beside(1000), sizes(kPoints);
  for (double& error : beside) error = missed(numbers);
  for (std::size_t n = 0; n < kPoints; ++n) {
    deviations[n] = n % 3 == 0 ? 2 : 0.1;
    sizes[n] = std::hypot(deviations[n] * normal(numbers), beside[numbers() % beside.size()]);
  }
  std::ranges::sort(sizes);
  const double drawn = sizes[kPoints * 95 / 100];
  EXPECT_NEAR(largest_errors(deviations, beside), drawn, 0.02 * drawn);
  std::ranges::sort(beside);
  EXPECT_GT(std::abs(std::hypot(largest_errors(deviations), beside[950]) - drawn), 0.08 * drawn);
  EXPECT_NEAR(largest_errors({0, 0, 0}, beside), beside[950], 0.05 * beside[950]);
  EXPECT_EQ(largest_errors({0, 0}, {0, 0}), 0);
}

// Light without noise stays what it is, edges and all.
TEST(Reconstruction, KeepsLightWithoutNoise) {
  for (const Light& light : {Light(smooth), Light(edge), Light(parted)}) EXPECT_LT(told(sheet(light, 0)).error, 0.05);
}

// One bright sample among many is told; of noise that all have, no more than its largest values are.
TEST(Reconstruction, TellsASampleThatFiltersSpread) {
  Stage stage = sheet(smooth, 0.01);
  const std::size_t place = 30UL * kWidth + 70;
  constexpr float kOfNoise = 10;
  EXPECT_LT(std::ranges::max(stage.reconstructed().spike_de00), kOfNoise) << "control: no such sample";
  stage.halves[place][0] += color::Rgb{20, 20, 20};
  std::vector<float> spikes = stage.reconstructed().spike_de00;
  EXPECT_GT(spikes[place], 10 * kOfNoise);
  spikes[place] = 0;
  EXPECT_LT(std::ranges::max(spikes), kOfNoise);
}

TEST(Reconstruction, NeverMixesParts) {
  const Stage stage = sheet(parted, 0.05);
  const Reconstruction found = stage.reconstructed();
  const double apart = de00(stage, 0, stage.truth[kWidth - 1]);
  double error = 0, sampled = 0;
  for (std::size_t n = 0; n < stage.points.size(); ++n) {
    if (std::abs(3 * stage.points[n].x - kWidth) > 12) continue;
    EXPECT_LT(de00(stage, n, found.light[n]), apart / 2) << n;
    error += std::pow(de00(stage, n, found.light[n]), 2);
    sampled += std::pow(de00(stage, n, 0.5 * (stage.halves[n][0] + stage.halves[n][1])), 2);
  }
  EXPECT_LT(error, sampled / 4);
}

// Three of four points have no samples: their neighbors tell them, and the error with them. No neighbor tells a part
// that has no samples at all.
TEST(Reconstruction, NeighborsTellPointsWithoutSamples) {
  Stage stage = sheet(smooth, 0.05);
  stage.points.back().piece.part = 7;
  double sampled = 0;
  for (std::size_t n = 0; n < stage.points.size(); ++n) {
    const bool left_out = stage.points[n].x % 2 != 0 || stage.points[n].y % 2 != 0;
    sampled += left_out ? 0 : std::pow(de00(stage, n, 0.5 * (stage.halves[n][0] + stage.halves[n][1])), 2);
    if (left_out) stage.halves[n] = {kUnknown, kUnknown};
  }
  const Reconstruction found = stage.reconstructed();
  const std::size_t last = stage.points.size() - 1;
  double error = 0, told = 0;
  for (std::size_t n = 0; n < last; ++n) {
    ASSERT_TRUE(std::isfinite(found.error_de00[n])) << n;
    error += std::pow(de00(stage, n, found.light[n]), 2), told += std::pow(found.error_de00[n], 2);
  }
  EXPECT_TRUE(std::isinf(found.error_de00[last]));
  EXPECT_LT(error / static_cast<double>(last), sampled / (static_cast<double>(last) / 4) / 4);
  EXPECT_GT(std::sqrt(told / error), 0.8);
}

// A pixel at an edge shows both parts, and is the sum of what each of them tells.
TEST(Reconstruction, PixelsAtEdgesAreSumsOfTheirPieces) {
  Stage stage = sheet(parted, 0.05);
  std::vector<std::size_t> edges;
  for (std::size_t n = 0; n < stage.points.size(); ++n) {
    if (stage.points[n].x != kWidth / 3) continue;
    ShownPiece left = stage.points[n - 1].piece, right = stage.points[n].piece;
    left.share = 0.25F, right.share = 0.75F;
    const color::Rgb shift = 0.25 * (stage.truth[n - 1] - stage.truth[n]);
    stage.truth[n] += shift;
    for (color::Rgb& half : stage.halves[n]) half += shift;
    stage.points[n].pieces = {left, right};
    edges.push_back(n);
  }
  const Reconstruction found = stage.reconstructed();
  double error = 0, sampled = 0;
  for (const std::size_t n : edges) {
    error += std::pow(de00(stage, n, found.light[n]), 2);
    sampled += std::pow(de00(stage, n, 0.5 * (stage.halves[n][0] + stage.halves[n][1])), 2);
  }
  EXPECT_LT(error, sampled / 4);
}

TEST(Reconstruction, IsTheSameForAnyNumberOfThreads) {
  const Stage stage = sheet(edge, 0.05);
  Reconstruction first;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    const Reconstruction found = stage.reconstructed();
    if (first.light.empty()) first = found;
    EXPECT_EQ(found.light, first.light);
    EXPECT_EQ(found.error_de00, first.error_de00);
  }
  set_threads(0);
}

// Rare bright samples are the noise that misleads a choice between filters.
TEST(HardCase, ReconstructionOfRareSamplesIsNoWorseThanTheirMean) {
  for (const int rare : {10, 100}) {
    for (const Light& light : {Light(smooth), Light(edge)}) {
      const Told of = told(sheet(light, 0.1, rare));
      EXPECT_LT(of.error, of.sampled) << rare;
    }
  }
}

// One point alone, none at all, and points that show no surface beside them.
TEST(HardCase, ReconstructionOfAFewPointsIsTheirMean) {
  EXPECT_TRUE(reconstruction({}, {}, {}, 1).light.empty());
  Stage stage = sheet(smooth, 0.05);
  stage.points = {stage.points[100], stage.points[500]};
  stage.halves = {stage.halves[100], stage.halves[500]};
  stage.beside.resize(2);
  stage.points[1].pieces = {stage.points[1].piece};
  stage.points[1].pieces[0].share = 0.5F, stage.points[1].pieces[0].part = 9;
  const Reconstruction found = stage.reconstructed();
  for (std::size_t n = 0; n < 2; ++n) {
    const color::Rgb mean = 0.5 * (stage.halves[n][0] + stage.halves[n][1]);
    EXPECT_LT(length(found.light[n] - mean), 1e-5);
    EXPECT_TRUE(std::isfinite(found.error_de00[n]));
  }
}

}  // namespace
}  // namespace goniochrome::render::reconstruction_test
