#include "render/sbrdf.h"

#include <cmath>
#include <numbers>

namespace goniochrome {

namespace {

// The axes of a texel in the world.
struct Axes {
  Vec3 x, y, z;
  Vec3 local(const Vec3& d) const { return {dot(d, x), dot(d, y), dot(d, z)}; }
  Vec3 world(const Vec3& d) const { return d.x * x + d.y * y + d.z * z; }
};

Axes axes_of(const SbrdfTexel& texel, const Vec3& normal, const Vec3& tangent) {
  Vec3 t = tangent - dot(tangent, normal) * normal;
  const double size = length(t);
  // A tangent along the normal says nothing: any direction in the surface will do.
  t = size > 1e-9 ? (1 / size) * t
                  : normalized(cross(normal, std::abs(normal.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 x = texel.x_tangent * t + texel.x_bitangent * cross(normal, t);
  return {x, cross(normal, x), normal};
}

}  // namespace

Result<MipCube> mip_cube(const PrefilteredEnvironment& env) {
  if (env.lobes.empty()) return input_error("{}: holds no lobes", env.source);
  MipCube mip;
  mip.finest_exponent = env.lobes.back().exponent;
  int size = env.lobes.back().map.size;
  for (double exponent = mip.finest_exponent; exponent > 0.9; exponent /= 4) {
    const PrefilteredLobe* lobe = std::abs(exponent - 1) < 1e-6 ? &env.diffuse : env.lobe(exponent);
    if (lobe == nullptr)
      return input_error(
          "{}: lacks the lobe of exponent {:g}: prefilter with quarters of the sharpest, such as --exponents "
          "4,16,64,256",
          env.source, exponent);
    CubeMap level(size);
    for (int face = 0; face < 6; ++face)
      for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
          const Vec3 value = bilinear(lobe->map, cube_direction(face, column + 0.5, row + 0.5, size));
          for (int c = 0; c < 3; ++c) level.at(face, row, column)[c] = static_cast<float>(value[c]);
        }
    mip.levels.push_back(std::move(level));
    size = std::max(size / 2, 1);
  }
  return mip;
}

SbrdfShader::SbrdfShader(const PrefilteredEnvironment* env, const MipCube* mip, std::vector<Light> lights,
                         const ReflectionOperator& reflection)
    : env_(env), mip_(mip), lights_(std::move(lights)), reflection_(reflection) {
  if (env_ == nullptr) return;
  bool diffuse = false;
  const auto add = [&](double exponent, const CubeMap& map) { exponents_.push_back(exponent), maps_.push_back(&map); };
  for (const PrefilteredLobe& lobe : env_->lobes) {
    if (!diffuse && lobe.exponent > 1) add(1, env_->diffuse.map), diffuse = true;
    add(lobe.exponent, lobe.map);
  }
  if (!diffuse) add(1, env_->diffuse.map);
}

Vec3 SbrdfShader::filtered(double exponent, const Vec3& direction) const {
  const auto blended = [&](const CubeMap& low, const CubeMap* high, double share) {
    const Vec3 value = bilinear(low, direction);
    return share == 0 ? value : (1 - share) * value + share * bilinear(*high, direction);
  };
  if (mip_ != nullptr) {
    const double level = mip_level(exponent, mip_->finest_exponent, static_cast<int>(mip_->levels.size()));
    const auto fine = static_cast<std::size_t>(level);
    const double share = level - static_cast<double>(fine);
    return blended(mip_->levels[fine], share > 0 ? &mip_->levels[fine + 1] : nullptr, share);
  }
  const ExponentBlend blend = exponent_blend(exponent, exponents_);
  const auto low = static_cast<std::size_t>(blend.lower);
  return blended(*maps_[low], blend.upper_weight > 0 ? maps_[low + 1] : nullptr, blend.upper_weight);
}

Rgb SbrdfShader::shade(const SbrdfTexel& texel, const Vec3& normal, const Vec3& tangent, const Vec3& to_viewer) const {
  const Axes axes = axes_of(texel, normal, tangent);
  const Vec3 viewer = axes.local(to_viewer);
  if (viewer.z <= 0) return {};
  Rgb sum;
  for (const Light& light : lights_) {
    const Vec3 to_light = axes.local(light.direction);
    if (to_light.z > 0)
      sum +=
          (std::numbers::pi * to_light.z) * reflected(reflection_, light.white, brdf(texel.surface, to_light, viewer));
  }
  if (env_ == nullptr) return sum;
  sum += std::numbers::pi * reflected(reflection_, bilinear(env_->diffuse.map, normal), texel.surface.diffuse);
  for (const LafortuneLobe& lobe : texel.surface.lobes) {
    const LobeFetch fetch = environment_fetch(lobe, viewer);
    if (fetch.weight == Rgb{}) continue;
    sum += reflected(reflection_, filtered(lobe.exponent, axes.world(fetch.direction)), fetch.weight);
  }
  return sum;
}

Rgb SbrdfShader::shade(const SbrdfTexture& texture, double u, double v, const Vec3& normal, const Vec3& tangent,
                       const Vec3& to_viewer) const {
  Rgb sum;
  for (const TextureTap& tap : texture_taps(texture.width, texture.height, u, v)) {
    if (tap.weight > 0)
      sum += tap.weight * shade(sbrdf_texel(texture, tap.column, tap.row), normal, tangent, to_viewer);
  }
  return sum;
}

}  // namespace goniochrome
