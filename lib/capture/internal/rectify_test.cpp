#include "capture/internal/rectify.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/scratch_for_test.h"
#include "base/vec3.h"
#include "capture/photo_stack.h"
#include "image/image.h"

namespace goniochrome::capture::rectify_test {
namespace {

constexpr int kColumns = 40, kRows = 30;

// The plate is 4 x 3 in the plane z = 0, u runs right and v down from the upper left corner.
Vec3 color_at(double u, double v) {
  return {0.4 + 0.3 * std::sin(9 * u), 0.4 + 0.3 * std::cos(7 * v), 0.3 + 0.2 * std::sin(5 * u + 6 * v)};
}

// A camera of pinhole and lens that looks at a place of the plate, by rays and textbook projection.
class PinholeCamera {
 public:
  PinholeCamera(const Vec3& eye, const Vec3& aim, double roll, int width, int height, double k1)
      : eye_(eye), width_(width), height_(height), k1_(k1), z_(normalized(aim - eye)) {
    const Vec3 side = normalized(cross(z_, {std::sin(roll), std::cos(roll), 0}));
    x_ = side, y_ = cross(z_, side);  // right and down
  }

  ImagePlace project(const Vec3& point) const {
    const Vec3 d = point - eye_;
    const double x = focal() * dot(d, x_) / dot(d, z_), y = focal() * dot(d, y_) / dot(d, z_);
    const double lens = 1 + k1_ * (x * x + y * y) / (half() * half());
    return {0.5 * width_ + lens * x, 0.5 * height_ + lens * y};
  }

  // The photograph: each pixel is the mean of 2 x 2 rays. `border` is the color beside the plate.
  image::Image photograph(double border) const {
    image::Image image{width_, height_, 3, {}, {"R", "G", "B"}};
    for (int row = 0; row < height_; ++row)
      for (int column = 0; column < width_; ++column) {
        Vec3 sum;
        for (int k = 0; k < 4; ++k)
          sum += 0.25 * seen(column + 0.25 + 0.5 * (k % 2), row + 0.25 + 0.5 * (k / 2), border);
        for (int c = 0; c < 3; ++c) image.data.push_back(static_cast<float>(sum[c]));
      }
    return image;
  }

 private:
  double focal() const { return 1.4 * width_; }
  double half() const { return 0.5 * std::hypot(width_, height_); }
  Vec3 seen(double column, double row, double border) const {
    const double x = column - 0.5 * width_, y = row - 0.5 * height_, r = std::hypot(x, y) / half();
    double straight = r;
    for (int i = 0; i < 8; ++i)  // Newton's method
      straight -= (straight * (1 + k1_ * straight * straight) - r) / (1 + 3 * k1_ * straight * straight);
    const double lens = r > 0 ? straight / r : 1;
    const Vec3 d = lens * x * x_ + lens * y * y_ + focal() * z_;
    const Vec3 at = eye_ + (-eye_.z / d.z) * d;
    const double u = at.x / 4 + 0.5, v = 0.5 - at.y / 3;
    return u < 0 || u > 1 || v < 0 || v > 1 ? Vec3{border, border, border} : color_at(u, v);
  }

  Vec3 eye_;
  int width_, height_;
  double k1_;
  Vec3 x_, y_, z_;
};

// The largest error of a rectified photograph, edges of one texel apart: their samples reach beyond the plate.
double worst_error(const PinholeCamera& camera, const Corners& corners) {
  const ScratchFolder folder;
  image::ImagePart part{"", camera.photograph(0.05), {{"colorInteropID", std::string("lin_rec2020_scene")}}};
  part.type = image::PixelType::kFloat;
  EXPECT_TRUE(image::write_exr(folder.path("a.exr"), {part}).ok());
  const auto stack =
      PhotoStack::open({"photos.csv", {{folder.path("a.exr"), 2, {}, {}, 1, corners}}}, 1e9, {kColumns, kRows});
  if (!stack.ok()) {
    ADD_FAILURE() << stack.error().message;
    return 0;
  }
  std::vector<PhotoPixel> texels;
  EXPECT_TRUE(stack->read_rows(0, kRows, texels).ok());
  double worst = 0;
  for (int row = 1; row < kRows - 1; ++row)
    for (int column = 1; column < kColumns - 1; ++column) {
      const Vec3 want = color_at((column + 0.5) / kColumns, (row + 0.5) / kRows);
      const PhotoPixel& is = texels[static_cast<std::size_t>(row * kColumns + column)];
      worst = std::max({worst, std::abs(is.r - want.x), std::abs(is.g - want.y), std::abs(is.b - want.z)});
    }
  return worst;
}

Corners corners_of(const PinholeCamera& camera, double k1) {
  return {{camera.project({-2, 1.5, 0}), camera.project({2, 1.5, 0}), camera.project({2, -1.5, 0}),
           camera.project({-2, -1.5, 0})},
          k1};
}

TEST(Rectify, PhotographsOfDifferentCamerasShowOnePlate) {
  const PinholeCamera front({0.3, -0.4, 9}, {0, 0, 0}, 0, 320, 240, 0),
      aside({5, 3, 6}, {0.2, 0.1, 0}, 0.3, 400, 300, 0), steep({-7, -2, 3}, {0, 0, 0}, -0.5, 300, 400, 0);
  for (const PinholeCamera* camera : {&front, &aside, &steep})
    EXPECT_LT(worst_error(*camera, corners_of(*camera, 0)), 0.002);
  // The control: without the corners of the plate, another place is at each texel.
  EXPECT_GT(worst_error(aside, {{{{0, 0}, {400, 0}, {400, 300}, {0, 300}}}}), 0.2);
}

TEST(Rectify, ALensIsStraightened) {
  for (const double k1 : {-0.12, 0.15}) {
    const PinholeCamera camera({4, 3, 7}, {0, 0, 0}, 0.2, 400, 300, k1);
    EXPECT_LT(worst_error(camera, corners_of(camera, k1)), 0.002) << k1;
    EXPECT_GT(worst_error(camera, corners_of(camera, 0)), 0.01) << "the control, " << k1;
  }
}

TEST(Rectify, CornersThatNoPlateHasAreRefused) {
  const auto told = [](const std::array<ImagePlace, 4>& at, double k1 = 0) {
    const auto view = Perspective::of({at, k1}, 100, 80);
    return view.ok() ? std::string("nothing") : view.error().message;
  };
  EXPECT_EQ(told({{{0, 0}, {100, 0}, {100, 80}, {0, 80}}}), "nothing");
  EXPECT_EQ(told({{{10, 5}, {90, 15}, {80, 70}, {5, 60}}}, -0.2), "nothing");
  EXPECT_NE(told({{{10, 5}, {100.5, 15}, {80, 70}, {5, 60}}}).find("the upper right corner is at 100.5,15, outside"),
            std::string::npos);
  EXPECT_NE(told({{{10, 10}, {50, 50}, {70, 70}, {5, 60}}}).find("the upper right corner is on the line"),
            std::string::npos);
  EXPECT_NE(told({{{10, 10}, {10, 10}, {70, 70}, {5, 60}}}).find("on the line"), std::string::npos);
  EXPECT_NE(told({{{10, 5}, {90, 15}, {5, 60}, {80, 70}}}).find("sides that cross"), std::string::npos);
  EXPECT_NE(told({{{10, 5}, {5, 60}, {80, 70}, {90, 15}}}).find("against the clock"), std::string::npos);
  EXPECT_NE(told({{{0, 0}, {100, 0}, {100, 80}, {0, 80}}}, -0.3).find("check k1"), std::string::npos);
}

}  // namespace
}  // namespace goniochrome::capture::rectify_test
