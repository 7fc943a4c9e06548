#include "render/scene.h"

#include <algorithm>

#include "color/color.h"

namespace goniochrome::render {

namespace {

bool has_weight(const paint::Lobe& lobe) {
  return lobe.directional_diffuse != color::Rgb{} || lobe.gloss != color::Rgb{};
}

double luminance(const color::Rgb& rgb) {
  return color::xyz_d65_from_rgb(rgb).Y;
}

}  // namespace

bool needs_rays(const Scene& scene) {
  return scene.ground || std::ranges::any_of(scene.emission, [](const color::Rgb& e) { return e != color::Rgb{}; });
}

std::vector<double> lobe_exponents(const std::vector<paint::LobeFit>& paints) {
  std::vector<double> exponents;
  for (const paint::LobeFit& paint : paints) {
    for (const paint::Lobe& lobe : paint.lobes) {
      if (!lobe.is_mirror() && has_weight(lobe)) exponents.push_back(lobe.exponent);
    }
  }
  std::sort(exponents.begin(), exponents.end());
  exponents.erase(std::unique(exponents.begin(), exponents.end()), exponents.end());
  return exponents;
}

bool has_mirror(const std::vector<paint::LobeFit>& paints) {
  return std::any_of(paints.begin(), paints.end(), [](const paint::LobeFit& paint) {
    const paint::Lobe* mirror = find_lobe(paint, paint::kMirrorExponent);
    return mirror != nullptr && has_weight(*mirror);
  });
}

const paint::Lobe* find_lobe(const paint::LobeFit& paint, double exponent) {
  const auto at = std::find_if(paint.lobes.begin(), paint.lobes.end(),
                               [&](const paint::Lobe& lobe) { return lobe.exponent == exponent; });
  return at == paint.lobes.end() ? nullptr : &*at;
}

DiffuseWhite diffuse_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights) {
  DiffuseWhite white;
  const int n = env != nullptr ? env->diffuse.map.size : 0;
  for (int face = 0; face < 6; ++face) {
    for (int row = 0; row < n; ++row) {
      for (int column = 0; column < n; ++column) {
        const float* texel = env->diffuse.map.at(face, row, column);
        const double y = luminance({texel[0], texel[1], texel[2]});
        if (y <= white.luminance) continue;
        white = {y, envmap::cube_direction(face, column + 0.5, row + 0.5, n)};
      }
    }
  }
  for (const Light& light : lights) white.luminance += luminance(light.white);
  return white;
}

double facing_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights,
                    const Vec3& direction) {
  double sum = 0;
  if (env != nullptr && env->diffuse.map.size > 0) sum = luminance(envmap::bilinear(env->diffuse.map, direction));
  for (const Light& light : lights) sum += std::max(0.0, dot(light.direction, direction)) * luminance(light.white);
  return sum;
}

double metered_white(const envmap::PrefilteredEnvironment* env, const std::vector<Light>& lights,
                     const Vec3& to_camera) {
  const double mean = (facing_white(env, lights, {0, 1, 0}) + facing_white(env, lights, to_camera)) / 2;
  return mean > 0 ? mean : diffuse_white(env, lights).luminance;
}

}  // namespace goniochrome::render
