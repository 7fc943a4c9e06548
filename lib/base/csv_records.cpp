#include "base/csv_records.h"

#include <algorithm>

#include "base/text.h"

namespace goniochrome {

namespace {

constexpr std::size_t kReadAtOnce = 1 << 16;
constexpr std::size_t kLongestRecord = 1 << 20;  // in a longer one a quotation mark was left open
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

bool quotes_closed(std::string_view text) {
  return std::ranges::count(text, '"') % 2 == 0;
}

// The separator that a line such as `sep=;` names, as spreadsheets write it before a table; 0 for any other line.
char named_separator(std::string_view line) {
  line = line.substr(0, line.find_last_not_of("\r\n \"") + 1);
  if (line.starts_with('"')) line.remove_prefix(1);
  return line.size() == 5 && lower(line.substr(0, 4)) == "sep=" ? line[4] : '\0';
}

char separator_of(std::string_view header) {
  bool quoted = false;
  bool semicolon = false, tab = false;
  for (const char c : header) {
    if (c == '"') quoted = !quoted;
    semicolon = semicolon || (c == ';' && !quoted);
    tab = tab || (c == '\t' && !quoted);
  }
  return semicolon ? ';' : tab ? '\t' : ',';
}

// The cell that begins at `at`, which moves behind its separator, or behind the end for the last cell. A quoted cell
// may have white space around its quotes; anything else there is kept as it is.
std::string cell_at(std::string_view record, std::size_t& at, char separator) {
  std::size_t end = at;
  bool quoted = false;
  for (; end < record.size() && (quoted || record[end] != separator); ++end) quoted ^= record[end] == '"';
  const std::string_view cell = trimmed(record.substr(at, end - at));
  at = end + 1;
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
  std::string text;
  for (std::size_t i = 1; i + 1 < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"' && cell[i + 1] == '"' && i + 2 < cell.size()) ++i;
  }
  return text;
}

std::string doubled_quotes(std::string_view text) {
  std::string doubled;
  for (const char c : text) doubled += c == '"' ? "\"\"" : std::string(1, c);
  return doubled;
}

// True if a spreadsheet would take the text for a formula and work it out. Apostrophes before one count as part of it,
// so that one more can be taken off again.
bool looks_like_formula(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of('\''), text.size()));
  return !text.empty() && std::string_view("=+-@").find(text.front()) != std::string_view::npos;
}

}  // namespace

// Appends the next bytes to the buffer, less what was used. False at the end of the input.
Result<bool> CsvRecords::fill() {
  buffer_.erase(0, at_);
  at_ = 0;
  if (!input_) return false;
  std::string bytes;
  GONIO_ASSIGN(const std::size_t count, input_->read(bytes, kReadAtOnce));
  decoder_.append(bytes, buffer_);
  return count > 0;
}

// Appends one line to the record, without its end: LF, CR LF or CR.
Result<bool> CsvRecords::next_line() {
  for (;;) {
    const std::size_t end = buffer_.find_first_of("\r\n", at_);
    const bool needs_more = end == std::string::npos || (buffer_[end] == '\r' && end + 1 == buffer_.size());
    if (needs_more) {
      if (buffer_.size() - at_ > kLongestRecord) break;
      GONIO_ASSIGN(const bool more, fill());
      if (more) continue;
      if (at_ == buffer_.size()) return false;
    }
    const std::size_t length = (end == std::string::npos ? buffer_.size() : buffer_.find_first_of("\r\n", at_)) - at_;
    record_.append(buffer_, at_, length);
    at_ += length;
    if (at_ < buffer_.size()) at_ += buffer_.compare(at_, 2, "\r\n") == 0 ? 2 : 1;
    ++lines_read_;
    return true;
  }
  return error(fmt::format("a line is longer than {} bytes: give a table in text", kLongestRecord));
}

// Reads one record that is not blank.
Result<bool> CsvRecords::next_record() {
  if (failed_) return false;
  failed_ = true;  // until the record is complete
  do {
    record_.clear();
    line_ = lines_read_ + 1;
    GONIO_ASSIGN(const bool found, next_line());
    if (!found) return false;
    while (!quotes_closed(record_)) {
      record_ += '\n';
      GONIO_ASSIGN(const bool more, next_line());
      if (!more || record_.size() > kLongestRecord)
        return error("a quotation mark is left open: close it, or double it inside a quoted cell");
    }
    if (line_ == 1 && record_.starts_with(kByteOrderMark)) record_.erase(0, kByteOrderMark.size());
  } while (trimmed(record_).empty() || (has_comments_ && trimmed(record_).starts_with('#')));
  failed_ = false;
  return true;
}

Result<bool> CsvRecords::next(std::vector<std::string>& cells) {
  for (;;) {
    GONIO_ASSIGN(const bool found, next_record());
    if (!found) return false;
    if (separator_ == 0) {
      separator_ = named_separator(record_);
      if (separator_ != 0) continue;
      separator_ = separator_of(record_);
    }
    if (!is_plain_utf8(record_)) return error("a character is not valid UTF-8: save the table as CSV UTF-8");
    cells.clear();
    for (std::size_t at = 0; at <= record_.size();) cells.push_back(cell_at(record_, at, separator_));
    if (std::ranges::any_of(cells, [](const std::string& cell) { return !cell.empty(); })) return true;
  }
}

Result<CsvRecords> CsvRecords::second_reading() {
  GONIO_ASSIGN(InputFile input, input_->second_reading());
  CsvRecords second(std::move(input));
  second.decoder_ = decoder_;
  second.buffer_ = buffer_;
  second.at_ = at_;
  second.line_ = line_, second.lines_read_ = lines_read_;
  second.separator_ = separator_;
  second.failed_ = failed_;
  return Result(std::move(second));
}

Result<std::vector<TableRow>> table_rows(CsvRecords records, bool has_comments) {
  records.has_comments_ = has_comments;
  std::vector<TableRow> rows;
  for (std::vector<std::string> cells;;) {
    GONIO_ASSIGN(const bool found, records.next(cells));
    if (!found) return Result(std::move(rows));
    rows.push_back({records.line(), cells});
  }
}

std::optional<std::string> with_decimal_point(std::string_view text) {
  if (std::ranges::count(text, ',') != 1 || text.find('.') != std::string_view::npos) return std::nullopt;
  std::string pointed(text);
  pointed[pointed.find(',')] = '.';
  return pointed;
}

std::optional<double> number_in_cell(std::string_view cell) {
  return parse_number(with_decimal_point(cell).value_or(std::string(cell)));
}

std::string_view cell_text(std::string_view cell) {
  return cell.starts_with('\'') && looks_like_formula(cell) ? cell.substr(1) : cell;
}

std::string csv_cell(std::string_view text) {
  if (looks_like_formula(text)) return "\"'" + doubled_quotes(text) + '"';
  if (text.find_first_of(",;\t\"\r\n") == std::string_view::npos && trimmed(text) == text) return std::string(text);
  return '"' + doubled_quotes(text) + '"';
}

}  // namespace goniochrome
