// Where on a map each surface lies.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/result.h"
#include "image/image.h"
#include "tool.h"

namespace goniochrome::tool {

// A gray picture, from 0 to 1 as it is stored.
class Mask {
 public:
  // Takes alpha where `alpha` is set and the picture has one, else the mean of the colors. Error: not a picture, or a
  // value that is not finite.
  static Result<Mask> read(const std::string& path, bool alpha, bool invert);

  int width() const { return gray_.width; }
  int height() const { return gray_.height; }
  // Calls take(value, share) for the pixels at a place from 0 to 1, u to the right and v up: the nearest one, or the
  // four around it.
  template <class Take>
  void at(double u, double v, bool smooth, const Take& take) const {
    const double x = u * width(), y = (1 - v) * height();
    if (!smooth) {
      take(pixel(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y))), 1.0);
      return;
    }
    const double left = std::floor(x - 0.5), top = std::floor(y - 0.5), s = x - 0.5 - left, t = y - 0.5 - top;
    for (const int i : {0, 1})
      for (const int j : {0, 1})
        take(pixel(static_cast<int>(left) + i, static_cast<int>(top) + j), (i ? s : 1 - s) * (j ? t : 1 - t));
  }

 private:
  // Beyond the edge, the pixel at the edge.
  double pixel(int x, int y) const {
    return *gray_.pixel(std::clamp(x, 0, gray_.width - 1), std::clamp(y, 0, gray_.height - 1));
  }
  image::Image gray_;
};

// A number, or a mask.
class Amount {
 public:
  // "" is 0. Error: as Mask::read(); a number that is not 0 to 1.
  static Result<Amount> parse(const std::string& option, const std::string& text);
  bool empty() const { return value_ == 0 && !mask_; }
  double at(double u, double v) const;

 private:
  double value_ = 0;
  std::shared_ptr<const Mask> mask_;
};

// The number of a surface and its share.
using Shares = std::vector<std::pair<std::size_t, double>>;

class Pattern {
 public:
  // Error: options that contradict each other or do not suit so many surfaces; a mask that cannot be read.
  static Result<Pattern> create(const Options& options, std::size_t surfaces);

  // The size that the mask of the whole map has, or 0 x 0.
  std::pair<int, int> size() const;
  // One sentence.
  std::string told() const;
  // The shares of one texel, of sum 1, none of them 0.
  Shares shares(int column, int row, int width, int height) const;

 private:
  enum class Kind { kPlain, kStripe, kGradient, kMask, kDecal, kMosaic, kMix };
  Pattern() = default;
  // `aspect` is the width of the map over its height.
  void add(double u, double v, double aspect, double share, std::vector<double>& shares) const;
  void add_value(double value, double share, std::vector<double>& shares) const;

  Kind kind_ = Kind::kPlain;
  std::size_t surfaces_ = 1;
  std::vector<double> numbers_;  // of --stripe, or the shares of --mix
  int columns_ = 1;
  double cosine_ = 1, sine_ = 0;
  double center_x_ = 0.5, center_y_ = 0.5, wide_ = 0.5;
  std::shared_ptr<const Mask> mask_;
};

}  // namespace goniochrome::tool
