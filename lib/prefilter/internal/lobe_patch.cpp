#include "prefilter/internal/lobe_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/angles.h"
#include "math/quadrature.h"
#include "prefilter/internal/lobe_rows.h"

namespace goniochrome::prefilter {

namespace {

using envmap::Cell;
using envmap::Environment;

constexpr double kNothing = 1e-20;  // of the kernel's top; a sun may outshine the mean by 1e6 and the floor is 1e-3

// The state of one quarter of the recursion.
struct Task {
  const Environment& env;
  Vec3 d;
  const ZonalKernel& kernel;
  double relative;
  double edge_radius;         // cells that the edge cuts are quartered down to this, in radians
  const CosineKernel* power;  // the kernel, if its values may be found a vector at a time; else null
};

// max(0, cos)^E at the points of a rule each way, all of them in one sum of powers.
double powers_over_cell(const Task& task, const Cell& cell, const math::GaussPoints& rule) {
  constexpr std::size_t kMost = 16;
  std::array<double, kMost + rows::kPadding> cosines{}, weights{};
  std::size_t count = 0;
  envmap::for_each_node(task.env, cell, rule, [&](const Vec3& direction, double weight) {
    cosines[count] = dot(task.d, direction), weights[count] = weight;
    ++count;
  });
  return rows::sum_of_powers(weights.data(), cosines.data(), count, 0, 1, task.power->exponent());
}

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
  const math::GaussPoints& rule = math::kGaussPoints[std::max(points, radius > 0.05 ? 4 : 2) - 1];
  return task.power ? powers_over_cell(task, cell, rule) : envmap::over_cell(task.env, cell, rule, lobe);
}

// Where a sharp cosine lobe has fallen to kNothing: cos^E is below exp(-E angle^2/2).
double reach_rad(double sharpness) {
  static const double widths = std::sqrt(-2 * std::log(kNothing));
  return widths / sharpness;
}

// The nodes of an eight-point rule on equal pieces of an angle that starts at 0: sine and cosine, and their weights.
struct Nodes {
  Nodes() = default;
  Nodes(double width_rad, int pieces) {
    static const std::vector<math::QuadraturePoint> rule = math::gauss_legendre(8);
    const double half = width_rad / (2 * pieces);
    for (int k = 0; k < pieces; ++k)
      for (const math::QuadraturePoint& point : rule) {
        const double angle = half * (2 * k + 1 + point.position);
        sine.push_back(std::sin(angle)), cosine.push_back(std::cos(angle)), weight.push_back(half * point.weight);
      }
  }
  std::size_t count() const { return weight.size(); }
  std::vector<double> sine, cosine, weight;
};

// All texels of a map are equally wide and equally high, so that their nodes are a turn apart. Nodes are kept for the
// last width that was asked for, by the number of pieces.
class KeptNodes {
 public:
  const Nodes& of(double width_rad, int pieces) {
    if (width_rad != width_rad_) by_pieces_.clear();
    width_rad_ = width_rad;
    const std::size_t wanted = static_cast<std::size_t>(pieces);
    if (wanted >= by_pieces_.size()) by_pieces_.resize(wanted + 1);
    if (by_pieces_[wanted].count() == 0) by_pieces_[wanted] = Nodes(width_rad, pieces);
    return by_pieces_[wanted];
  }

 private:
  double width_rad_ = 0;
  std::vector<Nodes> by_pieces_;
};

// The pieces, in lobe widths, on which the eight-point rule errs by less than `relative` of the lobe's top. Of
// exp(-u^2/2) it errs by h^17 (8!)^4 / (17 (16!)^3) times the 16th derivative, which is at most 2e6: 5e-12 (h/2)^17.
// Three quarters of that h leave a factor of 130.
double piece_for(double relative) {
  return std::min(4.0, 1.5 * std::pow(relative / 5e-12, 1.0 / 17));
}

}  // namespace

// The sines and cosines belong to the rows and the columns of the nodes, so that a node costs one power.
double sharp_lobe_over_texel(const Environment& env, int column, int row, const Vec3& d, double exponent,
                             double relative) {
  const double row_rad = kPi / env.height(), column_rad = 2 * kPi / env.width(), sharpness = std::sqrt(exponent);
  const double theta0 = row_rad * row, theta1 = row_rad * (row + 1);
  const double ring = theta0 < kPi / 2 && theta1 > kPi / 2 ? 1 : std::max(std::sin(theta0), std::sin(theta1));
  const double piece = piece_for(relative);
  const auto pieces = [&](double width_rad) {
    return std::max(1, static_cast<int>(std::ceil(width_rad * sharpness / piece)));
  };
  thread_local KeptNodes kept_down, kept_across;
  thread_local std::vector<double> level, weight;
  const Nodes& down = kept_down.of(row_rad, pieces(row_rad));
  const Nodes& across = kept_across.of(column_rad, pieces(column_rad * ring));
  // Longitude falls with the columns: d.x sin + d.z cos of it, counted from the side of the first column.
  const double side = kPi - column_rad * column, x = d.x, z = d.z;
  const double along = x * std::sin(side) + z * std::cos(side), beside = z * std::sin(side) - x * std::cos(side);
  level.assign(across.count() + rows::kPadding, 0), weight.assign(across.count() + rows::kPadding, 0);
  for (std::size_t i = 0; i < across.count(); ++i) {
    level[i] = along * across.cosine[i] + beside * across.sine[i];
    weight[i] = across.weight[i];
  }
  const double sin0 = std::sin(theta0), cos0 = std::cos(theta0);
  double sum = 0;
  for (std::size_t j = 0; j < down.count(); ++j) {
    const double sine = sin0 * down.cosine[j] + cos0 * down.sine[j],
                 cosine = cos0 * down.cosine[j] - sin0 * down.sine[j];
    sum += down.weight[j] * sine *
           rows::sum_of_powers(weight.data(), level.data(), across.count(), d.y * cosine, sine, exponent);
  }
  return sum;
}

double lobe_over_cell(const Environment& env, const Cell& cell, const Vec3& d, const ZonalKernel& kernel,
                      double relative, double at_edge) {
  // Within a cell of radius r the rows of a lat-long map bend t away from a line by r/8 or so of its change, so a cut
  // cell errs by r/5 of itself at worst; each quartering leaves a quarter of that.
  const double radius = env.radius_rad(cell.column0, cell.row0, cell.column1, cell.row1);
  const double edge_radius = std::min(0.1, radius * std::sqrt(std::min(1.0, at_edge / (radius / 5))));
  // The reference asks for more digits, and keeps a method of its own.
  constexpr double kLeastRelative = 1e-8, kWidths = 0.5, kSharp = 30;
  const double sharpness = kernel.sharpness();
  const CosineKernel* power = relative >= kLeastRelative ? dynamic_cast<const CosineKernel*>(&kernel) : nullptr;
  if (env.layout() == Environment::Layout::kLatLong && power && sharpness > kSharp &&
      2 * radius * sharpness > kWidths) {
    const double theta =
        envmap::angle_between(env.direction_at((cell.column0 + cell.column1) / 2, (cell.row0 + cell.row1) / 2), d);
    if (theta - radius > reach_rad(sharpness)) return 0;
    if (theta + radius < kernel.edge().angle_rad)
      return sharp_lobe_over_texel(env, static_cast<int>(cell.column0), static_cast<int>(cell.row0), d,
                                   kernel.exponent(), relative);
  }
  return integrate({env, d, kernel, relative, edge_radius, power}, cell, 0);
}

}  // namespace goniochrome::prefilter
