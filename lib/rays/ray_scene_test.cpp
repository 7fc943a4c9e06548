// Rays against closed forms: a sphere of triangles, surfaces that coincide, every size of a mesh, meshes that are none.
#include "rays/ray_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <optional>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "base/parallel.h"

namespace goniochrome::rays::ray_scene_test {
namespace {

// A sphere with its exact normals; triangles bend away from it by (pi/rows)^2/8 of the radius.
mesh::Mesh sphere(int rows, double radius = 1, const Vec3& middle = {}) {
  mesh::Mesh mesh;
  const int columns = 2 * rows;
  for (int i = 0; i <= rows; ++i) {
    for (int j = 0; j <= columns; ++j) {
      const double t = kPi * i / rows, p = 2 * kPi * (j % columns) / columns;
      const Vec3 n{std::sin(t) * std::sin(p), std::cos(t), std::sin(t) * std::cos(p)};
      mesh.normals.push_back(n);
      mesh.positions.push_back(middle + radius * n);
    }
  }
  const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(i * (columns + 1) + j); };
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < columns; ++j) {
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
      if (i < rows - 1) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
    }
  }
  mesh.parts = {{"sphere", "", 0, mesh.triangles.size()}};
  return mesh;
}

mesh::Mesh single_triangle(double size = 1) {
  mesh::Mesh mesh;
  mesh.positions = {{0, 0, 0}, {size, 0, 0}, {0, size, 0}};
  mesh.normals.assign(3, {0, 0, 1});
  mesh.triangles = {{0, 1, 2}};
  mesh.parts = {{"one", "", 0, 1}};
  return mesh;
}

class Numbers {
 public:
  double operator()() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<double>(state_ >> 11) * 0x1p-53;
  }
  Vec3 direction() {
    const double z = 2 * (*this)() - 1, p = 2 * kPi * (*this)(), s = std::sqrt(1 - z * z);
    return {s * std::cos(p), s * std::sin(p), z};
  }

 private:
  std::uint64_t state_ = 7;
};

// The distance of a sphere around the origin along a ray from outside; negative where it misses.
double sphere_distance(const Vec3& origin, const Vec3& direction, double radius) {
  const double b = dot(origin, direction), c = dot(origin, origin) - radius * radius, d = b * b - c;
  return d < 0 ? -1 : -b - std::sqrt(d);
}

// The spot that a ray in the units of the mesh meets, and how far it is in these.
struct Met {
  Spot spot;
  Vec3 position;
  double distance = 0;
};
std::optional<Met> met_by(const RayScene& scene, const Vec3& origin, const Vec3& direction) {
  const Float3 from = scene.local(origin), toward = float3(direction);
  const Hit hit = scene.closest(from, toward);
  if (!hit.any()) return std::nullopt;
  const Spot spot = scene.spot(hit, from, toward);
  return Met{spot, scene.world(spot.position), hit.distance / scene.scale()};
}

TEST(RayScene, MeetsASphereWhereTheClosedFormSays) {
  constexpr int kRows = 512;
  const double sagitta = std::pow(kPi / kRows, 2) / 8;
  const mesh::Mesh mesh = sphere(kRows);
  const auto scene = RayScene::create(mesh);
  ASSERT_TRUE(scene.ok());
  Numbers next;
  int met = 0, missed = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 origin = 3 * next.direction();
    const Vec3 aim{0.9 * (2 * next() - 1), 0.9 * (2 * next() - 1), 0.9 * (2 * next() - 1)};
    const Vec3 direction = normalized(aim - origin);
    const double outer = sphere_distance(origin, direction, 1),
                 inner = sphere_distance(origin, direction, 1 - 2 * sagitta);
    const auto point = met_by(*scene, origin, direction);
    const auto occluded = [&](double distance) {
      return scene->occluded(scene->local(origin), float3(direction), static_cast<float>(distance * scene->scale()));
    };
    EXPECT_EQ(point.has_value(), occluded(HUGE_VAL));
    if (inner > 0) {
      ASSERT_TRUE(point.has_value());
      ++met;
      // Floats of a scene of size 1 seen from a distance of 3 are off by some 1e-6.
      EXPECT_GE(point->distance, outer - 3e-6);
      EXPECT_LE(point->distance, inner + 3e-6);
      // Along the ray the error of the plane grows as the ray grazes it.
      EXPECT_LT(length(point->position - (origin + point->distance * direction)),
                3e-6 / std::abs(dot(vec3(point->spot.geometric), direction)));
      EXPECT_LT(length(vec3(point->spot.shading) - normalized(point->position)), 1e-4);  // linear between exact normals
      EXPECT_FALSE(point->spot.inside);
      EXPECT_TRUE(occluded(inner + 1e-5));
      EXPECT_FALSE(occluded(outer - 1e-5));
    } else if (outer < 0) {
      EXPECT_FALSE(point.has_value());
      ++missed;
    }
  }
  EXPECT_GT(met, 5000);
  EXPECT_GT(missed, 500);
}

TEST(RayScene, SeesTheBackOfATurnedSurface) {
  const mesh::Mesh mesh = sphere(64);
  const auto scene = RayScene::create(mesh);
  ASSERT_TRUE(scene.ok());
  const auto point = met_by(*scene, {}, {0, 0, 1});
  ASSERT_TRUE(point.has_value());
  EXPECT_TRUE(point->spot.inside);
  EXPECT_LT(point->spot.geometric.z, -0.99);
  EXPECT_LT(point->spot.shading.z, -0.99);
}

TEST(RayScene, FansMeetWhatSingleRaysMeet) {
  const mesh::Mesh mesh = sphere(40);
  const auto scene = RayScene::create(mesh, Floor{-1.2});
  ASSERT_TRUE(scene.ok());
  Numbers next;
  for (int k = 0; k < 2000; ++k) {
    Fan fan;
    const Vec3 world = 2.5 * next.direction();
    fan.origin = scene->local(world);
    fan.wanted = static_cast<unsigned>(255 * next());
    Hit hits[8];
    for (int i = 0; i < 8; ++i) {
      const Float3 d = float3(next.direction());
      fan.x[i] = d.x, fan.y[i] = d.y, fan.z[i] = d.z;
    }
    const unsigned occluded = scene->occluded(fan);
    scene->closest(fan, hits);
    EXPECT_EQ(occluded & ~fan.wanted, 0U);
    for (unsigned i = 0; i < 8; ++i) {
      if ((fan.wanted >> i & 1U) == 0) continue;
      const Float3 d{fan.x[i], fan.y[i], fan.z[i]};
      const Hit single = scene->closest(fan.origin, d);
      EXPECT_EQ((occluded >> i & 1U) != 0, single.any());
      EXPECT_EQ(hits[i].any(), single.any());
      if (single.any()) {
        EXPECT_NEAR(hits[i].distance, single.distance, 1e-5F);
      }
    }
  }
}

// Rays that are traced together meet what each of them meets by itself, however far they look. A ray that grazes an
// edge may fall to either side, because packets round in another order: fewer than one of a thousand. The control looks
// as far as no other ray does.
TEST(RayScene, NarrowFansMeetWhatSingleRaysMeet) {
  const mesh::Mesh mesh = sphere(40);
  const auto scene = RayScene::create(mesh, Floor{-1.2});
  ASSERT_TRUE(scene.ok());
  Numbers next;
  int rays = 0, met = 0, differ = 0, differ_without_reach = 0;
  for (int k = 0; k < 4000; ++k) {
    Fan fan;
    fan.origin = scene->local(2.5 * next.direction());
    fan.wanted = static_cast<unsigned>(255 * next());
    fan.narrow = true;
    fan.reach = static_cast<float>(4 * scene->scale() * next());
    const Vec3 middle = next.direction();
    for (int i = 0; i < 8; ++i) {
      const Float3 d = float3(normalized(middle + 0.02 * next.direction()));
      fan.x[i] = d.x, fan.y[i] = d.y, fan.z[i] = d.z;
    }
    const unsigned occluded = scene->occluded(fan);
    EXPECT_EQ(occluded & ~fan.wanted, 0U);
    for (unsigned i = 0; i < 8; ++i) {
      if ((fan.wanted >> i & 1U) == 0) continue;
      const Float3 d{fan.x[i], fan.y[i], fan.z[i]};
      const bool one = scene->occluded(fan.origin, d, fan.reach), of_fan = (occluded >> i & 1U) != 0;
      ++rays, met += one, differ += one != of_fan, differ_without_reach += scene->occluded(fan.origin, d) != of_fan;
    }
  }
  EXPECT_GT(met, rays / 10);
  EXPECT_LT(met, rays - rays / 10);
  EXPECT_LT(differ, rays / 1000);
  EXPECT_GT(differ_without_reach, rays / 100);
}

TEST(RayScene, AFloorLiesWhereItIsSaidAndReachesTheHorizon) {
  const mesh::Mesh mesh = sphere(32, 2.0, {100, 5, -3});
  const auto scene = RayScene::create(mesh, Floor{3.0});
  ASSERT_TRUE(scene.ok());
  EXPECT_EQ(scene->parts(), 2);
  const auto below = met_by(*scene, {100, 5, 10}, normalized(Vec3{0, -1e-4, 1}));
  ASSERT_TRUE(below.has_value());
  EXPECT_EQ(below->spot.triangle, kFloor);
  EXPECT_EQ(below->spot.part, 1);
  EXPECT_NEAR(below->position.y, 3.0, 1e-6);
  EXPECT_NEAR(below->position.z, 20010, 2);
  EXPECT_EQ(vec3(below->spot.geometric), (Vec3{0, 1, 0}));
  // A floor above the mesh shows its underside.
  const auto above = RayScene::create(mesh, Floor{9.0});
  const auto under = met_by(*above, {100, 8, 10}, {0, 1, 0});
  ASSERT_TRUE(under.has_value());
  EXPECT_TRUE(under->spot.inside);
  EXPECT_EQ(vec3(under->spot.geometric), (Vec3{0, -1, 0}));
}

// Triangles in every orientation that meet nothing but themselves: from no point of theirs may a ray above their plane
// be occluded. The control starts its rays on the surface itself.
double self_occluded_share(double size, bool from_surface) {
  int occluded = 0, rays = 0;
  Numbers next;
  for (int k = 0; k < 200; ++k) {
    mesh::Mesh mesh = single_triangle(size);
    const Vec3 x = next.direction(), y = normalized(cross(x, next.direction()));
    const Vec3 shift = (10 * size * next()) * next.direction();
    for (Vec3& p : mesh.positions) p = shift + p.x * x + p.y * y;
    mesh.normals.assign(3, cross(x, y));
    const auto scene = RayScene::create(mesh);
    if (!scene.ok()) return 1;
    for (int i = 0; i < 200; ++i) {
      const double u = next(), v = (1 - u) * next();
      const Float3 toward = float3(-cross(x, y));
      const Spot spot = scene->spot({0, static_cast<float>(u), static_cast<float>(v), 1}, {}, toward);
      Vec3 d = next.direction();
      const Vec3 n = vec3(spot.geometric);
      if (dot(d, n) < 0) d = -d;
      if (i % 2 == 0) d = normalized(d + (1e-3 * next() - dot(d, n)) * n);  // grazing
      occluded += scene->occluded(from_surface ? spot.position : spot.start, float3(d));
      ++rays;
    }
  }
  return static_cast<double>(occluded) / rays;
}

TEST(HardCase, RaysLeaveTheirOwnTriangleAtEveryScale) {
  double textbook = 1, ours = 0;
  for (const double size : {1e-6, 1.0, 1e6}) {
    textbook = std::min(textbook, self_occluded_share(size, true));
    ours = worst_of(ours, self_occluded_share(size, false));
  }
  hard_case("transport-self", {"rays that meet their own triangle", textbook, ours, 0, "share"});
}

// A sphere of few triangles with smooth normals: above the horizon of the smooth normal nothing blocks. The control
// starts on the flat triangles.
TEST(HardCase, ASmoothSphereOfFewTrianglesDoesNotShadeItself) {
  const auto occluded_share = [](double size, bool flat) {
    const mesh::Mesh mesh = sphere(12, size);
    const auto scene = RayScene::create(mesh);
    Numbers next;
    int occluded = 0, rays = 0;
    for (int i = 0; i < 40000; ++i) {
      const Vec3 from = next.direction();
      const Float3 origin = scene->local(3 * size * from), toward = float3(-from);
      const Hit hit = scene->closest(origin, toward);
      const Spot spot = scene->spot(hit, origin, toward);
      Vec3 d = next.direction();
      const Vec3 n = vec3(spot.shading);
      if (dot(d, n) < 0) d = -d;
      occluded += scene->occluded(flat ? spot.position + kLift * spot.geometric : spot.start, float3(d));
      ++rays;
    }
    return static_cast<double>(occluded) / rays;
  };
  // Interpolated normals are not quite radial, so that their horizon dips below the lifted point's by a trace.
  double textbook = 1, ours = 0;
  for (const double size : {1e-6, 1.0, 1e6}) {
    textbook = std::min(textbook, occluded_share(size, true));
    ours = worst_of(ours, occluded_share(size, false));
  }
  hard_case("transport-self", {"open sky of a smooth sphere that is occluded", textbook, ours, 2e-4, "share"});
}

TEST(RayScene, DuplicateAndCoplanarFacesDoNotBlockWhatStartsOnThem) {
  mesh::Mesh mesh = single_triangle();
  mesh.positions.push_back({0.6, 0.6, 0});  // overlaps the first triangle in its plane
  mesh.normals.push_back({0, 0, 1});
  mesh.triangles = {{0, 1, 2}, {0, 1, 2}, {0, 1, 3}, {0, 2, 1}};
  mesh.parts[0].count = 4;
  const auto scene = RayScene::create(mesh);
  ASSERT_TRUE(scene.ok());
  Numbers next;
  for (int i = 0; i < 5000; ++i) {
    const double x = 0.5 * next(), y = 0.4 * next();
    const Float3 origin = scene->local({x, y, 1}), down{0, 0, -1};
    const Hit hit = scene->closest(origin, down);
    ASSERT_TRUE(hit.any());
    const Spot spot = scene->spot(hit, origin, down);
    EXPECT_FLOAT_EQ(spot.geometric.z, 1);
    Vec3 d = next.direction();
    d.z = std::abs(d.z) * (i % 2 == 0 ? 1 : 1e-3);
    EXPECT_FALSE(scene->occluded(spot.start, float3(normalized(d))));
  }
}

TEST(RayScene, KnowsAConvexMesh) {
  EXPECT_TRUE(RayScene::create(sphere(48))->is_convex());
  mesh::Mesh inside_out = sphere(48);
  for (auto& t : inside_out.triangles) std::swap(t[0], t[1]);
  EXPECT_FALSE(RayScene::create(inside_out)->is_convex());
  mesh::Mesh dented = sphere(48);
  for (Vec3& p : dented.positions)
    if (p.y > 0.9) p = 0.8 * p;
  EXPECT_FALSE(RayScene::create(dented)->is_convex());
}

TEST(RayScene, TellsWhetherAPointSeesItsWholeHemisphere) {
  const auto free_share = [](const mesh::Mesh& mesh) {
    const auto scene = RayScene::create(mesh);
    Numbers next;
    int free = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3 from = next.direction();
      const auto hit = scene->closest(scene->local(5 * from), float3(-from));
      const Spot spot = scene->spot(hit, scene->local(5 * from), float3(-from));
      free += !scene->any_above(spot.start, spot.shading, 0);
    }
    return free / 2000.0;
  };
  EXPECT_GT(free_share(sphere(48)), 0.999);
  mesh::Mesh two = sphere(48);
  const mesh::Mesh other = sphere(48, 0.3, {0, 1.3, 0});
  const auto shift = static_cast<std::uint32_t>(two.positions.size());
  two.positions.insert(two.positions.end(), other.positions.begin(), other.positions.end());
  two.normals.insert(two.normals.end(), other.normals.begin(), other.normals.end());
  for (const auto& t : other.triangles) two.triangles.push_back({t[0] + shift, t[1] + shift, t[2] + shift});
  two.parts[0].count = two.triangles.size();
  EXPECT_LT(free_share(two), 0.9);
  EXPECT_GT(free_share(two), 0.05);
}

TEST(RayScene, IsTheSameForAnyNumberOfThreads) {
  mesh::Mesh mesh = sphere(300);
  const std::size_t single = mesh.triangles.size();
  for (std::size_t i = 0; i < single; ++i) mesh.triangles.push_back(mesh.triangles[i]);  // ties everywhere
  mesh.parts[0].count = mesh.triangles.size();
  std::vector<std::uint32_t> first;
  for (const int count : {1, 2, 5}) {
    set_threads(count);
    const auto scene = RayScene::create(mesh);
    std::vector<std::uint32_t> met;
    Numbers next;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 from = next.direction();
      const Hit hit = scene->closest(scene->local(3 * from), float3(normalized(next.direction() - 3 * from)));
      std::uint32_t bits[3] = {hit.triangle, 0, 0};
      std::memcpy(&bits[1], &hit.u, 4);
      std::memcpy(&bits[2], &hit.distance, 4);
      met.insert(met.end(), bits, bits + 3);
    }
    if (first.empty()) first = met;
    EXPECT_EQ(met, first) << count;
  }
  set_threads(0);
}

TEST(RayScene, RefusesMeshesThatAreNone) {
  mesh::Mesh mesh = single_triangle();
  mesh.positions[1].y = std::nan("");
  auto scene = RayScene::create(mesh);
  ASSERT_FALSE(scene.ok());
  EXPECT_NE(scene.error().message.find("vertex 1"), std::string::npos) << scene.error().message;
  mesh = single_triangle();
  mesh.triangles[0][2] = 9;
  EXPECT_FALSE(RayScene::create(mesh).ok());
  mesh = single_triangle();
  mesh.parts.clear();
  EXPECT_FALSE(RayScene::create(mesh).ok());
  EXPECT_FALSE(RayScene::create(mesh::Mesh{}).ok());
  EXPECT_FALSE(RayScene::create(single_triangle(), Floor{std::nan("")}).ok());
}

TEST(RayScene, VerticesThatAreNoNumbersAreRefusedByTheReader) {
  const auto path = std::filesystem::temp_directory_path() / "goniochrome-nan-vertex.obj";
  for (const char* word : {"nan", "inf"}) {
    std::ofstream(path) << "v 0 0 0\nv 1 0 0\nv 0 " << word << " 0\nf 1 2 3\n";
    const auto mesh = mesh::read_mesh(path.string());
    ASSERT_FALSE(mesh.ok());
    EXPECT_NE(mesh.error().message.find(":3:"), std::string::npos) << mesh.error().message;
  }
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace goniochrome::rays::ray_scene_test
