#include "prefilter/internal/harmonic_grid.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "prefilter/internal/harmonic_grid.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "base/unset_array.h"
#include "math/fft.h"
#include "math/legendre.h"
#include "math/quadrature.h"

// On the full circle of the polar angle a function of degree L is a trigonometric polynomial of degree L in both
// angles. Its coefficients, divided by the transform of a narrow bump and taken to a grid twice as fine as they need,
// give samples whose sum weighted by the bump is the function again [Barnett2019]. The bump is exp(b (sqrt(1-z^2) - 1))
// over `taps` grid steps; each tap's weight is a polynomial of the place between two grid points.
//
// Debian 12 has no library for this. The Python packages of two were measured at 98,304 directions and three channels
// to an error of 1e-6. FINUFFT 2.5 does the last step alone, from the Fourier coefficients on, for complex values: it
// takes 35, 54 and 130 ms at the degrees 127, 255 and 511, where all of lobe_values() takes 24, 64 and 215 ms. ducc0
// 0.42 does all of it in 14, 31 and 76 ms: it is the faster by far at high degrees, and costs a library that users
// would have to build themselves.

#ifndef GONIOCHROME_HARMONIC_GRID_TYPES
#define GONIOCHROME_HARMONIC_GRID_TYPES
namespace goniochrome::prefilter::harmonic_grid {

constexpr std::size_t kMostTaps = 16;  // padded
constexpr std::size_t kTerms = 20;

// Coefficients of the weight of tap t as a polynomial of u in -1..1: [term][tap].
struct Bump {
  std::size_t taps = 0, padded = 0;
  double beta = 0;
  double terms[kTerms][kMostTaps] = {};
};

// Three planes (R, G, B) of rows x stride samples; row 0 is `margin` steps north of the pole, columns wrap by a copy.
struct Grid {
  std::size_t rows = 0, columns = 0, stride = 0;
  double theta_step = 0, phi_step = 0;
  std::ptrdiff_t first_row = 0;     // the row of the circle that row 0 is
  std::ptrdiff_t first_column = 0;  // likewise
  UnsetArray<double> plane[3];
};

}  // namespace goniochrome::prefilter::harmonic_grid
#endif

HWY_BEFORE_NAMESPACE();
namespace goniochrome::prefilter {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The weights of the taps from grid point ceil(x - taps/2) on; returns that point.
HWY_INLINE std::ptrdiff_t Weights(const harmonic_grid::Bump& bump, double x, double* weights) {
  const hn::ScalableTag<double> d;
  const double left = x - 0.5 * static_cast<double>(bump.taps), first = std::ceil(left);
  const auto u = hn::Set(d, 2 * (first - left) - 1);
  for (std::size_t t = 0; t < bump.padded; t += hn::Lanes(d)) {
    auto sum = hn::LoadU(d, bump.terms[harmonic_grid::kTerms - 1] + t);
    for (std::size_t k = harmonic_grid::kTerms - 1; k-- > 0;) sum = hn::MulAdd(sum, u, hn::LoadU(d, bump.terms[k] + t));
    hn::StoreU(sum, d, weights + t);
  }
  return static_cast<std::ptrdiff_t>(first);
}

// The value of the three planes at each point. Step 1: the weights of the taps down and across. Step 2: each row of
// taps is multiplied by its weight and added up, a vector of columns at a time. Step 3: the columns are weighed and
// added.
void Gather(const harmonic_grid::Grid& grid, const harmonic_grid::Bump& bump, const double* theta, const double* phi,
            std::size_t count, float* rgb) {
  const hn::ScalableTag<double> d;
  const std::size_t lanes = hn::Lanes(d);
  alignas(64) double down[harmonic_grid::kMostTaps], across[harmonic_grid::kMostTaps];
  for (std::size_t i = 0; i < count; ++i) {
    const std::ptrdiff_t row = Weights(bump, theta[i] / grid.theta_step, down) - grid.first_row;
    const std::ptrdiff_t column = Weights(bump, phi[i] / grid.phi_step, across) - grid.first_column;
    const std::size_t corner = static_cast<std::size_t>(row) * grid.stride + static_cast<std::size_t>(column);
    for (std::size_t c = 0; c < 3; ++c) {
      const double* at = grid.plane[c].data() + corner;
      auto total = hn::Zero(d);
      for (std::size_t t = 0; t < bump.padded; t += lanes) {
        auto sum = hn::Zero(d);
        for (std::size_t r = 0; r < bump.taps; ++r)
          sum = hn::MulAdd(hn::Set(d, down[r]), hn::LoadU(d, at + r * grid.stride + t), sum);
        total = hn::MulAdd(sum, hn::LoadU(d, across + t), total);
      }
      const double value = hn::GetLane(hn::SumOfLanes(d, total));
      rgb[3 * i + c] = value > 0 ? static_cast<float>(value) : 0.0F;
    }
  }
}

// Adds `weight[i]` around each point to one plane: Gather() the other way round.
void Spread(const harmonic_grid::Bump& bump, const double* theta, const double* phi, const double* weight,
            std::size_t count, harmonic_grid::Grid& grid, std::size_t channel) {
  const hn::ScalableTag<double> d;
  alignas(64) double down[harmonic_grid::kMostTaps], across[harmonic_grid::kMostTaps];
  double* plane = grid.plane[channel].data();
  for (std::size_t i = 0; i < count; ++i) {
    if (weight[i] == 0) continue;
    const std::ptrdiff_t row = Weights(bump, theta[i] / grid.theta_step, down) - grid.first_row;
    const std::ptrdiff_t column = Weights(bump, phi[i] / grid.phi_step, across) - grid.first_column;
    double* at = plane + static_cast<std::size_t>(row) * grid.stride + static_cast<std::size_t>(column);
    for (std::size_t r = 0; r < bump.taps; ++r, at += grid.stride) {
      const auto scale = hn::Set(d, weight[i] * down[r]);
      for (std::size_t t = 0; t < bump.padded; t += hn::Lanes(d))
        hn::StoreU(hn::MulAdd(scale, hn::LoadU(d, across + t), hn::LoadU(d, at + t)), d, at + t);
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace goniochrome::prefilter
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace goniochrome::prefilter {

HWY_EXPORT(Gather);
HWY_EXPORT(Spread);

namespace {

using harmonic_grid::Bump;
using harmonic_grid::Grid;

constexpr std::size_t kOrdersAtOnce = 8;
constexpr std::size_t kRowsAtOnce = 16;

double bump_value(double beta, double z) {
  return std::fabs(z) < 1 ? std::exp(beta * (std::sqrt(1 - z * z) - 1)) : 0;
}

// Interpolates each tap's weight at Chebyshev points, then gathers powers of u.
Bump make_bump(int taps) {
  Bump bump;
  bump.taps = static_cast<std::size_t>(taps);
  bump.padded = (bump.taps + 7) / 8 * 8;
  bump.beta = 2.30 * taps;
  constexpr std::size_t n = harmonic_grid::kTerms;
  // Powers of u in T_j, by T_(j+1) = 2 u T_j - T_(j-1).
  std::vector<std::vector<double>> chebyshev(n, std::vector<double>(n, 0.0));
  chebyshev[0][0] = 1;
  chebyshev[1][1] = 1;
  for (std::size_t j = 2; j < n; ++j)
    for (std::size_t k = 0; k < n; ++k)
      chebyshev[j][k] = (k > 0 ? 2 * chebyshev[j - 1][k - 1] : 0) - chebyshev[j - 2][k];
  for (std::size_t t = 0; t < bump.taps; ++t) {
    std::vector<double> value(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double u = std::cos(kPi * (static_cast<double>(i) + 0.5) / n), delta = (u + 1) / 2;
      value[i] = bump_value(bump.beta, 1 - 2 * (delta + static_cast<double>(t)) / taps);
    }
    for (std::size_t j = 0; j < n; ++j) {
      double coefficient = 0;
      for (std::size_t i = 0; i < n; ++i)
        coefficient += value[i] * std::cos(kPi * static_cast<double>(j) * (static_cast<double>(i) + 0.5) / n);
      coefficient *= (j == 0 ? 1.0 : 2.0) / n;
      for (std::size_t k = 0; k < n; ++k) bump.terms[k][t] += coefficient * chebyshev[j][k];
    }
  }
  return bump;
}

// 1 / (transform of the bump at frequency n, in grid steps), n = 0..degree: with z = sin s the integrand is smooth and
// all but periodic, so equal steps suffice.
std::vector<double> corrections(const Bump& bump, int degree, double step) {
  constexpr int kSteps = 400;
  double weight[kSteps], sine[kSteps];
  for (int i = 0; i < kSteps; ++i) {
    const double s = kPi * ((i + 0.5) / kSteps - 0.5);
    weight[i] = std::exp(bump.beta * (std::cos(s) - 1)) * std::cos(s);
    sine[i] = std::sin(s);
  }
  std::vector<double> result;
  for (int n = 0; n <= degree; ++n) {
    double sum = 0;
    for (int i = 0; i < kSteps; ++i)
      sum += weight[i] * std::cos(n * step * static_cast<double>(bump.taps) / 2 * sine[i]);
    result.push_back(1 / (sum * kPi / kSteps * static_cast<double>(bump.taps) / 2));
  }
  return result;
}

// F_m on the fine rows: [row][m][re R G B im R G B], some orders at a time. `correction` is that of the polar angle.
UnsetArray<double> fine_rows(const Harmonics& harmonics, const std::vector<double>& k, const Grid& grid,
                             std::size_t fine, const std::vector<double>& correction) {
  const int degree = static_cast<int>(k.size()) - 1;
  const std::size_t orders = static_cast<std::size_t>(degree) + 1;
  const std::size_t circle = math::fast_length(static_cast<std::size_t>(2 * degree + 2), 4), half = circle / 2;
  std::vector<double> theta(half / 2);
  for (std::size_t i = 0; i < theta.size(); ++i)
    theta[i] = 2 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(circle);
  const math::Rings rings(theta);
  const math::Fft coarse_fft(circle), fine_fft(fine);
  UnsetArray<double> rows(grid.rows * orders * 6);
  parallel_for(orders, kOrdersAtOnce, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t kLanes = 3 * kOrdersAtOnce;
    math::Block coarse(circle, kLanes), refined(fine, kLanes);
    std::vector<double> even(6 * rings.count), odd(6 * rings.count), scaled;
    // Step 1: the values of k_l a_lm P_lm, summed over l, on the rings of the northern hemisphere; parity gives the
    // southern rings, and P_lm beyond the poles is (-1)^m times itself, which fills the circle.
    for (std::size_t m = begin; m < end; ++m) {
      const double* a = harmonics.order(static_cast<int>(m));
      scaled.clear();
      for (std::size_t l = m; l < orders; ++l)
        for (std::size_t c = 0; c < 6; ++c) scaled.push_back(k[l] * a[6 * (l - m) + c]);
      math::legendre_values(rings, static_cast<int>(m), degree, scaled.data(), even.data(), odd.data());
      const double fold = m % 2 == 0 ? 1 : -1;
      for (std::size_t i = 0; i < theta.size(); ++i)
        for (std::size_t c = 0; c < 6; ++c) {
          std::vector<double>& part = c < 3 ? coarse.re : coarse.im;
          const std::size_t j = 3 * (m - begin) + c % 3;
          const double e = even[c * rings.count + i], o = odd[c * rings.count + i];
          part[i * kLanes + j] = e + o;
          part[(half - 1 - i) * kLanes + j] = e - o;
          part[(circle - 1 - i) * kLanes + j] = fold * (e + o);
          part[(half + i) * kLanes + j] = fold * (e - o);
        }
    }
    // Step 2: the coefficients along the circle. The rings lie half a step off the pole, which a phase undoes, and each
    // coefficient is divided by the transform of the bump.
    coarse.transform(coarse_fft, -1);
    const int steps = static_cast<int>(circle), fine_steps = static_cast<int>(fine);
    for (int n = -degree; n <= degree; ++n) {
      const double angle = -kPi * n / steps, scale = correction[static_cast<std::size_t>(std::abs(n))] / steps;
      const double cosine = scale * std::cos(angle), sine = scale * std::sin(angle);
      const std::size_t from = static_cast<std::size_t>((n + steps) % steps) * kLanes;
      const std::size_t to = static_cast<std::size_t>((n + fine_steps) % fine_steps) * kLanes;
      for (std::size_t j = 0; j < kLanes; ++j) {
        refined.re[to + j] = cosine * coarse.re[from + j] - sine * coarse.im[from + j];
        refined.im[to + j] = cosine * coarse.im[from + j] + sine * coarse.re[from + j];
      }
    }
    // Step 3: back to samples on the fine circle, of which the rows of the grid are a part.
    refined.transform(fine_fft, 1);
    for (std::size_t row = 0; row < grid.rows; ++row) {
      const std::ptrdiff_t on_circle = static_cast<std::ptrdiff_t>(row) + grid.first_row;
      const std::size_t from = static_cast<std::size_t>((on_circle + fine_steps) % fine_steps) * kLanes;
      for (std::size_t m = begin; m < end; ++m)
        for (std::size_t c = 0; c < 6; ++c)
          rows[(row * orders + m) * 6 + c] = (c < 3 ? refined.re : refined.im)[from + 3 * (m - begin) + c % 3];
    }
  });
  return rows;
}

// A grid that is twice as fine as a function of this degree needs, without samples.
Grid unset_grid(int degree, const Bump& bump) {
  const std::size_t fine = math::fast_length(std::max<std::size_t>(4 * (static_cast<std::size_t>(degree) + 1), 32), 4);
  const std::size_t margin = bump.taps / 2 + 1;
  Grid grid;
  grid.theta_step = grid.phi_step = 2 * kPi / static_cast<double>(fine);
  grid.first_row = grid.first_column = -static_cast<std::ptrdiff_t>(margin);
  grid.rows = fine / 2 + 2 * margin + 1;
  grid.columns = fine;
  grid.stride = fine + 2 * margin + harmonic_grid::kMostTaps;
  for (auto& plane : grid.plane) plane = UnsetArray<double>(grid.rows * grid.stride);
  return grid;
}

// Samples of the sum over l, m of k[l] a_lm Y_lm divided by the bump's transform, ready for Gather().
Grid make_grid(const Harmonics& harmonics, const std::vector<double>& k, const Bump& bump) {
  const int degree = static_cast<int>(k.size()) - 1;
  const std::size_t orders = static_cast<std::size_t>(degree) + 1;
  Grid grid = unset_grid(degree, bump);
  const std::size_t fine = grid.columns, margin = static_cast<std::size_t>(-grid.first_column);
  const std::vector<double> correction = corrections(bump, degree, grid.phi_step);  // of either angle: equal steps
  const UnsetArray<double> rows = fine_rows(harmonics, k, grid, fine, correction);
  const math::Fft fft(fine);
  parallel_for(grid.rows, kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t kSeries = 3 * kRowsAtOnce;
    math::Block block(fine, kSeries / 2);
    // Step 1: two real series X and Y as one complex one: Z_m = X_m + i Y_m, and their conjugates at -m.
    for (std::size_t m = 0; m < orders; ++m)
      for (std::size_t lane = 0; lane < block.lanes; ++lane) {
        const auto series = [&](std::size_t s) {
          const std::size_t row = begin + s / 3;
          return row < end ? &rows[(row * orders + m) * 6 + s % 3] : nullptr;
        };
        const double *x = series(2 * lane), *y = series(2 * lane + 1);
        const double scale = correction[m];
        const double xr = x ? scale * x[0] : 0, xi = x ? scale * x[3] : 0;
        const double yr = y ? scale * y[0] : 0, yi = y ? scale * y[3] : 0;
        block.re[m * block.lanes + lane] = xr - yi;
        block.im[m * block.lanes + lane] = xi + yr;
        if (m == 0) continue;
        block.re[(fine - m) * block.lanes + lane] = xr + yi;
        block.im[(fine - m) * block.lanes + lane] = yr - xi;
      }
    // Step 2: samples along each row; the first and the last columns are copied beyond the ends, where taps reach.
    block.transform(fft, 1);
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t s = 3 * (row - begin) + c;
        const std::vector<double>& part = s % 2 == 0 ? block.re : block.im;
        double* to = &grid.plane[c][row * grid.stride];
        for (std::size_t j = 0; j < grid.stride; ++j) {
          const std::size_t column = (j + fine - margin) % fine;
          to[j] = part[column * block.lanes + s / 2];
        }
      }
  });
  return grid;
}

}  // namespace

// exp(-pi taps sqrt(1 - 1/2)) for a grid twice as fine as needed, times a small constant.
int taps_for(double error) {
  const double taps = std::log(10 / std::max(error, 1e-14)) / (kPi * std::sqrt(0.5));
  return std::clamp(static_cast<int>(std::ceil(taps)) + 1, 4, 14);
}

GridAngles::GridAngles(const envmap::SphereGrid& grid, const envmap::Rotation& turn) {
  const std::size_t width = static_cast<std::size_t>(grid.width()),
                    count = width * static_cast<std::size_t>(grid.height());
  theta.resize(count);
  phi.resize(count);
  parallel_for(count, 1 << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 d = turn.to_environment(grid.direction(static_cast<int>(i % width), static_cast<int>(i / width)));
      theta[i] = std::atan2(std::hypot(d.x, d.z), d.y);
      const double azimuth = std::atan2(d.x, -d.z);
      phi[i] = azimuth < 0 ? azimuth + 2 * kPi : azimuth;
    }
  });
}

std::vector<float> lobe_values(const Harmonics& harmonics, const std::vector<double>& k, const GridAngles& angles,
                               int taps) {
  const Bump bump = make_bump(taps);
  const Grid grid = make_grid(harmonics, k, bump);
  std::vector<float> values(3 * angles.theta.size());
  parallel_for(angles.theta.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
    HWY_DYNAMIC_DISPATCH(Gather)
    (grid, bump, &angles.theta[begin], &angles.phi[begin], end - begin, &values[3 * begin]);
  });
  return values;
}

namespace {

struct Points {
  std::vector<double> theta, phi, weight[3];
};

// n points across h err by (l h)^2n / C_n at degree l, C = 4320, 2e6, 1.8e9: the fewest that keep k_l times that below
// 1e-7.
math::GaussRule rule_for(const std::vector<double>& k, double texel_rad) {
  constexpr std::array<double, 3> kScale = {4320, 2e6, 1.8e9};
  const auto error = [&](int points, int pieces) {
    double worst = 0;
    for (std::size_t l = 0; l < k.size(); ++l)
      worst = std::max(worst, std::fabs(k[l]) * std::pow(static_cast<double>(l) * texel_rad / pieces, 2.0 * points));
    return worst / kScale[static_cast<std::size_t>(points) - 2];
  };
  for (const int points : {2, 3, 4})
    if (error(points, 1) < 1e-7) return math::gauss_rule(points, 1);
  int pieces = 2;
  while (error(4, pieces) >= 1e-7) ++pieces;
  return math::gauss_rule(4, pieces);
}

Points row_points(const envmap::Environment& env, int row, const math::GaussRule& rule, const envmap::Clip& clip) {
  Points points;
  for (int column = 0; column < env.width(); ++column) {
    const std::array<float, 3> rgb = clip.left_of(env.radiance(column, row));
    if (rgb[0] == 0 && rgb[1] == 0 && rgb[2] == 0) continue;
    for (std::size_t i = 0; i < rule.at.size(); ++i)
      for (std::size_t j = 0; j < rule.at.size(); ++j) {
        const double x = column + rule.at[i], y = row + rule.at[j];
        const Vec3 d = env.direction_at(x, y);
        const double area = env.solid_angle_density(x, y) * rule.weight[i] * rule.weight[j];
        const double azimuth = std::atan2(d.x, -d.z);
        points.theta.push_back(std::atan2(std::hypot(d.x, d.z), d.y));
        points.phi.push_back(azimuth < 0 ? azimuth + 2 * kPi : azimuth);
        for (std::size_t c = 0; c < 3; ++c) points.weight[c].push_back(area * rgb[c]);
      }
  }
  return points;
}

}  // namespace

ScatteredMoments scattered_moments(const envmap::Environment& env, const std::vector<double>& k,
                                   const envmap::Clip& clip) {
  const int degree = static_cast<int>(k.size()) - 1;
  const Bump bump = make_bump(14);
  Grid grid = unset_grid(degree + 1, bump);
  for (auto& plane : grid.plane) std::fill_n(plane.data(), plane.size(), 0.0);
  const std::size_t fine = grid.columns, orders = static_cast<std::size_t>(degree) + 1;
  const math::GaussRule rule = rule_for(k, env.largest_texel_rad());
  // Step 1: the texels as weighted points, spread onto the grid; some rows at a time, because points take memory.
  constexpr int kRowsAtATime = 64;
  for (int first = 0; first < env.height(); first += kRowsAtATime) {
    std::vector<Points> rows(static_cast<std::size_t>(std::min(kRowsAtATime, env.height() - first)));
    parallel_for(rows.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) rows[i] = row_points(env, first + static_cast<int>(i), rule, clip);
    });
    parallel_for(3, 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c)
        for (const Points& p : rows)
          HWY_DYNAMIC_DISPATCH(Spread)(bump, p.theta.data(), p.phi.data(), p.weight[c].data(), p.theta.size(), grid, c);
    });
  }
  // Step 2: the copied columns are folded back and every row is transformed.
  ScatteredMoments moments;
  moments.rows = grid.rows;
  moments.circle = fine;
  moments.first_row = grid.first_row;
  moments.scale = corrections(bump, degree + 1, grid.theta_step);
  moments.values = UnsetArray<double>(orders * grid.rows * 6);
  const math::Fft fft(fine);
  parallel_for(grid.rows, kRowsAtOnce, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t kSeries = 3 * kRowsAtOnce;  // as complex series whose imaginary parts are zero
    math::Block block(fine, kSeries);
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t j = 0; j < grid.stride; ++j) {
          const std::size_t column = (j + 2 * fine - static_cast<std::size_t>(-grid.first_column)) % fine;
          block.re[column * kSeries + 3 * (row - begin) + c] += grid.plane[c][row * grid.stride + j];
        }
    block.transform(fft, -1);
    for (std::size_t m = 0; m < orders; ++m)
      for (std::size_t row = begin; row < end; ++row)
        for (std::size_t c = 0; c < 3; ++c) {
          double* to = &moments.values[(m * grid.rows + row) * 6];
          const std::size_t at = m * kSeries + 3 * (row - begin) + c;
          to[c] = moments.scale[m] * block.re[at];
          to[3 + c] = moments.scale[m] * block.im[at];
        }
  });
  return moments;
}

}  // namespace goniochrome::prefilter
#endif
