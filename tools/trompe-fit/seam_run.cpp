#include "tool.h"

#include <algorithm>
#include <cmath>

#include "answer.h"
#include "brdf/gloss.h"
#include "paint_stream.h"
#include "panels.h"
#include "panels/seam.h"
#include "picture.h"

namespace goniochrome::tool {

namespace {

constexpr std::size_t kMostFitted = 400;  // views that a fit looks at; all views judge it

std::vector<panels::PanelView> panel_views(const mesh::Seam& seam, const std::vector<panels::SeamView>& views) {
  std::vector<panels::PanelView> seen;
  for (const panels::SeamView& view : views) seen.push_back(panels::panel_view(seam, view));
  return seen;
}

std::vector<double> weights_of(const std::vector<panels::SeamView>& views) {
  std::vector<double> weights;
  for (const panels::SeamView& view : views) weights.push_back(view.weight);
  return weights;
}

class SeamRun {
 public:
  SeamRun(const Options& options, const TrompeSeamRequest& request, cli::Session& session)
      : options_(options), request_(request), session_(session) {}

  Result<cli::Verdict> operator()() {
    GONIO_TRY(prepare());
    const auto take_all = [&](const std::vector<paint::Paint>& batch, formats::PaintWriter& writer) -> Result<void> {
      for (const paint::Paint& paint : batch) GONIO_TRY(take(paint, writer));
      return {};
    };
    GONIO_TRY(stream_paints(options_.inputs, options_.only, options_.output, session_, take_all));
    session_.results().update(results_of(fits_));
    return negative_ ? cli::Verdict::kNegative : cli::Verdict::kDone;
  }

 private:
  Result<void> prepare() {
    GONIO_ASSIGN(stage_, panels::seam_stage(options_.seam, request_.world, request_.geometries, options_.seam_deg));
    tell_remarks(stage_.mesh, session_);
    traced_ = traced_seam(options_.seam, stage_, session_);
    for (const std::size_t i : panels::spread_places(stage_.views.size(), kMostFitted))
      fitted_.push_back(stage_.views[i]);
    std::vector<double> folds;
    for (const mesh::SeamPoint& p : stage_.seam.points) folds.push_back(p.fold_deg);
    std::ranges::sort(folds);
    session_.say(fmt::format("seam {} | {}: {:.2f} m, misalignment {:+.1f} to {:+.1f} deg (median {:+.1f})",
                             request_.world.part_a, request_.world.part_b, stage_.seam.length_m, folds.front(),
                             folds.back(), folds[folds.size() / 2]));
    session_.results()["misalignment_deg"] = {
        {"low", folds.front()}, {"median", folds[folds.size() / 2]}, {"high", folds.back()}};
    return {};
  }

  Result<Answer> answer_for(const paint::Paint& paint) {
    Answer answer;
    answer.name = paint.name + options_.suffix;
    GONIO_ASSIGN(const double coat, brdf::coat_index_of_paint(paint));
    answer.coat_index = coat;
    GONIO_ASSIGN(answer.a, panels::appearance_of(paint));
    const bool solid = paint.paint_class == paint::PaintClass::kSolid;
    if (options_.seam.environment.empty()) {
      GONIO_ASSIGN(answer.fit,
                   panels::trompe_fit(answer.a, solid, panels::under_coat(panel_views(stage_.seam, fitted_), coat),
                                      request_.fit));
      const std::vector<panels::PanelView> all = panels::under_coat(panel_views(stage_.seam, stage_.views), coat);
      answer.before = panels::trompe_errors(answer.a, answer.a, all);
      answer.after = panels::trompe_errors(answer.a, answer.fit.b, all);
      return answer;
    }
    GONIO_ASSIGN(const panels::EnvironmentPanels panels,
                 panels::EnvironmentPanels::make(stage_.env, paint::condition_of(paint), coat));
    GONIO_ASSIGN(const paint::LobeFit worn, panels.lobes(answer.a));
    const auto lights_of = [&](const std::vector<panels::SeamView>& views) {
      return panels::seam_lights(panels, traced_ ? &*traced_ : nullptr, worn, stage_.seam, views, request_.world.part_a,
                                 request_.world.part_b);
    };
    GONIO_ASSIGN(const panels::SeamLights some, lights_of(fitted_));
    GONIO_ASSIGN(const panels::SeamLights all, lights_of(stage_.views));
    tell_traced(all, stage_.views.size(), paint.name, session_);
    GONIO_ASSIGN(const std::vector<color::Lab> target, panels::seam_colors(panels, some.a)(answer.a));
    GONIO_ASSIGN(answer.fit, panels::trompe_fit(answer.a, solid, target, weights_of(fitted_),
                                                panels::seam_colors(panels, some.b), request_.fit));
    GONIO_ASSIGN(const std::vector<color::Lab> first, panels::seam_colors(panels, all.a)(answer.a));
    GONIO_ASSIGN(const std::vector<color::Lab> before, panels::seam_colors(panels, all.b)(answer.a));
    GONIO_ASSIGN(const std::vector<color::Lab> after, panels::seam_colors(panels, all.b)(answer.fit.b));
    answer.before = panels::trompe_errors(first, before, weights_of(stage_.views));
    answer.after = panels::trompe_errors(first, after, weights_of(stage_.views));
    return answer;
  }

  Result<void> take(const paint::Paint& paint, formats::PaintWriter& writer) {
    const Result<Answer> answer = answer_for(paint);
    if (!answer.ok()) {
      if (answer.error().kind == ErrorKind::kUsage) return answer.error();
      negative_ = true;
      session_.warn(fmt::format("left out: {}: {}", paint.name, answer.error().message));
      fits_.push_back({{"name", paint.name}, {"status", "failed"}, {"message", answer.error().message}});
      return {};
    }
    Json json = answer_json(*answer);
    json.erase("geometries");
    json["views"] = stage_.views.size();
    json["seam"] = places_json(*answer);
    fits_.push_back(std::move(json));
    const bool negative = !is_improved(*answer, request_.fit) || !answer->fit.converged;
    negative_ = negative_ || negative;
    negative ? session_.say_verdict(answer_line(*answer)) : session_.say(answer_line(*answer));
    GONIO_TRY(writer.write(painted(paint, *answer)));
    return options_.picture.empty() ? Result<void>() : draw(paint, *answer);
  }

  Json places_json(const Answer& answer) const {
    const auto before = panels::by_place(stage_.seam, stage_.views, answer.before.de),
               after = panels::by_place(stage_.seam, stage_.views, answer.after.de);
    Json places = Json::array();
    for (std::size_t i = 0; i < stage_.seam.points.size(); ++i)
      places.push_back({{"run", stage_.seam.points[i].run},
                        {"distance_m", stage_.seam.points[i].distance_m},
                        {"fold_deg", stage_.seam.points[i].fold_deg},
                        {"rms_before", json_number(before[i].rms)},
                        {"rms_after", json_number(after[i].rms)}});
    return places;
  }

  Result<void> draw(const paint::Paint& paint, const Answer& answer) {
    SeamPair pair;
    pair.mesh = &stage_.mesh, pair.seam = &stage_.seam;
    pair.env = options_.seam.environment.empty() ? nullptr : &stage_.env;
    pair.lights = request_.world.lights, pair.viewer = request_.world.viewers.front();
    pair.part_b = request_.world.part_b, pair.dark = options_.dark;
    pair.a = paint, pair.answer = answer;
    GONIO_ASSIGN(const image::Image image, seam_pair(pair));
    return pictures_.write(paint, image, session_);
  }

  const Options& options_;
  const TrompeSeamRequest& request_;
  cli::Session& session_;
  panels::SeamStage stage_;
  std::optional<panels::TracedSeam> traced_;  // in an environment with a mirror part
  std::vector<panels::SeamView> fitted_;
  std::vector<Json> fits_;
  PaintPictures pictures_{options_.picture, "--picture shows"};
  bool negative_ = false;
};

std::string plan(const Options& options, const TrompeSeamRequest& request) {
  return fmt::format(
      "seam of {} and {} in {}; paint B goes to {}\n{}"
      "minimized: {} of dE76 over at most {} views spread along the seam, by {}; judged by all\n",
      request.world.part_a, request.world.part_b, options.seam.mesh, request.world.part_b,
      panels::seam_light_text(options.seam, request.world, request.geometries), options.objective, kMostFitted,
      options.vary);
}

}  // namespace

Result<cli::Verdict> run_on_seam(const Options& options, cli::Session& session) {
  GONIO_ASSIGN(const TrompeSeamRequest request, seam_request_of(options));
  session.explain(plan(options, request));
  return SeamRun(options, request, session)();
}

}  // namespace goniochrome::tool
