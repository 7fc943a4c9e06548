// Light that is gathered at few points and interpolated: the same for any number of threads, free where nothing is in
// the way, stopped in time.
#include "render/path/gathered_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"
#include "render/camera.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render {
namespace {

// Balls above a floor in a room with a lamp: smooth surfaces, shadows, creases, and a paint of wide and narrow lobes.
struct GatherStage {
  mesh::Mesh mesh;
  envmap::Environment light = studio();
  envmap::BlockTree blocks{light};
  envmap::PrefilteredEnvironment maps = constant_env({0.5, 0.5, 0.6}, {6, 40});
  Scene scene;
  std::optional<Transport> transport;
  VisibleSurface surface;
  PathRequest request;

  explicit GatherStage(int width, Ground::Kind floor = Ground::Kind::kShadow) {
    add_mesh(mesh, sphere_mesh(48), 0.6, {-0.5, 0, 0});
    add_mesh(mesh, sphere_mesh(48), 0.4, {0.6, -0.2, 0.2});
    add_rectangle(mesh, "wall", {-1.2, -0.6, -0.9}, {2.4, 0, 0}, {0, 1.2, 0});
    paint::LobeFit paint = matt({0.1, 0.08, 0.06});
    paint.lobes = {{6, {0.1, 0.1, 0.1}, {}}, {40, {0.3, 0.3, 0.3}, {0.1, 0.1, 0.1}}};
    scene.mesh = &mesh, scene.texels = &blocks, scene.env = &maps;
    scene.paints.assign(mesh.parts.size(), paint);
    scene.ground.emplace();
    scene.ground->kind = floor, scene.ground->height = -0.6, scene.ground->probe_eye = {0, 1, 0};
    scene.ground->paint = matt({0.2, 0.2, 0.2});
    PathScene path;
    path.scene = &scene, path.environment = &light, path.ground = scene.ground;
    auto made = Transport::create(path);
    if (!made.ok()) throw std::runtime_error(made.error().message);
    transport.emplace(*std::move(made));
    Camera camera;
    camera.eye = {0.5, 1.2, 4}, camera.target = {0, -0.1, 0}, camera.fov_deg = 34;
    const int height = 3 * width / 4;
    surface = visible_surface(transport->rays(), *rays(camera, width, height), width, height);
    request.options.bounces = 2;
  }
  GatherStage(const GatherStage&) = delete;

  PathPicture drawn(bool gather, double tolerance, std::uint64_t seed = 1, bool with_open = true) {
    const OpenShading open(scene);
    request.gather = gather, request.open = gather && with_open ? &open : nullptr;
    request.tolerance_de00 = tolerance, request.seed = seed;
    return path_picture(*transport, surface, nullptr, request);
  }
};

TEST(GatheredLight, IsTheSameForAnyNumberOfThreads) {
  GatherStage stage(40);
  PathPicture first;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    const PathPicture picture = stage.drawn(true, 3);
    if (first.points.empty()) first = picture;
    ASSERT_EQ(picture.points.size(), first.points.size());
    EXPECT_EQ(picture.noise_p95_de00, first.noise_p95_de00);
    for (std::size_t i = 0; i < first.points.size(); ++i) {
      EXPECT_EQ(picture.points[i].radiance, first.points[i].radiance);
      EXPECT_EQ(picture.points[i].covariance, first.points[i].covariance);
    }
  }
  set_threads(0);
}

TEST(GatheredLight, OfAConvexShapeNothingIsCorrected) {
  PathStage stage(sphere_mesh(64), {matt({0.5, 0.4, 0.3})});
  stage.environment = studio();
  stage.build();
  Camera camera;
  camera.eye = {0, 0, 4}, camera.fov_deg = 36;
  const VisibleSurface surface = visible_surface(stage.transport->rays(), *rays(camera, 40, 40), 40, 40);
  PathRequest request;
  request.options.correction = true, request.gather = true;
  const PathPicture picture = path_picture(*stage.transport, surface, nullptr, request);
  EXPECT_TRUE(picture.reached);
  EXPECT_GT(picture.points.size(), 500U);
  EXPECT_EQ(picture.free_share, 1);
  for (const PathPoint& point : picture.points) EXPECT_EQ(point.radiance, color::Rgb{});
}

TEST(GatheredLight, StopsWhenItsTimeIsUpAndSaysHowFarItCame) {
  GatherStage stage(80);
  stage.request.time_limit_s = 0.3;
  const PathPicture picture = stage.drawn(true, 0.001);
  EXPECT_FALSE(picture.reached);
  EXPECT_GT(picture.noise_p95_de00, 0.001);
  for (const PathPoint& point : picture.points) EXPECT_TRUE(std::isfinite(point.noise_de00));
}

}  // namespace
}  // namespace goniochrome::render
