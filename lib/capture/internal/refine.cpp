#include "capture/internal/refine.h"

#include <ceres/tiny_solver.h>

#include <algorithm>
#include <cmath>

namespace goniochrome::capture {

namespace {

// The function whose squares are made least: the weighted residuals of all channels, then the distances from the prior.
// Parameters: four numbers of a shape for each lobe, or, with a frame in common, its twice angle and three numbers for
// each lobe (log_exponent, even, odd).
class Distances {
 public:
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = Eigen::Dynamic };

  Distances(const TexelSamples& samples, const Eigen::ArrayXd& weight, const ShapePrior& prior, bool in_common)
      : samples_(samples), weight_(weight), prior_(prior), in_common_(in_common) {}

  int lobes() const { return static_cast<int>(prior_.center.size()); }
  int NumParameters() const { return in_common_ ? 1 + 3 * lobes() : 4 * lobes(); }
  int NumResiduals() const { return 3 * static_cast<int>(samples_.count()) + 4 * lobes(); }

  Eigen::VectorXd parameters(const LobeShapes& shapes, double twice_angle) const {
    Eigen::VectorXd p(NumParameters());
    int at = 0;
    if (in_common_) p[at++] = twice_angle;
    for (const LobeShape& s : shapes) {
      p[at++] = s.log_exponent, p[at++] = s.even;
      if (in_common_) {
        p[at++] = s.cos_part * std::cos(twice_angle) + s.sin_part * std::sin(twice_angle);
      } else {
        p[at++] = s.cos_part, p[at++] = s.sin_part;
      }
    }
    return p;
  }

  LobeShapes shapes(const double* p) const {
    LobeShapes shapes(static_cast<std::size_t>(lobes()));
    const double c = in_common_ ? std::cos(p[0]) : 0, s = in_common_ ? std::sin(p[0]) : 0;
    const double* at = in_common_ ? p + 1 : p;
    for (LobeShape& shape : shapes) {
      shape.log_exponent = *at++, shape.even = *at++;
      if (in_common_) {
        shape.cos_part = c * *at, shape.sin_part = s * *at++;
      } else {
        shape.cos_part = *at++, shape.sin_part = *at++;
      }
    }
    return shapes;
  }

  bool operator()(const double* parameters, double* residuals, double* jacobian) const {
    const LobeShapes here = shapes(parameters);
    const Eigen::Index n = samples_.count(), rows = NumResiduals();
    model_.solve(samples_, here, weight_, jacobian != nullptr);
    model_.put_residuals(samples_, weight_, residuals);
    double* to_prior = residuals + 3 * n;
    for (std::size_t j = 0; j < here.size(); ++j) {
      const LobeShape& center = prior_.center[j];
      *to_prior++ = (here[j].log_exponent - center.log_exponent) / prior_.log_exponent;
      *to_prior++ = (here[j].even - center.even) / prior_.axes;
      *to_prior++ = (here[j].cos_part - center.cos_part) / prior_.axes;
      *to_prior++ = (here[j].sin_part - center.sin_part) / prior_.axes;
    }
    if (!jacobian) return true;
    std::fill(jacobian, jacobian + rows * NumParameters(), 0.0);
    const double c = in_common_ ? std::cos(parameters[0]) : 0, s = in_common_ ? std::sin(parameters[0]) : 0;
    for (int j = 0; j < lobes(); ++j) {
      const Eigen::Index prior_row = 3 * n + 4 * j;
      const auto add = [&](int parameter, int k, double factor) {
        double* column = jacobian + rows * parameter;
        model_.add_slope(j, k, factor, weight_, column);
        column[prior_row + k] += factor / (k == 0 ? prior_.log_exponent : prior_.axes);
      };
      if (!in_common_) {
        for (int k = 0; k < 4; ++k) add(4 * j + k, k, 1);
        continue;
      }
      const double odd = parameters[3 * j + 3];
      add(3 * j + 1, 0, 1);
      add(3 * j + 2, 1, 1);
      add(3 * j + 3, 2, c), add(3 * j + 3, 3, s);
      add(0, 2, -s * odd), add(0, 3, c * odd);
    }
    return true;
  }

 private:
  const TexelSamples& samples_;
  const Eigen::ArrayXd& weight_;
  const ShapePrior& prior_;
  bool in_common_;
  mutable LobeModel model_;
};

}  // namespace

void refine(const TexelSamples& samples, const Eigen::ArrayXd& weight, const ShapePrior& prior, int iterations,
            LobeShapes& shapes, SharedFrame* frame) {
  const Distances distances(samples, weight, prior, frame != nullptr);
  Eigen::VectorXd p = distances.parameters(shapes, frame ? frame->twice_angle : 0);
  ceres::TinySolver<Distances> solver;
  solver.options.max_num_iterations = iterations + 1;
  solver.options.function_tolerance = 1e-2;  // of half the sum of squares, in squared standard deviations
  solver.options.parameter_tolerance = 1e-5;
  solver.options.initial_trust_region_radius = 10;
  solver.Solve(distances, &p);
  if (!p.allFinite()) return;
  shapes = distances.shapes(p.data());
  for (LobeShape& shape : shapes) {
    shape.log_exponent = std::clamp(shape.log_exponent, kLeastLogExponent, kMostLogExponent);
    shape.even = std::clamp(shape.even, -3.0, 3.0);
  }
  if (frame) frame->twice_angle = std::remainder(p[0], 2 * 3.14159265358979323846);
}

SharedFrame shared_frame(const std::vector<double>& energy, LobeShapes& shapes) {
  double c = 0, s = 0;
  // Lobes may be long along the frame or across it, so that their angles are compared as lines: squares of complex
  // numbers, which a turn by 180 degrees of the doubled angle leaves as they are.
  for (std::size_t j = 0; j < shapes.size(); ++j) {
    const double p = shapes[j].cos_part, q = shapes[j].sin_part;
    c += energy[j] * (p * p - q * q), s += energy[j] * 2 * p * q;
  }
  const double twice = 0.5 * std::atan2(s, c);
  for (LobeShape& shape : shapes) {
    const double odd = shape.cos_part * std::cos(twice) + shape.sin_part * std::sin(twice);
    shape.cos_part = odd * std::cos(twice), shape.sin_part = odd * std::sin(twice);
  }
  return {twice};
}

}  // namespace goniochrome::capture
