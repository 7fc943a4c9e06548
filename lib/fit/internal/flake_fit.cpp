#include "fit/internal/flake_fit.h"

#include <algorithm>
#include <cmath>

#include "math/cosine_power.h"
#include "math/statistics.h"

namespace goniochrome::fit {

Norm norm_of(FitMethod method) {
  return method == FitMethod::kL1 ? Norm::kL1 : Norm::kL2;
}

LinearFit linear_fit(Norm norm, const LinearProblem& problem) {
  math::Matrix weighted = problem.shape;
  for (int j = 0; j < problem.columns(); ++j)
    for (int i = 0; i < problem.rows(); ++i) weighted(i, j) *= problem.weight[i];
  LinearFit fit;
  fit.x.resize(static_cast<std::size_t>(problem.columns()));
  std::vector<double> b(problem.weight.size());
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < b.size(); ++i) b[i] = problem.weight[i] * problem.value[i][c];
    const math::NonNegativeFit solved = norm == Norm::kL1 ? math::l1_fit(weighted, b) : math::nnls(weighted, b);
    fit.converged = fit.converged && solved.converged;
    fit.optimality_gap = std::max(fit.optimality_gap, solved.optimality_gap);
    sum += norm == Norm::kL1 ? solved.objective : solved.objective * solved.objective;
    for (std::size_t j = 0; j < fit.x.size(); ++j) fit.x[j][c] = solved.x[j];
  }
  fit.objective = norm == Norm::kL1 ? sum : std::sqrt(sum);
  return fit;
}

LinearProblem with_columns(const LinearProblem& problem, const std::vector<int>& columns) {
  LinearProblem part{math::Matrix(problem.rows(), static_cast<int>(columns.size())), problem.weight, problem.value};
  for (std::size_t j = 0; j < columns.size(); ++j)
    std::copy_n(problem.shape.column(columns[j]), problem.rows(), &part.shape(0, static_cast<int>(j)));
  return part;
}

std::vector<color::Rgb> predictions(const LinearProblem& problem, const std::vector<color::Rgb>& x) {
  std::vector<color::Rgb> shown(static_cast<std::size_t>(problem.rows()));
  for (int j = 0; j < problem.columns(); ++j) {
    if (x[j] == color::Rgb{}) continue;
    for (int i = 0; i < problem.rows(); ++i) shown[i] += problem.shape(i, j) * x[j];
  }
  return shown;
}

namespace {

// |W(Mx-b)| as LinearFit has it; with all weights 1 where `plain`.
double error_norm(Norm norm, const LinearProblem& problem, const std::vector<color::Rgb>& x, bool plain = false) {
  const std::vector<color::Rgb> shown = predictions(problem, x);
  double sum = 0;
  for (std::size_t i = 0; i < shown.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double r = (plain ? 1 : problem.weight[i]) * (problem.value[i][c] - shown[i][c]);
      sum += norm == Norm::kL1 ? std::abs(r) : r * r;
    }
  return norm == Norm::kL1 ? sum : std::sqrt(sum);
}

// The last polish of a fit: weights that make the CIEDE2000 differences at the readings least. The color that is
// predicted where a shape stands is sum_j shape[j] x[j], x[j] >= 0 a working-space triple per column.
struct DeltaEProblem {
  int columns = 0;
  color::Xyz white;  // that the Lab values are relative to
  struct Reading {
    std::vector<double> shape;
    color::Lab lab;
  };
  std::vector<Reading> readings;
  // Inferred rows, which steer where no reading is: residual weight * (prediction - value), in L*.
  struct Guide {
    std::vector<double> shape;
    color::Rgb value;
    double weight = 0;
  };
  std::vector<Guide> guides;
};

// The residuals are three for each reading (a vector of length dE00) and three for each guide; the unknowns are x,
// column by column.
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

// A gap up to this is none: on sample paints, where the search ended by itself, it was at most 1e-4.
constexpr double kStationary = 1e-4;

// How far x is from stationary: for each column of the derivative, where x may still move that way, its cosine to the
// residual, or less where the whole residual is shorter than what is seen.
double stationarity(const Residuals& residuals, const std::vector<double>& x) {
  std::vector<double> r;
  math::Matrix j(residuals.rows(), residuals.unknowns());
  residuals.linearize(x, r, j);
  double size = 0;
  for (const double v : r) size += v * v;
  // Residuals below what is seen have no direction that counts.
  size = std::max(size, kVisible_de00 * kVisible_de00);
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
// so that weights enter and leave the bounds many at a time. It is stationary to rounding after 10 to 30 steps; Ceres'
// trust region, whose steps are projected onto the bounds, was still on its way after 400.
class FlakeSearch {
 public:
  FlakeSearch(const Residuals& residuals, const Deadline& deadline)
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

double stationarity(const DeltaEProblem& problem, const std::vector<color::Rgb>& x) {
  std::vector<double> flat;
  for (const color::Rgb& rgb : x)
    for (int c = 0; c < 3; ++c) flat.push_back(rgb[c]);
  return stationarity(Residuals(problem), flat);
}

// The best of the local minima reached from each start, which is never worse than a start.
FlakeFit deltae_fit(const DeltaEProblem& problem, const std::vector<std::vector<color::Rgb>>& starts,
                    const Deadline& deadline) {
  FlakeFit best;
  const Residuals residuals(problem);
  FlakeSearch search(residuals, deadline);
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
  for (std::size_t j = 0; j < best_x.size(); j += 3) best.x.push_back({best_x[j], best_x[j + 1], best_x[j + 2]});
  return best;
}

// Many small rows count more in a squared norm than in a sum of absolute values, so inferred rows have less weight in
// the search for color differences than in the linear fits.
constexpr double kGuideShare = 0.5;

// Color differences for the comparison of two fits: the mean over the readings, their median where they are many, and
// the mean over the readings that stand for them.
struct Differences {
  double mean = 0, median = 0, usual = 0;

  bool no_worse_than(const Differences& other) const {
    constexpr double kUnseen_de00 = 0.01;
    return mean <= other.mean + kUnseen_de00 && median <= other.median + kUnseen_de00 &&
           usual <= other.usual + kUnseen_de00;
  }
};

std::vector<double> differences_at(const std::vector<FlakeReading>& readings, const color::Xyz& white,
                                   const FlakeModel& model, const std::vector<color::Rgb>& x) {
  std::vector<double> de00;
  for (const FlakeReading& reading : readings)
    de00.push_back(
        color::delta_e_2000(reading.lab, color::lab_from_rgb(reading.passages * shown(model, x, reading.at), white)));
  return de00;
}

Differences differences(const FlakeTarget& target, const FlakeModel& model, const std::vector<color::Rgb>& x) {
  constexpr std::size_t kMany = 20;
  Differences out;
  const std::vector<double> all = differences_at(target.readings, target.white, model, x),
                            usual = differences_at(target.usual, target.white, model, x);
  if (!all.empty()) out.mean = math::mean(all);
  if (all.size() > kMany) out.median = math::median(all);
  if (!usual.empty()) out.usual = math::mean(usual);
  return out;
}

// The search makes the sum of squares least, by which a few large differences can fall while most of them rise. Where
// that happens, the weights go back toward those of the l1 fit as far as needed to be no worse than it; all weights
// between the two are non-negative too. Returns whether the weights had to go back.
bool bound_by(const std::vector<color::Rgb>& l1, const FlakeTarget& target, const FlakeModel& model,
              std::vector<color::Rgb>& x) {
  constexpr int kBacks = 16;
  const Differences bound = differences(target, model, l1);
  const std::vector<color::Rgb> free = x;
  for (int back = 0; back <= kBacks; ++back) {
    const double share = static_cast<double>(back) / kBacks;
    for (std::size_t j = 0; j < x.size(); ++j) x[j] = (1 - share) * free[j] + share * l1[j];
    if (differences(target, model, x).no_worse_than(bound)) return back > 0;
  }
  return true;
}

// The weight, in each row, of the difference between one view and the next.
constexpr double kSmoothnessShare = 0.1;

// Rows that ask two neighboring views to show the same, at the angles of the target's rows, no closer than about 9 deg.
void add_smoothness(const FlakeTarget& target, const FlakeModel& model, LinearProblem& problem) {
  const int views = static_cast<int>(model.views_deg.size()), width = model.columns_per_view();
  constexpr double kApart_rad = 0.16;
  std::vector<const FlakeRow*> angles;
  for (const FlakeRow& row : target.rows)
    if (std::ranges::none_of(angles, [&](const FlakeRow* other) {
          return std::abs(other->at.aspecular_rad - row.at.aspecular_rad) < kApart_rad;
        }))
      angles.push_back(&row);
  const int known = problem.rows(), more = (views - 1) * static_cast<int>(angles.size());
  math::Matrix all(known + more, problem.columns());
  for (int j = 0; j < problem.columns(); ++j) std::copy_n(problem.shape.column(j), known, &all(0, j));
  std::vector<double> shape(static_cast<std::size_t>(width));
  int i = known;
  for (const FlakeRow* row : angles) {
    const FlakeModel plain{model.exponents};
    plain.shape(row->at, shape.data());
    for (int v = 0; v + 1 < views; ++v, ++i) {
      for (int j = 0; j < width; ++j) all(i, v * width + j) = -shape[j], all(i, (v + 1) * width + j) = shape[j];
      problem.weight.push_back(kSmoothnessShare * row->weight);
      problem.value.push_back({});
    }
  }
  problem.shape = std::move(all);
}

// An error in a row that weighs so much more costs the l1 fit more than all other rows gain by it. The fit then meets
// such rows exactly where it can, and the other rows are the best that is left.
constexpr double kHeldWeight = 1e4;

DeltaEProblem deltae_problem(const FlakeTarget& target, const FlakeModel& model, const LinearProblem& linear) {
  DeltaEProblem problem;
  problem.columns = model.columns();
  problem.white = target.white;
  const auto width = static_cast<std::size_t>(problem.columns);
  for (const FlakeReading& reading : target.readings) {
    std::vector<double> shape(width);
    model.shape(reading.at, shape.data());
    for (double& s : shape) s *= reading.passages;
    problem.readings.push_back({std::move(shape), reading.lab});
  }
  for (int i = 0; i < linear.rows(); ++i) {
    if (i < static_cast<int>(target.rows.size()) && !target.rows[i].inferred) continue;
    std::vector<double> shape(width);
    for (std::size_t j = 0; j < width; ++j) shape[j] = linear.shape(i, static_cast<int>(j));
    problem.guides.push_back({std::move(shape), linear.value[i], kGuideShare * linear.weight[i]});
  }
  return problem;
}

}  // namespace

void FlakeModel::shape(const FlakePoint& at, double* columns) const {
  const int width = columns_per_view();
  const double log_cos = math::log_cosine(at.aspecular_rad);
  const auto lobes = [&](double* first, double share) {
    first[0] = share;
    for (int j = 1; j < width; ++j) first[j] = share * math::power_of_cosine(log_cos, exponents[j - 1]);
  };
  if (views_deg.empty()) return lobes(columns, 1);
  std::fill(columns, columns + this->columns(), 0.0);
  const auto above = std::ranges::upper_bound(views_deg, at.view_deg) - views_deg.begin();
  const auto last = static_cast<std::ptrdiff_t>(views_deg.size()) - 1;
  if (above == 0 || above > last) return lobes(columns + width * std::min(above, last), 1);
  const double share = (at.view_deg - views_deg[above - 1]) / (views_deg[above] - views_deg[above - 1]);
  lobes(columns + width * (above - 1), 1 - share);
  lobes(columns + width * above, share);
}

color::Rgb shown(const FlakeModel& model, const std::vector<color::Rgb>& x, const FlakePoint& at) {
  std::vector<double> shape(x.size());
  model.shape(at, shape.data());
  color::Rgb sum;
  for (std::size_t j = 0; j < x.size(); ++j) sum += shape[j] * x[j];
  return sum;
}

LinearProblem linear_problem(const FlakeTarget& target, const FlakeModel& model) {
  LinearProblem problem{math::Matrix(static_cast<int>(target.rows.size()), model.columns())};
  std::vector<double> shape(static_cast<std::size_t>(model.columns()));
  for (int i = 0; i < problem.rows(); ++i) {
    model.shape(target.rows[i].at, shape.data());
    for (int j = 0; j < problem.columns(); ++j) problem.shape(i, j) = shape[j];
    problem.weight.push_back(target.rows[i].weight);
    problem.value.push_back(target.rows[i].value);
  }
  return problem;
}

FlakeFit flake_fit(FitMethod method, const FlakeTarget& target, const FlakeModel& model, const Deadline& deadline) {
  LinearProblem problem = linear_problem(target, model);
  if (model.views_deg.size() > 1) add_smoothness(target, model, problem);
  const std::vector<double> weight = problem.weight;
  for (std::size_t i = 0; i < target.rows.size(); ++i)
    if (target.rows[i].held) problem.weight[i] *= kHeldWeight;
  FlakeFit fit;
  if (method == FitMethod::kDeltaE) {
    const std::vector<std::vector<color::Rgb>> starts = {linear_fit(Norm::kL1, problem).x,
                                                         linear_fit(Norm::kL2, problem).x};
    const DeltaEProblem search = deltae_problem(target, model, problem);
    fit = deltae_fit(search, starts, deadline);
    const bool went_back = bound_by(starts.front(), target, model, fit.x);
    fit.optimality_gap = stationarity(search, fit.x);
    const bool gap = fit.optimality_gap > kStationary;
    if (went_back && fit.status != FitStatus::kTimeLimit) fit.status = gap ? FitStatus::kBounded : FitStatus::kOptimal;
    if (gap && fit.status == FitStatus::kOptimal) fit.status = FitStatus::kStalled;
  } else {
    LinearFit best = linear_fit(norm_of(method), problem);
    fit.x = std::move(best.x);
    fit.optimality_gap = best.optimality_gap;
    if (!best.converged) fit.status = FitStatus::kNotConverged;
  }
  problem.weight = weight;
  fit.objective = error_norm(norm_of(method), problem, fit.x);
  fit.plain_objective = error_norm(norm_of(method), problem, fit.x, true);
  return fit;
}

}  // namespace goniochrome::fit
