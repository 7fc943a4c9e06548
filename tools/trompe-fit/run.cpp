#include "tool.h"

#include <algorithm>
#include <cmath>

#include "answer.h"
#include "base/parallel.h"
#include "base/text.h"
#include "brdf/gloss.h"
#include "paint_stream.h"
#include "panels.h"
#include "picture.h"

namespace goniochrome::tool {

namespace {

constexpr int kNamesShown = 20;

using Answers = std::vector<Answer>;

std::vector<panels::PanelView> views_of(const std::vector<const TrompeGeometry*>& geometries, double coat_index) {
  std::vector<panels::PanelView> views;
  for (const TrompeGeometry* geometry : geometries) views.push_back(geometry->view.under_coat(coat_index));
  return views;
}

Result<Answer> answer(const paint::Paint& paint, const paint::Appearance& a,
                      const std::vector<const TrompeGeometry*>& fitted, std::vector<const TrompeGeometry*> judged,
                      const TrompeRequest& request) {
  Answer result;
  result.a = a;
  GONIO_ASSIGN(result.coat_index, brdf::coat_index_of_paint(paint));
  GONIO_ASSIGN(result.fit, panels::trompe_fit(a, paint.paint_class == paint::PaintClass::kSolid,
                                              views_of(fitted, result.coat_index), request.fit));
  const std::vector<panels::PanelView> views = views_of(judged, result.coat_index);
  result.before = panels::trompe_errors(a, a, views);
  result.after = panels::trompe_errors(a, result.fit.b, views);
  result.judged = std::move(judged);
  return result;
}

// The paints for the second panel, by the mode asked.
Result<Answers> answers_for(const paint::Paint& paint, const TrompeRequest& request, const std::string& suffix) {
  GONIO_ASSIGN(const paint::Appearance a, panels::appearance_of(paint));
  Answers answers;
  std::vector<const TrompeGeometry*> all;
  for (const TrompeGeometry& geometry : request.geometries) all.push_back(&geometry);
  if (request.mode != TrompeMode::kRows) {
    GONIO_ASSIGN(Answer one, answer(paint, a, request.single ? std::vector{&*request.single} : all, all, request));
    one.name = paint.name + suffix;
    answers.push_back(std::move(one));
    return answers;
  }
  std::vector<double> lights;
  for (const TrompeGeometry& g : request.geometries)
    if (std::ranges::find(lights, g.geometry.light_deg) == lights.end()) lights.push_back(g.geometry.light_deg);
  for (const double light : lights) {
    std::vector<const TrompeGeometry*> row;
    std::ranges::copy_if(all, std::back_inserter(row),
                         [&](const TrompeGeometry* g) { return g->geometry.light_deg == light; });
    GONIO_ASSIGN(Answer one, answer(paint, a, row, row, request));
    one.name = fmt::format("{}{}.light{}", paint.name, suffix, shortest(light));
    one.light_deg = light;
    answers.push_back(std::move(one));
  }
  return answers;
}

std::string plan(const Options& options, const TrompeRequest& request) {
  std::string text = fmt::format(
      "{} pairs of light and viewer; left out: {} within {} deg of the mirror direction, {} below the horizon, {} that "
      "do not see the second panel\n"
      "minimized: {} of dE76 over {}, by {}, from several starts; some milliseconds a paint\n",
      request.geometries.size(), request.in_glare.size(), panels::kIndexGlare_deg, request.below_horizon,
      request.hidden, options.objective,
      request.mode == TrompeMode::kAll      ? "all of them"
      : request.mode == TrompeMode::kSingle ? "the one geometry of --at; the others only judge"
                                            : "those of each light, one paint for each",
      options.vary);
  return text + fmt::format("in the plane of incidence the second panel's aspecular angles are {} deg {}\n",
                            shortest(2 * std::abs(request.angle_deg)), request.angle_deg > 0 ? "smaller" : "larger");
}

class Run {
 public:
  Run(const Options& options, const TrompeRequest& request, cli::Session& session)
      : options_(options), request_(request), session_(session) {}

  Result<cli::Verdict> operator()() {
    GONIO_TRY(stream_paints(
        options_.inputs, options_.only, options_.output, session_,
        [&](const std::vector<paint::Paint>& batch, formats::PaintWriter& writer) { return take(batch, writer); }));
    return finish();
  }

 private:
  Result<void> take(const std::vector<paint::Paint>& batch, formats::PaintWriter& writer) {
    std::vector<std::optional<Result<Answers>>> found(batch.size());
    parallel_for(batch.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) found[i] = answers_for(batch[i], request_, options_.suffix);
    });
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Result<Answers>& answers = *found[i];
      if (!answers.ok()) {
        if (answers.error().kind == ErrorKind::kUsage) return answers.error();
        negative_ = true;
        session_.warn(fmt::format("left out: {}", answers.error().message));
        fits_.push_back({{"name", batch[i].name}, {"status", "failed"}, {"message", answers.error().message}});
        continue;
      }
      for (const Answer& answer : *answers) {
        note(answer);
        GONIO_TRY(writer.write(painted(batch[i], answer)));
      }
      if (!options_.picture.empty()) GONIO_TRY(draw(batch[i], *answers));
    }
    return {};
  }

  Result<void> draw(const paint::Paint& paint, const Answers& answers) {
    GONIO_ASSIGN(const image::Image image, swatches(paint::condition_of(paint), answers));
    return pictures_.write(paint, image, session_);
  }

  void note(const Answer& answer) {
    fits_.push_back(answer_json(answer));
    const bool negative = !is_improved(answer, request_.fit) || !answer.fit.converged;
    negative_ = negative_ || negative;
    if (!answer.fit.converged)
      session_.warn(fmt::format("{}: not converged: the best paint found is written", answer.name));
    if (++told_ <= kNamesShown)
      negative ? session_.say_verdict(answer_line(answer)) : session_.say(answer_line(answer));
    if (request_.single)
      session_.say(
          fmt::format("  at light {}, view {}: {:.2f} to {:.2f}; one geometry can always be met, the others pay",
                      shortest(request_.single->geometry.light_deg), shortest(request_.single->geometry.view_deg),
                      answer.fit.before.max, answer.fit.after.max));
  }

  cli::Verdict finish() {
    if (told_ > kNamesShown) session_.say(fmt::format("... and {} more", told_ - kNamesShown));
    session_.results().update(results_of(fits_));
    if (fits_.empty()) session_.warn("the input holds no paints: nothing was fitted");
    return negative_ || fits_.empty() ? cli::Verdict::kNegative : cli::Verdict::kDone;
  }

  const Options& options_;
  const TrompeRequest& request_;
  cli::Session& session_;
  std::vector<Json> fits_;
  int told_ = 0;
  PaintPictures pictures_{options_.picture, "--picture shows"};
  bool negative_ = false;
};

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  if (!options.seam.mesh.empty()) return run_on_seam(options, session);
  GONIO_ASSIGN(const TrompeRequest request, request_of(options));
  session.explain(plan(options, request));
  tell_left_out(request.in_glare, request.below_horizon, session);
  if (request.hidden > 0)
    session.say(fmt::format("left out: {} pairs whose viewer does not see the second panel", request.hidden));
  return Run(options, request, session)();
}

}  // namespace goniochrome::tool
