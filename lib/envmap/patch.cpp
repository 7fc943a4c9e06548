#include "envmap/patch.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/angles.h"
#include "math/cosine_power.h"
#include "math/gauss_rule.h"

namespace goniochrome::envmap {

namespace {

constexpr double kHorizon = kPi / 2;
constexpr double kNothing = 1e-20;  // of the lobe's peak; a sun may outshine the mean by 1e6 and the floor is 1e-3

template <class Integrand>
auto over_cell(const Environment& env, const Cell& cell, const math::GaussPoints& rule, const Integrand& integrand) {
  decltype(integrand(Vec3{})) sum{};
  const double width = cell.column1 - cell.column0, height = cell.row1 - cell.row0;
  for (int j = 0; j < rule.count; ++j)
    for (int i = 0; i < rule.count; ++i) {
      const double column = cell.column0 + rule.at[i] * width, row = cell.row0 + rule.at[j] * height;
      const double weight = rule.weight[i] * rule.weight[j] * width * height * env.solid_angle_density(column, row);
      sum += weight * integrand(env.direction_at(column, row));
    }
  return sum;
}

std::array<Cell, 4> quarters(const Cell& c) {
  const double column = (c.column0 + c.column1) / 2, row = (c.row0 + c.row1) / 2;
  return {{{c.column0, c.row0, column, row},
           {column, c.row0, c.column1, row},
           {c.column0, row, column, c.row1},
           {column, row, c.column1, c.row1}}};
}

// What one quarter of the recursion knows.
struct Task {
  const Environment& env;
  Vec3 d;
  double exponent;
  double relative;
  double horizon_radius;  // cells cut by the horizon are quartered down to this, in radians
};

double over_horizon_cell(const Task& task, const Cell& cell) {
  const double column = (cell.column0 + cell.column1) / 2, row = (cell.row0 + cell.row1) / 2;
  const double x = (cell.column1 - cell.column0) / 4, y = (cell.row1 - cell.row0) / 4;
  // Half way to the sides: a face's last row ends where the next face begins.
  const auto t = [&](double i, double j) { return dot(task.d, task.env.direction_at(column + i * x, row + j * y)); };
  const double left = t(-1, 0), right = t(1, 0), top = t(0, -1), bottom = t(0, 1), center = t(0, 0);
  // The mean of t over the cell, its bend included: a bend of x^2 means 1/12, and shows as 1/16 half way out.
  const double mean = center + 4.0 / 3 * ((left + right) / 2 - center + (top + bottom) / 2 - center);
  return task.env.solid_angle(cell.column0, cell.row0, cell.column1, cell.row1) *
         linear_mean(mean, 2 * (right - left), 2 * (bottom - top), task.exponent);
}

// The n-point rule errs by about (v/2)^2n (n!)^4 2^2n / ((2n+1) (2n)!^3) times the 2n-th derivative, with v the
// relative variation of the lobe across the cell; these are the v at which that is 1e-10, for n = 2, 3, 4.
// `share` is the value of the lobe there: far down its flank a larger error of the little value is as good.
int rule_for(double variation, double relative, double share) {
  const double wanted = relative / std::max(share, 1e-12);
  const double scale = std::clamp(std::pow(wanted / 1e-10, 1.0 / 8), 1.0, 6.0);  // the steepest of the three powers
  if (variation < 0.02 * scale) return 2;
  if (variation < 0.12 * scale) return 3;
  if (variation < 0.35 * scale) return 4;
  return 0;
}

double integrate(const Task& task, const Cell& cell, int depth) {
  const double column = (cell.column0 + cell.column1) / 2, row = (cell.row0 + cell.row1) / 2;
  const double theta = angle_between(task.env.direction_at(column, row), task.d);
  const double radius = task.env.radius_rad(cell.column0, cell.row0, cell.column1, cell.row1);
  if (theta - radius >= kHorizon) return 0;
  const double most = math::cosine_power(std::cos(std::max(0.0, theta - radius)), task.exponent);
  if (most < kNothing) return 0;
  const auto lobe = [&](const Vec3& w) { return math::cosine_power(dot(task.d, w), task.exponent); };
  const auto split = [&] {
    double sum = 0;
    for (const Cell& quarter : quarters(cell)) sum += integrate(task, quarter, depth + 1);
    return sum;
  };
  constexpr int kDeepest = 24;
  if (theta + radius > kHorizon)
    return radius <= task.horizon_radius || depth >= kDeepest ? over_horizon_cell(task, cell) : split();
  // d/dtheta ln cos^E = -E tan(theta), and near its top the lobe is as wide as 1/sqrt(E).
  const double steep = task.exponent * std::tan(std::min(theta + radius, kHorizon - 1e-9));
  const int points = rule_for(2 * radius * std::max(std::sqrt(task.exponent), steep), task.relative, most);
  // A lat-long cell that is large itself bends; its density must be smooth over it, too.
  if (radius > 0.5 || (points == 0 && depth < kDeepest)) return split();
  return over_cell(task.env, cell, math::kGaussPoints[std::max(points, radius > 0.05 ? 4 : 2) - 1], lobe);
}

}  // namespace

// The mean of max(0, t)^E over a cell on which t is linear: t0 in the middle, changing by a and b from side to side.
// With F the second antiderivative of the power that is (F(++) - F(+-) - F(-+) + F(--)) / (a b); where t hardly changes
// one way, the first antiderivative's difference.
double linear_mean(double t0, double a, double b, double exponent) {
  a = std::fabs(a), b = std::fabs(b);
  if (a < b) std::swap(a, b);
  const auto above = [&](double t, double power) { return t > 0 ? std::pow(t, power) : 0.0; };
  if (a < 1e-14) return math::cosine_power(t0, exponent);
  if (b < 1e-5 * a) return (above(t0 + a / 2, exponent + 1) - above(t0 - a / 2, exponent + 1)) / ((exponent + 1) * a);
  const auto corner = [&](double i, double j) { return above(t0 + (i * a + j * b) / 2, exponent + 2); };
  return (corner(1, 1) - corner(1, -1) - corner(-1, 1) + corner(-1, -1)) / ((exponent + 1) * (exponent + 2) * a * b);
}

double lobe_over_cell(const Environment& env, const Cell& cell, const Vec3& d, double exponent, double relative,
                      double at_horizon) {
  // Within a cell of radius r the rows of a lat-long map bend t away from a line by r/8 or so of its change, so a cut
  // cell errs by r/5 of itself at worst; each quartering leaves a quarter of that.
  const double radius = env.radius_rad(cell.column0, cell.row0, cell.column1, cell.row1);
  const double horizon_radius = std::min(0.1, radius * std::sqrt(std::min(1.0, at_horizon / (radius / 5))));
  return integrate({env, d, exponent, relative, horizon_radius}, cell, 0);
}

Vec3 moment_of_cell(const Environment& env, const Cell& cell) {
  const double radius = env.radius_rad(cell.column0, cell.row0, cell.column1, cell.row1);
  if (radius > 0.2) {
    Vec3 sum;
    for (const Cell& quarter : quarters(cell)) sum += moment_of_cell(env, quarter);
    return sum;
  }
  return over_cell(env, cell, math::kGaussPoints[radius > 0.01 ? 3 : 1], [](const Vec3& w) { return w; });
}

}  // namespace goniochrome::envmap
