#include "cli/tool.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>

#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "cli/outputs.h"
#include "cli/parse.h"
#include "cli/process.h"
#include "cli/thread_start.h"

namespace goniochrome::cli {

namespace {

// Requests by --help, --version and --generate; set by the table like any other option.
struct Requests {
  bool help = false;
  bool version = false;
  std::string generate;
};

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && word.find_first_of(" \t\n\"'\\$`&|;<>()*?[]#~!{}") == std::string::npos;
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::string command_line(const std::string& name, const std::vector<std::string>& arguments) {
  std::string text = name;
  for (const std::string& word : arguments) text += " " + shell_word(word);
  return text;
}

// Where messages cannot be written, the exit status still tells what happened; fmt::print would throw.
void tell(const std::string& text) {
  std::fputs(text.c_str(), stderr);
}

int fail(const std::string& tool, const Error& error) {
  tell(fmt::format("{}: {}\n", tool, error.message));
  if (error.kind == ErrorKind::kUsage) tell(fmt::format("`{} --help` shows the usage\n", tool));
  return exit_status(error);
}

// Standard output must have reached its reader before a tool may say that it is done.
Result<void> close_output() {
  if (std::fflush(stdout) == 0 && !std::ferror(stdout)) return {};
  return input_error("standard output: cannot be written");
}

// Writes `text` as the whole of standard output, and returns the exit status.
int answer(const ToolSpec& spec, const std::string& text) {
  std::fputs(text.c_str(), stdout);
  const auto closed = close_output();
  return closed.ok() ? 0 : fail(spec.name, closed.error());
}

// Writes the man page or the completion. A table with faults is a bug.
int generate(const ToolSpec& spec, const std::string& what) {
  const std::string text = what == "man" ? man_page(spec) : bash_completion(spec);
  const std::vector<std::string> faults = table_faults(spec);
  if (!faults.empty()) return fail(spec.name, {ErrorKind::kBug, joined(faults, "\n")});
  return answer(spec, text);
}

}  // namespace

int exit_status(const Error& error) {
  switch (error.kind) {
    case ErrorKind::kUsage:
      return 2;
    case ErrorKind::kInput:
      return 3;
    case ErrorKind::kLimit:
      return 4;
    case ErrorKind::kBug:
      break;
  }
  return 70;
}

const char* Session::version() {
  return GONIOCHROME_VERSION;
}

std::string Session::provenance() const {
  return fmt::format("{} {}: {}", tool_, version(), command_line_);
}

void Session::say(const std::string& line) const {
  common_.quiet ? held_back_ = line, void() : say_verdict(line);
}

void Session::say_verdict(const std::string& line) const {
  if (progress_shown_) tell("\r\033[K");
  progress_shown_ = false;
  tell(line + "\n");
}

void Session::warn(const std::string& line) {
  results()["warnings"].push_back(line);
  if (!common_.quiet) say_verdict(fmt::format("{}: warning: {}", tool_, line));
}

void Session::end(Verdict verdict) {
  if (!common_.quiet || verdict == Verdict::kDone) return;
  for (const Json& warning : results().value("warnings", Json::array()))
    say_verdict(fmt::format("{}: warning: {}", tool_, warning.get<std::string>()));
  if (!held_back_.empty()) say_verdict(held_back_);
}

void Session::progress(const std::string& line) const {
  if (common_.quiet || clock_.elapsed_s() < 0.5 || !isatty(STDERR_FILENO)) return;
  tell("\r\033[K" + line);
  std::fflush(stderr);
  progress_shown_ = true;
}

void Session::explain(const std::string& text) const {
  if (common_.explain) tell(text);
}

Result<void> Session::write_report() const {
  if (common_.report.empty()) return {};
  return report_.write(common_.report, {{"tool", tool_},
                                        {"version", version()},
                                        {"command", command_line_},
                                        {"elapsed_s", clock_.elapsed_s()},
                                        {"peak_rss_mb", peak_rss_mb()},
                                        {"threads", threads()},
                                        {"seed", common_.seed}});
}

int tool_main(int argc, char** argv, const ToolSpec& table, const CommonOptions& common,
              const std::function<Result<Verdict>(Session&)>& run) {
  open_closed_descriptors();
  expect_memory_to_run_out(table.name);
  expect_threads_to_run_out(table.name);
  Requests requests;
  ToolSpec spec = table;
  spec.flag("help,h", &requests.help, "print this help");
  spec.flag("version", &requests.version, "print the version");
  spec.option("generate", "TEXT", "man", &requests.generate, "print a text made from the table of options")
      .one_of({"man", "completion"});
  // Linux starts a program without any argument, its name included, where the caller wants that.
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  // These three answer whatever else is on the line, and even where a required option is missing.
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    if (word == "--") break;
    if (word == "--help" || word == "-h") return answer(spec, help_text(spec));
    if (word == "--version") return answer(spec, fmt::format("{} {}\n", spec.name, Session::version()));
    const std::string value = word == "--generate" && i + 1 < arguments.size() ? arguments[i + 1] : "";
    const std::string what = word.starts_with("--generate=") ? word.substr(11) : value;
    if (what == "man" || what == "completion") return generate(spec, what);
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond its limit is a writing error, which names the file
  try {
    if (const auto parsed = parse(spec, arguments); !parsed.ok()) return fail(spec.name, parsed.error());
    if (!requests.generate.empty()) return generate(spec, requests.generate);
    if (const auto checked = check_outputs(spec); !checked.ok()) return fail(spec.name, checked.error());
    set_threads(common.threads);
    Session session(spec.name, command_line(spec.name, arguments), common);
    const auto verdict = run(session);
    if (!verdict.ok()) return fail(spec.name, verdict.error());
    if (const auto written = session.write_report(); !written.ok()) return fail(spec.name, written.error());
    if (const auto closed = close_output(); !closed.ok()) return fail(spec.name, closed.error());
    session.end(*verdict);
    return static_cast<int>(*verdict);
  } catch (const std::bad_alloc&) {
    return fail(spec.name, {ErrorKind::kInput, "out of memory: the input is too large for this machine"});
  } catch (const std::exception& bug) {
    if (is_short_of_memory()) return fail(spec.name, input_error("out of memory: {}", bug.what()));
    return fail(spec.name,
                {ErrorKind::kBug, fmt::format("internal error: {}: please report it with the command", bug.what())});
  }
}

}  // namespace goniochrome::cli
