// Meshes that no modeler wanted, and paints that send back more than they get: paths end, and their light is right.
#include <gtest/gtest.h>

#include "render/path/scenes_for_paths_for_test.h"
#include "render/surface_layer.h"

namespace goniochrome::render::bad_shapes_test {
namespace {

// Every triangle once more, as it is or turned over.
mesh::Mesh doubled(mesh::Mesh mesh, bool turned_over) {
  mesh::Mesh result;
  result.positions = mesh.positions, result.normals = mesh.normals;
  const auto count = static_cast<std::uint32_t>(mesh.positions.size());
  if (turned_over) {
    result.positions.insert(result.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const Vec3& n : mesh.normals) result.normals.push_back(-n);
  }
  for (mesh::MeshPart part : mesh.parts) {
    const std::size_t first = part.first;
    part.first = result.triangles.size();
    for (std::size_t i = first; i < first + part.count; ++i) {
      auto t = mesh.triangles[i];
      result.triangles.push_back(t);
      if (turned_over) t = {t[0] + count, t[2] + count, t[1] + count};
      result.triangles.push_back(t);
    }
    part.count *= 2;
    result.parts.push_back(part);
  }
  return result;
}

mesh::Mesh inside_out(mesh::Mesh mesh) {
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  for (Vec3& n : mesh.normals) n = -n;
  return mesh;
}

// A cup whose walls are met from their other side, or stand twice in the mesh, shows what it shows as it is.
TEST(BadShapes, DuplicateCoplanarAndInsideOutWallsShowTheSameLight) {
  const auto stage_of = [](mesh::Mesh mesh) {
    auto stage = std::make_unique<PathStage>(std::move(mesh), std::vector<paint::LobeFit>{matt({0.8, 0.5, 0.3})});
    stage->environment = environment_of(
        16, 8, [](int x, int y) { return color::Rgb{1 + 0.2 * x, y < 3 ? 3.0 : 0.5, x == 4 ? 6.0 : 1.0}; });
    stage->scene.lights = {{normalized({0.3, 2, 0.2}), {0.5, 0.4, 0.3}}};
    stage->build();
    return stage;
  };
  const Vec3 targets[] = {{0.1, -1, 0.2}, {0.98, -0.98, 0.5}, {-1, 0.3, -0.4}};
  const auto seen = [&](const PathStage& stage, const Vec3& target) {
    return stage.seen({}, {0.02, 0.9, 0.01}, 0.999 * target, 400);
  };
  const auto plain = stage_of(box_mesh(false)), black = stage_of(box_mesh(false));
  for (paint::LobeFit& paint : black->scene.paints) paint = matt({0.8, 0.5, 0.2});
  black->build();
  double worst = 0, control = 0;
  for (const Vec3& target : targets) {
    const PathEstimate truth = seen(*plain, target);
    const auto errors = [&](const PathEstimate& other) {
      double most = 0;
      for (int c = 0; c < 3; ++c)
        most = std::max(most, std::abs(other.radiance[c] - truth.radiance[c]) /
                                  std::hypot(deviation(other, c), deviation(truth, c)));
      return most;
    };
    for (const mesh::Mesh& mesh :
         {doubled(box_mesh(false), false), doubled(box_mesh(false), true), inside_out(box_mesh(false))})
      worst = std::max(worst, errors(seen(*stage_of(mesh), target)));
    control = std::max(control, errors(seen(*black, target)));
  }
  EXPECT_LT(worst, 5);
  EXPECT_GT(control, 5);  // another paint
}

// In a closed box of factor 1.2 light grows without end. Paths end by chance all the same.
TEST(BadShapes, PathsEndBetweenMapsThatGainLight) {
  brdf::ColorMap map = brdf::color_map_of_size(4, 1.5);
  std::ranges::fill(map.factors, 1.2F);
  PathStage stage(box_mesh(true), {matt({1, 1, 1})});
  const SurfaceLayer layer(stage.scene, std::vector<PartSurface>(6, {{}, &map}), brdf::CriticalAngle::kSlide);
  stage.scene.layer = &layer;
  stage.emission.assign(6, {1, 1, 1});
  stage.build();
  PathOptions options;
  options.bounces = 1 << 20;
  const PathEstimate estimate = stage.seen(options, {0.1, 0.2, 0}, {0, -1, 0}, 2);
  EXPECT_TRUE(std::isfinite(estimate.radiance.x));
  EXPECT_GT(estimate.radiance.x, 10);
}

}  // namespace
}  // namespace goniochrome::render::bad_shapes_test
