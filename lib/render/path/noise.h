// How visible the random error of a radiance is. goniochrome-paths(7), "PATHS".
#pragma once

#include <array>
#include <vector>

#include "color/color.h"

namespace goniochrome::render {

// The covariance of three channels: rr gg bb rg rb gb.
using Covariance = std::array<double, 6>;

// Independent estimates of one radiance, one after the other: their mean, and how they scatter. What is summed are
// their differences from the first, so that few digits cancel.
class Estimates {
 public:
  void add(const color::Rgb& value) {
    if (count_++ == 0) first_ = value;
    const color::Rgb d = value - first_;
    sum_ += d;
    squares_[0] += d.x * d.x, squares_[1] += d.y * d.y, squares_[2] += d.z * d.z;
    squares_[3] += d.x * d.y, squares_[4] += d.x * d.z, squares_[5] += d.y * d.z;
  }
  int count() const { return count_; }
  color::Rgb mean() const { return count_ > 0 ? first_ + (1.0 / count_) * sum_ : color::Rgb{}; }
  // The covariance of a single estimate; that of their mean is smaller by count(). 0 where there are fewer than two.
  Covariance covariance() const;

 private:
  color::Rgb first_, sum_;
  Covariance squares_{};
  int count_ = 0;
};

// CIEDE2000 near a radiance, as seen before a diffuse white of this luminance, to first order: the square of a small
// difference is the sum of the squares of its products with three rows. The rotation term of blues, which is worth a
// few percent, is left out.
struct SeenRows {
  std::array<Vec3, 3> rows = {};  // along lightness, chroma and hue

  SeenRows(const color::Rgb& radiance, double white_luminance);
  // The products: their length is that of the difference.
  Vec3 along(const color::Rgb& difference) const {
    return {dot(rows[0], difference), dot(rows[1], difference), dot(rows[2], difference)};
  }
};

// The root mean square CIEDE2000 difference between a radiance and the same with a small random error of this
// covariance, by SeenRows.
double noise_de00(const color::Rgb& radiance, const Covariance& covariance, double white_luminance);

// The size that errors exceed at 5 of 100 points, where the errors of each are normal with such a standard deviation,
// along one direction of color as those of light mostly are. Independent of them each point has one of the errors
// `beside`, across that direction; none: nothing.
double largest_errors(const std::vector<double>& deviations, const std::vector<double>& beside = {});
// They were about so many standard deviations of the noisiest points, in four pictures.
constexpr double kDeviations = 1.4;

// Errors of points of the mesh and of the floor, CIEDE2000, one standard deviation.
struct PointErrors {
  std::vector<double> mesh, floor;

  void add(const PointErrors& more);
};

// largest_errors() over the mesh or over the floor, whichever is larger.
struct TotalErrors {
  double noise = 0;  // that samples leave
  double all = 0;    // with what the mesh of the picture has `beside` it, and with the shares of light that stopped
};
TotalErrors total_errors(const PointErrors& points, const std::vector<double>& beside, double stopped_de00);

}  // namespace goniochrome::render
