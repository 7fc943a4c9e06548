// What every tool does around its work: parse, run, report, exit. See the contract in goniochrome-paint(5), EXIT
// STATUS.
#pragma once

#include <functional>
#include <string>

#include "base/clock.h"
#include "base/json.h"
#include "base/result.h"
#include "cli/options.h"
#include "cli/report.h"

namespace goniochrome::cli {

// What a finished run says of its work.
enum class Verdict {
  kDone = 0,
  kNegative = 1,  // over threshold, no match, not converged
  kStopped = 4,   // stopped by a limit, best result written
};

// Exit status of an error: 2 usage, 3 bad input or I/O, 4 limit, 70 a bug.
int exit_status(const Error& error);

// A tool's run: messages to standard error, figures into the report.
class Session {
 public:
  Session(std::string tool, std::string command_line, const CommonOptions& common)
      : tool_(std::move(tool)), command_line_(std::move(command_line)), common_(common) {}

  // The command as given, for provenance.
  const std::string& command_line() const { return command_line_; }
  const std::string& tool() const { return tool_; }
  static const char* version();
  const CommonOptions& common() const { return common_; }
  double elapsed_s() const { return clock_.elapsed_s(); }

  // `results` of --report.
  Json& results() { return report_.results(); }

  // A list of `results` that grows with the library: empty at first, then an element for each add(), which is what
  // `element` returns; it is not asked without --report.
  void begin_list(const std::string& list) { report_.begin_list(list); }
  template <class Element>
  void add(const std::string& list, const Element& element) {
    if (!common_.report.empty()) report_.add(list, element());
  }

  // One line on standard error, unless --quiet.
  void say(const std::string& line) const;
  // `tool: warning: ...`, also collected under results.warnings.
  void warn(const std::string& line);
  // A progress line, only on a terminal and only after 0.5 s; overwritten by the next line.
  void progress(const std::string& line) const;
  // The plan of --explain: standard error, so that data can still go through a pipe.
  void explain(const std::string& text) const;

  Result<void> write_report() const;

 private:
  std::string tool_, command_line_;
  const CommonOptions& common_;
  Stopwatch clock_;
  Report report_;
  mutable bool progress_shown_ = false;
};

// The main() of a tool: parses argv by the table (which writes into the caller's options), answers --help, --version
// and --generate, sets the threads, runs, writes the report, prints an error as `tool: message`, and returns the exit
// status.
int tool_main(int argc, char** argv, const ToolSpec& spec, const CommonOptions& common,
              const std::function<Result<Verdict>(Session&)>& run);

}  // namespace goniochrome::cli
