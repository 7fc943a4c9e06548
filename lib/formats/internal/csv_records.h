// Records of a table in text: cells between separators, quoted or not, whatever the line ends.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/input.h"
#include "base/result.h"

namespace goniochrome::formats {

// A longer record is refused: a quotation mark was left open.
constexpr std::size_t kLongestRecord = 1 << 20;

class CsvRecords {
 public:
  explicit CsvRecords(InputFile input) : input_(std::move(input)) {}

  // Reads the next record that is not blank into `cells`: without the white space around unquoted cells, and with the
  // quotes of quoted ones resolved. Returns false at the end. The first record fixes the separator: the one of `;`, tab
  // and `,` that it holds, in that order. Error: file and line; it is final where the record does not end.
  Result<bool> next(std::vector<std::string>& cells);

  // The line (from 1) on which the last record began.
  int line() const { return line_; }
  char separator() const { return separator_; }
  const std::string& name() const { return input_.name(); }

 private:
  Result<bool> next_line();
  Result<bool> fill();
  Error error(std::string_view what) const { return input_error("{}:{}: {}", name(), line_, what); }

  InputFile input_;
  std::string buffer_;
  std::size_t at_ = 0;
  std::string record_;
  int line_ = 0, lines_read_ = 0;
  char separator_ = 0;
  bool failed_ = false;
};

// One cell as it is written between commas: quoted where any reader might take it apart.
std::string csv_cell(std::string_view text);

}  // namespace goniochrome::formats
