// Ten paints of a ball in a gray cup on one basis, shaded from one transport as an editor of paints does it, against
// tracing each of them anew with all bounces.
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "render/internal/seen.h"
#include "render/path/path_tracer.h"
#include "render/path/shown_paints.h"
#include "render/path/transport_shading.h"
#include "render/path/transport_stage_for_test.h"

namespace goniochrome::render::ten_paints_test {
namespace {

using namespace transport_stage;

constexpr int kWidth = 12, kHeight = 9;
constexpr double kTruthNoise_de00 = 1.5;

image::Image shaded(const TransportShader& shader, const LobeTransport& t, const paint::LobeFit& cup,
                    const paint::LobeFit& ball, BounceScale& scale) {
  std::vector<TransportPaint> paints(5, *transport_paint(t.columns, cup, brdf::kGlossIncidence_deg));
  paints.push_back(*transport_paint(t.columns, ball, brdf::kGlossIncidence_deg));
  std::vector<std::vector<color::Rgb>> weights(5, weights_of(t.columns, cup));
  weights.push_back(weights_of(t.columns, ball));
  scale = bounce_scale(t, weights, nullptr);
  image::Image picture{kWidth, kHeight, 4, std::vector<float>(4UL * kWidth * kHeight, 0.0F), {}};
  shader.shade(paints, nullptr, scale, 1, picture);
  return picture;
}

// The difference to tracing anew has three parts: the noise of the transport, which two transports show (they differ by
// sqrt 2 of it, which is more); that of the truth, of whose standard deviation 95 % stay within 2.2 (of three
// channels); and what the scaling of bounced light says that it errs by, known to a fifth from its probes. The first
// two are independent. Maps err by some 0.5. The control is the picture of the paints that were worn: a shading that
// did nothing.
TEST(TenPaints, FromOneTransportAreThoseThatAreTracedAnew) {
  std::mt19937_64 random(12);
  const paint::LobeFit cup = matt({0.15, 0.15, 0.15}), ball = random_paint(random);
  Stage stage(cup, ball, kWidth, kHeight);
  LobeTransportRequest request;
  request.tolerance_de00 = 1.5;
  const TracedLobes traced = stage.traced(request);
  request.seed = 50;
  const TracedLobes other = stage.traced(request);
  ASSERT_TRUE(traced.reached && other.reached);
  const LobeTransport& t = traced.transport;
  const TransportShader shader(t, {}), other_shader(other.transport, {});
  BounceScale scale;
  const image::Image as_worn = shaded(shader, t, cup, ball, scale);
  EXPECT_EQ(scale.error_p95_de00, 0);
  int controls = 0;
  for (int number = 0; number < 10; ++number) {
    const paint::LobeFit new_ball = random_paint(random);
    const image::Image again = shaded(other_shader, other.transport, cup, new_ball, scale);
    const image::Image ours = shaded(shader, t, cup, new_ball, scale);
    stage.dress(cup, new_ball);
    PathRequest path;
    path.tolerance_de00 = kTruthNoise_de00;
    const PathPicture truth = path_picture(*stage.path.transport, stage.surface, nullptr, path);
    ASSERT_EQ(truth.points.size(), t.places.size());
    std::vector<double> off, noise, undone;
    for (std::size_t i = 0; i < truth.points.size(); ++i) {
      const auto pixel = [&](const image::Image& picture) {
        const float* p = picture.pixel(truth.points[i].x, truth.points[i].y);
        return color::Rgb{p[0], p[1], p[2]};
      };
      off.push_back(seen_difference(pixel(ours), truth.points[i].radiance, 1));
      noise.push_back(seen_difference(pixel(ours), pixel(again), 1));
      undone.push_back(seen_difference(pixel(as_worn), truth.points[i].radiance, 1));
    }
    const double bound = std::hypot(percentile_95(noise), 2.2 * kTruthNoise_de00) + 1.2 * scale.error_p95_de00 + 0.5;
    std::printf("paint %d: p95 %.2f of %.2f, told %.2f, noise %.2f, undone %.2f\n", number, percentile_95(off), bound,
                scale.error_p95_de00, percentile_95(noise), percentile_95(undone));
    EXPECT_LT(percentile_95(off), bound) << number;
    controls += percentile_95(undone) > bound ? 1 : 0;
  }
  EXPECT_GE(controls, 8);
}

// A ball and its cup under one coat, shown with nothing but the image in another: at each point it is what Fresnel's
// equations make of the image in the first one. The control: weights alone, which know no view.
class AnotherCoat : public testing::TestWithParam<std::pair<double, double>> {};

TEST_P(AnotherCoat, ShowsItsImageAsItGoesWithTheView) {
  const auto [traced_index, other_index] = GetParam();
  paint::LobeFit cup = matt({0.3, 0.3, 0.3}), ball = cup;
  cup.coat_index = ball.coat_index = traced_index;
  ball.lobes = {{paint::kMirrorExponent, {}, {1, 1, 1}}};
  const Stage stage(cup, ball, kWidth, kHeight);
  LobeTransportRequest request;
  request.tolerance_de00 = 5, request.bounces = 1;
  const LobeTransport t = stage.traced(request).transport;
  const std::vector<float> views_deg = view_angles_deg(t, {&stage.surface});
  const TransportShader shader(t, views_deg);
  const auto image_of = [&](double index, bool by_view) {
    paint::LobeFit image = matt({});
    image.coat_index = index;
    image.lobes = {{paint::kMirrorExponent, {}, {1, 1, 1}}};
    const std::vector<PartPaint> parts(t.worn.brushed.size(), PartPaint{&image, {}, brdf::kGlossIncidence_deg, "", ""});
    ShownPaints shown = *shown_paints(t.columns, t.worn, parts);
    EXPECT_EQ(shown.with_views, index != traced_index);
    for (TransportPaint& paint : shown.paints)
      if (!by_view) paint.mirror_by_view.clear();
    BounceScale unscaled;
    unscaled.of_class.assign(t.worn.groups.classes(), {1, 1, 1});
    image::Image picture{kWidth, kHeight, 4, std::vector<float>(4UL * kWidth * kHeight, 0.0F), {}};
    shader.shade(shown.paints, nullptr, unscaled, 1, picture);
    return picture;
  };
  const image::Image before = image_of(traced_index, true), after = image_of(other_index, true),
                     control = image_of(other_index, false);
  double off = 0, off_control = 0;
  int compared = 0;
  for (std::size_t i = 0; i < t.places.size(); ++i) {
    const std::size_t at = 4 * t.places[i] + 1;
    if (!(before.data[at] > 0)) continue;
    const double c = std::cos(views_deg[i] * kDegree);
    const double truth =
        before.data[at] * brdf::fresnel_dielectric(c, other_index) / brdf::fresnel_dielectric(c, traced_index);
    off = std::max(off, std::abs(after.data[at] / truth - 1));
    off_control = std::max(off_control, std::abs(control.data[at] / truth - 1));
    ++compared;
  }
  EXPECT_GT(compared, 10);
  EXPECT_LT(off, 1e-3);
  EXPECT_GT(off_control, 0.04) << "the control must fail";
}
INSTANTIATE_TEST_SUITE_P(Each, AnotherCoat, testing::Values(std::pair(1.5, 1.56), std::pair(1.56, 1.5)));

// One that is asked paint after paint sums up what the paints worn sent once. It says the same as one that is new, to
// the last bit, by any number of threads. The control is another paint.
TEST(TenPaints, AreScaledAsEachAlone) {
  std::mt19937_64 random(3);
  const paint::LobeFit cup = random_paint(random), ball = random_paint(random);
  const Stage stage(cup, ball, kWidth, kHeight);
  LobeTransportRequest request;
  request.tolerance_de00 = 20, request.bounces = 2;
  const LobeTransport t = stage.traced(request).transport;
  const color::ReflectionOperator iso = color::iso_rgb_operator();
  BounceScaler scaler(t, &iso);
  BounceScale last;
  for (const int threads : {1, 2, 5}) {
    std::vector<std::vector<color::Rgb>> weights(5, weights_of(t.columns, random_paint(random)));
    weights.push_back(weights_of(t.columns, ball));
    set_threads(threads);
    const BounceScale scale = scaler.scale(weights);
    set_threads(1);
    const BounceScale alone = bounce_scale(t, weights, &iso);
    EXPECT_TRUE(scale.changed);
    EXPECT_EQ(scale.of_class, alone.of_class);
    EXPECT_EQ(scale.error_p95_de00, alone.error_p95_de00);
    EXPECT_NE(scale.of_class, last.of_class) << "the control";
    last = scale;
  }
  set_threads(0);
  const std::vector<std::vector<color::Rgb>> as_worn(5, weights_of(t.columns, cup));
  EXPECT_FALSE(scaler.scale(as_worn).changed);
}

}  // namespace
}  // namespace goniochrome::render::ten_paints_test
