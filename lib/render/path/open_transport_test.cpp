#include "render/path/open_transport.h"

#include <gtest/gtest.h>

#include "render/internal/seen.h"
#include "render/path/transport_shading.h"
#include "render/path/transport_stage_for_test.h"
#include "render/renderer.h"

namespace goniochrome::render::open_transport_test {
namespace {

using namespace transport_stage;

// The engine cpu draws the same light by other code: it looks all maps up for each paint.
TEST(OpenTransport, ShowsEachPaintAsTheEngineDoes) {
  std::mt19937_64 random(4);
  Stage stage(random_paint(random), random_paint(random), 48, 36);
  Scene scene = stage.path.scene;
  Camera camera;
  camera.eye = {0.5, 4, 2};
  camera.fov_deg = 36;
  Renderer renderer = Renderer::tracing();
  ASSERT_TRUE(renderer.load(scene, "cpu").ok());
  const auto seen = renderer.look(*scene.mesh, {camera, 48, 36, 1, false});
  ASSERT_TRUE(seen.ok());
  const LobeTransport light = open_transport(*stage.open, stage.columns, stage.worn, {*seen});
  const TransportShader shader(light, {});
  std::vector<double> apart, other;
  for (int i = 0; i < 4; ++i) {
    const paint::LobeFit paint = random_paint(random);
    std::ranges::fill(scene.paints, paint);
    scene.gloss_deg.assign(scene.paints.size(), 45);
    ASSERT_TRUE(renderer.load(scene, "cpu").ok());
    const image::Image engine = renderer.draw(camera, 48, 36, 1).value().picture;
    const TransportPaint worn = transport_paint(stage.columns, paint, 45).value();
    image::Image ours{48, 36, 4, std::vector<float>(std::size_t{4} * 48 * 36, 0.0F), {}};
    shader.shade(std::vector<TransportPaint>(scene.paints.size(), worn), nullptr,
                 {false, std::vector<color::Rgb>(light.worn.groups.classes(), color::Rgb{1, 1, 1})}, 1, ours);
    for (const std::uint32_t place : light.places) {
      const float *a = &ours.data[4 * std::size_t{place}], *b = &engine.data[4 * std::size_t{place}];
      apart.push_back(seen_difference({a[0], a[1], a[2]}, {b[0], b[1], b[2]}, 3));
      other.push_back(seen_difference({a[0], a[1], a[2]}, 0.9 * color::Rgb{b[0], b[1], b[2]}, 3));
    }
  }
  ASSERT_GT(apart.size(), 3000u);
  std::printf("p95 %.3f dE00 apart; light of 0.9 would be %.3f\n", percentile_95(apart), percentile_95(other));
  // Light is kept in halves, of 1 part in 2000, and a lobe of flakes and gloss looks in one direction in the engine and
  // in two here. The control is light that is off by a tenth.
  EXPECT_LT(percentile_95(apart), 0.25);
  EXPECT_GT(percentile_95(other), 1);
}

TEST(OpenTransport, TakesTheMeanOfItsSamples) {
  const image::Image stacked{1, 2, 4, {1, 2, 3, 1, 3, 2, 1, 0}, {}};
  image::Image picture;
  put_mean(stacked, 2, picture);
  EXPECT_EQ(picture.height, 1);
  EXPECT_EQ(picture.data, (std::vector<float>{2, 2, 2, 0.5F}));
}

}  // namespace
}  // namespace goniochrome::render::open_transport_test
