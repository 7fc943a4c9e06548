#include <algorithm>

#include "base/text.h"
#include "cli/options.h"
#include "cli/parse.h"

namespace goniochrome::cli {

namespace {

// The default value of an option as text; empty where there is none worth telling.
struct DefaultText {
  std::string operator()(const bool*) const { return ""; }
  std::string operator()(const std::string* value) const { return *value; }
  std::string operator()(const double* value) const { return shortest(*value); }
  std::string operator()(const int* value) const { return std::to_string(*value); }
  std::string operator()(const std::uint64_t* value) const { return std::to_string(*value); }
  std::string operator()(const std::vector<std::string>* value) const { return joined(*value, " "); }
  std::string operator()(const std::vector<double>* value) const { return joined(*value, ",", shortest); }
};

std::string default_of(const Option& option) {
  return std::visit(DefaultText{}, option.target);
}

std::string option_help(const Option& option) {
  std::string text = option.help;
  if (!option.choices.empty()) text += fmt::format(": {}", joined(option.choices, ", "));
  if (!option.alias.empty()) text += fmt::format("; also --{}", option.alias);
  const std::string value = default_of(option);
  if (option.required)
    text += " (required)";
  else if (!value.empty())
    text += fmt::format(" [{}]", value);
  return text;
}

// Names of values that tell their unit.
constexpr std::pair<const char*, const char*> kUnits[] = {
    {"DEG", "degrees"},    {"S", "seconds"},   {"MS", "milliseconds"},         {"MM", "millimeters"}, {"PX", "pixels"},
    {"GU", "gloss units"}, {"STOPS", "stops"}, {"DE00", "units of CIEDE2000"}, {"X,Y", "pixels"},
};

std::string unit_of(const Option& option) {
  if (!option.unit.empty()) return option.unit;
  for (const auto& [value, unit] : kUnits)
    if (option.value == value) return unit;
  return "";
}

bool is_number(const Option& option) {
  return !std::holds_alternative<bool*>(option.target) && !std::holds_alternative<std::string*>(option.target) &&
         !std::holds_alternative<std::vector<std::string>*>(option.target);
}

// The domain of a value: "Value: degrees, from 0 to 90."
std::string domain_sentences(const Option& option) {
  std::string text;
  if (const std::string unit = unit_of(option); !unit.empty()) text = " " + unit;
  const auto add = [&](const std::string& more) { text += (text.empty() ? " " : ", ") + more; };
  const bool has_low = option.low > -1e300, has_high = option.high < 1e300;
  if (has_low && has_high)
    add(fmt::format("from {:.15g} to {:.15g}", option.low, option.high));
  else if (has_low)
    add(fmt::format("{:.15g} or more", option.low));
  else if (has_high)
    add(fmt::format("{:.15g} or less", option.high));
  if (!text.empty()) text = " Value:" + text + ".";
  if (std::holds_alternative<std::vector<std::string>*>(option.target)) text += " Repeatable.";
  return text;
}

// A help line as a sentence.
std::string sentence(std::string text) {
  if (text.empty()) return text;
  if (text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text + (text.back() == '.' ? "" : ".");
}

// The option's paragraph in the man page.
std::string paragraph(const Option& option) {
  std::string text = sentence(option.help);
  if (!option.choices.empty()) text += fmt::format(" Value: one of {}.", joined(option.choices, ", "));
  if (!option.details.empty()) text += " " + option.details;
  std::string rest;
  if (option.choices.empty()) rest = domain_sentences(option);
  const std::string value = default_of(option);
  if (option.required)
    rest += " Required.";
  else if (!value.empty())
    rest += fmt::format(" Default: {}.", value);
  if (!option.alias.empty()) rest += fmt::format(" The option may also be written --{}.", option.alias);
  if (!option.example.empty()) rest += fmt::format(" Example: --{} {}", option.name, option.example);
  // Behind a list they are a paragraph of their own.
  const std::size_t last_line = option.details.rfind('\n');
  const bool ends_in_list = last_line != std::string::npos && option.details.compare(last_line + 1, 2, "- ") == 0;
  if (ends_in_list && !rest.empty()) rest[0] = '\n';
  return text + rest;
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

// A paragraph below a .TP, in which lines that begin with "- " are items of a list.
std::string roff_paragraph(const std::string& text) {
  std::string result;
  bool in_list = false;
  for (const std::string_view line : split(text, '\n')) {
    const bool item = line.starts_with("- ");
    if (item) result += in_list ? ".IP \\(bu\n" : ".RS\n.IP \\(bu 2\n";
    if (!item && in_list) result += ".RE\n.IP\n";
    in_list = item;
    result += roff(item ? line.substr(2) : line) + "\n";
  }
  return in_list ? result + ".RE\n" : result;
}

// A paragraph of the description. One that begins with "# TITLE" and a new line has a heading.
std::string section_paragraph(const std::string& text, bool follows_another) {
  if (!text.starts_with("# ")) return (follows_another ? ".PP\n" : "") + roff_paragraph(text);
  const std::size_t end = text.find('\n');
  return fmt::format(".SS {}\n{}", roff(text.substr(2, end - 2)), roff_paragraph(text.substr(end + 1)));
}

// A category as the heading of a section.
std::string heading(const std::string& category) {
  std::string text = sentence(category);
  text.pop_back();
  return text;
}

}  // namespace

std::string help_text(const ToolSpec& spec) {
  std::string text = fmt::format("{} - {}\n\nusage: {}\n", spec.name, spec.summary, usage(spec));
  if (spec.inputs) text += fmt::format("\n  {}\n      {}\n", spec.inputs->value, wrapped(spec.inputs->help, 6, 100));
  std::string category;
  for (const Option& option : spec.options) {
    if (option.category != category) text += fmt::format("\n{}:\n", category = option.category);
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
    text += fmt::format("  {}\n      {}\n", example.command, wrapped(sentence(example.effect), 6, 100));
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
  if (!spec.description.empty()) text += roff(spec.description.front()) + "\n";
  if (!spec.examples.empty()) text += ".SH EXAMPLES\n";
  for (std::size_t i = 0; i < spec.examples.size(); ++i)
    text += fmt::format("{}{}\n.PP\n.nf\n.RS\n{}\n.RE\n.fi\n", i ? ".PP\n" : "",
                        roff(sentence(spec.examples[i].effect)), roff(spec.examples[i].command));
  if (spec.description.size() > 1) text += ".SH DETAILS\n";
  for (std::size_t i = 1; i < spec.description.size(); ++i) text += section_paragraph(spec.description[i], i > 1);
  text += ".SH OPTIONS\n";
  if (spec.inputs) text += fmt::format(".TP\n.I {}\n{}\n", roff(spec.inputs->value), roff(sentence(spec.inputs->help)));
  std::string category;
  for (const Option& option : spec.options) {
    if (option.category != category) text += fmt::format(".SS {}\n", roff(heading(category = option.category)));
    const std::string letter = option.letter ? fmt::format("\\fB\\-{}\\fR, ", option.letter) : "";
    const std::string value = option.value.empty() ? "" : " \\fI" + roff(option.value) + "\\fR";
    text += fmt::format(".TP\n{}\\fB\\-\\-{}\\fR{}\n{}", letter, roff(option.name), value,
                        roff_paragraph(paragraph(option)));
  }
  if (!spec.report.empty()) {
    text += ".SH REPORT\nThe object\n.I results\nof\n.B \\-\\-report\nholds these keys:\n";
    for (const ReportKey& key : spec.report) text += fmt::format(".TP\n.B {}\n{}.\n", roff(key.key), roff(key.meaning));
  }
  text +=
      ".SH EXIT STATUS\n0: done. 1: done, with a negative verdict. 2: wrong command line. 3: wrong input, a file that "
      "cannot be read or written, or no memory or thread. 4, before 1: a limit stopped the work, and the best "
      "result is written. 70: a bug. goniochrome(7) has the rules for scripts.\n";
  std::vector<std::string> pages = spec.see_also;
  for (const char* of_all : {"goniochrome-paint(5)", "goniochrome(7)"})
    if (std::ranges::find(pages, of_all) == pages.end()) pages.emplace_back(of_all);
  text += ".SH SEE ALSO\n";
  for (const std::string& page : pages) {
    const auto open = page.find('(');
    text +=
        fmt::format(".BR {} {}{}\n", roff(page.substr(0, open)), page.substr(open), page == pages.back() ? "" : ",");
  }
  if (!spec.gone.empty()) text += ".SH OPTIONS THAT ARE GONE\n";
  for (const GoneOption& option : spec.gone)
    text += fmt::format(".TP\n.B \\-\\-{}\n{}\n", roff(option.name), roff(sentence(option.instead)));
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
                           joined(option.choices, " "));
    else if (!option.value.empty())
      cases += fmt::format("    {}) COMPREPLY=($(compgen -f -- \"$word\")); return ;;\n", pattern);
  }
  std::string function = "_" + spec.name;
  std::ranges::replace(function, '-', '_');
  return fmt::format(
      "{}() {{\n  local word=${{COMP_WORDS[COMP_CWORD]}}\n  case ${{COMP_WORDS[COMP_CWORD-1]}} in\n{}  esac\n"
      "  case $word in\n    -*) COMPREPLY=($(compgen -W \"{}\" -- \"$word\")) ;;\n"
      "    *) COMPREPLY=($(compgen -f -- \"$word\")) ;;\n  esac\n}}\ncomplete -o filenames -F {} {}\n",
      function, cases, joined(words, " "), function, spec.name);
}

std::vector<std::string> table_faults(const ToolSpec& spec) {
  std::vector<std::string> faults;
  // Texts are put together from pieces of a line each, where a blank is soon written twice.
  const auto check_blanks = [&](const std::string& where, const std::string& text) {
    if (text.find("  ") != std::string::npos || text.starts_with(' ') || text.ends_with(' '))
      faults.push_back(fmt::format("{} {}: a blank too many in its text", spec.name, where));
  };
  check_blanks("NAME", spec.summary);
  for (const std::string& paragraph : spec.description) check_blanks("DESCRIPTION", paragraph);
  for (const Option& option : spec.options) check_blanks("--" + option.name, option.help + "." + option.details);
  for (const ReportKey& key : spec.report) check_blanks("REPORT " + key.key, key.meaning);
  for (const Example& example : spec.examples) check_blanks("EXAMPLES", example.effect);
  const auto fault = [&](const Option& option, const std::string& what) {
    faults.push_back(fmt::format("{} --{}: {}", spec.name, option.name, what));
  };
  for (const Option& option : spec.options) {
    if (option.category.empty()) fault(option, "stands under no heading");
    if (option.help.empty() || option.help.back() == '.') fault(option, "its help is not one line without a full stop");
    if (!option.details.empty() && option.details.back() != '.') fault(option, "its details are not whole sentences");
    if (option.value.empty()) continue;
    // N is a count, K a factor and X a ratio: they have no unit.
    const bool is_pure = std::string("NKX").find(option.value[0]) != std::string::npos;
    if (is_number(option) && !is_pure && unit_of(option).empty()) fault(option, "its unit is not told");
    if (option.example.empty()) fault(option, "has no example");
    ToolSpec alone{.name = spec.name, .options = {option}};
    alone.options[0].required = false;
    const auto parsed = parse(alone, {fmt::format("--{}={}", option.name, option.example)});
    if (!parsed.ok()) fault(option, "refuses its own example: " + parsed.error().message);
  }
  return faults;
}

}  // namespace goniochrome::cli
