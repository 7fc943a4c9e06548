#include "prefilter/internal/lobe_patch.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::prefilter {

namespace {

using envmap::Cell;
using envmap::Environment;

constexpr double kNothing = 1e-20;  // of the kernel's top; a sun may outshine the mean by 1e6 and the floor is 1e-3

// What one quarter of the recursion knows.
struct Task {
  const Environment& env;
  Vec3 d;
  const ZonalKernel& kernel;
  double relative;
  double edge_radius;  // cells that the edge cuts are quartered down to this, in radians
};

double over_edge_cell(const Task& task, const Cell& cell) {
  const double column = (cell.column0 + cell.column1) / 2, row = (cell.row0 + cell.row1) / 2;
  const double x = (cell.column1 - cell.column0) / 4, y = (cell.row1 - cell.row0) / 4;
  // Half way to the sides: a face's last row ends where the next face begins.
  const auto t = [&](double i, double j) { return dot(task.d, task.env.direction_at(column + i * x, row + j * y)); };
  const double left = t(-1, 0), right = t(1, 0), top = t(0, -1), bottom = t(0, 1), center = t(0, 0);
  // The mean of t over the cell, its bend included: a bend of x^2 means 1/12, and shows as 1/16 half way out.
  const double mean = center + 4.0 / 3 * ((left + right) / 2 - center + (top + bottom) / 2 - center);
  return task.env.solid_angle(cell.column0, cell.row0, cell.column1, cell.row1) *
         task.kernel.linear_mean(mean, 2 * (right - left), 2 * (bottom - top));
}

// The n-point rule errs by about (v/2)^2n (n!)^4 2^2n / ((2n+1) (2n)!^3) times the 2n-th derivative, with v the
// relative variation of the kernel across the cell; these are the v at which that is 1e-10, for n = 2, 3, 4.
// `share` is the value of the kernel there: far down its flank a larger error of the little value is as good.
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
  const double theta = envmap::angle_between(task.env.direction_at(column, row), task.d);
  const double radius = task.env.radius_rad(cell.column0, cell.row0, cell.column1, cell.row1);
  const double edge = task.kernel.edge().angle_rad;
  if (theta - radius >= edge) return 0;
  const double most = task.kernel.value(std::cos(std::max(0.0, theta - radius)));
  if (most < kNothing) return 0;
  const auto lobe = [&](const Vec3& w) { return task.kernel.value(dot(task.d, w)); };
  const auto split = [&] {
    double sum = 0;
    for (const Cell& quarter : envmap::quarters(cell)) sum += integrate(task, quarter, depth + 1);
    return sum;
  };
  constexpr int kDeepest = 24;
  if (theta + radius > edge)
    return radius <= task.edge_radius || depth >= kDeepest ? over_edge_cell(task, cell) : split();
  const int points = rule_for(2 * radius * task.kernel.variation(theta + radius), task.relative, most);
  // A lat-long cell that is large itself bends; its density must be smooth over it, too.
  if (radius > 0.5 || (points == 0 && depth < kDeepest)) return split();
  return envmap::over_cell(task.env, cell, math::kGaussPoints[std::max(points, radius > 0.05 ? 4 : 2) - 1], lobe);
}

}  // namespace

double lobe_over_cell(const Environment& env, const Cell& cell, const Vec3& d, const ZonalKernel& kernel,
                      double relative, double at_edge) {
  // Within a cell of radius r the rows of a lat-long map bend t away from a line by r/8 or so of its change, so a cut
  // cell errs by r/5 of itself at worst; each quartering leaves a quarter of that.
  const double radius = env.radius_rad(cell.column0, cell.row0, cell.column1, cell.row1);
  const double edge_radius = std::min(0.1, radius * std::sqrt(std::min(1.0, at_edge / (radius / 5))));
  return integrate({env, d, kernel, relative, edge_radius}, cell, 0);
}

}  // namespace goniochrome::prefilter
