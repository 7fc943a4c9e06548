#include "prefilter/internal/harmonics.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "math/fft.h"
#include "math/legendre.h"
#include "prefilter/internal/harmonic_grid.h"

// A lat-long map is constant on cells, so its Fourier moments along a row are a discrete transform times a sinc,
// exactly; and along a column, too:
//   f_m(row) = sum over columns of f exp(-i m p_j) (2 pi/W) sinc(m pi/W)
//   c_mn     = sum over rows of f_m exp(-i n t_r) (pi/H) sinc(n pi/2H) = integral of f_m(t) exp(-i n t) dt.
// sin(t) P_lm(t) is a trigonometric polynomial of degree l+1 on the full circle, so its integral against f_m is its sum
// over M >= 2L+3 equal steps times the low-pass g_m(t) = sum over |n| <= L+1 of c_mn exp(i n t), divided by M. Beyond
// the poles P_lm goes on as (-1)^m P_lm(2 pi - t), which folds the circle onto the rings of one half.

namespace goniochrome::prefilter {

namespace {

constexpr std::size_t kTransformedAtOnce = 16;  // 48 real series, two to a complex one
constexpr std::size_t kOrdersAtOnce = 8;        // 24 complex series

double sinc(double x) {
  return std::fabs(x) < 1e-8 ? 1 : std::sin(x) / x;
}

struct Complex {
  double re = 0, im = 0;
};
Complex operator*(const Complex& a, const Complex& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
Complex turn(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

// f_m of every row: [m][row][re R G B im R G B], some rows at a time.
UnsetArray<double> row_moments(const envmap::Environment& env, int degree, const envmap::Clip& clip) {
  const std::size_t width = static_cast<std::size_t>(env.width()), height = static_cast<std::size_t>(env.height());
  UnsetArray<double> moments(static_cast<std::size_t>(degree + 1) * height * 6);
  const math::Fft fft(width);
  parallel_for(height, kTransformedAtOnce, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t kReals = 3 * kTransformedAtOnce;
    math::Block block(width, kReals / 2);
    // Step 1: the channels of the rows, two to a complex series.
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t j = 0; j < width; ++j) {
        const std::array<float, 3> rgb = clip.left_of(env.radiance(static_cast<int>(j), static_cast<int>(row)));
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t series = 3 * (row - begin) + c;
          std::vector<double>& part = series % 2 == 0 ? block.re : block.im;
          part[j * block.lanes + series / 2] = rgb[c];
        }
      }
    // Step 2: transforms; the frequency m beyond the width is an alias that the sinc weighs.
    block.transform(fft, -1);
    for (int m = 0; m <= degree; ++m) {
      const double angle = kPi * m / static_cast<double>(width);
      const Complex phase = turn(-angle);
      const double scale = 2 * kPi / static_cast<double>(width) * sinc(angle);
      const std::size_t up = static_cast<std::size_t>(m) % width * block.lanes;
      const std::size_t down = (width - static_cast<std::size_t>(m) % width) % width * block.lanes;
      for (std::size_t row = begin; row < end; ++row)
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t series = 3 * (row - begin) + c, lane = series / 2;
          // Z = X + iY of two real series: X = (Z_m + conj Z_-m)/2, Y = (Z_m - conj Z_-m)/(2i).
          const Complex z = {block.re[up + lane], block.im[up + lane]};
          const Complex w = {block.re[down + lane], -block.im[down + lane]};
          const Complex x = series % 2 == 0 ? Complex{(z.re + w.re) / 2, (z.im + w.im) / 2}
                                            : Complex{(z.im - w.im) / 2, (w.re - z.re) / 2};
          const Complex f = phase * x;
          double* to = &moments[(static_cast<std::size_t>(m) * height + row) * 6];
          to[c] = scale * f.re;
          to[3 + c] = scale * f.im;
        }
    }
  });
  return moments;
}

// The rings on which the Legendre functions are summed, and how a series on the full circle folds onto them.
struct RingCircle {
  std::size_t circle, half;
  std::vector<double> theta;  // of the northern rings
  math::Rings rings;

  explicit RingCircle(int degree)
      : circle(math::fast_length(static_cast<std::size_t>(2 * degree + 4), 4)),
        half(circle / 2),
        theta(northern(circle)),
        rings(theta) {}

 private:
  static std::vector<double> northern(std::size_t circle) {
    std::vector<double> angles(circle / 4);
    for (std::size_t i = 0; i < angles.size(); ++i)
      angles[i] = 2 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(circle);
    return angles;
  }
};

// a_lm of one order from g on the full circle (lane `lane` on, three channels): the weight sin t belongs to a density
// in t and p and changes sign beyond the poles; a density in solid angle has none.
void sum_order(const RingCircle& on, const math::Block& g, std::size_t lane, int m, bool by_angle,
               Harmonics& harmonics) {
  const std::size_t count = on.rings.count;
  std::vector<double> even(6 * count, 0.0), odd(6 * count, 0.0);
  const double fold = (m % 2 == 0) == by_angle ? -1 : 1;
  for (std::size_t i = 0; i < on.theta.size(); ++i) {
    const double weight = (by_angle ? std::sin(on.theta[i]) : 1) / static_cast<double>(on.circle);
    const std::size_t north = i * g.lanes, south = (on.half - 1 - i) * g.lanes;
    const std::size_t north_back = (on.circle - 1 - i) * g.lanes, south_back = (on.half + i) * g.lanes;
    for (std::size_t c = 0; c < 6; ++c) {
      const std::vector<double>& part = c < 3 ? g.re : g.im;
      const std::size_t j = lane + c % 3;
      const double up = part[north + j] + fold * part[north_back + j];
      const double under = part[south + j] + fold * part[south_back + j];
      even[c * count + i] = weight * (up + under);
      odd[c * count + i] = weight * (up - under);
    }
  }
  math::legendre_sums(on.rings, m, harmonics.degree, even.data(), odd.data(), harmonics.order(m));
}

// Moments along the rows, and how their rows lie on the circle.
struct RowMoments {
  UnsetArray<double> values;         // [m][row][re R G B im R G B]
  std::size_t rows = 0, circle = 0;  // `rows` equal steps of a circle of `circle`
  std::ptrdiff_t first = 0;          // the step of row 0
  double offset = 0;                 // of a row's angle within its step, in steps
  std::vector<double> scale;         // what the moment of frequency |n| is multiplied by
  bool by_angle = false;             // a density in angles, not in solid angle
};

// The coefficients from the moments along the rows, some orders at a time.
Harmonics harmonics_from(const RowMoments& moments, int degree) {
  const RingCircle on(degree);
  const math::Fft down(moments.circle), back(on.circle);
  Harmonics harmonics(degree);
  parallel_for(static_cast<std::size_t>(degree + 1), kOrdersAtOnce, [&](std::size_t begin, std::size_t end) {
    constexpr std::size_t kLanes = 3 * kOrdersAtOnce;
    math::Block column(moments.circle, kLanes), low(on.circle, kLanes);
    const int steps = static_cast<int>(moments.circle), rings = static_cast<int>(on.circle);
    // Step 1: the rows where they lie on the full circle of the polar angle.
    for (std::size_t m = begin; m < end; ++m)
      for (std::size_t row = 0; row < moments.rows; ++row) {
        const std::size_t at =
            static_cast<std::size_t>((static_cast<std::ptrdiff_t>(row) + moments.first + steps) % steps) * kLanes;
        for (std::size_t c = 0; c < 3; ++c) {
          const double* from = &moments.values[(m * moments.rows + row) * 6];
          column.re[at + 3 * (m - begin) + c] += from[c];
          column.im[at + 3 * (m - begin) + c] += from[3 + c];
        }
      }
    // Step 2: c_mn, the moments along the columns.
    column.transform(down, -1);
    // Step 3: the low-pass g_m on the circle of rings.
    const int last = degree + 1;
    for (int n = -last; n <= last; ++n) {
      const Complex factor = turn(kPi * n / rings - 2 * kPi * n * moments.offset / steps);
      const double scale = moments.scale[static_cast<std::size_t>(std::abs(n))];
      const std::size_t from = static_cast<std::size_t>((n % steps + steps) % steps) * kLanes;
      const std::size_t to = static_cast<std::size_t>((n + rings) % rings) * kLanes;
      for (std::size_t j = 0; j < kLanes; ++j) {
        const Complex g = factor * Complex{column.re[from + j], column.im[from + j]};
        low.re[to + j] = scale * g.re;
        low.im[to + j] = scale * g.im;
      }
    }
    low.transform(back, 1);
    // Step 4: sums of g_m P_lm over the rings.
    for (std::size_t m = begin; m < end; ++m)
      sum_order(on, low, 3 * (m - begin), static_cast<int>(m), moments.by_angle, harmonics);
  });
  return harmonics;
}

}  // namespace

Harmonics harmonics_of(const envmap::Environment& env, const std::vector<double>& k, const envmap::Clip& clip) {
  const int degree = static_cast<int>(k.size()) - 1;
  RowMoments moments;
  if (env.layout() == envmap::Environment::Layout::kLatLong) {
    moments.values = row_moments(env, degree, clip);
    moments.rows = static_cast<std::size_t>(env.height());
    moments.circle = 2 * moments.rows;
    moments.offset = 0.5;
    moments.by_angle = true;
    for (int n = 0; n <= degree + 1; ++n)
      moments.scale.push_back(kPi / env.height() * sinc(kPi * n / (2.0 * env.height())));
  } else {
    ScatteredMoments scattered = scattered_moments(env, k, clip);
    moments.values = std::move(scattered.values);
    moments.rows = scattered.rows;
    moments.circle = scattered.circle;
    moments.first = scattered.first_row;
    moments.scale = std::move(scattered.scale);
  }
  return harmonics_from(moments, degree);
}

namespace {

// The sums over l > degree of (2l+1)|k_l|, for degree = 0..most.
std::vector<double> truncation_bounds(const ZonalKernel& kernel, int most) {
  const int end = most + 2000;
  const std::vector<double> k = kernel.multipliers(end);
  double tail = kernel.tail(k);
  std::vector<double> bounds(static_cast<std::size_t>(most) + 1);
  for (int l = end; l >= 0; --l) {
    if (l <= most) bounds[l] = tail;
    tail += (2.0 * l + 1) * std::fabs(k[l]);
  }
  return bounds;
}

}  // namespace

double truncation_bound(const ZonalKernel& kernel, int degree) {
  return truncation_bounds(kernel, degree).back();
}

int sufficient_degree(const ZonalKernel& kernel, double error, int most) {
  const std::vector<double> bounds = truncation_bounds(kernel, most);
  for (int l = 0; l <= most; ++l)
    if (bounds[l] <= error) return l;
  return -1;
}

}  // namespace goniochrome::prefilter
