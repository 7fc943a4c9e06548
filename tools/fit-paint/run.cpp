#include "run.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/clock.h"
#include "fit/paint_fit.h"
#include "paint/name_ledger.h"
#include "paint/xml.h"

namespace goniochrome {

namespace {

// Paints are fitted in batches that grow, so that the first ones of a slow pipe come through at once.
constexpr std::size_t kLargestBatch = 256;
constexpr int kWarningsShown = 10;

FitOptions fit_options(const Options& options) {
  FitOptions fit;
  fit.method = options.method == "l2"       ? FitMethod::kL2
               : options.method == "deltae" ? FitMethod::kDeltaE
                                            : FitMethod::kL1;
  fit.target = options.target == "curve" ? TargetCurve::Kind::kCurve : TargetCurve::Kind::kMeasured;
  fit.perceptual_weights = options.weights == "perceptual";
  if (options.gloss > 0) fit.assumed_gloss_60_gu = options.gloss;
  return fit;
}

// What is done, left out, and what it costs.
std::string plan(const Options& options, const Basis& basis) {
  std::string seen, unseen;
  for (const double e : basis.exponents)
    (cos_power(15 * M_PI / 180, e) >= kSeenPart ? seen : unseen) += fmt::format(" {}", e);
  return fmt::format(
      "basis {}: {} lobes{}\n"
      "  flake lobes at a first reading of 15 deg:{}\n"
      "  gloss alone, no reading sees them:{}\n"
      "target {}: {}\n"
      "method {}: {}\n"
      "gloss: {}\n"
      "left out: readings within {} deg of specular; the colors of the working space below 0 (told as gamut_de00)\n",
      basis.name, basis.exponents.size(), basis.mirror ? " and the mirror" : "", seen.empty() ? " none" : seen,
      unseen.empty() ? " none" : unseen, options.target,
      options.target == "curve" ? "quadratic of face, flop and travel; misses 5-angle readings by some dE00"
                                : "the readings, a monotone cubic between them at 3 % of their weight",
      options.method,
      options.method == "l2"       ? "least squares; about 15 us a paint, 7-12 % worse in absolute error"
      : options.method == "deltae" ? "least color difference at the readings, started from l1 and l2; some ms a paint"
                                   : "least absolute error; about 20 us a paint, leaves an outlier aside",
      options.gloss > 0 ? fmt::format("as stated, else {} GU at 60 deg", options.gloss) : "as stated, else matt",
      kGlareAngle_deg);
}

Json report_of(const Paint& paint, const PaintFit& fit) {
  const PaintFitReport& r = fit.report;
  Json by_geometry = Json::object(), gloss = Json::array();
  for (const GeometryError& g : r.de00_by_geometry) {
    // Two readings of one geometry: the worse one counts.
    const double before = by_geometry.value(g.geometry, 0.0);
    by_geometry[g.geometry] = json_number(std::max(before, g.de00));
  }
  for (const GlossMisfit& g : r.gloss)
    gloss.push_back({{"angle_deg", g.angle_deg}, {"stated_gu", g.stated_gu}, {"misfit_gu", json_number(g.misfit_gu)}});
  return {{"name", paint.name},
          {"method", fit.lobes.method},
          {"status", r.status},
          {"time_us", r.time_us},
          {"objective", json_number(r.objective)},
          {"plain_objective", json_number(r.plain_objective)},
          {"optimality_gap", json_number(r.optimality_gap)},
          {"active_lobes", r.active_lobes},
          {"unseen_exponents", r.unseen},
          {"de00_max", json_number(r.de00_max)},
          {"de00_mean", json_number(r.de00_mean)},
          {"de00_by_geometry", by_geometry},
          {"gamut_de00", json_number(r.gamut_de00)},
          {"glare_rows", r.glare_rows},
          {"gloss", gloss}};
}

// The figures of a run, gathered paint by paint.
class Tally {
 public:
  Tally(const Options& options, cli::Session& session) : options_(options), session_(session) {
    if (!options.common.report.empty()) session.results()["paints"] = Json::array();
  }

  void add(const Paint& paint, const PaintFit& fit) {
    ++fitted_;
    not_converged_ += fit.report.status != "optimal";
    sum_mean_ += fit.report.de00_mean;
    if (fitted_ == 1 || fit.report.de00_max > worst_de00_) {
      worst_de00_ = fit.report.de00_max;
      const auto worst = std::ranges::max_element(fit.report.de00_by_geometry, {}, &GeometryError::de00);
      worst_ = fmt::format("{} at {}", paint.name, worst->geometry);
    }
    if (!options_.common.report.empty()) session_.results()["paints"].push_back(report_of(paint, fit));
  }

  void add_failure(const Paint& paint, const std::string& where, const std::string& message) {
    if (++failed_ <= kWarningsShown)
      session_.warn(fmt::format("{}: paint \"{}\" is passed on unfitted: {}", where, paint.name, message));
    if (!options_.common.report.empty())
      session_.results()["paints"].push_back(
          {{"name", paint.name}, {"method", options_.method}, {"status", "failed"}, {"message", message}});
  }

  void add_time(double seconds) { fit_s_ += seconds; }
  std::size_t done() const { return fitted_ + failed_; }

  cli::Verdict finish() {
    if (failed_ > kWarningsShown) session_.warn(fmt::format("{} more paints unfitted", failed_ - kWarningsShown));
    const double rate = fit_s_ > 0 ? static_cast<double>(done()) / fit_s_ : 0;
    session_.results()["fits_per_s"] = rate;
    session_.results()["fitted"] = fitted_;
    session_.results()["failed"] = failed_;
    std::string line = fmt::format("{}: {} paints by {}", session_.tool(), fitted_, options_.method);
    if (fitted_ > 0)
      line += fmt::format(", dE00 mean {:.2f}, worst {:.2f} ({})", sum_mean_ / static_cast<double>(fitted_),
                          worst_de00_, worst_);
    if (not_converged_ > 0) line += fmt::format(", {} not converged", not_converged_);
    if (failed_ > 0) line += fmt::format(", {} unfitted", failed_);
    session_.say(line + fmt::format("; {:.0f} fits/s", rate));
    return failed_ > 0 || not_converged_ > 0 ? cli::Verdict::kNegative : cli::Verdict::kDone;
  }

 private:
  const Options& options_;
  cli::Session& session_;
  std::size_t fitted_ = 0, failed_ = 0, not_converged_ = 0;
  double sum_mean_ = 0, worst_de00_ = 0, fit_s_ = 0;
  std::string worst_;
};

struct Input {
  std::string path;
  PaintReader reader;
};

Result<std::vector<Input>> open_all(std::vector<std::string> paths) {
  if (paths.empty()) paths = {"-"};
  std::vector<Input> inputs;
  for (const std::string& path : paths) {
    GONIO_ASSIGN(PaintReader reader, PaintReader::open(path));
    reader.read_prolog();
    inputs.push_back({path == "-" ? "standard input" : path, std::move(reader)});
  }
  return inputs;
}

// Names must stay unique in the output. A reader sees to that within one file; this does between files.
class NamesOfAll {
 public:
  explicit NamesOfAll(const std::vector<Input>& inputs) : inputs_(inputs) {}
  Result<void> note(const Paint& paint, std::size_t input, int line) {
    if (inputs_.size() == 1) return {};
    const auto before = ledger_.note(paint.name, static_cast<int>(input) + 1);
    if (!before) return {};
    return input_error("{}:{}: paint \"{}\" is already in {}: rename one of them", inputs_[input].path, line,
                       paint.name, inputs_[*before - 1].path);
  }

 private:
  const std::vector<Input>& inputs_;
  NameLedger ledger_;
};

// Fits one batch and writes it on.
Result<void> finish_batch(const PaintFitter& fitter, std::vector<Paint>& batch, const std::vector<int>& lines,
                          const std::string& path, PaintWriter& writer, Tally& tally) {
  const Stopwatch clock;
  std::vector<Result<PaintFit>> results = fits(fitter, batch);
  tally.add_time(clock.elapsed_s());
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (results[i].ok()) {
      tally.add(batch[i], *results[i]);
      batch[i].lobes = std::move(results[i]->lobes);
    } else {
      tally.add_failure(batch[i], fmt::format("{}:{}", path, lines[i]), results[i].error().message);
    }
    GONIO_TRY(writer.write(batch[i]));
  }
  return {};
}

Result<void> fit_all(const PaintFitter& fitter, std::vector<Input>& inputs, PaintWriter& writer, Tally& tally,
                     const cli::Session& session) {
  NamesOfAll names(inputs);
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    std::vector<Paint> batch;
    std::vector<int> lines;
    bool more = true;
    for (std::size_t size = 1; more; size = std::min(2 * size, kLargestBatch)) {
      batch.clear(), lines.clear();
      while (more && batch.size() < size) {
        GONIO_ASSIGN(std::optional<Paint> paint, inputs[k].reader.next());
        more = paint.has_value();
        if (!more) break;
        lines.push_back(inputs[k].reader.line());
        GONIO_TRY(names.note(*paint, k, lines.back()));
        batch.push_back(std::move(*paint));
      }
      GONIO_TRY(finish_batch(fitter, batch, lines, inputs[k].path, writer, tally));
      session.progress(fmt::format("{}: {} paints", session.tool(), tally.done()));
    }
  }
  return {};
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  GONIO_ASSIGN(Basis basis, read_basis(options.basis));
  session.explain(plan(options, basis));
  const PaintFitter fitter(std::move(basis), fit_options(options));

  GONIO_ASSIGN(std::vector<Input> inputs, open_all(options.paints));
  std::vector<Processing> history;
  std::vector<std::string> foreign;
  for (const Input& input : inputs) {
    history.insert(history.end(), input.reader.processing().begin(), input.reader.processing().end());
    foreign.insert(foreign.end(), input.reader.foreign().begin(), input.reader.foreign().end());
  }
  history.push_back({session.tool(), cli::Session::version(), session.command_line()});

  GONIO_ASSIGN(OutputFile file, OutputFile::create(options.output));
  GONIO_ASSIGN(PaintWriter writer, PaintWriter::begin(std::move(file), history, foreign));
  Tally tally(options, session);
  GONIO_TRY(fit_all(fitter, inputs, writer, tally, session));
  GONIO_TRY(writer.finish());
  return tally.finish();
}

}  // namespace goniochrome
