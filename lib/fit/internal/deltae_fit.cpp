#include "fit/internal/deltae_fit.h"

#include <algorithm>
#include <cmath>

#include "math/least_squares.h"

namespace goniochrome::fit {

namespace {

// Residuals: three for each reading (a vector of length dE00) and three for each guide. Unknowns: x, column by column.
class Residuals {
 public:
  explicit Residuals(const DeltaEProblem& problem) : problem_(problem) {}

  int rows() const { return static_cast<int>(3 * (problem_.readings.size() + problem_.guides.size())); }
  int unknowns() const { return 3 * problem_.columns; }

  double sum_of_squares(const std::vector<double>& x) const {
    double sum = 0;
    for (const auto& reading : problem_.readings) {
      const Vec3 e = difference(reading.lab, prediction(reading.shape, x));
      sum += dot(e, e);
    }
    for (const auto& guide : problem_.guides) {
      const color::Rgb e = guide.weight * (prediction(guide.shape, x) - guide.value);
      sum += dot(e, e);
    }
    return sum;
  }

  // The residuals and, in the leading rows of `jacobian`, their derivative.
  void linearize(const std::vector<double>& x, std::vector<double>& residuals, math::Matrix& jacobian) const {
    residuals.resize(static_cast<std::size_t>(rows()));
    int row = 0;
    for (const auto& reading : problem_.readings) {
      const color::Rgb rgb = prediction(reading.shape, x);
      const Vec3 e = difference(reading.lab, rgb);
      for (int k = 0; k < 3; ++k) residuals[row + k] = e[k];
      for (int c = 0; c < 3; ++c) {
        const Vec3 slope = derivative(reading.lab, rgb, c);
        for (int j = 0; j < problem_.columns; ++j)
          for (int k = 0; k < 3; ++k) jacobian(row + k, 3 * j + c) = slope[k] * reading.shape[j];
      }
      row += 3;
    }
    for (const auto& guide : problem_.guides) {
      const color::Rgb rgb = prediction(guide.shape, x);
      for (int c = 0; c < 3; ++c) {
        residuals[row + c] = guide.weight * (rgb[c] - guide.value[c]);
        for (int j = 0; j < problem_.columns; ++j) jacobian(row + c, 3 * j + c) = guide.weight * guide.shape[j];
      }
      row += 3;
    }
  }

 private:
  static color::Rgb prediction(const std::vector<double>& shape, const std::vector<double>& x) {
    color::Rgb rgb;
    for (std::size_t j = 0; j < shape.size(); ++j) rgb += shape[j] * color::Rgb{x[3 * j], x[3 * j + 1], x[3 * j + 2]};
    return rgb;
  }
  Vec3 difference(const color::Lab& lab, const color::Rgb& rgb) const {
    return color::delta_e_2000_vector(lab, color::lab_from_rgb(rgb, problem_.white));
  }
  // By channel c, by central differences: their error of about 1e-10 moves the steps, not the minimum.
  Vec3 derivative(const color::Lab& lab, const color::Rgb& rgb, int c) const {
    const double step = 1e-5 * std::max(std::abs(rgb[c]), 1e-4);
    color::Rgb up = rgb, down = rgb;
    up[c] += step, down[c] -= step;
    return (1 / (2 * step)) * (difference(lab, up) - difference(lab, down));
  }

  const DeltaEProblem& problem_;
};

double column_norm(const math::Matrix& m, int column, int rows) {
  double sum = 0;
  for (int i = 0; i < rows; ++i) sum += m(i, column) * m(i, column);
  return std::sqrt(sum);
}

// How far x is from stationary: for each column of the derivative its cosine to the residual, where x may still move
// that way.
double stationarity(const Residuals& residuals, const std::vector<double>& x) {
  std::vector<double> r;
  math::Matrix j(residuals.rows(), residuals.unknowns());
  residuals.linearize(x, r, j);
  double size = 0;
  for (const double v : r) size += v * v;
  if (size < 1e-20) return 0;
  double worst = 0;
  for (int k = 0; k < j.columns; ++k) {
    double gradient = 0;
    for (int i = 0; i < j.rows; ++i) gradient += j(i, k) * r[i];
    const double norm = column_norm(j, k, j.rows);
    if (norm == 0 || (x[k] <= 0 && gradient > 0)) continue;
    worst = std::max(worst, std::abs(gradient) / (norm * std::sqrt(size)));
  }
  return worst;
}

// Levenberg and Marquardt's method on x >= 0. Each step z is the exact minimum of the linearized problem under the
// bounds, a non-negative least-squares problem of its own:
//
//   minimize |J (z - x) + r|^2 + damping |D (z - x)|^2   over z >= 0,   D = the lengths of J's columns
//
// so that weights enter and leave the bounds many at a time. It is stationary to rounding after 10 to 30 steps where a
// trust region with projected steps was still on its way after 400.
class Search {
 public:
  Search(const Residuals& residuals, const Deadline& deadline)
      : residuals_(residuals),
        deadline_(deadline),
        rows_(residuals.rows()),
        unknowns_(residuals.unknowns()),
        system_(rows_ + unknowns_, unknowns_),
        right_(static_cast<std::size_t>(rows_ + unknowns_)),
        scale_(static_cast<std::size_t>(unknowns_)) {}

  FitStatus run(std::vector<double>& x, double& value) {
    constexpr int kMostSteps = 200;
    value = residuals_.sum_of_squares(x);
    double damping = 1e-3;
    int small_gains = 0;
    for (int step = 0; step < kMostSteps; ++step) {
      if (deadline_.passed()) return FitStatus::kTimeLimit;
      linearize(x);
      double next_value = value;
      std::vector<double> next;
      for (;; damping *= 8) {
        next = solved(x, damping);
        next_value = residuals_.sum_of_squares(next);
        if (next_value < value) break;
        constexpr double kNoStepLeft = 1e8;
        if (damping > kNoStepLeft) return FitStatus::kOptimal;
        if (deadline_.passed()) return FitStatus::kTimeLimit;
      }
      const double gain = value - next_value;
      x = std::move(next), value = next_value;
      damping = std::max(damping / 10, 1e-12);
      constexpr double kSmallGain = 1e-8;  // of the sum of squares: 1e-9 dE00 of a typical one
      // Where all differences together are unseen, hues of nearly gray colors jump and steps are short: the search ends
      // where their length falls by less than 1e-4 dE00.
      constexpr double kUnseen = 0.06, kUnseenGain = 2e-4;
      const double least_gain = value < kUnseen ? kUnseenGain * std::sqrt(value) : kSmallGain * value;
      small_gains = gain < least_gain ? small_gains + 1 : 0;
      if (small_gains >= 2 || value < 1e-16) return FitStatus::kOptimal;
    }
    return FitStatus::kNotConverged;
  }

 private:
  void linearize(const std::vector<double>& x) {
    residuals_.linearize(x, r_, system_);
    for (int k = 0; k < unknowns_; ++k) scale_[k] = std::max(column_norm(system_, k, rows_), 1e-12);
    for (int i = 0; i < rows_; ++i) {
      right_[i] = -r_[i];
      for (int k = 0; k < unknowns_; ++k)
        if (x[k] != 0) right_[i] += system_(i, k) * x[k];
    }
  }

  std::vector<double> solved(const std::vector<double>& x, double damping) {
    const double root = std::sqrt(damping);
    for (int k = 0; k < unknowns_; ++k) {
      system_(rows_ + k, k) = root * scale_[k];
      right_[rows_ + k] = root * scale_[k] * x[k];
    }
    return math::nnls(system_, right_).x;
  }

  const Residuals& residuals_;
  const Deadline& deadline_;
  int rows_, unknowns_;
  math::Matrix system_;
  std::vector<double> r_, right_, scale_;
};

}  // namespace

DeltaEFit deltae_fit(const DeltaEProblem& problem, const std::vector<std::vector<color::Rgb>>& starts,
                     const Deadline& deadline) {
  DeltaEFit best;
  const Residuals residuals(problem);
  Search search(residuals, deadline);
  std::vector<double> best_x;
  double best_value = 0;
  for (const std::vector<color::Rgb>& start : starts) {
    std::vector<double> x;
    for (const color::Rgb& rgb : start)
      for (int c = 0; c < 3; ++c) x.push_back(std::max(rgb[c], 0.0));
    double value = 0;
    const FitStatus status = search.run(x, value);
    if (!best_x.empty() && value >= best_value) continue;
    best_value = value, best.status = status, best_x = std::move(x);
  }
  best.objective = std::sqrt(best_value);
  best.optimality_gap = stationarity(residuals, best_x);
  for (std::size_t j = 0; j < best_x.size(); j += 3) best.x.push_back({best_x[j], best_x[j + 1], best_x[j + 2]});
  return best;
}

}  // namespace goniochrome::fit
