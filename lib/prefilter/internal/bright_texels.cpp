#include "prefilter/internal/bright_texels.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "base/angles.h"
#include "base/parallel.h"
#include "envmap/patch.h"
#include "math/quadrature.h"
#include "prefilter/internal/lobe_patch.h"
#include "prefilter/internal/lobe_rows.h"

namespace goniochrome::prefilter {

namespace {

constexpr double kBright = 50;  // times the mean

float bright_limit(const envmap::Environment& env) {
  const Vec3 flux = env.flux();
  return static_cast<float>(kBright * std::max({flux.x, flux.y, flux.z}) / (4 * kPi));
}

// The radiance above which at most `most` texels lie, and no less than kBright means.
float limit_of(const envmap::Environment& env, int most) {
  const float bright = bright_limit(env);
  std::vector<float> above;
  for (int row = 0; row < env.height(); ++row)
    for (int column = 0; column < env.width(); ++column) {
      const float* rgb = env.radiance(column, row);
      const float largest = std::max({rgb[0], rgb[1], rgb[2]});
      if (largest > bright) above.push_back(largest);
    }
  const std::size_t kept = static_cast<std::size_t>(most);
  if (above.size() <= kept) return bright;
  std::nth_element(above.begin(), above.begin() + most, above.end(), std::greater<>());
  return above[kept];
}

// Leaves the mean of the others in the place of the bright texels: a plateau at the limit would leave edges as steep as
// the limit, which is high where a sun makes the mean.
envmap::Clip without_bright(const envmap::Environment& env, int most) {
  const float limit = limit_of(env, most);
  const Vec3 others = env.flux({limit, 0});
  return {limit, static_cast<float>(std::max({others.x, others.y, others.z}) / (4 * kPi))};
}

}  // namespace

std::size_t bright_count(const envmap::Environment& env) {
  const float limit = bright_limit(env);
  std::vector<std::size_t> rows(static_cast<std::size_t>(env.height()));
  parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (int column = 0; column < env.width(); ++column) {
        const float* rgb = env.radiance(column, static_cast<int>(row));
        rows[row] += std::max({rgb[0], rgb[1], rgb[2]}) > limit;
      }
  });
  const std::size_t all = std::accumulate(rows.begin(), rows.end(), std::size_t{0});
  return std::min(all, static_cast<std::size_t>(kMostBright));
}

BrightTexels::BrightTexels(const envmap::Environment& env, int most) : env_(&env), rest_(without_bright(env, most)) {
  gauss_.per_texel = 4;
  for (int row = 0; row < env.height(); ++row)
    for (int column = 0; column < env.width(); ++column) {
      const float* all = env.radiance(column, row);
      if (!(std::max({all[0], all[1], all[2]}) > rest_.most)) continue;
      const std::array<float, 3> rest = rest_.left_of(all);
      const Vec3 excess = {double(all[0]) - rest[0], double(all[1]) - rest[1], double(all[2]) - rest[2]};
      const double area = env.solid_angle(column, row);
      const Vec3 centroid =
          (1 / area) * envmap::moment_of_cell(env, {double(column), double(row), column + 1.0, row + 1.0});
      const auto at = [&](double x, double y) { return env.direction_at(column + x, row + y); };
      texels_.push_back({area * excess, centroid, 2 * (at(0.75, 0.5) - at(0.25, 0.5)),
                         2 * (at(0.5, 0.75) - at(0.5, 0.25)), env.radius_rad(column, row, column + 1, row + 1), excess,
                         column, row});
      largest_radius_ = std::max(largest_radius_, texels_.back().radius_rad);
      centroids_.add(centroid, area * excess);
      for (const double i : math::kGaussPair)
        for (const double j : math::kGaussPair)
          gauss_.add(env.direction_at(column + i, row + j), env.solid_angle_density(column + i, row + j) / 4 * excess);
    }
}

void BrightTexels::Points::add(const Vec3& at, const Vec3& rgb) {
  x.push_back(at.x), y.push_back(at.y), z.push_back(at.z);
  for (int c = 0; c < 3; ++c) flux.push_back(static_cast<float>(rgb[c]));
}

// Step 1: as a parallelogram on which t is linear but for r/5 of its change; of cos^E a texel of radius r counts there
// r^E at most, so that is little. Step 2: where it is too much, by recursion.
Vec3 BrightTexels::beside_edge(const Vec3& d, const ZonalKernel& kernel, const Texel& texel, double allowed) const {
  const double most = std::max({texel.flux.x, texel.flux.y, texel.flux.z}) * kernel.near_edge(2 * texel.radius_rad);
  if (most * texel.radius_rad / 5 <= allowed)
    return kernel.linear_mean(dot(d, texel.centroid), dot(d, texel.across), dot(d, texel.down)) * texel.flux;
  const double relative = std::max(allowed / most, 1e-8);
  const envmap::Cell cell = {double(texel.column), double(texel.row), texel.column + 1.0, texel.row + 1.0};
  return lobe_over_cell(*env_, cell, d, kernel, relative, relative) * texel.excess;
}

// The centroid is exact for the cosine alone; for cos^E it errs by E |E-1| h^2/(24 t^2) of the texel, much near the
// horizon.
Vec3 BrightTexels::lobe(const Vec3& d, const ZonalKernel& kernel, double allowed) const {
  const bool linear = kernel.is_cosine();
  const Points& points = linear ? centroids_ : gauss_;
  // Step 1: every texel as points.
  const double direction[3] = {d.x, d.y, d.z};
  double sum[3] = {0, 0, 0};
  kernel.add_points(points.flux.data(), points.x.size(), points.x.data(), points.y.data(), points.z.data(), direction,
                    sum);
  Vec3 total = {sum[0], sum[1], sum[2]};
  if (!kernel.edge().exists()) return kernel.scale() * total;
  // Step 2: where the edge cuts a texel, or the kernel bends beside it, the points are replaced by the patch.
  const double reach = linear ? 1 : 4, edge = kernel.edge().cosine;
  thread_local std::vector<std::size_t> near;
  near.resize(texels_.size());
  const std::size_t count =
      rows::points_near(texels_.size(), centroids_.x.data(), centroids_.y.data(), centroids_.z.data(), direction, edge,
                        reach * largest_radius_, near.data());
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = near[n];
    const Texel& texel = texels_[i];
    const double t = dot(d, texel.centroid);
    if (std::fabs(t - edge) > reach * texel.radius_rad) continue;
    for (std::size_t k = points.per_texel * i; k < points.per_texel * (i + 1); ++k) {
      const double value = kernel.value(dot(d, {points.x[k], points.y[k], points.z[k]}));
      for (int c = 0; c < 3; ++c) total[c] -= value * points.flux[3 * k + c];
    }
    total += beside_edge(d, kernel, texel, allowed / kernel.scale());
  }
  return kernel.scale() * total;
}

}  // namespace goniochrome::prefilter
