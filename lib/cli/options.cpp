#include "cli/options.h"

#include "base/text.h"

namespace goniochrome::cli {

Option& Option::from(double lowest, double highest) {
  low = lowest, high = highest;
  return *this;
}

Option& Option::one_of(std::vector<std::string> words) {
  choices = std::move(words);
  return *this;
}

Option& Option::in(std::string its_unit) {
  unit = std::move(its_unit);
  return *this;
}

Option& Option::more(std::string sentences) {
  details = std::move(sentences);
  return *this;
}

Option& Option::needed() {
  required = true;
  return *this;
}

Option& ToolSpec::option(const std::string& names, std::string value, std::string example, Target target,
                         std::string help) {
  Option& added = options.emplace_back();
  const auto words = split(names, ',');
  added.name = words[0];
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i].size() == 1)
      added.letter = words[i][0];
    else
      added.alias = words[i];
  }
  added.value = std::move(value), added.example = std::move(example);
  added.target = target, added.help = std::move(help), added.category = heading;
  return added;
}

Option& ToolSpec::flag(const std::string& names, bool* target, std::string help) {
  return option(names, "", "", target, std::move(help));
}

Option& add_tolerance(ToolSpec& spec, CommonOptions& common, const std::string& value, const std::string& of_what) {
  Option& option = spec.option("tolerance", value, shortest(common.tolerance / 5), &common.tolerance, of_what).from(0);
  option.given = &common.tolerance_given;
  return option;
}

void add_common_options(ToolSpec& spec, CommonOptions& common, const CommonTexts& texts) {
  spec.heading = "common to all tools";
  if (texts.explain)
    spec.flag("explain", &common.explain, "say what will be done before doing it")
        .more(
            "The text goes to standard error. It also says what will be left out and why, and what the choices cost.");
  if (!texts.time_limit.empty())
    spec.option("time-limit", "S", "60", &common.time_limit_s,
                "longest time for " + texts.time_limit + "; 0 is no limit")
        .from(0)
        .more("After this time the best result so far is written and " + texts.stopped + ".");
  if (!texts.seed.empty())
    spec.option("seed", "N", "7", &common.seed, "number that starts the random choice of " + texts.seed)
        .from(0)
        .more("The same number makes the same choice.");
  spec.option("report", "FILE", "report.json", &common.report, "write the figures of the run as one JSON object")
      .more("- is standard output, where that carries no data.");
  spec.option("threads", "N", "4", &common.threads, "number of threads; 0 is one for each core")
      .from(0, 1024)
      .more("The results do not depend on it. 1 needs the fewest threads, where the system allows no more.");
  spec.flag("quiet,q", &common.quiet, "print only errors, and reasons of status 1 and 4");
}

}  // namespace goniochrome::cli
