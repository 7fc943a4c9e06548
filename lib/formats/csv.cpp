#include "formats/csv.h"

#include <algorithm>
#include <array>

#include "base/text.h"
#include "formats/imported.h"
#include "formats/xml.h"

namespace goniochrome::formats {

namespace {

constexpr const char* kLongHeader = "sample,geometry,illuminant,observer,L,a,b";
constexpr std::size_t kChunk = 1 << 16;
constexpr std::size_t kLongestRecord = 1 << 20;  // in a longer one a quotation mark was left open
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// The records of a table: cells between separators, quoted or not, whatever the ends of lines are.
class CsvRecords {
 public:
  explicit CsvRecords(InputFile input) : input_(std::move(input)) {}

  // Reads the next record that is not blank into `cells`. White space around cells and the quotes of quoted cells are
  // taken off. Returns false at the end. The first record fixes the separator: `;` if it holds one, or else a tab, or
  // else `,`. Error: file and line; it is final where the record does not end.
  Result<bool> next(std::vector<std::string>& cells);

  // The line (from 1) on which the last record began.
  int line() const { return line_; }
  char separator() const { return separator_; }
  const std::string& name() const { return input_.name(); }
  Error error(std::string_view what) const { return input_error("{}:{}: {}", name(), line_, what); }

 private:
  Result<bool> next_line();
  Result<bool> fill();

  InputFile input_;
  std::string buffer_;
  std::size_t at_ = 0;
  std::string record_;
  int line_ = 0, lines_read_ = 0;
  char separator_ = 0;
  bool failed_ = false;
};

bool quotes_closed(std::string_view text) {
  return std::ranges::count(text, '"') % 2 == 0;
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

// Appends the next bytes to the buffer, less what was used. False at the end of the input.
Result<bool> CsvRecords::fill() {
  buffer_.erase(0, at_);
  at_ = 0;
  GONIO_ASSIGN(const std::size_t count, input_.read(buffer_, kChunk));
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

Result<bool> CsvRecords::next(std::vector<std::string>& cells) {
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
  } while (trimmed(record_).empty());
  failed_ = false;
  if (separator_ == 0) {
    if (record_.starts_with(kByteOrderMark)) record_.erase(0, kByteOrderMark.size());
    if (record_.starts_with("\xff\xfe") || record_.starts_with("\xfe\xff"))
      return failed_ = true, error("the table is UTF-16: save it as CSV UTF-8");
    separator_ = separator_of(record_);
  }
  if (!is_plain_utf8(record_)) return error("a character is not valid UTF-8: save the table as CSV UTF-8");
  cells.clear();
  for (std::size_t at = 0; at <= record_.size();) cells.push_back(cell_at(record_, at, separator_));
  return true;
}

std::string doubled_quotes(std::string_view text) {
  std::string doubled;
  for (const char c : text) doubled += c == '"' ? "\"\"" : std::string(1, c);
  return doubled;
}

// Whether a spreadsheet would take the text for a formula and work it out. Apostrophes before one count as part of it,
// so that one more can be taken off again.
bool looks_like_formula(std::string_view text) {
  text.remove_prefix(std::min(text.find_first_not_of('\''), text.size()));
  return !text.empty() && std::string_view("=+-@").find(text.front()) != std::string_view::npos;
}

// A text that is none of our numbers as its cell says it, without the apostrophe that marks it as text.
std::string_view cell_text(std::string_view cell) {
  return cell.starts_with('\'') && looks_like_formula(cell) ? cell.substr(1) : cell;
}

// One text as it is written between commas: quoted if any reader might take it apart, and behind an apostrophe if a
// spreadsheet would take it for a formula.
std::string csv_cell(std::string_view text) {
  if (looks_like_formula(text)) return "\"'" + doubled_quotes(text) + '"';
  if (text.find_first_of(",;\t\"\r\n") == std::string_view::npos && trimmed(text) == text) return std::string(text);
  return '"' + doubled_quotes(text) + '"';
}

// The columns that have names of their own.
enum Column {
  kSample,
  kGeometry,
  kIlluminant,
  kObserver,
  kL,
  kA,
  kB,
  kClass,
  kCode,
  kInstrument,
  kGloss20,
  kGloss60,
  kGloss85,
  kOrigin,
  kColumns
};
constexpr std::array<std::string_view, kColumns> kNames = {
    "sample", "geometry", "illuminant", "observer", "l",       "a",       "b",
    "class",  "code",     "instrument", "gloss20",  "gloss60", "gloss85", "origin"};

// A heading in lower case and without what spreadsheets add: `L*`, `L_15`, `L (15)`.
std::string plain_heading(std::string_view heading) {
  std::string text = lower(heading);
  std::erase_if(text, [](char c) { return c == '*' || c == '_' || c == ' ' || c == '(' || c == ')'; });
  return text == "name" || text == "paint" ? "sample" : text == "gloss" ? "gloss60" : text;
}

// Lab of one geometry in a wide table: where its three columns are.
struct Triple {
  paint::Geometry geometry;
  std::array<int, 3> column = {-1, -1, -1};
};

// What the columns of a table mean.
struct Header {
  std::vector<std::string> headings;  // as written
  std::array<int, kColumns> column;
  std::vector<Triple> triples;
  std::vector<std::string> unknown;
  bool is_wide() const { return column[kGeometry] < 0; }
};

// Notes the column of a heading like `L45as15`. Error: the same column is there twice.
Result<bool> take_triple(Header& header, const std::string& heading, int index) {
  const auto channel = std::string_view("lab").find(heading.front());
  if (channel == std::string_view::npos || heading.size() < 2) return false;
  const auto geometry = paint::parse_geometry(std::string_view(heading).substr(1));
  if (!geometry.ok()) return false;
  auto triple = std::ranges::find(header.triples, *geometry, &Triple::geometry);
  if (triple == header.triples.end()) triple = header.triples.insert(triple, {*geometry});
  if (triple->column[channel] >= 0)
    return input_error("two columns are named {}: keep one", shown(header.headings[index]));
  triple->column[channel] = index;
  return true;
}

Result<Header> header_of(const std::vector<std::string>& cells) {
  Header header;
  header.headings = cells;
  header.column.fill(-1);
  for (int i = 0; i < static_cast<int>(cells.size()); ++i) {
    const std::string heading = plain_heading(cells[i]);
    const auto known = std::ranges::find(kNames, heading);
    if (known != kNames.end()) {
      int& column = header.column[known - kNames.begin()];
      if (column >= 0) return input_error("two columns are named {}: keep one", shown(cells[i]));
      column = i;
      continue;
    }
    if (heading.empty()) continue;
    GONIO_ASSIGN(const bool taken, take_triple(header, heading, i));
    if (!taken) header.unknown.push_back(cells[i]);
  }
  if (header.column[kSample] < 0) return input_error("the header has no column \"sample\": begin with {}", kLongHeader);
  if (!header.is_wide()) {
    for (const Column channel : {kL, kA, kB})
      if (header.column[channel] < 0)
        return input_error("the header has no column \"{}\": begin with {}", "Lab"[channel - kL], kLongHeader);
    return header;
  }
  if (header.triples.empty())
    return input_error("the header has neither a column \"geometry\" nor columns like L15, a15, b15: begin with {}",
                       kLongHeader);
  for (const Triple& triple : header.triples)
    for (int c = 0; c < 3; ++c)
      if (triple.column[c] < 0)
        return input_error("the header has no column {}{}: give L, a and b of every geometry", "Lab"[c],
                           paint::geometry_name(triple.geometry));
  return header;
}

// Leaves the rows that are not from the curve, if there are any.
void drop_curve(paint::Measurement& measurement, const std::vector<paint::Geometry>& from_curve) {
  if (from_curve.size() >= measurement.rows.size()) return;
  std::erase_if(measurement.rows, [&](const paint::LabReading& row) {
    return std::ranges::find(from_curve, row.geometry) != from_curve.end();
  });
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", shown(word));
  return text;
}

}  // namespace

struct CsvPaintReader::State {
  explicit State(InputFile input) : records(std::move(input)) {}

  Result<void> read_header();
  Result<std::optional<paint::Paint>> next_wide();
  Result<std::optional<paint::Paint>> next_long();

  Result<void> check_width() const;
  std::string_view text(int column) const { return column < 0 ? std::string_view() : cell_text(cells[column]); }
  Result<double> number(int column, Domain domain = Domain::kAny) const;
  Result<color::Lab> lab(const std::array<int, 3>& columns) const;
  Result<color::ViewingCondition> condition() const;
  Result<paint::Paint> described() const;
  Result<void> add_row();
  Result<std::vector<paint::Geometry>> curve_geometries() const;
  Result<void> agree(const paint::Paint& row) const;
  Error error(std::string_view what) const { return records.error(what); }

  CsvRecords records;
  Header header;
  std::vector<std::string> cells, warnings;
  NameLedger names;
  int line = 0;

  // Long tables: the sample whose rows are being collected.
  std::optional<paint::Paint> open;
  int open_line = 0;
  std::vector<int> row_lines;
  std::vector<paint::Geometry> from_curve;
  std::string skipped;  // a sample that was there before: its rows are passed over
};

Result<void> CsvPaintReader::State::read_header() {
  GONIO_ASSIGN(const bool found, records.next(cells));
  if (!found) return input_error("{}: is empty: begin with {}", records.name(), kLongHeader);
  auto parsed = header_of(cells);
  if (!parsed.ok()) return error(parsed.error().message);
  header = std::move(*parsed);
  if (!header.unknown.empty())
    warnings.push_back(fmt::format("{}: the columns {} are not read", records.name(), listed(header.unknown)));
  if (header.column[kIlluminant] < 0 || header.column[kObserver] < 0)
    warnings.push_back(
        fmt::format("{}: there are no columns illuminant and observer: taken as D65 and 10 deg", records.name()));
  return {};
}

Result<void> CsvPaintReader::State::check_width() const {
  if (cells.size() == header.headings.size()) return {};
  const bool comma = records.separator() == ',' && cells.size() > header.headings.size();
  return error(fmt::format("the row has {} cells and the header {}: {}", cells.size(), header.headings.size(),
                           comma ? "write decimal points, or separate the cells by ;" : "fill or remove cells"));
}

// A comma is read as a decimal point where it cannot be a separator.
Result<double> CsvPaintReader::State::number(int column, Domain domain) const {
  std::string cell = cells[column];
  if (records.separator() != ',') cell = with_decimal_point(cell).value_or(cell);
  const auto value = number_in(cell, domain);
  if (!value.ok()) return error(fmt::format("{} {}", shown(header.headings[column]), value.error().message));
  return *value;
}

Result<color::Lab> CsvPaintReader::State::lab(const std::array<int, 3>& columns) const {
  color::Lab value;
  GONIO_ASSIGN(value.L, number(columns[0], Domain::kLab));
  GONIO_ASSIGN(value.a, number(columns[1], Domain::kLab));
  GONIO_ASSIGN(value.b, number(columns[2], Domain::kLab));
  return value;
}

Result<color::ViewingCondition> CsvPaintReader::State::condition() const {
  color::ViewingCondition condition;
  if (header.column[kIlluminant] >= 0) condition.illuminant = text(header.column[kIlluminant]);
  if (condition.illuminant.empty()) return error("illuminant is empty: write D65, A or another one");
  if (header.column[kObserver] < 0) return condition;
  const auto observer = observer_in(text(header.column[kObserver]));
  if (!observer.ok()) return error("observer " + observer.error().message);
  condition.observer_deg = *observer;
  return condition;
}

// Everything that a row says of its paint except the Lab values.
Result<paint::Paint> CsvPaintReader::State::described() const {
  paint::Paint paint;
  paint.name = text(header.column[kSample]);
  if (paint.name.empty()) return error("sample is empty: name every row");
  GONIO_ASSIGN(color::ViewingCondition viewing, condition());
  paint.measurement = paint::Measurement{std::move(viewing), std::string(text(header.column[kInstrument])), {}};
  paint.code = text(header.column[kCode]);
  if (const auto name = text(header.column[kClass]); !name.empty()) {
    const auto paint_class = class_in(lower(name));
    if (!paint_class.ok()) return error("class " + paint_class.error().message);
    paint.paint_class = *paint_class;
  }
  constexpr std::array kMeters = {std::pair{kGloss20, 20.0}, std::pair{kGloss60, 60.0}, std::pair{kGloss85, 85.0}};
  for (const auto& [column, angle_deg] : kMeters) {
    if (text(header.column[column]).empty()) continue;
    GONIO_ASSIGN(const double gloss, number(header.column[column], Domain::kNotNegative));
    paint.gloss.push_back({angle_deg, gloss});
  }
  return paint;
}

Result<std::optional<paint::Paint>> CsvPaintReader::State::next_wide() {
  GONIO_ASSIGN(const bool found, records.next(cells));
  if (!found) return std::optional<paint::Paint>();
  GONIO_TRY(check_width());
  GONIO_ASSIGN(paint::Paint paint, described());
  if (const auto before = names.note(paint.name, records.line()))
    return error(fmt::format("sample \"{}\" is already at line {}: rename one of them", shown(paint.name), *before));
  for (const Triple& triple : header.triples) {
    if (std::ranges::all_of(triple.column, [&](int column) { return cells[column].empty(); })) continue;
    GONIO_ASSIGN(const color::Lab value, lab(triple.column));
    paint.measurement->rows.push_back({triple.geometry, value});
  }
  if (paint.measurement->rows.empty()) return error(fmt::format("sample \"{}\" has no Lab values", shown(paint.name)));
  GONIO_ASSIGN(const std::vector<paint::Geometry> curve, curve_geometries());
  drop_curve(*paint.measurement, curve);
  line = records.line();
  return std::optional(std::move(paint));
}

// The geometries that the column origin of a wide table lists, separated by white space.
Result<std::vector<paint::Geometry>> CsvPaintReader::State::curve_geometries() const {
  std::vector<paint::Geometry> geometries;
  for (const std::string_view word : split(text(header.column[kOrigin]), ' ')) {
    if (word.empty()) continue;
    const auto geometry = paint::parse_geometry(word);
    if (!geometry.ok()) return error("origin: " + geometry.error().message);
    geometries.push_back(*geometry);
  }
  return geometries;
}

// Error: a further row says something else of the open sample than its first row. It may say nothing.
Result<void> CsvPaintReader::State::agree(const paint::Paint& row) const {
  const auto differs = [&](const char* what) {
    return error(
        fmt::format("sample \"{}\" has another {} than on line {}: a paint has one; give the others names of "
                    "their own",
                    shown(row.name), what, open_line));
  };
  const auto conflict = [](const std::string& later, const std::string& first) {
    return !later.empty() && later != first;
  };
  if (!(row.measurement->condition == open->measurement->condition)) return differs("illuminant or observer");
  if (conflict(row.measurement->instrument, open->measurement->instrument)) return differs("instrument");
  if (conflict(row.code, open->code)) return differs("code");
  if (row.paint_class != paint::PaintClass::kUnknown && row.paint_class != open->paint_class) return differs("class");
  for (const paint::GlossReading& gloss : row.gloss) {
    const auto first = std::ranges::find(open->gloss, gloss.angle_deg, &paint::GlossReading::angle_deg);
    if (first == open->gloss.end() || first->gloss_units != gloss.gloss_units) return differs("gloss");
  }
  return {};
}

// Takes the row in `cells` into the open sample, or opens one with it.
Result<void> CsvPaintReader::State::add_row() {
  GONIO_ASSIGN(paint::Paint row, described());
  if (open) {
    GONIO_TRY(agree(row));
  } else if (const auto before = names.note(row.name, records.line())) {
    skipped = row.name;
    return error(fmt::format("sample \"{}\" is already at line {}: put its rows together, or rename it",
                             shown(row.name), *before));
  } else {
    open = std::move(row);
    open_line = records.line();
    row_lines.clear();
    from_curve.clear();
  }
  auto geometry = paint::parse_geometry(text(header.column[kGeometry]));
  if (!geometry.ok()) return error(geometry.error().message);
  auto& rows = open->measurement->rows;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].geometry == *geometry)
      return error(fmt::format("geometry {} of sample \"{}\" is already at line {}: keep one, or give the mean",
                               paint::geometry_name(*geometry), shown(open->name), row_lines[i]));
  if (rows.size() >= kMostRows) return error(fmt::format("more than {} rows in one sample: split it", kMostRows));
  GONIO_ASSIGN(const color::Lab value, lab({header.column[kL], header.column[kA], header.column[kB]}));
  const std::string origin = lower(text(header.column[kOrigin]));
  if (!origin.empty() && origin != "row" && origin != "curve")
    return error(fmt::format("origin is \"{}\": write row, or curve for what a curve says", shown(origin)));
  if (origin == "curve") from_curve.push_back(*geometry);
  rows.push_back({*geometry, value});
  row_lines.push_back(records.line());
  return {};
}

// Collects rows until one of another sample comes. That row stays in `cells` for the next call.
Result<std::optional<paint::Paint>> CsvPaintReader::State::next_long() {
  for (;;) {
    if (cells.empty()) {
      GONIO_ASSIGN(const bool found, records.next(cells));
      if (!found) cells.clear();
    }
    const bool at_end = cells.empty();
    const Result<void> width = at_end ? Result<void>() : check_width();
    const std::string name = at_end || !width.ok() ? "" : std::string(text(header.column[kSample]));
    if (open && width.ok() && name != open->name) {
      paint::Paint paint = *std::exchange(open, std::nullopt);
      line = open_line;
      drop_curve(*paint.measurement, from_curve);
      if (!paint.measurement->rows.empty()) return std::optional(std::move(paint));
    }
    if (at_end) return std::optional<paint::Paint>();
    Result<void> added = width;
    if (width.ok() && (name.empty() || name != skipped)) {
      skipped.clear();
      added = add_row();
    }
    cells.clear();
    if (!added.ok()) return added.error();
  }
}

Result<CsvPaintReader> CsvPaintReader::open(const std::string& path) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  return open(std::move(input));
}

Result<CsvPaintReader> CsvPaintReader::open(InputFile input) {
  auto state = std::make_unique<State>(std::move(input));
  GONIO_TRY(state->read_header());
  state->cells.clear();
  return CsvPaintReader(std::move(state));
}

CsvPaintReader::CsvPaintReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
CsvPaintReader::CsvPaintReader(CsvPaintReader&&) noexcept = default;
CsvPaintReader::~CsvPaintReader() = default;

Result<std::optional<paint::Paint>> CsvPaintReader::next() {
  return is_wide() ? state_->next_wide() : state_->next_long();
}

int CsvPaintReader::line() const {
  return state_->line;
}

bool CsvPaintReader::is_wide() const {
  return state_->header.is_wide();
}

const std::vector<std::string>& CsvPaintReader::warnings() const {
  return state_->warnings;
}

namespace {

constexpr const char* kOtherColumns = ",class,code,instrument,gloss20,gloss60,gloss85";

std::string lab_cells(const color::Lab& lab) {
  return fmt::format(",{},{},{}", shortest(lab.L), shortest(lab.a), shortest(lab.b));
}

// A heading's geometry: the aspecular angle alone in the plane of 45 deg incidence.
std::string column_name(const paint::Geometry& geometry) {
  const bool usual = geometry.incidence_deg == 45 && !geometry.out_of_plane && !geometry.reversed;
  return usual ? shortest(geometry.aspecular_deg) : paint::geometry_name(geometry);
}

std::string listed_names(const std::vector<paint::Geometry>& geometries) {
  std::string text;
  for (const paint::Geometry& geometry : geometries) text += (text.empty() ? "" : " ") + paint::geometry_name(geometry);
  return text;
}

std::string other_cells(const paint::Paint& paint) {
  std::string text = fmt::format(",{},{},{}", paint::paint_class_name(paint.paint_class), csv_cell(paint.code),
                                 csv_cell(paint.measurement->instrument));
  for (const double angle_deg : {20.0, 60.0, 85.0}) {
    const auto gloss = std::ranges::find(paint.gloss, angle_deg, &paint::GlossReading::angle_deg);
    text += "," + (gloss == paint.gloss.end() ? "" : shortest(gloss->gloss_units));
  }
  return text;
}

}  // namespace

Result<CsvPaintWriter> CsvPaintWriter::begin(OutputFile file, const CsvLayout& layout) {
  std::string head = layout.wide.empty() ? kLongHeader : "sample,illuminant,observer";
  for (const paint::Geometry& geometry : layout.wide) {
    const std::string name = column_name(geometry);
    head += fmt::format(",L{},a{},b{}", name, name, name);
  }
  if (layout.all_columns) head += kOtherColumns;
  if (layout.origin) head += ",origin";
  CsvPaintWriter writer(std::move(file), layout);
  GONIO_TRY(writer.file_.write(head + "\n"));
  return writer;
}

Result<void> CsvPaintWriter::write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve) {
  if (!paint.measurement || paint.measurement->rows.empty())
    return input_error("paint \"{}\" has no Lab values: a table cannot hold it", shown(paint.name));
  GONIO_TRY(check_writable(paint));
  const auto& [condition, instrument, rows, spectra] = *paint.measurement;
  const std::string viewing = fmt::format(",{},{}", csv_cell(condition.illuminant), condition.observer_deg);
  const std::string others = layout_.all_columns ? other_cells(paint) : "";
  std::string text;
  if (layout_.wide.empty()) {
    for (const paint::LabReading& row : rows) {
      const bool curve = std::ranges::find(from_curve, row.geometry) != from_curve.end();
      text += csv_cell(paint.name) + "," + paint::geometry_name(row.geometry) + viewing + lab_cells(row.lab) + others;
      text += layout_.origin ? curve ? ",curve\n" : ",row\n" : "\n";
    }
  } else {
    std::size_t placed = 0;
    text = csv_cell(paint.name) + viewing;
    for (const paint::Geometry& geometry : layout_.wide) {
      const auto row = std::ranges::find(rows, geometry, &paint::LabReading::geometry);
      placed += row != rows.end();
      text += row == rows.end() ? ",,," : lab_cells(row->lab);
    }
    if (placed < rows.size())
      return input_error("paint \"{}\" has rows at geometries that the table has no columns for", shown(paint.name));
    text += others + (layout_.origin ? "," + listed_names(from_curve) : "") + "\n";
  }
  GONIO_TRY(file_.write(text));
  return is_stream_ ? file_.flush() : Result<void>();
}

Result<void> CsvPaintWriter::finish() {
  return file_.commit();
}

}  // namespace goniochrome::formats
