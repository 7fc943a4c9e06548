#include "capture/internal/texel_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/hard_case_for_test.h"
#include "capture/internal/truth_for_test.h"
#include "math/statistics.h"

namespace goniochrome::capture::texel_fit_test {
namespace {

struct Spoiling {
  double noise = 0.01;     // relative, one sigma
  double bad_share = 0;    // of values that are shadows or specks
  double saturated = 1e9;  // what the camera cannot see beyond
};

// Values of the texel in photographs of these poses.
TexelSamples photographed(const TrueTexel& texel, const std::vector<Pose>& poses, const Spoiling& how,
                          std::uint64_t seed) {
  TestNumbers random(seed);
  TexelSamples samples;
  samples.resize(static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    EXPECT_TRUE(samples.aim(row, poses[i].light, poses[i].camera));
    const auto f = true_brdf(texel, poses[i].light, poses[i].camera);
    samples.use[row] = Use::kValue;
    const double fate = random();
    for (Eigen::Index k = 0; k < 3; ++k) {
      double value = f[static_cast<std::size_t>(k)] * poses[i].light.z * (1 + how.noise * normal_deviate(random));
      if (fate < how.bad_share / 2) value *= 0.1;
      if (fate > 1 - how.bad_share / 2) value = value * 3 + 0.1;
      if (value > how.saturated) value = how.saturated, samples.use[row] = Use::kLowerBound;
      samples.value(row, k) = value;
    }
  }
  return samples;
}

// The median relative error of a fit in directions that it has not seen.
double error_elsewhere(const TrueTexel& texel, const TexelFit& fit, const std::vector<Pose>& poses) {
  std::vector<double> errors;
  const double turn = fit.frame.twice_angle / 2, c = std::cos(turn), s = std::sin(turn);
  const auto turned = [&](const Vec3& d) { return Vec3{c * d.x + s * d.y, c * d.y - s * d.x, d.z}; };
  for (const Pose& pose : poses) {
    const auto truth = true_brdf(texel, pose.light, pose.camera);
    const color::Rgb found = brdf::brdf(fit.surface, turned(pose.light), turned(pose.camera));
    double off = 0, size = 0;
    for (int k = 0; k < 3; ++k)
      off += std::abs(found[k] - truth[static_cast<std::size_t>(k)]), size += truth[static_cast<std::size_t>(k)];
    errors.push_back(off / size);
  }
  return math::median(errors);
}

constexpr int kTexels = 120;

double error_of(const TexelOptions& options, const Spoiling& how, int photographs = 60, bool metal = true) {
  TexelFitter fitter(options);
  const auto poses = gantry(photographs, 1), elsewhere = gantry(60, 99);
  std::vector<double> errors;
  for (int i = 0; i < kTexels; ++i) {
    const TrueTexel texel = metal ? brushed(i / 120.0) : varnished(i / 120.0);
    const TexelFit fit = fitter.fit(photographed(texel, poses, how, static_cast<std::uint64_t>(i) + 7), {});
    errors.push_back(error_elsewhere(texel, fit, elsewhere));
  }
  return math::median(errors);
}

TEST(TexelFit, FindsTheSurfaceWithinItsNoise) {
  for (const bool metal : {true, false})
    for (const FitMethod method : {FitMethod::kDictionary, FitMethod::kNonlinear})
      EXPECT_LE(error_of({.lobes = metal ? 2 : 1, .method = method}, {}, 60, metal), 0.01 + 0.02) << metal;
}

TEST(TexelFit, ShadowsAndSpecksDoNotSpoilIt) {
  for (const bool metal : {true, false}) {
    const int lobes = metal ? 2 : 1;
    const double clean = error_of({.lobes = lobes}, {}, 60, metal);
    const Spoiling spoiled{.bad_share = 0.1};
    EXPECT_LE(error_of({.lobes = lobes}, spoiled, 60, metal), 1.5 * clean);
    // The control: the same fit without weights.
    EXPECT_GT(error_of({.lobes = lobes, .robust = false}, spoiled, 60, metal), 1.5 * clean);
  }
}

TEST(HardCase, CaptureOutliers) {
  const Spoiling spoiled{.bad_share = 0.1};
  const double textbook = error_of({.method = FitMethod::kNonlinear}, spoiled), ours = error_of({}, spoiled);
  hard_case("capture-outliers", {"relative error of a surface, 10 % of whose values are shadows or specks", textbook,
                                 ours, 0.01, "relative"});
}

TEST(TexelFit, SaturatedValuesAreBounds) {
  // The camera sees half of the highlights no brighter than this.
  const Spoiling bright{.saturated = 0.25};
  EXPECT_LE(error_of({}, bright), 0.02);
  EXPECT_LE(error_of({.lobes = 1}, bright, 60, false), 0.02);
}

// A surface of one lobe, fitted by two: which exponent the dark one has is noise. The control is the order by exponents
// alone, by which it would be the first lobe of many texels and the second of others.
TEST(TexelFit, LobesThatNoValueShowsComeLast) {
  TexelFitter fitter({.lobes = 2});
  const auto poses = gantry(60, 1);
  int dark = 0, first_by_exponent = 0;
  for (int i = 0; i < kTexels; ++i) {
    const TexelFit fit =
        fitter.fit(photographed(varnished(i / 120.0), poses, {}, static_cast<std::uint64_t>(i) + 7), {});
    const brdf::LafortuneLobe &first = fit.surface.lobes[0], &second = fit.surface.lobes[1];
    EXPECT_NE(first.albedo, color::Rgb{}) << i;
    if (second.albedo != color::Rgb{}) continue;
    ++dark, first_by_exponent += second.exponent < first.exponent;
  }
  EXPECT_GT(first_by_exponent, 5) << "the control must fail; " << dark << " texels have a dark lobe";
}

TEST(TexelFit, ErrorFallsWithPhotographsAndLobes) {
  const double few = error_of({}, {.noise = 0.05}, 20), more = error_of({}, {.noise = 0.05}, 60),
               most = error_of({}, {.noise = 0.05}, 180);
  EXPECT_GT(few, more);
  EXPECT_GT(more, most);
  EXPECT_GT(error_of({.lobes = 1}, {}), 1.5 * error_of({.lobes = 2}, {}));
}

}  // namespace
}  // namespace goniochrome::capture::texel_fit_test
