// The nonlinear part of the fit of a texel: shapes of lobes, by Levenberg and Marquardt's method.
#pragma once

#include "capture/internal/lobe_shapes.h"

namespace goniochrome::capture {

// Likely values of the shapes: the nearer, the smaller the standard deviations. They decide where the photographs leave
// a shape open.
struct ShapePrior {
  LobeShapes center;
  double log_exponent = 2, axes = 1;  // standard deviations
};

// The direction to which all lobes of a texel are turned: twice the angle from the tangent to their x axis.
struct SharedFrame {
  double twice_angle = 0;
};

// Improves the shapes by at most `iterations` steps. `weight` is that of LobeModel::solve(). With `frame`, all lobes
// keep that direction in common, and it is improved too; without, each lobe has its own.
void refine(const TexelSamples& samples, const Eigen::ArrayXd& weight, const ShapePrior& prior, int iterations,
            LobeShapes& shapes, SharedFrame* frame);

// The direction that the lobes have in common, where each has its own, weighted by `energy` (one number a lobe). The
// shapes are turned to it.
SharedFrame shared_frame(const std::vector<double>& energy, LobeShapes& shapes);

}  // namespace goniochrome::capture
