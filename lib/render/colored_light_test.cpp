// The box of the test data under white and cyan light, with and without the reflection operator: [GranierDamez2004],
// figure 4.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/testdata_for_test.h"
#include "render/renderer.h"

namespace goniochrome::render::colored_light_test {
namespace {

image::Image box_picture(Renderer& renderer, const mesh::Mesh& mesh, const color::Rgb& light,
                         const color::ReflectionOperator& reflection, const char* engine) {
  Scene scene;
  scene.mesh = &mesh;
  for (const mesh::MeshPart& part : mesh.parts) {
    paint::LobeFit paint;
    paint.diffuse = (1 / M_PI) * (part.name == "Red" ? color::Rgb{0.55, 0.04, 0.03} : color::Rgb{0.7, 0.7, 0.7});
    scene.paints.push_back(paint);
  }
  scene.lights = {{orbit_direction(30, 45), light}};
  scene.reflection = reflection;
  EXPECT_TRUE(renderer.load(scene, engine).ok());
  Camera camera;
  camera.eye = {0, 1, 4.6}, camera.target = {0, 1, 0}, camera.fov_deg = 33;
  const auto frame = renderer.draw(camera, 64, 64, 1);
  EXPECT_TRUE(frame.ok());
  return frame->picture;
}

TEST(ColoredLight, ARedWallStaysRedInCyanLight) {
  const auto mesh = mesh::read_mesh(testdata("box.obj"));
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok()) << renderer.error().message;
  for (const char* engine : {"gl", "cpu"}) {
    const auto picture = [&](const color::Rgb& light, const color::ReflectionOperator& op) {
      return box_picture(*renderer, *mesh, light, op, engine);
    };
    const image::Image white = picture({1, 1, 1}, color::component_wise()),
                       same = picture({1, 1, 1}, color::iso_rgb_operator());
    float largest = 0;
    for (std::size_t i = 0; i < white.data.size(); ++i)
      largest = std::max(largest, std::abs(white.data[i] - same.data[i]));
    EXPECT_LE(largest, 1e-6F);  // single precision
    const image::Image plain = picture({0, 0.9, 1}, color::component_wise()),
                       ours = picture({0, 0.9, 1}, color::iso_rgb_operator());
    const float *lost = plain.pixel(8, 32), *kept = ours.pixel(8, 32);  // on the left wall
    EXPECT_EQ(lost[0], 0);
    EXPECT_GT(kept[0], 3 * std::max(kept[1], kept[2]));
    EXPECT_GT(kept[0], 0.2F * white.pixel(8, 32)[0]);
  }
}

}  // namespace
}  // namespace goniochrome::render::colored_light_test
