#include "base/angles.h"
#include "tool.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/clock.h"
#include "base/heap.h"
#include "base/parallel.h"
#include "base/text.h"
#include "contact_sheet.h"
#include "envmap/engine_cube.h"
#include "envmap/mip.h"
#include "envmap/open_maps.h"
#include "envmap/remarks.h"
#include "output_names.h"
#include "prefilter/exact_lobe.h"
#include "prefilter/lobe_cache.h"
#include "prefilter/prefilter.h"
#include "prefilter/rms_maps.h"
#include "wanted.h"

namespace goniochrome::tool {

namespace {

std::string exponent_name(double exponent) {
  return paint::is_mirror(exponent) ? "mirror" : shortest(exponent);
}

const char* layout_name(const envmap::Environment& env) {
  if (env.ball()) return "mirror ball";
  switch (env.layout()) {
    case envmap::Environment::Layout::kLatLong:
      return "lat-long";
    case envmap::Environment::Layout::kCube:
      return "cube";
    case envmap::Environment::Layout::kCubeEdges:
      return "cube with texel centers on the edges";
    case envmap::Environment::Layout::kAngular:
      return "angular probe";
  }
  return "";
}

// The outline that --ball names, or none for auto. Error: usage.
Result<std::optional<envmap::BallDisc>> ball_outline(const std::string& where) {
  if (where == "auto") return std::optional<envmap::BallDisc>();
  std::vector<double> numbers;
  for (const std::string_view word : split(where, ','))
    if (const auto number = parse_number(word); number && std::isfinite(*number)) numbers.push_back(*number);
  if (numbers.size() != 3 || std::count(where.begin(), where.end(), ',') != 2 || !(numbers[2] > 0))
    return usage_error("--ball is \"{}\": give auto, or X,Y,RADIUS in texels", where);
  return std::optional<envmap::BallDisc>({numbers[0], numbers[1], numbers[2]});
}

Result<envmap::Environment> read_image(const Options& options) {
  using envmap::Environment;
  const auto bad = options.bad_pixels == "zero" ? Environment::BadPixels::kZero : Environment::BadPixels::kError;
  const std::string image = options.images.empty() ? "-" : options.images.front();
  if (options.ball.empty())
    return options.images.size() > 1 ? Environment::read_faces(options.images, bad) : Environment::read(image, bad);
  if (options.images.size() > 1) return usage_error("--ball with {} files: give one photograph", options.images.size());
  GONIO_ASSIGN(const std::optional<envmap::BallDisc> outline, ball_outline(options.ball));
  return Environment::read_ball(image, outline, bad);
}

Result<envmap::Environment> read_environment(const Options& options, const envmap::Rotation& turn) {
  auto read = read_image(options);
  if (read.ok() && options.exposure != 0) read = read->scaled(std::exp2(options.exposure));
  if (read.ok() && options.horizon > -90) read = read->above(options.horizon * kDegree, turn);
  return read;
}

void tell_source(const envmap::Environment& env, cli::Session& session) {
  const envmap::Environment::Counts& n = env.replaced();
  session.results()["source"] = {
      {"path", env.source()}, {"layout", layout_name(env)}, {"width", env.width()},   {"height", env.height()},
      {"nan", n.nan},         {"infinite", n.infinite},     {"negative", n.negative}, {"out_of_gamut", n.out_of_gamut}};
  if (env.ball())
    session.results()["source"]["ball"] = {{"x", env.ball()->x}, {"y", env.ball()->y}, {"radius", env.ball()->radius}};
  for (const std::string& remark : envmap::remarks(env)) session.warn(remark);
}

// The text of --explain.
std::string plan_text(const envmap::Environment& env, const Wanted& wanted, const Options& options,
                      const std::vector<prefilter::LobePlan>& plan, const prefilter::LobeSource& known) {
  const prefilter::PrefilterRequest& request = wanted.request;
  std::string text = fmt::format("{}: {}, {} x {} texels, each a constant patch\n", env.source(), layout_name(env),
                                 env.width(), env.height());
  for (const LeftOut& lobe : wanted.left_out)
    text += fmt::format("left out: {}: at most {:.1e} of what any of {} paints reflects, below the tolerance {}\n",
                        exponent_name(lobe.exponent), lobe.share, wanted.paints, shortest(request.tolerance));
  if (has_levels(options))
    text += "left out: the diffuse lobe and the mirror, which a mip-mapped cube has no level for\n";
  text += "exponent  size  method            degree  error    lookup   time\n";
  double total = 0;
  for (const prefilter::LobePlan& lobe : plan) {
    const bool there = known && known(lobe);
    text += fmt::format("{:<9} {:<5} {:<17} {:<7} {:<8.1e} {:<8.1e} {:.3f} s\n", exponent_name(lobe.exponent),
                        lobe.size, there ? "cache" : prefilter::method_name(lobe.method),
                        lobe.degree > 0 ? std::to_string(lobe.degree) : "-", lobe.predicted_error, lobe.lookup_error,
                        there ? 0 : lobe.predicted_time_s);
    total += there ? 0 : lobe.predicted_time_s;
  }
  text += fmt::format("about {:.2f} s on {} threads, and reading and writing\n", total, threads());
  text += fmt::format(
      "error: of a texel, relative to it or to 1e-3 of the mean, at most {}; lookup: what bilinear fetches between "
      "texels typically add{}\n",
      shortest(request.tolerance), request.size > 0 ? "; --size auto would keep that at ten times the tolerance" : "");
  return text;
}

struct Timing {
  double time_s = 0;
  bool cached = false;
};

Json report_of(const prefilter::LobePlan& plan, const envmap::PrefilteredLobe& lobe, const Timing& timing,
               double ratio) {
  const bool verified = lobe.verified_texels > 0;
  return {{"exponent", lobe.is_mirror() ? Json("mirror") : Json(lobe.exponent)},
          {"size", lobe.map.size},
          {"method", lobe.method},
          {"cached", timing.cached},
          {"degree", plan.degree},
          {"storage", envmap::storage_type(lobe) == image::PixelType::kHalf ? "half" : "float"},
          {"predicted_time_s", plan.predicted_time_s},
          {"time_s", timing.time_s},
          {"predicted_error", plan.predicted_error},
          {"lookup_error", plan.lookup_error},
          {"max_rel_error", verified ? json_number(lobe.max_error) : Json(nullptr)},
          {"mean_rel_error", verified ? json_number(lobe.mean_error) : Json(nullptr)},
          {"verified_texels", lobe.verified_texels},
          {"energy_ratio", json_number(ratio)}};
}

std::vector<envmap::PrefilteredLobe*> all_lobes(envmap::PrefilteredEnvironment& env) {
  std::vector<envmap::PrefilteredLobe*> lobes;
  if (env.diffuse.map.size > 0) lobes.push_back(&env.diffuse);
  for (envmap::PrefilteredLobe& lobe : env.lobes) lobes.push_back(&lobe);
  if (env.mirror.map.size > 0) lobes.push_back(&env.mirror);
  return lobes;
}

// Measures every lobe against the reference. Returns whether all keep the tolerance.
bool verify(const Options& options, const envmap::Environment& env, const envmap::Rotation& turn,
            envmap::PrefilteredEnvironment& result, cli::Session& session) {
  bool within = true;
  for (envmap::PrefilteredLobe* lobe : all_lobes(result)) {
    session.progress(fmt::format("{}: verifying {}", session.tool(), exponent_name(lobe->exponent)));
    const prefilter::LobeError error =
        prefilter::lobe_error(env, *lobe, options.verify, (options.verify + 9) / 10, options.common.seed, turn);
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

Result<void> write_for_engines(const Options& options, const envmap::PrefilteredEnvironment& result,
                               cli::Session& session) {
  const envmap::Rec709Levels rec709 = envmap::in_rec709(result.lobes);
  session.results()["clipped_to_rec709"] = rec709.clipped;
  if (rec709.clipped > 0)
    session.warn(fmt::format("{}: {} texels beyond Rec.709 clipped to it", result.source, rec709.clipped));
  if (options.layout == "dds") return envmap::write_dds(options.output, rec709.levels);
  return envmap::write_ktx2(options.output, rec709.levels, result.source, session.provenance());
}

Result<void> write(const Options& options, const envmap::PrefilteredEnvironment& result, cli::Session& session) {
  const std::string command = session.provenance();
  if (options.layout == "ktx2" || options.layout == "dds") return write_for_engines(options, result, session);
  if (options.layout == "mip") return envmap::write_mip(options.output, result.lobes, result.source, command);
  return envmap::write_env(options.output, result, command);
}

void tell_wanted(const Options& options, const Wanted& wanted, cli::Session& session) {
  session.results()["layout"] = options.layout;
  Json& left_out = session.results()["left_out"] = Json::array();
  for (const LeftOut& lobe : wanted.left_out)
    left_out.push_back({{"exponent", paint::is_mirror(lobe.exponent) ? Json("mirror") : Json(lobe.exponent)},
                        {"share", json_number(lobe.share)}});
}

// Returns the maps, and appends to `timings` how long each of them took. Lobes that the cache lacks are put into it.
Result<envmap::PrefilteredEnvironment> filter(const envmap::Environment& env,
                                              const prefilter::PrefilterRequest& request,
                                              const std::vector<prefilter::LobePlan>& plan,
                                              const std::optional<prefilter::LobeCache>& cache, cli::Session& session,
                                              std::vector<Timing>& timings) {
  std::vector<bool> found;
  Result<void> kept = {};
  const auto done = [&](const envmap::PrefilteredLobe& lobe, double time_s) {
    const bool cached = cache && found[timings.size()];
    timings.push_back({time_s, cached});
    if (cache && !cached && kept.ok()) kept = cache->keep(lobe);
    session.progress(fmt::format("{}: {} of {} lobes, {}", session.tool(), timings.size(), plan.size(),
                                 exponent_name(lobe.exponent)));
  };
  prefilter::LobeSource known;
  if (cache)
    known = [&](const prefilter::LobePlan& lobe) {
      auto there = cache->find(lobe);
      found.push_back(there.has_value());
      return there;
    };
  envmap::PrefilteredEnvironment result = prefilter::prefiltered(env, request, plan, done, known);
  GONIO_TRY(kept);
  return result;
}

}  // namespace

namespace {

Result<void> check_picture(const Options& options) {
  if (options.picture.empty()) return {};
  if (!options.picture.ends_with(".png"))
    return usage_error("--picture is \"{}\": give a name that ends in .png", options.picture);
  if (options.layout != "env" && !has_levels(options))
    return usage_error("--picture shows cubes, and --layout {} makes none: look at the output itself", options.layout);
  return {};
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  keep_freed_memory();  // grids, moments and maps of some megabytes follow each other
  GONIO_TRY(check_picture(options));
  if (options.sparkle && options.layout != "env")
    return usage_error("--sparkle adds maps that the layout env alone has: leave --layout {} out", options.layout);
  const bool is_engine_cube = options.layout == "ktx2" || options.layout == "dds";
  GONIO_TRY(check_output_name(options.output,
                              is_engine_cube ? "a cube texture of --layout " + options.layout : "an EXR",
                              is_engine_cube ? "." + options.layout : ".exr"));
  GONIO_ASSIGN(const Wanted wanted, wanted_lobes(options));
  const prefilter::PrefilterRequest& request = wanted.request;
  const Stopwatch read_clock;
  GONIO_ASSIGN(const envmap::Environment env, read_environment(options, request.turn));
  session.results()["read_s"] = read_clock.elapsed_s();
  tell_wanted(options, wanted, session);
  tell_source(env, session);
  std::optional<prefilter::LobeCache> cache;
  if (!options.cache.empty()) {
    GONIO_ASSIGN(cache, prefilter::LobeCache::open(options.cache, env, request, cli::Session::version()));
  }
  const std::vector<prefilter::LobePlan> plan = prefilter::prefilter_plan(env, request);
  if (options.common.explain) {
    prefilter::LobeSource known;
    if (cache) known = [&](const prefilter::LobePlan& lobe) { return cache->find(lobe); };
    session.explain(plan_text(env, wanted, options, plan, known));
  }

  const Stopwatch filter_clock;
  std::vector<Timing> timings;
  GONIO_ASSIGN(envmap::PrefilteredEnvironment result, filter(env, request, plan, cache, session, timings));
  const double filter_s = filter_clock.elapsed_s();
  session.results()["filter_s"] = filter_s;

  const Stopwatch verify_clock;
  const bool within = options.verify == 0 || verify(options, env, request.turn, result, session);
  session.results()["verify_s"] = verify_clock.elapsed_s();

  const Vec3 flux = env.flux();
  session.begin_list("lobes");
  double worst = 0;
  std::vector<envmap::PrefilteredLobe*> lobes = all_lobes(result);
  for (std::size_t i = 0; i < lobes.size(); ++i) {
    worst = std::max(worst, lobes[i]->max_error);
    session.add("lobes",
                [&] { return report_of(plan[i], *lobes[i], timings[i], prefilter::energy_ratio(flux, *lobes[i])); });
  }
  for (const envmap::Spot& spot : result.spots) {
    const Vec3 light = kPi * spot.white;
    session.results()["spots"].push_back(
        {{"direction", {spot.direction.x, spot.direction.y, spot.direction.z}},
         {"radius_deg", spot.radius_rad / kDegree},
         {"share", json_number((light.x + light.y + light.z) / (flux.x + flux.y + flux.z))}});
  }
  const Stopwatch open_maps_clock;
  if (options.layout == "env" && !options.no_open_maps) envmap::keep_open_maps(result);
  session.results()["open_maps_s"] = open_maps_clock.elapsed_s();
  const Stopwatch sparkle_clock;
  if (options.sparkle) prefilter::keep_rms_maps(env, request, result);
  session.results()["sparkle_s"] = sparkle_clock.elapsed_s();
  const Stopwatch write_clock;
  GONIO_TRY(write(options, result, session));
  if (!options.picture.empty()) GONIO_TRY(image::write_png(options.picture, contact_sheet(result)));
  session.results()["write_s"] = write_clock.elapsed_s();

  const std::string checked = options.verify == 0
                                  ? fmt::format("tolerance {}, not verified", shortest(request.tolerance))
                                  : fmt::format("largest error {:.2e} of {} texels a lobe, tolerance {}", worst,
                                                lobes.front()->verified_texels, shortest(request.tolerance));
  session.say(fmt::format("{}: {} lobes in {:.2f} s; {}", session.tool(), lobes.size(), filter_s, checked));
  return within ? cli::Verdict::kDone : cli::Verdict::kNegative;
}

}  // namespace goniochrome::tool
