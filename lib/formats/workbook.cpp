#include "formats/importers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "base/csv_records.h"
#include "base/text.h"
#include "color/illuminant.h"
#include "formats/internal/spectral_rows.h"
#include "formats/internal/spreadsheet.h"

namespace goniochrome::formats {

namespace {

constexpr int kNoColumn = -1;
// How far Lab and spectrum of one reading may lie apart. Instruments weigh their spectra by tables for their own bands,
// which changes the color by a few hundredths.
constexpr double kLabAgrees_de00 = 0.2;
// Three columns of L*, a* and b* under one viewing condition.
struct LabColumns {
  color::ViewingCondition condition;
  std::array<int, 3> at = {kNoColumn, kNoColumn, kNoColumn};
};

// A column of sparkle, graininess or the like.
struct TextureColumn {
  std::string quantity, version;
  int at = 0;
};

// The meaning of the columns below a row of headings.
struct Table {
  int name = kNoColumn, code = kNoColumn, date = kNoColumn, serial = kNoColumn, geometry = kNoColumn,
      illuminant = kNoColumn, observer = kNoColumn;
  std::vector<LabColumns> colors;
  std::vector<WavelengthColumn> wavelengths;
  std::string wavelength_fault;  // why they make no spectrum
  Scale scale = Scale::kUnstated;
  std::vector<TextureColumn> textures;
  std::vector<std::string> other_colors;  // headings that end in L, a or b and are of another color

  bool has_values() const {
    return !colors.empty() || wavelengths.size() >= kFewestWavelengths || (geometry != kNoColumn && !textures.empty());
  }
};

// A heading in lower case without blanks, asterisks and colons, up to a bracket.
std::string plain_column(std::string_view heading) {
  std::string text = lower(heading.substr(0, heading.find_first_of("([")));
  std::erase_if(text, [](char c) { return std::string_view(" *_:.").find(c) != std::string_view::npos; });
  return text;
}

template <std::size_t N>
bool is_one_of(const std::string& word, const std::array<std::string_view, N>& words) {
  return std::ranges::find(words, word) != words.end();
}

constexpr std::array<std::string_view, 13> kNameHeadings = {"name",   "sample",      "samplename", "standard", "paint",
                                                            "color",  "colour",      "id",         "sampleid", "probe",
                                                            "muster", "bezeichnung", "farbe"};
constexpr std::array<std::string_view, 6> kDateHeadings = {"date", "date/time", "datetime", "time", "datum", "zeit"};
constexpr std::array<std::string_view, 4> kCodeHeadings = {"code", "paintcode", "colorcode", "farbcode"};
constexpr std::array<std::string_view, 4> kSerialHeadings = {"serial", "serialnumber", "serialno", "seriennummer"};
constexpr std::array<std::string_view, 3> kIlluminantHeadings = {"illuminant", "lichtart", "normlichtart"};
constexpr std::array<std::string_view, 4> kObserverHeadings = {"observer", "beobachter", "normalbeobachter",
                                                               "observerangle"};
constexpr std::array<std::string_view, 6> kGeometryHeadings = {"geometry", "geometrie",  "angle",
                                                               "winkel",   "messwinkel", "messgeometrie"};

// `D65/10` or `D65 10°` in a text; parts that are not there stay empty and 0.
color::ViewingCondition condition_in(std::string_view text) {
  color::ViewingCondition condition = color::condition_among(text);
  std::string word;
  for (const char c : std::string(text) + " ") {
    if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z')) {
      word += c;
      continue;
    }
    if (condition.observer_deg == 0 && (word == "2" || word == "10")) condition.observer_deg = word == "2" ? 2 : 10;
    word.clear();
  }
  return condition;
}

// True where every word of a heading is of the light, the observer or CIELAB.
bool names_light_alone(std::string_view text) {
  static constexpr std::array<std::string_view, 9> kWords = {"cie", "cielab",     "lab",      "deg",         "degree",
                                                             "obs", "illuminant", "observer", "normlichtart"};
  std::string word;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    const char c = i < text.size() ? text[i] : ' ';
    if ((c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-') {
      word += c;
      continue;
    }
    const bool known = word.empty() || word == "-" || is_one_of(lower(word), kWords) || color::observer_in(word) != 0 ||
                       !color::condition_among(word).illuminant.empty();
    if (!known) return false;
    word.clear();
  }
  return true;
}

// A heading such as `L*`, `a* (D65/10)` or `D65/10 b*`, or of another color: `Hunter L`, `Delta a*`.
struct LabHeading {
  std::size_t channel = 0;  // of L, a and b
  color::ViewingCondition condition;
  bool is_other = false;
};
std::optional<LabHeading> lab_heading(std::string_view heading) {
  heading = trimmed(heading);
  std::string_view before, word = heading;
  const auto bracket = heading.find_first_of("([");
  if (bracket != std::string_view::npos) {
    before = heading.substr(bracket), word = trimmed(heading.substr(0, bracket));
  } else if (const auto blank = heading.find_last_of(" \t"); blank != std::string_view::npos) {
    before = heading.substr(0, blank), word = heading.substr(blank + 1);
  }
  const std::string plain = plain_column(word);
  const auto channel = std::string_view("lab").find(plain);
  if (plain.size() != 1 || channel == std::string_view::npos) return std::nullopt;
  return LabHeading{channel, condition_in(before), !names_light_alone(before)};
}

// A heading that names a texture, and its version where it stands in brackets: `Sparkle Grade (v2)`.
std::optional<TextureColumn> texture_heading(std::string_view heading, int column) {
  static constexpr std::array<std::string_view, 6> kWords = {"sparkle", "grain",    "coarse",
                                                             "glitz",   "rnigkeit", "texture"};
  const std::string word = lower(heading);
  if (std::ranges::none_of(kWords, [&](std::string_view known) { return word.find(known) != std::string::npos; }))
    return std::nullopt;
  const auto open = heading.find('('), close = heading.find(')');
  TextureColumn texture{std::string(trimmed(heading.substr(0, open))), "", column};
  if (open != std::string_view::npos && close != std::string_view::npos && close > open)
    texture.version = trimmed(heading.substr(open + 1, close - open - 1));
  return texture.quantity.empty() ? std::nullopt : std::optional(texture);
}

// The number of a cell such as `45%`.
std::string_view without_percent(std::string_view text) {
  return text.ends_with('%') ? trimmed(text.substr(0, text.size() - 1)) : text;
}

// True if the row is a title such as `Reflectance [%]`.
bool states_reflectance(const SheetRow& row) {
  const std::string text = row.cells.empty() ? "" : lower(row.cells[0].text);
  return (text.find("reflect") != std::string::npos || text.find("remission") != std::string::npos) &&
         scale_in(text) != Scale::kUnstated;
}

class WorkbookReader {
 public:
  WorkbookReader(std::string file, const ImportOptions& options) : file_(std::move(file)), options_(options) {}

  Result<void> read(const Sheet& sheet);
  Result<ImportedPaints> finish();

 private:
  // A paint whose readings are gathered over all sheets.
  struct Gathered {
    OpenPaint open;
    std::vector<std::string> places;  // where each of the spectra stands
  };

  Error error(const Sheet& sheet, const SheetRow& row, const std::string& what) const {
    return input_error("{}: sheet \"{}\", row {}: {}", file_, shown(sheet.name), row.number, what);
  }
  Table table_below(const Sheet& sheet, std::size_t heading) const;
  static bool is_row_of_units(const SheetRow& row, const Table& table);
  Result<void> state_scale(const Sheet& sheet, const SheetRow& row, Scale scale);
  Result<void> read_row(const Sheet& sheet, const SheetRow& row, const Table& table);
  Result<void> read_lab(const Sheet& sheet, const SheetRow& row, const Table& table, const paint::Geometry& geometry,
                        OpenPaint& open);
  Result<void> take_stated(const Sheet& sheet, const SheetRow& row, const Table& table,
                           color::ViewingCondition& condition) const;
  Result<void> read_spectrum(const Sheet& sheet, const SheetRow& row, const Table& table,
                             const paint::Geometry& geometry, Gathered& gathered);
  Result<void> read_textures(const Sheet& sheet, const SheetRow& row, const Table& table, std::string_view geometry,
                             OpenPaint& open);
  Gathered& gathered(const std::string& name, const std::string& date, std::string_view code);
  Result<double> unit_of_all();
  Result<void> integrate(Gathered& paint);

  std::string file_;
  const ImportOptions& options_;
  std::string stated_name_;  // by the sheet that is being read, for tables without a column of names
  color::ViewingCondition stated_{"", 0};
  std::vector<Gathered> paints_;
  std::map<std::pair<std::string, std::string>, std::vector<std::size_t>> numbers_of_;
  SpectralMeter meter_;
  Scale stated_scale_ = Scale::kUnstated;
  double unit_ = 1;  // of the reflectances: 1, or .01 for percent
  double disagreement_de00_ = 0;
  std::size_t disagreements_ = 0;
  std::string worst_;
  Remarks remarks_;
  ImportedPaints result_;
  std::string sheets_;  // names of those that were looked at
  bool any_table_ = false;
};

// Reads the row of headings. A column without a known heading is that of the geometry if every cell below, until the
// table ends, names one.
Table WorkbookReader::table_below(const Sheet& sheet, std::size_t heading) const {
  Table table;
  const SheetRow& row = sheet.rows[heading];
  for (const SheetCell& cell : row.cells) {
    const std::string word = plain_column(cell.text);
    if (table.name == kNoColumn && is_one_of(word, kNameHeadings)) table.name = cell.column;
    if (table.date == kNoColumn && is_one_of(word, kDateHeadings)) table.date = cell.column;
    if (table.code == kNoColumn && is_one_of(word, kCodeHeadings)) table.code = cell.column;
    if (table.serial == kNoColumn && is_one_of(word, kSerialHeadings)) table.serial = cell.column;
    if (table.geometry == kNoColumn && is_one_of(word, kGeometryHeadings)) table.geometry = cell.column;
    if (table.illuminant == kNoColumn && is_one_of(word, kIlluminantHeadings)) table.illuminant = cell.column;
    if (table.observer == kNoColumn && is_one_of(word, kObserverHeadings)) table.observer = cell.column;
    if (const auto nm = wavelength_in(cell.text)) {
      table.wavelengths.push_back({*nm, cell.column});
      if (const auto taken = take_scale(cell.text, table.scale); !taken.ok())
        table.wavelength_fault = taken.error().message;
    }
    if (auto texture = texture_heading(cell.text, cell.column)) table.textures.push_back(std::move(*texture));
    if (const auto lab = lab_heading(cell.text); lab && lab->is_other) {
      table.other_colors.push_back(cell.text);
    } else if (lab) {
      const auto open = std::ranges::find_if(table.colors, [&](const LabColumns& columns) {
        return columns.condition == lab->condition && columns.at[lab->channel] == kNoColumn;
      });
      LabColumns& columns = open != table.colors.end() ? *open : table.colors.emplace_back(LabColumns{lab->condition});
      columns.at[lab->channel] = cell.column;
    }
  }
  if (const auto sorted = sort_wavelengths(table.wavelengths); table.wavelength_fault.empty() && !sorted.ok())
    table.wavelength_fault = sorted.error().message;
  std::erase_if(table.colors, [](const LabColumns& columns) { return std::ranges::count(columns.at, kNoColumn) > 0; });
  if (table.geometry == kNoColumn && table.has_values() && heading + 1 < sheet.rows.size())
    for (const SheetCell& cell : sheet.rows[heading + 1].cells)
      if (!parse_number(cell.text) && paint::parse_geometry(cell.text).ok()) table.geometry = cell.column;
  return table;
}

// The paint of a name and a date. A row without a code is of the first of them, whatever its code is.
WorkbookReader::Gathered& WorkbookReader::gathered(const std::string& name, const std::string& date,
                                                   std::string_view code) {
  std::vector<std::size_t>& numbers = numbers_of_[{name, date}];
  for (const std::size_t number : numbers) {
    std::string& known = paints_[number].open.paint.code;
    if (known.empty()) known = code;
    if (code.empty() || known == code) return paints_[number];
  }
  numbers.push_back(paints_.size());
  OpenPaint& open = paints_.emplace_back().open;
  open.paint.name = name, open.paint.code = code, open.date = date;
  return paints_.back();
}

Result<void> WorkbookReader::read_lab(const Sheet& sheet, const SheetRow& row, const Table& table,
                                      const paint::Geometry& geometry, OpenPaint& open) {
  for (const LabColumns& columns : table.colors) {
    std::array<double, 3> values{};
    int empty = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::string_view text = row.at(columns.at[k]);
      const auto value = number_in_cell(text);
      empty += text.empty();
      if (!text.empty() && !value)
        return error(sheet, row, fmt::format("{}* is \"{}\": write a number", "Lab"[k], shown(text)));
      values[k] = value.value_or(0);
    }
    if (empty == 3) continue;
    if (empty > 0 && sheet.formulas_without_value > 0)
      return error(sheet, row,
                   "one of L*, a* and b* is missing, and formulas of the sheet have no stored value: open and save the "
                   "workbook");
    if (empty > 0) return error(sheet, row, "one of L*, a* and b* is missing: give all three, or none");
    const color::Lab lab{values[0], values[1], values[2]};
    if (const auto checked = check_lab(lab); !checked.ok()) return error(sheet, row, checked.error().message);
    color::ViewingCondition condition = columns.condition;
    GONIO_TRY(take_stated(sheet, row, table, condition));
    if (condition.illuminant.empty()) condition.illuminant = stated_.illuminant;
    if (condition.observer_deg == 0) condition.observer_deg = stated_.observer_deg;
    if (condition.illuminant.empty() || condition.observer_deg == 0)
      remarks_.note("illuminant or observer is not stated: taken as D65/10 where the options do not say it",
                    open.paint.name);
    open.readings.push_back({completed(condition, options_, {"D65", 10}), {geometry, lab}});
  }
  return {};
}

// Fills in what the row states in columns of their own.
Result<void> WorkbookReader::take_stated(const Sheet& sheet, const SheetRow& row, const Table& table,
                                         color::ViewingCondition& condition) const {
  const std::string_view light = table.illuminant == kNoColumn ? "" : row.at(table.illuminant),
                         observer = table.observer == kNoColumn ? "" : row.at(table.observer);
  if (condition.illuminant.empty() && !light.empty()) condition = color::condition_of(light, condition.observer_deg);
  if (condition.observer_deg != 0 || observer.empty()) return {};
  condition.observer_deg = color::observer_in(observer);
  if (condition.observer_deg == 0)
    return error(sheet, row, fmt::format("the observer is \"{}\": write 2 or 10 (degrees)", shown(observer)));
  return {};
}

Result<void> WorkbookReader::read_spectrum(const Sheet& sheet, const SheetRow& row, const Table& table,
                                           const paint::Geometry& geometry, Gathered& gathered) {
  if (table.wavelengths.size() < kFewestWavelengths) return {};
  if (!table.wavelength_fault.empty()) return error(sheet, row, table.wavelength_fault);
  const double from_nm = table.wavelengths[0].nm, step_nm = table.wavelengths[1].nm - from_nm;
  std::vector<double> factors;
  std::size_t in_percent = 0;  // cells that say so
  for (const auto& [nm, column] : table.wavelengths) {
    const std::string_view text = row.at(column);
    if (text.empty() && factors.empty()) return {};
    in_percent += text.ends_with('%');
    const auto value = number_in_cell(without_percent(text));
    if (!value || !(std::abs(*value) <= kMostLab))
      return error(sheet, row, fmt::format("the reflectance at {} nm is \"{}\": write a number", nm, shown(text)));
    factors.push_back(*value);
  }
  if (in_percent > 0 && in_percent < factors.size())
    return error(sheet, row, "some of its reflectances are shown as percent and others are not: show all alike");
  if (in_percent > 0) GONIO_TRY(state_scale(sheet, row, Scale::kPercent));
  gathered.open.spectra.push_back({geometry, from_nm, step_nm, std::move(factors)});
  gathered.places.push_back(fmt::format("{} at {}", gathered.open.paint.name, paint::geometry_name(geometry)));
  return {};
}

Result<void> WorkbookReader::read_textures(const Sheet& sheet, const SheetRow& row, const Table& table,
                                           std::string_view geometry, OpenPaint& open) {
  for (const TextureColumn& column : table.textures) {
    const std::string_view text = row.at(column.at);
    if (text.empty()) continue;
    const auto value = number_in_cell(text);
    if (!value)
      return error(sheet, row, fmt::format("{} is \"{}\": write a number", shown(column.quantity), shown(text)));
    const auto same = [&](const paint::TextureReading& other) {
      return other.quantity == column.quantity && other.geometry == geometry && other.version == column.version;
    };
    if (std::ranges::any_of(open.textures, same))
      remarks_.note("several values of one texture: the first was taken",
                    fmt::format("{} of {}", column.quantity, open.paint.name));
    else
      open.textures.push_back({column.quantity, std::string(geometry), column.version, *value});
  }
  return {};
}

// True if the row says in which unit the spectra below are.
bool WorkbookReader::is_row_of_units(const SheetRow& row, const Table& table) {
  if (table.wavelengths.size() < kFewestWavelengths) return false;
  const std::string_view cell = row.at(table.wavelengths.front().at);
  return !number_in_cell(without_percent(cell)) && scale_in(cell) != Scale::kUnstated;
}

// All sheets have one scale. Error: another was stated before.
Result<void> WorkbookReader::state_scale(const Sheet& sheet, const SheetRow& row, Scale scale) {
  if (scale == Scale::kUnstated) return {};
  if (stated_scale_ != Scale::kUnstated && stated_scale_ != scale)
    return error(sheet, row, "says another scale of reflectances than stands before: write percent or factors in all");
  stated_scale_ = scale;
  return {};
}

Result<void> WorkbookReader::read_row(const Sheet& sheet, const SheetRow& row, const Table& table) {
  if (is_row_of_units(row, table)) return state_scale(sheet, row, scale_in(row.at(table.wavelengths.front().at)));
  const std::string name(table.name == kNoColumn ? stated_name_ : row.at(table.name));
  const std::string_view geometry_text = table.geometry == kNoColumn ? std::string_view() : row.at(table.geometry);
  if (name.empty() && geometry_text.empty()) return {};  // a remark, a sum
  if (name.empty()) return error(sheet, row, "has no name of a sample: give it one");
  if (geometry_text.empty()) return error(sheet, row, fmt::format("\"{}\" has no geometry: write 45as15", shown(name)));
  const auto cell = [&](int column) { return column == kNoColumn ? std::string_view() : row.at(column); };
  Gathered& paint = gathered(name, std::string(cell(table.date)), cell(table.code));
  if (paint.open.serial.empty()) paint.open.serial = cell(table.serial);
  GONIO_TRY(read_textures(sheet, row, table, geometry_text, paint.open));
  if (table.colors.empty() && table.wavelengths.empty()) return {};  // textures have geometries of their own
  const auto geometry = paint::parse_geometry(geometry_text);
  if (!geometry.ok()) return error(sheet, row, geometry.error().message);
  GONIO_TRY(read_lab(sheet, row, table, *geometry, paint.open));
  return read_spectrum(sheet, row, table, *geometry, paint);
}

Result<void> WorkbookReader::read(const Sheet& sheet) {
  sheets_ += fmt::format("{}\"{}\"", sheets_.empty() ? "" : ", ", shown(sheet.name));
  if (sheet.formulas_without_value > 0)
    remarks_.note("formulas without a stored value count as empty cells: open and save the workbook", sheet.name);
  if (sheet.is_hidden || sheet.hidden_rows > 0)
    remarks_.note("sheets and rows that the workbook hides are read as well", sheet.name);
  stated_name_.clear(), stated_ = {"", 0};
  Table table;
  for (std::size_t i = 0; i < sheet.rows.size(); ++i) {
    const SheetRow& row = sheet.rows[i];
    if (Table below = table_below(sheet, i); below.has_values()) {
      table = std::move(below);
      if (table.wavelengths.size() >= kFewestWavelengths) GONIO_TRY(state_scale(sheet, row, table.scale));
      any_table_ = any_table_ || table.geometry != kNoColumn;
      for (const std::string& other : table.other_colors)
        remarks_.note("columns of another color than CIELAB under a light are not read", other);
      if (table.geometry != kNoColumn) continue;
      remarks_.note("a table without a column of geometries was left out", sheet.name);
      table = {};
    } else if (table.has_values()) {
      const auto read = read_row(sheet, row, table);
      if (!read.ok() && !options_.keep_going) return read;
      if (!read.ok()) result_.skipped.push_back(read.error().message);
    } else if (states_reflectance(row)) {
      GONIO_TRY(state_scale(sheet, row, scale_in(row.cells[0].text)));
    } else if (row.cells.size() >= 2) {  // `STANDARD: | name` and the like
      const std::string word = plain_column(row.cells[0].text);
      if (is_one_of(word, kNameHeadings)) stated_name_ = row.cells[1].text;
      const color::ViewingCondition said = condition_in(row.cells[1].text);
      if (word.find("illum") != std::string::npos || word.find("lichtart") != std::string::npos)
        stated_ = {said.illuminant, said.observer_deg != 0 ? said.observer_deg : stated_.observer_deg};
      else if (is_one_of(word, kObserverHeadings))
        stated_.observer_deg = color::observer_in(row.cells[1].text);
    }
  }
  return {};
}

// The unit that makes factors of the reflectances of all sheets. Error: their scale cannot be known.
Result<double> WorkbookReader::unit_of_all() {
  ScaleJudge judge;
  for (const Gathered& paint : paints_)
    for (const paint::SpectrumReading& spectrum : paint.open.spectra) {
      const auto seen = std::ranges::find(paint.open.readings, spectrum.geometry,
                                          [](const SeenReading& reading) { return reading.reading.geometry; });
      judge.add(paint.open.paint.name, spectrum.geometry, spectrum.factors,
                seen == paint.open.readings.end() ? std::nullopt : std::optional(seen->reading.lab.L));
    }
  const auto unit = judge.unit(stated_scale_, options_.scale, remarks_);
  if (!unit.ok()) return input_error("{}: {}", file_, unit.error().message);
  return *unit;
}

// Lab from the spectra of geometries that have none, and how far it lies from the Lab of those that have one.
Result<void> WorkbookReader::integrate(Gathered& paint) {
  OpenPaint& open = paint.open;
  std::vector<color::ViewingCondition> conditions;
  for (const SeenReading& seen : open.readings)
    if (std::ranges::find(conditions, seen.condition) == conditions.end()) conditions.push_back(seen.condition);
  if (conditions.empty()) conditions.push_back(completed({"", 0}, options_, {"D65", 10}));
  for (std::size_t i = 0; i < open.spectra.size(); ++i) {
    paint::SpectrumReading& spectrum = open.spectra[i];
    for (double& factor : spectrum.factors) factor *= unit_;
    if (const auto checked = check_not_negative(spectrum.factors); !checked.ok())
      return input_error("{}: {}: {}", file_, paint.places[i], checked.error().message);
    for (const color::ViewingCondition& condition : conditions) {
      const auto lab = meter_.lab(spectrum, condition);
      if (!lab.ok()) {
        remarks_.note("spectra are not integrated: " + lab.error().message, paint.places[i]);
        continue;
      }
      note_uncovered(meter_.held_share(), paint.places[i], remarks_);
      const auto seen = std::ranges::find_if(open.readings, [&](const SeenReading& reading) {
        return reading.condition == condition && reading.reading.geometry == spectrum.geometry;
      });
      if (seen == open.readings.end()) {
        if (const auto checked = check_lab(*lab); !checked.ok())
          return input_error("{}: {}: from its spectrum, {}", file_, paint.places[i], checked.error().message);
        open.readings.push_back({condition, {spectrum.geometry, *lab}});
        continue;
      }
      const double apart = color::delta_e_2000(*lab, seen->reading.lab);
      disagreements_ += apart > kLabAgrees_de00;
      if (apart > disagreement_de00_) disagreement_de00_ = apart, worst_ = paint.places[i];
    }
  }
  return {};
}

Result<ImportedPaints> WorkbookReader::finish() {
  GONIO_ASSIGN(unit_, unit_of_all());
  UniqueNames names;
  for (Gathered& paint : paints_) {
    GONIO_TRY(integrate(paint));
    if (!paint.open.complete(options_, remarks_)) continue;
    paint.open.paint.name = names.own(paint.open.paint.name, remarks_);
    result_.paints.push_back(std::move(paint.open.paint));
  }
  if (disagreements_ > 0)
    remarks_.note(
        fmt::format("the Lab was taken where it is not the color of the spectrum beside it: at {} of the readings, by "
                    "up to {:.2g} dE00",
                    disagreements_, disagreement_de00_),
        worst_);
  if (!any_table_)
    return input_error(
        "{}: none of its sheets ({}) has a table of geometries beside L*, a* and b*, or beside reflectances under "
        "their wavelengths",
        file_, sheets_.empty() ? "there are none" : sheets_);
  result_.warnings = remarks_.lines();
  return std::move(result_);
}

}  // namespace

bool looks_workbook(std::string_view head) {
  return head.starts_with("PK\x03\x04") || head.starts_with("PK\x05\x06") || head.starts_with("\xd0\xcf\x11\xe0");
}

Result<ImportedPaints> read_workbook(InputFile input, const ImportOptions& options) {
  WorkbookReader reader(input.name(), options);
  GONIO_ASSIGN(Spreadsheet book, Spreadsheet::open(std::move(input)));
  for (std::size_t i = 0; i < book.sheet_count(); ++i) {
    GONIO_ASSIGN(const Sheet sheet, book.sheet(i));
    GONIO_TRY(reader.read(sheet));
  }
  return reader.finish();
}

}  // namespace goniochrome::formats
