#include "run.h"

#include <algorithm>
#include <cmath>

#include "base/clock.h"
#include "base/parallel.h"
#include "base/text.h"
#include "envmap/prefilter.h"
#include "envmap/reference.h"
#include "paint/basis.h"

namespace goniochrome {

namespace {

constexpr double kLeastTolerance = 1e-6;  // floats hold 6e-8, the reference 1e-8

std::string exponent_name(double exponent) {
  return std::isinf(exponent) ? "mirror" : shortest(exponent);
}

const char* layout_name(Environment::Layout layout) {
  switch (layout) {
    case Environment::Layout::kLatLong:
      return "lat-long";
    case Environment::Layout::kCube:
      return "cube";
    case Environment::Layout::kCubeEdges:
      return "cube with texel centers on the edges";
  }
  return "";
}

// What is asked for. Ascending exponents, each once; the diffuse lobe stands for exponent 1.
Result<PrefilterRequest> request_of(const Options& options) {
  PrefilterRequest request;
  if (options.basis.empty() == options.exponents.empty())
    return usage_error("give either --basis FILE or --exponents LIST");
  request.exponents = options.exponents;
  if (!options.basis.empty()) {
    GONIO_ASSIGN(const Basis basis, read_basis(options.basis));
    request.exponents = basis.exponents;
  }
  std::vector<double>& e = request.exponents;
  std::sort(e.begin(), e.end());
  e.erase(std::unique(e.begin(), e.end()), e.end());
  std::erase(e, 1.0);
  request.mirror = !options.no_mirror;
  if (options.size != "auto") {
    const auto size = parse_integer(options.size);
    if (!size || *size < 1 || *size > 8192)
      return usage_error("--size is \"{}\": give auto or the texels along a face, 1 to 8192", options.size);
    request.size = static_cast<int>(*size);
  }
  request.tolerance = options.common.tolerance;
  if (!(request.tolerance >= kLeastTolerance && request.tolerance < 1))
    return usage_error("--tolerance is {}: give {} to 1", shortest(request.tolerance), shortest(kLeastTolerance));
  return request;
}

Result<Environment> read_environment(const Options& options) {
  const auto bad = options.bad_pixels == "zero" ? Environment::BadPixels::kZero : Environment::BadPixels::kError;
  if (options.images.size() > 1) return Environment::read_faces(options.images, bad);
  return Environment::read(options.images.empty() ? "-" : options.images.front(), bad);
}

void tell_source(const Environment& env, cli::Session& session) {
  const Environment::Counts& n = env.replaced();
  session.results()["source"] = {{"path", env.source()},   {"layout", layout_name(env.layout())},
                                 {"width", env.width()},   {"height", env.height()},
                                 {"nan", n.nan},           {"infinite", n.infinite},
                                 {"negative", n.negative}, {"out_of_gamut", n.out_of_gamut}};
  if (n.total() > 0)
    session.warn(fmt::format("{}: {} texels set to zero ({} not a number, {} infinite, {} negative)", env.source(),
                             n.total(), n.nan, n.infinite, n.negative));
  if (n.out_of_gamut > 0)
    session.warn(fmt::format("{}: {} texels beyond Rec.2020 clipped to it", env.source(), n.out_of_gamut));
}

std::string plan_text(const Environment& env, const PrefilterRequest& request, const std::vector<LobePlan>& plan) {
  std::string text = fmt::format("{}: {}, {} x {} texels, each a constant patch\n", env.source(),
                                 layout_name(env.layout()), env.width(), env.height());
  text += "exponent  size  method            degree  error    lookup   time\n";
  double total = 0;
  for (const LobePlan& lobe : plan) {
    text += fmt::format("{:<9} {:<5} {:<17} {:<7} {:<8.1e} {:<8.1e} {:.3f} s\n", exponent_name(lobe.exponent),
                        lobe.size, method_name(lobe.method), lobe.degree > 0 ? std::to_string(lobe.degree) : "-",
                        lobe.predicted_error, lobe.lookup_error, lobe.predicted_time_s);
    total += lobe.predicted_time_s;
  }
  text += fmt::format("about {:.2f} s on {} threads, and reading and writing\n", total, threads());
  text += fmt::format(
      "error: of a texel, relative to it or to 1e-3 of the mean, at most {}; lookup: what bilinear fetches between "
      "texels "
      "typically add{}\n",
      shortest(request.tolerance), request.size > 0 ? "; --size auto would keep that at ten times the tolerance" : "");
  return text;
}

Json report_of(const LobePlan& plan, const PrefilteredLobe& lobe, double time_s, double ratio) {
  const bool verified = lobe.verified_texels > 0;
  return {{"exponent", std::isinf(lobe.exponent) ? Json("mirror") : Json(lobe.exponent)},
          {"size", lobe.map.size},
          {"method", lobe.method},
          {"degree", plan.degree},
          {"storage", storage_type(lobe) == PixelType::kHalf ? "half" : "float"},
          {"predicted_time_s", plan.predicted_time_s},
          {"time_s", time_s},
          {"predicted_error", plan.predicted_error},
          {"lookup_error", plan.lookup_error},
          {"max_rel_error", verified ? json_number(lobe.max_error) : Json(nullptr)},
          {"mean_rel_error", verified ? json_number(lobe.mean_error) : Json(nullptr)},
          {"verified_texels", lobe.verified_texels},
          {"energy_ratio", json_number(ratio)}};
}

std::vector<PrefilteredLobe*> all_lobes(PrefilteredEnvironment& env) {
  std::vector<PrefilteredLobe*> lobes = {&env.diffuse};
  for (PrefilteredLobe& lobe : env.lobes) lobes.push_back(&lobe);
  if (env.mirror.map.size > 0) lobes.push_back(&env.mirror);
  return lobes;
}

// Measures every lobe against the reference. Returns whether all keep the tolerance.
bool verify(const Options& options, const Environment& env, PrefilteredEnvironment& result, cli::Session& session) {
  bool within = true;
  for (PrefilteredLobe* lobe : all_lobes(result)) {
    session.progress(fmt::format("{}: verifying {}", session.tool(), exponent_name(lobe->exponent)));
    const LobeError error = lobe_error(env, *lobe, options.verify, (options.verify + 9) / 10, options.common.seed);
    lobe->max_error = error.max;
    lobe->mean_error = error.mean;
    lobe->verified_texels = error.texels;
    if (error.max <= lobe->tolerance) continue;
    within = false;
    session.warn(fmt::format("lobe {}: a texel is off by {:.2e}, more than the tolerance {}",
                             exponent_name(lobe->exponent), error.max, shortest(lobe->tolerance)));
  }
  return within;
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  GONIO_ASSIGN(const PrefilterRequest request, request_of(options));
  const Stopwatch read_clock;
  GONIO_ASSIGN(const Environment env, read_environment(options));
  session.results()["read_s"] = read_clock.elapsed_s();
  tell_source(env, session);
  const std::vector<LobePlan> plan = prefilter_plan(env, request);
  if (options.common.explain) session.explain(plan_text(env, request, plan));

  const Stopwatch filter_clock;
  std::vector<double> times;
  PrefilteredEnvironment result = prefiltered(env, request, plan, [&](const PrefilteredLobe& lobe, double time_s) {
    times.push_back(time_s);
    session.progress(
        fmt::format("{}: {} of {} lobes, {}", session.tool(), times.size(), plan.size(), exponent_name(lobe.exponent)));
  });
  const double filter_s = filter_clock.elapsed_s();
  session.results()["filter_s"] = filter_s;

  const Stopwatch verify_clock;
  const bool within = options.verify == 0 || verify(options, env, result, session);
  session.results()["verify_s"] = verify_clock.elapsed_s();

  double worst = 0;
  std::vector<PrefilteredLobe*> lobes = all_lobes(result);
  for (std::size_t i = 0; i < lobes.size(); ++i) {
    worst = std::max(worst, lobes[i]->max_error);
    session.results()["lobes"].push_back(report_of(plan[i], *lobes[i], times[i], energy_ratio(env, lobes[i]->map)));
  }
  const Stopwatch write_clock;
  GONIO_TRY(write_env(options.output, result,
                      fmt::format("{} {}: {}", session.tool(), cli::Session::version(), session.command_line())));
  session.results()["write_s"] = write_clock.elapsed_s();

  const std::string checked = options.verify == 0
                                  ? fmt::format("tolerance {}, not verified", shortest(request.tolerance))
                                  : fmt::format("largest error {:.2e} of {} texels a lobe, tolerance {}", worst,
                                                result.diffuse.verified_texels, shortest(request.tolerance));
  session.say(fmt::format("{}: {} lobes in {:.2f} s; {}", session.tool(), lobes.size(), filter_s, checked));
  return within ? cli::Verdict::kDone : cli::Verdict::kNegative;
}

}  // namespace goniochrome
