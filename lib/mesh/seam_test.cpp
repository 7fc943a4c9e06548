#include "mesh/seam.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/testdata_for_test.h"

namespace goniochrome::mesh::seam_test {
namespace {

using ::testing::HasSubstr;

void add_quad(Mesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, bool flipped = false) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  Vec3 normal = normalized(cross(b - a, d - a));
  if (flipped) normal = -normal;
  for (const Vec3& p : {a, b, c, d}) mesh.positions.push_back(p), mesh.normals.push_back(normal);
  if (flipped) {
    mesh.triangles.push_back({first, first + 2, first + 1});
    mesh.triangles.push_back({first, first + 3, first + 2});
  } else {
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
}

void begin_part(Mesh& mesh, const std::string& name) {
  mesh.parts.push_back({name, "", mesh.triangles.size(), 0});
}
void end_part(Mesh& mesh) {
  mesh.parts.back().count = mesh.triangles.size() - mesh.parts.back().first;
}

struct Plates {
  double gap = 0.005, flush = 0.002, fold_deg = 3, scale = 1;
  bool flip_right = false, duplicate = false, bottom = false;
};

// Two plates 1 long (x) and 0.4 wide that meet along x: `left` at z < 0 lies in y = 0, `right` beyond the gap is turned
// about x so that the two form a ridge.
Mesh plates(const Plates& p) {
  Mesh mesh;
  const double s = p.scale, f = p.fold_deg * kDegree;
  begin_part(mesh, "left");
  for (int i = 0; i < (p.duplicate ? 2 : 1); ++i)
    add_quad(mesh, {0, 0, 0}, {s, 0, 0}, {s, 0, -0.4 * s}, {0, 0, -0.4 * s});
  end_part(mesh);
  begin_part(mesh, "right");
  const Vec3 near{0, p.flush * s, p.gap * s}, far = near + 0.4 * s * Vec3{0, -std::sin(f), std::cos(f)}, way{s, 0, 0};
  add_quad(mesh, near, far, far + way, near + way, p.flip_right);
  end_part(mesh);
  // Something beneath, so that inside and outside differ.
  begin_part(mesh, "floor");
  add_quad(mesh, {-s, -s, s}, {2 * s, -s, s}, {2 * s, -s, -s}, {-s, -s, -s});
  end_part(mesh);
  return mesh;
}

TEST(Seam, MeasuresGapFlushAndFold) {
  const Seam seam = *seam_between(plates({}), "left", "right");
  ASSERT_GT(seam.points.size(), 100u);
  EXPECT_TRUE(seam.unit_guessed);
  EXPECT_EQ(seam.unit_m, 1);
  EXPECT_NEAR(seam.length_m, 1, 0.02);
  for (const SeamPoint& p : seam.points) {
    EXPECT_NEAR(p.gap_mm, 5, 1e-9);
    EXPECT_NEAR(p.flush_mm, 2, 1e-9);
    EXPECT_NEAR(p.angle_deg, 3, 1e-9);
    EXPECT_NEAR(p.fold_deg, 3, 1e-9);
    EXPECT_NEAR(p.normal_a.y, 1, 1e-12);
    EXPECT_NEAR(p.across.z, 1, 1e-12);
    EXPECT_EQ(p.run, 0);
  }
  for (std::size_t i = 1; i < seam.points.size(); ++i)
    EXPECT_GT(seam.points[i].distance_m, seam.points[i - 1].distance_m);
  const Seam valley = *seam_between(plates({.fold_deg = -4}), "left", "right");
  EXPECT_NEAR(valley.points[10].fold_deg, -4, 1e-9);
}

TEST(Seam, MillimetersAreSeenAndCanBeSaid) {
  const Seam seam = *seam_between(plates({.scale = 1000}), "left", "right");
  EXPECT_EQ(seam.unit_m, 1e-3);
  EXPECT_NEAR(seam.points[0].gap_mm, 5, 1e-9);
  EXPECT_NEAR(seam.length_m, 1, 0.02);
  const Seam said = *seam_between(plates({.scale = 1000}), "left", "right", {.unit_m = 0.01, .max_gap_mm = 100});
  EXPECT_NEAR(said.points[0].gap_mm, 50, 1e-9);
  EXPECT_FALSE(said.unit_guessed);
}

TEST(Seam, FlippedAndDuplicateFacesAreRepairedAndCounted) {
  const Seam flipped = *seam_between(plates({.flip_right = true}), "left", "right");
  EXPECT_GT(flipped.repairs.turned, 0);
  EXPECT_NEAR(flipped.points[0].fold_deg, 3, 1e-9);
  const Seam twice = *seam_between(plates({.duplicate = true}), "left", "right");
  EXPECT_EQ(twice.repairs.duplicate_faces, 2);
  EXPECT_NEAR(twice.points[0].fold_deg, 3, 1e-9);
}

TEST(Seam, NonManifoldEdgesEndAPanel) {
  // Two fins below the edge of `left` make it an edge of three faces.
  Mesh finned;
  begin_part(finned, "left");
  add_quad(finned, {0, 0, 0}, {1, 0, 0}, {1, 0, -0.4}, {0, 0, -0.4});
  add_quad(finned, {0, 0, 0}, {0, -0.1, 0}, {1, -0.1, 0}, {1, 0, 0});
  add_quad(finned, {0, 0, 0}, {0, -0.1, -0.1}, {1, -0.1, -0.1}, {1, 0, 0});
  end_part(finned);
  begin_part(finned, "right");
  add_quad(finned, {0, 0, 0.005}, {0, 0, 0.4}, {1, 0, 0.4}, {1, 0, 0.005});
  end_part(finned);
  const Seam seam = *seam_between(finned, "left", "right");
  EXPECT_EQ(seam.repairs.non_manifold_edges, 1);
  EXPECT_NEAR(seam.points[0].angle_deg, 0, 1e-9);
}

TEST(Seam, WhatIsNoSeamIsRefusedByName) {
  const Mesh mesh = plates({.gap = 0.3});
  EXPECT_THAT(seam_between(mesh, "left", "door").error().message,
              HasSubstr("no part \"door\": it has left, right, floor"));
  EXPECT_THAT(seam_between(mesh, "left", "left").error().message, HasSubstr("between \"left\" and itself"));
  EXPECT_THAT(seam_between(mesh, "left", "right").error().message,
              HasSubstr("do not touch: their edges are 300 mm apart at the nearest, and a gap up to 37.42 mm"));
  EXPECT_THAT(seam_between(plates({.fold_deg = 50}), "left", "right").error().message, HasSubstr("within 30 deg"));
  EXPECT_TRUE(seam_between(plates({.gap = 0.3}), "left", "right", {.max_gap_mm = 400}).ok());
}

double median_fold(const Seam& seam) {
  std::vector<double> folds;
  for (const SeamPoint& p : seam.points) folds.push_back(p.fold_deg);
  std::ranges::nth_element(folds, folds.begin() + static_cast<std::ptrdiff_t>(folds.size() / 2));
  return folds[folds.size() / 2];
}

// The bumper of the speed shape is turned by 8 degrees; rolled borders put 9 mm of the nose's own bend between the ends
// of both skins, which is the half degree more. Door and fender are in line.
TEST(Seam, TheBumperOfTheSpeedShapeIsEightDegreesOut) {
  const Mesh mesh = *read_mesh(testdata("speed-shape.obj"));
  const Seam bumper = *seam_between(mesh, "Hood", "Bumper_F");
  EXPECT_GT(bumper.length_m, 0.9);
  EXPECT_GT(median_fold(bumper), 8);
  EXPECT_LT(median_fold(bumper), 9.2);
  EXPECT_NEAR(median_fold(*seam_between(mesh, "Bumper_F", "Hood")), median_fold(bumper), 0.1);
  const Seam door = *seam_between(mesh, "Door_L", "Fender_L");
  EXPECT_GT(door.length_m, 0.6);
  EXPECT_LT(std::abs(median_fold(door)), 0.5);
  EXPECT_THAT(seam_between(mesh, "Roof", "Bumper_F").error().message, HasSubstr("do not touch"));
}

}  // namespace
}  // namespace goniochrome::mesh::seam_test
