// A photograph of a plate in perspective, seen straight from the front.
// goniochrome-surfaces(7), "Photographs in perspective".
#pragma once

#include <array>

#include "base/result.h"
#include "capture/photo_table.h"

namespace goniochrome::capture {

// The photograph's pixel of every place of a plate.
class Perspective {
 public:
  // Error, which begins with the name of a corner: corners outside of a photograph of this size, on one line, crossed,
  // or in the wrong order; a k1 by which no lens shows them.
  static Result<Perspective> of(const Corners& corners, int width, int height);

  // u runs from 0 to 1 to the right of the plate, v down.
  ImagePlace at(double u, double v) const;

  // The number of samples along each side of a texel from u, v on: one for each pixel that it covers, 8 at most.
  int samples(double u, double v, double wide, double high) const;

 private:
  ImagePlace distorted(const ImagePlace& straight) const;
  ImagePlace undistorted(const ImagePlace& seen) const;
  ImagePlace scaled(const ImagePlace& from, double factor) const;
  double squared(const ImagePlace& place) const;  // r^2

  ImagePlace middle_;
  double half_diagonal_ = 1, k1_ = 0;
  std::array<double, 8> m_{};  // x = (m0 u + m1 v + m2)/(m6 u + m7 v + 1), y = (m3 u + m4 v + m5)/(...)
};

}  // namespace goniochrome::capture
