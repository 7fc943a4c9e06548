#include "render/reference.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/clock.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "color/color.h"
#include "render/seen.h"

namespace goniochrome {

namespace {

// cos^E below exp(-kTail) is left out: 4e-18 of the peak.
constexpr double kTail = 40;
// A texel is cut into pieces of at most this many standard deviations (1/sqrt E) of the sharpest lobe that reaches it.
// The midpoint rule then errs by (1/4)^2/24 of the value on a patch, and far less in the sum over smooth radiance.
constexpr double kPiece = 0.25;

// Tilts of the truth: of an anisotropic lobe's peak.
constexpr double kTiltTolerance = 1e-3;

// A run of texels is set up once for so many points: directions cost more than lobes.
constexpr std::size_t kPointsTogether = 16;

struct Patch {
  Vec3 direction;  // unit
  double solid_angle_sr;
};

const ExactModel& model_of(const SurfacePoint& point) {
  static const ExactModel bare;
  return point.model != nullptr ? *point.model : bare;
}

double view_deg(const SurfacePoint& point) {
  return std::atan2(length(cross(point.normal, point.to_viewer)), dot(point.normal, point.to_viewer)) * 180 /
         std::numbers::pi;
}

// The reflected radiance of one point, gathered patch by patch.
class Gatherer {
 public:
  // Texels are at most `texel_rad` across.
  Gatherer(const SurfacePoint& point, double texel_rad)
      : point_(point), model_(model_of(point)), paint_(at_view(*point.paint, view_deg(point))) {
    cos_o_ = dot(point.normal, point.to_viewer);
    set_mirror_directions();
    for (const Lobe& lobe : paint_.lobes) {
      if (std::isfinite(lobe.exponent)) lobes_.push_back(lobe);
    }
    std::sort(lobes_.begin(), lobes_.end(), [](const Lobe& a, const Lobe& b) { return a.exponent < b.exponent; });
    if (model_.fresnel) {
      const double share = 1 / fresnel_dielectric(std::cos(model_.gloss_deg * std::numbers::pi / 180), kCoatIndex);
      for (Lobe& lobe : lobes_) lobe.gloss = share * lobe.gloss;
    }
    for (auto lobe = lobes_.rbegin(); lobe != lobes_.rend(); ++lobe) {
      const double pieces = std::ceil(texel_rad * std::sqrt(lobe->exponent) / kPiece);
      if (pieces <= 1) break;
      // cos^E = exp(-kTail) at this angle; a texel whose center is that far and its own extent has nothing to give.
      const double reach_rad = std::acos(std::exp(-kTail / lobe->exponent)) + texel_rad;
      const double chord = 2 * std::sin(0.5 * std::min(reach_rad, std::numbers::pi));
      cuts_.push_back({chord * chord, static_cast<int>(pieces)});
    }
  }

  const Vec3& reflected() const { return reflected_; }

  // Into how many pieces, across and down, a texel about this direction is to be cut.
  int pieces(const Vec3& direction) const {
    if (cuts_.empty()) return 1;
    double chord2 = 4;
    for (const Mirrored& m : mirrored_)
      chord2 = std::min(chord2, dot(m.direction - direction, m.direction - direction));
    for (const Cut& cut : cuts_) {
      if (chord2 < cut.chord2) return cut.pieces;
    }
    return 1;
  }

  // Adds f L cos_i dw, with cos_i multiplied into f so that the gloss term needs no division.
  void add(const Patch& patch, const Rgb& radiance) { add(patch, radiance, model_.horizon); }
  void add_light(const Light& light) { add({light.direction, std::numbers::pi}, light.white, true); }

  // With `horizon`, the direction's own cosine, and nothing from below.
  void add(const Patch& patch, const Rgb& radiance, bool horizon) {
    const double above = dot(point_.normal, patch.direction), cos_i = horizon ? above : cos_o_;
    Rgb f = above > 0 ? above * paint_.diffuse : Rgb{};
    if (above > 0 || !horizon) f += lobes_toward(patch.direction, cos_i);
    const Rgb product =
        model_.reflection != nullptr ? goniochrome::reflected(*model_.reflection, f, radiance) : f * radiance;
    sum_ += patch.solid_angle_sr * product;
  }

  // The mirror lobe, which sees this radiance.
  void add_mirror(const Rgb& radiance) {
    const Lobe* mirror = find_lobe(paint_, kMirrorExponent);
    if (mirror == nullptr) return;
    const bool fresnel = point_.model == nullptr || model_.fresnel;
    const Rgb k = fresnel_dielectric(fresnel ? cos_o_ : std::numbers::sqrt2 / 2, kCoatIndex) * mirror->gloss;
    sum_ += model_.reflection != nullptr ? goniochrome::reflected(*model_.reflection, k, radiance) : k * radiance;
  }

  const Rgb& sum() const { return sum_; }

 private:
  struct Cut {
    double chord2;  // within this squared distance of the mirror direction
    int pieces;
  };
  struct Mirrored {
    Vec3 direction;
    double share;
  };

  // About the normal, and about each tilted normal: the tangent runs level around +Y, on a level surface along +X.
  void set_mirror_directions() {
    const Vec3& n = point_.normal;
    reflected_ = 2 * cos_o_ * n - point_.to_viewer;
    if (model_.tilts.empty()) {
      mirrored_ = {{reflected_, 1}};
      return;
    }
    const double level2 = n.x * n.x + n.z * n.z;
    const Vec3 x = level2 > 1e-12 ? normalized({n.z, 0, -n.x}) : Vec3{1, 0, 0}, y = cross(n, x);
    for (const Tilt& tilt : model_.tilts) {
      const Vec3 m = tilt.normal.x * x + tilt.normal.y * y + tilt.normal.z * n;
      const double cos_m = dot(m, point_.to_viewer);
      const Vec3 r = 2 * cos_m * m - point_.to_viewer;
      if (cos_m > 0 && dot(r, n) > 0) mirrored_.push_back({r, tilt.weight});
    }
  }

  Rgb lobes_toward(const Vec3& direction, double cos_i) const {
    Rgb f;
    const double cos_half = 0.5 * length(direction + point_.to_viewer);
    const double fresnel = model_.fresnel ? fresnel_dielectric(std::min(1.0, cos_half), kCoatIndex) : 1;
    for (const Mirrored& m : mirrored_) {
      const Vec3 apart = m.direction - direction;
      const double versine = 0.5 * dot(apart, apart);
      if (versine >= 1) continue;
      const double log_cos = std::log1p(-versine);
      for (const Lobe& lobe : lobes_) {
        if (lobe.exponent * -log_cos > kTail) break;
        const double power = m.share * std::exp(lobe.exponent * log_cos);
        f += power * (cos_i * lobe.directional_diffuse + fresnel * lobe.gloss);
      }
    }
    return f;
  }

  const SurfacePoint& point_;
  const ExactModel& model_;
  LobeFit paint_;
  double cos_o_ = 1;
  Vec3 reflected_;
  std::vector<Mirrored> mirrored_;
  std::vector<Lobe> lobes_;  // finite exponents, ascending
  std::vector<Cut> cuts_;    // of the lobes narrower than a texel, sharpest first
  Rgb sum_;
};

// The reflected radiance of one point of a texture: the exact lobes of the texels around it.
class TextureGatherer {
 public:
  TextureGatherer(const TexturedPoint& point, const ReflectionOperator* reflection, double texel_rad)
      : point_(point), reflection_(reflection) {
    const Vec3& n = point.normal;
    for (const SurfaceLayer::Piece& piece : point.place.pieces) {
      const SurfaceFrame frame = surface_frame(piece.texel, n, point.place.tangent);
      const Vec3 viewer = frame.local(point.to_viewer);
      diffuse_ += piece.share * piece.texel.surface.diffuse;
      for (const LafortuneLobe& lobe : piece.texel.surface.lobes)
        add_lobe(frame.world(lobe.axes * viewer), lobe.exponent, piece.share * lobe.albedo, texel_rad);
    }
  }

  int pieces(const Vec3& direction) const {
    int most = 1;
    for (const TexelLobe& lobe : lobes_) {
      if (lobe.pieces > most && dot(lobe.middle, direction) > lobe.cut_cosine) most = lobe.pieces;
    }
    return most;
  }

  void add(const Patch& patch, const Rgb& radiance) {
    const double cos_i = dot(point_.normal, patch.direction);
    if (cos_i <= 0) return;
    Rgb f = diffuse_;
    for (const TexelLobe& lobe : lobes_) {
      if (dot(lobe.middle, patch.direction) < lobe.least_cosine) continue;
      const Vec3 apart = lobe.middle - patch.direction;
      const double log_cos = std::log1p(-0.5 * dot(apart, apart));
      f += std::exp(std::min(lobe.log_peak + lobe.exponent * log_cos, kLargestLog)) * lobe.color;
    }
    const Rgb product = reflection_ != nullptr ? goniochrome::reflected(*reflection_, f, radiance) : f * radiance;
    sum_ += patch.solid_angle_sr * cos_i * product;
  }
  void add_light(const Light& light) { add({light.direction, std::numbers::pi}, light.white); }

  const Rgb& sum() const { return sum_; }

 private:
  static constexpr double kLargestLog = 700;
  struct TexelLobe {
    Vec3 axis;    // p = C wo, in the world
    Vec3 middle;  // of length 1
    double exponent = 1, log_peak = 0;
    Rgb color;
    double least_cosine = 0;  // below it, nothing that counts
    int pieces = 1;           // that a texel is cut into, within
    double cut_cosine = 2;
  };

  // Neighboring texels often hold the same lobe in another color.
  void add_lobe(const Vec3& axis, double exponent, const Rgb& albedo, double texel_rad) {
    const double size = length(axis);
    if (albedo == Rgb{} || !(size > 0)) return;
    for (TexelLobe& lobe : lobes_) {
      if (lobe.axis == axis && lobe.exponent == exponent) {
        lobe.color += albedo;
        return;
      }
    }
    TexelLobe lobe{axis, (1 / size) * axis, exponent, exponent * std::log(size), albedo};
    if (exponent > 0) lobe.least_cosine = std::exp(-kTail / exponent);
    const double pieces = std::ceil(texel_rad * std::sqrt(exponent) / kPiece);
    if (pieces > 1) {
      lobe.pieces = static_cast<int>(pieces);
      lobe.cut_cosine = std::cos(std::min(std::acos(lobe.least_cosine) + texel_rad, std::numbers::pi));
    }
    lobes_.push_back(lobe);
  }

  const TexturedPoint& point_;
  const ReflectionOperator* reflection_;
  Rgb diffuse_;
  std::vector<TexelLobe> lobes_;
  Rgb sum_;
};

// The piece (i, j) of a texel cut into k x k.
Patch piece(const Environment& env, int column, int row, int i, int j, int k) {
  const double step = 1.0 / k, left = column + i * step, top = row + j * step;
  return {env.direction_at(left + 0.5 * step, top + 0.5 * step), env.solid_angle(left, top, left + step, top + step)};
}

template <class AnyGatherer>
void gather_environment(const Environment& env, std::vector<AnyGatherer>& points) {
  for (int row = 0; row < env.height(); ++row) {
    for (int column = 0; column < env.width(); ++column) {
      const float* texel = env.radiance(column, row);
      const Rgb radiance{texel[0], texel[1], texel[2]};
      if (radiance == Rgb{}) continue;
      const Patch whole{env.direction(column, row), env.solid_angle(column, row)};
      for (AnyGatherer& point : points) {
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

}  // namespace

std::vector<Rgb> reference_radiance(const std::vector<SurfacePoint>& points, const Environment* env,
                                    const std::vector<Light>& lights) {
  std::vector<Rgb> radiance(points.size());
  const double texel_rad = env != nullptr ? env->largest_texel_rad() : 0;
  parallel_for(points.size(), kPointsTogether, [&](std::size_t begin, std::size_t end) {
    std::vector<Gatherer> gatherers;
    for (std::size_t i = begin; i < end; ++i) gatherers.emplace_back(points[i], texel_rad);
    if (env != nullptr) gather_environment(*env, gatherers);
    for (std::size_t i = begin; i < end; ++i) {
      Gatherer& gatherer = gatherers[i - begin];
      for (const Light& light : lights) gatherer.add_light(light);
      if (env != nullptr) {
        const float* texel = env->lookup(gatherer.reflected());
        gatherer.add_mirror({texel[0], texel[1], texel[2]});
      }
      radiance[i] = gatherer.sum();
    }
  });
  return radiance;
}

std::vector<Rgb> textured_radiance(const std::vector<TexturedPoint>& points, const Environment* env,
                                   const std::vector<Light>& lights, const ReflectionOperator* reflection) {
  std::vector<Rgb> radiance(points.size());
  const double texel_rad = env != nullptr ? env->largest_texel_rad() : 0;
  parallel_for(points.size(), kPointsTogether, [&](std::size_t begin, std::size_t end) {
    std::vector<TextureGatherer> gatherers;
    for (std::size_t i = begin; i < end; ++i) gatherers.emplace_back(points[i], reflection, texel_rad);
    if (env != nullptr) gather_environment(*env, gatherers);
    for (std::size_t i = begin; i < end; ++i) {
      for (const Light& light : lights) gatherers[i - begin].add_light(light);
      radiance[i] = gatherers[i - begin].sum();
    }
  });
  return radiance;
}

namespace {

bool is_textured(const Scene& scene, int part) {
  return scene.layer != nullptr && scene.layer->surface(part).texture != nullptr;
}

// The colors of the textured ones of these points take the place of what is there.
void put_textured(const Scene& scene, const std::vector<VisiblePoint>& points, const Effects& effects,
                  const Environment* env, std::vector<Rgb>& colors) {
  std::vector<TexturedPoint> textured;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_textured(scene, points[i].part)) continue;
    textured.push_back({points[i].normal, points[i].to_viewer, scene.layer->place(points[i], i, effects)});
    numbers.push_back(i);
  }
  const std::vector<Rgb> shown = textured_radiance(textured, effects.environment ? env : nullptr,
                                                   effects.lights > 0 ? scene.lights : std::vector<Light>(),
                                                   effects.reflection ? &scene.reflection : nullptr);
  for (std::size_t i = 0; i < shown.size(); ++i) colors[numbers[i]] = shown[i];
}

}  // namespace

std::vector<Rgb> exact_radiance(const std::vector<VisiblePoint>& points, const Scene& scene, const Effects& effects,
                                const Environment* env) {
  std::vector<LobeFit> paints;
  std::vector<ExactModel> models(scene.paints.size());
  Effects dense = effects;
  dense.tilt_tolerance = kTiltTolerance;
  const auto tilts = effects.anisotropy ? tilts_of(scene, dense) : std::vector<std::vector<Tilt>>(scene.paints.size());
  for (std::size_t part = 0; part < scene.paints.size(); ++part) {
    paints.push_back(with_effects(scene.paints[part], effects));
    ExactModel& model = models[part];
    if (effects.maps) paints.back().views.clear();  // the maps are told apart from the weights for all views
    model.fresnel = effects.fresnel;
    if (part < scene.gloss_deg.size()) model.gloss_deg = scene.gloss_deg[part];
    model.horizon = effects.horizon || effects.lobes.empty() || !effects.environment;
    if (tilts[part].size() > 1) model.tilts = tilts[part];
    if (effects.reflection) model.reflection = &scene.reflection;
  }
  std::vector<SurfacePoint> surface;
  std::vector<std::size_t> numbers;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto part = static_cast<std::size_t>(points[i].part);
    if (is_textured(scene, points[i].part)) continue;
    surface.push_back({points[i].normal, points[i].to_viewer, &paints[part], &models[part]});
    numbers.push_back(i);
  }
  const std::vector<Rgb> plain = reference_radiance(surface, effects.environment ? env : nullptr,
                                                    effects.lights > 0 ? scene.lights : std::vector<Light>());
  std::vector<Rgb> colors(points.size());
  for (std::size_t i = 0; i < plain.size(); ++i) colors[numbers[i]] = plain[i];
  if (effects.maps) scene.layer->add_mapped(points, colors);
  put_textured(scene, points, effects, env, colors);
  return colors;
}

PixelSample sampled_pixels(const Gbuffer& g, const Scene& scene, int count, std::uint64_t seed) {
  std::vector<std::array<int, 2>> visible;
  for (int y = 0; y < g.height; ++y) {
    for (int x = 0; x < g.width; ++x) {
      if (g.part(x, y) >= 0) visible.push_back({x, y});
    }
  }
  std::vector<TexturePlace> places;
  if (scene.layer != nullptr) places = scene.layer->places(g);
  PixelSample sample;
  for (const std::size_t i : drawn(visible.size(), static_cast<std::size_t>(count), seed)) {
    const auto [x, y] = visible[i];
    sample.places.push_back(visible[i]);
    sample.points.push_back({g.normal(x, y), g.to_viewer(x, y), g.part(x, y)});
    if (places.empty()) continue;
    sample.points.back().placed = true;
    sample.points.back().place = places[static_cast<std::size_t>(y) * g.width + x];
  }
  return sample;
}

PictureError picture_error(const Frame& frame, const Scene& scene, const Environment* env, double white_luminance,
                           int count, std::uint64_t seed) {
  const Stopwatch clock;
  const double white = white_luminance > 0 ? white_luminance : 1;  // in the dark all is black
  const PixelSample sample = sampled_pixels(*frame.gbuffer, scene, count, seed);
  const std::vector<std::array<int, 2>>& chosen = sample.places;
  const std::vector<Rgb> truth = exact_radiance(sample.points, scene, effects_of(scene), env);

  PictureError error;
  error.checked_pixels = static_cast<int>(chosen.size());
  std::vector<double> de00;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    const float* pixel = frame.centers.pixel(chosen[i][0], chosen[i][1]);
    de00.push_back(seen_difference({pixel[0], pixel[1], pixel[2]}, truth[i], white));
    error.de00_mean += de00.back() / static_cast<double>(chosen.size());
    if (de00.back() <= error.de00_max) continue;
    error.de00_max = de00.back();
    error.worst_x = chosen[i][0], error.worst_y = chosen[i][1];
  }
  error.de00_p95 = percentile_95(std::move(de00));
  error.time_s = clock.elapsed_s();
  return error;
}

}  // namespace goniochrome
