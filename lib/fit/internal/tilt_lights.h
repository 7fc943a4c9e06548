// The lights that tilted lobes are fitted in: lamps of several sizes all around, each with some even light beside it.
// goniochrome-interference(7), "TILTED LOBES".
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "base/vec3.h"
#include "color/color.h"

namespace goniochrome::fit {

// A symmetric 3x3 matrix: what a difference of two colors counts, squared, is d^T Q d.
class Metric {
 public:
  using Channels = std::array<double, 3>;

  Metric() = default;
  // The square of a 3x3 matrix: M^T M times a weight.
  Metric(const std::array<Channels, 3>& rows, double weight);

  double at(std::size_t row, std::size_t column) const { return q_[kPlace[row][column]]; }
  void add(double factor, const Metric& other) {
    for (std::size_t i = 0; i < q_.size(); ++i) q_[i] += factor * other.q_[i];
  }
  Channels times(const Channels& d) const;
  double squared(const Channels& d) const;
  // How far x^T Q x - 2 x^T slope falls below 0 for non-negative x.
  double gain(const Channels& slope) const;

 private:
  static constexpr std::size_t kPlace[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  std::array<double, 6> q_{};
};

// Lamps are symmetric pairs about the plane y = 0, or lie in it, since the colors that are compared are symmetric.
class TiltLights {
 public:
  // Columns can then be asked for of these exponents, and of the number behind them, which is that of exponent 1.
  explicit TiltLights(const std::vector<double>& exponents);

  // The lights for a viewer at an angle from the normal: lamps with an extent, even light alone, and lamps without
  // extent, of which half stand close about the mirror direction. A number in all that follows is that of a light.
  struct Set {
    std::vector<Vec3> points;  // of the lamps without extent
  };
  Set lights(double view_deg) const;

  // The colors of f cos_i to a viewer in each light, relative to white; f cos_i is symmetric in y and 0 below the
  // horizon.
  std::vector<color::Rgb> colors(const Set& set, const std::function<color::Rgb(const Vec3& light)>& f_cos) const;
  // Variant with the values of f cos_i below the horizon.
  std::vector<color::Rgb> colors_all(const Set& set, const std::function<color::Rgb(const Vec3& light)>& f_cos) const;
  // The column of a lobe of weight 1 about an axis and the axis at -y, half of each: (E + 1)/(2 pi) cos^E.
  std::vector<float> column(const Set& set, std::size_t exponent, const Vec3& axis) const;
  // The metric of small differences from such a color in light m.
  Metric metric(const Set& set, std::size_t m, const color::Rgb& color) const;
  // The mean color difference over the lights.
  double mean_difference(const Set& set, const std::vector<color::Rgb>& a, const std::vector<color::Rgb>& b) const;

 private:
  struct Lamp {
    Vec3 center;
    int kind = 0;       // by size; the last kind is even light alone
    double weight = 1;  // in sums over lights; together with the points 1
  };
  struct Sample {
    Vec3 direction;
    double solid_angle_sr;  // that it stands for, with its mirror image
  };
  std::vector<color::Rgb> summed(const Set& set, const std::function<color::Rgb(const Vec3& light)>& f_cos,
                                 std::size_t begin) const;
  double blurred(std::size_t exponent, int kind, double cosine) const;
  double weight(const Set& set, std::size_t m) const;

  std::vector<double> exponents_;
  std::vector<Lamp> lamps_;
  std::vector<Sample> samples_;  // below the horizon first
  std::size_t first_above_ = 0;
  std::vector<std::vector<float>> kernels_;   // of each lamp, over the samples, with their solid angles
  std::vector<std::vector<double>> blurred_;  // exponent * kinds + kind: by angle
};

}  // namespace goniochrome::fit
