#include "tool.h"

#include <optional>

#include "base/clock.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "chart.h"
#include "formats/imported.h"
#include "formulas.h"
#include "illuminants.h"
#include "judgement.h"
#include "paint_sink.h"
#include "quality/limit_maker.h"

namespace goniochrome::tool {

namespace {

constexpr std::size_t kFailuresShown = 10;  // samples
constexpr std::size_t kWordsShown = 4;      // failures of one sample; the output has all

// One run, which turns a stream of samples into judgements.
class Run {
 public:
  Run(const Options& options, cli::Session& session, const Standards& standards, const quality::CompareOptions& compare)
      : options_(options), session_(session), standards_(standards), compare_(compare) {}

  Result<cli::Verdict> operator()() {
    GONIO_ASSIGN(formats::PaintBatches batches, formats::PaintBatches::open(options_.inputs));
    GONIO_ASSIGN(PaintSink sink,
                 PaintSink::begin(options_.format, options_.output, table_head(compare_), batches, session_));
    sink_.emplace(std::move(sink));
    session_.begin_list("judgements");
    GONIO_TRY(for_each_batch(
        batches, session_, [&](const std::vector<paint::Paint>& batch) { return take(batch); }, left_out()));
    GONIO_TRY(sink_->finish());
    for (const std::string& remark : remarks_.lines()) session_.warn(remark);
    GONIO_TRY(write_limits());
    if (!options_.chart.empty()) GONIO_TRY(write_charts(options_, charted_, families_, compare_, session_));
    return finish();
  }

 private:
  struct Made {
    Judgement judgement;
    std::string text;
  };

  std::function<void(const Error&)> left_out() {
    if (!options_.keep_going) return {};
    return [this](const Error& error) { leave_out(error.message); };
  }

  void leave_out(const std::string& message) {
    session_.warn(message + ": left out");
    ++left_out_;
  }

  Result<Made> made(const paint::Paint& sample) const {
    GONIO_ASSIGN(const Standard* standard, standards_.of(sample));
    GONIO_ASSIGN(const quality::Subject subject, quality::subject_of(sample));
    Made result{{standard, {}, {}}, ""};
    GONIO_ASSIGN(result.judgement.comparison, quality::compare(standard->subject, subject, compare_));
    result.judgement.judged = quality::judged(result.judgement.comparison, compare_, standard->limits);
    result.text = text_of(result.judgement, compare_, sink_->format());
    return Result(std::move(result));
  }

  Result<void> take(const std::vector<paint::Paint>& batch) {
    const Stopwatch comparing;
    std::vector<std::optional<Result<Made>>> all(batch.size());
    parallel_for(batch.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) all[i] = made(batch[i]);
    });
    comparing_s_ += comparing.elapsed_s();
    for (std::size_t i = 0; i < batch.size(); ++i) {
      if (all[i]->ok()) {
        GONIO_TRY(note(std::move(**all[i]), batch[i]));
        continue;
      }
      const Error& error = all[i]->error();
      const std::string message = fmt::format("paint \"{}\": {}", batch[i].name, error.message);
      if (!options_.keep_going) return Error{error.kind, message};
      leave_out(message);
    }
    return sink_->flush();
  }

  Result<void> note(Made made, const paint::Paint& sample) {
    Judgement& judgement = made.judgement;
    ++compared_;
    count_.add(judgement);
    for (const std::string& remark : judgement.comparison.remarks) remarks_.note(remark, sample.name);
    if (!judgement.judged.excesses.empty() && count_.negative() <= kFailuresShown)
      session_.say_verdict(fmt::format("{}: \"{}\" {} against \"{}\": {}", session_.tool(), sample.name,
                                       judgement.verdict() == "fail" ? "fails" : "is incomplete",
                                       judgement.comparison.standard, joined(judgement.words(kWordsShown), "; ")));
    if (!options_.make_limits.empty()) maker_.add(judgement.comparison, compare_);
    session_.add("judgements", [&] { return judgement_json(judgement, compare_); });
    GONIO_TRY(sink_->format() == Format::kPaints ? sink_->write(with_verdict(sample, judgement))
                                                 : sink_->write(made.text));
    if (!options_.chart.empty()) charted_.push_back({std::move(judgement), sample});
    return {};
  }

  // The limits of --make-limits, and the standards with them where paint XML is wanted; paints of --show-limit.
  Result<void> write_limits() {
    if (!options_.make_limits.empty()) {
      GONIO_ASSIGN(const std::vector<quality::Limit> limits,
                   options_.share > 0 ? maker_.by_share(options_.share) : maker_.by_spread(options_.spread));
      if (const std::vector<std::string> dropped = maker_.dropped(); !dropped.empty())
        session_.warn(fmt::format(
            "{}: no limits for {}, which a sample or its standard lacks: measure it, or leave that sample out",
            options_.make_limits, joined(dropped, ", ")));
      if (options_.make_limits.ends_with(".xml")) {
        std::vector<paint::Paint> paints;
        for (const Standard& standard : standards_.all())
          paints.push_back(quality::with_limits(standard.subject.paint, limits));
        GONIO_TRY(write_paints(options_.make_limits, paints, session_));
      } else {
        GONIO_TRY(write_file(options_.make_limits, quality::limits_table(limits)));
      }
    }
    if (options_.show_limit.empty()) return {};
    std::vector<paint::Paint> paints;
    for (const Standard& standard : standards_.all()) {
      GONIO_ASSIGN(auto family, quality::just_passing(standard.subject.paint, compare_, standard.limits));
      std::ranges::copy(family, std::back_inserter(paints));
      if (!options_.chart.empty()) families_.push_back(std::move(family));
    }
    return write_paints(options_.show_limit, paints, session_);
  }

  cli::Verdict finish() {
    Json& results = session_.results();
    results["standards"] = standards_.all().size();
    results["compared"] = compared_;
    results["passed"] = count_.passed;
    results["failed"] = count_.failed;
    results["incomplete"] = count_.incomplete;
    results["not_judged"] = count_.without;
    results["left_out"] = left_out_;
    results["pairs_per_s"] = json_number(comparing_s_ > 0 ? static_cast<double>(compared_) / comparing_s_ : 0);
    if (count_.negative() > kFailuresShown)
      session_.say_verdict(
          fmt::format("{}: {} more samples do not pass", session_.tool(), count_.negative() - kFailuresShown));
    if (compared_ + left_out_ == 0) session_.warn("the input holds no paints: nothing was compared");
    std::string line = fmt::format("{}: {} compared with {} standard{}", session_.tool(), compared_,
                                   standards_.all().size(), standards_.all().size() == 1 ? "" : "s");
    line += standards_.has_limits() ? ", " + count_.words() : ", not judged: there are no limits";
    if (left_out_ > 0) line += fmt::format(", {} left out", left_out_);
    const bool negative = compared_ == 0 || count_.negative() + left_out_ > 0;
    session_.say(line);
    return negative ? cli::Verdict::kNegative : cli::Verdict::kDone;
  }

  const Options& options_;
  cli::Session& session_;
  const Standards& standards_;
  const quality::CompareOptions& compare_;
  std::optional<PaintSink> sink_;
  quality::LimitMaker maker_;
  formats::Remarks remarks_;
  std::vector<ChartedSample> charted_;
  std::vector<LimitFamily> families_;  // of --show-limit, for the page
  VerdictCount count_;
  std::size_t compared_ = 0, left_out_ = 0;
  double comparing_s_ = 0;
};

Result<quality::CompareOptions> compare_options(const Options& options, const Standards& standards) {
  quality::CompareOptions compare;
  GONIO_ASSIGN(compare.formulas, formulas_of(options.formulas));
  GONIO_ASSIGN(compare.illuminants, illuminants_of(options.illuminants));
  for (const Standard& standard : standards.all()) GONIO_TRY(quality::add_needed(standard.limits, compare));
  if (compare.formulas.empty()) compare.formulas.push_back(paint::kInOtherLight);
  for (const std::string& name : compare.illuminants) {
    const auto known = paint::lab_of({{}, 400, 300, {1, 1}}, {name, 10});
    if (!known.ok()) return input_error("limits: metamerism_{}: {}", name, known.error().message);
  }
  return Result(std::move(compare));
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  if (options.share > 0 && options.make_limits.empty())
    return usage_error("--share says how --make-limits makes limits: give --make-limits FILE");
  GONIO_ASSIGN(const Standards standards, Standards::open(options, session));
  GONIO_ASSIGN(const quality::CompareOptions compare, compare_options(options, standards));
  if (!options.show_limit.empty() && !standards.has_limits())
    return usage_error("--show-limit draws the limits: give them by --limits, or standards that carry them");
  return Run(options, session, standards, compare)();
}

}  // namespace goniochrome::tool
