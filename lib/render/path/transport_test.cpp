// Light transport against closed forms. Bounds are in standard errors of the estimate, as it states them.
#include "render/path/transport.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "base/hard_case_for_test.h"
#include "brdf/lobe_model.h"
#include "render/exact.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/scene_effects.h"

namespace goniochrome::render::transport_test {
namespace {

// Beyond so many standard errors of some ten independent figures an estimate is wrong; the errors are of 64 batches and
// more, so that their own spread is a tenth.
constexpr double kMostErrors = 5;

struct Worst {
  double errors = 0;    // in standard errors
  double relative = 0;  // to the truth
};
void judge(const PathEstimate& estimate, const color::Rgb& truth, Worst& worst) {
  for (int c = 0; c < 3; ++c) {
    const double off = std::abs(estimate.radiance[c] - truth[c]);
    // Floats round to 1e-6 where there is no noise at all.
    worst.errors = worst_of(worst.errors, off / (deviation(estimate, c) + 1e-6 * std::abs(truth[c])));
    worst.relative = worst_of(worst.relative, off / std::abs(truth[c]));
  }
}

// Albedo 1 in a light of 1 from everywhere is 1, in every corner of a cup and of a hollow of smooth normals. The
// control stops after the direct light.
TEST(HardCase, WhiteSurfacesInEvenLightShowThatLight) {
  Worst ours, direct;
  for (const double albedo : {1.0, 1.0000001}) {
    PathStage cup(box_mesh(false), {matt({albedo, albedo, albedo})});
    cup.environment = even_environment();
    PathStage hollow(sphere_mesh(24), {matt({albedo, albedo, albedo})});
    hollow.environment = even_environment();
    // A bowl: the lower half of a sphere seen from inside.
    std::vector<std::array<std::uint32_t, 3>> lower;
    for (const auto& t : hollow.mesh.triangles)
      if (hollow.mesh.positions[t[0]].y < 0.3) lower.push_back(t);
    hollow.mesh.triangles = lower;
    hollow.mesh.parts[0].count = lower.size();
    for (PathStage* stage : {&cup, &hollow}) {
      stage->build();
      for (const Vec3& target :
           {Vec3{0, -1, 0}, Vec3{0.99, -0.99, 0.99}, Vec3{-0.999, -0.5, 0.2}, Vec3{0.3, -0.9, -0.97}}) {
        for (const int bounces : {100, 0}) {
          PathOptions options;
          options.bounces = bounces;
          judge(stage->seen(options, {0.02, 0.6, 0.01}, 0.999 * target, 200), {1, 1, 1}, bounces > 0 ? ours : direct);
        }
        // The light as a correction of the unoccluded light.
        PathOptions options;
        options.bounces = 100;
        options.correction = true;
        PathEstimate estimate = stage->seen(options, {0.02, 0.6, 0.01}, 0.999 * target, 200);
        estimate.radiance += color::Rgb{1, 1, 1};
        judge(estimate, {1, 1, 1}, ours);
      }
    }
  }
  hard_case("transport-furnace",
            {"radiance of white walls in an even light of 1", direct.errors, ours.errors, kMostErrors, "sigma"});
  EXPECT_LT(ours.relative, 0.05);
}

TEST(Transport, AClosedBoxShowsTheGeometricSeries) {
  for (const double albedo : {0.5, 0.8}) {
    PathStage box(box_mesh(true), {matt({albedo, 0.5 * albedo, 0.2})});
    box.emission.assign(6, {1, 0.5, 0.25});
    box.build();
    const color::Rgb truth{1 / (1 - albedo), 0.5 / (1 - 0.5 * albedo), 0.25 / 0.8};
    Worst ours, cut;
    for (const int bounces : {1000, 3}) {
      PathOptions options;
      options.bounces = bounces;
      for (const Vec3& target : {Vec3{0, -1, 0}, Vec3{1, 0.9, 0.9}, Vec3{-0.9, -0.9, 1}})
        judge(box.seen(options, {0.1, 0.2, 0}, target, 300), truth, bounces > 3 ? ours : cut);
    }
    EXPECT_LT(ours.errors, kMostErrors);
    EXPECT_LT(ours.relative, 0.02);
    EXPECT_GT(cut.errors, kMostErrors);  // control: three bounces are not enough
  }
}

// In colored light paints act as matrices: L = e + R L, so that L = (1 - R)^-1 e.
TEST(Transport, AClosedBoxShowsTheSeriesOfColoredLight) {
  const color::ReflectionOperator op = color::iso_rgb_operator();
  PathStage box(box_mesh(true), {matt({0.6, 0.3, 0.2})});
  const color::Rgb light{1, 0.2, 0.1};
  box.emission.assign(6, light);
  box.scene.reflection = op;
  box.build();
  color::Matrix3 system = reflection_matrix(op, {0.6, 0.3, 0.2});
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) system[i][j] = (i == j ? 1.0 : 0.0) - system[i][j];
  const color::Rgb truth = color::product(color::inverse(system).matrix, light);
  Worst ours, plain;
  PathOptions options;
  options.bounces = 1000;
  judge(box.seen(options, {0.1, 0.2, 0}, {0, -1, 0}, 400), truth, ours);
  EXPECT_LT(ours.errors, kMostErrors);
  judge(box.seen(options, {0.1, 0.2, 0}, {0, -1, 0}, 400), light * color::Rgb{1 / 0.4, 1 / 0.7, 1 / 0.8}, plain);
  EXPECT_GT(plain.errors, kMostErrors);  // control: channel by channel
}

// Half a sky would be too easy: the plane sees a black ball that hides (R/d)^2 cos t of its cosine-weighted sky.
TEST(Transport, ABallHidesItsFormFactorFromAPlane) {
  mesh::Mesh mesh;
  add_rectangle(mesh, "plane", {-20, 0, -20}, {0, 0, 40}, {40, 0, 0});
  add_mesh(mesh, sphere_mesh(192), 0.7, {0.2, 1.5, -0.1});
  PathStage stage(std::move(mesh), {matt({0.9, 0.6, 0.3}), matt({0, 0, 0})});
  stage.environment = even_environment({1, 2, 0.5});
  stage.build();
  Worst ours, unoccluded;
  for (const Vec3& target : {Vec3{0.2, 0, -0.1}, Vec3{1, 0, 0.4}, Vec3{-2, 0, 1}, Vec3{4, 0, 3}}) {
    const Vec3 toward = Vec3{0.2, 1.5, -0.1} - target;
    const double d = length(toward), hidden = 0.49 / (d * d) * toward.y / d;
    const color::Rgb open = color::Rgb{0.9, 0.6, 0.3} * color::Rgb{1, 2, 0.5};
    for (const bool correction : {false, true}) {
      PathOptions options;
      options.bounces = 0;
      options.correction = correction;
      PathEstimate estimate = stage.seen(options, target + Vec3{0.02, 0.05, 0.01}, target, 400);
      if (correction) estimate.radiance += open;
      judge(estimate, (1 - hidden) * open, ours);
      judge({open, estimate.covariance}, (1 - hidden) * open, unoccluded);
    }
  }
  EXPECT_LT(ours.errors, kMostErrors);
  EXPECT_LT(ours.relative, 0.01);
  EXPECT_GT(unoccluded.errors, kMostErrors);  // control
}

// light.md section 2: an element that sees a rectangle parallel to it, or at a right angle.
TEST(Transport, RectanglesShineByTheirFormFactors) {
  const auto parallel = [](double a, double b) {
    const double x = std::hypot(1, a), y = std::hypot(1, b);
    return (a / x * std::atan(b / x) + b / y * std::atan(a / y)) / (2 * kPi);
  };
  const auto perpendicular = [](double x, double y) {
    const double r = std::hypot(x, y);
    return (std::atan(1 / y) - y / r * std::atan(1 / r)) / (2 * kPi);
  };
  struct Case {
    Vec3 corner, a, b;
    double factor;
  };
  const double c = 0.8, a = 1.1, b = 0.6;
  for (const Case& each : {Case{{0, 0, c}, {a, 0, 0}, {0, b, 0}, parallel(a / c, b / c)},
                           Case{{c, 0, 0}, {0, b, 0}, {0, 0, a}, perpendicular(a / b, c / b)}}) {
    mesh::Mesh mesh;
    add_rectangle(mesh, "element", {-1e-3, -1e-3, 0}, {2e-3, 0, 0}, {0, 2e-3, 0});
    add_rectangle(mesh, "lamp", each.corner, each.a, each.b);
    PathStage stage(std::move(mesh), {matt({1, 1, 1}), matt({0, 0, 0})});
    stage.emission = {{0, 0, 0}, {3, 2, 1}};
    stage.build();
    Worst ours, wrong;
    PathOptions options;
    const PathEstimate estimate = stage.seen(options, {-0.1, -0.1, 0.3}, {0, 0, 0}, 400);
    judge(estimate, each.factor * color::Rgb{3, 2, 1}, ours);
    judge(estimate, 1.03 * each.factor * color::Rgb{3, 2, 1}, wrong);
    EXPECT_LT(ours.errors, kMostErrors);
    EXPECT_LT(ours.relative, 0.01);
    EXPECT_GT(wrong.errors, kMostErrors);  // control
  }
}

// The product along a path from the eye is the product from the light outward. The control multiplies the paints from
// the eye.
TEST(HardCase, ColoredLightIsReflectedFromTheLightOutward) {
  const color::ReflectionOperator op = color::iso_rgb_operator();
  TestNumbers next(4);
  const auto color = [&] { return color::Rgb{next(), next(), next()}; };
  double ours = 0, textbook = 0;
  for (int i = 0; i < 1000; ++i) {
    const color::Rgb light = color(), paints[3] = {color(), color(), color()};
    PathProduct path(&op);
    for (const color::Rgb& paint : paints) path.reflect(paint);
    const color::Rgb truth = reflected(op, reflected(op, reflected(op, light, paints[2]), paints[1]), paints[0]);
    const color::Rgb eyeward = reflected(op, reflected(op, reflected(op, paints[0], paints[1]), paints[2]), light);
    for (int c = 0; c < 3; ++c) {
      ours = worst_of(ours, std::abs(path.shown(light)[c] - truth[c]));
      textbook = worst_of(textbook, std::abs(eyeward[c] - truth[c]));
    }
  }
  hard_case("transport-order", {"light that three paints reflect", textbook, ours, 1e-12, "absolute"});
}

paint::LobeFit coated() {
  paint::LobeFit paint;
  paint.diffuse = {0.08, 0.05, 0.02};
  paint.lobes = {{3, {0.05, 0.1, 0.1}, {}},
                 {40, {0.3, 0.2, 0.1}, {0.5, 0.5, 0.5}},
                 {700, {}, {9, 9, 9}},
                 {paint::kMirrorExponent, {}, {0.8, 0.8, 0.8}}};
  return paint;
}

// A convex shape blocks nothing: paths show what the reference integrator sums, and there is nothing to correct.
TEST(Transport, AConvexShapeShowsTheReferenceIntegral) {
  for (const bool brushed : {false, true}) {
    paint::LobeFit paint = coated();
    if (!brushed)
      paint.views = {{20, paint.diffuse, paint.lobes}, {70, 2.0 * paint.diffuse, {{40, {1, 1, 1}, {0.1, 0, 0}}}}};
    PathStage stage(sphere_mesh(96), {paint});
    stage.environment = studio();
    stage.scene.lights = {{normalized({1, 2, 1}), {0.5, 0.4, 0.3}}};
    stage.scene.gloss_deg = {20};
    stage.scene.reflection = color::iso_rgb_operator();
    if (brushed) stage.scene.anisotropy = {{0.15, 0.5}};
    const Transport& transport = stage.build();
    ExactModel model;
    model.fresnel = true;
    model.gloss_deg = 20;
    model.reflection = &stage.scene.reflection;
    Effects effects;
    effects.lobes = {{3, true, true}, {40, true, true}, {700, true, true}};
    effects.tilt_tolerance = 1e-3;
    if (brushed) model.tilts = tilts_of(stage.scene, effects)[0];
    ExactModel without = model;
    without.fresnel = false;
    Worst ours, control;
    for (const Vec3& eye : {Vec3{0, 0, 3}, Vec3{2, 1.5, 2}, Vec3{-1, 3, 0.5}}) {
      for (const double off : {0.0, 0.5, 0.85}) {
        const Vec3 across = normalized(cross(eye, {0.3, 1, 0.1})), target = off * across;
        const Vec3 toward = normalized(target - eye);
        const rays::RayScene& rays = transport.rays();
        const rays::Hit hit = rays.closest(rays.local(eye), rays::float3(toward));
        const rays::Spot spot = rays.spot(hit, rays.local(eye), rays::float3(toward));
        const Vec3 normal = normalized(rays::vec3(spot.shading));
        const color::Rgb truth =
            reference_radiance({{normal, -toward, &paint, &model}}, &*stage.environment, stage.scene.lights)[0];
        PathOptions options;
        const PathEstimate estimate = path_estimate(transport, options, spot, -toward, 800, 3);
        judge(estimate, truth, ours);
        judge(estimate,
              reference_radiance({{normal, -toward, &paint, &without}}, &*stage.environment, stage.scene.lights)[0],
              control);
        options.correction = true;
        const PointTransport at(transport, options, spot, rays::float3(-toward));
        EXPECT_TRUE(at.certain());
        EXPECT_EQ(at.deterministic(), color::Rgb{});
      }
    }
    EXPECT_LT(ours.errors, kMostErrors) << brushed;
    EXPECT_LT(ours.relative, 0.03);
    EXPECT_GT(control.errors, kMostErrors);
  }
}

// Where a mesh blocks and bounces, the correction is the whole less the sum of the reference integrator without it, for
// every share of the gathered light.
TEST(Transport, TheCorrectionIsTheWholeLessTheOpenLight) {
  mesh::Mesh mesh = box_mesh(false);
  add_mesh(mesh, sphere_mesh(48), 0.4, {0.2, -0.5, 0.1});
  PathStage stage(std::move(mesh), {coated()});
  stage.scene.paints[1] = matt({0.8, 0.2, 0.1});
  stage.environment = studio();
  stage.scene.lights = {{normalized({0.3, 2, 0.2}), {0.5, 0.4, 0.3}}};
  const Transport& transport = stage.build();
  ExactModel model;
  model.fresnel = true;
  Worst ours;
  double changed = 0;
  for (const Vec3& target : {Vec3{0.2, -0.12, 0.1}, Vec3{0.9, -1, 0.9}, Vec3{-0.5, -1, 0.3}, Vec3{1, -0.5, 0.1}}) {
    const Vec3 eye{-0.3, 1.6, 0.2}, toward = normalized(target - eye);
    const rays::RayScene& rays = transport.rays();
    const rays::Spot spot =
        rays.spot(rays.closest(rays.local(eye), rays::float3(toward)), rays.local(eye), rays::float3(toward));
    const Vec3 normal = normalized(rays::vec3(spot.shading));
    const paint::LobeFit& paint = stage.scene.paints[static_cast<std::size_t>(spot.part)];
    const color::Rgb open =
        reference_radiance({{normal, -toward, &paint, &model}}, &*stage.environment, stage.scene.lights)[0];
    for (const int bounces : {0, 4}) {
      PathOptions options;
      options.bounces = bounces;
      const PathEstimate whole = path_estimate(transport, options, spot, -toward, 500, 1);
      options.correction = true;
      PathEstimate difference = path_estimate(transport, options, spot, -toward, 500, 2);
      changed = std::max(changed, std::abs(difference.radiance.y / open.y));
      for (std::size_t k = 0; k < 6; ++k) difference.covariance[k] += whole.covariance[k];
      difference.radiance += open;
      judge(difference, whole.radiance, ours);
    }
    // The shares of lobes and diffuse part add up.
    PathOptions options;
    options.bounces = 2;
    const PathEstimate all = path_estimate(transport, options, spot, -toward, 500, 3);
    options.into_diffuse = false;
    PathEstimate sum = path_estimate(transport, options, spot, -toward, 500, 4);
    options.into_diffuse = true, options.into_lobes = false;
    const PathEstimate diffuse = path_estimate(transport, options, spot, -toward, 500, 5);
    options.bounces = 0;
    const PathEstimate neither = path_estimate(transport, options, spot, -toward, 500, 6);
    sum.radiance += diffuse.radiance - neither.radiance;
    for (std::size_t k = 0; k < 6; ++k)
      sum.covariance[k] += diffuse.covariance[k] + neither.covariance[k] + all.covariance[k];
    judge(sum, all.radiance, ours);
  }
  EXPECT_LT(ours.errors, kMostErrors);
  EXPECT_GT(changed, 0.1);
}

// A sun of 1e8 in one texel, found by a path from a matt floor by way of a mirror only. Its light is known: the mirror
// shows the sun's image. The control cuts samples at a hundred times the open sky, as renderers do against fireflies.
TEST(HardCase, ASunInAMirrorIsFoundAndItsErrorTold) {
  mesh::Mesh mesh;
  add_rectangle(mesh, "floor", {-3, 0, -3}, {0, 0, 6}, {6, 0, 0});
  add_rectangle(mesh, "mirror", {1, 0, -40}, {0, 0, 80}, {0, 40, 0});  // faces -X
  PathStage stage(std::move(mesh), {matt({0.5, 0.5, 0.5}), only_mirror(0.9)});
  // From -X at some 30 degrees; a wall behind the floor keeps its direct light away.
  add_rectangle(stage.mesh, "wall", {-3, 0.02, -3}, {0, 0, 6}, {0, 3, 0});
  stage.scene.paints.push_back(matt({0, 0, 0}));
  constexpr int kWidth = 64, kHeight = 32, kColumn = 48, kRow = 10;
  stage.environment = environment_of(kWidth, kHeight, [](int x, int y) {
    return x == kColumn && y == kRow ? color::Rgb{1e8, 1e8, 1e8} : color::Rgb{1, 1, 1};
  });
  ASSERT_LT(stage.environment->direction(kColumn, kRow).x, -0.7);
  stage.build();
  // Truth: the integral over the texel of f cos L K_M F, every direction of which the mirror sends to the floor.
  const auto truth = [&](const Vec3& point) {
    double sum = 0;
    constexpr int kGrid = 200;
    for (int i = 0; i < kGrid; ++i) {
      for (int j = 0; j < kGrid; ++j) {
        const double c0 = kColumn + static_cast<double>(i) / kGrid, r0 = kRow + static_cast<double>(j) / kGrid;
        const Vec3 d = stage.environment->direction_at(c0 + 0.5 / kGrid, r0 + 0.5 / kGrid);
        const Vec3 toward{-d.x, d.y, d.z};  // from the floor to the mirror
        if (toward.x <= 0 || toward.y <= 0) continue;
        // The ray that the mirror sends to the sun must pass over the wall.
        const double way = (1 - point.x) / toward.x, height = point.y + way * toward.y;
        if (height + 4 / toward.x * toward.y < 3.02) continue;
        const double omega = stage.environment->solid_angle(c0, r0, c0 + 1.0 / kGrid, r0 + 1.0 / kGrid);
        sum += 0.5 / kPi * d.y * 1e8 * 0.9 * brdf::fresnel_dielectric(toward.x, brdf::kCoatIndex) * omega;
      }
    }
    return sum;
  };
  PathOptions options;
  options.bounces = 4;
  int covered = 0, points = 0;
  double ours = 0, cut = 0, variance = 0;  // sums of relative errors
  for (int i = 0; i < 60; ++i) {
    const Vec3 target{0.6 - 0.03 * i, 0, 0.02 * i};
    const double expected = truth(target);
    if (expected < 1000) continue;  // in the wall's shadow, or at its edge
    const PathEstimate estimate =
        stage.seen(options, target + Vec3{0.1, 0.5, 0}, target, 1500, static_cast<std::uint64_t>(i));
    ++points;
    EXPECT_TRUE(std::isfinite(deviation(estimate)));
    EXPECT_GT(deviation(estimate), 1e-3 * expected);  // it is told
    covered += std::abs(estimate.radiance.y - expected) < 1.96 * deviation(estimate);
    ours += estimate.radiance.y / expected - 1;
    cut += std::min(estimate.radiance.y, 100.0) / expected - 1;
    variance += std::pow(deviation(estimate) / expected, 2);
  }
  ASSERT_GT(points, 20);
  // The bound is that of 95 % intervals of skewed estimates (each batch finds the sun with a chance of some percent).
  EXPECT_GT(covered, 0.85 * points);
  hard_case("transport-firefly",
            {"light of a sun of 1e8 by way of a mirror, mean of its points", std::abs(cut) / std::sqrt(variance),
             std::abs(ours) / std::sqrt(variance), kMostErrors, "sigma"});
  EXPECT_LT(std::abs(ours) / points, 0.1);
}

// Errors that are stated cover the true ones: of 95 % intervals by Student's t of 15 degrees of freedom, between 93 and
// 97 % of 1,000 hold the truth (three standard deviations of the count are 2.1 %). The control takes one standard error
// for two.
TEST(Transport, StatedErrorsCoverTheTrueOnes) {
  mesh::Mesh mesh;
  add_rectangle(mesh, "plane", {-20, 0, -20}, {0, 0, 40}, {40, 0, 0});
  add_mesh(mesh, sphere_mesh(128), 0.7, {0, 1.2, 0});
  PathStage stage(std::move(mesh), {matt({0.9, 0.6, 0.3}), matt({0, 0, 0})});
  stage.environment = even_environment();
  stage.build();
  TestNumbers next(11);
  int covered = 0, half = 0;
  constexpr int kPoints = 1000;
  for (int i = 0; i < kPoints; ++i) {
    const Vec3 target{2 * next() - 1, 0, 2 * next() - 1}, toward = Vec3{0, 1.2, 0} - target;
    const double d = length(toward), truth = 0.6 * (1 - 0.49 / (d * d) * toward.y / d);
    PathOptions options;
    options.bounces = 0;
    const PathEstimate estimate =
        stage.seen(options, target + Vec3{0.01, 0.04, 0.01}, target, 16, static_cast<std::uint64_t>(i));
    const double off = std::abs(estimate.radiance.y - truth) / deviation(estimate);
    covered += off < 2.131;
    half += off < 1.066;
  }
  EXPECT_GT(covered, 0.93 * kPoints);
  EXPECT_LT(covered, 0.97 * kPoints);
  EXPECT_LT(half, 0.93 * kPoints);
}

TEST(Transport, RefusesWhatItCannotTrace) {
  PathStage stage(box_mesh(true), {matt({0.5, 0.5, 0.5})});
  PathScene scene;
  scene.scene = &stage.scene;
  scene.emission = {{1, 1, std::nan("")}};
  EXPECT_FALSE(Transport::create(scene).ok());
  scene.emission.clear();
  stage.scene.paints.pop_back();
  EXPECT_FALSE(Transport::create(scene).ok());
  stage.scene.paints.push_back(matt({0.5, std::nan(""), 0.5}));
  const auto refused = Transport::create(scene);
  ASSERT_FALSE(refused.ok());
  EXPECT_NE(refused.error().message.find("lid"), std::string::npos) << refused.error().message;
}

}  // namespace
}  // namespace goniochrome::render::transport_test
