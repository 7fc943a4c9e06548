#include "brdf/lobe_surface.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "math/least_squares.h"

namespace goniochrome::brdf {

namespace {

// Frames of a file in half precision agree to some 1e-4 rad.
constexpr double kSameTurn_rad = 5e-4;

bool is_round(const LafortuneLobe& lobe) {
  return lobe.axes.x == lobe.axes.y;
}

bool same_shape(const TurnedLobe& a, const TurnedLobe& b) {
  if (!(a.lobe.axes == b.lobe.axes) || a.lobe.exponent != b.lobe.exponent) return false;
  return is_round(a.lobe) || std::abs(a.turn_rad - b.turn_rad) < kSameTurn_rad;
}

Vec3 in_frame(const Vec3& d, double turn_rad) {
  if (turn_rad == 0) return d;
  const double c = std::cos(turn_rad), s = std::sin(turn_rad);
  return {c * d.x + s * d.y, c * d.y - s * d.x, d.z};
}

}  // namespace

TurnedLobe turned_lobe(const LafortuneLobe& lobe, double turn_rad) {
  TurnedLobe result{lobe, 0};
  if (is_round(lobe)) return result;
  const double quarter = 0.5 * kPi, quarters = std::round(turn_rad / quarter);
  result.turn_rad = turn_rad - quarters * quarter;
  if (std::fmod(std::abs(quarters), 2.0) != 0) std::swap(result.lobe.axes.x, result.lobe.axes.y);
  return result;
}

color::Rgb brdf(const LobeSurface& surface, const Vec3& to_light, const Vec3& to_viewer) {
  if (to_light.z <= 0 || to_viewer.z <= 0) return {};
  color::Rgb f = surface.diffuse;
  for (const TurnedLobe& turned : surface.lobes) {
    const LafortuneLobe& lobe = turned.lobe;
    const double x = dot(lobe.axes * in_frame(to_viewer, turned.turn_rad), in_frame(to_light, turned.turn_rad));
    f += {scaled_power(lobe.albedo.x, x, lobe.exponent), scaled_power(lobe.albedo.y, x, lobe.exponent),
          scaled_power(lobe.albedo.z, x, lobe.exponent)};
  }
  return f;
}

double lobe_energy(const LafortuneLobe& lobe) {
  return 2 * kPi / (lobe.exponent + 1) * (lobe.albedo.x + lobe.albedo.y + lobe.albedo.z) / 3;
}

LobeSurface lobe_surface(const SbrdfTexture& texture, int column, int row, std::uint32_t lobes) {
  LobeSurface surface;
  for (const SbrdfTexel& texel : sbrdf_texels(texture, column, row)) {
    const double turn = std::atan2(texel.x_bitangent, texel.x_tangent);
    surface.diffuse += texel.surface.diffuse;
    for (std::size_t i = 0; i < texel.surface.lobes.size(); ++i) {
      const LafortuneLobe& lobe = texel.surface.lobes[i];
      if ((lobes >> i & 1U) != 0 && !(lobe.albedo == color::Rgb{})) surface.lobes.push_back(turned_lobe(lobe, turn));
    }
  }
  return surface;
}

void add_surface(LobeSurface& sum, const LobeSurface& part, double share) {
  if (share == 0) return;
  sum.diffuse += share * part.diffuse;
  for (const TurnedLobe& lobe : part.lobes) {
    const auto same = std::ranges::find_if(sum.lobes, [&](const TurnedLobe& there) { return same_shape(there, lobe); });
    if (same != sum.lobes.end()) {
      same->lobe.albedo += share * lobe.lobe.albedo;
    } else {
      sum.lobes.push_back(lobe);
      sum.lobes.back().lobe.albedo = share * lobe.lobe.albedo;
    }
  }
}

namespace {

// The first lobe that has a direction, or null.
const TurnedLobe* directed(const LobeSurface& surface) {
  const auto found = std::ranges::find_if(surface.lobes, [](const TurnedLobe& lobe) { return !is_round(lobe.lobe); });
  return found == surface.lobes.end() ? nullptr : &*found;
}

}  // namespace

bool has_one_frame(const LobeSurface& surface) {
  const TurnedLobe* first = directed(surface);
  return first == nullptr || std::ranges::all_of(surface.lobes, [&](const TurnedLobe& lobe) {
           return is_round(lobe.lobe) || std::abs(lobe.turn_rad - first->turn_rad) < kSameTurn_rad;
         });
}

void write_texel(const LobeSurface& surface, int lobes, double unused_exponent, float* values, float* turns) {
  const TurnedLobe* first = directed(surface);
  const double turn = first == nullptr ? 0 : first->turn_rad;
  std::vector<const TurnedLobe*> order;
  for (const TurnedLobe& lobe : surface.lobes) order.push_back(&lobe);
  std::ranges::stable_sort(order, {}, [](const TurnedLobe* lobe) { return lobe->lobe.exponent; });
  for (int c = 0; c < 3; ++c) *values++ = static_cast<float>(surface.diffuse[c]);
  *values++ = static_cast<float>(std::cos(2 * turn)), *values++ = static_cast<float>(std::sin(2 * turn));
  const LafortuneLobe unused{{}, {-1, -1, 1}, unused_exponent};
  for (std::size_t i = 0; i < static_cast<std::size_t>(lobes); ++i) {
    const LafortuneLobe& lobe = i < order.size() ? order[i]->lobe : unused;
    if (turns != nullptr) {
      const double its_turn = i < order.size() && !is_round(lobe) ? order[i]->turn_rad : turn;
      *turns++ = static_cast<float>(std::cos(2 * its_turn)), *turns++ = static_cast<float>(std::sin(2 * its_turn));
    }
    for (int c = 0; c < 3; ++c) *values++ = static_cast<float>(lobe.albedo[c]);
    for (int c = 0; c < 3; ++c) *values++ = static_cast<float>(lobe.axes[c]);
    *values++ = static_cast<float>(lobe.exponent);
  }
}

namespace {

// A lobe of the axes (-a, -a, 1) with a^2 = 1 + 2 k/n has |p|^n = (1 + 2 k sin^2/n)^(n/2), close to exp(k sin^2): its
// strength grows toward grazing angles, and its middle moves away from the normal, little where k/n is small. Up to a
// quarter of n, a lobe seen at 60 deg moves by 6 deg.
struct Grown {
  double k = 0, weight = 0;
};

double grown_power(double k, double exponent, double sine2) {
  return k == 0 ? 1 : std::exp(0.5 * exponent * std::log1p(2 * k * sine2 / exponent));
}

// The strength g(cosine of the viewing angle) as at most two terms, by non-negative least squares of the relative
// error at angles up to 80 deg: all pairs of k are tried, and the best is kept. `error` is the mean relative one.
template <class Strength>
std::vector<Grown> grown_lobes(double exponent, const Strength& strength, double& error) {
  constexpr int kAngles = 17;
  const std::vector<double> all = {0, 0.25, 0.5, 1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48};
  std::vector<double> allowed;
  for (const double k : all)
    if (k <= 0.25 * exponent) allowed.push_back(k);
  math::Matrix columns(kAngles, static_cast<int>(allowed.size()));
  const std::vector<double> ones(kAngles, 1.0);
  for (int row = 0; row < kAngles; ++row) {
    const double cosine = std::cos(5.0 * row * kDegree), sine2 = 1 - cosine * cosine, g = strength(cosine);
    for (std::size_t i = 0; i < allowed.size(); ++i)
      columns(row, static_cast<int>(i)) = grown_power(allowed[i], exponent, sine2) / g;
  }
  std::vector<Grown> best;
  double least = 0;
  for (std::size_t i = 0; i < allowed.size(); ++i) {
    for (std::size_t j = i; j < allowed.size(); ++j) {
      math::Matrix pair(kAngles, i == j ? 1 : 2);
      for (int row = 0; row < kAngles; ++row) {
        pair(row, 0) = columns(row, static_cast<int>(i));
        if (i != j) pair(row, 1) = columns(row, static_cast<int>(j));
      }
      const math::NonNegativeFit fit = math::nnls(pair, ones);
      if (!best.empty() && fit.objective >= least) continue;
      least = fit.objective, best = {{allowed[i], fit.x[0]}};
      if (i != j) best.push_back({allowed[j], fit.x[1]});
    }
  }
  error = 0;
  for (int row = 0; row < kAngles; ++row) {
    const double cosine = std::cos(5.0 * row * kDegree);
    double shown = 0;
    for (const Grown& term : best) shown += term.weight * grown_power(term.k, exponent, 1 - cosine * cosine);
    error += std::abs(shown / strength(cosine) - 1) / kAngles;
  }
  return best;
}

// Adds `weight` times a strength that changes with the viewing angle.
template <class Strength>
void add_grown(LobeSurface& surface, double exponent, const color::Rgb& weight, const Strength& strength,
               double& error) {
  if (weight == color::Rgb{}) return;
  double here = 0;
  LobeSurface part;
  for (const Grown& term : grown_lobes(exponent, strength, here)) {
    if (term.weight == 0) continue;
    const double a = term.k == 0 ? 1 : std::sqrt(1 + 2 * term.k / exponent);
    part.lobes.push_back({{term.weight * weight, {-a, -a, 1}, exponent}, 0});
  }
  add_surface(surface, part, 1);
  error = std::max(error, here);
}

// A mirror reflects F at every angle; a lobe of weight 1 reflects 2 pi/(n+1) times the cosine of its middle.
void add_mirror(LobeSurface& surface, double index, const color::Rgb& share, double exponent, double& error) {
  add_grown(
      surface, exponent, ((exponent + 1) / (2 * kPi)) * share,
      [&](double cosine) { return fresnel_dielectric(cosine, index) / cosine; }, error);
}

}  // namespace

PaintedSurface painted_surface(const paint::LobeFit& fit, double gloss_deg, double mirror_exponent) {
  PaintedSurface result;
  const double once = coat_transmission(std::sqrt(0.5), fit.coat_index);
  const double mean = fit.coat_index == paint::kNoCoat ? 1 : mean_coat_transmission(fit.coat_index);
  result.surface.diffuse = (once * mean) * fit.diffuse;
  const double index = mirror_index(fit.coat_index);
  for (const paint::Lobe& lobe : fit.lobes) {
    if (lobe.is_mirror()) {
      add_mirror(result.surface, index, lobe.gloss, mirror_exponent, result.mirror_error);
      continue;
    }
    if (!(lobe.directional_diffuse == color::Rgb{}))
      add_surface(result.surface, {{}, {{{(once * once) * lobe.directional_diffuse, {-1, -1, 1}, lobe.exponent}, 0}}},
                  1);
    add_grown(
        result.surface, lobe.exponent, lobe.gloss,
        [&](double cosine) { return coat_fresnel(cosine, gloss_deg) / cosine; }, result.mirror_error);
  }
  return result;
}

PaintedSurface coat_surface(double coat_index, double share, double mirror_exponent) {
  PaintedSurface result;
  add_mirror(result.surface, coat_index, share * color::Rgb{1, 1, 1}, mirror_exponent, result.mirror_error);
  return result;
}

}  // namespace goniochrome::brdf
