// The control of tests and benchmarks: a single microfacet lobe with the distribution of GGX, fitted by Ceres.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/angles.h"
#include "fit/brdf_target.h"
#include "fit/ceres_options.h"

namespace goniochrome::fit {

struct GgxKind {
  bool diffuse = true;      // with a constant beside the lobe
  bool schlick = true;      // the lobe's reflectance grows to 1 at grazing angles
  bool logarithmic = true;  // residuals log10(1 + f), else reflectance factors times dL*/dY
};

struct GgxModel {
  GgxKind kind;
  double x[7] = {0.05, 0.05, 0.05, 0.3, 0.3, 0.3, 0};  // diffuse, lobe at normal incidence, log of the roughness

  // D G / (4 cos_i cos_o), G Smith's.
  static double lobe(const Vec3& light, const Vec3& view, double roughness) {
    const Vec3 half = normalized(light + view);
    const double a2 = roughness * roughness, d = half.z * half.z * (a2 - 1) + 1;
    const auto g1 = [&](double c) { return 2 / (1 + std::sqrt(1 + a2 * (1 / (c * c) - 1))); };
    return a2 / (kPi * d * d) * g1(light.z) * g1(view.z) / (4 * light.z * view.z);
  }
  double grazing(const Vec3& light, const Vec3& view) const {
    return kind.schlick ? std::pow(1 - std::min(1.0, length(light + view) / 2), 5) : 0;
  }
  color::Rgb f(const Vec3& light, const Vec3& view) const {
    const double shape = lobe(light, view, std::exp(x[6])), g = grazing(light, view);
    color::Rgb sum;
    for (int c = 0; c < 3; ++c) sum[c] = x[c] + (x[3 + c] * (1 - g) + g) * shape;
    return sum;
  }
};

struct GgxCost final : public ceres::CostFunction {
  GgxCost(const std::vector<BrdfSample>& s, GgxKind k, const color::Xyz& white) : samples(s), model{k} {
    set_num_residuals(static_cast<int>(3 * s.size()));
    mutable_parameter_block_sizes()->push_back(7);
    for (const BrdfSample& sample : s) {
      pairs.push_back(directions_of(sample));
      weight.push_back(k.logarithmic ? 1 : kPi * color::lightness_slope(color::lab_from_rgb(sample.value, white).L));
    }
  }
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    GgxModel m = model;
    std::copy_n(parameters[0], 7, m.x);
    constexpr double kStep = 1e-6;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const auto& [light, view] = pairs[i];
      const double shape = GgxModel::lobe(light, view, std::exp(m.x[6])), g = m.grazing(light, view);
      const double slope = (GgxModel::lobe(light, view, std::exp(m.x[6] + kStep)) -
                            GgxModel::lobe(light, view, std::exp(m.x[6] - kStep))) /
                           (2 * kStep);
      const color::Rgb predicted = m.f(light, view);
      for (int c = 0; c < 3; ++c) {
        const double wanted = std::max(samples[i].value[c], 0.0) / kPi;
        const double w = model.kind.logarithmic ? 1 / ((1 + predicted[c]) * std::log(10)) : weight[i];
        residuals[3 * i + c] =
            model.kind.logarithmic ? std::log10((1 + predicted[c]) / (1 + wanted)) : w * (predicted[c] - wanted);
        if (!jacobians || !jacobians[0]) continue;
        double* row = jacobians[0] + 7 * (3 * i + c);
        std::fill(row, row + 7, 0.0);
        row[c] = w, row[3 + c] = w * (1 - g) * shape, row[6] = w * (m.x[3 + c] * (1 - g) + g) * slope;
      }
    }
    return true;
  }
  const std::vector<BrdfSample>& samples;
  GgxModel model;
  std::vector<paint::DirectionPair> pairs;
  std::vector<double> weight;
};

// The best of three starts.
inline GgxModel fitted_ggx(const std::vector<BrdfSample>& samples, GgxKind kind, const color::Xyz& white) {
  GgxModel best{kind};
  double best_cost = INFINITY;
  GgxCost cost(samples, kind, white);
  for (const double roughness : {0.05, 0.2, 0.5}) {
    GgxModel model{kind};
    model.x[6] = std::log(roughness);
    ceres::Problem::Options ownership;
    ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::Problem problem(ownership);
    problem.AddResidualBlock(&cost, nullptr, model.x);
    for (int k = 0; k < 6; ++k) problem.SetParameterLowerBound(model.x, k, 0);
    for (int k = 0; k < 3 && !kind.diffuse; ++k) model.x[k] = 0, problem.SetParameterUpperBound(model.x, k, 1e-12);
    problem.SetParameterLowerBound(model.x, 6, std::log(1e-3));
    problem.SetParameterUpperBound(model.x, 6, 0);
    ceres::Solver::Options options = quiet_solver_options();
    options.max_num_iterations = 200;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (summary.final_cost < best_cost) best_cost = summary.final_cost, best = model;
  }
  return best;
}

}  // namespace goniochrome::fit
