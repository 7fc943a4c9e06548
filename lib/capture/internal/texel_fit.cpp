#include "capture/internal/texel_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/angles.h"
#include "math/least_squares.h"
#include "math/statistics.h"

namespace goniochrome::capture {

namespace {

constexpr double kTukey = 4.5;            // standard deviations beyond which a value counts for nothing
constexpr double kMedianOfThree = 0.888;  // the median of the root mean square of three normal deviates

// Lobes about the mirror direction of exponents 1 to 2048; lobes that lie long in one of four directions; and lobes
// that look back to the light.
LobeShapes dictionary() {
  LobeShapes lobes;
  for (int k = 0; k <= 11; ++k) lobes.push_back({k * std::log(2.0), -1, 0, 0});
  for (const double log_exponent : {std::log(10.0), std::log(40.0), std::log(160.0)})
    for (int turn = 0; turn < 4; ++turn)
      for (const double odd : {0.35}) {
        const double twice = turn * kPi / 2;
        lobes.push_back({log_exponent, -1 + odd, -odd * std::cos(twice), -odd * std::sin(twice)});
      }
  for (const double exponent : {2.0, 16.0}) lobes.push_back({std::log(exponent), 1, 0, 0});
  return lobes;
}

double squared(double x) {
  return x * x;
}

double apart(const LobeShape& a, const LobeShape& b) {
  return squared(a.log_exponent - b.log_exponent) +
         4 * (squared(a.even - b.even) + squared(a.cos_part - b.cos_part) + squared(a.sin_part - b.sin_part));
}

// Two lobes as one, by their energies.
LobeShape merged(const LobeShape& a, double of_a, const LobeShape& b, double of_b) {
  const double s = of_a / (of_a + of_b), t = 1 - s;
  return {s * a.log_exponent + t * b.log_exponent, s * a.even + t * b.even, s * a.cos_part + t * b.cos_part,
          s * a.sin_part + t * b.sin_part};
}

// Merges lobes until `wanted` are left, each time the pair that loses least.
void merge_to(int wanted, LobeShapes& lobes, std::vector<double>& energy) {
  while (static_cast<int>(lobes.size()) > wanted) {
    std::size_t first = 0, second = 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < lobes.size(); ++i)
      for (std::size_t j = i + 1; j < lobes.size(); ++j) {
        const double loss = energy[i] * energy[j] / (energy[i] + energy[j]) * apart(lobes[i], lobes[j]);
        if (loss < least) least = loss, first = i, second = j;
      }
    lobes[first] = merged(lobes[first], energy[first], lobes[second], energy[second]);
    energy[first] += energy[second];
    lobes.erase(lobes.begin() + static_cast<std::ptrdiff_t>(second));
    energy.erase(energy.begin() + static_cast<std::ptrdiff_t>(second));
  }
}

std::vector<double> collected(const TexelSamples& samples, const Eigen::ArrayXd& from, Use use) {
  std::vector<double> values;
  for (Eigen::Index i = 0; i < samples.count(); ++i)
    if (samples.use[i] == use) values.push_back(from[i]);
  return values;
}

}  // namespace

TexelFitter::TexelFitter(const TexelOptions& options) : options_(options), dictionary_(dictionary()) {}

// The standard deviation of a value is that of its rounding and a share of the value or of the model, whichever is
// larger: by the value alone, a shadow would be taken for a reading of great precision.
void TexelFitter::expect(const TexelSamples& samples, const Eigen::ArrayX3d& model) {
  const double floor = 0.1 * options_.relative_noise * level_;
  const Eigen::ArrayXd size = model.rowwise().mean().max(mean_);
  sigma_ = (samples.rounding.square() + (options_.relative_noise * size).square() + floor * floor).sqrt();
  distance_ = ((model - samples.value).square().rowwise().mean()).sqrt() / sigma_;
  for (Eigen::Index i = 0; i < samples.count(); ++i) {
    if (samples.use[i] == Use::kNone) distance_[i] = 0;
    // A saturated value says only that the surface is at least as bright.
    if (samples.use[i] == Use::kLowerBound && model.row(i).mean() >= mean_[i]) distance_[i] = 0;
  }
}

void TexelFitter::weigh(const TexelSamples& samples, const Eigen::ArrayX3d& model, double floor_spread, bool gentle,
                        State& state) {
  expect(samples, model);
  const std::vector<double> distances = collected(samples, distance_, Use::kValue);
  state.spread = distances.empty() ? 1 : std::max(floor_spread, math::median(distances) / kMedianOfThree);
  weight_ = sigma_.inverse();
  for (Eigen::Index i = 0; i < samples.count(); ++i) {
    const bool bound_met = samples.use[i] == Use::kLowerBound && distance_[i] == 0;
    if (samples.use[i] == Use::kNone || bound_met) {
      weight_[i] = 0;
    } else if (options_.robust) {
      const double t = distance_[i] / state.spread;
      weight_[i] *= gentle ? 1 / std::sqrt(1 + t * t) : t < kTukey ? 1 - squared(t / kTukey) : 0.0;
    }
  }
}

// The weights before any model is known. False: there is nothing to fit.
bool TexelFitter::begin(const TexelSamples& samples) {
  mean_ = samples.value.rowwise().mean();
  const std::vector<double> values = collected(samples, mean_, Use::kValue);
  constexpr std::size_t kFewest = 4;
  if (values.size() < kFewest) return false;
  level_ = math::median(values);
  if (!(level_ > 0)) return false;
  if (options_.method == FitMethod::kNonlinear) {
    sigma_.setConstant(samples.count(), std::max(level_, std::numeric_limits<double>::min()) * options_.relative_noise);
  } else {
    sigma_ = (samples.rounding.square() + (options_.relative_noise * mean_.max(level_)).square()).sqrt();
  }
  weight_ = (samples.use == Use::kValue).select(sigma_.inverse(), 0.0);
  return true;
}

// The robust loss of Tukey, for a spread that is the same for all that are compared.
double TexelFitter::cost(const TexelSamples& samples, const State& state, double spread) {
  model_.solve(samples, state.shapes, weight_, false);
  model_.put_model(model_values_);
  expect(samples, model_values_);
  double sum = 0;
  for (Eigen::Index i = 0; i < samples.count(); ++i) {
    const double u = std::min(1.0, squared(distance_[i] / (kTukey * spread)));
    sum += options_.robust ? 1 - (1 - u) * (1 - u) * (1 - u) : squared(distance_[i]);
  }
  return sum;
}

void TexelFitter::improve(const TexelSamples& samples, const ShapePrior& prior, int rounds, int iterations,
                          bool in_common, State& state) {
  for (int round = 0; round < rounds; ++round) {
    if (options_.method == FitMethod::kDictionary) {
      model_.solve(samples, state.shapes, weight_, false);
      model_.put_model(model_values_);
      weigh(samples, model_values_, 0.25, false, state);
    }
    // The prior is in the standard deviations that the residuals have, not in those expected.
    ShapePrior scaled = prior;
    scaled.log_exponent /= state.spread, scaled.axes /= state.spread;
    refine(samples, weight_, scaled, iterations, state.shapes, in_common ? &state.frame : nullptr);
  }
}

LobeShapes TexelFitter::plain_start() const {
  constexpr double kFirst[kMostLobes] = {10, 60, 250, 3};
  LobeShapes shapes;
  for (int j = 0; j < options_.lobes; ++j) shapes.push_back({std::log(kFirst[j]), -1, 0, 0});
  return shapes;
}

// Gray weights of all lobes of the dictionary and of the diffuse part; then the lobes with weight, merged.
LobeShapes TexelFitter::dictionary_start(const TexelSamples& samples) {
  const auto rows = static_cast<int>(samples.count()), columns = static_cast<int>(dictionary_.size()) + 1;
  Eigen::MatrixXd all(rows, columns);
  all.col(0) = samples.cosine;
  for (int j = 1; j < columns; ++j) {
    put_lobe_column(samples, dictionary_[static_cast<std::size_t>(j) - 1], column_);
    all.col(j) = column_.value;
  }
  math::Matrix m(rows, columns);
  std::vector<double> b(static_cast<std::size_t>(rows));
  math::NonNegativeFit found;
  State state;
  for (int round = 0; round < (options_.robust ? 3 : 1); ++round) {
    for (int j = 0; j < columns; ++j) Eigen::Map<Eigen::ArrayXd>(&m(0, j), rows) = all.col(j).array() * weight_;
    Eigen::Map<Eigen::ArrayXd>(b.data(), rows) = mean_ * weight_;
    found = math::nnls(m, b);
    const Eigen::VectorXd gray = all * Eigen::Map<Eigen::VectorXd>(found.x.data(), columns);
    // The colors differ from the gray model: only the brightness is compared here.
    model_values_ = samples.value;
    const Eigen::ArrayXd gain = (mean_ > 0).select(gray.array() / mean_.max(1e-30), 1.0);
    for (int c = 0; c < 3; ++c) model_values_.col(c) = samples.value.col(c) * gain;
    for (Eigen::Index i = 0; i < samples.count(); ++i)
      if (!(mean_[i] > 0)) model_values_.row(i).setConstant(gray[i]);
    weigh(samples, model_values_, 1, true, state);
  }
  LobeShapes lobes;
  std::vector<double> energy;
  for (int j = 1; j < columns; ++j) {
    const double x = found.x[static_cast<std::size_t>(j)];
    if (x <= 0) continue;
    lobes.push_back(dictionary_[static_cast<std::size_t>(j) - 1]);
    energy.push_back(x * (all.col(j).array() * weight_).matrix().norm());
  }
  merge_to(options_.lobes, lobes, energy);
  // Too few: the rest are lobes between those of the plain start and what was found.
  for (const LobeShape& shape : plain_start()) {
    if (static_cast<int>(lobes.size()) == options_.lobes) break;
    lobes.push_back(shape);
  }
  return lobes;
}

TexelFitter::State TexelFitter::own_fit(const TexelSamples& samples, LobeShapes start) {
  State state;
  const bool plain = options_.method == FitMethod::kNonlinear;
  state.shapes = std::move(start);
  const ShapePrior prior{state.shapes, plain ? 100.0 : 1.5, plain ? 100.0 : 0.7};
  improve(samples, prior, plain ? 1 : 2, plain ? 30 : 5, false, state);
  std::vector<double> energy;
  model_.solve(samples, state.shapes, weight_, false);
  for (int j = 0; j < options_.lobes; ++j) energy.push_back(model_.strengths().row(j + 1).sum());
  state.frame = shared_frame(energy, state.shapes);
  const ShapePrior turned{state.shapes, prior.log_exponent, prior.axes};
  improve(samples, turned, plain ? 1 : 3, plain ? 30 : 5, true, state);
  return state;
}

TexelFit TexelFitter::fit(const TexelSamples& samples, const std::vector<Start>& starts) {
  if (!begin(samples)) return unfitted();
  const Eigen::ArrayXd first = weight_;
  State best;
  double least = std::numeric_limits<double>::infinity();
  if (options_.method == FitMethod::kDictionary) {
    for (const Start& start : starts) {
      State state{start.shapes, start.frame, 1};
      weight_ = first;
      improve(samples, {start.shapes, 0.7, 0.35}, 3, 4, true, state);
      const double here = cost(samples, state, 1);
      if (here < least) least = here, best = std::move(state);
    }
    if (best.spread < options_.good_spread && !best.shapes.empty()) return finished(samples, std::move(best));
  } else {
    return finished(samples, own_fit(samples, plain_start()));
  }
  weight_ = first;
  const LobeShapes from_dictionary = dictionary_start(samples);
  const Eigen::ArrayXd robust = weight_;
  for (const LobeShapes& start : {from_dictionary, plain_start()}) {
    weight_ = robust;
    State own = own_fit(samples, start);
    const double here = cost(samples, own, 1);
    if (here < least) least = here, best = std::move(own);
    if (best.spread < options_.good_spread) break;
  }
  return finished(samples, std::move(best));
}

// Black, and not certain.
TexelFit TexelFitter::unfitted() const {
  TexelFit fit;
  fit.shapes = plain_start();
  for (const LobeShape& shape : fit.shapes)
    fit.surface.lobes.push_back({{}, {-1, -1, 1}, std::exp(shape.log_exponent)});
  return fit;
}

TexelFit TexelFitter::together(const TexelSamples& samples, const TexelFit& fit, const std::vector<Start>& neighbors) {
  if (!begin(samples)) return unfitted();
  State best{fit.shapes, fit.frame, fit.spread};
  weigh(samples, fitted_values(samples, fit), 0.25, false, best);
  const Eigen::ArrayXd first = weight_;
  const double spread = std::max(1.0, best.spread);
  State start = best;
  double least = cost(samples, best, spread);
  for (const Start& neighbor : neighbors) {
    State state{neighbor.shapes, neighbor.frame, best.spread};
    weight_ = first;
    const double here = cost(samples, state, spread);
    if (here < least) least = here, start = std::move(state);
  }
  weight_ = first;
  const ShapePrior prior{start.shapes, 0.5, 0.25};
  improve(samples, prior, 2, 4, true, start);
  return finished(samples, std::move(start));
}

// Sorts the lobes, takes the strengths a last time, bounds what nothing has determined, and tells how sure all is.
TexelFit TexelFitter::finished(const TexelSamples& samples, State state) {
  std::ranges::sort(state.shapes, {}, &LobeShape::log_exponent);
  for (int round = 0; round < 2 && options_.method == FitMethod::kDictionary; ++round) {
    model_.solve(samples, state.shapes, weight_, false);
    model_.put_model(model_values_);
    weigh(samples, model_values_, 0.25, false, state);
  }
  model_.solve(samples, state.shapes, weight_, false);
  model_.put_model(model_values_);
  expect(samples, model_values_);
  TexelFit fit;
  fit.spread = state.spread, fit.shapes = state.shapes, fit.frame = state.frame;
  fit.surface.diffuse = model_.diffuse();
  fit.certain = true;
  const double c = std::cos(state.frame.twice_angle), s = std::sin(state.frame.twice_angle);
  for (int j = 0; j < options_.lobes; ++j) {
    const LobeShape& shape = state.shapes[static_cast<std::size_t>(j)];
    const double odd = c * shape.cos_part + s * shape.sin_part, n = std::exp(shape.log_exponent);
    put_lobe_column(samples, shape, column_);
    // A lobe that no value shows is none, and leaves nothing open.
    const double strength = model_.strengths().row(j + 1).mean();
    const double shown = (weight_ > 0).select(strength * column_.value / sigma_, 0.0).maxCoeff();
    constexpr double kShown = 1.5;  // standard deviations
    const bool is_shown = shown > kShown * fit.spread;
    brdf::LafortuneLobe lobe{
        is_shown ? model_.albedo(j, shape) : color::Rgb{}, {shape.even + odd, shape.even - odd, 1}, n};
    // A surface does not send back more light than it gets. Where a lobe was seen far from its peak only, its strength
    // there is a guess, and a small slip of the exponent makes it anything.
    const double peak = std::max({1.0, std::abs(lobe.axes.x), std::abs(lobe.axes.y)});
    for (int k = 0; k < 3; ++k) {
      const double energy = brdf::scaled_power(2 * kPi / (n + 1) * lobe.albedo[k], peak, n);
      constexpr double kMostEnergy = 1;
      if (energy <= kMostEnergy) continue;
      lobe.albedo[k] *= kMostEnergy / energy;
      fit.certain = false;
    }
    // The largest base of its power that was seen, against the one that it would have at its peak.
    double seen = 0;
    for (Eigen::Index i = 0; i < samples.count(); ++i)
      if (weight_[i] > 0 && samples.cosine[i] > 0)
        seen = std::max(seen, std::exp(std::log(column_.value[i] / samples.cosine[i]) + column_.log_scale));
    constexpr double kSeen = 0.1;
    if (is_shown && seen < kSeen) fit.certain = false;
    fit.surface.lobes.push_back(lobe);
  }
  std::ranges::stable_partition(fit.surface.lobes,
                                [](const brdf::LafortuneLobe& lobe) { return lobe.albedo != color::Rgb{}; });
  for (Eigen::Index i = 0; i < samples.count(); ++i) {
    if (weight_[i] > 0)
      ++fit.used;
    else if (samples.use[i] == Use::kValue)
      ++fit.left_out;
  }
  constexpr double kNearMirror = 0.94;  // the cosine of 20 degrees
  if (!(((weight_ > 0).select(samples.up - samples.along, -1.0)).maxCoeff() >= kNearMirror)) fit.certain = false;
  const int unknowns = 3 * (1 + options_.lobes) + 3 * options_.lobes + 1;
  if (3 * fit.used < 2 * unknowns || 2 * fit.left_out > fit.used) fit.certain = false;
  return fit;
}

Eigen::ArrayX3d fitted_values(const TexelSamples& samples, const TexelFit& fit) {
  const double c = std::cos(fit.frame.twice_angle), s = std::sin(fit.frame.twice_angle);
  Eigen::ArrayX3d f(samples.count(), 3);
  for (Eigen::Index i = 0; i < samples.count(); ++i) {
    color::Rgb sum = fit.surface.diffuse;
    for (const brdf::LafortuneLobe& lobe : fit.surface.lobes) {
      const double even = 0.5 * (lobe.axes.x + lobe.axes.y), odd = 0.5 * (lobe.axes.x - lobe.axes.y);
      const double base =
          even * samples.along[i] + odd * (c * samples.split[i] + s * samples.skew[i]) + lobe.axes.z * samples.up[i];
      for (int k = 0; k < 3; ++k) sum[k] += brdf::scaled_power(lobe.albedo[k], base, lobe.exponent);
    }
    f.row(i) << samples.cosine[i] * sum.x, samples.cosine[i] * sum.y, samples.cosine[i] * sum.z;
  }
  return f;
}

}  // namespace goniochrome::capture
