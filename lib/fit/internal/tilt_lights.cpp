#include "fit/internal/tilt_lights.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"

namespace goniochrome::fit {

namespace {

// Lamps have the profile cos^E: 4, 10 and 24 deg of standard deviation, so many of each over the half sphere, and all
// lamps of a kind together count as much. Even light alone is the last kind.
struct Kind {
  double exponent;
  int count;
  double weight;
};
constexpr std::array kKinds = {Kind{200, 240, 0.25}, Kind{32, 120, 0.3}, Kind{5.5, 40, 0.1}};
constexpr int kEven = static_cast<int>(kKinds.size());
constexpr double kEvenWeight = 0.05;

// The share of a lamp in the light on a white surface that faces it.
constexpr double kLampShare = 0.75;

// Lamps without extent show the shape of lobes, and a sum of few sharp lobes as spots. Half of them are spread evenly,
// half as cos^E about the mirror direction, where all that is sharp lies.
constexpr int kPoints = 260;
constexpr double kPointWeight = 0.3, kPointShare = 0.6, kPointExponent = 12;

constexpr int kAngles = 361;  // of blurred lobes, every half degree

double normalization(double exponent) {
  return (exponent + 1) / (2 * kPi);
}

// Points on the half sphere y >= 0, evenly spread (a Fibonacci spiral of twice as many).
std::vector<Vec3> half_sphere(int count) {
  const double turn = kPi * (3 - std::sqrt(5.0));
  std::vector<Vec3> points;
  for (int i = 0; i < 2 * count; ++i) {
    const double z = 1 - (i + 0.5) / count, r = std::sqrt(1 - z * z);
    const Vec3 p{r * std::cos(turn * i), r * std::sin(turn * i), z};
    if (p.y >= 0) points.push_back(p);
  }
  return points;
}

// The integral of two normalized cosine lobes at an angle: the second one at the middle of equal parts of the first.
double overlap(double lamp, double lobe, double angle_rad) {
  constexpr int kLampRings = 40, kSides = 32;
  const Vec3 axis{std::sin(angle_rad), 0, std::cos(angle_rad)};
  double sum = 0;
  for (int i = 0; i < kLampRings; ++i) {
    const double cosine = std::pow((i + 0.5) / kLampRings, 1 / (lamp + 1)), sine = std::sqrt(1 - cosine * cosine);
    for (int j = 0; j < kSides; ++j) {
      const double phi = kPi * (j + 0.5) / kSides;
      const double c = dot(axis, {sine * std::cos(phi), sine * std::sin(phi), cosine});
      if (c > 0) sum += std::pow(c, lobe);
    }
  }
  return normalization(lobe) * sum / (kLampRings * kSides);
}

const color::Xyz& white() {
  static const color::Xyz white = color::xyz_d65_from_rgb({1, 1, 1});
  return white;
}

}  // namespace

Metric::Metric(const std::array<Channels, 3>& rows, double weight) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i; j < 3; ++j) {
      double sum = 0;
      for (const Channels& row : rows) sum += row[i] * row[j];
      q_[kPlace[i][j]] = weight * sum;
    }
  }
}

Metric::Channels Metric::times(const Channels& d) const {
  return {q_[0] * d[0] + q_[1] * d[1] + q_[2] * d[2], q_[1] * d[0] + q_[3] * d[1] + q_[4] * d[2],
          q_[2] * d[0] + q_[4] * d[1] + q_[5] * d[2]};
}

double Metric::squared(const Channels& d) const {
  const Channels q = times(d);
  return d[0] * q[0] + d[1] * q[1] + d[2] * q[2];
}

double Metric::gain(const Channels& slope) const {
  constexpr int kSweeps = 12;
  Channels x{};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t c = 0; c < 3; ++c) {
      if (!(at(c, c) > 0)) continue;
      const Channels q = times(x);
      x[c] = std::max(0.0, x[c] + (slope[c] - q[c]) / at(c, c));
    }
  }
  return 2 * (x[0] * slope[0] + x[1] * slope[1] + x[2] * slope[2]) - squared(x);
}

TiltLights::TiltLights(const std::vector<double>& exponents) : exponents_(exponents) {
  for (int kind = 0; kind < kEven; ++kind) {
    const std::vector<Vec3> centers = half_sphere(kKinds[static_cast<std::size_t>(kind)].count);
    for (const Vec3& center : centers)
      lamps_.push_back(
          {center, kind, kKinds[static_cast<std::size_t>(kind)].weight / static_cast<double>(centers.size())});
  }
  lamps_.push_back({{0, 0, 1}, kEven, kEvenWeight});
  // Cells of equal solid angle.
  constexpr int kRows = 72, kColumns = 60;
  for (int row = 0; row < kRows; ++row) {
    const double z = -1 + 2 * (row + 0.5) / kRows, r = std::sqrt(1 - z * z);
    for (int column = 0; column < kColumns; ++column) {
      const double phi = kPi * (column + 0.5) / kColumns;
      samples_.push_back({{r * std::cos(phi), r * std::sin(phi), z}, 4 * kPi / (kRows * kColumns)});
    }
    if (z < 0) first_above_ = samples_.size();
  }
  kernels_.resize(lamps_.size());
  parallel_for(lamps_.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t m = begin; m < end; ++m) {
      if (lamps_[m].kind == kEven) continue;
      const double exponent = kKinds[static_cast<std::size_t>(lamps_[m].kind)].exponent;
      double sum = 0;
      std::vector<double> values;
      for (const Sample& sample : samples_) {
        double value = 0;
        for (const double side : {1.0, -1.0}) {
          const double c = dot(lamps_[m].center, {sample.direction.x, side * sample.direction.y, sample.direction.z});
          if (c > 0) value += 0.5 * std::pow(c, exponent);
        }
        values.push_back(sample.solid_angle_sr * value);
        sum += values.back();
      }
      for (const double value : values) kernels_[m].push_back(static_cast<float>(value / sum));
    }
  });
  exponents_.push_back(1);
  const std::vector<double>& all = exponents_;
  blurred_.resize(all.size() * kKinds.size());
  parallel_for(blurred_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      for (int a = 0; a < kAngles; ++a)
        blurred_[i].push_back(
            overlap(kKinds[i % kKinds.size()].exponent, all[i / kKinds.size()], kPi * a / (kAngles - 1)));
    }
  });
}

TiltLights::Set TiltLights::lights(double view_deg) const {
  Set set{half_sphere(kPoints)};
  const double in = view_deg * kDegree;
  for (const Vec3& even : half_sphere(kPoints)) {
    // cos^E about the mirror direction: the even one keeps its turn about the axis.
    const double cosine = std::pow(0.5 * (1 + even.z), 1 / (kPointExponent + 1)), sine = std::sqrt(1 - cosine * cosine);
    const double flat = std::hypot(even.x, even.y), x = flat > 0 ? sine * even.x / flat : 0;
    const double y = flat > 0 ? sine * even.y / flat : sine;
    set.points.push_back({x * std::cos(in) + cosine * std::sin(in), y, cosine * std::cos(in) - x * std::sin(in)});
  }
  return set;
}

double TiltLights::weight(const Set& set, std::size_t m) const {
  return m < lamps_.size() ? lamps_[m].weight : kPointWeight / static_cast<double>(set.points.size());
}

double TiltLights::blurred(std::size_t exponent, int kind, double cosine) const {
  const std::vector<double>& table = blurred_[exponent * kKinds.size() + static_cast<std::size_t>(kind)];
  const double at = std::acos(std::clamp(cosine, -1.0, 1.0)) / kPi * (kAngles - 1);
  const int low = std::min(static_cast<int>(at), kAngles - 2);
  const double share = at - low;
  return (1 - share) * table[static_cast<std::size_t>(low)] + share * table[static_cast<std::size_t>(low) + 1];
}

std::vector<color::Rgb> TiltLights::colors(const Set& set,
                                           const std::function<color::Rgb(const Vec3& light)>& f_cos) const {
  return summed(set, f_cos, first_above_);
}
std::vector<color::Rgb> TiltLights::colors_all(const Set& set,
                                               const std::function<color::Rgb(const Vec3& light)>& f_cos) const {
  return summed(set, f_cos, 0);
}

std::vector<color::Rgb> TiltLights::summed(const Set& set, const std::function<color::Rgb(const Vec3& light)>& f_cos,
                                           std::size_t begin) const {
  std::vector<color::Rgb> values;
  color::Rgb even;
  for (std::size_t i = begin; i < samples_.size(); ++i) {
    values.push_back(f_cos(samples_[i].direction));
    even += samples_[i].solid_angle_sr * values.back();
  }
  std::vector<color::Rgb> colors;
  for (std::size_t m = 0; m < lamps_.size(); ++m) {
    if (lamps_[m].kind == kEven) {
      colors.push_back(even);
      continue;
    }
    color::Rgb lit;
    for (std::size_t i = begin; i < samples_.size(); ++i)
      if (kernels_[m][i] > 0) lit += static_cast<double>(kernels_[m][i]) * values[i - begin];
    colors.push_back(kLampShare * kPi * lit + (1 - kLampShare) * even);
  }
  for (const Vec3& point : set.points) {
    const color::Rgb lit = point.z > 0 || begin == 0 ? f_cos(point) : color::Rgb{};
    colors.push_back(kPointShare * kPi * lit + (1 - kPointShare) * even);
  }
  return colors;
}

std::vector<float> TiltLights::column(const Set& set, std::size_t exponent, const Vec3& axis) const {
  std::vector<float> column;
  for (const Lamp& lamp : lamps_) {
    double value = 1;
    if (lamp.kind != kEven) {
      double lit = 0;
      for (const double side : {1.0, -1.0})
        lit += 0.5 * blurred(exponent, lamp.kind, dot(lamp.center, {axis.x, side * axis.y, axis.z}));
      value = kLampShare * kPi * lit + (1 - kLampShare);
    }
    column.push_back(static_cast<float>(value));
  }
  const double power = exponents_[exponent];
  for (const Vec3& point : set.points) {
    double lit = 0;
    for (const double side : {1.0, -1.0}) {
      const double cosine = dot(point, {axis.x, side * axis.y, axis.z});
      if (cosine > 0) lit += 0.5 * std::pow(cosine, power);
    }
    column.push_back(static_cast<float>(kPointShare * kPi * normalization(power) * lit + (1 - kPointShare)));
  }
  return column;
}

// CIEDE2000 of small differences, but for its turns of hue: the differences of lightness, chroma and hue over
// S_L, S_C and S_H = 1, 1 + 0.045 C and 1 + 0.015 C. The derivatives of L*a*b* are taken by differences.
Metric TiltLights::metric(const Set& set, std::size_t m, const color::Rgb& color) const {
  constexpr double kDark = 0.02, kStep = 1e-4, kGray = 1e-3;
  const color::Rgb at{std::max(color.x, kDark), std::max(color.y, kDark), std::max(color.z, kDark)};
  const color::Lab lab = color::lab_from_rgb(at, white());
  const double chroma = std::hypot(lab.a, lab.b);
  const bool gray = chroma < kGray;  // which has no hue: any two directions across each other serve
  const double a = gray ? 1 : lab.a / chroma, b = gray ? 0 : lab.b / chroma;
  std::array<Metric::Channels, 3> rows{};
  for (std::size_t c = 0; c < 3; ++c) {
    color::Rgb moved = at;
    moved[static_cast<int>(c)] *= 1 + kStep;
    const color::Lab to = color::lab_from_rgb(moved, white());
    const double step = kStep * at[static_cast<int>(c)];
    rows[0][c] = (to.L - lab.L) / step;
    rows[1][c] = (a * (to.a - lab.a) + b * (to.b - lab.b)) / step / (1 + 0.045 * chroma);
    rows[2][c] = (a * (to.b - lab.b) - b * (to.a - lab.a)) / step / (1 + 0.015 * chroma);
  }
  return {rows, weight(set, m)};
}

double TiltLights::mean_difference(const Set& set, const std::vector<color::Rgb>& a,
                                   const std::vector<color::Rgb>& b) const {
  double sum = 0;
  for (std::size_t m = 0; m < a.size(); ++m)
    sum += weight(set, m) * color::delta_e_2000(color::lab_from_rgb(a[m], white()), color::lab_from_rgb(b[m], white()));
  return sum;
}

}  // namespace goniochrome::fit
