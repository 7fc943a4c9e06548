#include "tool.h"

#include <algorithm>
#include <cstdio>

#include "base/file.h"
#include "base/file_names.h"
#include "base/paths.h"
#include "base/text.h"
#include "display/display.h"
#include "in_time.h"
#include "paint_views.h"
#include "picture_file.h"
#include "plan_text.h"
#include "render/aov.h"
#include "render/left_out.h"
#include "render/picture_error.h"
#include "render/planning.h"
#include "setup.h"
#include "sight.h"
#include "stage.h"
#include "stream.h"
#include "truth_check.h"

namespace goniochrome::tool {

namespace {

// Pixels that the truth of each effect is measured at; it takes an integration for each of them.
constexpr int kMostTruth = 100;

// Beside the plan's estimates, what they are worth here: how far the picture is from that of all effects, and its time.
Result<void> measure_plan(render::Renderer& renderer, const render::Scene& scene, const render::Plan& plan,
                          const render::View& view, double white, cli::Session& session) {
  GONIO_ASSIGN(const render::LeftOut measured, render::left_out(renderer, scene, plan, view, white));
  session.results()["left_out"] = {{"de00_mean", json_number(measured.de00_mean)},
                                   {"de00_p95", json_number(measured.de00_p95)},
                                   {"de00_max", json_number(measured.de00_max)},
                                   {"shading_ms", measured.planned_ms},
                                   {"shading_all_ms", measured.full_ms}};
  session.say(fmt::format(
      "left out: dE00 p95 {:.2f} to the picture of all effects (predicted {:.2f}); shading {:.1f} ms a sample of each "
      "pixel, with all effects {:.1f}",
      measured.de00_p95, plan.de00_p95, measured.planned_ms, measured.full_ms));
  return {};
}

// The right half of `other` takes the place of the picture's.
void put_right_half(const render::Frame& other, render::Frame& frame) {
  for (int y = 0; y < frame.picture.height; ++y) {
    for (int x = frame.picture.width / 2; x < frame.picture.width; ++x) {
      std::copy_n(other.picture.pixel(x, y), 4, frame.picture.pixel(x, y));
    }
  }
}

// A run that draws: its shots share one context and one upload.
class Shooting {
 public:
  Shooting(const Options& options, Request request, Stage& stage, cli::Session& session)
      : options_(options), request_(std::move(request)), stage_(stage), session_(session), frames_(options.to) {}

  Result<cli::Verdict> shoot(const std::optional<display::Display>& display);

 private:
  render::View view(const Shot& shot, int shrink) const {
    return {shot.camera, std::max(1, request_.size.width / shrink), std::max(1, request_.size.height / shrink),
            shrink > 1 ? 1 : request_.samples, shrink == 1 && options_.check > 0};
  }
  // True if the picture is drawn by rays alone.
  bool by_rays() const {
    const auto engine = render::engine_named(plan_.engine);
    return engine.ok() && (*engine)->traces_rays;
  }
  bool is_enlarged() const { return timed_ && timed_->enlarged_from(); }
  render::Scene over_floor(bool wanted) const;
  void leave_out_hidden_floor();
  bool is_quick() const;
  void tell_noise();
  void tell_maps();
  void tell(bool explains, const std::string& line) const;
  void tell_rays();
  Result<void> look(render::Renderer& renderer);
  Result<render::Plan> load(render::Renderer& renderer, const DressedMesh& dress);
  Result<void> draw(render::Renderer& renderer, const Shot& shot, bool first);
  Result<void> draw_in_time(render::Renderer& renderer, const Shot& shot, bool first, render::Frame& frame);
  Result<cli::Verdict> shade_transport(const std::optional<display::Display>& display);
  Result<void> write(const Shot& shot, const std::optional<display::Display>& display);
  Result<cli::Verdict> check_picture();
  void tell_plan(render::Plan plan, const std::string& shader);
  void tell_findings(const render::Frame& frame);

  const Options& options_;
  Request request_;
  Stage& stage_;
  cli::Session& session_;
  FrameOutput frames_;
  std::vector<Shot> shots_;
  std::vector<std::shared_ptr<const render::Gbuffer>> looks_;
  Exposure exposure_;
  render::Plan plan_;
  render::Frame frame_;
  std::optional<TimedPictures> timed_;  // none: not yet, or pictures take the time that they need
  bool stopped_ = false;                // before the noise was within the tolerance that was asked for
  bool all_reached_ = true;             // whether that of the pictures by an engine with noise is, asked for or not
};

// The scene with the floor of its picture, wherever that is drawn.
render::Scene Shooting::over_floor(bool wanted) const {
  render::Scene scene = stage_.scene;
  if (wanted && stage_.rays && stage_.rays->absent.empty() && !scene.ground) scene.ground = stage_.rays->floor;
  return scene;
}

// From below, a floor would hide the mesh.
void Shooting::leave_out_hidden_floor() {
  if (!stage_.rays || !stage_.rays->floor) return;
  const auto below =
      std::ranges::find_if(shots_, [&](const Shot& shot) { return shot.camera.eye.y <= stage_.rays->floor->height; });
  if (below == shots_.end()) return;
  if (stage_.rays->floor_forced)
    session_.warn(fmt::format("the camera of {} is below the floor, which is left out", below->output));
  stage_.rays->no_floor = "the camera is below the floor";
  stage_.rays->floor.reset();
}

// A sequence is planned on small pictures from some of its places, a single picture on itself.
Result<void> Shooting::look(render::Renderer& renderer) {
  constexpr std::size_t kLooks = 8;
  const int shrink = shots_.size() > 1 ? 4 : 1;
  const std::size_t step = (shots_.size() + kLooks - 1) / kLooks;
  for (std::size_t i = 0; i < shots_.size(); i += step) {
    GONIO_ASSIGN(std::shared_ptr<const render::Gbuffer> seen, renderer.look(stage_.mesh, view(shots_[i], shrink)));
    looks_.push_back(std::move(seen));
    if (options_.turntable == 0) break;
  }
  return {};
}

Result<render::Plan> Shooting::load(render::Renderer& renderer, const DressedMesh& dress) {
  wear(dress, options_, stage_);
  auto plan = renderer.load(stage_.scene, looks_, request_.plan);
  if (plan.ok()) return plan;
  return Error{plan.error().kind, (options_.env.empty() ? "" : options_.env + ": ") + plan.error().message};
}

void Shooting::tell_plan(render::Plan plan, const std::string& shader) {
  Json& results = session_.results();
  results["plan_de00_p95"] = json_number(plan.de00_p95);
  results["plan_quick"] = request_.quick;
  results["plan_ms"] = plan.time_ms;
  session_.explain(plan_table(plan));
  if (request_.quick && (plan.effects.rays.any() || request_.traces()))
    session_.explain(fmt::format("no tolerance, time limit or check is asked for: rays end after {:g} s\n", kQuick_s));
  if (request_.plan.effects.forced_on("sparkle").value_or(false))
    for (const render::PlanItem& item : plan.items)
      if (item.effect == "sparkle" && !item.on) session_.warn("no sparkle is drawn: " + item.reason);
  if (options_.print_shader) std::fputs((shader_gaps(plan) + shader).c_str(), stdout);
  plan_ = std::move(plan);
}

// Tells the findings of the first picture on effects that no plan can know.
void Shooting::tell_findings(const render::Frame& frame) {
  const render::Plan before = plan_;
  render::add_findings(frame.rays, frame.maps, plan_);
  session_.explain(findings_text(before, plan_));
  for (Json& row : plan_rows(plan_)) session_.results()["plan"].push_back(std::move(row));
}

Result<void> Shooting::draw(render::Renderer& renderer, const Shot& shot, bool first) {
  stage_.scene.lights = shot.lights;
  for (std::size_t i = 0; i < stage_.dresses.size(); ++i) {
    render::Frame other;
    if (stage_.dresses.size() > 1 || first) {
      GONIO_ASSIGN(render::Plan plan, load(renderer, stage_.dresses[i]));
      if (first && options_.check > 0 && session_.common().explain) {
        const auto sample = render::sampled_pixels(*looks_.front(), stage_.scene, std::min(options_.check, kMostTruth),
                                                   session_.common().seed);
        std::vector<render::ProbePixel> pixels;
        for (const auto& [x, y] : sample.places) pixels.push_back({looks_.front().get(), x, y, {}});
        render::add_truth(plan, render::seen_scene(stage_.scene, looks_), sample.points, stage_.source.image(),
                          exposure_.white.luminance, pixels);
      }
      if (first) {
        tell_plan(std::move(plan), renderer.shader());
        for (const std::string& remark : renderer.remarks()) session_.warn(remark);
      }
    } else {
      wear(stage_.dresses[i], options_, stage_);
      renderer.load_paints(stage_.scene);
    }
    GONIO_TRY(draw_in_time(renderer, shot, first && i == 0, i == 0 ? frame_ : other));
    if (first) tell_findings(i == 0 ? frame_ : other);
    if (i == 1) put_right_half(other, frame_);
  }
  return {};
}

// A time limit is kept where rays correct a picture or its paths are smoothed; other pictures are drawn whole.
Result<void> Shooting::draw_in_time(render::Renderer& renderer, const Shot& shot, bool first, render::Frame& frame) {
  const bool is_timed =
      session_.common().time_limit_s > 0 && !request_.transport && (plan_.effects.rays.any() || request_.smooths_paths);
  if (!is_timed) return renderer.draw(view(shot, 1), frame);
  if (!timed_) timed_.emplace(stage_.mesh, effort_of(options_, request_, session_));
  const auto seen = shots_.size() == 1 ? looks_.front() : nullptr;
  GONIO_TRY(timed_->draw(renderer, view(shot, 1), first ? session_.elapsed_s() : 0, seen, frame));
  if (const std::optional<PictureSize>& size = timed_->enlarged_from(); first && size) {
    session_.results()["enlarged_from"] = {{"width", size->width}, {"height", size->height}};
    session_.warn(
        fmt::format("--time-limit {} is too short for {} x {} pixels: the picture is enlarged from {} x {}, whose "
                    "errors alone are told",
                    shortest(session_.common().time_limit_s), request_.size.width, request_.size.height, size->width,
                    size->height));
  }
  return {};
}

Result<void> Shooting::write(const Shot& shot, const std::optional<display::Display>& display) {
  if (!display) {
    const render::Scene drawn = over_floor(plan_.effects.rays.floor || by_rays());
    std::optional<TracedView> traced;
    if (request_.transport) {
      const bool with_maps = !by_rays() && (request_.engine == nullptr || request_.engine->is_planned);
      GONIO_ASSIGN(traced, traced_view(drawn, stage_.source.image(), with_maps, *frame_.gbuffer, request_.samples,
                                       exposure_.white.luminance, options_.bounces, session_));
      frame_.gbuffer = traced->gbuffer;
      stopped_ |= !traced->reached;
    }
    GONIO_ASSIGN(std::vector<image::ImagePart> picture,
                 exr_picture(options_, request_, frame_, drawn, stage_.dresses.front(), plan_, exposure_,
                             traced ? &traced->file : nullptr, session_));
    if (options_.to.empty()) return image::write_exr(shot.output, picture);
    GONIO_ASSIGN(const std::string content, exr_frame(std::move(picture)));
    return frames_.write(content, request_.size);
  }
  image::ByteImage shown;
  GONIO_TRY(display->show(frame_.picture, exposure_.stops, shown));
  if (!options_.to.empty()) return frames_.write(frames_.content(shown), request_.size);
  return write_file(shot.output, image::png_content(shown, provenance(session_, &*display)));
}

// Other paints in the light that was traced; nothing is planned, since all is there.
Result<cli::Verdict> Shooting::shade_transport(const std::optional<display::Display>& display) {
  TransportViews views(options_, request_, stage_, session_);
  GONIO_ASSIGN(const ShadedPaint shaded, views.show(stage_.dresses.front(), frame_.picture));
  const double tolerance = session_.common().tolerance;
  if (!shaded.scaled) {
    session_.say("bounced light is that of these paints");
  } else if (shaded.bounced_de00_p95 <= tolerance) {
    session_.say(fmt::format("bounced light was traced in other paints and scaled to these: off by {:.2f} dE00 (p95)",
                             shaded.bounced_de00_p95));
  } else {
    session_.warn(fmt::format(
        "bounced light was traced in other paints; scaled to these it is off by {:.2f} dE00 (p95), above --tolerance "
        "{}: trace again with --aov transport in these paints",
        shaded.bounced_de00_p95, tolerance));
  }
  frame_.gbuffer = stage_.gbuffer;
  exposure_ = views.exposure, plan_ = *views.plan;
  stage_.scene.lights.clear();
  for (const image::AovLight& light : stage_.transport->file.lights)
    stage_.scene.lights.push_back(render::light_of(light));
  GONIO_TRY(write({{}, {}, options_.output}, display));
  report_pictures(plan_, exposure_, 1, 0, shaded.frame_ms, session_);
  session_.say(fmt::format("{}: {} x {}, shaded in {:.1f} ms from the light of {}, exposure {:+.2f}{}",
                           options_.output == "-" ? "standard output" : options_.output, request_.size.width,
                           request_.size.height, shaded.frame_ms, options_.gbuffer, exposure_.stops,
                           display ? ", " + display->name() : ""));
  return shaded.bounced_de00_p95 > tolerance ? cli::Verdict::kNegative : cli::Verdict::kDone;
}

// Says a line, which --quiet keeps where it explains an exit status.
void Shooting::tell(bool explains, const std::string& line) const {
  explains ? session_.say_verdict(line) : session_.say(line);
}

// The errors of maps where no surface is in the way of light.
void Shooting::tell_maps() {
  if (frame_.maps.errors_de00.empty()) return;
  const double de00 = frame_.maps.de00_p95();
  session_.results()["maps"] = {{"de00_p95", json_number(de00)}, {"points", frame_.maps.errors_de00.size()}};
  if (!plan_.effects.rays.any()) session_.say(fmt::format("maps: errors dE00 {:.2f} (p95)", de00));
}

// Tells the effects of rays that an engine without rays was given.
void Shooting::tell_rays() {
  const render::CorrectionNoise& rays = frame_.rays;
  if (!plan_.effects.rays.any() || (rays.dark && !plan_.effects.rays.floor)) return;
  session_.results()["rays"] = {{"noise_de00_p95", json_number(rays.de00_p95)},
                                {"error_de00_p95", json_number(rays.error_de00_p95)},
                                {"samples", rays.samples},
                                {"free_share", rays.free_share},
                                {"reached", rays.reached},
                                {"ms", rays.ms}};
  const bool late =
      session_.common().time_limit_s > 0 && session_.common().tolerance_given && (!rays.reached || is_enlarged());
  stopped_ |= late;
  constexpr double kWorthTelling = 0.5;
  const double tolerance = session_.common().tolerance, maps = frame_.maps.de00_p95();
  tell(late, fmt::format("rays: {:.0f} samples a point in {:.0f} ms, errors dE00 {:.2f} (p95){}{}", rays.samples,
                         rays.ms, rays.error_de00_p95,
                         maps > kWorthTelling * tolerance ? fmt::format(", {:.2f} by maps alone", maps) : "",
                         rays.reached ? "" : fmt::format(", more than {:.3g}", tolerance)));
}

bool Shooting::is_quick() const {
  const cli::CommonOptions& common = session_.common();
  return !common.tolerance_given && !(common.time_limit_s > 0) && options_.check == 0 && !request_.transport &&
         (!request_.traces() || request_.smooths_paths);
}

void Shooting::tell_noise() {
  if (!frame_.noise) return;
  const render::Noise& noise = *frame_.noise;
  all_reached_ = all_reached_ && noise.reached;
  const bool by_time_alone = session_.common().time_limit_s > 0 && !session_.common().tolerance_given;
  const bool late = (!noise.reached || is_enlarged()) && !request_.quick && !by_time_alone;
  stopped_ |= late;
  Json& results = session_.results();
  results["noise_de00_p95"] = json_number(noise.de00_p95);
  results["noise_de00_mean"] = json_number(noise.de00_mean);
  results["noise_reached"] = all_reached_;
  results["samples_mean"] = noise.samples_mean;
  results["path_s"] = noise.time_s;
  results["bounces"] = options_.bounces;
  if (noise.places_gain > 1)
    session_.explain(fmt::format(
        "paths are also aimed at bright places of the surface, such as a wall beside a lamp: the mean square "
        "of what a direction brings to a matt surface is predicted to be {:.1f} times smaller\n",
        noise.places_gain));
  tell(late, fmt::format("noise: dE00 p95 {:.2f}, mean {:.2f} after {:.0f} samples a pixel in {:.1f} s{}",
                         noise.de00_p95, noise.de00_mean, noise.samples_mean, noise.time_s,
                         noise.reached ? ""
                                       : fmt::format(", stopped before it was within {}",
                                                     shortest(session_.common().tolerance))));
}

Result<cli::Verdict> Shooting::shoot(const std::optional<display::Display>& display) {
  if (stage_.transport) return shade_transport(display);
  if (request_.transport) GONIO_TRY(can_trace_view(stage_.scene));
  GONIO_ASSIGN(shots_, shots_of(options_, stage_.mesh, request_.size, stage_.scene.lights));
  leave_out_hidden_floor();
  request_.quick = is_quick();
  GONIO_ASSIGN(render::Renderer renderer, make_renderer(options_, request_, stage_, session_));
  GONIO_TRY(look(renderer));
  session_.explain(explanation(options_, stage_.mesh, stage_.dresses.front()));
  exposure_ = begin_sight(renderer, *looks_.front(), stage_, request_, session_);
  double frame_ms = 0;
  for (const Shot& shot : shots_) {
    GONIO_TRY(draw(renderer, shot, &shot == &shots_.front()));
    frame_ms += frame_.frame_ms / static_cast<double>(shots_.size());
    tell_noise();
    tell_maps();
    tell_rays();
    if (&shot == &shots_.front() && !exposure_.is_metered) exposure_.meter(white_by_gray(frame_), request_);
    if (stage_.scene.ground && shot.camera.eye.y <= stage_.scene.ground->height)
      session_.warn(fmt::format("the camera of {} is below the floor, which is black from there", shot.output));
    session_.progress(shot.output);
    GONIO_TRY(write(shot, display));
  }
  report_pictures(plan_, exposure_, shots_.size(), frame_.gbuffer_ms, frame_ms, session_);
  const std::string name = options_.output == "-" ? "standard output" : shots_.front().output;
  session_.say(fmt::format(
      "{}{}: {} x {}, {} samples a pixel, drawn in {:.0f} ms by {} (visible points {:.0f} ms), exposure {:+.2f}{}",
      name, shots_.size() > 1 ? fmt::format(" and {} more", shots_.size() - 1) : "", request_.size.width,
      request_.size.height, request_.samples, frame_ms, plan_.engine, frame_.gbuffer_ms, exposure_.stops,
      display ? ", " + display->name() : ""));
  cli::Verdict verdict = cli::Verdict::kDone;
  if (options_.check > 0) {
    GONIO_ASSIGN(verdict, check_picture());
  }
  // An engine that traces rays leaves nothing out.
  if (options_.check > 0 && !by_rays()) {
    GONIO_TRY(measure_plan(renderer, render::seen_scene(stage_.scene, looks_), plan_, view(shots_.back(), 1),
                           exposure_.white.luminance, session_));
  }
  return stopped_ ? cli::Verdict::kStopped : verdict;
}

Result<cli::Verdict> Shooting::check_picture() {
  const bool traced =
      frame_.rays.samples > 0 || plan_.effects.rays.any() || (stage_.rays && stage_.rays->absent.empty());
  const bool truth = options_.check_against == "truth" || (options_.check_against == "auto" && traced);
  session_.progress(fmt::format("checking {} pixels", options_.check));
  if (!truth || stage_.gbuffer) {
    // The model does not know the effects of rays.
    if (!frame_.open_centers.data.empty()) frame_.centers = frame_.open_centers;
    const render::PictureError error = render::picture_error(
        frame_, stage_.scene, stage_.source.image(), exposure_.white.luminance, options_.check, session_.common().seed);
    session_.results()["error"] = error_json(error, "model", stage_.source.name);
    session_.say(fmt::format("dE00 to the reference: mean {:.2f}, p95 {}, max {:.2f} at {},{} ({} pixels, {:.1f} s)",
                             error.de00_mean, told_p95(error), error.de00_max, error.worst_x, error.worst_y,
                             error.checked_pixels, error.time_s));
    return tell_verdict(error, session_.common().tolerance, session_);
  }
  render::TruthRequest request;
  request.environment = stage_.source.image();
  request.white_luminance =
      frame_.noise && frame_.noise->white_luminance > 0 ? frame_.noise->white_luminance : exposure_.white.luminance;
  request.count = options_.check;
  request.tolerance_de00 = session_.common().tolerance;
  request.bounces = options_.bounces;
  request.seed = session_.common().seed;
  request.whole = by_rays();
  GONIO_ASSIGN(const render::TruthError error,
               render::truth_error(frame_, over_floor(true), plan_.effects.rays, request));
  return tell_truth(error, stage_.source.name, session_.common().tolerance, session_);
}

}  // namespace

Result<cli::Verdict> run(const Options& asked, cli::Session& session) {
  GONIO_TRY(FileNames::check(asked.output, {"name", "code", "index"}, "--output"));
  GONIO_ASSIGN(const Options drawn, settled(asked));
  GONIO_ASSIGN(const Options options, is_stream(drawn) ? stream_options(drawn) : Result<Options>(drawn));
  GONIO_ASSIGN(Request request, request_of(options));
  std::optional<display::Display> display;
  if (request.png) {
    GONIO_ASSIGN(display::Display made, display::Display::make(options.view));
    display.emplace(std::move(made));
    session.results()["view"] = display->name();
  }
  for (const std::string& name : shot_names(options)) GONIO_TRY(can_be_written(name));
  Stage stage;
  GONIO_TRY(set_stage(options, request, stage, session));
  if (stage.gbuffer) {
    const int side = request.points_across();
    request.size = {stage.gbuffer->width / side, stage.gbuffer->height / side};
    if (stage.transport) request.samples_of_point = stage.transport->light.samples;
  }
  if (is_stream(options)) return draw_stream(options, request, stage, display, session);
  return Shooting(options, std::move(request), stage, session).shoot(display);
}

}  // namespace goniochrome::tool
