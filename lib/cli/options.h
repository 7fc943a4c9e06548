// One table of options per tool. The parser, --help, the man page and the shell completion are all made from it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace goniochrome::cli {

// Where a parsed value goes. The value already there is the default and is shown in the help.
using Target =
    std::variant<bool*, std::string*, double*, int*, std::uint64_t*, std::vector<std::string>*, std::vector<double>*>;

struct Option {
  std::string name = {};   // long name without dashes: "basis"
  char letter = 0;         // short name: 'o', or 0
  std::string value = {};  // what stands for the value in the help: "FILE"; empty for a flag
  std::string help = {};   // one sentence, lower case, no full stop
  Target target = {};
  std::vector<std::string> choices = {};  // the words it takes, if it is a choice
  double low = -1e300, high = 1e300;      // the domain of a number, both ends included
  bool required = false;
  std::string alias = {};  // another long name that means the same
};
// A vector<string> target collects a repeated option; a vector<double> target takes a comma-separated list, or repeats.

// The words that are not options.
struct Positional {
  std::string value = {};  // "PAINTS"
  std::string help = {};
  std::vector<std::string>* target = nullptr;
  int low = 0, high = 1000000;  // how many; 0 means standard input where none is given
};

struct Example {
  std::string command = {};  // runs as it stands in a folder with testdata/
  std::string effect = {};   // what it does, one sentence
};

struct ReportKey {
  std::string key = {};  // "lobes[].time_s"
  std::string meaning = {};
};

// A tool's whole story.
struct ToolSpec {
  std::string name = {};
  std::string summary = {};                   // one line: "fit paints to a basis of cosine lobes"
  std::vector<std::string> description = {};  // paragraphs for the man page
  std::vector<Option> options = {};
  std::optional<Positional> inputs = {};
  std::vector<Example> examples = {};
  std::vector<ReportKey> report = {};      // keys of results in --report
  std::vector<std::string> see_also = {};  // "fit-basis(1)"
};

// The options that mean the same in every tool. A tool lists those that do something for it.
struct CommonOptions {
  bool quiet = false;
  bool explain = false;
  std::string report;
  double tolerance = 1e-3;
  double time_limit_s = 0;
  int threads = 0;
  std::uint64_t seed = 1;
};
// Every tool has --quiet, --report, --threads, --help, --version and --generate; these are the others.
enum class Common { kExplain, kTolerance, kTimeLimit, kSeed };
void add_common_options(ToolSpec& spec, CommonOptions& common, const std::vector<Common>& which);

// The texts made from the table.
std::string help_text(const ToolSpec& spec);
std::string man_page(const ToolSpec& spec);
std::string bash_completion(const ToolSpec& spec);

}  // namespace goniochrome::cli
