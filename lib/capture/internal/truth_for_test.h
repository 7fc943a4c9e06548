// For tests: a surface of known lobes photographed, by the textbook formula written anew and in double precision.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/random_for_test.h"
#include "base/vec3.h"

namespace goniochrome::capture {

struct TrueLobe {
  std::array<double, 3> strength;
  double cx, cy, cz, n;
};
struct TrueTexel {
  std::array<double, 3> diffuse;
  double turn = 0;  // of the frame, rad
  std::vector<TrueLobe> lobes;
};

// [McAllister2002] 1 and 2 by std::pow, with nothing shared with the code under test.
inline std::array<double, 3> true_brdf(const TrueTexel& texel, const Vec3& light, const Vec3& camera) {
  const double c = std::cos(texel.turn), s = std::sin(texel.turn);
  const double lx = c * light.x + s * light.y, ly = c * light.y - s * light.x;
  const double vx = c * camera.x + s * camera.y, vy = c * camera.y - s * camera.x;
  std::array<double, 3> f = texel.diffuse;
  for (const TrueLobe& lobe : texel.lobes) {
    const double base = lobe.cx * lx * vx + lobe.cy * ly * vy + lobe.cz * light.z * camera.z;
    if (base <= 0) continue;
    for (std::size_t k = 0; k < 3; ++k) f[k] += lobe.strength[k] * std::pow(base, lobe.n);
  }
  return f;
}

inline double energy_scale(double n) {
  return (n + 1) / (2 * 3.14159265358979323846);
}

// A varnish of one lobe on a color.
inline TrueTexel varnished(double u) {
  const double n = 12 + 100 * u, a = 0.05 * energy_scale(n);
  return {{0.09 - 0.05 * u, 0.05, 0.02 + 0.02 * u}, 0, {{{a, a, a}, -1 - 0.5 / n, -1 - 0.5 / n, 1, n}}};
}

// Metal that is brushed along a direction of its own: two lobes, one of them long across.
inline TrueTexel brushed(double u) {
  const double a = 0.3 * energy_scale(12), b = 0.25 * energy_scale(60);
  return {{0.01, 0.01, 0.012},
          3 * u,
          {{{0.8 * a, 0.75 * a, 0.6 * a}, -1, -0.4, 1, 12}, {{0.8 * b, 0.75 * b, 0.6 * b}, -1, -0.9, 1, 60}}};
}

struct Pose {
  Vec3 light, camera;  // unit
};

// Poses of a gantry: camera and light anywhere up to 65 degrees from the normal, and in half of the photographs the
// light within some 20 degrees of the mirror direction.
inline std::vector<Pose> gantry(int count, std::uint64_t seed) {
  TestNumbers random(seed);
  const auto anywhere = [&] {
    const double z = 1 - random() * (1 - std::cos(1.13)), phi = 6.283185307179586 * random(), r = std::sqrt(1 - z * z);
    return Vec3{r * std::cos(phi), r * std::sin(phi), z};
  };
  std::vector<Pose> poses;
  for (int i = 0; i < count; ++i) {
    Pose pose{anywhere(), anywhere()};
    while (i % 2 == 1) {
      const Vec3 mirror = {-pose.camera.x, -pose.camera.y, pose.camera.z};
      const Vec3 off = {0.7 * (random() - 0.5), 0.7 * (random() - 0.5), 0.7 * (random() - 0.5)};
      pose.light = normalized(mirror + off);
      if (pose.light.z > 0.3) break;
    }
    poses.push_back(pose);
  }
  return poses;
}

// A deviate of a normal distribution.
inline double normal_deviate(TestNumbers& random) {
  double sum = 0;
  for (int i = 0; i < 12; ++i) sum += random();
  return sum - 6;
}

}  // namespace goniochrome::capture
