// The fit of one texel: a diffuse part and lobes to what the photographs say of it.
#pragma once

#include <vector>

#include "brdf/lafortune.h"
#include "capture/internal/refine.h"

namespace goniochrome::capture {

enum class FitMethod {
  kDictionary,  // non-negative weights of a dictionary of lobes, robust, then refined; starts from neighbors too
  kNonlinear,   // least squares from one start, as [McAllister2002] 3
};

struct TexelOptions {
  int lobes = 2;
  FitMethod method = FitMethod::kDictionary;
  bool robust = true;            // shadows and outliers are weighted down
  double good_spread = 1;        // TexelFit::spread of a fit that needs no other start
  double relative_noise = 0.02;  // standard deviation of a value that its rounding does not explain
};

struct TexelFit {
  LobeShapes shapes;  // ascending exponents
  SharedFrame frame;
  // In the frame that is turned by half of frame.twice_angle, with ascending exponents, but lobes that no value shows at
  // the end, so that neighbors have the same lobe at the same place; without light, no lobes.
  brdf::Lafortune surface;
  double spread = 1;        // of the residuals, in the standard deviations that were expected
  int used = 0;             // values that count
  int left_out = 0;         // values that were found to be shadows or outliers
  bool certain = false;     // enough values, each lobe was seen, and no strength had to be bounded
};

// Everything that is needed again and again. One for each thread.
class TexelFitter {
 public:
  explicit TexelFitter(const TexelOptions& options);

  // The fit. `starts` are shapes of neighbors (each with a frame), which are tried besides the fitter's own start; the
  // own start is passed over where a neighbor's explains the values as well as their noise allows.
  struct Start {
    LobeShapes shapes;
    SharedFrame frame;
  };
  TexelFit fit(const TexelSamples& samples, const std::vector<Start>& starts);

  // Improves `fit`: the shapes that explain this texel best, its own or those of a neighbor, decide what its own values
  // leave open.
  TexelFit together(const TexelSamples& samples, const TexelFit& fit, const std::vector<Start>& neighbors);

 private:
  struct State {
    LobeShapes shapes;
    SharedFrame frame;
    double spread = 1;
  };
  void expect(const TexelSamples& samples, const Eigen::ArrayX3d& model);
  void weigh(const TexelSamples& samples, const Eigen::ArrayX3d& model, double floor_spread, bool gentle, State& state);
  bool begin(const TexelSamples& samples);
  void improve(const TexelSamples& samples, const ShapePrior& prior, int rounds, int iterations, bool in_common,
               State& state);
  double cost(const TexelSamples& samples, const State& state, double spread);
  LobeShapes dictionary_start(const TexelSamples& samples);
  LobeShapes plain_start() const;
  State own_fit(const TexelSamples& samples, LobeShapes start);
  TexelFit unfitted() const;
  TexelFit finished(const TexelSamples& samples, State state);

  TexelOptions options_;
  LobeShapes dictionary_;
  double level_ = 0;  // the median of the values of this texel
  Eigen::ArrayXd mean_, sigma_, distance_, weight_;
  Eigen::ArrayX3d model_values_;
  LobeModel model_;
  LobeColumn column_;
};

// BRDF times cosine of a fit for every photograph.
Eigen::ArrayX3d fitted_values(const TexelSamples& samples, const TexelFit& fit);

}  // namespace goniochrome::capture
