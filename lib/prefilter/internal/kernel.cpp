#include "prefilter/internal/kernel.h"

#include <algorithm>
#include <cmath>

#include "math/cosine_power.h"
#include "math/quadrature.h"
#include "prefilter/internal/lobe_rows.h"

namespace goniochrome::prefilter {

namespace {

double clamped_angle(double cosine) {
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

// The integral of body(angle) over 0..end radians at `points` Gauss points.
template <class Body>
double over_angles(double end, int points, const Body& body) {
  double sum = 0;
  for (const auto& [x, weight] : math::gauss_legendre(points)) sum += weight * end / 2 * body((x + 1) * end / 2);
  return sum;
}

constexpr int kAngles = 256;  // resolve any kernel up to the 12 widths at which it has fallen to 1e-30

}  // namespace

// ---- What follows from the values of a kernel.

// k_l = 2 pi scale() times the integral of K P_l sin over 0..end. P_l oscillates at most (l + 1) end / (2 pi) times
// there, and Gauss points take pi of themselves to a period; kAngles more are for K. The recursion of P_l rounds: of
// bells of 0.2, 0.05, 0.01 and 0.004 rad it leaves 2e-15, 3e-14, 2e-13 and 3e-13, which is taken as zero.
std::vector<double> ZonalKernel::multipliers(int degree) const {
  const double end = std::min({edge_.angle_rad, support_rad(), kPi});
  const int points = kAngles + static_cast<int>((degree + 1) * end / 2);
  std::vector<double> k(static_cast<std::size_t>(degree) + 1);
  for (const auto& [x, weight] : math::gauss_legendre(points)) {
    const double angle = (x + 1) * end / 2, t = std::cos(angle);
    const double share = weight * end / 2 * 2 * kPi * scale() * value(t) * std::sin(angle);
    double p = 1, before = 0;
    for (int l = 0; l <= degree; ++l) {
      k[static_cast<std::size_t>(l)] += share * p;
      const double next = ((2 * l + 1) * t * p - l * before) / (l + 1);
      before = p, p = next;
    }
  }
  const double rounding = 4e-15 * sharpness();
  for (double& multiplier : k)
    if (std::fabs(multiplier) < rounding) multiplier = 0;
  return k;
}

// The tail falls as a power of l or faster: each octave has the same part of the one before, or less.
double ZonalKernel::tail(const std::vector<double>& k) const {
  double octave[2] = {0, 0};
  for (std::size_t l = k.size() / 4; l < k.size(); ++l)
    octave[l >= k.size() / 2] += (2 * static_cast<double>(l) + 1) * std::fabs(k[l]);
  if (octave[1] == 0) return 0;
  const double ratio = octave[1] / octave[0];
  return ratio < 1 ? octave[1] * ratio / (1 - ratio) : 1e300;
}

// By Parseval: the sum over all l is 4 pi scale()^2 times the integral of K^2.
double ZonalKernel::norm_beyond(int degree) const {
  const double end = std::min({edge_.angle_rad, support_rad(), kPi});
  double square = 8 * kPi * kPi * scale() * scale() * over_angles(end, kAngles, [&](double angle) {
                    const double k = value(std::cos(angle));
                    return k * k * std::sin(angle);
                  });
  const std::vector<double> k = multipliers(degree);
  for (std::size_t l = 0; l < k.size(); ++l) square -= (2 * static_cast<double>(l) + 1) * k[l] * k[l];
  return std::sqrt(std::max(0.0, square));
}

double ZonalKernel::variation(double angle_rad) const {
  const double step = 1e-4 / sharpness();
  const double at = std::clamp(std::min(angle_rad, edge_.angle_rad - 2 * step), step, kPi - step);
  const double near = value(std::cos(at - step)), far = value(std::cos(at + step));
  if (!(far > 0)) return 1e300;
  return std::max(sharpness(), std::log(near / far) / (2 * step));
}

double ZonalKernel::near_edge(double angle_rad) const {
  return value(std::cos(std::max(0.0, edge_.angle_rad - angle_rad)));
}

// Means over 32 x 32 parts, which place a step at the edge to 1/64 of the parallelogram.
double ZonalKernel::linear_mean(double t0, double a, double b) const {
  constexpr int kParts = 32;
  double sum = 0;
  for (int i = 0; i < kParts; ++i)
    for (int j = 0; j < kParts; ++j) sum += value(t0 + a * ((i + 0.5) / kParts - 0.5) + b * ((j + 0.5) / kParts - 0.5));
  return sum / (kParts * kParts);
}

double ZonalKernel::slope(double t, double) const {
  const double step = 1e-4 / (sharpness() * sharpness()), high = std::min(1.0, t + step);
  return (value(high) - value(t - step)) / (high - t + step);
}

// The kernel bends most about its top, so that `high` alone counts where the block is wider than the kernel.
double ZonalKernel::bend(double low, double high, double, double) const {
  constexpr int kParts = 4;
  const double step = 1e-3 / (sharpness() * sharpness());
  double most = 0;
  for (int i = 0; i <= kParts; ++i) {
    const double t = std::min(low + (high - low) * i / kParts, 1 - step);
    most = std::max(most, std::fabs(value(t - step) - 2 * value(t) + value(t + step)) / (step * step));
  }
  return most;
}

namespace {

void add(const float* rgb, double weight, double sum[3]) {
  for (int c = 0; c < 3; ++c) sum[c] += weight * static_cast<double>(rgb[c]);
}

}  // namespace

void ZonalKernel::add_lat_long_row(const float* rgb, std::size_t columns, const double* sine, const double* cosine,
                                   double a, double b, double c, double sum[3]) const {
  for (std::size_t j = 0; j < columns; ++j) add(rgb + 3 * j, value(a + b * sine[j] + c * cosine[j]), sum);
}

void ZonalKernel::add_cube_row(const float* rgb, std::size_t columns, const double* s, const double* weight, double p,
                               double q, double m, double sum[3]) const {
  for (std::size_t j = 0; j < columns; ++j) {
    const double norm = std::sqrt(m + s[j] * s[j]);
    add(rgb + 3 * j, value((p + q * s[j]) / norm) * weight[j] / (norm * norm * norm), sum);
  }
}

void ZonalKernel::add_points(const float* rgb, std::size_t points, const double* x, const double* y, const double* z,
                             const double d[3], double sum[3]) const {
  for (std::size_t j = 0; j < points; ++j) add(rgb + 3 * j, value(d[0] * x[j] + d[1] * y[j] + d[2] * z[j]), sum);
}

NumericKernel::NumericKernel(std::function<double(double angle_rad)> of_angle, double edge_rad)
    : ZonalKernel(edge_rad < kPi ? Edge{std::cos(edge_rad), edge_rad} : Edge{}), of_angle_(std::move(of_angle)) {
  support_rad_ = angle_at(1e-30);
  // A bell exp(-(s angle)^2 / 2) is half as high at sqrt(2 ln 2) / s.
  sharpness_ = std::max(1.0, std::sqrt(2 * std::log(2.0)) / angle_at(0.5));
  scale_ = 1 / (2 * kPi * over_angles(support_rad_, kAngles, [&](double angle) {
                  return value(std::cos(angle)) * std::sin(angle);
                }));
}

double NumericKernel::value(double cosine) const {
  return cosine > edge().cosine ? of_angle_(clamped_angle(cosine)) : 0;
}

// The angle from which on K is below a share of its top: its edge at the latest.
double NumericKernel::angle_at(double share) const {
  double low = 0, high = std::min(edge().angle_rad, kPi);
  if (of_angle_(high) >= share) return high;
  for (int step = 0; step < 60; ++step) {
    const double middle = (low + high) / 2;
    (of_angle_(middle) >= share ? low : high) = middle;
  }
  return high;
}

// ---- The powers of the cosine.

double CosineKernel::value(double cosine) const {
  return math::cosine_power(cosine, exponent_);
}

double CosineKernel::sharpness() const {
  return std::sqrt(std::max(exponent_, 1.0));
}

double CosineKernel::support_rad() const {
  return std::acos(exponent_ > 0 ? std::exp(-69.0 / exponent_) : 0);
}

// From the recursion of integrals of t^E P_l over 0..1: k_l = k_(l-2) (E-l+2)/(E+l+1).
std::vector<double> CosineKernel::multipliers(int degree) const {
  std::vector<double> k(static_cast<std::size_t>(std::max(degree, 1)) + 1);
  k[0] = 1;
  k[1] = (exponent_ + 1) / (exponent_ + 2);
  for (int l = 2; l <= degree; ++l) k[l] = k[l - 2] * (exponent_ - l + 2) / (exponent_ + l + 1);
  k.resize(static_cast<std::size_t>(degree) + 1);
  return k;
}

// |k_l| falls as l^-(E+3/2), so (2l+1)|k_l|, summed, falls as l^-(E-1/2).
double CosineKernel::tail(const std::vector<double>& k) const {
  const double power = exponent_ - 0.5;
  const std::size_t end = k.size() - 1;
  if (power <= 0) return 1e300;
  return (2.0 * static_cast<double>(end) + 1) * std::max(std::fabs(k[end]), std::fabs(k[end - 1])) *
         static_cast<double>(end) / power;
}

double CosineKernel::norm_beyond(int degree) const {
  const int end = degree + 20000;
  const std::vector<double> k = multipliers(end);
  double sum = 0;
  for (int l = degree + 1; l <= end; ++l) sum += (2.0 * l + 1) * k[l] * k[l];
  return std::sqrt(sum);
}

// d/dtheta ln cos^E = -E tan(theta), and near its top the lobe is as wide as 1/sqrt(E).
double CosineKernel::variation(double angle_rad) const {
  return std::max(std::sqrt(exponent_), exponent_ * std::tan(std::min(angle_rad, edge().angle_rad - 1e-9)));
}

double CosineKernel::near_edge(double angle_rad) const {
  return std::pow(std::min(1.0, angle_rad), exponent_);
}

// With F the second antiderivative of the power that is (F(++) - F(+-) - F(-+) + F(--)) / (a b); where t hardly changes
// one way, the first antiderivative's difference.
double CosineKernel::linear_mean(double t0, double a, double b) const {
  const double e = exponent_;
  a = std::fabs(a), b = std::fabs(b);
  if (a < b) std::swap(a, b);
  const auto above = [&](double t, double power) { return t > 0 ? std::pow(t, power) : 0.0; };
  if (a < 1e-14) return value(t0);
  if (b < 1e-5 * a) return (above(t0 + a / 2, e + 1) - above(t0 - a / 2, e + 1)) / ((e + 1) * a);
  const auto corner = [&](double i, double j) { return above(t0 + (i * a + j * b) / 2, e + 2); };
  return (corner(1, 1) - corner(1, -1) - corner(-1, 1) + corner(-1, -1)) / ((e + 1) * (e + 2) * a * b);
}

double CosineKernel::bend(double low, double high, double least, double most) const {
  const double e = exponent_;
  return e * std::fabs(e - 1) * std::max(least / (low * low), most / (high * high));
}

void CosineKernel::add_lat_long_row(const float* rgb, std::size_t columns, const double* sine, const double* cosine,
                                    double a, double b, double c, double sum[3]) const {
  rows::add_lat_long_row(rgb, columns, sine, cosine, a, b, c, exponent_, sum);
}

void CosineKernel::add_cube_row(const float* rgb, std::size_t columns, const double* s, const double* weight, double p,
                                double q, double m, double sum[3]) const {
  rows::add_cube_row(rgb, columns, s, weight, p, q, m, exponent_, sum);
}

void CosineKernel::add_points(const float* rgb, std::size_t points, const double* x, const double* y, const double* z,
                              const double d[3], double sum[3]) const {
  rows::add_points(rgb, points, x, y, z, d, exponent_, sum);
}

}  // namespace goniochrome::prefilter
