// The background around a mesh: one sample of a pixel stands for all where no edge is seen.
#include "render/path/ray_correction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::ray_correction_test {
namespace {

constexpr int kWidth = 96, kHeight = 64;

// A ball above a floor, below a lamp that throws a sharp shadow.
struct Stage : PathStage {
  Stage() : PathStage(sphere_mesh(32), {matt({0.7, 0.6, 0.5})}) {
    environment = environment_of(64, 32, [](int x, int y) {
      return y >= 16 ? color::Rgb{0.2 + 0.002 * x, 0.5, 0.3} : color::Rgb{0.3 + 0.005 * x, 0.5, 0.9};
    });
    ground.emplace();
    ground->height = -1.2, ground->probe_eye = {0, 0.6, 0};
    scene.lights = {{normalized({-1, 0.8, 0.4}), {0.6, 0.6, 0.6}, 0.002}};
    build();
  }
};

image::Image beside_mesh(const Stage& stage, const Transport& transport,
                         const std::vector<std::vector<const Gbuffer*>>& groups) {
  image::Image picture;
  picture.width = kWidth, picture.height = kHeight, picture.channels = 3;
  picture.data.assign(std::size_t{3} * kWidth * kHeight, 0);
  const Backdrop backdrop{Background::kEnvironment, {}, &*stage.environment};
  for (const auto& group : groups)
    MeshSurroundings{transport, backdrop, {true, true, true, true}}.add(group, 0.25F, picture);
  return picture;
}

TEST(Surroundings, APixelIsTheMeanOfItsSamples) {
  Stage stage;
  Transport transport = *stage.transport;
  transport.shade_ground({}, 1);
  Camera camera;
  camera.eye = {3, 2, 5};
  camera.fov_deg = 50;
  const Rays center = *rays(camera, kWidth, kHeight);
  std::vector<Gbuffer> samples;
  for (const auto& [dx, dy] : sample_shifts(4))
    samples.push_back(mesh_gbuffer(transport.rays(), center.shifted(dx, dy), kWidth, kHeight));
  const auto [a, b, c, d] = std::array{&samples[0], &samples[1], &samples[2], &samples[3]};
  const image::Image together = beside_mesh(stage, transport, {{a, b, c, d}}),
                     each = beside_mesh(stage, transport, {{a}, {b}, {c}, {d}}),
                     first = beside_mesh(stage, transport, {{a}, {a}, {a}, {a}});
  int apart = 0;
  for (std::size_t i = 0; i < together.data.size(); ++i) {
    const float value = together.data[i], mean = each.data[i];
    EXPECT_NEAR(value, mean, 1e-5 * mean) << i;
    apart += std::abs(first.data[i] - mean) > mean / 32;
  }
  EXPECT_GT(apart, 50) << "the control: first samples alone, which are wrong at edges";
}

// Rows beside a band are drawn with it, and are points of another one.
TEST(CorrectionNoise, HasTheErrorsOfPointsThatAreKept) {
  PathPicture band;
  for (int y = 0; y < 4; ++y) {
    PathPoint point;
    point.y = y, point.floor = y == 2, point.noise_de00 = y;
    band.points.push_back(point);
  }
  band.noise_p95_de00 = 1.5, band.error_p95_de00 = 2, band.reached = true;
  CorrectionNoise noise;
  noise.add(band, 0, 3);
  band.error_p95_de00 = 1.25;
  noise.add(band, 1, 4);
  EXPECT_EQ(noise.drawn.mesh, (std::vector<double>{0, 1, 1, 3}));
  EXPECT_EQ(noise.drawn.floor, (std::vector<double>{2, 2}));
  EXPECT_EQ(noise.error_de00_p95, 1.25) << "that of all, which the last band tells";
}

}  // namespace
}  // namespace goniochrome::render::ray_correction_test
