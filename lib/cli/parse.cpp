#include "cli/parse.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <map>

#include "base/text.h"

namespace goniochrome::cli {

namespace {

std::string dashed(const Option& option) {
  return "--" + option.name;
}

Error unknown_option(const ToolSpec& spec, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  for (const GoneOption& gone : spec.gone)
    if (name == "--" + gone.name) return usage_error("{} is gone: {}", name, gone.instead);
  const Option* nearest = nullptr;
  std::size_t distance = 4;
  for (const Option& option : spec.options) {
    const std::size_t d = edit_distance(dashed(option), name);
    if (d < distance) nearest = &option, distance = d;
  }
  return usage_error("unknown option {}: {}", name,
                     nearest ? "did you mean " + dashed(*nearest) + "?" : "`" + spec.name + " --help` lists them");
}

std::string domain(const Option& option) {
  if (option.low > -1e300 && option.high < 1e300)
    return fmt::format(" from {} to {}", shortest(option.low), shortest(option.high));
  if (option.low > -1e300) return fmt::format(" of {} or more", shortest(option.low));
  if (option.high < 1e300) return fmt::format(" of {} or less", shortest(option.high));
  return "";
}

Result<double> number(const Option& option, std::string_view text, bool whole) {
  const char* kind = whole ? "whole number" : "number";
  const auto value = whole ? [&]() -> std::optional<double> {
    const auto integer = parse_integer(text);
    return integer ? std::optional<double>(static_cast<double>(*integer)) : std::nullopt;
  }()
      : parse_number(text);
  if (!value || *value < option.low || *value > option.high)
    return usage_error("{} is \"{}\": give a {}{}", dashed(option), text, kind, domain(option));
  return *value;
}

// Puts the texts given for one option into its target.
struct Setter {
  const Option& option;
  const std::vector<std::string>& texts;

  Result<void> operator()(bool* target) const {
    *target = true;
    return {};
  }
  Result<void> operator()(std::string* target) const {
    const std::string& text = texts.back();
    if (text.empty()) return usage_error("{} is empty: give {}", dashed(option), option.value);
    if (!option.choices.empty() && std::ranges::find(option.choices, text) == option.choices.end())
      return usage_error("{} is \"{}\": give {}", dashed(option), text, joined(option.choices, ", "));
    *target = text;
    return {};
  }
  Result<void> operator()(double* target) const {
    GONIO_ASSIGN(*target, number(option, texts.back(), false));
    return {};
  }
  Result<void> operator()(int* target) const {
    GONIO_ASSIGN(const double value, number(option, texts.back(), true));
    if (std::abs(value) > 2147483647.0) return usage_error("{} is \"{}\": too large", dashed(option), texts.back());
    *target = static_cast<int>(value);
    return {};
  }
  Result<void> operator()(std::uint64_t* target) const {
    GONIO_ASSIGN(const double value, number(option, texts.back(), true));
    if (value < 0) return usage_error("{} is \"{}\": give a whole number of 0 or more", dashed(option), texts.back());
    *target = static_cast<std::uint64_t>(*parse_integer(texts.back()));
    return {};
  }
  Result<void> operator()(std::vector<std::string>* target) const {
    for (const std::string& text : texts)
      if (text.empty()) return usage_error("{} is empty: give {}", dashed(option), option.value);
    *target = texts;
    return {};
  }
  Result<void> operator()(std::vector<double>* target) const {
    target->clear();
    for (const std::string& text : texts)
      for (const std::string_view piece : split(text, ',')) {
        GONIO_ASSIGN(const double value, number(option, trimmed(piece), false));
        target->push_back(value);
      }
    return {};
  }
};

bool is_list(const Option& option) {
  return std::holds_alternative<std::vector<std::string>*>(option.target) ||
         std::holds_alternative<std::vector<double>*>(option.target);
}

}  // namespace

Result<void> parse(const ToolSpec& spec, const std::vector<std::string>& arguments) {
  CLI::App app;
  app.set_help_flag();
  app.allow_extras();
  std::map<std::string, std::vector<std::string>> texts;
  for (const Option& option : spec.options) {
    const std::string names = (option.letter ? fmt::format("-{},", option.letter) : "") + dashed(option) +
                              (option.alias.empty() ? "" : ",--" + option.alias);
    if (option.value.empty())
      app.add_flag_callback(names, [&texts, &option] { texts[option.name].emplace_back(); });
    else
      app.add_option_function<std::string>(
             names, [&texts, &option](const std::string& text) { texts[option.name].push_back(text); })
          ->trigger_on_parse();
  }
  // The library has a syntax of its own for words in brackets where it takes positional arguments, so it takes none:
  // what it leaves over are the positional words, and unknown options. After "--" all words are positional.
  const auto separator = std::ranges::find(arguments, "--");
  // It takes the next word for the value of "--name=".
  for (const Option& option : spec.options)
    if (!option.value.empty() && std::find(arguments.begin(), separator, dashed(option) + "=") != separator)
      return usage_error("{} is empty: give {}", dashed(option), option.value);
  try {
    // CLI11 takes the arguments last first.
    std::vector<std::string> reversed(std::make_reverse_iterator(separator), arguments.rend());
    app.parse(reversed);
  } catch (const CLI::ArgumentMismatch& mismatch) {
    const std::string name = std::string(mismatch.what()).substr(0, std::string(mismatch.what()).find(':'));
    return usage_error("{} needs a value", name);
  } catch (const CLI::ParseError& error) {
    return usage_error("{}", error.what());
  }
  std::vector<std::string> words = app.remaining();
  for (const std::string& word : words)
    if (word.size() > 1 && word[0] == '-') return unknown_option(spec, word);
  if (separator != arguments.end()) words.insert(words.end(), separator + 1, arguments.end());
  if (!spec.inputs && !words.empty())
    return usage_error("\"{}\" is one word too many: {} takes no input files", words.front(), spec.name);
  if (std::ranges::find(words, "") != words.end())
    return usage_error("an argument is empty: give {}, or - for standard input", spec.inputs->value);

  for (const Option& option : spec.options) {
    const auto given = texts.find(option.name);
    if (given == texts.end() || given->second.empty()) {
      if (option.required) return usage_error("{} {} is missing: {}", dashed(option), option.value, option.help);
      continue;
    }
    if (!option.value.empty() && !is_list(option) && given->second.size() > 1)
      return usage_error("{} is given {} times: give it once", dashed(option), given->second.size());
    GONIO_TRY(std::visit(Setter{option, given->second}, option.target));
    if (option.given != nullptr) *option.given = true;
  }
  if (spec.inputs) {
    const auto count = static_cast<int>(words.size());
    if (count < spec.inputs->low) return usage_error("{} is missing: {}", spec.inputs->value, spec.inputs->help);
    if (count > spec.inputs->high)
      return usage_error("{} inputs are given: {} takes at most {}", count, spec.name, spec.inputs->high);
    *spec.inputs->target = words;
  }
  return {};
}

}  // namespace goniochrome::cli
