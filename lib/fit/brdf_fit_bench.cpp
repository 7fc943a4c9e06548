// Fitting a measured BRDF: time and relative error of the lobes beside a single GGX lobe found by Ceres, on the same
// directions with the same weights. Needs GONIOCHROME_DATA.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/clock.h"
#include "fit/brdf_rows.h"
#include "fit/paint_fit.h"
#include "fit/solver.h"

namespace goniochrome {
namespace {

constexpr double kRadian = M_PI / 180;
constexpr const char* kFiles[] = {"rgl/vch_golden_yellow_rgb.bsdf", "rgl/satin_rosaline_rgb.bsdf",
                                  "rgl/cc_ibiza_sunset_rgb.bsdf", "cornell/garnet_red.brdf"};

Basis basis(int lobes) {
  Basis b{"bench", {}, false};
  for (int j = 0; j < lobes; ++j) b.exponents.push_back(std::pow(3000.0, j / (lobes - 1.0)));
  return b;
}

Result<BrdfTarget> target(int file) {
  const char* folder = std::getenv("GONIOCHROME_DATA");
  if (!folder) return input_error("GONIOCHROME_DATA is not set");
  GONIO_ASSIGN(InputFile input, InputFile::open(std::string(folder) + "/brdf/" + kFiles[file]));
  return read_brdf_target(input);
}

void lobes(benchmark::State& state) {
  const auto brdf = target(static_cast<int>(state.range(0)));
  if (!brdf.ok()) return state.SkipWithError(brdf.error().message.c_str());
  const PaintFitter fitter(basis(12), {.method = state.range(1) == 1 ? FitMethod::kL1 : FitMethod::kL2});
  double error = 0;
  std::size_t directions = 0;
  for (auto _ : state) {
    const auto fit = fitter.fit(*brdf);
    error = fit->report.brdf->relative_error_median, directions = fit->report.brdf->fitted;
  }
  state.SetLabel(kFiles[state.range(0)]);
  state.counters["relative_error"] = error;
  state.counters["directions"] = static_cast<double>(directions);
}
BENCHMARK(lobes)->ArgNames({"file", "l"})->ArgsProduct({{0, 1, 2, 3}, {1, 2}})->Unit(benchmark::kMillisecond);

// pi f = kd + ks D G / (4 cos_i cos_o), G Smith's for GGX, without Fresnel: seven unknowns, the log of the roughness
// last. Only angles are known of a direction: cos_h follows from them.
struct Ggx final : public ceres::CostFunction {
  explicit Ggx(const BrdfRows& r) : rows(r) {
    set_num_residuals(static_cast<int>(3 * r.fitted.size()));
    mutable_parameter_block_sizes()->push_back(7);
  }
  static double shape(const BrdfSample& s, double roughness) {
    const double ci = std::cos(s.light_deg * kRadian), co = std::cos(s.view_deg * kRadian), a2 = roughness * roughness;
    // The aspecular angle tells the cosine between light and viewer: r(wi).wo = 2 ci co - wi.wo.
    const double io = 2 * ci * co - std::cos(s.aspecular_rad);
    const double ch2 = (ci + co) * (ci + co) / std::max(2 + 2 * io, 1e-12), d = ch2 * (a2 - 1) + 1;
    const auto lambda = [&](double c) { return (std::sqrt(1 + a2 * (1 / (c * c) - 1)) - 1) / 2; };
    return a2 / (d * d) / (1 + lambda(ci) + lambda(co)) / (4 * ci * co);
  }
  Rgb prediction(const BrdfSample& s, const double* x) const {
    const double lobe = shape(s, std::exp(x[6]));
    return {x[0] + x[3] * lobe, x[1] + x[4] * lobe, x[2] + x[5] * lobe};
  }
  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const double* x = parameters[0];
    for (std::size_t i = 0; i < rows.fitted.size(); ++i) {
      const double w = rows.flake.rows[i].weight, lobe = shape(rows.fitted[i], std::exp(x[6]));
      constexpr double kStep = 1e-6;
      const double slope =
          (shape(rows.fitted[i], std::exp(x[6] + kStep)) - shape(rows.fitted[i], std::exp(x[6] - kStep))) / (2 * kStep);
      const Rgb predicted = prediction(rows.fitted[i], x);
      for (int c = 0; c < 3; ++c) {
        residuals[3 * i + c] = w * (predicted[c] - rows.flake.rows[i].value[c]);
        if (!jacobians || !jacobians[0]) continue;
        double* row = jacobians[0] + 7 * (3 * i + c);
        std::fill(row, row + 7, 0.0);
        row[c] = w, row[3 + c] = w * lobe, row[6] = w * x[3 + c] * slope;
      }
    }
    return true;
  }
  const BrdfRows& rows;
};

void ggx(benchmark::State& state) {
  const auto brdf = target(static_cast<int>(state.range(0)));
  if (!brdf.ok()) return state.SkipWithError(brdf.error().message.c_str());
  const auto rows = brdf_rows(*brdf, *white_point({"D65", 2}), {.method = FitMethod::kL2}, basis(12).exponents);
  double error = 0;
  for (auto _ : state) {
    double best_cost = INFINITY;
    for (const double roughness : {0.05, 0.2, 0.5}) {
      double x[7] = {0.05, 0.05, 0.05, 0.1, 0.1, 0.1, std::log(roughness)};
      Ggx cost(*rows);
      ceres::Problem::Options ownership;
      ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
      ceres::Problem problem(ownership);
      problem.AddResidualBlock(&cost, nullptr, x);
      for (int k = 0; k < 6; ++k) problem.SetParameterLowerBound(x, k, 0);
      problem.SetParameterLowerBound(x, 6, std::log(1e-3));
      problem.SetParameterUpperBound(x, 6, 0);
      ceres::Solver::Options options = quiet_solver_options();
      options.max_num_iterations = 200;
      ceres::Solver::Summary summary;
      ceres::Solve(options, &problem, &summary);
      if (summary.final_cost >= best_cost) continue;
      best_cost = summary.final_cost;
      std::vector<double> errors;
      for (const BrdfSample& s : rows->fitted) errors.push_back(length(cost.prediction(s, x) - s.value) / length(s.value));
      std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
      error = errors[errors.size() / 2];
    }
  }
  state.SetLabel(kFiles[state.range(0)]);
  state.counters["relative_error"] = error;
}
BENCHMARK(ggx)->ArgName("file")->DenseRange(0, 3)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace goniochrome
