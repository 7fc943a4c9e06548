#include "tool.h"

#include <algorithm>
#include <functional>
#include <set>

#include "base/clock.h"
#include "base/parallel.h"
#include "base/text.h"
#include "cloud.h"
#include "finding.h"
#include "formats/reference.h"
#include "illuminants.h"
#include "sink.h"
#include "streamed_library.h"

namespace goniochrome::tool {

namespace {

constexpr std::size_t kWarningsShown = 10;

std::string names_of(const std::vector<paint::Geometry>& geometries) {
  return joined(geometries, ",", paint::geometry_name);
}

const char* origin_name(library::LibraryIndex::Origin origin) {
  switch (origin) {
    case library::LibraryIndex::Origin::kMapped:
      return "mapped";
    case library::LibraryIndex::Origin::kBuilt:
      return "built";
    case library::LibraryIndex::Origin::kInMemory:
      break;
  }
  return "in_memory";
}

// One run, which turns a stream of queries into findings.
class Run {
 public:
  // `streamed` is the library where it is no file.
  Run(const Options& options, cli::Session& session, const Searched& library,
      const std::optional<StreamedLibrary>& streamed, const library::LibrarySearchOptions& search)
      : options_(options),
        session_(session),
        library_(library),
        streamed_(streamed),
        index_(library.index()),
        metric_(search.metric),
        weights_(search.weights),
        search_(library.search()) {}

  Result<cli::Verdict> operator()() {
    session_.explain(plan_text());
    GONIO_ASSIGN(formats::PaintBatches batches, formats::PaintBatches::open(options_.inputs));
    GONIO_ASSIGN(OutputFile file, OutputFile::create(options_.output));
    session_.begin_list("queries");
    if (options_.assign) return assign(batches, std::move(file));
    GONIO_ASSIGN(Sink sink, Sink::begin(format_of(options_.format, options_.output), !options_.illuminants.empty(),
                                        std::move(file)));
    const auto take = [&](const std::vector<paint::Paint>& batch) -> Result<void> {
      GONIO_ASSIGN(const auto findings, found(batch));
      for (const auto& finding : findings)
        if (finding) GONIO_TRY(sink.write(*finding, index_));
      return sink.flush();
    };
    GONIO_TRY(for_each_batch(batches, session_, take, left_out()));
    GONIO_TRY(sink.finish(options_.library, streamed_, session_));
    if (!options_.cloud.empty()) GONIO_TRY(cloud_.write(options_.cloud, index_));
    return finish();
  }

 private:
  // The queries go on as paints, in their order, those without an answer as they came.
  Result<cli::Verdict> assign(formats::PaintBatches& batches, OutputFile file) {
    Prolog prolog;
    prolog.take(batches);
    GONIO_ASSIGN(CodeSink sink, CodeSink::begin(std::move(file), std::move(prolog), session_));
    std::size_t without_code = 0;
    const auto take = [&](const std::vector<paint::Paint>& batch) -> Result<void> {
      GONIO_ASSIGN(const auto findings, found(batch));
      for (std::size_t i = 0; i < batch.size(); ++i) {
        GONIO_ASSIGN(const std::string name, sink.write(batch[i], findings[i] ? &*findings[i] : nullptr, index_));
        if (!name.empty() && without_code++ == 0)
          session_.warn(fmt::format("library paint \"{}\" has no code: its name stands for it", name));
      }
      return {};
    };
    GONIO_TRY(for_each_batch(batches, session_, take, left_out()));
    if (without_code > 1)
      session_.warn(fmt::format("{} more designs got the name of a paint without a code", without_code - 1));
    GONIO_TRY(sink.finish());
    if (!options_.cloud.empty()) GONIO_TRY(cloud_.write(options_.cloud, index_));
    return finish();
  }

  // The handler of a query that cannot be read.
  std::function<void(const Error&)> left_out() {
    if (!options_.keep_going) return {};
    return [this](const Error& error) { leave_out(error.message); };
  }

  void leave_out(const std::string& message) {
    session_.warn(message + ": left out");
    ++left_out_;
  }

  // The result for each paint of a batch; nothing for those that were left out.
  Result<std::vector<std::optional<Finding>>> found(const std::vector<paint::Paint>& batch) {
    std::vector<std::pair<std::size_t, QueryPlan>> queries;
    for (const paint::Paint& paint : batch) {
      auto plan = library_.plan(paint);
      if (plan.ok()) {
        tell_once(plan->plan);
        queries.emplace_back(static_cast<std::size_t>(&paint - batch.data()), std::move(*plan));
        continue;
      }
      const std::string message = fmt::format("paint \"{}\": {}", paint.name, plan.error().message);
      if (!options_.keep_going) return Error{plan.error().kind, message};
      leave_out(message);
    }
    const Stopwatch searching;
    std::vector<std::optional<Finding>> findings(batch.size());
    parallel_for(queries.size(), 4, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        findings[queries[i].first] =
            finding_of(batch[queries[i].first], std::move(queries[i].second), library_, metric_,
                       {options_.threshold, options_.off_radial, options_.hue_travel});
    });
    wall_s_ += searching.elapsed_s();
    for (const auto& finding : findings)
      if (finding) note(*finding);
    return findings;
  }

  void note(const Finding& finding) {
    ++searched_;
    if (!options_.cloud.empty()) cloud_.note(finding);
    search_s_ += finding.search_s;
    outside_ += finding.outside;
    off_radial_ += finding.off_radial;
    turns_ += finding.turns;
    no_match_ += finding.no_match();
    session_.add("queries", [&] { return finding_json(finding, index_); });
    if (finding.status() == "ok" || ++problems_ > kWarningsShown) return;
    if (finding.no_match())
      return session_.warn(fmt::format("paint \"{}\": the filters leave no paint of the library", finding.query));
    const Neighbor& nearest = finding.neighbors.front();
    const auto name = index_.name(nearest.match.paint);
    if (finding.outside)
      session_.warn(
          fmt::format("paint \"{}\" is outside the library: the nearest, \"{}\", is {:.1f} away on average; "
                      "the design has L* {:+.1f}, chroma {:+.1f}, hue {:+.1f} against it",
                      finding.query, name, nearest.mean_de, nearest.dL, nearest.dC, nearest.dH));
    if (finding.off_radial)
      session_.warn(
          fmt::format("paint \"{}\" travels off-radially: its flop lies {:+.1f} off the face's hue line, that "
                      "of the nearest, \"{}\", {:+.1f}",
                      finding.query, finding.hue_shift, name, finding.matched_hue_shift));
    if (finding.turns)
      session_.warn(fmt::format("paint \"{}\" turns its hue by {:+.0f} deg from face to flop, the nearest, \"{}\", {}",
                                finding.query, finding.hue_travel_deg, name,
                                std::isnan(finding.matched_hue_travel_deg)
                                    ? "has no hue to turn"
                                    : fmt::format("by {:+.0f}", finding.matched_hue_travel_deg)));
  }

  // Tells of library paints that are left out and of conditions that are mixed, once for each set of geometries.
  void tell_once(const library::SearchPlan& plan) {
    const std::string names = names_of(plan.geometries);
    for (const paint::Geometry& geometry : plan.geometries) compared_.insert(paint::geometry_name(geometry));
    if ((plan.left_out == 0 && !plan.mixed) || !told_.insert(names).second) return;
    if (plan.left_out > 0)
      session_.warn(
          fmt::format("{} of {} library paints lack one of {} and are left out", plan.left_out, index_.size(), names));
    if (plan.mixed)
      session_.warn(fmt::format("Lab values for {}/{} are compared with others as they are", plan.mixed->illuminant,
                                plan.mixed->observer_deg));
  }

  std::string method_names() const {
    std::set<std::string> names;
    for (std::size_t i = 0; i < index_.sections().size(); ++i)
      names.insert(search_.method(i) == library::SearchMethod::kTree ? "tree" : "scan");
    return joined({names.begin(), names.end()}, ",");
  }

  std::string plan_text() const {
    std::string text = fmt::format("library {}: {} paints, {} to consider; index {}{}, {:.1f} MB, {:.3f} s\n",
                                   options_.library, index_.size(), search_.candidates(), origin_name(index_.origin()),
                                   index_.note().empty() ? "" : " (" + index_.note() + ")",
                                   static_cast<double>(index_.bytes()) / 1048576, index_.build_s());
    for (std::size_t i = 0; i < index_.sections().size(); ++i) {
      const library::LibrarySection& section = index_.sections()[i];
      const bool tree = search_.method(i) == library::SearchMethod::kTree;
      text += fmt::format("  {} paints, {}/{} at {}: {}\n", section.tree.size, section.condition.illuminant,
                          section.condition.observer_deg, names_of(section.geometries), tree ? "tree" : "scan");
    }
    return text +
           fmt::format(
               "method {}: {}; the scan wins only below {} paints, or where a filter lets fewer than one in {} through "
               "(measured: 10^6 paints, 5 nearest, tree 52 us against 5.8 ms in dE76, 1.3 against 120 ms in dE00)\n"
               "formula {}: {}\n"
               "compared at {}; every answer is exact, ties in the library's order\n"
               "left out: paints without a color\n",
               options_.method, options_.method == "auto" ? "as measured" : "as told", library::kLeafSize + 1,
               library::kScanFraction, color::formula_name(metric_),
               metric_ == library::kDe76 ? "sum of the differences"
                                         : "sum of the differences, pruned by a proven lower bound",
               options_.geometries.empty() ? "the geometries that query and library share"
                                           : "the geometries asked for");
  }

  cli::Verdict finish() {
    Json& results = session_.results();
    results["library_size"] = index_.size();
    results["candidates"] = search_.candidates();
    results["index"] = origin_name(index_.origin());
    results["index_s"] = index_.build_s();
    results["read_s"] = index_.read_s();
    results["index_bytes"] = index_.bytes();
    results["method"] = method_names();
    results["query_us"] = json_number(searched_ > 0 ? 1e6 * search_s_ / static_cast<double>(searched_) : 0);
    results["queries_per_s"] = json_number(wall_s_ > 0 ? static_cast<double>(searched_) / wall_s_ : 0);
    results["searched"] = searched_;
    results["outside"] = outside_;
    results["off_radial"] = off_radial_;
    results["hue_travel"] = turns_;
    results["no_match"] = no_match_;
    results["left_out"] = left_out_;
    for (const auto& [geometry, weight] : weights_)
      if (searched_ > 0 && !compared_.contains(paint::geometry_name(geometry)))
        session_.warn(
            fmt::format("the weight of {} has no effect: nothing was compared there", paint::geometry_name(geometry)));
    if (problems_ > kWarningsShown)
      session_.warn(fmt::format("{} more designs with problems", problems_ - kWarningsShown));
    if (searched_ + left_out_ == 0) session_.warn("the input holds no paints: nothing was searched");
    std::string line = fmt::format("{}: {} paints against {}", session_.tool(), searched_, index_.size());
    if (outside_ > 0) line += fmt::format(", {} outside", outside_);
    if (off_radial_ > 0) line += fmt::format(", {} off-radial", off_radial_);
    if (turns_ > 0) line += fmt::format(", {} of another hue travel", turns_);
    if (no_match_ > 0) line += fmt::format(", {} without a match", no_match_);
    if (left_out_ > 0) line += fmt::format(", {} left out", left_out_);
    session_.say(line);
    return searched_ == 0 || outside_ + no_match_ + left_out_ > 0 ? cli::Verdict::kNegative : cli::Verdict::kDone;
  }

  const Options& options_;
  cli::Session& session_;
  const Searched& library_;
  const std::optional<StreamedLibrary>& streamed_;
  const library::LibraryIndex& index_;
  const color::DifferenceFormula& metric_;
  std::vector<std::pair<paint::Geometry, double>> weights_;
  const library::LibrarySearch& search_;
  Cloud cloud_;
  std::set<std::string> told_, compared_;
  std::size_t searched_ = 0, outside_ = 0, off_radial_ = 0, turns_ = 0, no_match_ = 0, left_out_ = 0, problems_ = 0;
  double search_s_ = 0, wall_s_ = 0;
};

Result<void> check_library(const library::LibraryIndex& index, const std::string& name) {
  if (index.size() > 0) return {};
  return input_error("{}: holds no paint: name a library that has some", name);
}

// The search under several illuminants.
Result<cli::Verdict> run_under_lights(const Options& options, const std::optional<StreamedLibrary>& streamed,
                                      const library::LibrarySearchOptions& search, cli::Session& session) {
  GONIO_ASSIGN(std::vector<std::string> illuminants, illuminants_of(options.illuminants));
  const auto progress = [&](std::size_t paints) {
    session.progress(fmt::format("{}: reading {}: {} paints", session.tool(), options.library, paints));
  };
  GONIO_ASSIGN(const library::LightsSearch lights,
               streamed
                   ? library::LightsSearch::from_paints(streamed->reader(), std::move(illuminants), search, progress)
                   : library::LightsSearch::open(options.library, std::move(illuminants), search, progress));
  tell_warnings(lights.warnings(), session);
  GONIO_TRY(check_library(lights.index(), options.library));
  if (lights.without_spectra() > 0)
    session.warn(
        fmt::format("{} of {} library paints have no spectra and are left out: nothing tells their color in "
                    "other light",
                    lights.without_spectra(), lights.index().size()));
  return Run(options, session, Searched(lights), streamed, search)();
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  GONIO_ASSIGN(const library::LibrarySearchOptions search, search_options(options));
  const bool is_table = options.format == "tsv" || options.format == "json" || options.output.ends_with(".json") ||
                        options.output.ends_with(".jsonl") || options.output.ends_with(".tsv");
  if (options.assign && is_table)
    return usage_error("--assign writes paint XML: leave --format out, and end the output in .xml");
  if (!options.cloud.empty() && !options.cloud.ends_with(".svg"))
    return usage_error("--cloud is \"{}\": give a name that ends in .svg", options.cloud);
  const bool asks_input = options.inputs.empty() || std::ranges::find(options.inputs, "-") != options.inputs.end();
  if (formats::paint_reference(options.library).file == "-" && asks_input)
    return usage_error("--library - takes standard input: name the paints to look for as files");
  GONIO_ASSIGN(const std::optional<StreamedLibrary> streamed, StreamedLibrary::open(options.library, session));
  if (!options.illuminants.empty()) return run_under_lights(options, streamed, search, session);
  const auto progress = [&](std::size_t paints) {
    session.progress(fmt::format("{}: indexing {}: {} paints", session.tool(), options.library, paints));
  };
  GONIO_ASSIGN(const library::LibraryIndex index,
               streamed ? library::LibraryIndex::from_paints(streamed->reader())
                        : library::LibraryIndex::open(options.library, progress, cli::Session::version()));
  tell_warnings(index.warnings(), session);
  if (index.origin() == library::LibraryIndex::Origin::kBuilt && index.note() != "there was none")
    session.say(
        fmt::format("{}: {}: made anew, {}", session.tool(), library::index_path(options.library), index.note()));
  if (!streamed && index.origin() == library::LibraryIndex::Origin::kInMemory &&
      !formats::paint_reference(options.library).name)
    session.warn(fmt::format("the index stays in memory and is made again by every run: {}", index.note()));
  GONIO_TRY(check_library(index, options.library));
  const library::LibrarySearch all(index, search);
  return Run(options, session, Searched(index, all), streamed, search)();
}

}  // namespace goniochrome::tool
