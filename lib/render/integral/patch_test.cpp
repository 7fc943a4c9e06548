// Means of lobes and matt bases over a patch, against sums over the patch.
#include "render/integral/patch.h"

#include <gtest/gtest.h>

#include "base/angles.h"
#include "render/integral/gatherer.h"

namespace goniochrome::render::patch_test {
namespace {

constexpr double kVariance = 0.02;  // along each axis: as blocks have it for the widest lobe at a usual tolerance

// A cap of even light, of which the half toward `side` has twice as much of R as the other half, and half of G and B.
struct Cap {
  std::vector<Vec3> red, others;
  Patch patch;
  std::array<Vec3, 3> of_channels;

  Cap(const Vec3& middle, const Vec3& side, double variance) : patch{} {
    const double radius = std::asin(2 * std::sqrt(variance));
    const Vec3 x = normalized(side - dot(side, middle) * middle), y = cross(middle, x);
    constexpr int kRings = 60, kSpokes = 120;
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kSpokes; ++j) {
        const double versine = (1 - std::cos(radius)) * (i + 0.5) / kRings, phi = 2 * kPi * (j + 0.5) / kSpokes;
        const double sine = std::sqrt(versine * (2 - versine));
        const Vec3 direction = sine * std::cos(phi) * x + sine * std::sin(phi) * y + (1 - versine) * middle;
        red.push_back(direction), others.push_back(direction);
        (std::cos(phi) > 0 ? red : others).push_back(direction);
      }
    const auto mean = [](const std::vector<Vec3>& directions) {
      Vec3 sum;
      for (const Vec3& direction : directions) sum += direction;
      return (1.0 / static_cast<double>(directions.size())) * sum;
    };
    const Vec3 of_red = mean(red), of_others = mean(others), all = 0.5 * (of_red + of_others);
    patch.direction = normalized(all), patch.solid_angle_sr = 1, patch.variance = 1 - length(all);
    const auto apart = [&](const Vec3& own) { return own - dot(own, patch.direction) * patch.direction; };
    of_channels = {apart(of_red), apart(of_others), apart(of_others)};
    patch.of_channels = &of_channels;
  }

  // The mean of a function of direction: for R, and for G.
  template <class Function>
  std::array<double, 2> means(const Function& f) const {
    std::array<double, 2> sums{};
    for (const Vec3& direction : red) sums[0] += f(direction) / static_cast<double>(red.size());
    for (const Vec3& direction : others) sums[1] += f(direction) / static_cast<double>(others.size());
    return sums;
  }
};

struct Errors {
  double largest = 0, signed_sum = 0, whole = 0;
  void add(double ours, double truth) {
    largest = std::max(largest, std::abs(ours - truth)), signed_sum += ours - truth, whole += truth;
  }
};

// Caps all over the hemisphere, lobes from the normal to grazing. Errors are parts of the largest value of the
// function, and of the sum over all caps. The control is the textbook's midpoint rule: all light from one direction.
TEST(Patch, IsWhatALobeMakesOfItInTheMean) {
  const Vec3 normal{0, 0, 1};
  for (const double exponent : {1.3, 6.0, 20.0}) {
    Errors ours, control;
    for (const double tilt_deg : {0.0, 35.0, 70.0}) {
      const Vec3 middle{std::sin(tilt_deg * kDegree), 0, std::cos(tilt_deg * kDegree)};
      for (double theta = 5; theta < 72; theta += 8)
        for (double phi = 0; phi <= 180; phi += 20) {
          const double s = std::sin(theta * kDegree), c = std::cos(theta * kDegree);
          const Cap cap({s * std::cos(phi * kDegree), s * std::sin(phi * kDegree), c}, {0.3, 0.5, 1},
                        kVariance / exponent);
          const auto lobe = [&](const Vec3& d) {
            const double cosine = dot(d, middle);
            return cosine > 0 ? std::pow(cosine, exponent) * d.z * brdf::coat_transmission(d.z, 1.5) : 0.0;
          };
          const std::array<double, 2> truth = cap.means(lobe);
          const BaseLight base(cap.patch, normal, 1.5);
          const LobeLight light(cap.patch, middle, normal);
          const BlurredLobe blurred(exponent, cap.patch.variance);
          const color::Rgb mean = light.mean(blurred) * base.mean(light.more_cosine(blurred, base));
          ours.add(mean.x, truth[0]), ours.add(mean.y, truth[1]);
          control.add(lobe(cap.patch.direction), truth[0]), control.add(lobe(cap.patch.direction), truth[1]);
        }
    }
    const double bias = std::abs(ours.signed_sum) / ours.whole,
                 of_control = std::abs(control.signed_sum) / control.whole;
    std::printf("exponent %4.1f: largest %.5f, bias %.5f; one direction %.5f, %.5f\n", exponent, ours.largest, bias,
                control.largest, of_control);
    EXPECT_LT(ours.largest, 0.012);
    EXPECT_LT(bias, 0.002);
    EXPECT_GT(control.largest, 4 * ours.largest) << "the control must fail";
    EXPECT_GT(of_control, 4 * bias) << "the control must fail";
  }
}

// A base meets a cosine exactly, wherever the channels are, and a lobe of exponent 1 up to the square of the variance.
TEST(Patch, KeepsACosine) {
  const Vec3 normal = normalized({0.2, 0.3, 0.9});
  const Cap cap(normalized({0.5, -0.2, 0.8}), {1, 0, 0}, kVariance);
  const std::array<double, 2> truth = cap.means([&](const Vec3& d) { return dot(d, normal); });
  const BaseLight base(cap.patch, normal, paint::kNoCoat);
  EXPECT_NEAR(base.mean().x, truth[0], 1e-12);
  EXPECT_NEAR(base.mean().y, truth[1], 1e-12);
  const LobeLight light(cap.patch, normal, normal);
  EXPECT_NEAR(light.mean({1, cap.patch.variance}).x, truth[0], 1e-3);
  EXPECT_GT(std::abs(dot(cap.patch.direction, normal) - truth[0]), 0.02) << "the control: one direction for all";
}

// The lobe ends at 90 deg from its middle: a patch there, and one well below.
TEST(Patch, ReachesToTheEndOfALobe) {
  const Vec3 normal{0, 0, 1}, middle{1, 0, 0};
  const Cap cap(normalized({-0.02, 0.5, 0.8}), {0, 1, 0}, kVariance);
  const auto truth = cap.means([&](const Vec3& d) { return std::pow(std::max(0.0, d.x), 1.3); });
  const LobeLight light(cap.patch, middle, normal);
  EXPECT_NEAR(light.mean({1.3, cap.patch.variance}).x, truth[0], 0.2 * truth[0]);
  EXPECT_EQ(light.mean({1.3, 0}).x, 0) << "the control: one direction misses it";
  const Cap below(normalized({-0.6, 0.2, 0.7}), {0, 1, 0}, kVariance);
  EXPECT_EQ(LobeLight(below.patch, middle, normal).mean({1.3, below.patch.variance}), color::Rgb{});
}

}  // namespace
}  // namespace goniochrome::render::patch_test
