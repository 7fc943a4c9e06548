// Directions toward bright places: pieces of surfaces, their density, the same light with less noise.
#include "render/path/bright_places.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/testdata_for_test.h"
#include "render/path/chi_square_for_test.h"
#include "render/path/scenes_for_paths_for_test.h"

namespace goniochrome::render::bright_places_test {
namespace {

using rays::Float3;

// A room, all of whose walls have one albedo, with or without a lid. A lamp hangs a hundredth before its back wall,
// behind a shade that hides it from the room: all light comes off a spot of the wall, past the shade's edge.
struct ShadedLamp : PathStage {
  static mesh::Mesh room(bool with_lid) {
    mesh::Mesh mesh = box_mesh(with_lid);
    add_rectangle(mesh, "shade", {-0.1, -0.1, -0.9}, {0.2, 0, 0}, {0, 0.2, 0});
    add_rectangle(mesh, "lamp", {-0.05, -0.05, -0.99}, {0, 0.1, 0}, {0.1, 0, 0});
    return mesh;
  }
  explicit ShadedLamp(double albedo = 0.6, bool with_lid = true)
      : PathStage(room(with_lid), {matt(albedo * color::Rgb{1, 1, 1})}) {
    scene.paints.back() = matt({});
    emission.resize(mesh.parts.size());
    emission.back() = {50, 50, 50};
  }
  const Rays through = *rays(Camera{{0.7, 0.5, 0.9}, {-0.3, -0.2, -1}, {0, 1, 0}, 60}, 64, 64);
  std::shared_ptr<const BrightPlaces> find() const { return transport->find_bright_places(12, 1); }
};

TEST(SurfacePieces, CoverTheirTriangles) {
  const auto scene = rays::RayScene::create(ShadedLamp::room(true));
  ASSERT_TRUE(scene.ok());
  const SurfacePieces pieces(*scene);
  ASSERT_GT(pieces.count(), 10 * scene->triangles());
  TestNumbers next(4);
  double area = 0, whole = 0;
  int astray = 0;
  for (std::uint32_t piece = 0; piece < pieces.count(); ++piece) {
    const std::uint32_t triangle = pieces.triangle(piece);
    area += pieces.area(piece);
    const auto corner = scene->corners(triangle);
    const Float3 a = corner[1] - corner[0], b = corner[2] - corner[0];
    const float aa = rays::dot(a, a), ab = rays::dot(a, b), bb = rays::dot(b, b), det = aa * bb - ab * ab;
    for (int k = 0; k < 4; ++k) {
      const rays::Hit drawn = pieces.drawn(piece, next(), next());
      const Float3 at = pieces.position(drawn) - corner[0];
      const float pa = rays::dot(at, a), pb = rays::dot(at, b);
      const float u = (bb * pa - ab * pb) / det, v = (aa * pb - ab * pa) / det;
      EXPECT_NEAR(u, drawn.u, 1e-5F);
      EXPECT_NEAR(v, drawn.v, 1e-5F);
      astray += drawn.triangle != triangle || pieces.at(triangle, u, v) != piece ? 1 : 0;
    }
  }
  for (std::uint32_t triangle = 0; triangle < scene->triangles(); ++triangle)
    whole += 0.5 * length(scene->doubled_area(triangle));
  EXPECT_NEAR(area, whole, 1e-9);
  // A point within a rounding of a piece's edge, some 1e-5 of its width, may fall to its neighbor: one of 30,000 does.
  EXPECT_LT(astray, 10);
  EXPECT_EQ(pieces.at(rays::kFloor, 0, 0), SurfacePieces::kNone);
}

TEST(BrightPlaces, AreDrawnAsTheirDensitySays) {
  ShadedLamp stage;
  const Transport& transport = stage.build();
  const auto places = stage.find();
  ASSERT_NE(places, nullptr);
  const rays::RayScene& scene = transport.rays();
  // On the left wall, from where the back wall and the shade are seen askew.
  const Float3 from = scene.local({0.2, 0.1, 0.3}), toward{-1, 0, 0};
  const rays::Hit hit = scene.closest(from, toward);
  const rays::Spot spot = scene.spot(hit, from, toward);
  const BrightPlaces::Receiver receiver = places->receiver(spot.triangle, spot.u, spot.v, 1);
  ASSERT_GT(receiver.chance(), 0);
  for (const double wrong : {1.0, 1.05}) {
    const double found = excess(
        SphereBins({0, 0, -1}, 60, 24), 400000,
        [&](double choice, double u, double v) -> std::optional<Vec3> {
          const BrightPlaces::Draw draw = places->drawn(receiver, spot.start, choice, u, v);
          const rays::Hit met = scene.closest(spot.start, draw.direction);
          if (met.triangle != draw.triangle) return std::nullopt;
          return rays::vec3(draw.direction);
        },
        [&](const Vec3& d) {
          const Float3 direction = rays::float3(d);
          const double pdf = places->pdf(receiver, scene.closest(spot.start, direction), direction);
          return d.z < -0.5 ? wrong * pdf : pdf;
        },
        1024);
    if (wrong == 1) {
      EXPECT_LT(found, 5);
    } else {
      EXPECT_GT(found, 5);  // control
    }
  }
}

// The lounge of testdata, gray, with a blue ceiling that its lamps shine at.
struct Lounge : PathStage {
  static mesh::Mesh room() {
    auto read = mesh::read_mesh(testdata("lounge.obj"));
    if (!read.ok()) throw std::runtime_error(read.error().message);
    return *std::move(read);
  }
  Lounge() : PathStage(room(), {matt({0.5, 0.5, 0.5})}) {
    for (std::size_t part = 0; part < mesh.parts.size(); ++part)
      if (mesh.parts[part].name == "Ceiling") scene.paints[part] = matt({0.12, 0.3, 0.85});
    scene.paints.back() = matt({});
    emission.resize(mesh.parts.size());
    emission.back() = {60, 55, 50};
  }
  const Rays through = *rays(Camera{{0.6, 1.45, 2.35}, {-0.1, 1, -1.5}, {0, 1, 0}, 62}, 64, 64);
};

struct Moments {
  double mean = 0, variance = 0, relative = 0;  // the latter is the variance over the square of each point's mean
  double error = 0;                             // of the mean over all points
};

// Moments of a batch, at points that the camera sees, mean over these.
Moments moments(const PathStage& stage, const Rays& through, int batches) {
  PathOptions options;
  options.bounces = 12;
  Moments moments;
  constexpr int kGrid = 6;
  for (int i = 0; i < kGrid; ++i) {
    for (int j = 0; j < kGrid; ++j) {
      const Vec3 eye = through.eye, target = eye + through.direction(10.7 * i + 4, 10.7 * j + 4);
      const PathEstimate seen = stage.seen(options, eye, target, batches, static_cast<std::uint64_t>(kGrid * i + j));
      moments.mean += seen.radiance.y / (kGrid * kGrid);
      moments.variance += batches * seen.covariance[1] / (kGrid * kGrid);
      moments.relative += batches * std::pow(deviation(seen) / seen.radiance.y, 2) / (kGrid * kGrid);
    }
  }
  moments.error = std::sqrt(moments.variance / (batches * kGrid * kGrid));
  return moments;
}

// Mean and relative variance, by places and by lobes alone. The ratio of variances is 3.9 in the lounge and 29
// behind the shade; with two rays from each group to each other it is 1.7 and 3.9.
void expect_same_with_less_noise(PathStage& stage, const Rays& through, double times) {
  stage.build();
  constexpr int kBatches = 500;
  const Moments by_lobes = moments(stage, through, kBatches);
  stage.transport->draw_toward(stage.transport->find_bright_places(12, 1));
  ASSERT_NE(stage.transport->bright_places(), nullptr);
  const Moments by_places = moments(stage, through, kBatches);
  EXPECT_LT(times * by_places.relative, by_lobes.relative);
  EXPECT_NEAR(by_places.mean, by_lobes.mean, 4 * std::hypot(by_places.error, by_lobes.error));
}

TEST(BrightPlaces, TheSameLightHasLessNoise) {
  Lounge lounge;
  expect_same_with_less_noise(lounge, lounge.through, 2.5);
  ShadedLamp shaded;
  expect_same_with_less_noise(shaded, shaded.through, 15);
}

// The bowls of the lounge's lamps are bright within, and the walls see that past their rims, from a part of each group
// alone. Nearly all directions from walls and ceiling to lit points of the bowls are drawn toward places as well: along
// the others light is met by luck only, as specks. They are 0.06 % here, 0.7 % with a quarter of the rays, and 8.5 %
// with two rays from each group to each other, however bright it is.
TEST(BrightPlaces, AreKnownWhereTheyAreSeenFromAPartOfAGroup) {
  Lounge lounge;
  const Transport& transport = lounge.build();
  const rays::RayScene& scene = transport.rays();
  const auto places = transport.find_bright_places(12, 1);
  ASSERT_NE(places, nullptr);
  const auto part = [&](std::uint32_t triangle) {
    return lounge.mesh.parts[static_cast<std::size_t>(scene.part(triangle))].name;
  };
  TestNumbers next(6);
  int seen = 0, known = 0;
  for (std::uint32_t triangle = 0; triangle < scene.triangles(); ++triangle) {
    if (part(triangle) != "Lamp_Bowls") continue;
    for (int k = 0; k < 40; ++k) {
      const double a = next(), b = next(), choice = next(), c = next(), d = next();
      const auto u = static_cast<float>(next()), v = static_cast<float>(next());
      const rays::Hit bowl{triangle, static_cast<float>(std::sqrt(a) * (1 - b)), static_cast<float>(std::sqrt(a) * b),
                           0};
      const rays::Spot from = scene.spot(bowl, {}, {0, -1, 0});
      const EmitterSample light = transport.emitters().drawn(lit_point(from), choice, c, d);
      if (!(light.pdf > 0) || scene.occluded(from.start, light.direction, 0.999F * light.distance)) continue;
      const Float3 away = PaintedPoint::drawn_about(from.shading, 1, u, v);
      const rays::Hit wall = scene.closest(from.start, away);
      if (!wall.any() || part(wall.triangle) == "Lamp_Bowls" || part(wall.triangle) == "Lamps") continue;
      const rays::Spot at = scene.spot(wall, from.start, away);
      const rays::Hit back = scene.closest(at.start, -away);
      if (back.triangle != triangle) continue;
      const BrightPlaces::Receiver receiver = places->receiver(at.triangle, at.u, at.v, 1);
      ++seen;
      if (receiver.chance() > 0 && places->pdf(receiver, back, -away) > 0) ++known;
    }
  }
  ASSERT_GT(seen, 1000);
  EXPECT_LT(seen - known, 0.003 * seen);
}

// Two of the box's walls that shine evenly light all of it evenly.
TEST(BrightPlaces, AreNotSoughtWhereLightIsEven) {
  PathStage stage(box_mesh(true), {matt({0.5, 0.5, 0.5})});
  EXPECT_EQ(stage.build().find_bright_places(12, 1), nullptr);  // no emitters
  stage.emission.assign(6, {});
  stage.emission[1] = stage.emission[2] = {1, 1, 1};
  EXPECT_EQ(stage.build().find_bright_places(12, 1), nullptr);
  ShadedLamp lamp;
  lamp.build();
  EXPECT_NE(lamp.find(), nullptr);                               // control
  EXPECT_EQ(lamp.transport->find_bright_places(0, 1), nullptr);  // no light comes from places
}

TEST(BrightPlaces, AreTheSameForAnyNumberOfThreads) {
  ShadedLamp stage;
  stage.build();
  PathOptions options;
  color::Rgb seen[3];
  for (const int count : {1, 3, 2}) {
    set_threads(count);
    stage.transport->draw_toward(stage.find());
    seen[count - 1] = stage.seen(options, stage.through.eye, {-0.3, -0.2, -1}, 20).radiance;
  }
  set_threads(0);
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_EQ(seen[0], seen[2]);
  stage.transport->draw_toward(nullptr);
  EXPECT_NE(seen[0], stage.seen(options, stage.through.eye, {-0.3, -0.2, -1}, 20).radiance);  // control
}

// White walls in even light, with a lamp that is as bright as that light: every point shows 1, whatever directions are
// drawn. The places are those of the same room where the lamp is all its light.
TEST(BrightPlaces, AWhiteCupInEvenLightIsNotSeen) {
  ShadedLamp lit(0.6, false);
  lit.build();
  const auto places = lit.find();
  ASSERT_NE(places, nullptr);
  ShadedLamp even(1, false);
  even.emission.back() = {1, 1, 1};
  even.environment = even_environment();
  even.build();
  PathOptions endless;
  endless.bounces = 1000;
  even.transport->draw_toward(places);
  for (const Vec3& target : {Vec3{-1, 0.2, -0.3}, Vec3{0.3, 0.1, -1}, Vec3{0.4, -1, 0.5}}) {
    const PathEstimate seen = even.seen(endless, {0.7, 0.5, 0.6}, target, 8000);
    EXPECT_NEAR(seen.radiance.y, 1, 4 * deviation(seen));
    EXPECT_LT(deviation(seen), 0.05);
  }
}

}  // namespace
}  // namespace goniochrome::render::bright_places_test
