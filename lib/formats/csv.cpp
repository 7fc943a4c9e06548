#include "formats/csv.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/csv_records.h"
#include "base/text.h"
#include "color/illuminant.h"
#include "formats/imported.h"
#include "formats/internal/csv_header.h"
#include "formats/internal/spectral_rows.h"
#include "formats/xml.h"
#include "paint/date.h"

namespace goniochrome::formats {

namespace {

// Leaves the rows that are not from the curve, if there are any.
void drop_curve(paint::Measurement& measurement, const std::vector<paint::Geometry>& from_curve) {
  if (from_curve.size() >= measurement.rows.size()) return;
  std::erase_if(measurement.rows, [&](const paint::LabReading& row) {
    return std::ranges::find(from_curve, row.geometry) != from_curve.end();
  });
}

std::string listed(const std::vector<std::string>& words) {
  return joined(words, ", ", [](const std::string& word) { return fmt::format("\"{}\"", shown(word)); });
}

}  // namespace

struct CsvPaintReader::State {
  State(InputFile input, Scale scale) : records(std::move(input)), asked_scale(scale) {}

  Result<void> read_header();
  Result<void> begin_rows();
  bool is_row_of_units() const;
  Result<void> find_scale();
  void judge_row(ScaleJudge& judge, std::string& name) const;
  bool continues_sample() const { return text(header.column[kSample]).empty() && open && open_name == name_above; }
  bool is_measured_again() const;
  Result<void> take_name(paint::Paint& paint);
  Result<std::optional<paint::Paint>> next_wide();
  Result<std::optional<paint::Paint>> wide_paint();
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
  CsvHeader header;
  std::vector<std::string> cells, warnings;
  Remarks remarks;
  PaintLedger names;
  SpectralMeter meter;
  Scale asked_scale;
  double unit = 1;  // of the reflectances: 1, or .01 for percent
  bool begun = false, scale_unknown = false;
  mutable std::string decimal_comma, decimal_point;  // a number with each
  std::string name_above;                            // of the last row, for rows that leave it out
  int line = 0;

  // Long tables: the sample whose rows are being collected.
  std::optional<paint::Paint> open;
  std::string open_name, open_date;  // as its first row states them
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

// True for a row that states the units of the columns: none of its values is a number.
bool CsvPaintReader::State::is_row_of_units() const {
  if (cells.size() != header.headings.size()) return false;
  std::vector<int> columns(header.column.begin() + kL, header.column.begin() + kB + 1);
  for (const WavelengthColumn& wavelength : header.wavelengths) columns.push_back(wavelength.at);
  for (const CsvTriple& triple : header.triples)
    columns.insert(columns.end(), triple.column.begin(), triple.column.end());
  constexpr std::array<std::string_view, 14> kUnits = {"%",     "percent", "prozent", "factor",     "faktor",
                                                       "-",     "nm",      "deg",     "\xc2\xb0",   "unit",
                                                       "units", "cielab",  "lab",     "reflectance"};
  bool any = false;
  for (const int column : columns) {
    if (column < 0 || cells[static_cast<std::size_t>(column)].empty()) continue;
    std::string word = lower(cells[static_cast<std::size_t>(column)]);
    std::erase_if(word, [](char c) { return std::string_view("[]()").find(c) != std::string_view::npos; });
    if (!word.empty() && std::ranges::find(kUnits, trimmed(word)) == kUnits.end()) return false;
    any = any || word != "-";
  }
  return any;
}

// Reads on to the first row of values, and finds the scale of the spectra.
Result<void> CsvPaintReader::State::begin_rows() {
  GONIO_ASSIGN(const bool found, records.next(cells));
  if (!found) {
    cells.clear();
  } else if (is_row_of_units()) {
    for (const WavelengthColumn& column : header.wavelengths) {
      const auto taken = take_scale(cells[static_cast<std::size_t>(column.at)], header.scale);
      if (!taken.ok()) return error(taken.error().message);
    }
    cells.clear();
  }
  return header.wavelengths.empty() ? Result<void>() : find_scale();
}

// Judges the spectra of all rows at once, which a second reading gives.
Result<void> CsvPaintReader::State::find_scale() {
  GONIO_ASSIGN(CsvRecords ahead, records.second_reading());
  const std::vector<std::string> first = cells;
  ScaleJudge judge;
  std::string name;
  for (bool found = !cells.empty(); found;) {
    if (check_width().ok()) judge_row(judge, name);
    auto next = ahead.next(cells);
    while (!next.ok()) next = ahead.next(cells);
    found = *next;
  }
  cells = first;
  const auto scale = judge.unit(header.scale, asked_scale, remarks);
  scale_unknown = !scale.ok();
  if (scale_unknown) return input_error("{}: {}", records.name(), scale.error().message);
  unit = *scale;
  return {};
}

// Rows that cannot be read say nothing here, and are named when they are read.
void CsvPaintReader::State::judge_row(ScaleJudge& judge, std::string& name) const {
  if (!text(header.column[kSample]).empty()) name = text(header.column[kSample]);
  const auto geometry = paint::parse_geometry(without_degree_sign(text(header.column[kGeometry])));
  if (!geometry.ok()) return;
  const auto measured = spectrum(*geometry);
  if (!measured.ok() || !*measured) return;
  const auto L = text(header.column[kL]).empty() ? Result<double>(input_error("")) : number(header.column[kL]);
  judge.add(name, *geometry, (*measured)->factors, L.ok() ? std::optional(*L) : std::nullopt);
}

// A comma is a decimal point: the separator does not stand in a cell, unless that is quoted.
Result<double> CsvPaintReader::State::number(int column, Domain domain) const {
  const std::string& text = cells[static_cast<std::size_t>(column)];
  const auto pointed = with_decimal_point(text);
  std::string& first = pointed ? decimal_comma : decimal_point;
  if (first.empty() && (pointed || text.find('.') != std::string::npos)) first = text;
  if (!decimal_comma.empty() && !decimal_point.empty())
    return error(
        fmt::format("the table has the numbers {} and {}: write all with a decimal point, and none with a "
                    "separator of thousands",
                    shown(decimal_comma), shown(decimal_point)));
  const auto value = number_in(pointed.value_or(text), domain);
  if (!value.ok())
    return error(fmt::format("{} {}", shown(header.headings[static_cast<std::size_t>(column)]), value.error().message));
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
    if (std::abs(factor) > kLargestReflectance)
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
  for (double& factor : measured->factors) factor *= unit;
  if (const auto checked = check_not_negative(measured->factors); !checked.ok()) return error(checked.error().message);
  if (!stated) {
    const auto integrated = meter.lab(*measured, condition);
    if (!integrated.ok()) return error(integrated.error().message);
    note_uncovered(meter.held_share(), open->name, remarks);
    row.lab = *integrated;
    if (const auto checked = check_lab(row.lab); !checked.ok()) return error(checked.error().message);
  }
  open->measurement->spectra.push_back(std::move(*measured));
  return row;
}

Result<color::ViewingCondition> CsvPaintReader::State::condition() const {
  color::ViewingCondition condition;
  if (continues_sample()) condition = open->measurement->condition;
  const std::string_view illuminant = text(header.column[kIlluminant]), deg = text(header.column[kObserver]);
  if (header.column[kIlluminant] >= 0 && illuminant.empty() && !continues_sample())
    return error("illuminant is empty: write D65, A or another one");
  const auto named = color::condition_in(illuminant);
  const bool has_observer = named && named->observer_deg != 0;
  int observer_deg = has_observer ? 0 : condition.observer_deg;
  if (header.column[kObserver] >= 0 && !(deg.empty() && (continues_sample() || has_observer))) {
    const auto observer = observer_in(without_degree_sign(deg));
    if (!observer.ok()) return error("observer " + observer.error().message);
    observer_deg = *observer;
  }
  const auto stated = stated_condition(illuminant.empty() ? condition.illuminant : illuminant, observer_deg);
  if (!stated.ok()) return error(stated.error().message);
  return *stated;
}

// Everything that a row says of its paint except the Lab values.
Result<paint::Paint> CsvPaintReader::State::described() const {
  paint::Paint paint;
  paint.name = text(header.column[kSample]);
  if (paint.name.empty() && !header.is_wide()) paint.name = name_above;
  if (paint.name.empty()) return error("sample is empty: name every row");
  GONIO_ASSIGN(color::ViewingCondition viewing, condition());
  paint.measurement = paint::Measurement{std::move(viewing), std::string(text(header.column[kInstrument])), {}};
  paint.measurement->serial = text(header.column[kSerial]);
  paint.measurement->date = paint::plain_date(text(header.column[kDate]));
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

// Gives the paint of the first of its rows a name of its own.
Result<void> CsvPaintReader::State::take_name(paint::Paint& paint) {
  const std::string stated = paint.name;
  const auto before = names.note(paint, records.line(), remarks);
  if (!before) return {};
  return error(fmt::format("sample \"{}\" is already at line {}: {}", shown(stated), *before,
                           header.is_wide() ? "rename one of them" : "put its rows together, or rename it"));
}

Result<std::optional<paint::Paint>> CsvPaintReader::State::next_wide() {
  if (cells.empty()) {
    GONIO_ASSIGN(const bool found, records.next(cells));
    if (!found) return std::optional<paint::Paint>();
  }
  auto paint = wide_paint();
  cells.clear();
  return paint;
}

// The paint of the row in `cells`.
Result<std::optional<paint::Paint>> CsvPaintReader::State::wide_paint() {
  GONIO_TRY(check_width());
  GONIO_ASSIGN(paint::Paint paint, described());
  GONIO_TRY(take_name(paint));
  for (const CsvTriple& triple : header.triples) {
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
  if (text(header.column[kSample]).empty())
    remarks.note("rows without a name were taken for rows of the sample above", fmt::format("line {}", records.line()));
  if (open) {
    GONIO_TRY(agree(row));
    open->measurement->date = paint::span_of_dates(open->measurement->date, row.measurement->date);
  } else {
    const std::string stated = row.name;
    if (const auto taken = take_name(row); !taken.ok()) {
      skipped = stated;
      return taken;
    }
    open = std::move(row);
    open_name = stated, open_date = open->measurement->date;
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

// True for a row of another code, or of another date whose geometry the open sample already has.
bool CsvPaintReader::State::is_measured_again() const {
  const std::string_view code = text(header.column[kCode]);
  if (!code.empty() && code != open->code) return true;
  const std::string date = paint::plain_date(text(header.column[kDate]));
  if (header.column[kDate] < 0 || date == open_date) return false;
  const auto geometry = paint::parse_geometry(without_degree_sign(text(header.column[kGeometry])));
  return geometry.ok() && std::ranges::find(open->measurement->rows, *geometry, &paint::LabReading::geometry) !=
                              open->measurement->rows.end();
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
    if (!at_end && width.ok() && !text(header.column[kSample]).empty()) name_above = text(header.column[kSample]);
    const std::string name = at_end || !width.ok() ? "" : name_above;
    if (open && width.ok() && (name != open_name || at_end || is_measured_again())) {
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

Result<CsvPaintReader> CsvPaintReader::open(InputFile input, Scale scale) {
  auto state = std::make_unique<State>(std::move(input), scale);
  GONIO_TRY(state->read_header());
  state->cells.clear();
  return CsvPaintReader(std::move(state));
}

CsvPaintReader::CsvPaintReader(std::unique_ptr<State> state) : state_(std::move(state)) {}
CsvPaintReader::CsvPaintReader(CsvPaintReader&&) noexcept = default;
CsvPaintReader::~CsvPaintReader() = default;

Result<std::optional<paint::Paint>> CsvPaintReader::next() {
  if (state_->scale_unknown) return std::optional<paint::Paint>();
  if (!std::exchange(state_->begun, true)) GONIO_TRY(state_->begin_rows());
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

std::vector<std::string> CsvPaintReader::closing_warnings() const {
  std::vector<std::string> lines;
  for (const std::string& remark : state_->remarks.lines())
    lines.push_back(fmt::format("{}: {}", state_->records.name(), remark));
  return lines;
}

}  // namespace goniochrome::formats
