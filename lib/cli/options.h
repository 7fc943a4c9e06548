// One table of options for each tool. The parser, --help, the man page and the shell completion are all made from it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace goniochrome::cli {

// Where a parsed value goes. The value that is already there is the default, and the help shows it.
// A vector<string> collects a repeated option; a vector<double> takes a comma-separated list, or repeats.
using Target =
    std::variant<bool*, std::string*, double*, int*, std::uint64_t*, std::vector<std::string>*, std::vector<double>*>;

struct Option {
  std::string name = {}, alias = {};  // without dashes; alias is another long name that means the same
  char letter = 0;                    // 0 where there is none
  std::string value = {};             // what stands for the value in the help: "FILE"; empty for a flag
  std::string example = {};           // a value that a reader may try
  Target target = {};
  std::string help = {};      // one line: lower case, no full stop
  std::string category = {};  // the heading under which help and man page show the option
  std::string unit = {};      // "degrees"; empty where the value's name tells it, as DEG does
  // Whole sentences for the man page, where the help line is not enough. Lines that begin with "- " make a list.
  std::string details = {};
  std::vector<std::string> choices = {};  // the words that the option takes, if it is a choice
  double low = -1e300, high = 1e300;      // the domain of a number; both ends belong to it
  bool required = false;
  bool* given = nullptr;  // becomes true where the option is given, be it with its default; null: nobody wants to know

  // These complete an option where it is added: spec.option(...).from(0, 90).more("...").
  Option& from(double lowest, double highest = 1e300);
  Option& one_of(std::vector<std::string> words);
  Option& in(std::string its_unit);
  Option& more(std::string sentences);
  Option& needed();
};

// The words that are not options.
struct Positional {
  std::string value = {};  // "PAINTS"
  std::string help = {};
  std::vector<std::string>* target = nullptr;
  int low = 0, high = 1000000;  // how many there may be; low = 0 means standard input where none is given
};

struct Example {
  std::string command = {};  // runs as it stands in a folder with testdata/
  std::string effect = {};   // what it does: one sentence
};

struct ReportKey {
  std::string key = {};  // "lobes[].time_s"
  std::string meaning = {};
};

// A tool's whole story.
// An option that a tool had. It ends with exit status 2 and what to use instead.
struct GoneOption {
  std::string name;     // "budget"
  std::string instead;  // a sentence without a full stop, after "--budget is gone: "
};

struct ToolSpec {
  std::string name = {};
  std::string summary = {};                   // one line: "fit paints to a basis of cosine lobes"
  std::vector<std::string> description = {};  // paragraphs for the man page
  std::vector<Option> options = {};
  std::optional<Positional> inputs = {};
  std::vector<Example> examples = {};
  std::vector<ReportKey> report = {};      // keys of `results` in --report
  std::vector<GoneOption> gone = {};       // the last section of the man page
  std::vector<std::string> see_also = {};  // "fit-basis(1)"

  std::string heading = {};  // of the options that are added next

  // Adds an option. `names` are its long name and, after commas, a letter or another long name: "output,o". The
  // reference holds until the next one is added.
  Option& option(const std::string& names, std::string value, std::string example, Target target, std::string help);
  Option& flag(const std::string& names, bool* target, std::string help);
};

// The options that mean the same in every tool.
struct CommonOptions {
  bool quiet = false;
  bool explain = false;
  std::string report;
  double tolerance = 1e-3;
  bool tolerance_given = false;  // by name, and not by the default
  double time_limit_s = 0;
  int threads = 0;
  std::uint64_t seed = 1;
};

// Every tool has --quiet, --report, --threads, --help, --version and --generate. It has the options below only where
// they do something in it, and says what that is; an empty text leaves an option out.
struct CommonTexts {
  bool explain = false;
  std::string time_limit = {};                   // "the search"
  std::string stopped = "the exit status is 4";  // once the time is over
  std::string seed = {};                         // "the starting points of the search"
};
void add_common_options(ToolSpec& spec, CommonOptions& common, const CommonTexts& texts = {});

// --tolerance, under the heading of the tool's choice. `of_what` says what it is a tolerance of.
Option& add_tolerance(ToolSpec& spec, CommonOptions& common, const std::string& value, const std::string& of_what);

// The texts made from the table.
std::string help_text(const ToolSpec& spec);
std::string man_page(const ToolSpec& spec);
std::string bash_completion(const ToolSpec& spec);

// Returns one sentence for each fault of the table: an option without a heading, a unit or an example, an example that
// the option itself refuses, a help line that is not one, a text with a blank too many. It parses the examples into the
// targets.
std::vector<std::string> table_faults(const ToolSpec& spec);

}  // namespace goniochrome::cli
