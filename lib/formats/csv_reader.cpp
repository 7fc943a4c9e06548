#include <algorithm>
#include <array>

#include "base/text.h"
#include "base/utf8.h"
#include "formats/csv.h"
#include "formats/internal/csv_records.h"
#include "formats/internal/xml_values.h"
#include "formats/name_ledger.h"
#include "formats/xml.h"

namespace goniochrome::formats {

namespace {

constexpr const char* kLongHeader = "sample,geometry,illuminant,observer,L,a,b";

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
  kColumns
};
constexpr std::array<std::string_view, kColumns> kNames = {
    "sample", "geometry", "illuminant", "observer", "l",       "a",      "b",
    "class",  "code",     "instrument", "gloss20",  "gloss60", "gloss85"};

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
    const auto* known = std::ranges::find(kNames, heading);
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
  std::string_view text(int column) const { return column < 0 ? std::string_view() : std::string_view(cells[column]); }
  Result<double> number(int column, Domain domain = Domain::kAny) const;
  Result<color::Lab> lab(const std::array<int, 3>& columns) const;
  Result<color::ViewingCondition> condition() const;
  Result<paint::Paint> described() const;
  Result<void> add_row();
  Result<void> agree(const paint::Paint& row) const;
  Error error(std::string_view what) const { return input_error("{}:{}: {}", records.name(), records.line(), what); }

  CsvRecords records;
  Header header;
  std::vector<std::string> cells, warnings;
  NameLedger names;
  int line = 0;

  // Long tables: the sample whose rows are being collected.
  std::optional<paint::Paint> open;
  int open_line = 0;
  std::vector<int> row_lines;
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

// A decimal comma is read where it cannot be a separator.
Result<double> CsvPaintReader::State::number(int column, Domain domain) const {
  std::string cell = cells[column];
  const bool decimal_comma = std::ranges::count(cell, ',') == 1 && cell.find('.') == std::string::npos;
  if (records.separator() != ',' && decimal_comma) cell[cell.find(',')] = '.';
  auto value = number_in(cell, domain);
  if (!value.ok()) return error(fmt::format("{} {}", shown(header.headings[column]), value.error().message));
  return *value;
}

Result<color::Lab> CsvPaintReader::State::lab(const std::array<int, 3>& columns) const {
  color::Lab value;
  GONIO_ASSIGN(value.L, number(columns[0]));
  GONIO_ASSIGN(value.a, number(columns[1]));
  GONIO_ASSIGN(value.b, number(columns[2]));
  return value;
}

Result<color::ViewingCondition> CsvPaintReader::State::condition() const {
  color::ViewingCondition condition;
  if (header.column[kIlluminant] >= 0) condition.illuminant = text(header.column[kIlluminant]);
  if (condition.illuminant.empty()) return error("illuminant is empty: write D65, A, ...");
  if (header.column[kObserver] < 0) return condition;
  const std::string_view observer = text(header.column[kObserver]);
  if (observer != "2" && observer != "10")
    return error(fmt::format("observer is \"{}\": write 2 or 10 (degrees)", shown(observer)));
  condition.observer_deg = observer == "2" ? 2 : 10;
  return condition;
}

// All that a row says of its paint but the Lab values.
Result<paint::Paint> CsvPaintReader::State::described() const {
  paint::Paint paint;
  paint.name = text(header.column[kSample]);
  if (paint.name.empty()) return error("sample is empty: name every row");
  GONIO_ASSIGN(color::ViewingCondition viewing, condition());
  paint.measurement = paint::Measurement{std::move(viewing), std::string(text(header.column[kInstrument])), {}};
  paint.code = text(header.column[kCode]);
  if (const auto name = text(header.column[kClass]); !name.empty()) {
    const auto paint_class = paint::paint_class_of(lower(name));
    if (!paint_class)
      return error(fmt::format("class is \"{}\": write solid, metallic, pearl, interference or unknown", shown(name)));
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
  line = records.line();
  return std::optional(std::move(paint));
}

// Whether a further row says nothing else of the open sample than its first row; it may say nothing.
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
  rows.push_back({*geometry, value});
  row_lines.push_back(records.line());
  return {};
}

// Collects rows until one of another sample comes; that one stays in `cells` for the next call.
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

}  // namespace goniochrome::formats
