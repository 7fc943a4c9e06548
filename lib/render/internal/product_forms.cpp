#include "render/internal/product_forms.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/angles.h"
#include "math/elementary.h"

namespace goniochrome::render {

namespace {

using Vec6 = std::array<double, 6>;

double dot6(const Vec6& a, const Vec6& b) {
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) sum += a[i] * b[i];
  return sum;
}

// The coefficients of A's squares and mixed products in channel c of A (x) A.
Vec6 quadratic(const color::ReflectionOperator& op, std::size_t c) {
  const auto& k = op.k[c];
  return {k[0][0], k[1][1], k[2][2], 2 * k[0][1], 2 * k[0][2], 2 * k[1][2]};
}

// The coefficients of the square of a linear form.
Vec6 square(const Vec3& a) {
  return {a.x * a.x, a.y * a.y, a.z * a.z, 2 * a.x * a.y, 2 * a.x * a.z, 2 * a.y * a.z};
}

// A conic on which linear forms are points: a' q b.
double on_conic(const Vec6& q, const Vec3& a, const Vec3& b) {
  return q[0] * a.x * b.x + q[1] * a.y * b.y + q[2] * a.z * b.z + q[3] * (a.x * b.y + a.y * b.x) +
         q[4] * (a.x * b.z + a.z * b.x) + q[5] * (a.y * b.z + a.z * b.y);
}

// Appends what v has across the orthonormal basis, unit; returns its length.
double append(std::vector<Vec6>& basis, Vec6 v) {
  for (int pass = 0; pass < 2; ++pass) {
    for (const Vec6& b : basis) {
      const double along = dot6(v, b);
      for (std::size_t i = 0; i < 6; ++i) v[i] -= along * b[i];
    }
  }
  const double length = std::sqrt(dot6(v, v));
  if (!(length > 1e-6)) return 0;
  for (double& x : v) x /= length;
  basis.push_back(v);
  return length;
}

// Three conics that span all those apolar to the operator's quadratic forms.
std::vector<Vec6> apolar_conics(const color::ReflectionOperator& op) {
  std::vector<Vec6> basis;
  for (std::size_t c = 0; c < 3; ++c) append(basis, quadratic(op, c));
  const std::size_t forms = basis.size();
  for (std::size_t i = 0; i < 6; ++i) {
    Vec6 unit{};
    unit[i] = 1;
    append(basis, unit);
  }
  return {basis.begin() + static_cast<std::ptrdiff_t>(forms), basis.end()};
}

// The three real roots of k[3] t^3 + k[2] t^2 + k[1] t + k[0], if there are three.
std::optional<Vec3> three_roots(const std::array<double, 4>& k) {
  const double most = std::max({std::abs(k[0]), std::abs(k[1]), std::abs(k[2])});
  if (!(std::abs(k[3]) > 1e-9 * most)) return std::nullopt;
  const double b = k[2] / k[3], c = k[1] / k[3], d = k[0] / k[3];
  const double p = c - b * b / 3, q = 2 * b * b * b / 27 - b * c / 3 + d;
  if (!(4 * p * p * p + 27 * q * q < 0)) return std::nullopt;
  const double radius = 2 * std::sqrt(-p / 3), angle = math::acos(std::clamp(3 * q / (p * radius), -1.0, 1.0)) / 3;
  Vec3 roots;
  for (int i = 0; i < 3; ++i) {
    double t = radius * math::cos(angle - 2 * kPi * i / 3) - b / 3;
    for (int step = 0; step < 2; ++step) {
      const double slope = (3 * t + 2 * b) * t + c;
      if (slope != 0) t -= (((t + b) * t + c) * t + d) / slope;
    }
    roots[i] = t;
  }
  return roots;
}

// Where two conics through `a` meet again: on the line from a toward d, conic q is met at (d'qd) a - 2 (a'qd) d, and
// both there where (a'q1d)(d'q2d) = (a'q2d)(d'q1d), a cubic in the direction d.
std::optional<std::array<Vec3, 4>> common_points(const Vec3& a, const Vec6& q1, const Vec6& q2) {
  const Vec3 e = normalized(std::abs(a.x) < 0.6 ? cross(a, {1, 0, 0}) : cross(a, {0, 1, 0})), f = cross(a, e);
  std::array<double, 4> cubic{};
  const auto add = [&](double sign, const Vec6& line, const Vec6& conic) {
    const double l[2] = {on_conic(line, a, e), on_conic(line, a, f)};
    const double d[3] = {on_conic(conic, e, e), 2 * on_conic(conic, e, f), on_conic(conic, f, f)};
    for (std::size_t i = 0; i < 2; ++i)
      for (std::size_t j = 0; j < 3; ++j) cubic[i + j] += sign * l[i] * d[j];
  };
  add(1, q1, q2), add(-1, q2, q1);
  const auto roots = three_roots(cubic);
  if (!roots) return std::nullopt;
  std::array<Vec3, 4> points = {a};
  for (int i = 0; i < 3; ++i) {
    const Vec3 d = normalized(e + (*roots)[i] * f);
    const double first = on_conic(q1, d, d), second = on_conic(q2, d, d);
    const bool by_first = std::abs(first) > std::abs(second);
    const Vec3 point = (by_first ? first : second) * a - 2 * on_conic(by_first ? q1 : q2, a, d) * d;
    if (!(length(point) > 1e-9)) return std::nullopt;
    points[static_cast<std::size_t>(i) + 1] = normalized(point);
  }
  return points;
}

// The shares of four squares in each channel's quadratic form, or none where they do not make it.
bool solve_shares(const color::ReflectionOperator& op, ProductForms& forms) {
  std::vector<Vec6> basis;
  double lengths[4];
  for (std::size_t i = 0; i < 4; ++i) {
    lengths[i] = append(basis, square(forms.in[i]));
    if (lengths[i] == 0) return false;
  }
  for (std::size_t c = 0; c < 3; ++c) {
    Vec6 left = quadratic(op, c);
    for (std::size_t i = 4; i-- > 0;) {
      const Vec6 form = square(forms.in[i]);
      const double share = dot6(left, basis[i]) / lengths[i];
      for (std::size_t j = 0; j < 6; ++j) left[j] -= share * form[j];
      forms.out[i][static_cast<int>(c)] = share;
    }
    if (!(std::sqrt(dot6(left, left)) < 1e-9)) return false;
  }
  return true;
}

double sum_of_parts(const Vec3& a) {
  return std::abs(a.x) + std::abs(a.y) + std::abs(a.z);
}

// How much larger than colors of 1 the terms of their product can be, so how much rounding grows.
double growth(const ProductForms& forms) {
  Vec3 sum;
  for (std::size_t i = 0; i < 4; ++i) {
    const double size = sum_of_parts(forms.in[i]);
    for (int c = 0; c < 3; ++c) sum[c] += std::abs(forms.out[i][c]) * size * size;
  }
  return std::max({sum.x, sum.y, sum.z});
}

// x_d x_e = ((x_d + x_e)^2 - x_d^2 - x_e^2)/2
ProductForms six_forms(const color::ReflectionOperator& op) {
  ProductForms forms;
  forms.count = 6;
  forms.in = {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  for (int c = 0; c < 3; ++c) {
    const auto& k = op.k[static_cast<std::size_t>(c)];
    forms.out[0][c] = k[0][0] - k[0][1] - k[0][2];
    forms.out[1][c] = k[1][1] - k[0][1] - k[1][2];
    forms.out[2][c] = k[2][2] - k[0][2] - k[1][2];
    forms.out[3][c] = k[0][1], forms.out[4][c] = k[0][2], forms.out[5][c] = k[1][2];
  }
  return forms;
}

}  // namespace

// Every pair of conics out of the three that are apolar to the operator meets in four points; where all are real, the
// squares of these four forms make the operator. One of the points may be chosen: of many, the choice that lets
// rounding grow least.
ProductForms product_forms(const color::ReflectionOperator& op) {
  if (op.k == color::component_wise().k) return {};
  constexpr int kChoices = 500;
  constexpr double kMostGrowth = 1e3, kGoldenAngle = 2.399963229728653;
  const std::vector<Vec6> conics = apolar_conics(op);
  ProductForms best = six_forms(op);
  double least = kMostGrowth;
  for (int i = 0; i < kChoices && conics.size() == 3; ++i) {
    const double z = (i + 0.5) / kChoices, s = std::sqrt(1 - z * z);
    const Vec3 a{s * math::cos(kGoldenAngle * i), s * math::sin(kGoldenAngle * i), z};
    const Vec3 values{on_conic(conics[0], a, a), on_conic(conics[1], a, a), on_conic(conics[2], a, a)};
    if (!(length(values) > 1e-12)) continue;
    const Vec3 v = normalized(values);
    const Vec3 t = normalized(std::abs(v.x) < 0.6 ? cross(v, {1, 0, 0}) : cross(v, {0, 1, 0})), u = cross(v, t);
    Vec6 first{}, second{};
    for (std::size_t j = 0; j < 6; ++j) {
      first[j] = t.x * conics[0][j] + t.y * conics[1][j] + t.z * conics[2][j];
      second[j] = u.x * conics[0][j] + u.y * conics[1][j] + u.z * conics[2][j];
    }
    const auto points = common_points(a, first, second);
    if (!points) continue;
    ProductForms forms;
    forms.count = 4;
    std::copy(points->begin(), points->end(), forms.in.begin());
    if (!solve_shares(op, forms)) continue;
    const double grown = growth(forms);
    if (grown < least) least = grown, best = forms;
  }
  return best;
}

std::vector<float> in_four_forms(const ProductForms& forms, const float* colors, std::size_t count, std::size_t step) {
  std::vector<float> result(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const color::Rgb color{colors[step * i], colors[step * i + 1], colors[step * i + 2]};
    for (int form = 0; form < 4; ++form)
      result[4 * i + static_cast<std::size_t>(form)] = static_cast<float>(forms.of(form, color));
  }
  return result;
}

}  // namespace goniochrome::render
