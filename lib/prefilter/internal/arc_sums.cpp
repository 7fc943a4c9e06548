#include "prefilter/internal/arc_sums.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "math/quadrature.h"

// At the polar angle t the cosine to the direction d is a + b cos(p - p_d) with a = d.y cos t, b = sin t
// hypot(d.x,d.z): above 0 for |p - p_d| < acos(-a/b). On that arc
//   integral of L dp,  L sin p dp,  L cos p dp
// are differences of running sums along the row, and they are all that exponents 0 and 1 need. Within texel j a running
// sum is A_j + L_j f(p), with f = p, -cos p, sin p.
//
// A library of spherical harmonics does not replace these sums. The horizon is a kink of the lobe of exponent 1 and a
// step of that of exponent 0, so that the coefficients fall slowly: truncation_bound() is 0.35 of the mean for exponent
// 1 at degree 127, still 0.12 at degree 2000, and infinite for exponent 0.

namespace goniochrome::prefilter {

namespace {

constexpr int kRowsAtOnce = 16;

// A_j of the three running sums, and L_j; per channel.
struct Step {
  double sum[3][3];  // [of 1, sin p, cos p][channel]
  double value[3];
};

struct Row {
  std::vector<Step> steps;
  double whole[3][3];  // over all of the row
};

Row row_of(const envmap::Environment& env, const envmap::Clip& clip, int row) {
  Row r = {std::vector<Step>(static_cast<std::size_t>(env.width())), {}};
  for (int j = 0; j < env.width(); ++j) {
    const auto f = [&](int column) {
      const double p = 2 * kPi * column / env.width();
      return std::array<double, 3>{p, -std::cos(p), std::sin(p)};
    };
    const std::array<double, 3> begin = f(j), end = f(j + 1);
    const std::array<float, 3> rgb = clip.left_of(env.radiance(j, row));
    Step& step = r.steps[static_cast<std::size_t>(j)];
    for (std::size_t c = 0; c < 3; ++c) {
      step.value[c] = rgb[c];
      for (std::size_t k = 0; k < 3; ++k) {
        step.sum[k][c] = r.whole[k][c] - step.value[c] * begin[k];
        r.whole[k][c] += step.value[c] * (end[k] - begin[k]);
      }
    }
  }
  return r;
}

struct Direction {
  Vec3 d;
  double across = 0, azimuth = 0, sine = 0, cosine = 1;  // hypot(d.x, d.z), p_d
};

Direction direction_of(const Vec3& d) {
  Direction result = {d, std::hypot(d.x, d.z)};
  if (result.across < 1e-15) return result;
  result.azimuth = std::atan2(d.x, -d.z);
  result.sine = d.x / result.across, result.cosine = -d.z / result.across;
  return result;
}

// Adds sign times the running sums at azimuth p to `sums`.
void add_at(const Row& row, double p, double sine, double cosine, double sign, double sums[3][3]) {
  const double turns = std::floor(p / (2 * kPi));
  const double in = p - 2 * kPi * turns, n = static_cast<double>(row.steps.size());
  const Step& step = row.steps[static_cast<std::size_t>(std::clamp(std::floor(in * n / (2 * kPi)), 0.0, n - 1))];
  const double f[3] = {in, -cosine, sine};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      sums[k][c] += sign * (turns * row.whole[k][c] + step.sum[k][c] + step.value[c] * f[k]);
}

// The integral of the lobe along a row at one polar angle.
Vec3 along(const Row& row, const Direction& to, double sin_t, double cos_t, bool flat) {
  const double a = to.d.y * cos_t, b = to.across * sin_t;
  if (a <= -b) return {};
  double sums[3][3] = {};
  if (a >= b) {
    std::copy(&row.whole[0][0], &row.whole[0][0] + 9, &sums[0][0]);
  } else {
    const double q = -a / b, r = std::sqrt(1 - q * q), half = std::acos(q);
    add_at(row, to.azimuth + half, to.sine * q + to.cosine * r, to.cosine * q - to.sine * r, 1, sums);
    add_at(row, to.azimuth - half, to.sine * q - to.cosine * r, to.cosine * q + to.sine * r, -1, sums);
  }
  Vec3 result;
  for (int c = 0; c < 3; ++c)
    result[c] = flat ? sums[0][c] : a * sums[0][c] + sin_t * (to.d.x * sums[1][c] - to.d.z * sums[2][c]);
  return result;
}

}  // namespace

// The kink of exponent 1, and the step of exponent 0, move along the row as fast as it is high at most: the error of a
// row is random, a part of h^3 and h^2 of a texel, and falls with the points as much.
int arc_points(bool step, double tolerance) {
  if (step) return tolerance < 2e-4 ? 16 : 4;
  return tolerance < 2e-5 ? 4 : 2;
}

std::vector<Vec3> arc_sums(const envmap::Environment& env, const envmap::Clip& clip, const ZonalKernel& kernel,
                           const std::vector<Vec3>& directions, double tolerance) {
  const bool step = kernel.shape() == ZonalKernel::Shape::kStep;
  const math::GaussRule rule = math::gauss_rule(2, arc_points(step, tolerance) / 2);
  std::vector<Direction> to(directions.size());
  std::transform(directions.begin(), directions.end(), to.begin(), direction_of);
  std::vector<Vec3> sums(directions.size());
  for (int first = 0; first < env.height(); first += kRowsAtOnce) {
    std::vector<Row> rows(static_cast<std::size_t>(std::min(kRowsAtOnce, env.height() - first)));
    parallel_for(rows.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) rows[i] = row_of(env, clip, first + static_cast<int>(i));
    });
    parallel_for(to.size(), 64, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = 0; i < rows.size(); ++i)
        for (std::size_t k = 0; k < rule.at.size(); ++k) {
          const double t = kPi * (first + static_cast<double>(i) + rule.at[k]) / env.height();
          const double sin_t = std::sin(t), cos_t = std::cos(t), weight = rule.weight[k] * sin_t * kPi / env.height();
          for (std::size_t j = begin; j < end; ++j) sums[j] += weight * along(rows[i], to[j], sin_t, cos_t, step);
        }
    });
  }
  for (Vec3& sum : sums) sum = kernel.scale() * sum;
  return sums;
}

}  // namespace goniochrome::prefilter
