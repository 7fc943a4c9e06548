// White in the light of shining parts, against the form factor of a rectangle.
#include "render/path/visible_white.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "render/camera.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::visible_white_test {
namespace {

// The form factor of a rectangle a x b parallel to an element at the distance c, one corner on its normal.
double form_factor(double a, double b, double c) {
  const double x = a / c, y = b / c, rx = std::hypot(1, x), ry = std::hypot(1, y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * kPi);
}

// A small plate under a lamp of 2 x 2 at the height 1. The camera sees the plate and, from below, the lamp.
double white_under_a_lamp(double radiance, const color::Rgb& plate) {
  mesh::Mesh mesh;
  add_rectangle(mesh, "plate", {-0.05, 0, -0.05}, {0, 0, 0.1}, {0.1, 0, 0});
  add_rectangle(mesh, "lamp", {-1, 1, -1}, {2, 0, 0}, {0, 0, 2});
  PathStage stage(mesh, {matt(plate), matt({0, 0, 0})});
  stage.emission = {{}, {radiance, radiance, radiance}};
  stage.build();
  Camera camera;
  camera.eye = {0, 0.6, 1.5}, camera.target = {0, 0.2, 0}, camera.fov_deg = 60;
  const int width = 120, height = 120;
  return visible_white(*stage.transport,
                       visible_surface(stage.transport->rays(), *rays(camera, width, height), width, height), 4, 1);
}

TEST(VisibleWhite, IsWhatTheLampSendsToAWhitePlate) {
  // Over the plate the factor differs by less than 1 %, and the median of 256 estimates of 64 samples errs by less.
  const double expected = 4 * form_factor(1, 1, 1);
  EXPECT_NEAR(expected, 0.554, 0.001);
  for (const double radiance : {1.0, 60.0})
    EXPECT_NEAR(white_under_a_lamp(radiance, {0.1, 0.1, 0.1}) / radiance, expected, 0.02 * expected);
}

// The paint of what is seen does not matter, or a black room would have no white.
TEST(VisibleWhite, DoesNotDependOnThePaint) {
  EXPECT_NEAR(white_under_a_lamp(1, {0, 0, 0}), white_under_a_lamp(1, {0.8, 0.1, 0.1}), 0.02);
}

// In a closed box in which everything shines there is no white that is lit alone.
TEST(VisibleWhite, IsNothingWhereAllThatIsSeenShines) {
  PathStage stage(box_mesh(false), {matt({0.5, 0.5, 0.5})});
  stage.emission.assign(stage.mesh.parts.size(), {1, 1, 1});
  stage.build();
  Camera camera;
  camera.eye = {0, 0, 0.5}, camera.target = {0, 0, -1};
  EXPECT_EQ(
      visible_white(*stage.transport, visible_surface(stage.transport->rays(), *rays(camera, 16, 16), 16, 16), 4, 1),
      0);
}

}  // namespace
}  // namespace goniochrome::render::visible_white_test
