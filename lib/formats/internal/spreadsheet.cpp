#include "formats/internal/spreadsheet.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>

#include "base/text.h"
#include "formats/internal/xml_stream.h"
#include "formats/internal/zip_archive.h"

namespace goniochrome::formats {

namespace {

constexpr std::size_t kLargestBook = std::size_t{1} << 30;
// A part that unpacks to more than this, and to more than so many times its packed size, is no table that anybody made.
constexpr std::size_t kAnySize = std::size_t{16} << 20, kMostGrowth = 200;
constexpr std::size_t kMostCells = std::size_t{1} << 22;
constexpr int kMostColumns = 1 << 14, kMostSheetRows = 1 << 20;  // of the format
constexpr std::size_t kMostSheets = 1000;

// Knows of each element that is open, and gathers its text.
class PartHandler : public XmlHandler {
 public:
  Result<void> start(const XmlTag& tag) final {
    path_.emplace_back(tag.name);
    text_.clear();
    return begun(tag);
  }
  Result<void> text(std::string_view text, int) final {
    text_ += text;
    return {};
  }
  Result<void> end(int) final {
    const auto result = ended();
    path_.pop_back();
    text_.clear();
    return result;
  }

 protected:
  virtual Result<void> begun(const XmlTag& tag) = 0;
  virtual Result<void> ended() { return {}; }

  bool in(std::string_view parent, std::string_view name) const {
    return path_.size() >= 2 && path_.back() == name && path_[path_.size() - 2] == parent;
  }
  bool inside(std::string_view name) const { return std::ranges::find(path_, name) != path_.end(); }
  static std::string attribute(const XmlTag& tag, std::string_view name) {
    for (const XmlAttribute& a : tag.attributes)
      if (a.name == name) return std::string(a.value);
    return "";
  }
  const std::string& content() const { return text_; }

 private:
  std::vector<std::string> path_;
  std::string text_;
};

struct SheetPart {
  std::string name, part;
  bool is_hidden = false;
};

bool is_true(std::string_view text) {
  return text == "1" || text == "true";
}

class WorkbookHandler : public PartHandler {
 public:
  std::vector<SheetPart> sheets;  // `part` is the relation's Id
  bool since_1904 = false;

 private:
  Result<void> begun(const XmlTag& tag) override {
    if (in("workbook", "workbookPr")) since_1904 = is_true(attribute(tag, "date1904"));
    if (!in("sheets", "sheet")) return {};
    if (sheets.size() == kMostSheets) return input_error("more than {} sheets: split the workbook", kMostSheets);
    const std::string state = attribute(tag, "state");
    sheets.push_back({attribute(tag, "name"), attribute(tag, "id"), state == "hidden" || state == "veryHidden"});
    return {};
  }
};

class RelationHandler : public PartHandler {
 public:
  std::map<std::string, std::string> targets;

 private:
  Result<void> begun(const XmlTag& tag) override {
    if (in("Relationships", "Relationship")) targets[attribute(tag, "Id")] = attribute(tag, "Target");
    return {};
  }
};

class StringHandler : public PartHandler {
 public:
  std::vector<std::string> strings;

 private:
  Result<void> begun(const XmlTag&) override {
    if (!in("sst", "si")) return {};
    if (strings.size() == kMostCells) return input_error("more than {} strings: split the workbook", kMostCells);
    strings.emplace_back();
    return {};
  }
  Result<void> ended() override {
    const bool spoken = inside("rPh");  // how it is pronounced
    if (!strings.empty() && !spoken && (in("si", "t") || in("r", "t"))) strings.back() += content();
    return {};
  }
};

// True for a format of numbers that has one of the characters, in quotation marks and brackets or not at all: these are
// text. `dd.mm.yyyy` shows a date, and `0.0%` percent.
bool shows(std::string_view format, std::string_view characters) {
  char until = 0;
  for (std::size_t i = 0; i < format.size(); ++i) {
    const char c = format[i];
    if (until != 0) {
      if (c == until) until = 0;
    } else if (c == '"' || c == '[') {
      until = c == '"' ? '"' : ']';
    } else if (c == '\\') {
      ++i;
    } else if (characters.find(c) != std::string_view::npos) {
      return true;
    }
  }
  return false;
}

// How a cell shows its number.
enum class CellStyle { kNumber, kDate, kPercent };

class StyleHandler : public PartHandler {
 public:
  std::vector<CellStyle> styles;

 private:
  Result<void> begun(const XmlTag& tag) override {
    const auto number = parse_integer(attribute(tag, "numFmtId"));
    if (in("numFmts", "numFmt") && number) own_[*number] = style_of(attribute(tag, "formatCode"));
    if (in("cellXfs", "xf")) styles.push_back(number ? style_of(*number) : CellStyle::kNumber);
    return {};
  }
  static CellStyle style_of(const std::string& format) {
    return shows(format, "ymdhYMDH") ? CellStyle::kDate : shows(format, "%") ? CellStyle::kPercent : CellStyle::kNumber;
  }
  // ECMA-376 part 1, 18.8.30: these formats need not be spelled out.
  CellStyle style_of(std::int64_t number) const {
    if (const auto own = own_.find(number); own != own_.end()) return own->second;
    if ((number >= 14 && number <= 22) || (number >= 45 && number <= 47)) return CellStyle::kDate;
    return number == 9 || number == 10 ? CellStyle::kPercent : CellStyle::kNumber;
  }
  std::map<std::int64_t, CellStyle> own_;
};

struct Range {
  CellPlace first, last;
};

class SheetHandler : public PartHandler {
 public:
  SheetHandler(const std::vector<std::string>& strings, const std::vector<CellStyle>& styles, bool since_1904)
      : strings_(strings), styles_(styles), since_1904_(since_1904) {}

  Sheet sheet;

  // Gives the text of each merged range to all its cells.
  Result<void> fill_merged() {
    std::size_t visited = 0;
    for (const Range& range : merged_) {
      const auto by_number = [](const SheetRow& row, int number) { return row.number < number; };
      auto row = std::lower_bound(sheet.rows.begin(), sheet.rows.end(), range.first.row, by_number);
      if (row == sheet.rows.end() || row->number != range.first.row) continue;
      const std::string text(row->at(range.first.column));
      if (text.empty()) continue;
      for (; row != sheet.rows.end() && row->number <= range.last.row; ++row)
        for (int column = range.first.column; column <= range.last.column; ++column) {
          if (++visited > kMostCells) return too_many();
          if (row->at(column).empty()) insert(*row, column, text);
        }
    }
    return {};
  }

 private:
  static Error too_many() { return input_error("more than {} cells: split the workbook", kMostCells); }

  static void insert(SheetRow& row, int column, const std::string& text) {
    const auto at = std::ranges::lower_bound(row.cells, column, {}, &SheetCell::column);
    if (at != row.cells.end() && at->column == column)
      at->text = text;
    else
      row.cells.insert(at, {column, text});
  }

  Result<void> begun(const XmlTag& tag) override {
    if (in("sheetData", "row")) {
      const auto number = parse_integer(attribute(tag, "r"));
      const int last = sheet.rows.empty() ? 0 : sheet.rows.back().number;
      const std::int64_t own = number.value_or(last + 1);
      if (own <= last || own > kMostSheetRows) return input_error("row {} stands behind row {}", own, last);
      sheet.rows.push_back({static_cast<int>(own), {}});
      is_row_hidden_ = is_true(attribute(tag, "hidden")), is_row_empty_ = true;
      column_ = -1;
    } else if (in("row", "c") && !sheet.rows.empty()) {
      const std::string reference = attribute(tag, "r");
      int column = column_ + 1;
      if (!reference.empty()) {
        GONIO_ASSIGN(const CellPlace place, cell_place(reference));
        column = place.column;
      }
      if (column <= column_ || column >= kMostColumns) return input_error("cell {} is not in order", reference);
      column_ = column;
      type_ = attribute(tag, "t"), value_.clear();
      const auto style = parse_integer(attribute(tag, "s"));
      const bool known = style && *style >= 0 && *style < static_cast<std::int64_t>(styles_.size());
      style_ = known ? styles_[static_cast<std::size_t>(*style)] : CellStyle::kNumber;
      is_formula_ = has_value_ = false;
    } else if (in("c", "f")) {
      is_formula_ = true;
    } else if (in("mergeCells", "mergeCell")) {
      const std::string reference = attribute(tag, "ref");
      const auto colon = reference.find(':');
      if (colon == std::string::npos) return {};
      GONIO_ASSIGN(const CellPlace first, cell_place(std::string_view(reference).substr(0, colon)));
      GONIO_ASSIGN(const CellPlace last, cell_place(std::string_view(reference).substr(colon + 1)));
      if (merged_.size() == kMostCells) return too_many();
      merged_.push_back({first, last});
    }
    return {};
  }

  Result<void> ended() override {
    if (in("c", "v")) value_ = content(), has_value_ = true;
    if (inside("is") && !inside("rPh") && (in("is", "t") || in("r", "t"))) value_ += content(), has_value_ = true;
    if (in("row", "c") && !sheet.rows.empty()) return end_cell();
    return {};
  }

  Result<void> end_cell() {
    sheet.formulas_without_value += is_formula_ && !has_value_;
    if (!has_value_) return {};
    if (type_ == "s") {
      const auto index = parse_integer(trimmed(value_));
      if (!index || *index < 0 || *index >= static_cast<std::int64_t>(strings_.size()))
        return input_error("row {}: a cell has the text number {}, and the workbook has {} texts: it is damaged",
                           sheet.rows.back().number, shown(value_), strings_.size());
      value_ = strings_[static_cast<std::size_t>(*index)];
    } else if (type_ == "b") {
      value_ = trimmed(value_) == "0" ? "FALSE" : "TRUE";
    } else if (style_ != CellStyle::kNumber && (type_.empty() || type_ == "n")) {
      if (const auto number = parse_number(trimmed(value_)))
        value_ = style_ == CellStyle::kDate ? date_text(*number, since_1904_) : shortest(100 * *number) + "%";
    }
    const std::string_view text = trimmed(value_);
    if (text.empty()) return {};
    if (++cells_ > kMostCells) return too_many();
    sheet.hidden_rows += is_row_hidden_ && is_row_empty_;
    is_row_empty_ = false;
    sheet.rows.back().cells.push_back({column_, std::string(text)});
    return {};
  }

  const std::vector<std::string>& strings_;
  const std::vector<CellStyle>& styles_;
  bool since_1904_;
  std::vector<Range> merged_;
  std::size_t cells_ = 0;
  int column_ = -1;
  std::string type_, value_;
  CellStyle style_ = CellStyle::kNumber;
  bool is_formula_ = false, has_value_ = false, is_row_hidden_ = false, is_row_empty_ = true;
};

}  // namespace

std::string_view SheetRow::at(int column) const {
  const auto found = std::ranges::lower_bound(cells, column, {}, &SheetCell::column);
  return found != cells.end() && found->column == column ? std::string_view(found->text) : std::string_view();
}

Result<CellPlace> cell_place(std::string_view reference) {
  CellPlace place{-1, 0};
  std::size_t i = 0;
  for (; i < reference.size() && reference[i] >= 'A' && reference[i] <= 'Z' && place.column < kMostColumns; ++i)
    place.column = 26 * (place.column + 1) + (reference[i] - 'A');
  const auto row = parse_integer(reference.substr(i));
  if (place.column < 0 || place.column >= kMostColumns || !row || *row < 1 || *row > kMostSheetRows)
    return input_error("a cell is called \"{}\": the workbook is damaged", shown(reference));
  place.row = static_cast<int>(*row);
  return place;
}

std::string date_text(double days, bool since_1904) {
  using namespace std::chrono;
  constexpr double kOf1904 = 1462;  // days later
  if (since_1904) days += kOf1904;
  constexpr double kLastDay = 2958466;  // the year 10000
  if (!(days >= 0 && days < kLastDay)) return shortest(days);
  // Day 60 would be February 29 of 1900, which was none; from March on, day 1 was December 31 of 1899.
  const auto rounded = static_cast<std::int64_t>(std::llround(days * 86400));
  const sys_seconds time = sys_days(year(1899) / 12 / 30) + seconds(rounded);
  const year_month_day date(floor<std::chrono::days>(time));
  const hh_mm_ss clock(time - floor<std::chrono::days>(time));
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02}:{:02}", int(date.year()), unsigned(date.month()),
                     unsigned(date.day()), clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

struct Spreadsheet::State {
  std::string name;
  std::optional<ZipArchive> archive;
  std::vector<SheetPart> sheets;
  std::vector<std::string> strings;
  std::vector<CellStyle> styles;
  bool since_1904 = false;

  bool has(const std::string& part) const { return archive->part(part).has_value(); }

  // Unpacks a part and tells `handler`. `called` is what errors name.
  Result<void> read(const std::string& part, const std::string& called, PartHandler& handler) const {
    const auto about = archive->part(part);
    if (!about)
      return input_error("{}: the workbook has no part {}: it is damaged, save it again", called, shown(part));
    if (about->is_encrypted) return input_error("{}: the workbook is encrypted: save it without a password", called);
    const auto unpacking = archive->unpacking(part);
    if (!unpacking.ok())
      return input_error("{}: {} cannot be unpacked ({}): save the workbook again", called, shown(part),
                         unpacking.error().message);
    const std::size_t most = std::max<std::size_t>(kAnySize, kMostGrowth * about->packed_bytes);
    std::size_t unpacked = 0;
    const XmlBytes bytes_of = [&](std::string& buffer, std::size_t wanted) -> Result<std::size_t> {
      const auto got = (*unpacking)(buffer, wanted);
      if (!got.ok()) return input_error("{}: {} is damaged or cut off: save the workbook again", called, shown(part));
      if ((unpacked += *got) > most)
        return input_error("{}: {} unpacks to more than {} times its size: that is no table of measurements", called,
                           shown(part), kMostGrowth);
      return *got;
    };
    XmlStream stream(called, bytes_of, handler);
    const auto result = stream.finish();
    if (result.ok() || result.error().message.starts_with(called)) return result;
    return input_error("{}: {}", called, result.error().message);
  }

  Result<void> read_frame();
};

Result<void> Spreadsheet::State::read_frame() {
  WorkbookHandler workbook;
  RelationHandler relations;
  StringHandler texts;
  StyleHandler formats;
  if (!has("xl/workbook.xml"))
    return input_error("{}: is a ZIP archive without a workbook (XLSX): unpack it, and give what is in it", name);
  GONIO_TRY(read("xl/workbook.xml", name, workbook));
  GONIO_TRY(read("xl/_rels/workbook.xml.rels", name, relations));
  if (has("xl/sharedStrings.xml")) GONIO_TRY(read("xl/sharedStrings.xml", name, texts));
  if (has("xl/styles.xml")) GONIO_TRY(read("xl/styles.xml", name, formats));
  sheets = std::move(workbook.sheets), strings = std::move(texts.strings);
  styles = std::move(formats.styles), since_1904 = workbook.since_1904;
  for (SheetPart& sheet : sheets) {
    // Relative to the folder xl, or absolute. Parts are looked up in the archive alone, so that no name leads out of
    // it.
    const std::string target = relations.targets[sheet.part];
    sheet.part = target.starts_with('/') ? target.substr(1) : "xl/" + target;
  }
  return {};
}

Spreadsheet::Spreadsheet(std::unique_ptr<State> state) : state_(std::move(state)) {}
Spreadsheet::Spreadsheet(Spreadsheet&&) noexcept = default;
Spreadsheet::~Spreadsheet() = default;

Result<Spreadsheet> Spreadsheet::open(InputFile input) {
  auto state = std::make_unique<State>();
  state->name = input.name();
  GONIO_ASSIGN(std::string bytes, input.rest(kLargestBook));
  if (bytes.starts_with("\xd0\xcf\x11\xe0"))
    return input_error(
        "{}: is an old workbook (XLS), or one that is encrypted: save it as XLSX (Office Open XML), without a password",
        state->name);
  state->archive = ZipArchive::open(state->name, std::move(bytes));
  if (!state->archive) return input_error("{}: the workbook is damaged or cut off: save it again", state->name);
  GONIO_TRY(state->read_frame());
  return Spreadsheet(std::move(state));
}

std::size_t Spreadsheet::sheet_count() const {
  return state_->sheets.size();
}

Result<Sheet> Spreadsheet::sheet(std::size_t index) {
  const SheetPart& about = state_->sheets[index];
  SheetHandler handler(state_->strings, state_->styles, state_->since_1904);
  handler.sheet.name = about.name, handler.sheet.is_hidden = about.is_hidden;
  const std::string called = fmt::format("{}: sheet \"{}\"", state_->name, shown(about.name));
  GONIO_TRY(state_->read(about.part, called, handler));
  if (const auto filled = handler.fill_merged(); !filled.ok())
    return input_error("{}: {}", called, filled.error().message);
  std::erase_if(handler.sheet.rows, [](const SheetRow& row) { return row.cells.empty(); });
  return std::move(handler.sheet);
}

}  // namespace goniochrome::formats
