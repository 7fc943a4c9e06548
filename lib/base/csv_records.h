// Tables in text (CSV) as records of cells, whatever separates them, and cells as tables need them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/encoding.h"
#include "base/file.h"
#include "base/result.h"

namespace goniochrome {

struct TableRow;

// The records of a table: cells between separators, quoted or not, whatever the ends of lines are.
class CsvRecords {
 public:
  explicit CsvRecords(InputFile input) : name_(input.name()), input_(std::move(input)) {}
  // The reader of a text in memory.
  CsvRecords(std::string name, std::string_view text) : name_(std::move(name)) { decoder_.append(text, buffer_); }

  // Reads the next record with a cell that is not empty into `cells`. White space around cells and the quotes of quoted
  // cells are taken off. Returns false at the end. A first record `sep=;` names the separator. Otherwise the first
  // record fixes it: `;` if it holds one, or else a tab, or else `,`. Error: file and line; it is final where the
  // record does not end.
  Result<bool> next(std::vector<std::string>& cells);

  // A second reader of the records that this one has still to read.
  Result<CsvRecords> second_reading();

  // The line (from 1) on which the last record began.
  int line() const { return line_; }
  char separator() const { return separator_; }
  const std::string& name() const { return name_; }
  Error error(std::string_view what) const { return input_error("{}:{}: {}", name(), line_, what); }

 private:
  Result<bool> next_line();
  Result<bool> fill();
  Result<bool> next_record();
  friend Result<std::vector<TableRow>> table_rows(CsvRecords records, bool has_comments);

  std::string name_;
  std::optional<InputFile> input_;
  Utf8Decoder decoder_;
  std::string buffer_;
  std::size_t at_ = 0;
  std::string record_;
  int line_ = 0, lines_read_ = 0;
  char separator_ = 0;
  bool failed_ = false, has_comments_ = false;
};

// A row of a small table that is read as a whole.
struct TableRow {
  int line = 0;
  std::vector<std::string> cells;
};

// All rows that CsvRecords gives; lines that begin with # are passed over where `has_comments`.
Result<std::vector<TableRow>> table_rows(CsvRecords records, bool has_comments = false);

// `text` with a point in place of its comma, if it has one comma and no point; nothing otherwise.
std::optional<std::string> with_decimal_point(std::string_view text);

// The number that a cell holds, with a decimal point or a decimal comma.
std::optional<double> number_in_cell(std::string_view cell);

// A text that is none of our numbers as its cell says it, without the apostrophe that marks it as text.
std::string_view cell_text(std::string_view cell);

// One text as it is written between commas: quoted if any reader might take it apart, and behind an apostrophe if a
// spreadsheet would take it for a formula.
std::string csv_cell(std::string_view text);

}  // namespace goniochrome
