#include "cli/outputs.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>
#include <string_view>

#include "base/paths.h"
#include "base/text.h"

namespace goniochrome::cli {

namespace {

// The options that name files to write, in all tools.
constexpr std::array<std::string_view, 12> kOutputs = {"output",    "report",      "table",      "plot",
                                                       "curve",     "picture",     "residual",   "cloud",
                                                       "error-map", "make-limits", "show-limit", "chart"};

struct File {
  std::string what;  // "--output", or "PAINTS" for a positional word
  std::string path;
};

bool writes(const Option& option) {
  return std::ranges::find(kOutputs, option.name) != kOutputs.end();
}

bool is_file(const std::string& path) {
  return !path.empty() && path != "-" && (!is_there(path) || is_plain_file(path));
}

bool has_any_of(const std::string& value, std::span<const std::string_view> words) {
  return std::ranges::any_of(words, [&](std::string_view word) { return value.find(word) != std::string::npos; });
}

// `text` and what may be the name of a file in it: FILE#NAMES, FILE@X,Y, PART=FILE*N, FILE,FILE.
std::vector<std::string> names_in(const std::string& text) {
  std::vector<std::string> names = {text};
  for (const std::string_view piece : split(text, ',')) {
    const std::string word(piece.substr(piece.find('=') + 1));  // all of it where there is no such sign
    names.push_back(word);
    for (std::size_t at = word.find_first_of("#@*"); at != std::string::npos; at = word.find_first_of("#@*", at + 1))
      names.push_back(word.substr(0, at));
  }
  return names;
}

// The values of the options that name files: of those that are written, or of those that are read.
std::vector<File> named_files(const ToolSpec& spec, bool written) {
  constexpr std::array<std::string_view, 3> kWritten = {"FILE", "PATTERN", "PATH"};
  constexpr std::array<std::string_view, 5> kRead = {"FILE", "PAINT", "IMAGE", "TABLE", "DROPPER"};
  std::vector<File> files;
  const auto add = [&](const std::string& what, const std::string& text) {
    for (const std::string& path : written ? std::vector{text} : names_in(text))
      if (is_file(path)) files.push_back({what, path});
  };
  for (const Option& option : spec.options) {
    if (writes(option) != written) continue;
    if (!(written ? has_any_of(option.value, kWritten) : has_any_of(option.value, kRead))) continue;
    if (const auto* one = std::get_if<std::string*>(&option.target)) add("--" + option.name, **one);
    if (const auto* many = std::get_if<std::vector<std::string>*>(&option.target))
      for (const std::string& text : **many) add("--" + option.name, text);
  }
  if (!written && spec.inputs)
    for (const std::string& word : *spec.inputs->target) add(spec.inputs->value, word);
  return files;
}

// True if two names lead to one file, be it there or not.
bool same_file(const std::string& a, const std::string& b) {
  const auto first = file_identity(a), second = file_identity(b);
  if (first || second) return first == second;
  return std::filesystem::path(a).lexically_normal() == std::filesystem::path(b).lexically_normal();
}

}  // namespace

Result<void> check_outputs(const ToolSpec& spec) {
  const std::vector<File> outputs = named_files(spec, true), inputs = named_files(spec, false);
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      if (same_file(outputs[i].path, outputs[j].path))
        return usage_error("{} and {} are both {}: give each its own file", outputs[j].what, outputs[i].what,
                           outputs[i].path);
    for (const File& input : inputs)
      if (file_identity(input.path) && same_file(outputs[i].path, input.path))
        return usage_error("{} is {}, which is also read: write to another file, and put it in place afterwards",
                           outputs[i].what, outputs[i].path);
    GONIO_TRY(can_be_written(outputs[i].path));
  }
  return {};
}

}  // namespace goniochrome::cli
