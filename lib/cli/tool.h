// The frame of every tool: it parses, runs, reports and exits. The exit statuses are a contract, which every man page
// states.
#pragma once

#include <functional>
#include <string>

#include "base/clock.h"
#include "base/json.h"
#include "base/result.h"
#include "cli/options.h"
#include "cli/report.h"

namespace goniochrome::cli {

// The verdict of a finished run on its work.
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

  const std::string& command_line() const { return command_line_; }  // the command as it was given
  const std::string& tool() const { return tool_; }
  static const char* version();
  // `tool version: command line`, for the header of a file.
  std::string provenance() const;
  const CommonOptions& common() const { return common_; }
  double elapsed_s() const { return clock_.elapsed_s(); }

  // The object `results` of --report.
  Json& results() { return report_.results(); }

  // A list of `results` that grows with the library. It is empty at first, and add() appends what `element` returns.
  // Without --report, `element` is not called.
  void begin_list(const std::string& list) { report_.begin_list(list); }
  template <class Element>
  void add(const std::string& list, const Element& element) {
    if (!common_.report.empty()) report_.add(list, element());
  }

  // One line on standard error, unless --quiet.
  void say(const std::string& line) const;
  // One line that explains an exit status other than 0; --quiet keeps it.
  void say_verdict(const std::string& line) const;
  // With --quiet, tells the warnings and the last line of a run whose exit status is not 0.
  void end(Verdict verdict);
  // `tool: warning: ...`, also collected under results.warnings.
  void warn(const std::string& line);
  // A progress line, which the next line overwrites. It appears only on a terminal, and only after 0.5 s.
  void progress(const std::string& line) const;
  // The plan of --explain. It goes to standard error, so that data can still go through a pipe.
  void explain(const std::string& text) const;

  Result<void> write_report() const;

 private:
  std::string tool_, command_line_;
  const CommonOptions& common_;
  Stopwatch clock_;
  Report report_;
  mutable bool progress_shown_ = false;
  mutable std::string held_back_;  // the last line that --quiet kept from the user
};

// The main function of a tool parses argv by the table, which writes into the caller's options; answers --help,
// --version and --generate; sets the number of threads; runs; writes the report; prints an error as `tool: message`.
// Returns the exit status.
int tool_main(int argc, char** argv, const ToolSpec& spec, const CommonOptions& common,
              const std::function<Result<Verdict>(Session&)>& run);

}  // namespace goniochrome::cli
