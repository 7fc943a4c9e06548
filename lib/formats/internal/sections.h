// Texts of sections and keys, as programs of instruments write them: `[SECTION]`, and below it lines `KEY=VALUE`.
#pragma once

#include <string>
#include <string_view>

#include "base/result.h"

namespace goniochrome::formats {

class SectionLines {
 public:
  // Reads `text`, which stays where it is.
  explicit SectionLines(std::string_view text) : rest_(text) {}

  // Goes on to the next line that begins a section or has a key. Blank lines and comments, which begin with `;`, are
  // passed over. Returns false at the end. The error lacks the place: the line is neither.
  Result<bool> next();

  bool begins_section() const { return key_.empty(); }
  const std::string& section() const { return section_; }  // in capitals
  const std::string& key() const { return key_; }          // in capitals
  std::string_view value() const { return value_; }
  int line() const { return line_; }  // from 1
  // True where the text ends within the line.
  bool is_unfinished() const { return unfinished_; }

 private:
  std::string_view rest_, value_;
  std::string section_, key_;
  int line_ = 0;
  bool unfinished_ = false;
};

}  // namespace goniochrome::formats
