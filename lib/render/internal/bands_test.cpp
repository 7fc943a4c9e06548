#include "render/internal/bands.h"

#include <gtest/gtest.h>

#include <numeric>

#include "render/path/visible_surface.h"
#include "render/scenes_for_test.h"

namespace goniochrome::render::bands_test {
namespace {

Gbuffer gbuffer(int width, int height, int first_seen, int last_seen) {
  Gbuffer g;
  g.width = width, g.height = height;
  g.data.assign(std::size_t{4} * width * height, 0);
  for (int y = first_seen; y < last_seen; ++y)
    for (int x = 0; x < width; ++x) g.data[4 * g.index(x, y) + 3] = 1;
  return g;
}

TEST(Bands, ASmallPictureIsOne) {
  EXPECT_EQ(bands_of(gbuffer(640, 360, 0, 360), 4, true), std::vector{whole_band(360)});
  EXPECT_EQ(bands_of(gbuffer(1280, 720, 0, 720), 16, false).size(), 1U) << "G-buffers are kept for the next picture";
  EXPECT_GT(bands_of(gbuffer(1280, 720, 0, 720), 16, true).size(), 1U);
}

TEST(Bands, KeepEachRowOnceAndDrawThoseBesideIt) {
  for (const auto& [width, height] : {std::pair{2560, 1440}, {60000, 25}, {200, 20000}}) {
    const std::vector<Band> bands = bands_of(gbuffer(width, height, height / 4, height / 2), 4, true);
    ASSERT_GT(bands.size(), 1U);
    int next = 0, number = 0;
    for (const Band& band : bands) {
      EXPECT_EQ(band.number, number++);
      EXPECT_EQ(band.count, static_cast<int>(bands.size()));
      EXPECT_EQ(band.first_kept, next);
      EXPECT_GT(band.last_kept, band.first_kept);
      EXPECT_TRUE(band.first < band.first_kept || band.first == 0);
      EXPECT_TRUE(band.last > band.last_kept || band.last == height);
      next = band.last_kept;
    }
    EXPECT_EQ(next, height);
  }
}

TEST(Bands, AreNarrowWhereTheMeshIsSeen) {
  const std::vector<Band> bands = bands_of(gbuffer(3000, 1500, 0, 500), 4, true);
  ASSERT_GT(bands.size(), 2U);
  EXPECT_LT(2 * bands.front().height(), bands.back().height());
}

TEST(Bands, RowsAreThoseThatRaysFind) {
  const mesh::Mesh mesh = sphere_mesh(32);
  const rays::RayScene scene = *rays::RayScene::create(mesh);
  const Rays view = *rays(Camera::orbit(mesh, 20, 30, 1, 30, 1), 48, 32);
  const Gbuffer rows = rows_of(mesh_gbuffer(scene, view, 48, 32), {10, 24, 12, 20, 1, 3});
  const Gbuffer traced = mesh_gbuffer(scene, view.shifted(0, 10), 48, 14);
  EXPECT_EQ(rows.height, traced.height);
  EXPECT_EQ(rows.triangles, traced.triangles);
  ASSERT_EQ(rows.data.size(), traced.data.size());
  for (std::size_t i = 0; i < rows.data.size(); ++i) EXPECT_NEAR(rows.data[i], traced.data[i], 1e-5);
  for (const auto& [x, y] : {std::pair{3, 2}, {40, 13}}) {
    EXPECT_LT(length(rows.to_viewer(x, y) - traced.to_viewer(x, y)), 1e-12);
  }
}

TEST(Bands, MakeOnePicture) {
  image::Image rows, picture;
  rows.width = 2, rows.height = 5, rows.channels = 1, rows.data.resize(10);
  std::iota(rows.data.begin(), rows.data.end(), 0.0F);
  put_band(rows, {0, 5, 0, 3}, 7, picture);
  put_band(rows, {2, 7, 3, 7}, 7, picture);
  EXPECT_EQ(picture.height, 7);
  EXPECT_EQ(picture.data, (std::vector<float>{0, 1, 2, 3, 4, 5, 2, 3, 4, 5, 6, 7, 8, 9}));
}

}  // namespace
}  // namespace goniochrome::render::bands_test
