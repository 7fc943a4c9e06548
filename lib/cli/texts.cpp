#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "cli/options.h"

namespace goniochrome::cli {

namespace {

// The default value of an option as text; empty where there is none worth telling.
struct DefaultText {
  std::string operator()(const bool*) const { return ""; }
  std::string operator()(const std::string* value) const { return *value; }
  std::string operator()(const double* value) const { return shortest(*value); }
  std::string operator()(const int* value) const { return std::to_string(*value); }
  std::string operator()(const std::uint64_t* value) const { return std::to_string(*value); }
  std::string operator()(const std::vector<std::string>* value) const {
    return fmt::format("{}", fmt::join(*value, " "));
  }
  std::string operator()(const std::vector<double>* value) const {
    std::vector<std::string> texts;
    for (const double v : *value) texts.push_back(shortest(v));
    return fmt::format("{}", fmt::join(texts, ","));
  }
};

std::string option_help(const Option& option) {
  std::string text = option.help;
  if (!option.choices.empty()) text += fmt::format(": {}", fmt::join(option.choices, ", "));
  if (!option.alias.empty()) text += fmt::format("; also --{}", option.alias);
  const std::string value = std::visit(DefaultText{}, option.target);
  if (option.required)
    text += " (required)";
  else if (!value.empty())
    text += fmt::format(" [{}]", value);
  return text;
}

std::string usage(const ToolSpec& spec) {
  std::string text = spec.name + " [options]";
  if (spec.inputs) {
    const std::string dots = spec.inputs->high > 1 ? "..." : "";
    text += spec.inputs->low > 0 ? fmt::format(" {}{}", spec.inputs->value, dots)
                                 : fmt::format(" [{}{}]", spec.inputs->value, dots);
  }
  return text;
}

// `text` in lines of at most `width`, each after the first indented.
std::string wrapped(const std::string& text, std::size_t indent, std::size_t width) {
  std::string result;
  std::size_t column = indent;
  for (const std::string_view word : split(text, ' ')) {
    if (column > indent && column + 1 + word.size() > width) {
      result += "\n" + std::string(indent, ' ');
      column = indent;
    } else if (column > indent) {
      result += ' ';
      ++column;
    }
    result += word;
    column += word.size();
  }
  return result;
}

// Text for a man page: backslashes, hyphens that are typed, and a leading dot or quote are made safe.
std::string roff(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\\')
      result += "\\e";
    else if (c == '-')
      result += "\\-";
    else
      result += c;
  }
  if (!result.empty() && (result[0] == '.' || result[0] == '\'')) result.insert(0, "\\&");
  return result;
}

}  // namespace

std::string help_text(const ToolSpec& spec) {
  std::string text = fmt::format("{} - {}\n\nusage: {}\n", spec.name, spec.summary, usage(spec));
  if (spec.inputs) text += fmt::format("\n  {}\n      {}\n", spec.inputs->value, wrapped(spec.inputs->help, 6, 100));
  text += "\noptions:\n";
  for (const Option& option : spec.options) {
    const std::string names =
        option.letter ? fmt::format("-{}, --{}", option.letter, option.name) : "    --" + option.name;
    const std::string head = fmt::format("  {}{}{}", names, option.value.empty() ? "" : " ", option.value);
    constexpr std::size_t kColumn = 30;
    text +=
        head + (head.size() + 2 > kColumn ? "\n" + std::string(kColumn, ' ') : std::string(kColumn - head.size(), ' '));
    text += wrapped(option_help(option), kColumn, 100) + "\n";
  }
  if (!spec.examples.empty()) text += "\nexamples:\n";
  for (const Example& example : spec.examples)
    text += fmt::format("  {}\n      {}\n", example.command, wrapped(example.effect, 6, 100));
  text += fmt::format("\nThe whole story: man {}\n", spec.name);
  return text;
}

std::string man_page(const ToolSpec& spec) {
  std::string title = spec.name;
  std::ranges::transform(title, title.begin(), [](char c) { return c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c; });
  std::string text = fmt::format(".TH {} 1 2026-11-21 \"Goniochrome\" \"Goniochrome\"\n.SH NAME\n{} \\- {}\n",
                                 roff(title), roff(spec.name), roff(spec.summary));
  text += fmt::format(".SH SYNOPSIS\n.B {}\n[options]", roff(spec.name));
  if (spec.inputs) text += roff(usage(spec).substr(spec.name.size() + 10));
  text += "\n.SH DESCRIPTION\n";
  for (std::size_t i = 0; i < spec.description.size(); ++i)
    text += (i ? ".PP\n" : "") + roff(spec.description[i]) + "\n";
  text += ".SH OPTIONS\n";
  if (spec.inputs) text += fmt::format(".TP\n.I {}\n{}\n", roff(spec.inputs->value), roff(spec.inputs->help));
  for (const Option& option : spec.options) {
    const std::string letter = option.letter ? fmt::format("\\fB\\-{}\\fR, ", option.letter) : "";
    const std::string value = option.value.empty() ? "" : " \\fI" + roff(option.value) + "\\fR";
    text += fmt::format(".TP\n{}\\fB\\-\\-{}\\fR{}\n{}\n", letter, roff(option.name), value, roff(option_help(option)));
  }
  if (!spec.report.empty()) {
    text += ".SH REPORT\nThe object\n.I results\nof\n.B \\-\\-report\nholds, beside the keys common to all tools:\n";
    for (const ReportKey& key : spec.report) text += fmt::format(".TP\n.B {}\n{}\n", roff(key.key), roff(key.meaning));
  }
  text +=
      ".SH EXIT STATUS\n"
      "0 done; 1 done, with a negative verdict; 2 usage; 3 bad input or I/O; 4 stopped by a limit, best result "
      "written; 70 a bug.\n";
  if (!spec.examples.empty()) text += ".SH EXAMPLES\n";
  for (std::size_t i = 0; i < spec.examples.size(); ++i)
    text += fmt::format("{}{}\n.PP\n.nf\n.RS\n{}\n.RE\n.fi\n", i ? ".PP\n" : "", roff(spec.examples[i].effect),
                        roff(spec.examples[i].command));
  text += ".SH SEE ALSO\n";
  for (const std::string& page : spec.see_also) {
    const auto open = page.find('(');
    text += fmt::format(".BR {} {},\n", roff(page.substr(0, open)), page.substr(open));
  }
  text += ".BR goniochrome\\-paint (5),\n.BR goniochrome\\-theory (7)\n";
  return text;
}

std::string bash_completion(const ToolSpec& spec) {
  std::vector<std::string> words;
  std::string cases;
  for (const Option& option : spec.options) {
    words.push_back("--" + option.name);
    const std::string pattern =
        option.letter ? fmt::format("--{}|-{}", option.name, option.letter) : "--" + option.name;
    if (!option.choices.empty())
      cases += fmt::format("    {}) COMPREPLY=($(compgen -W \"{}\" -- \"$word\")); return ;;\n", pattern,
                           fmt::join(option.choices, " "));
    else if (!option.value.empty())
      cases += fmt::format("    {}) COMPREPLY=($(compgen -f -- \"$word\")); return ;;\n", pattern);
  }
  std::string function = "_" + spec.name;
  std::ranges::replace(function, '-', '_');
  return fmt::format(
      "{}() {{\n  local word=${{COMP_WORDS[COMP_CWORD]}}\n  case ${{COMP_WORDS[COMP_CWORD-1]}} in\n{}  esac\n"
      "  case $word in\n    -*) COMPREPLY=($(compgen -W \"{}\" -- \"$word\")) ;;\n"
      "    *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n  esac\n}}\ncomplete -o filenames -F {} {}\n",
      function, cases, fmt::join(words, " "), function, spec.name);
}

}  // namespace goniochrome::cli
