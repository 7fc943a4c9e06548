// Reflection of colored light without spectra. Light and reflectance are often multiplied channel by channel; here each
// channel of the result depends on all channels of both, by a bilinear product. This header also reads and writes the
// files of such products. goniochrome-theory(7), COLORED LIGHT; [GranierDamez2004]
#pragma once

#include <array>
#include <span>
#include <string>

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

// The table of [GranierDamez2004] 5.3 for the sensors of ISO 17321, made coherent beyond its printed digits. The
// default for rendering, on working-space values as they are.
ReflectionOperator iso_rgb_operator();

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

// The operator as the text of a JSON file, {"k": [[[..3..],[..],[..]], [..], [..]]}, by output channel and then by both
// colors. The numbers have the fewest digits that read back as the same numbers.
std::string reflection_json(const ReflectionOperator& op);

// Reads such a file. Error: the file, and what is missing; or the row in which an operator is not symmetric and
// coherent to 1e-6.
Result<ReflectionOperator> read_reflection_operator(const std::string& path);

}  // namespace goniochrome::color
