#include "capture/internal/lobe_shapes.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "brdf/lafortune.h"

namespace goniochrome::capture {

// With x the base of the power and m its largest value, the column is cosine * exp(n (log x - log m)). Its slope by
// log n is n (log x - log m) times the column, and by `even` it is n along / x times the column; so for the other two.
void put_lobe_column(const TexelSamples& samples, const LobeShape& shape, LobeColumn& column,
                     Eigen::Array<double, Eigen::Dynamic, 4>* slope) {
  const double n = std::exp(std::clamp(shape.log_exponent, kLeastLogExponent, kMostLogExponent));
  constexpr double kLeastBase = 1e-6;  // a base of 0 or less gives no light, as this does for every exponent above 1
  Eigen::ArrayXd& value = column.value;
  value = shape.even * samples.along + shape.cos_part * samples.split + shape.sin_part * samples.skew + samples.up;
  const double most = std::max(value.maxCoeff(), kLeastBase);
  column.log_scale = n * std::log(most);
  if (slope) {
    const auto inverse = (value > kLeastBase).select(n / value.max(kLeastBase), 0.0).eval();
    slope->resize(value.size(), 4);
    slope->col(1) = inverse * samples.along;
    slope->col(2) = inverse * samples.split;
    slope->col(3) = inverse * samples.skew;
  }
  value = n * (value.max(kLeastBase * most) / most).log();
  if (slope) slope->col(0) = value;
  value = samples.cosine * value.exp();
  if (slope) slope->colwise() *= value;
}

void LobeModel::solve(const TexelSamples& samples, const LobeShapes& shapes, const Eigen::ArrayXd& weight,
                      bool with_slopes) {
  const std::size_t lobes = shapes.size();
  columns_.resize(lobes);
  slopes_.resize(lobes);
  weighted_.resize(samples.count(), Eigen::NoChange);
  cosine_ = samples.cosine;
  weighted_.col(0) = (samples.cosine * weight).matrix();
  for (std::size_t j = 0; j < lobes; ++j) {
    put_lobe_column(samples, shapes[j], columns_[j], with_slopes ? &slopes_[j] : nullptr);
    weighted_.col(static_cast<Eigen::Index>(j) + 1) = (columns_[j].value * weight).matrix();
  }
  const auto used = weighted_.leftCols(static_cast<Eigen::Index>(lobes) + 1);
  gram_.setZero();
  gram_.topLeftCorner(used.cols(), used.cols()).noalias() = used.transpose() * used;
  strengths_.setZero();
  for (int c = 0; c < 3; ++c) solve_channel(c, samples.value.col(c) * weight);
}

// The best strengths are those of the set of columns whose unconstrained strengths are all positive and leave the least
// error. There are 32 sets at most, and the first one that is tried is nearly always the answer.
void LobeModel::solve_channel(int channel, const Eigen::ArrayXd& target) {
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 1 + kMostLobes, 1 + kMostLobes>;
  using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 1 + kMostLobes, 1>;
  const int columns = lobes() + 1;
  const SmallVector right = weighted_.leftCols(columns).transpose() * target.matrix();
  double best_gain = 0;
  const unsigned all = (1U << columns) - 1;
  positive_[static_cast<std::size_t>(channel)] = 0;
  for (unsigned set = all; set > 0; --set) {
    std::array<int, 1 + kMostLobes> members{};
    int count = 0;
    for (int k = 0; k < columns; ++k)
      if (set >> k & 1 && gram_(k, k) > 0) members[static_cast<std::size_t>(count++)] = k;
    if (count == 0) continue;
    Small part(count, count);
    SmallVector wanted(count);
    for (int i = 0; i < count; ++i) {
      const int row = members[static_cast<std::size_t>(i)];
      wanted(i) = right(row);
      for (int j = 0; j < count; ++j) part(i, j) = gram_(row, members[static_cast<std::size_t>(j)]);
      part(i, i) *= 1 + 1e-10;  // columns that are nearly the same share their light
    }
    const SmallVector found = part.ldlt().solve(wanted);
    if (!(found.minCoeff() >= 0)) continue;
    const double gain = found.dot(wanted);
    if (gain <= best_gain) continue;
    best_gain = gain;
    strengths_.col(channel).setZero();
    unsigned positive = 0;
    for (int i = 0; i < count; ++i) {
      const int row = members[static_cast<std::size_t>(i)];
      strengths_(row, channel) = found(i);
      positive |= 1U << row;
    }
    positive_[static_cast<std::size_t>(channel)] = positive;
    if (set == all) break;
  }
}

color::Rgb LobeModel::albedo(int lobe, const LobeShape& shape) const {
  const double n = std::exp(std::clamp(shape.log_exponent, kLeastLogExponent, kMostLogExponent));
  const double base = std::exp(-columns_[static_cast<std::size_t>(lobe)].log_scale / n);
  const auto of = [&](int c) { return brdf::scaled_power(strengths_(lobe + 1, c), base, n); };
  return {of(0), of(1), of(2)};
}

void LobeModel::put_model(Eigen::ArrayX3d& to) const {
  to.resize(cosine_.size(), 3);
  for (int c = 0; c < 3; ++c) {
    to.col(c) = strengths_(0, c) * cosine_;
    for (int j = 0; j < lobes(); ++j) to.col(c) += strengths_(j + 1, c) * columns_[static_cast<std::size_t>(j)].value;
  }
}

void LobeModel::put_residuals(const TexelSamples& samples, const Eigen::ArrayXd& weight, double* to) const {
  const Eigen::Index n = samples.count();
  for (int c = 0; c < 3; ++c) {
    Eigen::Map<Eigen::VectorXd> r(to + c * n, n);
    r.noalias() = weighted_.leftCols(lobes() + 1) * strengths_.col(c).head(lobes() + 1);
    r.array() -= weight * samples.value.col(c);
  }
}

void LobeModel::add_slope(int lobe, int k, double factor, const Eigen::ArrayXd& weight, double* to) const {
  const Eigen::Index n = weight.size();
  const int columns = lobes() + 1;
  const Eigen::VectorXd v = (slopes_[static_cast<std::size_t>(lobe)].col(k) * weight).matrix();
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 1 + kMostLobes, 1> projected =
      weighted_.leftCols(columns).transpose() * v;
  // Most often all columns have a weight in all channels, or the same ones: the projection is found once.
  unsigned done = 0;
  Eigen::VectorXd rest(n);
  for (int c = 0; c < 3; ++c) {
    const double scale = factor * strengths_(lobe + 1, c);
    if (scale == 0) continue;
    const unsigned set = positive_[static_cast<std::size_t>(c)];
    if (set != done) {
      Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 1 + kMostLobes, 1 + kMostLobes> part =
          gram_.topLeftCorner(columns, columns);
      Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 1 + kMostLobes, 1> wanted = projected;
      for (int i = 0; i < columns; ++i) {
        part(i, i) = part(i, i) * (1 + 1e-10) + std::numeric_limits<double>::min();
        if (set >> i & 1) continue;
        part.row(i).setZero();
        part.col(i).setZero();
        part(i, i) = 1;
        wanted(i) = 0;
      }
      rest = v - weighted_.leftCols(columns) * part.ldlt().solve(wanted);
      done = set;
    }
    Eigen::Map<Eigen::VectorXd>(to + c * n, n) += scale * rest;
  }
}

}  // namespace goniochrome::capture
