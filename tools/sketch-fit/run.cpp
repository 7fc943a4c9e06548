#include "tool.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "base/clock.h"
#include "base/text.h"
#include "brdf/gloss.h"
#include "display/display.h"
#include "formats/default_basis.h"
#include "paint/curve.h"
#include "paint_stream.h"
#include "residual.h"
#include "sketch/registration.h"
#include "sketch/sketch.h"
#include "sketch/sketch_light.h"
#include "sketch/sketch_picture.h"
#include "sketch/sketch_pixels.h"

namespace goniochrome::tool {

namespace {

constexpr double kToldBounce_de00 = 0.5;  // below it, an error of bounced light is not worth a warning

// Everything that the fit looks at; `input` points into it.
struct Material {
  image::AovFile buffers;
  sketch::Picture picture;
  image::Image mask;
  std::optional<sketch::Registration> registration;
  envmap::PrefilteredEnvironment env;
  formats::Basis basis;
  std::optional<sketch::SketchTransport> transport;
  image::Image shaded;  // by the transport, in the paints that were worn
  sketch::SketchInput input;
};

Result<double> gain_of(const Options& options, const Material& material) {
  if (options.exposure != "auto") {
    const auto stops = parse_number(options.exposure);
    if (!stops || std::abs(*stops) > 64)
      return usage_error("--exposure is \"{}\": write a number of stops, or auto", options.exposure);
    return std::exp2(-*stops);
  }
  return material.picture.scene_linear ? std::exp2(-material.buffers.exposure_stops)
                                       : std::exp2(-material.buffers.automatic_stops);
}

Result<void> check_light(const Options& options, const image::AovFile& buffers) {
  if (!options.env.empty() || !buffers.transport.empty()) return {};
  if (!buffers.environment.empty())
    return usage_error("{} was rendered under the environment {}: give --env {}", buffers.path, buffers.environment,
                       buffers.environment);
  if (buffers.lights.size() > 1)
    return input_error("{} was rendered with {} lights: render picture and buffers with one --light", buffers.path,
                       buffers.lights.size());
  return {};
}

// Warns of effects that a picture under an environment shows and that the search does not know. It knows weights that
// change with the view where the paint found has some.
void warn_of_effects(const image::AovFile& buffers, bool found_views, cli::Session& session) {
  std::string unknown;
  for (const std::string& effect : sketch::effects_without_light(buffers))
    if (!(effect == "travel" && found_views)) unknown += ",-" + (effect == "anisotropy" ? "brushed" : effect);
  if (!unknown.empty())
    session.warn(
        fmt::format("{} was drawn with effects that the search does not know, and the paint will be off: render "
                    "it with --effects auto{}",
                    buffers.path, unknown));
}

// The effects that the picture was drawn without, as its own header tells them or else that of the buffers, which were
// rendered with it.
const std::vector<std::string>& left_out_of(const Material& material) {
  return material.picture.left_out ? *material.picture.left_out : material.buffers.left_out;
}

// Warns of light that the paint has and that the picture was drawn without.
void warn_of_left_out(const Options& options, const Material& material, cli::Session& session) {
  std::vector<std::string> light;
  for (const std::string& name : left_out_of(material))
    if (name == "diffuse" || name == "mirror" || name.starts_with("lobe-") || name.starts_with("gloss-"))
      light.push_back(name);
  if (light.empty()) return;
  session.warn(
      fmt::format("{} was drawn without {}, so that the paint found lacks it too, most of all near specular: render "
                  "picture and buffers with --effects all",
                  material.picture.left_out ? options.image : material.buffers.path, joined(light, ", ")));
}

// Lays a scan on the buffers. A mask of its size goes with it.
Result<void> register_scan(const Options& options, Material& material) {
  const image::Image &buffers = material.buffers.image, &scan = material.picture.rgb;
  const bool same_size = scan.width == buffers.width && scan.height == buffers.height;
  if (options.registration == "never" || (options.registration == "auto" && same_size)) return {};
  GONIO_ASSIGN(material.registration, sketch::registration_of(material.buffers, material.picture));
  if (material.mask.width == scan.width && material.mask.height == scan.height)
    material.mask = sketch::registered(material.mask, *material.registration, buffers.width, buffers.height);
  material.picture = sketch::registered(material.picture, *material.registration, buffers.width, buffers.height);
  return {};
}

void tell_registration(const Material& material, const Options& options, cli::Session& session) {
  session.results()["registration"] = nullptr;
  if (!material.registration) return;
  const sketch::Registration& r = *material.registration;
  session.results()["registration"] = {
      {"scale", r.scale}, {"turn_deg", r.turn_deg}, {"shift", {r.shift_x, r.shift_y}}, {"agreement", r.agreement}};
  session.say(fmt::format(
      "{} lies on the buffers at {:.3f} of their size, turned by {:.2f} deg and moved by {:.1f},{:.1f} pixels; their "
      "edges correlate by {:.2f}",
      options.image, r.scale, r.turn_deg, r.shift_x, r.shift_y, r.agreement));
  constexpr double kSure = 0.85;
  if (r.agreement < kSure)
    session.warn(
        fmt::format("the edges of {} and of the buffers correlate by {:.2f} only, where scans reach 0.9: look at "
                    "--residual, or bring both to one size",
                    options.image, r.agreement));
}

// Without --part a sketch is of all parts but those that --trim dressed.
Result<void> leave_out_trim(Material& material) {
  std::vector<int>& parts = material.input.parts;
  const std::vector<int>& trim = material.buffers.trim;
  if (material.transport) {
    parts = material.transport->mesh_parts();
  } else if (!trim.empty()) {
    parts.resize(material.buffers.parts.size());
    std::iota(parts.begin(), parts.end(), 1);
  }
  std::erase_if(parts, [&](int part) { return std::ranges::find(trim, part) != trim.end(); });
  if (parts.empty() && !trim.empty())
    return input_error("{}: --trim dressed every part: name by --part those that the sketch is of",
                       material.buffers.path);
  return {};
}

Result<void> gather(const Options& options, Material& material) {
  if (!options.shift.empty() && options.shift.size() != 2)
    return usage_error("--shift is given {} numbers: write X,Y", options.shift.size());
  if (!options.basis.empty() && !options.env.empty())
    return usage_error("--basis is for a point light: an environment brings its own");
  if (!options.residual.empty() && !options.residual.ends_with(".png"))
    return usage_error("--residual is \"{}\": give a name that ends in .png", options.residual);
  sketch::SketchInput& input = material.input;
  const bool by_name = options.view != "auto" && options.view != "plain";
  if (by_name && lower(options.view) != "paint") {
    const auto display = display::Display::make(options.view);
    if (!display.ok())
      return usage_error("--view is \"{}\": give auto, plain or a view: {}", options.view, display.error().message);
  }
  Result<sketch::Picture> picture = sketch::read_picture(
      options.image, options.view == "plain" ? sketch::PictureView::kShown : sketch::PictureView::kPaint,
      by_name ? options.view : "");
  Result<image::AovFile> buffers = image::read_aov_file(options.buffers);
  GONIO_ASSIGN(material.buffers, std::move(buffers));
  GONIO_TRY(check_light(options, material.buffers));
  for (const std::string& name : options.parts) {
    GONIO_ASSIGN(const int part, material.buffers.part(name));
    input.parts.push_back(part);
  }
  GONIO_ASSIGN(material.picture, std::move(picture));
  if (!options.mask.empty()) {
    GONIO_ASSIGN(image::ImagePart mask, image::read_image(options.mask));
    material.mask = std::move(mask.image);
    input.mask = &material.mask;
  }
  GONIO_TRY(register_scan(options, material));
  GONIO_ASSIGN(input.gain, gain_of(options, material));
  input.buffers = &material.buffers, input.edited = &material.picture;
  input.rule = options.pixels == "all"       ? sketch::PixelRule::kAll
               : options.pixels == "changed" ? sketch::PixelRule::kChanged
                                             : sketch::PixelRule::kAuto;
  // Where a scan is resampled, its fine detail differs from that of the picture without any edit.
  if (material.registration && options.pixels == "auto") input.rule = sketch::PixelRule::kAll;
  if (!options.shift.empty())
    input.shift_x = static_cast<int>(std::lround(options.shift[0])),
    input.shift_y = static_cast<int>(std::lround(options.shift[1]));
  GONIO_ASSIGN(material.transport, sketch::SketchTransport::of(material.buffers));
  if (options.parts.empty()) GONIO_TRY(leave_out_trim(material));
  if (material.transport) {
    material.shaded = material.transport->worn_picture();
    input.shaded = &material.shaded;
    return {};
  }
  if (options.env.empty()) {
    input.least_cosine = 0.05, input.glare_deg = options.glare_deg;
    GONIO_ASSIGN(material.basis, formats::basis_or_default(options.basis));
    return {};
  }
  GONIO_ASSIGN(material.env, envmap::read_env(options.env));
  return {};
}

void report_pixels(const sketch::SketchPixels& pixels, bool compared, Json& results) {
  results["pixels_used"] = pixels.used.size();
  results["pixels_changed"] = pixels.changed;
  results["pixels_rule"] = pixels.changed_only ? "changed" : "all";
  results["pixels_compared_with"] = compared ? Json(pixels.from_shaded ? "transport" : "picture") : Json(nullptr);
  results["pixels_left_out"] = Json::object();
  for (int use = 1; use < static_cast<int>(sketch::PixelUse::kCount); ++use)
    results["pixels_left_out"][sketch::pixel_use_name(static_cast<sketch::PixelUse>(use))] =
        pixels.count[static_cast<std::size_t>(use)];
}

void report_fit(const sketch::SketchFit& fit, bool environment, Json& results) {
  const bool fitted = fit.status == "fitted";
  results["status"] = fit.status;
  results["reason"] = fitted ? Json(nullptr) : Json(fit.reason);
  results["mode"] = environment ? "environment" : "point";
  results["model"] = fit.model;
  results["rms_de76"] = json_number(fit.rms_de76);
  results["median_de76"] = json_number(fit.median_de76);
  results["travel_deg"] = fit.appearance.travel_deg;
  results["face"] = lab_json(fit.appearance.face);
  results["flop"] = lab_json(fit.appearance.flop);
  results["rows"] = Json::array();
  for (const paint::LabReading& row : fit.rows)
    results["rows"].push_back(
        {{"geometry", paint::geometry_name(row.geometry)}, {"L", row.lab.L}, {"a", row.lab.a}, {"b", row.lab.b}});
  results["extrapolated_deg"] = fit.extrapolated_deg;
  results["residual_angle"] = fit.residual_angle.empty() ? Json(nullptr) : Json(fit.residual_angle);
  results["residual"] = Json::array();
  for (const sketch::AngleResidual& one : fit.residual)
    results["residual"].push_back({{"from_deg", one.from_deg},
                                   {"to_deg", one.to_deg},
                                   {"pixels", one.pixels},
                                   {"median_de76", json_number(one.median_de76)},
                                   {"L", json_number(one.mean.L)},
                                   {"a", json_number(one.mean.a)},
                                   {"b", json_number(one.mean.b)}});
  const bool told = !fit.gloss_from.empty() && fit.gloss_from != "undetermined";
  results["gloss_60_gu"] = told ? Json(fit.gloss_60_gu) : Json(nullptr);
  results["gloss_range_gu"] = fit.gloss_high_gu > 0 ? Json({fit.gloss_low_gu, fit.gloss_high_gu}) : Json(nullptr);
  results["gloss_from"] = fit.gloss_from.empty() ? Json(nullptr) : Json(fit.gloss_from);
  results["condition"] = fit.condition > 0 ? json_number(fit.condition) : Json(nullptr);
  results["aspecular_from_deg"] = environment ? Json(nullptr) : Json(fit.seen_from_deg);
  results["aspecular_to_deg"] = environment ? Json(nullptr) : Json(fit.seen_to_deg);
}

// Warns of the angles at which the picture is farthest from the paint found, where that can be seen.
void tell_residual(const Options& options, const sketch::SketchFit& fit, cli::Session& session) {
  constexpr double kSeen_de76 = 2;
  constexpr std::size_t kFewest = 20;  // pixels; the median of fewer is noise
  const sketch::AngleResidual* most = nullptr;
  for (const sketch::AngleResidual& one : fit.residual)
    if (one.pixels >= kFewest && one.median_de76 > (most != nullptr ? most->median_de76 : kSeen_de76)) most = &one;
  if (most == nullptr) return;
  session.warn(fmt::format("{} is {:.1f} dE76 (median of {} pixels) from the paint found at {} to {} deg from {}{}",
                           options.image, most->median_de76, most->pixels, most->from_deg, most->to_deg,
                           fit.residual_angle == "view" ? "the normal" : "specular",
                           options.residual.empty() ? ": see --residual" : ""));
}

// Tells what a reader should know beside the paint.
void tell(const Options& options, const sketch::SketchPixels& pixels, const sketch::SketchFit& fit,
          cli::Session& session) {
  if (fit.status != "fitted")
    session.warn(fmt::format("{}: the answer is the matt color that explains them best", fit.reason));
  if (!fit.extrapolated_deg.empty())
    session.warn(fmt::format("no pixel shows {} deg from specular: the color there is extrapolated",
                             fmt::join(fit.extrapolated_deg, ", ")));
  tell_residual(options, fit, session);
  const paint::Appearance& a = fit.appearance;
  const std::string gloss =
      fit.gloss_from.empty() ? ""
      : fit.gloss_from == "undetermined"
          ? fmt::format(", gloss undetermined between {:.0f} and {:.0f} GU", fit.gloss_low_gu, fit.gloss_high_gu)
          : fmt::format(", gloss {:.0f} GU by {}", fit.gloss_60_gu, fit.gloss_from);
  session.say(fmt::format(
      "{}: face {:.1f} {:.1f} {:.1f}, flop {:.1f} {:.1f} {:.1f}, travel {:.0f}{}; dE76 median {:.1f}, rms {:.1f}, {} {}"
      "pixels",
      options.name, a.face.L, a.face.a, a.face.b, a.flop.L, a.flop.a, a.flop.b, a.travel_deg, gloss, fit.median_de76,
      fit.rms_de76, pixels.used.size(), pixels.changed_only ? "edited " : ""));
}

// The paint in light that was traced. Bounced light depends on the paint, and so does the light that the coat leaves:
// both are changed to the paint found, and the paint is sought again.
sketch::SketchFit fit_in_transport(const sketch::SketchInput& input, const sketch::SketchPixels& pixels, int samples,
                                   const sketch::SketchLimits& limits, bool differences,
                                   sketch::SketchTransport& transport, cli::Session& session) {
  constexpr int kRounds = 3;
  sketch::SketchFit fit;
  double error_de00 = 0, coat_index = transport.coat_index();
  for (int round = 0; round < kRounds; ++round) {
    const sketch::SketchLight light = transport.light(samples, coat_index);
    fit = sketch::sketch_environment(input, pixels, light, limits, differences);
    if (fit.weights.empty() || round + 1 == kRounds) break;
    error_de00 = transport.wear(fit.weights, light.coat_index, input.parts);
    const auto index = brdf::coat_index_of({{60, fit.gloss_60_gu}});
    if (index.ok() && *index != paint::kNoCoat && coat_index != paint::kNoCoat) coat_index = *index;
  }
  session.results()["bounced_de00_p95"] = json_number(error_de00);
  if (error_de00 > kToldBounce_de00)
    session.warn(
        fmt::format("bounced light was traced in other paints; scaled to the paint found it is off by {:.1f} "
                    "dE00 (p95): trace again in that paint with render-osmesa --aov transport",
                    error_de00));
  return fit;
}

// Tells which light a fit without traced light does not know.
void tell_shadows(const image::AovFile& buffers, cli::Session& session) {
  if (std::ranges::find(buffers.drawn, "sparkle") != buffers.drawn.end())
    session.warn(fmt::format("{} shows single flakes, and a paint is their mean: render it with --effects auto,-sparkle",
                             buffers.path));
  if (!buffers.drawn_by_rays.empty())
    session.warn(
        fmt::format("{} shows {}: no paint explains what the mesh does to light, so that the paint found is off: "
                    "render picture and buffers with --effects auto,-rays, or the buffers with --aov transport",
                    buffers.path, buffers.drawn_by_rays));
  session.say(fmt::format(
      "{} holds no transport: the paint is sought in light that nothing blocks and no surface sends back. Where the "
      "picture has shadows or the body in itself, give buffers of render-osmesa --aov transport",
      buffers.path));
}

Result<void> check_usable(const sketch::SketchPixels& pixels, const Options& options) {
  if (!pixels.used.empty()) return {};
  std::string reasons;
  for (int use = 1; use < static_cast<int>(sketch::PixelUse::kCount); ++use)
    if (const auto count = pixels.count[static_cast<std::size_t>(use)]; count > 0)
      reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count,
                             sketch::pixel_use_name(static_cast<sketch::PixelUse>(use)));
  return input_error("{}: no pixel is left to fit ({}): check --mask, --part, --pixels and the exposure", options.image,
                     reasons);
}

void tell_shift(const sketch::SketchInput& input, cli::Session& session) {
  const sketch::SketchShift shift = sketch::sketch_shift(input);
  session.results()["suggested_shift"] = {shift.x, shift.y};
  if (shift.x != input.shift_x || shift.y != input.shift_y)
    session.warn(fmt::format("the picture seems moved by {},{} pixels against the buffers: try --shift {},{}", shift.x,
                             shift.y, shift.x, shift.y));
}

std::string plan_text(const Options& options) {
  std::string text =
      options.env.empty()
          ? "light: one lamp, from the buffers' aspecular and lambert\n"
            "curve: cosine lobes for flake and gloss light, or the clamped quadratic, whichever costs less; "
            "reweighted\n"
          : "light: the environment and the lamps of the buffers' header\n"
            "search: lobes of any weight and gloss; from there face, flop, travel and gloss, or else three rows, by "
            "damped least squares; the fewest numbers that explain the pixels as well\n";
  text += fmt::format("left out: edges, transparent and clipped pixels{}\n",
                      options.env.empty()
                          ? fmt::format(", light below 0.05, the {} deg about specular", shortest(options.glare_deg))
                          : "");
  return text + fmt::format("fallback: the matt color, where half of the pixels differ by more than {} dE76{}\n",
                            shortest(options.most_de76),
                            options.env.empty() ? ", or where all are too far from specular" : "");
}

}  // namespace

namespace {

// Lamps that are discs have highlights that tell the gloss. The search that knows them is the answer where it explains
// the pixels as well as the curve does.
Result<void> fit_lamps(const Material& material, const sketch::SketchLimits& limits, bool differences,
                       sketch::SketchPixels& pixels, sketch::SketchFit& fit) {
  if (!sketch::lamps_are_discs(material.buffers) || !material.buffers.has_rays ||
      !material.buffers.channel("normal.X").ok())
    return {};
  GONIO_ASSIGN(const sketch::SketchLight light, sketch::lamp_light(material.buffers, material.basis));
  sketch::SketchInput with_glare = material.input;
  with_glare.glare_deg = 0;
  GONIO_ASSIGN(sketch::SketchPixels all, sketch::sketch_pixels(with_glare));
  sketch::SketchFit by_lamps = sketch::sketch_lamps(with_glare, all, light, limits, differences);
  constexpr double kMore = 1.15, kMoreBy_de76 = 0.1;
  if (by_lamps.status != "fitted" || by_lamps.median_de76 > kMore * fit.median_de76 + kMoreBy_de76) return {};
  by_lamps.seen_from_deg = fit.seen_from_deg, by_lamps.seen_to_deg = fit.seen_to_deg;
  // The angles that neither of them has pixels for: a curve that fell back to a matt color names no angles.
  std::vector<double> extrapolated_deg;
  std::ranges::set_union(by_lamps.extrapolated_deg, fit.extrapolated_deg, std::back_inserter(extrapolated_deg));
  by_lamps.extrapolated_deg = std::move(extrapolated_deg);
  fit = std::move(by_lamps), pixels = std::move(all);
  return {};
}

}  // namespace

namespace {

// The paint of --start; none without the option.
Result<std::optional<paint::Paint>> start_of(const Options& options, cli::Session& session) {
  if (options.start.empty()) return std::optional<paint::Paint>();
  GONIO_ASSIGN(std::vector<paint::Paint> paints, all_paints(options.start, session));
  if (paints.size() != 1)
    return input_error("{}: --start takes one paint, and there are {}: write FILE#NAME", options.start, paints.size());
  return std::optional(std::move(paints.front()));
}

// Where the picture does not tell the gloss, it stays that of the start.
void keep_gloss(const std::optional<paint::Paint>& start, sketch::SketchFit& fit) {
  constexpr double kAngle_deg = 60;
  if (!start || fit.gloss_from != "undetermined") return;
  for (const paint::GlossReading& reading : start->gloss)
    if (reading.angle_deg == kAngle_deg) fit.gloss_60_gu = reading.gloss_units, fit.gloss_from = "start";
}

paint::Paint named_paint(const sketch::SketchFit& fit, const std::optional<paint::Paint>& start,
                         const Options& options) {
  paint::Paint paint = sketch::sketch_paint(fit, options.name);
  if (start) paint.code = start->code;
  return paint;
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  session.explain(plan_text(options));
  Material material;
  GONIO_TRY(gather(options, material));
  GONIO_ASSIGN(const std::optional<paint::Paint> start, start_of(options, session));
  const sketch::SketchInput& input = material.input;
  if (options.parts.empty() && !material.buffers.trim.empty())
    session.say(fmt::format("left out: {} parts that --trim dressed; --part takes parts by name",
                            material.buffers.trim.size()));
  tell_registration(material, options, session);
  for (const std::string& warning : material.picture.warnings) session.warn(warning);
  warn_of_left_out(options, material, session);
  const Stopwatch clock;
  GONIO_ASSIGN(sketch::SketchPixels pixels, sketch::sketch_pixels(input));
  GONIO_TRY(check_usable(pixels, options));
  sketch::SketchLimits limits;
  limits.median_de76 = options.most_de76;
  const bool differences = !options.residual.empty();
  const bool environment = !options.env.empty() || material.transport;
  sketch::SketchFit fit;
  if (material.transport) {
    const int samples = material.picture.samples.value_or(pixels.from_shaded ? material.transport->samples()
                                                                             : material.buffers.samples);
    fit = fit_in_transport(input, pixels, samples, limits, differences, *material.transport, session);
  } else if (environment) {
    GONIO_ASSIGN(const sketch::SketchLight light, sketch::sketch_light(material.buffers, material.env));
    fit = sketch::sketch_environment(input, pixels, light, limits, differences);
  } else {
    fit = sketch::sketch_point(input, pixels, material.basis, limits, differences);
    GONIO_TRY(fit_lamps(material, limits, differences, pixels, fit));
  }
  if (!options.env.empty() && !material.transport) warn_of_effects(material.buffers, fit.by_views, session);
  if (!material.transport) tell_shadows(material.buffers, session);
  keep_gloss(start, fit);
  Json& results = session.results();
  report_fit(fit, environment, results);
  if (material.transport) results["mode"] = "transport";
  report_pixels(pixels, input.rule != sketch::PixelRule::kAll, results);
  tell_shift(input, session);
  results["color_space"] = material.picture.space;
  results["fit_s"] = clock.elapsed_s();
  if (differences) GONIO_TRY(write_residual(options.residual, material.buffers, pixels, fit));
  GONIO_TRY(write_paints(options.output, {named_paint(fit, start, options)}, session));
  tell(options, pixels, fit, session);
  return cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
