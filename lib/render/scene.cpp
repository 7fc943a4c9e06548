#include "render/scene.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/disc_light.h"
#include "color/color.h"
#include "math/elementary.h"

namespace goniochrome::render {

namespace {

bool has_weight(const paint::Lobe& lobe) {
  return lobe.directional_diffuse != color::Rgb{} || lobe.gloss != color::Rgb{};
}

}  // namespace

Ground ground_below(const mesh::Mesh& mesh, const std::optional<double>& height, double eye_height) {
  const mesh::Box box = mesh::bounding_box(mesh);
  const Vec3 middle = box.middle();
  Ground ground;
  ground.height = height.value_or(box.low.y);
  const double eye = eye_height > 0 ? eye_height : box.longest_side() / 3;
  ground.probe_eye = {middle.x, ground.height + eye, middle.z};
  return ground;
}

bool needs_rays(const Scene& scene) {
  return scene.ground || std::ranges::any_of(scene.emission, [](const color::Rgb& e) { return e != color::Rgb{}; });
}

bool has_placed_lamps(const Scene& scene) {
  return std::ranges::any_of(scene.lights, [](const Light& light) { return light.place.has_value(); });
}

color::Rgb Light::radiance() const {
  return radius_rad > 0 ? kPi * brdf::disc_radiance(radius_rad) * white : color::Rgb{};
}

bool Light::meets(const Vec3& toward) const {
  return radius_rad > 0 && length(toward - direction) <= 2 * math::sin(0.5 * radius_rad);
}

Light light_at(const Light& light, const Vec3& position) {
  if (!light.place) return light;
  const Vec3 toward = light.place->position - position;
  const double distance = length(toward), radius = light.place->distance * math::sin(light.radius_rad);
  Light seen = light;
  seen.place.reset();
  const double least = std::max(radius, kNearestPoint * light.place->distance), far = std::max(distance, least);
  if (distance > 0) seen.direction = (1 / distance) * toward;
  const double closer = light.place->distance / far;
  seen.white = closer * closer * light.white;
  seen.radius_rad = math::asin(std::min(1.0, radius / far));
  return seen;
}

// Rings and steps of even solid angle; the middle of each in both.
std::vector<DiscDirection> disc_directions(const Light& light) {
  constexpr double kNarrow_rad = 0.01;
  constexpr int kRings = 4, kSteps = 8;
  if (light.radius_rad < kNarrow_rad) return {{light.direction, 1}};
  const Vec3 other = std::abs(light.direction.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 x = normalized(cross(other, light.direction)), y = cross(light.direction, x);
  const double half = math::sin(0.5 * light.radius_rad), sine = math::sin(light.radius_rad);
  const double weight = 4 * half * half / (sine * sine) / (kRings * kSteps);
  std::vector<DiscDirection> all;
  for (int ring = 0; ring < kRings; ++ring) {
    const double versine = 2 * half * half * (ring + 0.5) / kRings, across = std::sqrt(versine * (2 - versine));
    for (int step = 0; step < kSteps; ++step) {
      const double phi = 2 * kPi * (step + 0.5 * (ring % 2)) / kSteps;
      all.push_back(
          {(1 - versine) * light.direction + across * math::cos(phi) * x + across * math::sin(phi) * y, weight});
    }
  }
  return all;
}

Vec3 disc_direction(const Light& light, double u, double v) {
  const double half = math::sin(0.5 * light.radius_rad);
  const double versine = 2 * half * half * u, across = std::sqrt(versine * (2 - versine)), phi = 2 * kPi * v;
  const Vec3 other = std::abs(light.direction.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 x = normalized(cross(other, light.direction)), y = cross(light.direction, x);
  return (1 - versine) * light.direction + across * math::cos(phi) * x + across * math::sin(phi) * y;
}

bool wears_lobe(const paint::LobeFit& paint, double exponent, LobeWeight weight) {
  const auto has = [&](const paint::Lobe& lobe) {
    return lobe.exponent == exponent &&
           (weight == LobeWeight::kGloss ? lobe.gloss : lobe.directional_diffuse) != color::Rgb{};
  };
  return std::ranges::any_of(paint.lobes, has) ||
         std::ranges::any_of(paint.views, [&](const auto& view) { return std::ranges::any_of(view.lobes, has); });
}

std::vector<double> lobe_exponents(const std::vector<paint::LobeFit>& paints) {
  std::vector<double> exponents;
  const auto gather = [&](const std::vector<paint::Lobe>& lobes) {
    for (const paint::Lobe& lobe : lobes)
      if (!lobe.is_mirror() && has_weight(lobe)) exponents.push_back(lobe.exponent);
  };
  for (const paint::LobeFit& paint : paints) {
    gather(paint.lobes);
    for (const paint::ViewLobes& view : paint.views) gather(view.lobes);
  }
  std::sort(exponents.begin(), exponents.end());
  exponents.erase(std::unique(exponents.begin(), exponents.end()), exponents.end());
  return exponents;
}

bool has_mirror(const std::vector<paint::LobeFit>& paints) {
  return std::ranges::any_of(paints, [](const paint::LobeFit& paint) {
    return wears_lobe(paint, paint::kMirrorExponent, LobeWeight::kGloss) ||
           wears_lobe(paint, paint::kMirrorExponent, LobeWeight::kDirectionalDiffuse);
  });
}

const paint::Lobe* find_lobe(const paint::LobeFit& paint, double exponent) {
  const auto at = std::ranges::find(paint.lobes, exponent, &paint::Lobe::exponent);
  return at == paint.lobes.end() ? nullptr : &*at;
}

DiffuseWhite diffuse_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights) {
  DiffuseWhite white;
  const int n = env != nullptr ? env->diffuse.map.size : 0;
  for (int face = 0; face < 6; ++face) {
    for (int row = 0; row < n; ++row) {
      for (int column = 0; column < n; ++column) {
        const double y = color::luminance(vec3(env->diffuse.map.at(face, row, column)));
        if (y <= white.luminance) continue;
        white = {y, envmap::cube_direction(face, column + 0.5, row + 0.5, n)};
      }
    }
  }
  for (const Light& light : lights) white.luminance += color::luminance(light.white);
  return white;
}

double facing_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights,
                    const Vec3& direction) {
  double sum = 0;
  if (env != nullptr && env->diffuse.map.size > 0)
    sum = color::luminance(envmap::bilinear(env->diffuse.map, direction));
  for (const Light& light : lights)
    sum += brdf::disc_irradiance(dot(light.direction, direction), light.radius_rad) * color::luminance(light.white);
  return sum;
}

double metered_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights,
                     const Vec3& to_camera) {
  const double mean = (facing_white(env, lights, {0, 1, 0}) + facing_white(env, lights, to_camera)) / 2;
  return mean > 0 ? mean : diffuse_white(env, lights).luminance;
}

}  // namespace goniochrome::render
