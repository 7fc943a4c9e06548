// Options that the tools that write tables share: --output and --format, and texts that stay in their field.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "base/text.h"
#include "cli/options.h"
#include "color/color.h"

namespace goniochrome::tool {

enum class Format { kTable, kJson, kPaints };

// `paints` says which paints the format of that name writes, `json` what a line of JSON stands for.
inline void add_table_options(cli::ToolSpec& spec, std::string& output, std::string& format, const std::string& paints,
                              const std::string& json) {
  spec.option("output,o", "FILE", "found.tsv", &output, "where the result goes; - is standard output");
  spec.option("format,f", "FORMAT", "json", &format, "what is written")
      .one_of({"auto", "tsv", "json", "paints"})
      .more("tsv is a table, json has one JSON object for each " + json + " on a line of its own, and paints writes " +
            paints +
            ". auto goes by the ending of the output's name: .xml is paints, .json and .jsonl are json, and "
            "all else is tsv.");
}

inline void add_keep_going(cli::ToolSpec& spec, const std::string& names, bool& keep_going, const std::string& what) {
  spec.flag(names, &keep_going, "leave out " + what + ", with a warning each")
      .more("Where something was left out, the exit status is 1.");
}

// The format that --format names: "tsv", "json" or "paints", or with "auto" by the ending of the output's name.
inline Format format_of(const std::string& name, const std::string& output) {
  const auto by_ending = [&](const char* ending) { return name == "auto" && output.ends_with(ending); };
  if (name == "paints" || by_ending(".xml")) return Format::kPaints;
  if (name == "json" || by_ending(".json") || by_ending(".jsonl")) return Format::kJson;
  return Format::kTable;
}

// A text that stays in its field of a table: tabs and line ends become spaces.
inline std::string table_field(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
  return text;
}

// The decimals of numbers that come from these colors: the most that one of them has, from 2 to 4. Colors from spectra
// or a curve, whose decimals do not end, have the 2 of an instrument.
inline int decimals_of(const std::vector<color::Lab>& colors) {
  constexpr int kFewest = 2, kMost = 4;
  int decimals = kFewest;
  for (const color::Lab& lab : colors)
    for (const double value : {lab.L, lab.a, lab.b}) {
      std::array<char, 32> buffer;
      const char* const first = buffer.data();
      const char* const end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value).ptr;
      const std::string_view digits(first, end);
      const auto point = digits.find('.');
      const int own = point == std::string_view::npos ? 0 : static_cast<int>(digits.size() - point) - 1;
      if (own <= kMost && digits.find('e') == std::string_view::npos) decimals = std::max(decimals, own);
    }
  return decimals;
}

// The number with at most so many decimals.
inline std::string table_number(double value, int decimals) {
  if (std::isnan(value)) return "n/a";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  std::array<char, 400> buffer;  // the largest number has 309 digits before the point
  char* const first = buffer.data();
  char* const end = std::to_chars(first, first + buffer.size(), value, std::chars_format::fixed, decimals).ptr;
  std::string text(first, end);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

}  // namespace goniochrome::tool
