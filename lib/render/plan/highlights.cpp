#include "render/plan/highlights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"

namespace goniochrome::render {

namespace {

// Angles between normal and light. Gloss is strongest where the light grazes, and the base is darkest there.
constexpr std::array<double, 4> kIncidence_deg = {0, 45, 75, 85};
// Directions of the normal about that of the light.
constexpr int kTurns = 4;
// Two directions of light within this angle count as one.
constexpr double kSame_deg = 2;
// Directions of light for each part. More of them would take longer than the plan may.
constexpr std::size_t kMostLights = 8;
// Rows of a map of which the texels are compared: a lobe is wider than what lies between them.
constexpr int kRows = 64;

struct Bright {
  Vec3 direction;
  double light = 0;
};

Bright brightest_texel(const envmap::CubeMap& map) {
  Bright brightest;
  const int step = std::max(1, map.size / kRows);
  for (int face = 0; face < 6; ++face) {
    for (int row = step / 2; row < map.size; row += step) {
      for (int column = step / 2; column < map.size; column += step) {
        const float* texel = map.at(face, row, column);
        const double light = static_cast<double>(texel[0]) + texel[1] + texel[2];
        if (light <= brightest.light) continue;
        brightest = {envmap::cube_direction(face, column + 0.5, row + 0.5, map.size), light};
      }
    }
  }
  return brightest;
}

// The bright directions of the maps and their spots: these are the same for every point.
std::vector<Bright> bright_directions(const Scene& scene, const Effects& effects) {
  std::vector<Bright> all;
  const auto add = [&](const Bright& light) {
    const bool known = std::ranges::any_of(all, [&](const Bright& other) {
      return dot(other.direction, light.direction) > std::cos(kSame_deg * kDegree);
    });
    if (!known && light.light > 0) all.push_back(light);
  };
  if (scene.env == nullptr) return all;
  for (const envmap::Spot& spot : scene.env->spots) {
    const Light light = light_of(spot);
    add({light.direction, light.white.x + light.white.y + light.white.z});
  }
  for (const Effects::LobeUse& use : effects.lobes)
    if (const auto* lobe = scene.env->lobe(use.exponent); lobe != nullptr) add(brightest_texel(lobe->map));
  if (scene.env->diffuse.map.size > 0) add(brightest_texel(scene.env->diffuse.map));
  return all;
}

void add_points(const VisiblePoint& of, const Vec3& light, std::vector<VisiblePoint>& points) {
  const Vec3 aside = normalized(cross(light, std::abs(light.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{1, 0, 0}));
  const Vec3 upward = cross(aside, light);
  for (const double degrees : kIncidence_deg) {
    const double cosine = std::cos(degrees * kDegree), sine = std::sin(degrees * kDegree);
    for (int turn = 0; turn < (degrees == 0 ? 1 : kTurns); ++turn) {
      const double angle = 2 * kPi * turn / kTurns;
      VisiblePoint point = of;
      point.normal = cosine * light + (sine * std::cos(angle)) * aside + (sine * std::sin(angle)) * upward;
      point.to_viewer = 2 * cosine * point.normal - light;
      points.push_back(std::move(point));
    }
  }
}

}  // namespace

std::vector<VisiblePoint> highlight_points(const Scene& scene, const Effects& effects,
                                           const std::vector<VisiblePoint>& points) {
  const std::vector<Bright> around = bright_directions(scene, effects);
  std::vector<VisiblePoint> highlights;
  std::vector<bool> met(scene.paints.size(), false);
  for (const VisiblePoint& point : points) {
    const auto part = static_cast<std::size_t>(point.part);
    if (met[part]) continue;
    met[part] = true;
    std::vector<Bright> lights = around;
    for (const Light& lamp : scene.lights) {
      const Light here = light_at(lamp, point.position);
      lights.push_back({here.direction, kPi * (here.white.x + here.white.y + here.white.z)});
    }
    std::ranges::stable_sort(lights, std::ranges::greater(), &Bright::light);
    lights.resize(std::min(lights.size(), kMostLights));
    for (const Bright& light : lights) add_points(point, light.direction, highlights);
  }
  return highlights;
}

}  // namespace goniochrome::render
