// Fitting a measured BRDF: time and errors of the lobes beside those of a single GGX lobe found by Ceres on the same
// directions. Needs GONIOCHROME_DATA.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/angles.h"
#include "brdf/lobe_model.h"
#include "fit/brdf_target.h"
#include "fit/internal/ggx_for_test.h"
#include "fit/paint_fit.h"

namespace goniochrome::fit {
namespace {

constexpr double kSteepest_deg = 75.001;  // angles in files are rounded
constexpr const char* kFiles[] = {"rgl/vch_golden_yellow_rgb.bsdf", "rgl/satin_rosaline_rgb.bsdf",
                                  "rgl/cc_ibiza_sunset_rgb.bsdf", "cornell/garnet_red.brdf"};

formats::Basis basis(int lobes) {
  formats::Basis b{"bench", {}, false};
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
  const PaintFitter fitter(basis(12), {.method = state.range(1) == 1 ? FitMethod::kL1 : FitMethod::kL2,
                                       .view_sets = state.range(2) == 1 ? ViewSets::kWhereNeeded : ViewSets::kNone});
  PaintFit fit;
  for (auto _ : state) fit = *fitter.fit(*brdf);
  state.SetLabel(kFiles[state.range(0)]);
  state.counters["relative_error"] = fit.report.brdf->relative_error_median;
  const auto misplaced = *albedo_error(*brdf->source, [&](const Vec3& light, const Vec3& view) {
    return brdf::coated_brdf(fit.lobes, light, view, {0, 0, 1});
  });
  if (misplaced) state.counters["albedo_error"] = *misplaced;
  state.counters["directions"] = static_cast<double>(fit.report.brdf->fitted);
}
BENCHMARK(lobes)
    ->ArgNames({"file", "l", "views"})
    ->ArgsProduct({{0, 1, 2, 3}, {1, 2}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

// The GGX lobe as the public fitter has it (0: log10(1 + f), Schlick's reflectance, no diffuse part), with a diffuse
// part (1), and weighed as the lobes are, with Schlick's reflectance (2) and without (3).
void ggx(benchmark::State& state) {
  const auto brdf = target(static_cast<int>(state.range(0)));
  if (!brdf.ok()) return state.SkipWithError(brdf.error().message.c_str());
  constexpr GgxKind kKinds[] = {{false, true, true}, {true, true, true}, {true, true, false}, {true, false, false}};
  std::vector<BrdfSample> samples;
  for (const BrdfSample& s : brdf->samples)
    if (std::max(s.light_deg, s.view_deg) <= kSteepest_deg) samples.push_back(s);
  GgxModel model;
  for (auto _ : state) model = fitted_ggx(samples, kKinds[state.range(1)], *color::white_point({"D65", 2}));
  const auto f = [&](const Vec3& light, const Vec3& view) { return model.f(light, view); };
  std::vector<double> errors;
  for (const BrdfSample& s : samples) {
    if (s.aspecular_rad < kGlareAngle_deg * kDegree) continue;
    const paint::DirectionPair pair = directions_of(s);
    errors.push_back(length(kPi * f(pair.light, pair.view) - s.value) / length(s.value));
  }
  std::nth_element(errors.begin(), errors.begin() + static_cast<std::ptrdiff_t>(errors.size() / 2), errors.end());
  state.SetLabel(kFiles[state.range(0)]);
  state.counters["relative_error"] = errors[errors.size() / 2];
  const auto misplaced = *albedo_error(*brdf->source, f);
  if (misplaced) state.counters["albedo_error"] = *misplaced;
}
BENCHMARK(ggx)->ArgNames({"file", "kind"})->ArgsProduct({{0, 1, 2, 3}, {0, 1, 2, 3}})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace goniochrome::fit
