#include "materials/internal/ggx.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angles.h"

namespace goniochrome::materials {

double ggx_masking(double alpha, const Vec3& to_light, const Vec3& to_viewer) {
  const double a2 = alpha * alpha;
  const auto slope = [&](double c) { return std::sqrt(a2 + (1 - a2) * c * c); };
  return 1 / (2 * (slope(to_light.z) * to_viewer.z + slope(to_viewer.z) * to_light.z));
}

double ggx(double alpha, const Vec3& to_light, const Vec3& to_viewer) {
  const double a2 = alpha * alpha;
  const Vec3 half = normalized(to_light + to_viewer);
  // 1 - (1 - a2) z^2, which does not cancel for sharp lobes: the square of the sine is that of the vector itself.
  const double sine2 = half.x * half.x + half.y * half.y, d = sine2 + a2 * half.z * half.z;
  return a2 / (kPi * d * d) * ggx_masking(alpha, to_light, to_viewer);
}

double half_cosine(const Vec3& to_light, const Vec3& to_viewer) {
  return std::min(1.0, length(to_light + to_viewer) / 2);
}

double schlick(double cosine) {
  const double m = std::clamp(1 - cosine, 0.0, 1.0), m2 = m * m;
  return m2 * m2 * m;
}

// Half vectors are taken with the density D cos: tan^2(theta_h) = alpha^2 u/(1 - u). Light there reflects
// D G/(4 cos_o) dw_i = G (o.h)/(cos_o cos_h) times that density.
FacetAlbedo facet_albedo(double alpha, double cosine) {
  if (alpha <= 0) return {1, schlick(cosine)};
  constexpr int kRings = 48, kTurns = 24;
  const double c = std::clamp(cosine, 1e-3, 1.0), s = std::sqrt(1 - c * c), a2 = alpha * alpha;
  const auto slope = [&](double x) { return std::sqrt(a2 + (1 - a2) * x * x); };
  FacetAlbedo sum{0, 0};
  for (int ring = 0; ring < kRings; ++ring) {
    // Rings are dense toward u = 1, the steep facets, where the light goes below the horizon.
    const double left = 1 - (ring + 0.5) / kRings, tan2 = a2 * (1 / (left * left) - 1), z = 1 / std::sqrt(1 + tan2);
    for (int turn = 0; turn < kTurns; ++turn) {
      const double azimuth = kPi * (turn + 0.5) / kTurns, x = std::sqrt(1 - z * z) * std::cos(azimuth);
      const double along = s * x + c * z, light = 2 * along * z - c;
      if (along <= 0 || light <= 0) continue;
      const double masking = 2 * light * c / (slope(light) * c + slope(c) * light);
      const double share = 2 * left * masking * along / (c * z) / (kRings * kTurns);
      sum.all += share;
      sum.grazing += share * schlick(along);
    }
  }
  return sum;
}

namespace {

// The tables are even in the square root of alpha, which is what most models call roughness, and in the cosine.
constexpr std::size_t kAlphas = 33, kCosines = 49;

// The cell of an even table that holds a share of 0 to 1 of its length, and the place in it.
struct Place {
  std::size_t cell;
  double share;
};
Place place_of(double x, std::size_t nodes) {
  const double at = std::clamp(x, 0.0, 1.0) * static_cast<double>(nodes - 1);
  const std::size_t cell = std::min(static_cast<std::size_t>(at), nodes - 2);
  return {cell, at - static_cast<double>(cell)};
}

FacetAlbedo mixed(const FacetAlbedo& a, const FacetAlbedo& b, double share) {
  return {std::lerp(a.all, b.all, share), std::lerp(a.grazing, b.grazing, share)};
}

double root_at(std::size_t i) {
  return static_cast<double>(i) / (kAlphas - 1);
}

}  // namespace

FacetAlbedo quick_facet_albedo(double alpha, double cosine) {
  static const std::vector<FacetAlbedo> table = [] {
    std::vector<FacetAlbedo> all;
    for (std::size_t i = 0; i < kAlphas; ++i)
      for (std::size_t j = 0; j < kCosines; ++j)
        all.push_back(facet_albedo(root_at(i) * root_at(i), static_cast<double>(j) / (kCosines - 1)));
    return all;
  }();
  const Place row = place_of(std::sqrt(std::max(alpha, 0.0)), kAlphas), column = place_of(cosine, kCosines);
  const auto along = [&](std::size_t i) {
    const std::size_t k = i * kCosines + column.cell;
    return mixed(table[k], table[k + 1], column.share);
  };
  return mixed(along(row.cell), along(row.cell + 1), row.share);
}

FacetAlbedo quick_facet_average(double alpha) {
  static const std::vector<FacetAlbedo> table = [] {
    constexpr int kSteps = 96;
    std::vector<FacetAlbedo> all;
    for (std::size_t i = 0; i < kAlphas; ++i) {
      FacetAlbedo sum{0, 0};
      for (int j = 0; j < kSteps; ++j) {
        const double cosine = (j + 0.5) / kSteps;
        const FacetAlbedo albedo = facet_albedo(root_at(i) * root_at(i), cosine);
        sum.all += albedo.all * 2 * cosine / kSteps, sum.grazing += albedo.grazing * 2 * cosine / kSteps;
      }
      all.push_back(sum);
    }
    return all;
  }();
  const Place row = place_of(std::sqrt(std::max(alpha, 0.0)), kAlphas);
  return mixed(table[row.cell], table[row.cell + 1], row.share);
}

}  // namespace goniochrome::materials
