// What the tools that write tables share: the choice of --format, and texts that stay in their field.
#pragma once

#include <algorithm>
#include <string>

namespace goniochrome::tool {

enum class Format { kTable, kJson, kPaints };

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

}  // namespace goniochrome::tool
