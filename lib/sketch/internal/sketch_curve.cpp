#include "sketch/internal/sketch_curve.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "base/angles.h"
#include "base/parallel.h"
#include "brdf/lobe_model.h"
#include "math/statistics.h"
#include "sketch/internal/outliers.h"
#include "sketch/internal/sketch_lobes.h"
#include "sketch/internal/sketch_solve.h"

namespace goniochrome::sketch {

namespace {

constexpr int kBinsPerDegree = 4, kAngleBins = 180 * kBinsPerDegree + 1, kCosineBins = 12;
constexpr std::size_t kMostPerCell = 256;  // samples looked at; more add nothing
constexpr double kFullCount = 64;          // samples from which a cell has its full say
constexpr double kDarkest = 0.004;         // of a channel, for its weight; L* 4
constexpr int kIterations = 12;
constexpr std::size_t kScannedCells = 500;  // for the travel alone

// The mean of the samples within three deviations of the median in every channel.
SketchCell robust_mean(const SketchSample* samples, std::size_t count) {
  const std::size_t step = (count + kMostPerCell - 1) / kMostPerCell;
  std::array<double, 3> low{}, high{};
  std::vector<double> values, apart;
  for (int c = 0; c < 3; ++c) {
    values.clear(), apart.clear();
    for (std::size_t i = 0; i < count; i += step) values.push_back(samples[i].seen[c] / samples[i].cos_i);
    const double middle = math::median(values);
    for (const double value : values) apart.push_back(std::abs(value - middle));
    const double reach = 3 * kSigmas * math::median(apart) + 1e-3 * std::abs(middle) + 1e-6;
    low[c] = middle - reach, high[c] = middle + reach;
  }
  SketchCell cell;
  for (std::size_t i = 0; i < count; i += step) {
    const SketchSample& s = samples[i];
    bool inside = true;
    for (int c = 0; c < 3; ++c) {
      const double value = s.seen[c] / s.cos_i;
      inside &= low[c] <= value && value <= high[c];
    }
    if (!inside) continue;
    cell.count += 1, cell.aspecular_deg += s.aspecular_deg, cell.cos_i += s.cos_i;
    cell.view_deg += s.view_deg;
    for (int c = 0; c < 3; ++c) cell.seen[c] += s.seen[c];
  }
  if (cell.count == 0) return cell;
  const double share = 1 / cell.count;
  cell.aspecular_deg *= share, cell.cos_i *= share, cell.seen = share * cell.seen, cell.view_deg *= share;
  cell.count *= static_cast<double>(step);
  return cell;
}

// The data of a cell for reweighted least squares: weights that turn each channel's residual into lightness.
struct Weighing {
  std::vector<color::Rgb> lightness;  // dL*/dv of each channel
  std::vector<double> count;          // 0..1
  std::vector<double> agreement;      // robust weight

  explicit Weighing(const std::vector<SketchCell>& cells) : agreement(cells.size(), 1.0) {
    for (const SketchCell& cell : cells) {
      color::Rgb weight;
      for (int c = 0; c < 3; ++c) weight[c] = 116.0 / 3 * std::pow(std::max(cell.seen[c], kDarkest), -2.0 / 3);
      lightness.push_back(weight);
      count.push_back(cell_importance(cell));
    }
  }

  double square(std::size_t i, int c) const { return count[i] * agreement[i] * lightness[i][c] * lightness[i][c]; }

  // Residuals of light(i) in L*, from which the weights of the next round follow: those of least absolute deviations
  // first, then Cauchy's. Returns the cost, sum of count log(1 + (r/s)^2) with s fixed, over the sum of counts.
  template <class Light>
  double reweigh(const std::vector<SketchCell>& cells, Light&& light, bool absolute) {
    std::vector<double> residual(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) residual[i] = length(lightness[i] * (light(i) - cells[i].seen));
    const double scale = kTuning * std::max(kSigmas * math::median(residual), kLeastScale);
    double cost = 0, all = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const double r = residual[i] / scale, fixed = residual[i];
      agreement[i] = absolute ? 1 / std::max(r, 0.1) : 1 / (1 + r * r);
      cost += count[i] * std::log1p(fixed * fixed), all += count[i];
    }
    return cost / all;
  }
};

Eigen::Vector3d quadratic_row(double travel_deg, const SketchCell& cell) {
  const double u = std::min(cell.aspecular_deg, travel_deg) / travel_deg;
  return {cell.cos_i * u * u, cell.cos_i * u, cell.cos_i};
}

// The quadratic of a given travel; a trace of ridge keeps rank-deficient systems finite.
CurveFit quadratic_at(double travel_deg, const std::vector<SketchCell>& cells, int iterations) {
  CurveFit fit;
  fit.curve.travel_deg = travel_deg;
  Weighing weighing(cells);
  std::vector<Eigen::Vector3d> rows;
  for (const SketchCell& cell : cells) rows.push_back(quadratic_row(travel_deg, cell));
  for (int round = 0; round < iterations; ++round) {
    for (int c = 0; c < 3; ++c) {
      Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
      Eigen::Vector3d right = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const double weight = weighing.square(i, c);
        gram += weight * rows[i] * rows[i].transpose();
        right += weight * cells[i].seen[c] * rows[i];
      }
      gram.diagonal() += 1e-9 * gram.diagonal() + Eigen::Vector3d::Constant(1e-12);
      const Eigen::Vector3d x = gram.ldlt().solve(right);
      for (int k = 0; k < 3; ++k) fit.curve.quadratic[k][c] = x[k];
    }
    const auto& q = fit.curve.quadratic;
    const auto light = [&](std::size_t i) { return rows[i][0] * q[0] + rows[i][1] * q[1] + rows[i][2] * q[2]; };
    fit.cost = weighing.reweigh(cells, light, round < iterations / 2);
  }
  return fit;
}

// About kScannedCells of the cells, of all angles and cosines alike.
std::vector<SketchCell> sample_of(const std::vector<SketchCell>& cells) {
  const std::size_t step = sketch_step(cells.size(), kScannedCells);
  std::vector<SketchCell> some;
  for (std::size_t i = 0; i < cells.size(); i += step) some.push_back(cells[i]);
  return some;
}

// The condition of the three columns under the final weights, by luminance' channel, each column of length 1.
double condition_of(double travel_deg, const std::vector<SketchCell>& cells) {
  const Weighing weighing(cells);
  Eigen::Matrix3d gram = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const Eigen::Vector3d row = quadratic_row(travel_deg, cells[i]);
    gram += weighing.square(i, 1) * row * row.transpose();
  }
  const Eigen::Vector3d length = gram.diagonal().cwiseSqrt();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) gram(i, j) /= std::max(length[i] * length[j], 1e-300);
  const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(gram).eigenvalues();
  return values[2] > 0 ? std::sqrt(values[2] / std::max(values[0], 1e-30)) : 1e15;
}

// Exponents two to the power of 1: between two of them any sharper or wider lobe is their mixture to half a percent.
const std::vector<double>& lobe_exponents_used() {
  static const std::vector<double> all = {1, 2, 4, 8, 16, 32, 64, 128, 256};
  return all;
}
constexpr std::size_t kFirstGloss = 3;  // gloss lobes are at least this sharp
constexpr int kLobeColumns = 1 + 9 + 6;
constexpr double kShownFrom_deg = 15;  // the curve is asked for from here on
constexpr double kMostGrowth = 2;      // of a lobe from the first angle seen to the first asked for

// True if the angles seen determine the weight of a lobe this sharp. A lobe that is nearly 0 at all of them could take
// any weight, and would follow the noise of the first cells up to any color.
bool is_lobe_seen(double exponent, double from_deg) {
  return kMostGrowth * lobe_at(from_deg, exponent) >= lobe_at(std::min(from_deg, kShownFrom_deg), exponent);
}

// `from_deg`: the first angle of all cells.
std::array<double, kLobeColumns> lobe_row(const SketchCell& cell, double from_deg) {
  const auto& exponents = lobe_exponents_used();
  std::array<double, kLobeColumns> row{cell.cos_i};
  for (std::size_t j = 0; j < exponents.size(); ++j) {
    if (!is_lobe_seen(exponents[j], from_deg)) continue;
    const double power = lobe_at(cell.aspecular_deg, exponents[j]);
    row[1 + j] = cell.cos_i * power;
    if (j >= kFirstGloss) row[10 + j - kFirstGloss] = power;
  }
  return row;
}

}  // namespace

std::size_t sketch_step(std::size_t count, std::size_t most) {
  std::size_t step = std::max<std::size_t>(1, count / most);
  while (step > 1 && (step % 2 == 0 || step % 3 == 0)) ++step;
  return step;
}

double cell_importance(const SketchCell& cell) {
  return std::sqrt(std::min(cell.count, kFullCount) / kFullCount);
}

std::vector<SketchCell> sketch_cells(const std::vector<SketchSample>& samples) {
  const auto cell_of = [](const SketchSample& s) {
    const int angle = std::clamp(static_cast<int>(s.aspecular_deg * kBinsPerDegree), 0, kAngleBins - 1);
    const int cosine = std::clamp(static_cast<int>(s.cos_i * kCosineBins), 0, kCosineBins - 1);
    return static_cast<std::size_t>(angle * kCosineBins + cosine);
  };
  std::vector<std::size_t> begin(kAngleBins * kCosineBins + 1, 0);
  for (const SketchSample& s : samples) ++begin[cell_of(s) + 1];
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<SketchSample> sorted(samples.size());
  std::vector<std::size_t> place(begin.begin(), begin.end() - 1);
  for (const SketchSample& s : samples) sorted[place[cell_of(s)]++] = s;
  std::vector<SketchCell> cells(begin.size() - 1);
  parallel_for(cells.size(), kCosineBins, [&](std::size_t from, std::size_t to) {
    for (std::size_t i = from; i < to; ++i)
      if (begin[i + 1] > begin[i]) cells[i] = robust_mean(&sorted[begin[i]], begin[i + 1] - begin[i]);
  });
  std::erase_if(cells, [](const SketchCell& cell) { return cell.count == 0; });
  return cells;
}

color::Rgb SketchCurve::reflectance(double aspecular_deg) const {
  if (travel_deg > 0) {
    const double u = std::min(aspecular_deg, travel_deg) / travel_deg;
    return u * u * quadratic[0] + u * quadratic[1] + quadratic[2];
  }
  color::Rgb sum = diffuse;
  for (std::size_t j = 0; j < exponents.size(); ++j) sum += lobe_at(aspecular_deg, exponents[j]) * flake[j];
  return instrument_passages(aspecular_deg, coat_index) * sum;
}

double instrument_passages(double aspecular_deg, double coat_index) {
  constexpr double kLight_deg = 45;
  return brdf::coat_passages(coat_index, std::cos(kLight_deg * kDegree),
                             std::cos(brdf::instrument_view_deg(aspecular_deg) * kDegree));
}

color::Rgb SketchCurve::gloss(double aspecular_deg) const {
  color::Rgb sum;
  for (std::size_t j = 0; j < glare.size(); ++j)
    if (glare[j] != color::Rgb{}) sum += lobe_at(aspecular_deg, exponents[j]) * glare[j];
  return sum;
}

CurveFit fit_quadratic(const std::vector<SketchCell>& cells) {
  const std::vector<SketchCell> some = sample_of(cells);
  CurveFit best = quadratic_at(60, some, 4);
  const auto try_travel = [&](double travel_deg) {
    if (travel_deg <= 15 || travel_deg > 180) return;
    CurveFit fit = quadratic_at(travel_deg, some, 4);
    if (fit.cost < best.cost) best = std::move(fit);
  };
  for (double travel_deg = 20; travel_deg <= 180; travel_deg += 10) try_travel(travel_deg);
  for (const double step : {5.0, 2.5, 1.25, 0.6}) {
    const double middle = best.curve.travel_deg;
    try_travel(middle - step), try_travel(middle + step);
  }
  best = quadratic_at(best.curve.travel_deg, cells, kIterations);
  best.condition = condition_of(best.curve.travel_deg, cells);
  return best;
}

CurveFit fit_lobes(const std::vector<SketchCell>& cells) {
  CurveFit fit;
  SketchCurve& curve = fit.curve;
  curve.exponents = lobe_exponents_used();
  curve.flake.resize(curve.exponents.size()), curve.glare.resize(curve.exponents.size());
  Weighing weighing(cells);
  std::vector<std::array<double, kLobeColumns>> rows;
  for (const SketchCell& cell : cells) rows.push_back(lobe_row(cell, cells.front().aspecular_deg));
  std::array<color::Rgb, kLobeColumns> weights;
  for (int round = 0; round < kIterations; ++round) {
    for (int c = 0; c < 3; ++c) {
      NormalEquations normal(kLobeColumns);
      for (std::size_t i = 0; i < cells.size(); ++i)
        normal.add(rows[i].data(), cells[i].seen[c], weighing.square(i, c));
      const std::vector<double> x = normal.non_negative();
      for (int k = 0; k < kLobeColumns; ++k) weights[k][c] = x[k];
      curve.diffuse[c] = x[0];
      for (std::size_t j = 0; j < curve.exponents.size(); ++j) {
        curve.flake[j][c] = x[1 + j];
        if (j >= kFirstGloss) curve.glare[j][c] = x[10 + j - kFirstGloss];
      }
    }
    const auto light = [&](std::size_t i) {
      color::Rgb sum;
      for (int k = 0; k < kLobeColumns; ++k) sum += rows[i][k] * weights[k];
      return sum;
    };
    fit.cost = weighing.reweigh(cells, light, round < kIterations / 2);
  }
  return fit;
}

color::Rgb mean_diffuse(const std::vector<SketchCell>& cells) {
  color::Rgb sum;
  double all = 0;
  for (const SketchCell& cell : cells) {
    sum += (cell.count * cell.cos_i) * cell.seen;
    all += cell.count * cell.cos_i * cell.cos_i;
  }
  return all > 0 ? (1 / all) * sum : color::Rgb{};
}

}  // namespace goniochrome::sketch
