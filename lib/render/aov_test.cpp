#include "render/aov.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "render/scenes_for_test.h"

namespace goniochrome::render::aov_test {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 48, kHeight = 32;

// Two panels under an environment and a light, in flakes, gloss and mirror; seen at a slant.
struct World {
  mesh::Mesh mesh = panels_mesh(2);
  envmap::PrefilteredEnvironment env = constant_env({1, 0.8, 0.6}, {6, 40});
  Scene scene;
  View view{{{0.7, 0.4, 3}, {0, 0, 0}, {0, 1, 0}, 40}, kWidth, kHeight, 1, false};

  World() {
    env.lobes[1].map = cube_of(8, [](const Vec3& d) { return Vec3{1 + d.x, 1 + d.y, 1 + d.z}; });
    paint::LobeFit paint = matt({0.1, 0.2, 0.05});
    paint.lobes = {
        {6, {0.05, 0.1, 0.02}, {}}, {40, {0.2, 0.3, 0.1}, {0.1, 0.1, 0.1}}, {paint::kMirrorExponent, {}, {1, 1, 1}}};
    scene.mesh = &mesh, scene.env = &env, scene.paints = {paint, matt({0.5, 0.1, 0.1})};
    scene.lights = {{normalized({1, 2, 3}), {1, 0.9, 0.8}}};
    scene.background = Background::kEnvironment;
  }
};

// The picture with the buffers, as read back from a file.
image::AovFile buffers_of(const Frame& frame, const mesh::Mesh& mesh) {
  image::AovFile file;
  file.path = "view.exr";
  file.image = frame.picture;
  for (const char* name : {"normal", "part"}) EXPECT_TRUE(add_aov(file.image, *frame.gbuffer, name, {}).ok());
  const Rays& rays = frame.gbuffer->rays;
  file.corner = rays.corner, file.right = rays.right, file.down = rays.down, file.has_rays = true;
  for (const mesh::MeshPart& part : mesh.parts)
    file.parts.push_back(part.name), file.materials.push_back(part.material);
  return file;
}

Frame drawn(const World& world) {
  auto renderer = Renderer::create();
  EXPECT_TRUE(renderer->load(world.scene, "cpu").ok());
  Frame frame;
  EXPECT_TRUE(renderer->draw(world.view, frame).ok());
  return frame;
}

TEST(GbufferOf, ShadesTheSamePictureWithoutTheMesh) {
  World world;
  const Frame frame = drawn(world);
  auto gbuffer = gbuffer_of(buffers_of(frame, world.mesh));
  ASSERT_TRUE(gbuffer.ok()) << gbuffer.error().message;
  EXPECT_EQ(gbuffer->data, frame.gbuffer->data);
  mesh::Mesh parts_alone;
  parts_alone.parts = world.mesh.parts;
  world.scene.mesh = &parts_alone;
  Renderer renderer = Renderer::shading(std::make_shared<const Gbuffer>(*std::move(gbuffer)));
  ASSERT_TRUE(renderer.load(world.scene, "cpu").ok());
  Frame again;
  ASSERT_TRUE(renderer.draw(world.view, again).ok());
  EXPECT_EQ(again.picture.data, frame.picture.data);
  EXPECT_EQ(again.gbuffer_ms, 0);
  EXPECT_EQ(renderer.opengl(), "");
  const auto plan = renderer.load(world.scene, {again.gbuffer}, {});
  ASSERT_TRUE(plan.ok());
  EXPECT_EQ(plan->engine, "cpu");
}

TEST(GbufferOf, NeedsNormalPartRaysAndTheNamesOfParts) {
  const World world;
  const image::AovFile good = buffers_of(drawn(world), world.mesh);
  for (const char* name : {"normal.Y", "part"}) {
    image::AovFile bad = good;
    std::ranges::replace(bad.image.channel_names, std::string(name), std::string("other"));
    const auto gbuffer = gbuffer_of(bad);
    ASSERT_FALSE(gbuffer.ok());
    EXPECT_THAT(gbuffer.error().message, HasSubstr("view.exr: has no channel \"" + std::string(name)));
    EXPECT_THAT(gbuffer.error().message, HasSubstr("render-osmesa ... --aov"));
  }
  image::AovFile bad = good;
  bad.has_rays = false;
  EXPECT_THAT(gbuffer_of(bad).error().message, HasSubstr("goniochrome:rays"));
  bad = good, bad.parts.clear();
  EXPECT_THAT(gbuffer_of(bad).error().message, HasSubstr("goniochrome:parts"));
}

TEST(GbufferOf, NamesThePixelThatHoldsNoNormalOrNoPart) {
  const World world;
  const image::AovFile good = buffers_of(drawn(world), world.mesh);
  const int x = kWidth / 2, y = kHeight / 2, normal = 4, part = 7;
  ASSERT_GT(good.image.pixel(x, y)[part], 0);
  for (const float value : {0.5F, 3.0F, -1.0F, std::numeric_limits<float>::quiet_NaN()}) {
    image::AovFile bad = good;
    bad.image.pixel(x, y)[part] = value;
    const auto gbuffer = gbuffer_of(bad);
    ASSERT_FALSE(gbuffer.ok()) << value;
    EXPECT_THAT(gbuffer.error().message, HasSubstr("at pixel 24,16: the header names 2 parts"));
  }
  image::AovFile bad = good;
  bad.image.pixel(x, y)[normal + 2] = 0.5F;
  EXPECT_THAT(gbuffer_of(bad).error().message, HasSubstr("the normal at pixel 24,16 has the length 0.5"));
}

TEST(Aov, BuffersHoldWhatWasSeen) {
  const mesh::Mesh mesh = panels_mesh(1);
  Scene scene{&mesh, {matt({1, 1, 1})}, nullptr, {{normalized({0, 1, 1}), {1, 1, 1}}}, Background::kNone, {}};
  Camera camera;
  camera.eye = {0, 0, 4};
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer->load(scene).ok());
  const Frame frame = *renderer->draw(camera, 41, 41, 1);
  image::Image picture = frame.picture;
  for (const char* name : {"normal", "aspecular", "lambert", "mask", "part"}) {
    ASSERT_TRUE(add_aov(picture, *frame.gbuffer, name, scene.lights[0].direction).ok());
  }
  EXPECT_EQ(picture.channel_names, (std::vector<std::string>{"R", "G", "B", "A", "normal.X", "normal.Y", "normal.Z",
                                                             "aspecular", "lambert", "mask", "part"}));
  const float* middle = picture.pixel(20, 20);
  EXPECT_NEAR(middle[6], 1, 1e-6);
  EXPECT_NEAR(middle[7], 45, 1e-4);  // the panel sends light from 45 deg above to 45 deg below; the viewer is in front
  EXPECT_NEAR(middle[8], std::sqrt(0.5), 1e-6);
  EXPECT_EQ(middle[9], 1);
  EXPECT_EQ(middle[10], 1);
  const float* corner = picture.pixel(0, 0);
  EXPECT_EQ(corner[7], 180);
  EXPECT_EQ(corner[9] + corner[10] + corner[4], 0);
  EXPECT_THAT(add_aov(picture, *frame.gbuffer, "depth", {}).error().message, HasSubstr("normal, aspecular, lambert"));
}

}  // namespace
}  // namespace goniochrome::render::aov_test
