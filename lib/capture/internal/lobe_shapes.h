// The shapes of the lobes of one texel, and the strengths that fit best with them.
#pragma once

#include <array>
#include <vector>

#include "capture/internal/texel_samples.h"

namespace goniochrome::capture {

constexpr int kMostLobes = 4;

// A lobe (even along + cos_part split + sin_part skew + up)^exponent, see TexelSamples.
struct LobeShape {
  double log_exponent = 3, even = -1, cos_part = 0, sin_part = 0;
};
using LobeShapes = std::vector<LobeShape>;

constexpr double kLeastLogExponent = -1, kMostLogExponent = 9;  // exponents 0.37 to 8100

// The lobe times the cosine of the light for every photograph, scaled so that its largest value before the cosine is 1,
// and the logarithm of what was divided out. Where `slope` is given, it gets the derivatives by the four numbers of the
// shape, for a fixed scale.
struct LobeColumn {
  Eigen::ArrayXd value;
  double log_scale = 0;
};
void put_lobe_column(const TexelSamples& samples, const LobeShape& shape, LobeColumn& column,
                     Eigen::Array<double, Eigen::Dynamic, 4>* slope = nullptr);

// Strengths that are not negative: for each channel those of the diffuse part and of every lobe, by weighted least
// squares.
using Strengths = Eigen::Matrix<double, 1 + kMostLobes, 3>;

// The columns of a texel (diffuse first), and what the best strengths leave of the values.
class LobeModel {
 public:
  // `weight` is the square root of the weight of each photograph, in 1 over a standard deviation; 0 leaves one out.
  void solve(const TexelSamples& samples, const LobeShapes& shapes, const Eigen::ArrayXd& weight, bool with_slopes);

  int lobes() const { return static_cast<int>(columns_.size()); }
  const Strengths& strengths() const { return strengths_; }
  // The strength of a lobe in the units of a map: 1/sr, where the base of the power is 1.
  color::Rgb albedo(int lobe, const LobeShape& shape) const;
  color::Rgb diffuse() const { return {strengths_(0, 0), strengths_(0, 1), strengths_(0, 2)}; }
  // The values of the model for every photograph.
  void put_model(Eigen::ArrayX3d& to) const;
  // weight * (model - value), channel by channel.
  void put_residuals(const TexelSamples& samples, const Eigen::ArrayXd& weight, double* to) const;
  // The derivatives of the residuals by shape number `k` (0 to 3) of `lobe`, as far as the strengths cannot follow:
  // Kaufman's form of variable projection [GolubPereyra2003]. Added to `to` times `factor`.
  void add_slope(int lobe, int k, double factor, const Eigen::ArrayXd& weight, double* to) const;

 private:
  void solve_channel(int channel, const Eigen::ArrayXd& target);

  std::vector<LobeColumn> columns_;
  std::vector<Eigen::Array<double, Eigen::Dynamic, 4>> slopes_;
  Eigen::Matrix<double, Eigen::Dynamic, 1 + kMostLobes> weighted_;  // the columns times the weights
  Eigen::Matrix<double, 1 + kMostLobes, 1 + kMostLobes> gram_;
  Eigen::ArrayXd cosine_;
  Strengths strengths_;
  std::array<unsigned, 3> positive_{};  // bit k: column k has a weight in this channel
};

}  // namespace goniochrome::capture
