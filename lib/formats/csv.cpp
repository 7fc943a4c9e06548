#include "formats/csv.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "formats/imported.h"
#include "formats/internal/csv_records.h"
#include "formats/internal/spectral_rows.h"
#include "formats/xml.h"

namespace goniochrome::formats {

namespace {

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

// The words of other programs for these columns.
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> kOtherNames = {{
    {"name", "sample"},
    {"paint", "sample"},
    {"samplename", "sample"},
    {"probe", "sample"},
    {"muster", "sample"},
    {"bezeichnung", "sample"},
    {"farbe", "sample"},
    {"farbton", "sample"},
    {"geometrie", "geometry"},
    {"winkel", "geometry"},
    {"messwinkel", "geometry"},
    {"lichtart", "illuminant"},
    {"normlichtart", "illuminant"},
    {"beobachter", "observer"},
    {"normalbeobachter", "observer"},
    {"gloss", "gloss60"},
}};

// An angle without the degree sign that instruments add: `-15°`.
std::string without_degree_sign(std::string_view angle) {
  std::string text(angle);
  for (auto at = text.find("\xc2\xb0"); at != std::string::npos; at = text.find("\xc2\xb0")) text.erase(at, 2);
  return std::string(trimmed(text));
}

// A heading in lower case and without what spreadsheets and instruments add: `L*`, `L_15`, `L (15)`, `15° L*`,
// `15°:L*`.
std::string plain_heading(std::string_view heading) {
  std::string text = without_degree_sign(lower(heading));
  std::erase_if(text, [](char c) { return c == '*' || c == '_' || c == ' ' || c == '(' || c == ')' || c == ':'; });
  const bool angle_first = text.size() > 1 && (text[0] == '-' || (text[0] >= '0' && text[0] <= '9'));
  if (angle_first && std::string_view("lab").find(text.back()) != std::string_view::npos)
    std::rotate(text.begin(), text.end() - 1, text.end());
  const auto* other = std::ranges::find(kOtherNames, text, &std::pair<std::string_view, std::string_view>::first);
  return other != kOtherNames.end() ? std::string(other->second) : text;
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
  std::vector<WavelengthColumn> wavelengths;  // five or more, or none
  std::vector<std::string> unknown;
  std::string taken_for_sample;  // the heading of the first column, where no heading says where the names are
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
    if (taken) continue;
    if (const auto nm = wavelength_in(cells[i]))
      header.wavelengths.push_back({*nm, i});
    else
      header.unknown.push_back(cells[i]);
  }
  if (header.wavelengths.size() < kFewestWavelengths) {
    for (const WavelengthColumn& column : header.wavelengths)
      header.unknown.push_back(cells[static_cast<std::size_t>(column.at)]);
    header.wavelengths.clear();
  }
  GONIO_TRY(check_steps(header.wavelengths));
  const bool has_colors = header.column[kGeometry] >= 0 || !header.triples.empty();
  const bool first_is_free = cells[0].empty() || (!header.unknown.empty() && header.unknown[0] == cells[0]);
  if (header.column[kSample] < 0 && has_colors && first_is_free) {
    header.taken_for_sample = cells[0].empty() ? "first" : cells[0];
    std::erase(header.unknown, cells[0]);
    header.column[kSample] = 0;
  }
  if (header.column[kSample] < 0) return input_error("the header has no column \"sample\": begin with {}", kLongHeader);
  if (header.is_wide() && !header.wavelengths.empty())
    return input_error(
        "the header has wavelengths and no column \"geometry\": say at which geometry each spectrum was measured");
  if (!header.is_wide()) {
    const bool has_no_lab = header.column[kL] < 0 && header.column[kA] < 0 && header.column[kB] < 0;
    if (has_no_lab && !header.wavelengths.empty()) return header;
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
  Result<std::optional<paint::SpectrumReading>> spectrum(const paint::Geometry& geometry) const;
  Result<paint::LabReading> reading(const paint::Geometry& geometry);
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
  SpectralMeter meter;
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
  if (!header.taken_for_sample.empty())
    warnings.push_back(
        fmt::format("{}: the column \"{}\" is taken for the names", records.name(), shown(header.taken_for_sample)));
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

// The spectrum of the row, or nothing where its cells are empty.
Result<std::optional<paint::SpectrumReading>> CsvPaintReader::State::spectrum(const paint::Geometry& geometry) const {
  const std::vector<WavelengthColumn>& columns = header.wavelengths;
  if (std::ranges::all_of(columns, [&](const WavelengthColumn& column) { return cells[column.at].empty(); }))
    return std::optional<paint::SpectrumReading>();
  paint::SpectrumReading spectrum{geometry, columns[0].nm, columns[1].nm - columns[0].nm, {}};
  for (const WavelengthColumn& column : columns) {
    GONIO_ASSIGN(const double factor, number(column.at, Domain::kAny));
    if (std::abs(factor) > 100 * kLargestFactor)
      return error(fmt::format("{} is {}: write a reflectance, where 1, or 100 percent, is the perfect diffuser",
                               shown(header.headings[column.at]), shown(cells[column.at])));
    spectrum.factors.push_back(factor);
  }
  return std::optional(std::move(spectrum));
}

// Lab as the row states it, or from its spectrum, which the open sample keeps.
Result<paint::LabReading> CsvPaintReader::State::reading(const paint::Geometry& geometry) {
  const std::array<int, 3> columns = {header.column[kL], header.column[kA], header.column[kB]};
  GONIO_ASSIGN(auto measured, spectrum(geometry));
  const bool stated = std::ranges::any_of(columns, [&](int column) { return !text(column).empty(); });
  paint::LabReading row{geometry, {}};
  if (!measured && std::ranges::min(columns) < 0) return error("the row has no spectrum, and the table no L, a and b");
  if (stated || !measured) {
    GONIO_ASSIGN(row.lab, lab(columns));
  }
  if (!measured) return row;
  const color::ViewingCondition& condition = open->measurement->condition;
  if (const auto made = meter.make_factors(*measured, condition, stated ? std::optional(row.lab.L) : std::nullopt);
      !made.ok())
    return error(made.error().message);
  if (!stated) {
    const auto integrated = meter.lab(*measured, condition);
    if (!integrated.ok()) return error(integrated.error().message);
    row.lab = *integrated;
    if (const auto checked = check_lab(row.lab); !checked.ok()) return error(checked.error().message);
  }
  open->measurement->spectra.push_back(std::move(*measured));
  return row;
}

Result<color::ViewingCondition> CsvPaintReader::State::condition() const {
  color::ViewingCondition condition;
  if (header.column[kIlluminant] >= 0) condition.illuminant = text(header.column[kIlluminant]);
  if (condition.illuminant.empty()) return error("illuminant is empty: write D65, A or another one");
  if (header.column[kObserver] < 0) return condition;
  const auto observer = observer_in(without_degree_sign(text(header.column[kObserver])));
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
  auto geometry = paint::parse_geometry(without_degree_sign(text(header.column[kGeometry])));
  if (!geometry.ok()) return error(geometry.error().message);
  auto& rows = open->measurement->rows;
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (rows[i].geometry == *geometry)
      return error(fmt::format("geometry {} of sample \"{}\" is already at line {}: keep one, or give the mean",
                               paint::geometry_name(*geometry), shown(open->name), row_lines[i]));
  if (rows.size() >= kMostRows) return error(fmt::format("more than {} rows in one sample: split it", kMostRows));
  GONIO_ASSIGN(const paint::LabReading reading_here, reading(*geometry));
  const std::string origin = lower(text(header.column[kOrigin]));
  if (!origin.empty() && origin != "row" && origin != "curve")
    return error(fmt::format("origin is \"{}\": write row, or curve for what a curve says", shown(origin)));
  if (origin == "curve") from_curve.push_back(*geometry);
  rows.push_back(reading_here);
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

}  // namespace goniochrome::formats
