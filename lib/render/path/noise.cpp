#include "render/path/noise.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "math/statistics.h"
#include "render/path/sequence.h"

namespace goniochrome::render {

namespace {

// The rows of working space to XYZ, each divided by that of white.
const std::array<Vec3, 3>& relative_xyz_rows() {
  static const std::array<Vec3, 3> rows = [] {
    std::array<Vec3, 3> result;
    const color::Xyz white = color::xyz_d65_from_rgb({1, 1, 1});
    for (int c = 0; c < 3; ++c) {
      const color::Xyz xyz = color::xyz_d65_from_rgb({c == 0 ? 1.0 : 0.0, c == 1 ? 1.0 : 0.0, c == 2 ? 1.0 : 0.0});
      result[0][c] = xyz.X / white.X, result[1][c] = xyz.Y / white.Y, result[2][c] = xyz.Z / white.Z;
    }
    return result;
  }();
  return rows;
}

// f of CIELAB and its derivative.
struct Curve {
  double value, slope;
};
Curve lab_curve(double t) {
  constexpr double kKnee = 216.0 / 24389;
  if (t <= kKnee) return {t * (841.0 / 108) + 4.0 / 29, 841.0 / 108};
  const double root = std::cbrt(t);
  return {root, root / (3 * t)};
}

// Functions of angles in degrees.
constexpr double kCos30 = 0.8660254037844387, kCos6 = 0.9945218953682733, kSin6 = 0.10452846326765347,
                 kCos63 = 0.45399049973954675, kSin63 = 0.8910065241883678;

double variance_along(const Vec3& v, const Covariance& c) {
  return v.x * v.x * c[0] + v.y * v.y * c[1] + v.z * v.z * c[2] +
         2 * (v.x * v.y * c[3] + v.x * v.z * c[4] + v.y * v.z * c[5]);
}

}  // namespace

Covariance Estimates::covariance() const {
  Covariance result{};
  if (count_ < 2) return result;
  const double n = count_;
  const double products[6] = {sum_.x * sum_.x, sum_.y * sum_.y, sum_.z * sum_.z,
                              sum_.x * sum_.y, sum_.x * sum_.z, sum_.y * sum_.z};
  for (std::size_t i = 0; i < 6; ++i) result[i] = (squares_[i] - products[i] / n) / (n - 1);
  for (std::size_t i = 0; i < 3; ++i) result[i] = std::max(result[i], 0.0);
  return result;
}

// L, a and b are linear in the error to first order: dL = 116 f'(Y) dY and so on. CIEDE2000 weighs it along L, chroma
// and hue by the S functions; its a' = (1 + G) a stretches grays.
SeenRows::SeenRows(const color::Rgb& radiance, double white_luminance) {
  const auto& xyz = relative_xyz_rows();
  const double scale = 1 / white_luminance;
  Curve f[3];
  Vec3 gradient[3];
  for (std::size_t i = 0; i < 3; ++i) {
    f[i] = lab_curve(scale * dot(xyz[i], radiance));
    gradient[i] = (scale * f[i].slope) * xyz[i];
  }
  const double lightness = 116 * f[1].value - 16, a = 500 * (f[0].value - f[1].value),
               b = 200 * (f[1].value - f[2].value), c2 = a * a + b * b, c7 = c2 * c2 * c2 * std::sqrt(c2);
  const double stretch = 1.5 - 0.5 * std::sqrt(c7 / (c7 + 6103515625.0)), a_prime = stretch * a,
               chroma = std::sqrt(a_prime * a_prime + b * b);
  const Vec3 d_lightness = 116.0 * gradient[1], d_a = (500 * stretch) * (gradient[0] - gradient[1]),
             d_b = 200.0 * (gradient[1] - gradient[2]);
  // Functions of the hue h; without chroma every direction is both.
  const double cosine = chroma > 1e-9 ? a_prime / chroma : 1, sine = chroma > 1e-9 ? b / chroma : 0;
  const double cos_2h = cosine * cosine - sine * sine, sin_2h = 2 * sine * cosine,
               cos_3h = cos_2h * cosine - sin_2h * sine, sin_3h = sin_2h * cosine + cos_2h * sine,
               cos_4h = cos_2h * cos_2h - sin_2h * sin_2h, sin_4h = 2 * sin_2h * cos_2h;
  // 1 - .17 cos(h - 30) + .24 cos(2 h) + .32 cos(3 h + 6) - .2 cos(4 h - 63 deg)
  const double t = 1 - 0.17 * (kCos30 * cosine + 0.5 * sine) + 0.24 * cos_2h +
                   0.32 * (kCos6 * cos_3h - kSin6 * sin_3h) - 0.2 * (kCos63 * cos_4h + kSin63 * sin_4h);
  const double l50 = (lightness - 50) * (lightness - 50);
  const double s_l = 1 + 0.015 * l50 / std::sqrt(20 + l50), s_c = 1 + 0.045 * chroma, s_h = 1 + 0.015 * chroma * t;
  const Vec3 d_chroma = cosine * d_a + sine * d_b, d_hue = cosine * d_b - sine * d_a;
  rows = {(1 / s_l) * d_lightness, (1 / s_c) * d_chroma, (1 / s_h) * d_hue};
}

double noise_de00(const color::Rgb& radiance, const Covariance& covariance, double white_luminance) {
  double variance = 0;
  for (const Vec3& row : SeenRows(radiance, white_luminance).rows) variance += variance_along(row, covariance);
  return std::sqrt(std::max(0.0, variance));
}

// Errors are drawn, normal numbers by Box and Muller's transform. Their percentile has an error below a hundredth.
double largest_errors(const std::vector<double>& deviations, const std::vector<double>& beside) {
  constexpr std::uint32_t kDrawn = 1U << 15;
  if (deviations.empty()) return 0;
  const auto any = [](const std::vector<double>& of, double number) {
    return of.empty() ? 0 : of[static_cast<std::size_t>(number * static_cast<double>(of.size()))];
  };
  const Sequence::Set draws = Sequence(1, kDrawn).set(0);
  std::vector<double> sizes(kDrawn);
  for (std::uint32_t i = 0; i < kDrawn; ++i) {
    const auto [point, other, u, v] = draws.point(i);
    const double normal = std::sqrt(-2 * std::log(1 - u)) * std::cos(2 * kPi * v);
    sizes[i] = std::hypot(any(deviations, point) * normal, any(beside, other));
  }
  return math::percentile_95(std::move(sizes));
}

void PointErrors::add(const PointErrors& more) {
  mesh.insert(mesh.end(), more.mesh.begin(), more.mesh.end());
  floor.insert(floor.end(), more.floor.begin(), more.floor.end());
}

TotalErrors total_errors(const PointErrors& points, const std::vector<double>& beside, double stopped_de00) {
  const double on_floor = largest_errors(points.floor);
  return {std::max(largest_errors(points.mesh), on_floor),
          std::hypot(std::max(largest_errors(points.mesh, beside), on_floor), stopped_de00)};
}

}  // namespace goniochrome::render
