#include "sketch/registration.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "sketch/internal/sketch_scene_for_test.h"

namespace goniochrome::sketch::registration_test {
namespace {

using namespace sketch_scene;
using testing::HasSubstr;

constexpr double kDegree_rad = std::numbers::pi / 180;

// A drawing without axes of symmetry, in coordinates of -1..1 across: boxes and discs of different light, with edges
// one pixel of `softness` wide.
double drawn(double x, double y, double softness) {
  const auto inside = [&](double distance) { return 1 / (1 + std::exp(4 * distance / softness)); };
  const auto disc = [&](double cx, double cy, double r) { return inside(std::hypot(x - cx, y - cy) - r); };
  const auto box = [&](double cx, double cy, double w, double h) {
    return inside(std::max(std::abs(x - cx) - w, std::abs(y - cy) - h));
  };
  return 0.2 + 0.5 * disc(-0.3, 0.1, 0.35) - 0.15 * disc(-0.2, 0.2, 0.1) + 0.3 * box(0.45, -0.2, 0.3, 0.12) +
         0.2 * box(0.5, 0.25, 0.1, 0.15) + 0.1 * x;
}

image::AovFile buffers_of(int width, int height, double red = 1, double blue = 1) {
  image::AovFile file;
  file.path = "drawing.exr";
  file.image = {width, height, 3, {}, {"R", "G", "B"}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double v = drawn((2 * x + 1.0) / width - 1, (2 * y + 1.0 - height) / width, 2.0 / width);
      for (const double channel : {red * v, v, blue * v}) file.image.data.push_back(static_cast<float>(channel));
    }
  return file;
}

// The scan of a picture: each pixel of the scan shows the drawing where the similarity puts it, on white paper, with
// noise.
Picture scan_of(int buffer_width, int buffer_height, int width, int height, const Registration& truth, double red = 1) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.01);
  Picture scan;
  scan.scene_linear = true;
  scan.rgb = {width, height, 3, {}, {}};
  scan.state.assign(static_cast<std::size_t>(width) * height, Picture::kGood);
  const double c = std::cos(truth.turn_deg * kDegree_rad) / truth.scale,
               s = std::sin(truth.turn_deg * kDegree_rad) / truth.scale;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double px = x + 0.5 - 0.5 * width - truth.shift_x, py = y + 0.5 - 0.5 * height - truth.shift_y;
      const double qx = c * px + s * py, qy = -s * px + c * py;  // from the middle of the buffers
      const bool on_it = std::abs(qx) < 0.5 * buffer_width && std::abs(qy) < 0.5 * buffer_height;
      const double v = on_it ? drawn(2 * qx / buffer_width, 2 * qy / buffer_width, 2.0 / buffer_width) : 0.9;
      for (const double channel : {(on_it ? red : 1) * v, v, v})
        scan.rgb.data.push_back(static_cast<float>(std::max(0.0, channel + noise(random))));
    }
  return scan;
}

// How far apart the two similarities are at the corners of the buffers, in their pixels.
double worst_pixels(const Registration& a, const Registration& b, int width, int height) {
  double worst = 0;
  for (const double x : {-0.5 * width, 0.5 * width})
    for (const double y : {-0.5 * height, 0.5 * height}) {
      const auto at = [&](const Registration& r) {
        const double c = r.scale * std::cos(r.turn_deg * kDegree_rad), s = r.scale * std::sin(r.turn_deg * kDegree_rad);
        return std::pair{r.shift_x + c * x - s * y, r.shift_y + s * x + c * y};
      };
      worst = std::max(worst, std::hypot(at(a).first - at(b).first, at(a).second - at(b).second) / b.scale);
    }
  return worst;
}

// Half a pixel at the corners, where edges are a pixel wide, keeps every place that is two pixels from an edge on its
// own side of it.
constexpr double kHalfPixel = 0.5;

TEST(Registration, FindsScaleTurnAndShiftOfAScan) {
  struct Case {
    int width, height;
    Registration truth;
  };
  for (const Case& one : {Case{800, 500, {2.5, 0, 0, 0, 1}}, Case{960, 640, {2.6, 1.7, 14, -9, 1}},
                          Case{700, 520, {1.9, -4.6, -20, 12, 1}}, Case{400, 250, {1.21, 3.3, 3, 2, 1}},
                          Case{250, 160, {0.74, -2, -4, 1, 1}}, Case{320, 200, {1, 4.9, 2, 6, 1}}}) {
    const auto found = registration_of(buffers_of(320, 200), scan_of(320, 200, one.width, one.height, one.truth));
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_LE(worst_pixels(*found, one.truth, 320, 200), kHalfPixel)
        << one.width << ": " << found->scale << " " << found->turn_deg << " " << found->shift_x << " "
        << found->shift_y;
    EXPECT_GT(found->agreement, 0.85);
  }
}

TEST(Registration, AnotherPaintDoesNotLeadAstray) {
  const Registration truth{2.1, 2.2, 6, -8, 1};
  const auto found = registration_of(buffers_of(320, 200, 0.3, 1.6), scan_of(320, 200, 760, 480, truth, 1.4));
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_LE(worst_pixels(*found, truth, 320, 200), kHalfPixel);
}

TEST(Registration, SomethingElseIsRefused) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> any(0, 1);
  Picture noise = scan_of(320, 200, 640, 400, {2, 0, 0, 0, 1});
  for (float& value : noise.rgb.data) value = any(random);
  const auto found = registration_of(buffers_of(320, 200), noise);
  ASSERT_FALSE(found.ok());
  EXPECT_THAT(found.error().message, HasSubstr("bring both to one size"));
}

TEST(Registration, APictureOfTooFewPixelsIsRefused) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 7}, {5000, 10}, {3, 200}}) {
    const double scale = std::min(width / 320.0, height / 200.0);
    EXPECT_FALSE(registration_of(buffers_of(320, 200), scan_of(320, 200, width, height, {scale, 0, 0, 0, 1})).ok())
        << width << " x " << height;
  }
}

// The colors of the scan come back in the pixels of the buffers: the mean light of each, white paper beyond.
TEST(Registration, TheScanIsSeenInThePixelsOfTheBuffers) {
  const image::AovFile buffers = buffers_of(320, 200);
  const Registration truth{2.3, 3, 5, -7, 1};
  Picture scan = scan_of(320, 200, 760, 500, truth);
  scan.state[0] = Picture::kClipped;
  const Picture seen = registered(scan, truth, 320, 200);
  double worst = 0, sum = 0;
  for (int y = 4; y < 196; ++y)
    for (int x = 4; x < 316; ++x) {
      // Where the drawing is even; at its edges the box of a pixel differs from the scan's own.
      const float *here = buffers.image.pixel(x, y), *right = buffers.image.pixel(x + 1, y),
                  *below = buffers.image.pixel(x, y + 1);
      if (std::abs(right[1] - here[1]) > 0.002 || std::abs(below[1] - here[1]) > 0.002) continue;
      const double miss = std::abs(seen.pixel(x, y)[1] - here[1]);
      worst = std::max(worst, miss), sum += miss;
      EXPECT_EQ(seen.state[static_cast<std::size_t>(y) * 320 + x], Picture::kGood);
    }
  // The noise of 0.01 averages over nine samples of a pixel; four sigma of a single one bound the worst.
  EXPECT_LT(worst, 0.04);
  EXPECT_GT(sum, 0);
  const Picture beyond = registered(scan, {2.3, 0, 300, 0, 1}, 320, 200);
  EXPECT_EQ(beyond.state[319], Picture::kTransparent);
}

TEST(Registration, AMaskGoesTheSameWay) {
  image::Image mask{760, 500, 1, {}, {}};
  mask.data.assign(760 * 500, 0);
  for (int y = 0; y < 500; ++y)
    for (int x = 380; x < 760; ++x) *mask.pixel(x, y) = 1;
  const image::Image seen = registered(mask, {2.3, 0, 0, 0, 1}, 320, 200);
  EXPECT_NEAR(*seen.pixel(100, 100), 0, 1e-6);
  EXPECT_NEAR(*seen.pixel(220, 100), 1, 1e-6);
}

// From a turned and enlarged scan of the sphere the paint comes back as from the picture itself.
TEST(Registration, APaintIsFoundInAScan) {
  std::mt19937_64 random(15);
  image::AovFile ball = sphere(200, normalized(Vec3{0.4, 0.5, 0.8}));
  const paint::Paint paint = random_paint(random);
  shade(ball, lobes(paint));
  const Picture still = picture(ball);
  const SketchFit direct = fit(input(ball, still));
  const Registration back{1 / 1.7, -2.5, 0, 0, 1};  // a scan is what the picture looks like from its pixels
  const Picture scan = registered(still, back, 340, 340);
  const auto found = registration_of(ball, scan);
  ASSERT_TRUE(found.ok()) << found.error().message;
  EXPECT_NEAR(found->scale, 1.7, 0.01);
  const Picture seen = registered(scan, *found, 200, 200);
  const SketchFit scanned = fit(input(ball, seen));
  for (const double angle : {15.0, 45.0, 110.0})
    EXPECT_LT(color::delta_e_2000(paint::lab_at(direct.appearance, angle), paint::lab_at(scanned.appearance, angle)), 1)
        << angle;
}

}  // namespace
}  // namespace goniochrome::sketch::registration_test
