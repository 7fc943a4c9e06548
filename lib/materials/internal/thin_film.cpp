// [BelcourBarla2017], in the form that the extension states: Schlick's reflectances in the place of Fresnel's, no
// polarization, and the integral over wavelengths in the space of Fourier, where the color matching functions are sums
// of Gaussians.
#include "materials/internal/thin_film.h"

#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "materials/internal/ggx.h"

namespace goniochrome::materials {

namespace {

double square(double x) {
  return x * x;
}

double normal_reflectance(double index, double outer) {
  return square((index - outer) / (index + outer));
}

double rising(double normal, double cosine) {
  return std::lerp(normal, 1.0, schlick(cosine));
}

// XYZ, relative to Y of white, of an interference at that difference of optical paths and that phase. The phases of the
// three channels differ, and the extension takes each channel of XYZ with the phase of the channel of RGB at its place.
struct Gaussian {
  double value, position, variance;
};
double transformed(const Gaussian& g, double phase, double shift) {
  return g.value * std::sqrt(2 * kPi * g.variance) * std::cos(g.position * phase + shift) *
         std::exp(-square(phase) * g.variance);
}
color::Rgb interference(double path_nm, const Vec3& shift) {
  constexpr Gaussian kX = {5.4856e-13, 1.6810e+06, 4.3278e+09}, kX2 = {9.7470e-14, 2.2399e+06, 4.5282e+09},
                     kY = {4.4201e-13, 1.7953e+06, 9.3046e+09}, kZ = {5.2481e-13, 2.2084e+06, 6.6121e+09};
  constexpr double kScale = 1.0685e-7;
  const double phase = 2 * kPi * path_nm * 1e-9;
  const double x = (transformed(kX, phase, shift.x) + transformed(kX2, phase, shift.x)) / kScale;
  const double y = transformed(kY, phase, shift.y) / kScale, z = transformed(kZ, phase, shift.z) / kScale;
  // The matrix of the extension.
  return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
          0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

}  // namespace

color::Rgb film_reflectance(double film_index, double film_nm, const color::Rgb& base, double cosine) {
  const double inside2 = 1 - (1 - square(cosine)) / square(film_index);
  if (inside2 < 0) return {1, 1, 1};
  const double inside = std::sqrt(inside2);
  const double outer = rising(normal_reflectance(film_index, 1), cosine), through = 1 - outer;
  const double outer_phase = film_index < 1 ? 0 : kPi;
  Vec3 phase;
  color::Rgb both, series, sum;
  for (int c = 0; c < 3; ++c) {
    constexpr double kGuard = 1e-4;  // of the extension, against a base that reflects all
    const double root = std::sqrt(std::min(base[c] + kGuard, 1 - 1e-9)), index = (1 + root) / (1 - root);
    const double inner = rising(normal_reflectance(index, film_index), inside);
    phase[c] = outer_phase + (index < film_index ? kPi : 0);
    both[c] = std::clamp(outer * inner, 1e-5, 0.9999);
    const double reflected = square(through) * inner / (1 - both[c]);
    sum[c] = outer + reflected;
    series[c] = reflected - through;
  }
  const double path_nm = 2 * film_index * film_nm * inside;
  for (int order = 1; order <= 2; ++order) {
    const color::Rgb seen = interference(order * path_nm, order * phase);
    for (int c = 0; c < 3; ++c) {
      series[c] *= std::sqrt(both[c]);
      sum[c] += 2 * series[c] * seen[c];
    }
  }
  for (int c = 0; c < 3; ++c) sum[c] = std::max(sum[c], 0.0);
  return sum;
}

}  // namespace goniochrome::materials
