#include "tool.h"

#include <algorithm>
#include <cmath>

#include "base/file.h"
#include "base/parallel.h"
#include "base/paths.h"
#include "base/text.h"
#include "fit/basis_search.h"
#include "fitting.h"
#include "formats/basis.h"
#include "paint_stream.h"
#include "report/plot.h"

namespace goniochrome::tool {

namespace {

constexpr int kMostLobes = 24;

struct Range {
  int first = 1, last = 11;
};

Result<Range> lobe_range(const std::string& text) {
  const auto dots = text.find("..");
  const auto first = parse_integer(text.substr(0, dots));
  const auto last = dots == std::string::npos ? first : parse_integer(text.substr(dots + 2));
  if (!first || !last || *first < 1 || *last < *first || *last > kMostLobes)
    return usage_error("--lobes is \"{}\": give a number from 1 to {}, or a range like 1..11", text, kMostLobes);
  return Range{static_cast<int>(*first), static_cast<int>(*last)};
}

bool states_gloss(const paint::Paint& paint) {
  return std::ranges::any_of(paint.gloss, [](const paint::GlossReading& reading) { return reading.gloss_units > 0; });
}

// The targets with their floors. All have a mirror beside the lobes, or none has.
Result<std::vector<fit::BasisTarget>> read_targets(const Options& options, cli::Session& session) {
  const fit::BasisTargetOptions target_options{target_kind(options.target), options.weights == "perceptual"};
  std::vector<fit::BasisTarget> targets;
  bool mirror = options.mirror == "yes";
  for (const std::string& path : options.paints.empty() ? std::vector<std::string>{"-"} : options.paints) {
    GONIO_ASSIGN(FitInput input, FitInput::open(path));
    if (input.measured) {
      GONIO_ASSIGN(const fit::BrdfTarget brdf, fit::read_brdf_target(*input.measured));
      for (const std::string& remark : brdf.remarks) session.warn(fmt::format("{}: {}", input.name, remark));
      GONIO_ASSIGN(fit::BasisTarget target, fit::basis_target(brdf, target_options));
      targets.push_back(std::move(target));
      continue;
    }
    tell_warnings(input.paints->warnings(), session);
    for (;;) {
      GONIO_ASSIGN(const std::optional<paint::Paint> paint, input.paints->next());
      if (!paint) break;
      mirror = mirror || (options.mirror == "auto" && states_gloss(*paint));
      auto target = fit::basis_target(*paint, target_options);
      if (target.ok())
        targets.push_back(std::move(*target));
      else
        session.warn(fmt::format("{}: left out: {}", input.paints->place(), target.error().message));
    }
    tell_warnings(input.paints->closing_warnings(), session);
  }
  if (targets.empty()) return input_error("no paint to choose a basis for: give a library with at least one");
  for (fit::BasisTarget& target : targets) target.mirror = mirror;
  fit::set_floors(targets);
  return targets;
}

std::string list(const std::vector<double>& exponents) {
  return joined(exponents, " ", [](double exponent) { return fmt::format("{:.4g}", exponent); });
}

// The dE00 of the worst paint at its worst angle, for each set.
std::vector<double> visible_errors(const fit::BasisSearch& search, const std::vector<fit::BasisTarget>& targets) {
  std::vector<double> errors;
  std::vector<double> each(targets.size());
  for (const fit::FoundBasis& set : search.sets) {
    parallel_for(targets.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) each[i] = fit::basis_de00(set.exponents, targets[i]);
    });
    errors.push_back(*std::ranges::max_element(each));
  }
  return errors;
}

// Tells how evenly the exponents are spaced in log space: the squared correlation of log E with its rank. It is 1 where
// there are fewer than 3 exponents.
double log_regularity(const std::vector<double>& exponents) {
  const auto n = static_cast<double>(exponents.size());
  if (exponents.size() < 3) return 1;
  double mean = 0;
  for (const double e : exponents) mean += std::log(e) / n;
  double of_ranks = 0, of_logs = 0, both = 0;
  for (std::size_t j = 0; j < exponents.size(); ++j) {
    const double rank = static_cast<double>(j) - (n - 1) / 2, log = std::log(exponents[j]) - mean;
    of_ranks += rank * rank, of_logs += log * log, both += rank * log;
  }
  return of_logs > 0 ? both * both / (of_ranks * of_logs) : 0;
}

// The first number of lobes from which on the worst color changes by less than
// `visible` with every further lobe; 0 where the largest set still gains.
int enough_lobes(const fit::BasisSearch& search, const std::vector<double>& de00, double visible) {
  for (std::size_t i = 0; i + 1 < de00.size(); ++i) {
    const double best_later = *std::min_element(de00.begin() + static_cast<std::ptrdiff_t>(i), de00.end());
    if (de00[i] - best_later < visible) return static_cast<int>(search.sets[i].exponents.size());
  }
  return 0;
}

std::string table_csv(const fit::BasisSearch& search, const std::vector<double>& de00) {
  std::string text = "lobes,max_error,mean_error,de00_max,log_regularity,time_s,exponents\n";
  for (std::size_t i = 0; i < search.sets.size(); ++i) {
    const fit::FoundBasis& set = search.sets[i];
    text += fmt::format("{},{},{},{},{:.4f},{:.4f},{}\n", set.exponents.size(), shortest(set.error.max),
                        shortest(set.error.mean), shortest(de00[i]), log_regularity(set.exponents), set.time_s,
                        list(set.exponents));
  }
  return text;
}

std::string plot_svg(const fit::BasisSearch& search, const std::vector<double>& de00) {
  report::Plot exponents{
      .title = "Chosen exponents", .x = {.label = "exponent", .logarithmic = true}, .y = {.label = "number of lobes"}};
  report::Plot errors{
      .title = "Error of the library", .x = {.label = "number of lobes"}, .y = {.label = "error", .logarithmic = true}};
  report::Series max{"largest", {}, {}, report::Series::Style::kLineAndPoints},
      mean{"mean", {}, {}, report::Series::Style::kLineAndPoints},
      color{"worst dE00", {}, {}, report::Series::Style::kLineAndPoints};
  for (std::size_t i = 0; i < search.sets.size(); ++i) {
    const fit::FoundBasis& set = search.sets[i];
    const double lobes = static_cast<double>(set.exponents.size());
    exponents.series.push_back({"", set.exponents, std::vector<double>(set.exponents.size(), lobes),
                                report::Series::Style::kLineAndPoints, "#0072b2"});
    for (report::Series* s : {&max, &mean, &color}) s->x.push_back(lobes);
    max.y.push_back(set.error.max), mean.y.push_back(set.error.mean), color.y.push_back(de00[i]);
  }
  errors.series = {max, mean, color};
  return report::svg({exponents, errors}, 1);
}

// The file of --each that gets the set of so many lobes.
std::string each_name(const Options& options, std::size_t lobes) {
  return fmt::format("{}{}.basis.xml", options.each, lobes);
}

formats::Basis basis_of(const Options& options, bool mirror, const fit::BasisSearch& search,
                        const fit::FoundBasis& found) {
  formats::Basis basis{
      options.name.empty() ? fmt::format("b{}", found.exponents.size()) : options.name, found.exponents, mirror, {}};
  for (const fit::FoundBasis& each : search.sets)
    basis.sets.push_back(
        {static_cast<int>(each.exponents.size()), each.error.max, each.error.mean, each.error.objective()});
  return basis;
}

void report(const fit::BasisSearch& search, const std::vector<fit::BasisTarget>& targets,
            const std::vector<double>& de00, cli::Session& session) {
  Json sets = Json::array();
  for (std::size_t i = 0; i < search.sets.size(); ++i) {
    const fit::FoundBasis& set = search.sets[i];
    const auto worst = std::ranges::max_element(set.error.each) - set.error.each.begin();
    sets.push_back({{"lobes", set.exponents.size()},
                    {"exponents", set.exponents},
                    {"max_error", json_number(set.error.max)},
                    {"mean_error", json_number(set.error.mean)},
                    {"objective", json_number(set.error.objective())},
                    {"de00_max", json_number(de00[i])},
                    {"log_regularity", json_number(log_regularity(set.exponents))},
                    {"worst", targets[static_cast<std::size_t>(worst)].name},
                    {"time_s", set.time_s},
                    {"starts", set.starts},
                    {"evaluations", set.evaluations},
                    {"at_bound", set.at_low || set.at_high},
                    {"searched_paints", set.looked_at}});
    session.say(fmt::format("{:2} lobes: largest {:.3g}, mean {:.3g}, dE00 {:.2f}, {:.2f} s: {}", set.exponents.size(),
                            set.error.max, set.error.mean, de00[i], set.time_s, list(set.exponents)));
  }
  session.results()["sets"] = sets;
  double floor_max = 0, floor_mean = 0;
  for (const fit::BasisTarget& target : targets) {
    floor_max = std::max(floor_max, target.floor);
    floor_mean += target.floor / static_cast<double>(targets.size());
  }
  session.results()["floor_max"] = json_number(floor_max);
  session.results()["floor_mean"] = json_number(floor_mean);
  session.results()["mirror"] = targets.front().mirror;
  session.results()["paints"] = targets.size();
}

// Warns of exponents at an end of their domain, once for each end.
void warn_of_bounds(const fit::BasisSearch& search, bool mirror, cli::Session& session) {
  const auto sets_at = [&](bool fit::FoundBasis::*end) {
    std::vector<std::string> lobes;
    for (const fit::FoundBasis& set : search.sets)
      if (set.*end) lobes.push_back(fmt::format("{}", set.exponents.size()));
    return joined(lobes, ", ");
  };
  if (const std::string lobes = sets_at(&fit::FoundBasis::at_high); !lobes.empty())
    session.warn(fmt::format("the sharpest of {} lobes is at its bound: {}", lobes,
                             mirror ? "some coats ask for a lobe between it and the mirror"
                                    : "colors read nearer to specular, or --mirror yes, leave it less to meet"));
  if (const std::string lobes = sets_at(&fit::FoundBasis::at_low); !lobes.empty())
    session.warn(
        fmt::format("the broadest of {} lobes is at its bound of {:g}: a still broader one would show an edge "
                    "where light grazes; readings beyond 75 deg ask for it",
                    lobes, fit::BasisSearchOptions().low));
}

}  // namespace

Result<cli::Verdict> run(const Options& options, cli::Session& session) {
  GONIO_ASSIGN(const Range range, lobe_range(options.lobes));
  if (!options.each.empty())
    for (int lobes = range.first; lobes <= range.last; ++lobes)
      GONIO_TRY(can_be_written(each_name(options, static_cast<std::size_t>(lobes))));
  GONIO_ASSIGN(const std::vector<fit::BasisTarget> targets, read_targets(options, session));
  const bool mirror = targets.front().mirror;
  fit::BasisSearchOptions search_options;
  search_options.method = options.method == "lm" ? fit::BasisMethod::kLevenbergMarquardt : fit::BasisMethod::kPowerMean;
  search_options.first = range.first, search_options.last = range.last;
  search_options.starts = options.starts;
  search_options.representatives = static_cast<std::size_t>(options.representatives);
  search_options.seed = options.common.seed;
  search_options.time_limit_s = options.common.time_limit_s;
  session.explain(
      fmt::format("{} paints; {} starts for each of {} to {} "
                  "lobes, method {}\n"
                  "gloss: the rough coats of {} paints take part{}; a smooth coat asks for a mirror and for no lobe\n"
                  "left out: directions out of plane\n",
                  targets.size(), options.starts, range.first, range.last, options.method,
                  std::ranges::count_if(targets, [](const fit::BasisTarget& t) { return t.coat.has_value(); }),
                  mirror ? ", with the mirror" : ""));

  const std::size_t most = search_options.representatives;
  if (most > 0 && targets.size() > 2 * most)
    session.explain(
        fmt::format("searched on {} paints that represent all, and on those that are fitted worse than any of these; "
                    "--representatives 0 searches all\n",
                    most));

  const fit::BasisSearch search = fit::search_basis(targets, search_options);
  const std::vector<double> de00 = visible_errors(search, targets);
  report(search, targets, de00, session);
  warn_of_bounds(search, mirror, session);
  const int enough = enough_lobes(search, de00, options.visible_de00);
  session.results()["enough_lobes"] = enough ? Json(enough) : Json(nullptr);
  if (search.sets.size() > 1)
    session.say(
        enough ? fmt::format("fit-basis: beyond {} lobes no paint changes by dE00 {}", enough, options.visible_de00)
               : fmt::format("fit-basis: the last lobe is still worth dE00 {} or more", options.visible_de00));

  if (!options.table.empty()) GONIO_TRY(write_file(options.table, table_csv(search, de00)));
  if (!options.plot.empty()) GONIO_TRY(write_file(options.plot, plot_svg(search, de00)));
  if (!options.each.empty())
    for (const fit::FoundBasis& set : search.sets)
      GONIO_TRY(formats::write_basis(each_name(options, set.exponents.size()), basis_of(options, mirror, search, set)));
  GONIO_TRY(formats::write_basis(options.output, basis_of(options, mirror, search, search.sets.back())));
  if (search.stopped)
    session.say_verdict("fit-basis: the time limit stopped the search: the best exponents are written");
  return search.stopped ? cli::Verdict::kStopped : cli::Verdict::kDone;
}

}  // namespace goniochrome::tool
