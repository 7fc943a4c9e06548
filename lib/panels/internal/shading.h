// The color of a reflectance under a cosine, for numbers and for derivatives (Ceres' Jets) alike.
// goniochrome-panels(7), "GONIOGEOMETRIC INDEX".
#pragma once

#include <array>
#include <cmath>

namespace goniochrome::panels {

constexpr double kResponseKnee = 6.0 / 29;  // of the CIELAB response f, where its cube root begins

// The CIELAB response of c times the stimulus whose response is f. On the cube root it scales by k = cbrt(c), whatever
// the white; below the knee it is a straight line.
template <class T>
T scaled_response(const T& f, double c, double k) {
  if (f > kResponseKnee && k * f > kResponseKnee) return k * f;
  const T line = f > kResponseKnee ? f * f * f / (3 * kResponseKnee * kResponseKnee) : f - 4.0 / 29;
  const T scaled = c * line + 4.0 / 29;
  if (c > 1 && scaled > kResponseKnee) {  // what was below the knee is lifted above it
    using std::cbrt;
    return cbrt(3 * kResponseKnee * kResponseKnee * (scaled - 4.0 / 29));
  }
  return scaled;
}

// L*, a*, b* of c times the stimulus whose Lab is `lab`; k = cbrt(c).
template <class T>
std::array<T, 3> shaded_lab(const std::array<T, 3>& lab, double c, double k) {
  const T fy = (lab[0] + 16.0) / 116.0;
  const T x = scaled_response<T>(fy + lab[1] / 500.0, c, k), y = scaled_response<T>(fy, c, k),
          z = scaled_response<T>(fy - lab[2] / 200.0, c, k);
  return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

}  // namespace goniochrome::panels
