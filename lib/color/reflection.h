// Reflection of colored light without spectra. Light and reflectance are often multiplied channel by channel; here each
// channel of the result depends on all channels of both, by a bilinear product. goniochrome-color(7), "COLORED LIGHT";
// [GranierDamez2004]
#pragma once

#include <array>
#include <span>

#include "base/result.h"
#include "color/color.h"

namespace goniochrome::color {

// The 27 coefficients of C_c = sum_d sum_e k[c][d][e] A_d B_e. All operators made here have two properties: k is
// symmetric in d and e, so that light and reflectance may trade places, and it is coherent, sum_e k[c][d][e] = (c ==
// d), so that white light changes nothing.
struct ReflectionOperator {
  std::array<std::array<std::array<double, 3>, 3>, 3> k{};
};

// k[c][c][c] = 1, all else 0: each channel by itself.
ReflectionOperator component_wise();

// The default for rendering: fitted in the working space to published reflectances and lights (scripts/fit-operator),
// so that the mean CIEDE2000 difference from spectral rooms is small. reflection_evidence_test.cpp holds its error
// on spectra that were held out beside that of every other operator here.
ReflectionOperator fitted_operator();

// The table of [GranierDamez2004] 5.3 for the sensors of ISO 17321, made coherent beyond its printed digits. It is
// applied to working-space values as they are, although it was made for other primaries.
ReflectionOperator iso_rgb_operator();

// The table in its own primaries, those of Rec.709: both colors are taken there, and the product is taken back.
ReflectionOperator iso_rec709_operator();

// The operator of the working space, linear Rec.2020, estimated from the CIE 1931 color-matching functions. Its
// primaries are nearly monochromatic: red in cyan light goes negative there, where red of Rec.709 in its cyan stays
// red.
ReflectionOperator working_space_operator();

// A (x) B. White is (1,1,1).
constexpr Rgb reflected(const ReflectionOperator& op, const Rgb& a, const Rgb& b) {
  Rgb c;
  for (int i = 0; i < 3; ++i)
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e) c[i] += op.k[i][d][e] * a[d] * b[e];
  return c;
}

// The matrix of B -> A (x) B, rows by output channel.
using Matrix3 = std::array<std::array<double, 3>, 3>;
Matrix3 reflection_matrix(const ReflectionOperator& op, const Rgb& a);
Rgb product(const Matrix3& m, const Rgb& b);

// Beyond this condition number a division is refused: a relative error of 1e-4 would become 1.
constexpr double kWorstCondition = 1e4;

// The inverse of a matrix and its condition number in the 1-norm, infinite where it is singular (then the inverse is
// 0).
struct Inverse3 {
  Matrix3 matrix{};
  double condition = 0;
};
Inverse3 inverse(const Matrix3& m);

// C (/) A: the B with A (x) B = C. Error: the condition number of A, where it is beyond kWorstCondition.
Result<Rgb> divided(const ReflectionOperator& op, const Rgb& c, const Rgb& a);

// The change of every color of an image from one illuminant to another: divide by `from`, multiply by `to`. Error: the
// condition number of `from`.
struct Relighting {
  Matrix3 matrix{};
  double condition = 0;
};
Result<Relighting> relighting(const ReflectionOperator& op, const Rgb& from, const Rgb& to);

// How much each channel receives from the others, 0..1 and beyond: k_iii = 1 - alpha_i, the other k[i] scaled to stay
// coherent. alpha_i = 0 is the component-wise product of channel i. Error: alpha_i is not 0 where k_iii = 1.
Result<ReflectionOperator> with_transfer(const ReflectionOperator& op, const Rgb& alpha);

// The nearest operator (least squares) that is symmetric and coherent.
ReflectionOperator nearest_coherent(const ReflectionOperator& op);

// The operator of a color space from its color-matching functions, sampled at equal steps of wavelength, each scaled to
// sum 1. Error: fewer than three samples, or functions that depend on each other.
Result<ReflectionOperator> estimated_operator(std::span<const Rgb> color_matching);

// The primaries and the white of an RGB space, as CIE 1931 chromaticities x and y.
struct Primaries {
  std::array<std::array<double, 2>, 3> rgb{};  // of red, green and blue
  std::array<double, 2> white{};
};
constexpr Primaries kRec709 = {{{{0.640, 0.330}, {0.300, 0.600}, {0.150, 0.060}}}, {0.3127, 0.3290}};
constexpr Primaries kRec2020 = {{{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}}, {0.3127, 0.3290}};

// The operator on working-space values that does what `op` does on values of another space. A white other than D65 is
// adapted by Bradford's transform. Error: primaries on one line, or a chromaticity with y of 0 or less.
Result<ReflectionOperator> in_working_space(const ReflectionOperator& op, const Primaries& source);

}  // namespace goniochrome::color
