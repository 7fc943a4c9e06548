// Names of the files of many things, made from a pattern such as "out/{name}.png".
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/result.h"

namespace goniochrome {

// `text` as a part of a file's name on every usual system: what is a separator, a wildcard or a control character
// there, and bytes that are not UTF-8, become "_", as do a point in front and points and blanks at the end. It is cut
// to 180 bytes, between characters. "" becomes "_".
std::string safe_file_name(std::string_view text);

// The pattern and its words in braces: {name}, {code} and {index}.
class FileNames {
 public:
  // True if the text has one of the words in braces.
  static bool is_pattern(std::string_view text);

  // For the name of one file, which may have braces of its own. Error (usage): it has letters in braces that are none
  // of `words`, as {nme} is, so that somebody meant a pattern. `option` is what the error calls the name.
  static Result<void> check(const std::string& path, const std::vector<std::string>& words, const std::string& option);

  // Error (usage): a word in braces that is none of `words`, with those that there are. `option` is what the error
  // calls the pattern.
  static Result<FileNames> create(const std::string& pattern, const std::vector<std::string>& words,
                                  const std::string& option);

  // True if the pattern has this word.
  bool has(std::string_view word) const;

  // The file of the next thing. `index` has four digits or more, and a thing without a code is called by its name.
  // Names and codes are made safe. A file that was named before gets "-2", "-3" and so on in front of its ending. It
  // takes 32 bytes of memory for each.
  std::string next(std::size_t index, const std::string& name, const std::string& code);

 private:
  struct Piece {
    std::string text;  // as it stands, or the word
    bool is_word = false;
  };
  bool is_new(const std::string& path);

  std::vector<Piece> pieces_;
  std::unordered_map<std::uint64_t, std::uint32_t> taken_;  // by hash of the file's name, how often it was asked for
};

}  // namespace goniochrome
