#include "fit/internal/basis_errors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/gloss.h"
#include "math/cosine_power.h"
#include "math/least_squares.h"

namespace goniochrome::fit {

namespace {

constexpr std::array<std::size_t, kCoatErrorViews_deg.size()> kViews = {1, 3, 5, 8, 11};  // among brdf::kCoatViews_deg
static_assert(brdf::kCoatViews_deg[kViews[0]] == kCoatErrorViews_deg[0] &&
              brdf::kCoatViews_deg[kViews[4]] == kCoatErrorViews_deg[4]);
constexpr std::size_t kMostKept = 4096;  // targets whose coats' rings are kept: 2 kB each

// Rings within the width of the sun, the smallest light of an environment, are not told apart in a picture.
constexpr double kSun_deg = 0.53;

// The first ring that counts.
int first_ring() {
  const std::span<const double> rings = brdf::ring_angles_rad();
  return static_cast<int>(std::ranges::lower_bound(rings, kSun_deg * kDegree) - rings.begin());
}

// Rows of equal length, one behind the other, so that loops over a row run over neighbors in memory.
struct RowMajor {
  int rows = 0, columns = 0;
  std::vector<double> values;
  void resize(int r, int c) { rows = r, columns = c, values.assign(static_cast<std::size_t>(r) * c, 0.0); }
  double* row(int r) { return &values[static_cast<std::size_t>(r) * columns]; }
  const double* row(int r) const { return &values[static_cast<std::size_t>(r) * columns]; }
};

// Makes the first `pivots` columns of a triangle by Householder reflections, which are applied to the other columns
// too. A sum over rows is formed for all columns at once, row by row.
void triangulate(RowMajor& a, int pivots, std::vector<double>& sums) {
  constexpr double kNothing = 1e-140;  // the square is still a normal number
  sums.resize(static_cast<std::size_t>(a.columns));
  for (int k = 0; k < std::min(a.rows, pivots); ++k) {
    double square = 0;
    for (int r = k; r < a.rows; ++r) square += a.row(r)[k] * a.row(r)[k];
    const double norm = std::sqrt(square), corner = a.row(k)[k];
    if (!(norm > kNothing)) {
      for (int r = k; r < a.rows; ++r) a.row(r)[k] = 0;
      continue;
    }
    const double diagonal = corner > 0 ? -norm : norm, half = norm * (norm + std::abs(corner));
    a.row(k)[k] = corner - diagonal;  // column k holds the reflector until the others are done
    std::fill(sums.begin() + k + 1, sums.end(), 0.0);
    for (int r = k; r < a.rows; ++r) {
      const double v = a.row(r)[k];
      for (int c = k + 1; c < a.columns; ++c) sums[c] += v * a.row(r)[c];
    }
    for (int c = k + 1; c < a.columns; ++c) sums[c] /= half;
    for (int r = k; r < a.rows; ++r) {
      const double v = a.row(r)[k];
      for (int c = k + 1; c < a.columns; ++c) a.row(r)[c] -= v * sums[c];
      a.row(r)[k] = 0;
    }
    a.row(k)[k] = diagonal;
  }
}

// The triangle that triangulate() left.
math::Matrix triangle_of(const RowMajor& a, int pivots) {
  math::Matrix m(std::min(a.rows, pivots), pivots);
  for (int r = 0; r < m.rows; ++r)
    for (int c = r; c < pivots; ++c) m(r, c) = a.row(r)[c];
  return m;
}

// The lobes at the angles, angle by angle, each relative to its largest value there: a lobe that is as good as nothing
// at all angles still has a shape, and the products of its weight and its values do not depend on their scale.
std::vector<double> lobes_at(const std::vector<double>& angles_deg, const std::vector<double>& exponents) {
  std::vector<double> values(angles_deg.size() * exponents.size());
  for (std::size_t j = 0; j < exponents.size(); ++j) {
    double largest = 0;
    for (std::size_t r = 0; r < angles_deg.size(); ++r) {
      double& value = values[r * exponents.size() + j];
      value = math::cos_power(angles_deg[r] * kDegree, exponents[j]);
      largest = std::max(largest, value);
    }
    for (std::size_t r = 0; largest > 0 && r < angles_deg.size(); ++r) values[r * exponents.size() + j] /= largest;
  }
  return values;
}

// The shares of a coat's light within the rings that count.
std::vector<double> wanted_of(const brdf::RoughCoat& coat, std::size_t view) {
  std::vector<double> within = brdf::coat_within(coat, view);
  within.erase(within.begin(), within.begin() + first_ring());
  return within;
}

// Leaves the part e of an error e + floor: its square, and the gradient of that.
void leave_out(double floor, SquaredError& error) {
  const double whole = std::sqrt(error.value), rest = std::max(whole - floor, 0.0);
  error.value = rest * rest;
  for (double& slope : error.gradient) slope *= whole > 0 ? rest / whole : 0;
}

struct Workspace {
  RowMajor a;
  std::vector<double> sums, gradient;
};

}  // namespace

// A lobe of energy 1 has the share 1 - cos^(E+1) psi within psi, whose derivative by log E is -E log(cos psi) cos^(E+1)
// psi. The columns are the same for all coats.
struct BasisErrors::CoatShape {
  CoatShape(const std::vector<double>& exponents, bool mirror) {
    const std::span<const double> rings = brdf::ring_angles_rad().subspan(static_cast<std::size_t>(first_ring()));
    const int rows = static_cast<int>(rings.size()), lobes = static_cast<int>(exponents.size());
    const int pivots = lobes + (mirror ? 1 : 0);
    within.resize(rows, pivots);
    // Beside the columns stands the identity, which the reflections turn into Q'.
    RowMajor a;
    a.resize(rows, pivots + rows);
    for (int k = 0; k < rows; ++k) {
      double* row = within.row(k);
      for (int j = 0; j < lobes; ++j) row[j] = 1 - math::cos_power(rings[k], exponents[j] + 1);
      if (mirror) row[lobes] = 1;
      std::copy(row, row + pivots, a.row(k));
      a.row(k)[pivots + k] = 1;
      log_cos.push_back(math::log_cosine(rings[k]));
    }
    std::vector<double> sums;
    triangulate(a, pivots, sums);
    triangle = triangle_of(a, pivots);
    turned.resize(rows, triangle->rows);
    for (int k = 0; k < rows; ++k)
      for (int r = 0; r < triangle->rows; ++r) turned.row(k)[r] = a.row(r)[pivots + k];
  }

  RowMajor within, turned;  // the columns, and the first rows of Q' as columns
  std::optional<math::Matrix> triangle;
  std::vector<double> log_cos;
};

BasisErrors::BasisErrors(const std::vector<BasisTarget>& targets) : targets_(targets) {
  std::map<std::vector<double>, std::size_t> known;
  std::vector<double> angles;
  for (const BasisTarget& target : targets) {
    angles.clear();
    for (const BasisRow& row : target.rows) angles.push_back(row.angle_deg);
    const auto [at, is_new] = known.try_emplace(angles, shapes_.size());
    shape_of_.push_back(at->second);
    if (!is_new) continue;
    Shape shape{angles, {}};
    for (const double angle : angles) shape.log_cos.push_back(std::log(std::max(std::cos(angle * kDegree), 1e-300)));
    shapes_.push_back(std::move(shape));
  }
  if (targets.size() > kMostKept) return;
  wanted_.resize(targets.size());
  parallel_for(targets.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t v = 0; targets[i].coat && v < kViews.size(); ++v)
        wanted_[i].push_back(wanted_of(*targets[i].coat, kViews[v]));
  });
}

// With the coat's mean square error of the shares of light within rings around the mirror direction.
void BasisErrors::add_coat_error(std::size_t i, const std::vector<double>& exponents, const CoatShape& shape,
                                 bool with_gradient, SquaredError& result) const {
  const BasisTarget& target = targets_[i];
  const int rows = shape.within.rows, columns = shape.within.columns, lobes = static_cast<int>(exponents.size());
  std::vector<double> right(static_cast<std::size_t>(shape.turned.columns));
  for (std::size_t v = 0; v < kViews.size(); ++v) {
    const double scale = target.coat_weights[v] * target.coat_weights[v] / rows;
    std::vector<double> made;
    if (wanted_.empty()) made = wanted_of(*target.coat, kViews[v]);
    const std::vector<double>& wanted = wanted_.empty() ? made : wanted_[i][v];
    std::ranges::fill(right, 0.0);
    for (int k = 0; k < rows; ++k)
      for (int r = 0; r < shape.turned.columns; ++r) right[r] += wanted[k] * shape.turned.row(k)[r];
    const math::NonNegativeFit fit = math::nnls(*shape.triangle, right);
    for (int k = 0; k < rows; ++k) {
      const double* within = shape.within.row(k);
      double residual = -wanted[k];
      for (int j = 0; j < columns; ++j) residual += within[j] * fit.x[j];
      result.value += scale * residual * residual;
      if (!with_gradient || std::isinf(shape.log_cos[k])) continue;
      const double slope = -2 * scale * residual * shape.log_cos[k];
      for (int j = 0; j < lobes; ++j) result.gradient[j] += slope * fit.x[j] * exponents[j] * (1 - within[j]);
    }
  }
}

// The columns of a target are turned into a triangle once, which its three channels share: the fits that follow have as
// many rows as columns, and not as many as angles.
//
// At the inner optimum x the residual's dependence on x drops out (envelope theorem: x_j is either stationary or held
// at 0), so d err^2 / d log E_j = 2/n sum w^2 r x_j E_j log(cos t) cos^E_j t.
SquaredError BasisErrors::squared_error(std::size_t i, const std::vector<double>& exponents,
                                        const std::vector<double>& lobes_at_angles, bool with_gradient) const {
  static thread_local Workspace work;
  const BasisTarget& target = targets_[i];
  const int rows = static_cast<int>(target.rows.size()), lobes = static_cast<int>(exponents.size());
  const int pivots = lobes + 1;
  work.a.resize(rows, pivots + 3);
  for (int r = 0; r < rows; ++r) {
    const BasisRow& row = target.rows[r];
    const double* lobe = &lobes_at_angles[static_cast<std::size_t>(r) * lobes];
    double* a = work.a.row(r);
    a[0] = row.weight;
    for (int j = 0; j < lobes; ++j) a[j + 1] = row.weight * lobe[j];
    for (int c = 0; c < 3; ++c) a[pivots + c] = row.weight * row.value[c];
  }
  triangulate(work.a, pivots, work.sums);
  const math::Matrix triangle = triangle_of(work.a, pivots);

  SquaredError result{0, std::vector<double>(with_gradient ? exponents.size() : 0, 0.0)};
  std::vector<double> right(static_cast<std::size_t>(triangle.rows));
  const std::vector<double>& log_cos = shapes_[shape_of_[i]].log_cos;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < triangle.rows; ++r) right[r] = work.a.row(r)[pivots + c];
    const math::NonNegativeFit fit = math::nnls(triangle, right);
    result.value += fit.objective * fit.objective;
    for (int r = triangle.rows; r < rows; ++r) result.value += work.a.row(r)[pivots + c] * work.a.row(r)[pivots + c];
    if (!with_gradient) continue;
    work.gradient.assign(exponents.size(), 0.0);
    for (int r = 0; r < rows; ++r) {
      const BasisRow& row = target.rows[r];
      const double* lobe = &lobes_at_angles[static_cast<std::size_t>(r) * lobes];
      double residual = fit.x[0] - row.value[c];
      for (int j = 0; j < lobes; ++j) residual += lobe[j] * fit.x[j + 1];
      const double slope = 2 * row.weight * row.weight * residual * log_cos[r];
      for (int j = 0; j < lobes; ++j) work.gradient[j] += slope * lobe[j];
    }
    for (int j = 0; j < lobes; ++j) result.gradient[j] += work.gradient[j] * fit.x[j + 1] * exponents[j];
  }
  const double scale = 1.0 / std::max(3 * rows, 1);
  result.value *= scale;
  for (double& g : result.gradient) g *= scale;
  return result;
}

std::vector<SquaredError> BasisErrors::at(const std::vector<double>& exponents, bool with_gradient) const {
  std::vector<std::vector<double>> lobes_at_angles(shapes_.size());
  parallel_for(shapes_.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) lobes_at_angles[s] = lobes_at(shapes_[s].angles_deg, exponents);
  });
  std::optional<CoatShape> coats[2];  // without and with the mirror
  for (const BasisTarget& target : targets_)
    if (target.coat && !coats[target.mirror]) coats[target.mirror].emplace(exponents, target.mirror);

  std::vector<SquaredError> errors(targets_.size());
  parallel_for(targets_.size(), 4, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      errors[i] = squared_error(i, exponents, lobes_at_angles[shape_of_[i]], with_gradient);
      if (targets_[i].coat) add_coat_error(i, exponents, *coats[targets_[i].mirror], with_gradient, errors[i]);
      if (targets_[i].floor > 0) leave_out(targets_[i].floor, errors[i]);
    }
  });
  return errors;
}

}  // namespace goniochrome::fit
