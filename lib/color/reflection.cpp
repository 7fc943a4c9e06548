#include "color/reflection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "color/internal/cie_tables.h"

namespace goniochrome::color {

ReflectionOperator component_wise() {
  ReflectionOperator op;
  for (int c = 0; c < 3; ++c) op.k[c][c][c] = 1;
  return op;
}

// By scripts/fit-operator with the tables of testdata/, in thousandths: a step of 0.001 in one of the numbers changes
// the mean difference over the pairs that it was fitted to by less than 0.001. Its part beyond the plain product is 0.7
// of the best part for these pairs within the limits that keep red paint red in cyan light.
ReflectionOperator fitted_operator() {
  return nearest_coherent({{{{{{0.950, -0.012, 0.062}, {-0.012, 0.095, -0.083}, {0.062, -0.083, 0.021}}},
                             {{{0.052, -0.021, -0.031}, {-0.021, 0.995, 0.026}, {-0.031, 0.026, 0.005}}},
                             {{{0.003, -0.004, 0.001}, {-0.004, 0.000, 0.004}, {0.001, 0.004, 0.995}}}}}});
}

// Ten printed digits leave row sums up to 2e-10 off; the nearest coherent table is at most that far from them.
ReflectionOperator iso_rgb_operator() {
  return nearest_coherent({{{{{{.6533043776, .2708567778, .0758388444},
                               {.2708567778, -.2135258222, -.05733095555},
                               {.0758388444, -.05733095555, -.01850788891}}},
                             {{{.0594368555, -.0413179278, -.01811892773},
                               {-.0413179278, .9943860889, .0469318388},
                               {-.01811892773, .0469318388, -.02881291107}}},
                             {{{-.01119056664, .0005536667, .0106368999},
                               {.0005536667, -.04014829995, .0395946333},
                               {.0106368999, .0395946333, .9497684667}}}}}});
}

ReflectionOperator iso_rec709_operator() {
  return *in_working_space(iso_rgb_operator(), kRec709);
}

ReflectionOperator working_space_operator() {
  static const ReflectionOperator op = [] {
    std::vector<Rgb> matching;
    for (const CieRow& row : kCieTable)
      matching.push_back(rgb_from_xyz_d65({row.observer_2[0], row.observer_2[1], row.observer_2[2]}));
    return *estimated_operator(matching);
  }();
  return op;
}

Matrix3 reflection_matrix(const ReflectionOperator& op, const Rgb& a) {
  Matrix3 m{};
  for (int c = 0; c < 3; ++c)
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e) m[c][e] += op.k[c][d][e] * a[d];
  return m;
}

Rgb product(const Matrix3& m, const Rgb& b) {
  Rgb c;
  for (int i = 0; i < 3; ++i) c[i] = m[i][0] * b.x + m[i][1] * b.y + m[i][2] * b.z;
  return c;
}

namespace {

double norm_1(const Matrix3& m) {
  double largest = 0;
  for (int j = 0; j < 3; ++j) largest = std::max(largest, std::abs(m[0][j]) + std::abs(m[1][j]) + std::abs(m[2][j]));
  return largest;
}

}  // namespace

Inverse3 inverse(const Matrix3& m) {
  const double scale = norm_1(m);
  Inverse3 result;
  result.condition = std::numeric_limits<double>::infinity();
  if (!(scale > 0) || std::isinf(scale)) return result;
  // Cofactors of m/scale, so that neither products nor the determinant leave the range.
  Matrix3 adjugate{};
  const auto at = [&](int i, int j) { return m[i % 3][j % 3] / scale; };
  double determinant = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      adjugate[j][i] = at(i + 1, j + 1) * at(i + 2, j + 2) - at(i + 1, j + 2) * at(i + 2, j + 1);
  for (int j = 0; j < 3; ++j) determinant += at(0, j) * adjugate[j][0];
  // Below some roundings of its own terms the determinant is 0.
  if (std::abs(determinant) <= 8 * std::numeric_limits<double>::epsilon() * norm_1(adjugate)) return result;
  for (auto& row : adjugate)
    for (double& value : row) value /= determinant;
  result.condition = norm_1(adjugate);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) result.matrix[i][j] = adjugate[i][j] / scale;
  return result;
}

namespace {

Result<Inverse3> divisor(const ReflectionOperator& op, const Rgb& a) {
  const Inverse3 m = inverse(reflection_matrix(op, a));
  if (m.condition > kWorstCondition)
    return input_error("cannot divide by the color {} {} {}: its condition number is {:.3g}, more than {:g}", a.x, a.y,
                       a.z, m.condition, kWorstCondition);
  return m;
}

}  // namespace

Result<Rgb> divided(const ReflectionOperator& op, const Rgb& c, const Rgb& a) {
  GONIO_ASSIGN(const Inverse3 m, divisor(op, a));
  return product(m.matrix, c);
}

Result<Relighting> relighting(const ReflectionOperator& op, const Rgb& from, const Rgb& to) {
  GONIO_ASSIGN(const Inverse3 m, divisor(op, from));
  const Matrix3 light = reflection_matrix(op, to);
  Relighting result{{}, m.condition};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) result.matrix[i][j] += light[i][k] * m.matrix[k][j];
  return result;
}

// sum_e k[i][i][e] = 1 and sum_e k[i][d][e] = 0 for d != i stay true when k_iii becomes 1 - alpha and all else, whose
// sums are 1 - k_iii and 0, is multiplied by alpha/(1 - k_iii).
Result<ReflectionOperator> with_transfer(const ReflectionOperator& op, const Rgb& alpha) {
  ReflectionOperator result;
  for (int i = 0; i < 3; ++i) {
    const double own = op.k[i][i][i], transferred = 1 - own;
    if (!std::isfinite(alpha[i])) return input_error("transfer {} of channel {} is no number", alpha[i], i);
    if (alpha[i] != 0 && std::abs(transferred) < 1e-12)
      return input_error(
          "channel {} of this operator receives nothing from the others (k = {}): its transfer can only be 0, not {}",
          i, own, alpha[i]);
    const double factor = alpha[i] == 0 ? 0 : alpha[i] / transferred;
    for (int d = 0; d < 3; ++d)
      for (int e = 0; e < 3; ++e) result.k[i][d][e] = d == i && e == i ? 1 - alpha[i] : factor * op.k[i][d][e];
  }
  return result;
}

// For each c, minimize |S - K|^2 over symmetric S with S 1 = e_c. With K's symmetric part K', Lagrange's S is
// K' - (m 1' + 1 m') with 3 m + 1 (1'm) = r = K' 1 - e_c, hence 1'm = 1'r/6 and m = (r - 1'r/6)/3. Twice, which takes
// the rounding of the first pass away.
ReflectionOperator nearest_coherent(const ReflectionOperator& op) {
  ReflectionOperator result = op;
  for (int pass = 0; pass < 2; ++pass) {
    for (int c = 0; c < 3; ++c) {
      auto& k = result.k[c];
      for (int d = 0; d < 3; ++d)
        for (int e = 0; e < d; ++e) k[d][e] = k[e][d] = 0.5 * (k[d][e] + k[e][d]);
      std::array<double, 3> r{};
      for (int d = 0; d < 3; ++d) r[d] = k[d][0] + k[d][1] + k[d][2] - (d == c);
      const double total = (r[0] + r[1] + r[2]) / 6;
      for (int d = 0; d < 3; ++d)
        for (int e = 0; e < 3; ++e) k[d][e] -= (r[d] - total) / 3 + (r[e] - total) / 3;
    }
  }
  return result;
}

// The dual basis b = M bbar, M^-1 = <bbar_i, bbar_j>, stands for the smoothest spectrum of a color, and
// k[c][d][e] = <b_d b_e, bbar_c>. With each function scaled to sum 1 a constant spectrum 1 is the color (1,1,1), and
// the steps of wavelength cancel.
Result<ReflectionOperator> estimated_operator(std::span<const Rgb> color_matching) {
  Rgb sum;
  for (const Rgb& b : color_matching) sum += b;
  if (color_matching.size() < 3 || !(sum.x > 0 && sum.y > 0 && sum.z > 0))
    return input_error(
        "color-matching functions: {} samples with sums {} {} {}; at least 3 and positive sums are wanted",
        color_matching.size(), sum.x, sum.y, sum.z);
  std::vector<Rgb> bar;
  for (const Rgb& b : color_matching) bar.push_back({b.x / sum.x, b.y / sum.y, b.z / sum.z});
  Matrix3 gram{};
  for (const Rgb& b : bar)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) gram[i][j] += b[i] * b[j];
  const Inverse3 m = inverse(gram);
  if (m.condition > 1e10)
    return input_error("color-matching functions depend on each other: condition number {:.3g}", m.condition);
  ReflectionOperator op;
  for (const Rgb& b : bar) {
    const Rgb dual = product(m.matrix, b);
    for (int c = 0; c < 3; ++c)
      for (int d = 0; d < 3; ++d)
        for (int e = 0; e < 3; ++e) op.k[c][d][e] += b[c] * dual[d] * dual[e];
  }
  return nearest_coherent(op);
}

}  // namespace goniochrome::color
