#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "fit/sketch_common.h"
#include "fit/sketch_search.h"

namespace goniochrome {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr std::size_t kMostPixels = 6000;  // looked at by the search; more change the answer by less than 0.05 dE
constexpr std::size_t kFewestPixels = 30;

// The light of each part of the lobe model with weight 1 at a pixel, relative to white: goniochrome-theory(7),
// RENDERING. Columns: K_D, then K_DD and K_G of every lobe, then the mirror.
class Shading {
 public:
  Shading(const AovFile& buffers, const PrefilteredEnvironment& env, const Basis& basis)
      : buffers_(buffers), env_(env), basis_(basis), normal_(*buffers.channel("normal.X")) {}

  std::size_t columns() const { return search_columns(basis_); }

  void shade(std::uint32_t place, Vec3* column) const {
    const int width = buffers_.image.width;
    const float* pixel = &buffers_.image.data[static_cast<std::size_t>(place) * buffers_.image.channels + normal_];
    const Vec3 n{pixel[0], pixel[1], pixel[2]};
    const Vec3 wo = buffers_.to_viewer(static_cast<int>(place % width), static_cast<int>(place / width));
    const double c = dot(n, wo);
    const Vec3 r = 2 * c * n - wo;
    const double scale = 1 / buffers_.white_luminance;
    column[0] = scale * kPi * bilinear(env_.diffuse.map, n);
    for (std::size_t j = 0; j < basis_.exponents.size(); ++j) {
      const Vec3 light = scale * 2 * kPi / (basis_.exponents[j] + 1) * bilinear(env_.lobes[j].map, r);
      column[1 + 2 * j] = std::max(c, 0.0) * light, column[2 + 2 * j] = light;
    }
    column[columns() - 1] =
        basis_.mirror ? scale * fresnel_dielectric(std::max(c, 0.0), kCoatIndex) * bilinear(env_.mirror.map, r)
                      : Vec3{};
    for (const AovLight& light : buffers_.lights) add_light(light, n, r, scale, column);
  }

 private:
  void add_light(const AovLight& light, const Vec3& n, const Vec3& r, double scale, Vec3* column) const {
    const double cos_i = dot(n, light.direction);
    if (cos_i <= 0) return;
    const Vec3 apart = r - light.direction, white = scale * kPi * light.white;
    column[0] += cos_i * white;
    for (std::size_t j = 0; j < basis_.exponents.size(); ++j) {
      const double power = cos_power_from_versine(0.5 * dot(apart, apart), basis_.exponents[j]);
      column[1 + 2 * j] += cos_i * power * white, column[2 + 2 * j] += power * white;
    }
  }

  const AovFile& buffers_;
  const PrefilteredEnvironment& env_;
  const Basis& basis_;
  int normal_;
};

Basis basis_of(const PrefilteredEnvironment& env) {
  Basis basis;
  basis.name = "environment";
  for (const PrefilteredLobe& lobe : env.lobes) basis.exponents.push_back(lobe.exponent);
  basis.mirror = env.mirror.map.size > 0;
  return basis;
}

SearchSamples samples_of(const SketchInput& input, const SketchPixels& pixels, const Shading& shading) {
  const std::size_t step = std::max<std::size_t>(1, pixels.used.size() / kMostPixels);
  std::vector<std::uint32_t> places;
  for (std::size_t i = 0; i < pixels.used.size(); i += step) places.push_back(pixels.used[i]);
  SearchSamples samples;
  samples.columns = shading.columns();
  samples.display = !input.edited->scene_linear;
  samples.light.resize(places.size() * samples.columns);
  samples.importance.assign(places.size(), 1.0);
  parallel_for(places.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) shading.shade(places[i], &samples.light[i * samples.columns]);
  });
  const double scale = 1 / input.buffers->white_luminance;
  for (const std::uint32_t place : places) samples.seen.push_back(scale * edited_light(input, place));
  return samples;
}

Result<void> check_buffers(const AovFile& buffers) {
  if (const auto normal = buffers.channel("normal.X"); !normal.ok()) return normal.error();
  if (!buffers.has_rays)
    return input_error("{}: its header lacks goniochrome:rays: render the buffers again", buffers.path);
  return {};
}

}  // namespace

Result<SketchFit> sketch_environment(const SketchInput& input, const SketchPixels& pixels,
                                     const PrefilteredEnvironment& env, const SketchLimits& limits,
                                     bool with_differences) {
  const AovFile& buffers = *input.buffers;
  GONIO_TRY(check_buffers(buffers));
  const Basis basis = basis_of(env);
  const Shading shading(buffers, env, basis);
  const LobeSearch search(basis, samples_of(input, pixels, shading));
  SketchFit fit;
  std::vector<Rgb> weights(shading.columns());
  const auto judge = [&] {
    std::vector<Vec3> columns(weights.size());
    const double scale = 1 / buffers.white_luminance;
    const auto difference = [&](std::size_t i) {
      shading.shade(pixels.used[i], columns.data());
      const Rgb seen = scale * edited_light(input, pixels.used[i]);
      return delta_e_76(paint_lab(seen), paint_lab(as_displayed(shown_light(columns.data(), weights), input)));
    };
    judge_sketch(pixels.used.size(), with_differences, difference, fit);
  };
  const auto give_up = [&](const std::string& reason) {
    const Rgb matt = search.matt();
    fall_back(matt, reason, fit);
    weights.assign(weights.size(), Rgb{}), weights[0] = (1 / kPi) * matt;
    judge();
    return fit;
  };
  if (pixels.used.size() < kFewestPixels)
    return give_up(fmt::format("{} pixels are too few for a search", pixels.used.size()));
  const FoundPaint found = search.find();
  take_found(found, fit);
  weights = found.weights;
  judge();
  if (fit.median_de76 > limits.median_de76) return give_up(poor_match(fit));
  return fit;
}

}  // namespace goniochrome
