#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "base/file.h"
#include "base/paths.h"
#include "base/text.h"
#include "brdf/sbrdf.h"
#include "envmap/env_content.h"
#include "envmap/environment.h"
#include "envmap/open_maps.h"
#include "formats/default_basis.h"
#include "formats/paint_source.h"
#include "image/image.h"
#include "prefilter/filtered_image.h"
#include "prefilter/lobe_tree.h"
#include "prefilter/prefilter.h"
#include "stage.h"
#include "stream.h"

namespace goniochrome::tool {

namespace {

// A file holds exponents as floats.
bool has_exponent(const std::vector<double>& exponents, double exponent) {
  return std::ranges::any_of(exponents, [&](double of) { return std::abs(of - exponent) <= 1e-6 * of; });
}

// Tells by exponent whether one picture of these paints looks up a map of the environment; null if it may use all.
std::function<bool(double)> looked_up_maps(const Options& options, const Request& request, const Stage& stage) {
  const bool sums = request.traces() || (request.engine != nullptr && request.engine->needs_texels);
  if (is_stream(options) || !options.textures.empty() || options.check > 0 || request.transport || sums) return {};
  std::vector<paint::LobeFit> paints;
  for (const DressedMesh& dress : stage.dresses) paints.insert(paints.end(), dress.paints.begin(), dress.paints.end());
  if (std::ranges::any_of(paints, [](const paint::LobeFit& paint) { return !paint.tilts.empty(); })) return {};
  const bool rays = options.gbuffer.empty() && !options.effects.leave_out_rays();
  const bool mirror = rays || options.effects.forced_on("sums").value_or(false) || render::has_mirror(paints) ||
                      options.background == "env";
  return [mirror, exponents = render::lobe_exponents(paints)](double exponent) {
    return paint::is_mirror(exponent) ? mirror : has_exponent(exponents, exponent);
  };
}

// The exponents of all paints that are to be drawn, as far as they have lobes already. Those of a stream on standard
// input are not known yet.
Result<std::vector<double>> worn_exponents(const Options& options, const Stage& stage) {
  std::vector<paint::LobeFit> paints;
  for (const DressedMesh& dress : stage.dresses) paints.insert(paints.end(), dress.paints.begin(), dress.paints.end());
  if (is_stream(options) && options.paint != "-") {
    GONIO_ASSIGN(const formats::PaintSourcePointer source, formats::open_paints(options.paint));
    while (source->holds_designs()) {  // readings have no lobes yet
      auto paint = source->next();
      if (!paint.ok()) continue;  // the stream tells it
      if (!*paint) break;
      if ((*paint)->lobes) paints.push_back(*std::move((*paint)->lobes));
    }
  }
  std::vector<double> exponents = render::lobe_exponents(paints);
  for (const paint::LobeFit& paint : paints)
    for (const paint::TiltedLobes& set : paint.tilts)
      for (const paint::TiltedLobe& lobe : set.lobes)
        if (!paint::is_mirror(lobe.exponent)) exponents.push_back(lobe.exponent);
  return exponents;
}

// Adds maps between which the lobes of textures lie: the sharpest, each four times as sharp as the next, and the
// widest. One cube with levels needs every quarter of its sharpest.
void add_texture_exponents(const Options& options, const Stage& stage, std::vector<double>& exponents) {
  constexpr double kStep = 4;
  brdf::LobeRange range;
  for (const DressedMesh& dress : stage.dresses)
    for (const auto& texture : dress.textures) range.add(*texture);
  const auto [low, high] = range;
  if (high == 0) return;
  const double most = std::max(1.0, std::ranges::max(exponents));
  if (options.texture_maps == "mip") {
    double finest = kStep;
    while (finest < std::max(high, most)) finest *= kStep;
    for (double exponent = finest; exponent > 1; exponent /= kStep) exponents.push_back(exponent);
    return;
  }
  for (double exponent = high; exponent > most; exponent /= kStep) exponents.push_back(exponent);
  if (low < std::min(1.0, std::ranges::min(exponents))) exponents.push_back(low);
}

// The exponents that an image is filtered by. Those of the whole basis serve the next paint as well; paints of another
// basis have theirs.
Result<std::vector<double>> wanted_exponents(const Options& options, const Request& request, const Stage& stage) {
  if (request.traces()) return std::vector<double>();
  GONIO_ASSIGN(const formats::Basis basis, formats::basis_or_default(options.basis));
  GONIO_ASSIGN(std::vector<double> exponents, worn_exponents(options, stage));
  if (std::ranges::all_of(exponents, [&](double exponent) { return has_exponent(basis.exponents, exponent); }))
    exponents = basis.exponents;
  add_texture_exponents(options, stage, exponents);
  return exponents;
}

// An image of light, filtered or as an earlier run left it.
Result<envmap::PrefilteredEnvironment> light_of_image(const Options& options, const Request& request,
                                                      const Stage& stage, cli::Session& session) {
  GONIO_ASSIGN(const std::vector<double> exponents, wanted_exponents(options, request, stage));
  const std::string folder = options.no_cache ? "" : user_cache_folder();
  const FileCache cache = prefilter::filtered_images(folder);
  session.progress(options.env + ": filtering");
  GONIO_ASSIGN(prefilter::FilteredImage filtered,
               prefilter::filtered_image(options.env, exponents, cli::Session::version(),
                                         folder.empty() ? nullptr : &cache, looked_up_maps(options, request, stage)));
  for (const std::string& remark : filtered.remarks) session.warn(remark);
  session.results()["filtering"] = {{"was_kept", filtered.was_kept}, {"time_s", filtered.time_s}};
  if (filtered.was_kept) {
    session.explain(fmt::format("{}: an earlier run filtered it, and its maps are in {}\n", options.env, folder));
    return std::move(filtered.env);
  }
  const bool kept = !folder.empty() && filtered.not_kept.empty();
  session.say(fmt::format("{}: filtered by {} lobes in {:.2f} s{}", options.env,
                          prefilter::filter_exponents(exponents).size() + 2, filtered.time_s,
                          kept ? ", and kept in " + folder : ""));
  if (!filtered.not_kept.empty())
    session.warn(fmt::format("the maps of {} are not kept for the next run: {}: make room there, or give --no-cache",
                             options.env, filtered.not_kept));
  return std::move(filtered.env);
}

// True if the image holds the light of the environment, which may have been turned, brightened or cut since: their
// irradiance agrees about the middle of each face.
bool is_same_light(const envmap::Environment& image, const envmap::PrefilteredEnvironment& env) {
  constexpr double kApart = 0.03;  // of the largest; the tolerance of the diffuse map is at most a tenth in use
  const envmap::CubeMap& map = env.diffuse.map;
  if (map.size == 0) return true;  // nothing to tell by
  const prefilter::LobeTree exact(image);
  const int middle = map.size / 2;
  double largest = 0, apart = 0;
  for (int face = 0; face < 6; ++face) {
    const Vec3 truth = exact.lobe(envmap::cube_direction(face, middle + 0.5, middle + 0.5, map.size), 1, 1e-3);
    for (int c = 0; c < 3; ++c) {
      largest = std::max(largest, truth[c]);
      apart = std::max(apart, std::abs(truth[c] - map.at(face, middle, middle)[c]));
    }
  }
  return apart <= (kApart + env.diffuse.tolerance) * largest;
}

}  // namespace

Result<envmap::PrefilteredEnvironment> environment_of(const Options& options, const Request& request,
                                                      const Stage& stage, cli::Session& session) {
  const bool is_layer =
      options.env.find("{face}") != std::string::npos || image::image_file(options.env) != options.env;
  if (is_layer) return light_of_image(options, request, stage, session);
  GONIO_ASSIGN(InputFile input, InputFile::open(options.env));
  GONIO_ASSIGN(const std::string content, input.rest(std::string::npos));
  if (!content.empty() && !envmap::is_prefiltered(content)) {
    if (is_plain_file(options.env)) return light_of_image(options, request, stage, session);
    return input_error(
        "{}: is no prefiltered environment, and an image is filtered where it is a file: name a file, or filter it by "
        "prefilter-envmap",
        input.name());
  }
  GONIO_ASSIGN(envmap::PrefilteredEnvironment env,
               envmap::env_of_content(content, input.name(), looked_up_maps(options, request, stage)));
  envmap::keep_open_maps(env);  // those that the file lacks
  return env;
}

Result<Source> source_of(const Options& options, const render::Scene& scene, cli::Session& session) {
  if (scene.env == nullptr) return Source{};
  std::vector<std::string> candidates = {options.check_source};
  if (options.check_source.empty()) {
    candidates = {scene.env->source, (std::filesystem::path(options.env).parent_path() / scene.env->source).string()};
  }
  std::string missing = "is not there";
  for (const std::string& path : candidates) {
    const bool is_pattern = path.find("{face}") != std::string::npos;
    const bool there = is_pattern ? envmap::face_paths(path).ok() : is_plain_file(image::image_file(path));
    if (!there && options.check_source.empty()) continue;
    GONIO_ASSIGN(envmap::Environment environment,
                 envmap::Environment::read(path, envmap::Environment::BadPixels::kZero));
    if (is_same_light(environment, *scene.env)) return Source{std::move(environment), path};
    missing = "is turned, brightened or cut there";
    break;
  }
  if (scene.env->mirror.map.size == 0) {
    return input_error(
        "{}: its source \"{}\" {}, and it has no mirror part: name the image by --check-source, or make it with a "
        "mirror",
        options.env, scene.env->source, missing);
  }
  session.warn(fmt::format("the source \"{}\" of {} {}: its mirror part takes its place", scene.env->source,
                           options.env, missing));
  return Source{envmap::Environment::from_cube(scene.env->mirror.map, options.env), options.env + " (mirror part)"};
}

}  // namespace goniochrome::tool
