// Color maps and textures in paths: against quadrature in doubles, the reference integrator and the engine cpu.
#include <gtest/gtest.h>

#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "render/exact.h"
#include "render/path/chi_square_for_test.h"
#include "render/path/lobe_transport.h"
#include "render/path/scenes_for_paths_for_test.h"
#include "render/path/traced_paint.h"
#include "render/path/visible_surface.h"
#include "render/renderer.h"
#include "render/scene_effects.h"
#include "render/surface_layer.h"

namespace goniochrome::render::traced_surface_test {
namespace {

using rays::Float3;
using rays::float3;

// The bound of transport_test.cpp: beyond so many standard errors an estimate is wrong.
constexpr double kMostErrors = 5;

struct Worst {
  double errors = 0, relative = 0;
};
void judge(const PathEstimate& estimate, const color::Rgb& truth, Worst& worst) {
  for (int c = 0; c < 3; ++c) {
    const double off = std::abs(estimate.radiance[c] - truth[c]);
    // A sum in floats without noise is off by 1e-4 of the sharpest lobe's flank, as in samplers_test.cpp.
    worst.errors = std::max(worst.errors, off / (deviation(estimate, c) + 1e-4 * std::abs(truth[c])));
    worst.relative = std::max(worst.relative, off / std::abs(truth[c]));
  }
}

// A map that travels: bright and red where the view is near the mirror direction, blue elsewhere, darker at grazing
// angles. `level` scales it.
brdf::ColorMap traveling_map(double level = 1) {
  brdf::ColorMap map = brdf::color_map_of_size(24, 1.5);
  for (int row = 0; row < 48; ++row) {
    for (int column = 0; column < 24; ++column) {
      const auto [light, view] = brdf::map_directions(24, column, row);
      const Vec3 mirrored{-light.x, 0, light.z};
      const double near = std::pow(std::max(0.0, dot(mirrored, view)), 12), steep = 0.4 + 0.6 * light.z * view.z;
      const double rgb[] = {0.1 + 0.9 * near, 0.1 + 0.4 * near, 0.5 - 0.3 * near};
      for (int c = 0; c < 3; ++c) map.texel(column, row)[c] = static_cast<float>(level * steep * rgb[c]);
    }
  }
  return map;
}

brdf::ColorMap even_map(float factor) {
  brdf::ColorMap map = brdf::color_map_of_size(4, 1.5);
  std::ranges::fill(map.factors, factor);
  return map;
}

// Lobes that are near the map, and a gloss that it leaves alone.
paint::LobeFit mapped_paint() {
  paint::LobeFit paint;
  paint.diffuse = {0.03, 0.03, 0.1};
  paint.lobes = {{12, {0.25, 0.1, 0.01}, {0.2, 0.2, 0.2}}, {300, {}, {4, 4, 4}}};
  return paint;
}

// Brushed metal whose direction turns across, in two exponents; every other row is darker.
brdf::SbrdfTexture brushed() {
  brdf::SbrdfTexture texture{8, 4, 2, {}};
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 8; ++column) {
      const double angle = 2 * kPi * column / 8;
      const double share = row % 2 == 0 ? 1.0 : 0.3;
      for (const double value : {0.05, 0.03 * share, 0.02, std::cos(angle), std::sin(angle),   //
                                 0.3 * share, 0.2 * share, 0.1 * share, -1.0, -0.4, 1.0, 8.0,  //
                                 1.5 * share, 1.2 * share, 0.9 * share, -1.0, -0.9, 1.0, 60.0})
        texture.values.push_back(static_cast<float>(value));
    }
  }
  return texture;
}

// With normals that lean to all sides.
brdf::SbrdfTexture with_normals(brdf::SbrdfTexture texture) {
  for (int i = 0; i < texture.width * texture.height; ++i) {
    const Vec3 normal = normalized({std::cos(2.0 * i), std::sin(2.0 * i), 1.2});
    for (int c = 0; c < 3; ++c) texture.normals.push_back(static_cast<float>(normal[c]));
  }
  return texture;
}

// A stage some of whose parts have a surface beyond their paint.
struct LayeredStage : PathStage {
  std::vector<PartSurface> surfaces;
  std::unique_ptr<SurfaceLayer> layer;

  using PathStage::PathStage;
  const Transport& build_with_layer() {
    layer = std::make_unique<SurfaceLayer>(scene, surfaces, brdf::CriticalAngle::kSlide);
    scene.layer = layer.get();
    return build();
  }
  rays::Spot spot(const Vec3& eye, const Vec3& target) const {
    const rays::RayScene& rays = transport->rays();
    const Float3 direction = float3(normalized(target - eye));
    const rays::Hit hit = rays.closest(rays.local(eye), direction);
    if (!hit.any()) throw std::runtime_error("nothing is seen");
    return rays.spot(hit, rays.local(eye), direction);
  }
  TexturedPoint textured_point(const rays::Spot& spot, const Vec3& to_viewer) const {
    MeshPoint point;
    point.triangle = spot.triangle;
    point.shares = {1.0 - spot.u - spot.v, spot.u, spot.v};
    return {normalized(rays::vec3(spot.shading)), to_viewer, layer->place(spot.part, point, spot.inside).pieces};
  }
};

// Directions of a viewer and lights, in the frame z = normal and turned away from it.
struct TurnedFrame {
  Vec3 n = normalized({0.2, 0.9, -0.3}), x = normalized(cross(n, {1, 0, 0})), y = cross(n, x);
  Vec3 world(const Vec3& d) const { return d.x * x + d.y * y + d.z * n; }
};
Vec3 at_angles(double polar_deg, double azimuth_deg) {
  const double t = polar_deg * kDegree, p = azimuth_deg * kDegree;
  return {std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t)};
}

double excess_of(const PaintedPoint& point, double wrong_factor = 1) {
  return excess_of_draws(point, 200, 24, [&](const Vec3& d) {
    return (dot(d, rays::vec3(point.mirrored())) > 0.9 ? wrong_factor : 1) * point.at(float3(d)).pdf;
  });
}

TEST(TracedSurface, MapsAndTexturesAreDrawnAsTheirDensitySays) {
  LayeredStage stage(panels_mesh(3), {mapped_paint(), {}, {}});
  const brdf::ColorMap map = traveling_map();
  const brdf::SbrdfTexture texture = brushed(), tilted = with_normals(texture);
  stage.surfaces = {{{}, &map}, {{{&texture, 1.7}}}, {{{&tilted, 1.7}}}};
  stage.build_with_layer();
  for (std::size_t part = 0; part < 3; ++part) {
    auto paint = TracedPaint::create(stage.scene.paints[part], 45, {});
    ASSERT_TRUE(paint.ok());
    EXPECT_TRUE(paint->is_lobe_model());
    paint->put_surface(*stage.layer, static_cast<int>(part));
    EXPECT_FALSE(paint->is_lobe_model());
    for (const double view_deg : {0.0, 35.0, 80.0}) {
      const Vec3 viewer = at_angles(view_deg, 40);
      const Vec3 target{static_cast<double>(part) - 1.13, 0.21, 0};
      const PaintedPoint point(stage.spot(target + viewer, target), *paint, float3(viewer));
      EXPECT_LT(excess_of(point), 5) << part << " " << view_deg;
      if (view_deg == 35 && part < 2) {        // tilted texels draw little where the control looks
        EXPECT_GT(excess_of(point, 1.05), 5);  // control
      }
    }
  }
}

// f cos_i of a mapped point is the map's reflectance factor over pi and the gloss of the paint.
TEST(TracedSurface, AMapTakesTheFlakesPlaceAndLeavesTheGloss) {
  LayeredStage stage(panels_mesh(1), {mapped_paint()});
  const brdf::ColorMap map = traveling_map();
  stage.surfaces = {{{}, &map}};
  stage.build_with_layer();
  auto paint = TracedPaint::create(mapped_paint(), 45, {});
  paint->put_surface(*stage.layer, 0);
  paint::LobeFit gloss = mapped_paint();
  gloss.diffuse = {};
  for (paint::Lobe& lobe : gloss.lobes) lobe.directional_diffuse = {};
  const TurnedFrame frame;
  TestNumbers next(11);
  double worst = 0, flakes = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 viewer = at_angles(85 * next(), 360 * next()), light = at_angles(85 * next(), 360 * next());
    const PaintedPoint point(*paint, float3(frame.n), float3(frame.world(viewer)));
    const color::Rgb f = rays::vec3(point.at(float3(frame.world(light))).f_cos);
    const color::Rgb truth = light.z / kPi * brdf::reflectance_factor(map, light, viewer, brdf::CriticalAngle::kSlide) +
                             light.z * brdf::coated_brdf(gloss, light, viewer, {0, 0, 1}, 45);
    for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(f[c] - truth[c]) / truth[c]);
    const color::Rgb lobes = light.z * brdf::coated_brdf(mapped_paint(), light, viewer, {0, 0, 1}, 45);
    flakes = std::max(flakes, std::abs(lobes.x - truth.x) / truth.x);
  }
  EXPECT_LT(worst, 1e-4);  // floats; see samplers_test.cpp
  EXPECT_GT(flakes, 0.1);  // control: the lobes alone
}

// Under an environment: the integral over directions in doubles, from the middles of pieces of its texels.
color::Rgb mapped_integral(const brdf::ColorMap& map, const paint::LobeFit& gloss, const envmap::Environment& env,
                           const Vec3& normal, const Vec3& to_viewer) {
  const Vec3 x = normalized(cross(std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, normal)),
             y = cross(normal, x);
  const auto local = [&](const Vec3& d) { return Vec3{dot(d, x), dot(d, y), dot(d, normal)}; };
  const Vec3 wo = local(to_viewer);
  color::Rgb sum;
  for (int row = 0; row < env.height(); ++row) {
    for (int column = 0; column < env.width(); ++column) {
      const Vec3 wi = local(env.direction(column, row));
      if (wi.z <= 0) continue;
      const color::Rgb f = 1 / kPi * brdf::reflectance_factor(map, wi, wo, brdf::CriticalAngle::kSlide) +
                           brdf::coated_brdf(gloss, wi, wo, {0, 0, 1}, 45);
      const float* light = env.radiance(column, row);
      sum += env.solid_angle(column, row) * wi.z * f * color::Rgb{light[0], light[1], light[2]};
    }
  }
  return sum;
}

TEST(TracedSurface, AMappedConvexShapeShowsTheIntegral) {
  LayeredStage stage(sphere_mesh(96), {mapped_paint()});
  const brdf::ColorMap map = traveling_map();
  stage.surfaces = {{{}, &map}};
  stage.environment = studio();
  const Transport& transport = stage.build_with_layer();
  paint::LobeFit gloss = mapped_paint();
  gloss.diffuse = {};
  for (paint::Lobe& lobe : gloss.lobes) lobe.directional_diffuse = {};
  const envmap::Environment fine = stage.environment->cut_to(0.015);
  ExactModel model;
  model.fresnel = true;
  Worst ours, lobes;
  for (const Vec3& eye : {Vec3{0, 0, 3}, Vec3{2, 1.5, 2}, Vec3{-1, 3, 0.5}}) {
    for (const double off : {0.0, 0.5, 0.85}) {
      const Vec3 target = off * normalized(cross(eye, {0.3, 1, 0.1})), toward = normalized(target - eye);
      const rays::Spot spot = stage.spot(eye, target);
      const Vec3 normal = normalized(rays::vec3(spot.shading));
      const PathEstimate estimate = path_estimate(transport, {}, spot, -toward, 800, 3);
      judge(estimate, mapped_integral(map, gloss, fine, normal, -toward), ours);
      const paint::LobeFit paint = mapped_paint();
      judge(estimate, reference_radiance({{normal, -toward, &paint, &model}}, &*stage.environment, {})[0], lobes);
    }
  }
  EXPECT_LT(ours.errors, kMostErrors);
  EXPECT_LT(ours.relative, 0.03);
  EXPECT_GT(lobes.errors, kMostErrors);  // control: the lobes in the map's place
}

// A satin coat has gloss for each view, which a map leaves alone: under lights in its highlight a ball shows what
// exact_radiance() has.
TEST(TracedSurface, AMapLeavesTheGlossOfEachView) {
  const brdf::ColorMap map = traveling_map();
  paint::LobeFit satin = mapped_paint();
  satin.lobes.push_back({1000, {}, {0.1, 0.1, 0.1}});
  satin.views = {{0, satin.diffuse, {{12, {}, {0.05, 0.05, 0.05}}, {300, {}, {0.5, 0.5, 0.5}}}},
                 {60, satin.diffuse, {{300, {}, {8, 8, 8}}, {1000, {}, {20, 20, 20}}}}};
  LayeredStage stage(sphere_mesh(96), {satin});
  stage.surfaces = {{{}, &map}};
  const Vec3 eye{0, 0, 3};
  for (const double off : {0.2, 0.5, 0.8}) {
    // The lamp of each place stands in the mirror direction.
    const double view = std::asin(off);
    stage.scene.lights.push_back({{std::sin(2 * view), 0, std::cos(2 * view)}, {0.3, 0.2, 0.1}});
  }
  const Transport& transport = stage.build_with_layer();
  Worst ours, control;
  for (const double off : {0.2, 0.5, 0.8}) {
    const Vec3 target{off, 0, std::sqrt(1 - off * off)}, toward = normalized(target - eye);
    const rays::Spot spot = stage.spot(eye, target);
    const Vec3 normal = normalized(rays::vec3(spot.shading));
    const PathEstimate estimate = path_estimate(transport, {}, spot, -toward, 2, 3);
    Effects effects = effects_of(stage.scene);
    effects.fresnel = true;
    const VisiblePoint point{normal, -toward, 0};
    judge(estimate, exact_radiance({point}, stage.scene, effects, nullptr)[0], ours);
    effects.views = false;
    judge(estimate, exact_radiance({point}, stage.scene, effects, nullptr)[0], control);
  }
  EXPECT_LT(ours.relative, 2e-3);
  EXPECT_GT(control.relative, 0.1);
}

// Under a light, of an operator too, maps and textures show what exact_radiance() has; textures under an environment
// as well.
TEST(TracedSurface, AConvexShapeShowsTheReference) {
  const brdf::ColorMap map = traveling_map();
  const brdf::SbrdfTexture texture = brushed();
  for (const bool textured : {false, true}) {
    LayeredStage stage(sphere_mesh(96), {textured ? paint::LobeFit{} : mapped_paint()});
    stage.surfaces = {textured ? PartSurface{{{&texture, 6}}} : PartSurface{{}, &map}};
    if (textured) stage.environment = studio();
    stage.scene.lights = {{normalized({1, 2, 1}), {0.5, 0.4, 0.3}}, {normalized({-1, 1, 2}), {0.2, 0.1, 0.5}}};
    stage.scene.reflection = color::iso_rgb_operator();
    const Transport& transport = stage.build_with_layer();
    Worst ours, control;
    Effects effects = effects_of(stage.scene);
    effects.fresnel = true;
    for (const Vec3& eye : {Vec3{0, 0, 3}, Vec3{2, 1.5, 2}, Vec3{-1, 3, 0.5}}) {
      for (const double off : {0.1, 0.5, 0.85}) {
        const Vec3 target = off * normalized(cross(eye, {0.3, 1, 0.1})), toward = normalized(target - eye);
        const rays::Spot spot = stage.spot(eye, target);
        const Vec3 normal = normalized(rays::vec3(spot.shading));
        const PathEstimate estimate = path_estimate(transport, {}, spot, -toward, textured ? 800 : 2, 3);
        const envmap::Environment* env = stage.environment ? &*stage.environment : nullptr;
        color::Rgb truth, other;
        if (textured) {
          TexturedPoint point = stage.textured_point(spot, -toward);
          truth = textured_radiance({point}, env, stage.scene.lights, &stage.scene.reflection)[0];
          for (SurfaceLayer::Piece& piece : point.pieces)
            piece.tangent = cross(normal, piece.tangent);  // control: brushed across
          other = textured_radiance({point}, env, stage.scene.lights, &stage.scene.reflection)[0];
        } else {
          truth = exact_radiance({{normal, -toward, 0}}, stage.scene, effects, nullptr)[0];
          effects.maps = false;
          other = exact_radiance({{normal, -toward, 0}}, stage.scene, effects, nullptr)[0];
          effects.maps = true;
        }
        if (length(truth) == 0) continue;
        judge(estimate, truth, ours);
        judge(estimate, other, control);
      }
    }
    EXPECT_LT(ours.errors, kMostErrors) << textured;
    EXPECT_LT(ours.relative, 0.03) << textured;
    EXPECT_GT(control.errors, 2 * kMostErrors) << textured;
  }
}

// The light of the open surroundings, as maps and sums have it, and what rays change of it are the light along paths.
// Below the surface a tilted texel sees the surface in the place of the surroundings.
TEST(TracedSurface, RaysTakeTheLightThatTiltedTexelsHaveFromBelow) {
  mesh::Mesh plate = panels_mesh(1);
  for (const Vec3& p : plate.positions) plate.texture.push_back({static_cast<float>(p.x), static_cast<float>(p.y)});
  LayeredStage stage(std::move(plate), {{}});
  brdf::SbrdfTexture texture = {1, 1, 1, {0.1F, 0.1F, 0.1F, 1, 0, 0.5F, 0.4F, 0.3F, -1, -1, 1, 6}};
  texture = with_normals(texture);
  stage.surfaces = {{{{&texture, 1}}}};
  stage.environment = environment_of(32, 16, [](int, int row) { return color::Rgb{1, 1, row < 8 ? 1.0 : 2.0}; });
  stage.scene.lights = {{normalized({-1, 0.2, 2}), {0.5, 0.4, 0.3}, 0.1}, {normalized({1, 0, -0.2}), {0.2, 0.3, 0.4}}};
  const Transport& transport = stage.build_with_layer();
  Effects effects = effects_of(stage.scene);
  effects.environment = true;
  double control = 0;
  for (const Vec3& eye : {Vec3{0, 0, 3}, Vec3{2, 1.5, 1}, Vec3{-3, 1, 0.5}}) {
    const Vec3 toward = normalized(-eye);
    const rays::Spot spot = stage.spot(eye, {});
    PathOptions changes;
    changes.correction = true;
    const PathEstimate all = path_estimate(transport, {}, spot, -toward, 800, 3),
                       changed = path_estimate(transport, changes, spot, -toward, 800, 5);
    const color::Rgb open = exact_radiance({{{0, 0, 1}, -toward, 0}}, stage.scene, effects, &*stage.environment)[0];
    for (int c = 0; c < 3; ++c) {
      const double error = std::hypot(deviation(all, c), deviation(changed, c)) + 1e-3 * all.radiance[c];
      EXPECT_LT(std::abs(open[c] + changed.radiance[c] - all.radiance[c]), kMostErrors * error) << eye.x;
      control = std::max(control, std::abs(changed.radiance[c]) / error);
    }
  }
  EXPECT_GT(control, 10 * kMostErrors);
}

// Two sheets at a right angle: what a matt floor gets from a wall under a light, against the sum over points of the
// wall as the reference has it. The light comes level with the floor, so that none of it meets the floor itself.
TEST(TracedSurface, BouncesFindTheTexelsAndTheMap) {
  const brdf::ColorMap map = traveling_map();
  const brdf::SbrdfTexture texture = brushed();
  for (const bool textured : {false, true}) {
    mesh::Mesh mesh;
    add_rectangle(mesh, "floor", {-1, 0, -1}, {0, 0, 2}, {2, 0, 0});   // faces up
    add_rectangle(mesh, "wall", {-1, 0, -1}, {2, 0, 0}, {0, 1.5, 0});  // faces +Z
    for (const auto& p : mesh.positions) mesh.texture.push_back({static_cast<float>(p.x), static_cast<float>(p.y)});
    LayeredStage stage(std::move(mesh), {matt({0.8, 0.6, 0.5}), textured ? paint::LobeFit{} : mapped_paint()});
    stage.surfaces = {{}, textured ? PartSurface{{{&texture, 1.3}}} : PartSurface{{}, &map}};
    stage.scene.lights = {{normalized({0.3, 0, 1}), {0.9, 0.8, 0.7}}};
    const Transport& transport = stage.build_with_layer();
    Effects effects = effects_of(stage.scene);
    effects.fresnel = true;
    Worst ours, control;
    for (const Vec3& target : {Vec3{0.1, 0, -0.5}, Vec3{-0.6, 0, 0.3}}) {
      const auto gathered = [&](bool as_it_is) {
        constexpr int kColumns = 240, kRows = 180;
        std::vector<VisiblePoint> points;
        std::vector<TexturedPoint> textures;
        std::vector<double> factors;
        for (int i = 0; i < kRows; ++i) {
          for (int j = 0; j < kColumns; ++j) {
            const Vec3 at{2 * (j + 0.5) / kColumns - 1, 1.5 * (i + 0.5) / kRows, -1}, way = target - at;
            const double d = length(way);
            const Vec3 to_floor = (1 / d) * way;
            factors.push_back(to_floor.z * -to_floor.y / (d * d) * 3.0 / (kColumns * kRows));
            points.push_back({{0, 0, 1}, to_floor, 1});
            if (textured) {
              textures.push_back(stage.textured_point(stage.spot(at + 0.01 * to_floor, at), to_floor));
              if (!as_it_is)
                textures.back().pieces = stage.textured_point(stage.spot({0, 0.5, 0}, {0, 0.5, -1}), {0, 0, 1}).pieces;
            }
          }
        }
        Effects shown = effects;
        shown.maps = shown.maps && as_it_is;
        const std::vector<color::Rgb> light = textured
                                                  ? textured_radiance(textures, nullptr, stage.scene.lights, nullptr)
                                                  : exact_radiance(points, stage.scene, shown, nullptr);
        color::Rgb sum;
        for (std::size_t i = 0; i < light.size(); ++i) sum += factors[i] * light[i];
        return 1 / kPi * color::Rgb{0.8, 0.6, 0.5} * sum;
      };
      PathOptions options;
      options.bounces = 1;
      const PathEstimate estimate = path_estimate(transport, options, stage.spot({0.2, 1, 0.5}, target),
                                                  normalized(Vec3{0.2, 1, 0.5} - target), 6000, 1);
      judge(estimate, gathered(true), ours);
      judge(estimate, gathered(false), control);  // one texel for all, or the lobes in the map's place
    }
    EXPECT_LT(ours.errors, kMostErrors) << textured;
    EXPECT_LT(ours.relative, 0.02) << textured;
    EXPECT_GT(control.errors, 2 * kMostErrors) << textured;
  }
}

// Pixel by pixel under a light, next to a brushed paint, which has its own tilted normals.
TEST(TracedSurface, TexturesAndBrushedPaintsAreThoseOfTheEngineCpu) {
  mesh::Mesh mesh = sphere_mesh(64);
  add_mesh(mesh, sphere_mesh(64), 0.7, {1.9, 0, 0});
  LayeredStage stage(std::move(mesh), {{}, mapped_paint()});
  const brdf::SbrdfTexture texture = brushed();
  stage.surfaces = {{{{&texture, 6}}}, {}};
  stage.scene.lights = {{normalized({0.1, 0.8, 1}), {1, 0.8, 0.6}}};
  stage.scene.anisotropy = {{}, {0.1, 0.4}};
  const Transport& transport = stage.build_with_layer();
  auto renderer = Renderer::create();
  ASSERT_TRUE(renderer.ok());
  Effects effects = effects_of(stage.scene);
  effects.tilt_tolerance = 1e-3;
  ASSERT_TRUE(renderer->load(stage.scene, effects, "cpu").ok());
  Frame frame;
  ASSERT_TRUE(renderer->draw({Camera::orbit(stage.mesh, 20, 20, 1, 30, 1), 96, 96, 1, true}, frame).ok());
  const Gbuffer& g = *frame.gbuffer;
  const Gbuffer surface = visible_surface(transport.rays(), g.rays, 96, 96);
  int seen[2] = {0, 0}, off[2] = {0, 0}, flat = 0;
  const double white = 0.05;  // about what both show; differences are told relative to it
  const color::Rgb middle = [&] {
    color::Rgb sum;
    int count = 0;
    for (int y = 0; y < 96; ++y)
      for (int x = 0; x < 96; ++x)
        if (g.part(x, y) == 0) sum += color::Rgb{frame.picture.pixel(x, y)[0], 0, 0}, ++count;
    return 1.0 / count * sum;
  }();
  for (int y = 0; y < 96; ++y) {
    for (int x = 0; x < 96; ++x) {
      const int part = g.part(x, y);
      if (part < 0 || surface.part(x, y) != part) continue;
      const rays::Spot spot = spot_at(transport.rays(), surface, x, y);
      PathOptions options;
      options.bounces = 0;
      // Where the other ball shades it, or its own edge does, pictures differ as they should.
      if (transport.rays().occluded(spot.start, float3(stage.scene.lights[0].direction))) continue;
      const PointTransport at(transport, options, spot, float3(g.to_viewer(x, y)));
      const float* pixel = frame.picture.pixel(x, y);
      const color::Rgb shown{pixel[0], pixel[1], pixel[2]}, d = at.deterministic() - shown;
      ++seen[part];
      // A rasterizer's point is off by a hundredth of a pixel; floats and half floats by less.
      if (length(d) > 0.02 * length(shown) + 0.01 * white) ++off[part];
      if (part == 0 && std::abs(shown.x - middle.x) > 0.02 * shown.x + 0.01 * white) ++flat;
    }
  }
  for (const int part : {0, 1}) {
    EXPECT_GT(seen[part], 300);
    EXPECT_LT(off[part], seen[part] / 100) << part;
  }
  EXPECT_GT(flat, seen[0] / 2);  // control: the texture's mean
}

// A file of the light of each lobe cannot hold them.
TEST(TracedSurface, AreNoSumOfLobes) {
  LayeredStage stage(panels_mesh(2), {mapped_paint(), {}});
  const brdf::ColorMap map = even_map(0.5F);
  const brdf::SbrdfTexture texture = brushed();
  const LobeColumns columns = *lobe_columns(stage.scene);
  PathScene path;
  path.scene = &stage.scene;
  EXPECT_TRUE(worn_paints(columns, path).ok());
  for (const bool textured : {false, true}) {
    stage.surfaces = {{}, textured ? PartSurface{{{&texture, 1}}} : PartSurface{{}, &map}};
    stage.build_with_layer();
    const auto worn = worn_paints(columns, path);
    ASSERT_FALSE(worn.ok());
    EXPECT_NE(worn.error().message.find(textured ? "wears a texture" : "wears a color map"), std::string::npos);
  }
}

// White by a map and white by a texture in an even light of 1, in a cup, with all bounces.
TEST(TracedSurface, WhiteMapsAndTexturesInEvenLightShowThatLight) {
  const brdf::ColorMap white = even_map(1);
  const auto third = static_cast<float>(1 / kPi);
  const brdf::SbrdfTexture diffuse{1, 1, 1, {third, third, third, 1, 0, 0, 0, 0, -1, -1, 1, 5}};
  for (const bool textured : {false, true}) {
    LayeredStage stage(box_mesh(false), {textured ? paint::LobeFit{} : matt({0.5, 0.7, 0.9})});
    stage.surfaces.assign(5, textured ? PartSurface{{{&diffuse, 1}}} : PartSurface{{}, &white});
    stage.environment = even_environment();
    stage.build_with_layer();
    Worst ours, cut;
    for (const int bounces : {100, 0}) {
      PathOptions options;
      options.bounces = bounces;
      for (const Vec3& target : {Vec3{0, -1, 0}, Vec3{0.99, -0.99, 0.99}, Vec3{-0.999, -0.5, 0.2}})
        judge(stage.seen(options, {0.02, 0.6, 0.01}, 0.999 * target, 200), {1, 1, 1}, bounces > 0 ? ours : cut);
    }
    EXPECT_LT(ours.errors, kMostErrors) << textured;
    EXPECT_LT(ours.relative, 0.05) << textured;
    EXPECT_GT(cut.errors, kMostErrors);  // control: without bounces
  }
}

}  // namespace
}  // namespace goniochrome::render::traced_surface_test
