#include "render/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/clock.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "color/color.h"

namespace goniochrome {

namespace {

// cos^E below exp(-kTail) is left out: 4e-18 of the peak.
constexpr double kTail = 40;
// A texel is cut into pieces of at most this many standard deviations (1/sqrt E) of the sharpest lobe that reaches it.
// The midpoint rule then errs by (1/4)^2/24 of the value on a patch, and far less in the sum over smooth radiance.
constexpr double kPiece = 0.25;

// A run of texels is set up once for so many points: directions cost more than lobes.
constexpr std::size_t kPointsAtOnce = 16;

struct Patch {
  Vec3 direction;  // unit
  double solid_angle_sr;
};

// The reflected radiance of one point, gathered patch by patch.
class Gatherer {
 public:
  // Texels are at most `texel_rad` across.
  Gatherer(const SurfacePoint& point, double texel_rad) : point_(point) {
    reflected_ = 2 * dot(point.normal, point.to_viewer) * point.normal - point.to_viewer;
    for (const Lobe& lobe : point.paint->lobes) {
      if (std::isfinite(lobe.exponent)) lobes_.push_back(&lobe);
    }
    std::sort(lobes_.begin(), lobes_.end(), [](const Lobe* a, const Lobe* b) { return a->exponent < b->exponent; });
    for (auto lobe = lobes_.rbegin(); lobe != lobes_.rend(); ++lobe) {
      const double pieces = std::ceil(texel_rad * std::sqrt((*lobe)->exponent) / kPiece);
      if (pieces <= 1) break;
      // cos^E = exp(-kTail) at this angle; a texel whose center is that far and its own extent has nothing to give.
      const double reach_rad = std::acos(std::exp(-kTail / (*lobe)->exponent)) + texel_rad;
      const double chord = 2 * std::sin(0.5 * std::min(reach_rad, std::numbers::pi));
      cuts_.push_back({chord * chord, static_cast<int>(pieces)});
    }
  }

  const Vec3& reflected() const { return reflected_; }

  // Into how many pieces, across and down, a texel about this direction is to be cut.
  int pieces(const Vec3& direction) const {
    if (cuts_.empty()) return 1;
    const Vec3 apart = reflected_ - direction;
    const double chord2 = dot(apart, apart);
    for (const Cut& cut : cuts_) {
      if (chord2 < cut.chord2) return cut.pieces;
    }
    return 1;
  }

  // Adds f L cos_i dw, with cos_i multiplied into f so that the gloss term needs no division.
  void add(const Patch& patch, const Rgb& radiance) {
    const double cos_i = dot(point_.normal, patch.direction);
    if (cos_i <= 0) return;
    const Vec3 apart = reflected_ - patch.direction;
    const double versine = 0.5 * dot(apart, apart);
    Rgb f = cos_i * point_.paint->diffuse;
    if (versine < 1) {
      const double log_cos = std::log1p(-versine);
      for (const Lobe* lobe : lobes_) {
        if (lobe->exponent * -log_cos > kTail) break;
        f += std::exp(lobe->exponent * log_cos) * (cos_i * lobe->directional_diffuse + lobe->gloss);
      }
    }
    sum_ += patch.solid_angle_sr * (f * radiance);
  }

  const Rgb& sum() const { return sum_; }

 private:
  struct Cut {
    double chord2;  // within this squared distance of the mirror direction
    int pieces;
  };
  const SurfacePoint& point_;
  Vec3 reflected_;
  std::vector<const Lobe*> lobes_;  // finite exponents, ascending
  std::vector<Cut> cuts_;           // of the lobes narrower than a texel, sharpest first
  Rgb sum_;
};

// The piece (i, j) of a texel cut into k x k.
Patch piece(const Environment& env, int column, int row, int i, int j, int k) {
  const double step = 1.0 / k, left = column + i * step, top = row + j * step;
  return {env.direction_at(left + 0.5 * step, top + 0.5 * step), env.solid_angle(left, top, left + step, top + step)};
}

void gather_environment(const Environment& env, std::vector<Gatherer>& points) {
  for (int row = 0; row < env.height(); ++row) {
    for (int column = 0; column < env.width(); ++column) {
      const float* texel = env.radiance(column, row);
      const Rgb radiance{texel[0], texel[1], texel[2]};
      if (radiance == Rgb{}) continue;
      const Patch whole{env.direction(column, row), env.solid_angle(column, row)};
      for (Gatherer& point : points) {
        const int k = point.pieces(whole.direction);
        if (k == 1) {
          point.add(whole, radiance);
          continue;
        }
        for (int j = 0; j < k; ++j) {
          for (int i = 0; i < k; ++i) point.add(piece(env, column, row, i, j, k), radiance);
        }
      }
    }
  }
}

Rgb mirrored(const SurfacePoint& point, const Vec3& reflected, const Environment& env) {
  const Lobe* mirror = find_lobe(*point.paint, kMirrorExponent);
  if (mirror == nullptr) return {};
  const float* texel = env.lookup(reflected);
  const double fresnel = fresnel_dielectric(dot(point.normal, point.to_viewer), kCoatIndex);
  return fresnel * (mirror->gloss * Rgb{texel[0], texel[1], texel[2]});
}

// `count` of the n numbers 0..n-1, evenly drawn, in ascending order (Fisher-Yates on splitmix64).
std::vector<std::size_t> drawn(std::size_t n, std::size_t count, std::uint64_t seed) {
  std::vector<std::size_t> all(n);
  for (std::size_t i = 0; i < n; ++i) all[i] = i;
  for (std::size_t i = 0; i < std::min(count, n); ++i) {
    std::uint64_t z = (seed += 0x9E3779B97F4A7C15U);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9U;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBU;
    z ^= z >> 31;
    std::swap(all[i], all[i + z % (n - i)]);
  }
  all.resize(std::min(count, n));
  std::sort(all.begin(), all.end());
  return all;
}

Lab seen_lab(const Rgb& radiance, double white_luminance) {
  const Xyz white = xyz_d65_from_rgb({1, 1, 1});
  return lab_from_xyz(xyz_d65_from_rgb((1 / white_luminance) * radiance), white);
}

}  // namespace

std::vector<Rgb> reference_radiance(const std::vector<SurfacePoint>& points, const Environment* env,
                                    const std::vector<Light>& lights) {
  std::vector<Rgb> radiance(points.size());
  const double texel_rad = env != nullptr ? env->largest_texel_rad() : 0;
  parallel_for(points.size(), kPointsAtOnce, [&](std::size_t begin, std::size_t end) {
    std::vector<Gatherer> gatherers;
    for (std::size_t i = begin; i < end; ++i) gatherers.emplace_back(points[i], texel_rad);
    if (env != nullptr) gather_environment(*env, gatherers);
    for (std::size_t i = begin; i < end; ++i) {
      Gatherer& gatherer = gatherers[i - begin];
      for (const Light& light : lights) gatherer.add({light.direction, std::numbers::pi}, light.white);
      radiance[i] = gatherer.sum();
      if (env != nullptr) radiance[i] += mirrored(points[i], gatherer.reflected(), *env);
    }
  });
  return radiance;
}

PictureError picture_error(const Frame& frame, const Scene& scene, const Environment* env, double white_luminance,
                           int count, std::uint64_t seed) {
  const Stopwatch clock;
  const double white = white_luminance > 0 ? white_luminance : 1;  // in the dark all is black
  const Gbuffer& g = *frame.gbuffer;
  std::vector<std::array<int, 2>> visible;
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      if (g.part(x, y) >= 0) visible.push_back({x, y});
    }
  }
  std::vector<std::array<int, 2>> chosen;
  for (const std::size_t i : drawn(visible.size(), static_cast<std::size_t>(count), seed)) chosen.push_back(visible[i]);
  std::vector<SurfacePoint> points;
  for (const auto& [x, y] : chosen) {
    points.push_back({g.normal(x, y), g.to_viewer(x, y), &scene.paints[static_cast<std::size_t>(g.part(x, y))]});
  }
  const std::vector<Rgb> truth = reference_radiance(points, env, scene.lights);

  PictureError error;
  error.checked_pixels = static_cast<int>(chosen.size());
  std::vector<double> de00;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const float* pixel = frame.centers.pixel(chosen[i][0], chosen[i][1]);
    de00.push_back(delta_e_2000(seen_lab({pixel[0], pixel[1], pixel[2]}, white), seen_lab(truth[i], white)));
    error.de00_mean += de00.back() / static_cast<double>(chosen.size());
    if (de00.back() <= error.de00_max) continue;
    error.de00_max = de00.back();
    error.worst_x = chosen[i][0], error.worst_y = chosen[i][1];
  }
  std::sort(de00.begin(), de00.end());
  if (!de00.empty()) error.de00_p95 = de00[(de00.size() * 95 + 99) / 100 - 1];
  error.time_s = clock.elapsed_s();
  return error;
}

}  // namespace goniochrome
