#include "stream.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/file_names.h"
#include "base/parallel.h"
#include "base/pipeline.h"
#include "base/text.h"
#include "render/engine.h"
#include "render/plan.h"
#include "stream_sink.h"

namespace goniochrome::tool {

namespace {

constexpr int kWarningsShown = 10;

// How long pictures took, in steps of 0.1 ms up to 10 s, which takes constant memory.
class Times {
 public:
  void add(double ms) {
    ++steps_[static_cast<std::size_t>(std::clamp(10 * ms, 0.0, kSteps - 1.0))];
    ++count_, most_ms_ = std::max(most_ms_, ms);
  }
  // The time that this share of the pictures does not exceed.
  double quantile_ms(double share) const {
    double below = 0;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      below += steps_[i];
      if (below >= share * static_cast<double>(count_)) return 0.1 * static_cast<double>(i + 1);
    }
    return most_ms_;
  }
  double most_ms() const { return most_ms_; }

 private:
  static constexpr double kSteps = 1e5;
  std::vector<std::uint32_t> steps_ = std::vector<std::uint32_t>(static_cast<std::size_t>(kSteps), 0);
  std::size_t count_ = 0;
  double most_ms_ = 0;
};

class Streaming {
 public:
  Streaming(const Options& options, PaintSource source, PaintViews& views, StreamSink& sink, cli::Session& session)
      : options_(options), source_(std::move(source)), views_(views), sink_(sink), session_(session) {
    session_.begin_list("pictures");
  }

  // Draws all paints. Error: what ends the stream.
  Result<void> draw_all() {
    const int workers = threads() > 1 ? threads() : 0;
    // One slot each for the paint that is fetched, the one that is shaded, and those that are finished or wait.
    std::vector<StreamSlot> slots(static_cast<std::size_t>(workers > 0 ? workers + 3 : 1));
    run_stages(slots, workers, stages());
    if (stopped_) return *stopped_;
    if (done_ == 0) return first_failure_ ? *first_failure_ : input_error("{}: there is no paint in it", source_name());
    return sink_.end();
  }

  std::size_t done() const { return done_; }
  std::size_t failed() const { return failed_; }
  std::size_t far_off() const { return far_off_; }
  const Times& times() const { return times_; }
  std::vector<std::string> remarks() const { return source_.remarks(); }
  double shading_ms() const { return done_ > 0 ? shading_ms_ / static_cast<double>(done_) : 0; }

 private:
  Stages<StreamSlot> stages() {
    Stages<StreamSlot> stages;
    stages.fetch = [this](StreamSlot& slot) {
      if (!source_.next(sink_.looks_ahead(), slot.source)) return false;
      slot.clock = Stopwatch();
      return true;
    };
    stages.work = [this](StreamSlot& slot) { return go_on(draw(slot)); };
    stages.finish = [this](StreamSlot& slot) {
      slot.stopped.reset();
      if (slot.source.failure) return;
      const Result<void> finished = sink_.finish(slot);
      if (!finished.ok()) slot.stopped = finished.error();
    };
    stages.settle = [this](StreamSlot& slot) {
      if (slot.stopped) return go_on(*slot.stopped);
      const Result<void> settled = sink_.settle(slot);
      if (!settled.ok()) return go_on(settled);
      slot.source.failure ? tell_failure(slot) : tell_picture(slot);
      return true;
    };
    return stages;
  }

  bool go_on(const Result<void>& result) {
    if (!result.ok() && !stopped_) stopped_ = result.error();
    return result.ok();
  }

  Result<void> draw(StreamSlot& slot) {
    if (!slot.source.failure) {
      const Result<void> drawn = views_.draw(slot.source, slot.view);
      if (!drawn.ok()) slot.source.failure = about_paint(drawn.error(), slot.source.paint.name);
      slot.plan = views_.plan;
    }
    return sink_.place(slot);
  }

  void tell_failure(const StreamSlot& slot) {
    const Error& failure = *slot.source.failure;
    if (!first_failure_) first_failure_ = failure;
    if (++failed_ <= kWarningsShown) session_.warn(fmt::format("no picture: {}", failure.message));
    session_.add("pictures", [&] {
      return Json{{"name", slot.source.paint.name}, {"status", "failed"}, {"message", failure.message}};
    });
  }

  void tell_picture(const StreamSlot& slot) {
    ++done_;
    const double ms = 1000 * slot.clock.elapsed_s();
    times_.add(ms), shading_ms_ += slot.view.shading_ms;
    far_off_ += slot.view.bounced_de00_p95 > session_.common().tolerance ? 1 : 0;
    session_.add("pictures", [&] {
      Json picture = {{"name", slot.source.paint.name}, {"status", "done"}, {"time_ms", ms}};
      if (!slot.file.empty()) picture["file"] = slot.file;
      if (!options_.sheet.empty()) picture["sheet"] = slot.place.sheet + 1, picture["cell"] = slot.place.cell + 1;
      if (views_.plan->engine == "transport") picture["bounced_de00_p95"] = json_number(slot.view.bounced_de00_p95);
      return picture;
    });
    session_.progress(fmt::format("{}: {} pictures", session_.tool(), done_));
  }

  std::string source_name() const { return options_.paint == "-" ? "standard input" : options_.paint; }

  const Options& options_;
  PaintSource source_;
  PaintViews& views_;
  StreamSink& sink_;
  cli::Session& session_;
  Times times_;
  double shading_ms_ = 0;
  std::size_t done_ = 0, failed_ = 0, far_off_ = 0;
  std::optional<Error> first_failure_, stopped_;
};

void report(const Options& options, const Request& request, const Streaming& streaming, const PaintViews& views,
            const StreamSink& sink, double seconds, const std::optional<display::Display>& display,
            cli::Session& session) {
  const auto count = static_cast<double>(streaming.done());
  const double rate = seconds > 0 ? count / seconds : 0;
  Json& results = session.results();
  report_pictures(*views.plan, views.exposure, streaming.done(), views.gbuffer_ms, streaming.shading_ms(), session);
  results["failed"] = streaming.failed(), results["files"] = sink.files();
  results["pictures_per_s"] = rate;
  results["picture_ms"] = {{"p50", streaming.times().quantile_ms(0.5)},
                           {"p99", streaming.times().quantile_ms(0.99)},
                           {"max", streaming.times().most_ms()}};
  std::string line =
      fmt::format("{}: {} pictures", options.output == "-" ? "standard output" : options.output, streaming.done());
  if (!options.sheet.empty())
    line += fmt::format(" on {} sheet{} of {}", sink.files(), sink.files() == 1 ? "" : "s", options.sheet);
  line += fmt::format(", {} x {}, shaded in {:.1f} ms each by {}, {:.0f} pictures/s, exposure {:+.2f}{}",
                      request.size.width, request.size.height, streaming.shading_ms(), views.plan->engine, rate,
                      views.exposure.stops, display ? ", " + display->name() : "");
  if (streaming.failed() > 0)
    line += fmt::format(", {} paint{} failed", streaming.failed(), streaming.failed() == 1 ? "" : "s");
  session.say(line);
}

}  // namespace

bool is_stream(const Options& options) {
  const bool moves = options.turntable > 0 || options.light_sweep > 0;
  return FileNames::is_pattern(options.output) || !options.sheet.empty() || (!options.to.empty() && !moves);
}

Result<Options> stream_options(const Options& options) {
  const std::pair<const char*, bool> given[] = {
      {"split", !options.split.empty()},        {"turntable", options.turntable > 0},
      {"light-sweep", options.light_sweep > 0}, {"check", options.check > 0},
      {"aov", !options.aovs.empty()},           {"print-shader", options.print_shader},
      {"emit", !options.emissions.empty()},     {"spectral", options.needs_bands()}};
  for (const auto& [name, is_given] : given)
    if (is_given)
      return usage_error("--{} is for pictures of one paint: leave it out, or choose a paint by FILE#NAME", name);
  if (options.paint.empty()) return usage_error("there are no paints: give --paint a library, or - for a stream");
  if (!options.sheet.empty() && !lower(options.output).ends_with(".png"))
    return usage_error("--output is \"{}\": a sheet is a PNG", options.output);
  if (!options.sheet.empty() && !options.to.empty()) return usage_error("--sheet and --to exclude each other");
  Options adjusted = options;
  adjusted.spectral = "off";
  adjusted.rays_are_refused = options.effects.leave_out_rays();
  if (options.effects.start == render::Start::kAuto) {
    render::EffectWords& words = adjusted.effects = stream_effects();
    if (options.effects.forced != words.forced)
      words.forced.insert(words.forced.end(), options.effects.forced.begin(), options.effects.forced.end());
  }
  const auto engine =
      options.engine == "auto" ? Result<const render::EngineInfo*>(nullptr) : render::engine_named(options.engine);
  const bool by_rays = engine.ok() && *engine != nullptr && (*engine)->traces_rays;
  if (options.gbuffer.empty() && (by_rays || !adjusted.effects.leave_out_rays()))
    return usage_error(
        "rays are not traced for each paint of a stream: trace the light once, by --aov transport -o view.exr, and "
        "give "
        "--gbuffer view.exr");
  return adjusted;
}

Result<cli::Verdict> draw_stream(const Options& options, const Request& request, Stage& stage,
                                 const std::optional<display::Display>& display, cli::Session& session) {
  if (!options.mesh.empty() && !options.rays_are_refused)
    session.say(
        "a stream is drawn without shadows and without reflections of the mesh in itself: to have them, trace the "
        "light "
        "once, by --aov transport -o view.exr, and give --gbuffer view.exr");
  GONIO_ASSIGN(PaintSource source, PaintSource::open(options));
  GONIO_ASSIGN(std::unique_ptr<PaintViews> views, paint_views(options, request, stage, session));
  GONIO_ASSIGN(std::unique_ptr<StreamSink> sink,
               stream_sink({options, request, stage, display ? &*display : nullptr, *views, session}));
  const Stopwatch clock;
  Streaming streaming(options, std::move(source), *views, *sink, session);
  GONIO_TRY(streaming.draw_all());
  for (const std::string& remark : streaming.remarks()) session.warn(remark);
  report(options, request, streaming, *views, *sink, clock.elapsed_s(), display, session);
  if (streaming.failed() > kWarningsShown)
    session.warn(fmt::format("{} more paints have no picture", streaming.failed() - kWarningsShown));
  if (streaming.far_off() > 0)
    session.warn(fmt::format(
        "bounced light was traced in other paints; scaled to {} of these {} it is off by more than --tolerance "
        "{}: trace again with --aov transport in such a paint",
        streaming.far_off(), streaming.done(), session.common().tolerance));
  return streaming.failed() > 0 || streaming.far_off() > 0 ? cli::Verdict::kNegative : cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
