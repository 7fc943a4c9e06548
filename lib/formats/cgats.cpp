#include "formats/cgats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <unordered_map>

#include "base/csv_records.h"
#include "base/text.h"
#include "color/illuminant.h"
#include "formats/internal/spectral_records.h"
#include "paint/date.h"

namespace goniochrome::formats {

namespace {

// The words of a line up to a comment. They stand between white space or in quotation marks, which are doubled inside.
std::vector<std::string> words_of(std::string_view line) {
  std::vector<std::string> words;
  for (std::size_t i = 0; i < line.size();) {
    if (line[i] == ' ' || line[i] == '\t' || line[i] == '\r') {
      ++i;
    } else if (line[i] == '#') {
      break;
    } else if (line[i] == '"') {
      std::string word;
      for (++i; i < line.size(); ++i) {
        if (line[i] != '"') {
          word += line[i];
        } else if (i + 1 < line.size() && line[i + 1] == '"') {
          word += line[++i];
        } else {
          break;
        }
      }
      ++i;
      words.emplace_back(trimmed(word));
    } else {
      const auto end = std::min(line.find_first_of(" \t\r", i), line.size());
      words.emplace_back(trimmed(line.substr(i, end - i)));
      i = end;
    }
  }
  return words;
}

std::string unquoted(std::string_view text) {
  text = trimmed(text);
  while (text.starts_with('"')) text.remove_prefix(1);
  while (text.ends_with('"')) text.remove_suffix(1);
  return std::string(trimmed(text));
}

// The text after `key` in `text`, up to white space.
std::string_view after(std::string_view text, std::string_view key) {
  const auto at = text.find(key);
  if (at == std::string_view::npos) return {};
  text.remove_prefix(at + key.size());
  return text.substr(0, std::min(text.find_first_of(" \t\""), text.size()));
}

constexpr int kNone = -1;

// Which column holds what. The names of a color's three columns have the same ending, which may name a geometry.
struct ColorColumns {
  std::optional<paint::Geometry> geometry;
  std::array<int, 3> at = {kNone, kNone, kNone};
  bool xyz = false;
};
struct Columns {
  std::vector<std::string> fields;
  int name = kNone, id = kNone, geometry = kNone, illuminant = kNone, observer = kNone;
  int instrument = kNone, paint_class = kNone, code = kNone, date = kNone, serial = kNone;
  std::vector<ColorColumns> colors;
  std::vector<WavelengthColumn> wavelengths;  // five or more, or none
  std::vector<std::pair<double, int>> gloss;  // angle, column
};

class CgatsParser {
 public:
  // With a `judge`, it hears of the spectra, and nothing is integrated; else `unit` makes factors of those whose norm
  // is not stated.
  CgatsParser(std::string name, std::string_view text, const ImportOptions& options, ScaleJudge* judge, double unit)
      : name_(std::move(name)), text_(text), options_(options), judge_(judge), unit_(unit) {}

  Scale stated_scale() const { return stated_scale_; }

  Result<ImportedPaints> parse() {
    bool tables = false;
    while (next_line()) {
      const std::string first = words_.empty() ? "" : upper(words_[0]);
      if (first == "BEGIN_DATA_FORMAT") {
        GONIO_TRY(format());
      } else if (first == "BEGIN_DATA") {
        tables = true;
        GONIO_TRY(data());
      } else if (!words_.empty()) {
        GONIO_TRY(keyword(first));
      }
    }
    if (!tables) return input_error("{}: has no BEGIN_DATA: it is no CGATS table, or it was cut off", name_);
    finish_paint();
    xyz_scale_.finish(remarks_);
    if (const auto possible = normed_.unit_of_norm(); !possible.ok())
      return input_error("{}: {}", name_, possible.error().message);
    result_.warnings = remarks_.lines();
    return std::move(result_);
  }

 private:
  bool next_line() {
    if (text_.empty()) return false;
    const auto end = std::min(text_.find('\n'), text_.size());
    current_ = text_.substr(0, end);
    text_.remove_prefix(std::min(end + 1, text_.size()));
    ++line_;
    words_ = words_of(current_);
    return true;
  }

  Error error(const std::string& what) const { return input_error("{}:{}: {}", name_, line_, what); }

  Result<void> keyword(const std::string& key) {
    const auto rest = trimmed(current_).substr(std::min(words_[0].size(), trimmed(current_).size()));
    const std::string value = unquoted(rest.substr(0, rest.find('#')));
    if (key == "NUMBER_OF_SETS") {
      announced_ = parse_integer(value);
    } else if (key == "SPECTRAL_NORM") {
      spectral_norm_ = number_in_cell(value);
      if (!spectral_norm_ || !(*spectral_norm_ > 0))
        return error(fmt::format("SPECTRAL_NORM is \"{}\": write the value of the perfect diffuser", shown(value)));
    } else if (key == "INSTRUMENTATION") {
      instrument_ = value;
    } else if (key == "MEASUREMENT_GEOMETRY") {
      stated_geometry_ = value;
    } else if (key == "ILLUMINANT" || key == "ILLUMINATION_NAME") {
      take_illuminant(key, value);
    } else if (key == "OBSERVER" || key == "OBSERVER_ANGLE") {
      take_observer(key, value);
    } else if (key == "WEIGHTING_FUNCTION") {
      const auto comma = value.find(',');
      const std::string kind = upper(trimmed(value.substr(0, comma)));
      const std::string what = comma == std::string::npos ? "" : value.substr(comma + 1);
      kind == "ILLUMINANT" ? take_illuminant(key, what)
      : kind == "OBSERVER" ? take_observer(key, what)
                           : note_unheard(key, value);
    } else if (key == "MEASUREMENT_SOURCE") {
      if (stated_.illuminant.empty())
        stated_.illuminant = color::condition_among(after(value, "Illumination=")).illuminant;
      if (stated_.observer_deg == 0) stated_.observer_deg = color::observer_in(after(value, "ObserverAngle="));
      if (!is_none(after(value, "Filter="))) note_unheard("Filter", after(value, "Filter="));
      const std::string_view white = after(value, "WhiteBase=");
      if (!white.empty() && !lower(white).starts_with("abs")) note_unheard("WhiteBase", white);
    } else if (std::ranges::find(kChangesMeaning, key) != kChangesMeaning.end() && !is_none(value)) {
      note_unheard(key, value);
    }
    return {};
  }

  void take_observer(std::string_view key, std::string_view value) {
    if (const int found = color::observer_in(value)) return void(stated_.observer_deg = found);
    note_unheard(key, value);
  }

  void take_illuminant(std::string_view key, std::string_view value) {
    const color::ViewingCondition found = color::condition_among(value);
    if (found.illuminant.empty()) return note_unheard(key, value);
    stated_.illuminant = found.illuminant;
    if (found.observer_deg != 0) stated_.observer_deg = found.observer_deg;
  }

  // Keywords that change what the readings are. [ISO 28178:2009, table of keywords]
  static constexpr std::array<std::string_view, 5> kChangesMeaning = {"FILTER", "INSTRUMENT_FILTER", "POLARIZATION",
                                                                      "COMPUTATIONAL_PARAMETER", "DEVICE_CLASS"};

  static bool is_none(std::string_view value) {
    static constexpr std::array<std::string_view, 8> kNothingSaid = {"",    "no", "none",   "na",
                                                                     "n/a", "0",  "output", "input"};
    return std::ranges::find(kNothingSaid, lower(trimmed(value))) != kNothingSaid.end();
  }
  void note_unheard(std::string_view key, std::string_view value) { remarks_.note(unheard(key, value), ""); }

  Result<void> format() {
    columns_ = {};
    std::vector<std::string> words(words_.begin() + 1, words_.end());
    const int begun = line_;
    for (;;) {
      for (const std::string& word : words) {
        if (upper(word) == "END_DATA_FORMAT") return sort_columns();
        columns_.fields.push_back(word);
      }
      if (!next_line())
        return input_error("{}:{}: BEGIN_DATA_FORMAT has no END_DATA_FORMAT: the file was cut off", name_, begun);
      words = words_;
    }
  }

  Result<void> sort_columns() {
    for (int i = 0; i < static_cast<int>(columns_.fields.size()); ++i) {
      const std::string field = upper(columns_.fields[static_cast<std::size_t>(i)]);
      if (field == "SAMPLE_NAME" || field == "SAMPLENAME" || field == "NAME") columns_.name = i;
      if (field == "SAMPLE_ID" || field == "SAMPLEID") columns_.id = i;
      if (field == "GEOMETRY") columns_.geometry = i;
      if (field == "ILLUMINANT") columns_.illuminant = i;
      if (field == "OBSERVER") columns_.observer = i;
      if (field == "INSTRUMENT") columns_.instrument = i;
      if (field == "INSTRUMENT_SERIAL" || field == "SERIAL") columns_.serial = i;
      if (field == "PAINT_CLASS") columns_.paint_class = i;
      if (field == "PAINT_CODE") columns_.code = i;
      if (field == "DATE" || field == "DATETIME" || field == "MEASUREMENT_DATE" || field == "SAMPLE_DATE")
        columns_.date = i;
      if (field == "GLOSS") columns_.gloss.push_back({60, i});
      if (field.starts_with("GLOSS_"))
        if (const auto angle = parse_number(field.substr(6))) columns_.gloss.push_back({*angle, i});
    }
    if (!find_colors("LAB_", "LAB", false)) find_colors("XYZ_", "XYZ", true);
    for (int i = 0; i < static_cast<int>(columns_.fields.size()); ++i)
      if (const auto nm = wavelength_in(columns_.fields[static_cast<std::size_t>(i)]))
        columns_.wavelengths.push_back({*nm, i});
    if (columns_.wavelengths.size() < kFewestWavelengths) columns_.wavelengths.clear();
    if (const auto steps = sort_wavelengths(columns_.wavelengths); !steps.ok()) return error(steps.error().message);
    for (const WavelengthColumn& column : columns_.wavelengths) {
      const auto taken = take_scale(columns_.fields[static_cast<std::size_t>(column.at)], stated_scale_);
      if (!taken.ok()) return error(taken.error().message);
    }
    xyz_scale_.set(options_.scale, !columns_.wavelengths.empty());
    if (columns_.colors.empty() && columns_.wavelengths.empty())
      return error(
          "the fields hold neither LAB_L LAB_A LAB_B nor XYZ_X XYZ_Y XYZ_Z nor spectra such as SPECTRAL_NM_400: export "
          "one of them");
    return {};
  }

  bool find_colors(std::string_view prefix, std::string_view letters, bool xyz) {
    std::unordered_map<std::string, int> number_of;  // the first of each name; a table may have thousands of columns
    for (std::size_t i = 0; i < columns_.fields.size(); ++i)
      number_of.try_emplace(upper(columns_.fields[i]), static_cast<int>(i));
    const auto column_of = [&](const std::string& field) {
      const auto found = number_of.find(field);
      return found == number_of.end() ? kNone : found->second;
    };
    for (const std::string& field : columns_.fields) {
      const std::string first = std::string(prefix) + letters[0];
      if (!upper(field).starts_with(first)) continue;
      const std::string ending = upper(field).substr(first.size());
      ColorColumns color;
      color.xyz = xyz;
      for (std::size_t k = 0; k < 3; ++k) color.at[k] = column_of(std::string(prefix) + letters[k] + ending);
      if (!ending.empty()) {
        const auto geometry = paint::parse_geometry(lower(ending.substr(ending[0] == '_' ? 1 : 0)));
        if (!geometry) continue;
        color.geometry = *geometry;
      }
      if (std::ranges::find(color.at, kNone) == color.at.end()) columns_.colors.push_back(color);
    }
    return !columns_.colors.empty();
  }

  Result<void> data() {
    if (columns_.fields.empty())
      return error("BEGIN_DATA stands before any BEGIN_DATA_FORMAT: the columns have no names");
    std::int64_t rows = 0;
    const int begun = line_;
    for (;;) {
      if (!next_line()) return input_error("{}:{}: BEGIN_DATA has no END_DATA: the file was cut off", name_, begun);
      if (words_.empty()) continue;
      if (upper(words_[0]) == "END_DATA") break;
      if (judge_ && columns_.wavelengths.empty()) continue;
      ++rows;
      const auto read = row();
      if (read) continue;
      if (!options_.keep_going) return read.error();
      result_.skipped.push_back(read.error().message);
    }
    if (announced_ && *announced_ != rows)
      remarks_.note("NUMBER_OF_SETS does not count the rows there are", fmt::format("{} for {}", *announced_, rows));
    announced_.reset();
    return {};
  }

  // Takes the current line apart into cells. Where names have spaces and no quotation marks, the tabs part the cells.
  Result<void> cells() {
    if (words_.size() == columns_.fields.size()) return {};
    const std::size_t by_space = words_.size();
    words_.clear();
    for (const auto cell : split(current_, '\t')) words_.push_back(unquoted(cell));
    if (words_.size() == columns_.fields.size() + 1 && words_.back().empty()) words_.pop_back();
    if (words_.size() != columns_.fields.size())
      return error(fmt::format("{} cells where the format has {} fields: {}", by_space, columns_.fields.size(),
                               by_space > columns_.fields.size() ? "put names with spaces in quotation marks"
                                                                 : "fill empty cells with \"\""));
    return {};
  }

  const std::string& cell(int column) const {
    static const std::string kNothing;
    return column == kNone ? kNothing : words_[static_cast<std::size_t>(column)];
  }

  Result<double> number(int column) {
    const std::string& text = cell(column);
    if (const auto value = parse_number(text)) return *value;
    if (const auto value = parse_number(with_decimal_point(text).value_or(""))) {
      remarks_.note("decimal commas were read as points", fmt::format("line {}", line_));
      return *value;
    }
    return error(fmt::format("{} is \"{}\": write a number", columns_.fields[static_cast<std::size_t>(column)], text));
  }

  Result<void> row() {
    GONIO_TRY(cells());
    GONIO_ASSIGN(const color::ViewingCondition condition, condition_of_row());
    std::string name = cell(columns_.name).empty() ? cell(columns_.id) : cell(columns_.name);
    if (name.empty()) name = fmt::format("sample {}", result_.paints.size() + 1);
    std::vector<SeenReading> readings;
    for (const ColorColumns& color : columns_.colors) {
      if (color.geometry && cell(color.at[0]).empty()) continue;  // a wide table may have gaps
      std::array<double, 3> values{};
      for (std::size_t k = 0; k < 3; ++k) {
        GONIO_ASSIGN(values[k], number(color.at[k]));
      }
      color::Lab lab{values[0], values[1], values[2]};
      if (color.xyz) {
        GONIO_ASSIGN(const color::Xyz white, color::white_point(condition));
        lab = color::lab_from_xyz(xyz_scale_.scaled({values[0], values[1], values[2]}), white);
      }
      if (const auto checked = check_lab(lab); !checked.ok()) return error(checked.error().message);
      GONIO_ASSIGN(const auto geometry, geometry_of_row(color));
      if (geometry) readings.push_back({condition, {*geometry, lab}});
    }
    std::vector<paint::GlossReading> gloss;
    for (const auto& [angle, column] : columns_.gloss) {
      if (cell(column).empty()) continue;
      GONIO_ASSIGN(const double units, number(column));
      if (!(std::abs(units) <= kMostLab)) return error(fmt::format("the gloss is {}: write gloss units", units));
      gloss.push_back({angle, units});
    }
    std::optional<paint::SpectrumReading> measured;
    if (!columns_.wavelengths.empty()) {
      GONIO_ASSIGN(measured, spectrum(name, condition, readings));
    }
    const bool is_other = !cell(columns_.code).empty() && cell(columns_.code) != open_.paint.code;
    const bool is_again = cell(columns_.date) != open_date_ && has_any_of(readings);
    if (columns_.geometry == kNone || name != open_.paint.name || is_other || is_again) {
      finish_paint();
      open_.date = open_date_ = cell(columns_.date), open_.serial = cell(columns_.serial);
      open_.paint.name = std::move(name);
      open_.paint.gloss = std::move(gloss);
      open_.paint.code = cell(columns_.code);
      open_.paint.paint_class = paint::paint_class_of(cell(columns_.paint_class)).value_or(paint::PaintClass::kUnknown);
      open_.instrument = columns_.instrument == kNone ? instrument_ : cell(columns_.instrument);
    }
    open_.date = paint::span_of_dates(paint::plain_date(open_.date), paint::plain_date(cell(columns_.date)));
    open_.readings.insert(open_.readings.end(), readings.begin(), readings.end());
    if (measured) open_.spectra.push_back(std::move(*measured));
    return {};
  }

  // True where the open paint has a reading like one of these.
  bool has_any_of(const std::vector<SeenReading>& readings) const {
    return std::ranges::any_of(open_.readings, [&](const SeenReading& known) {
      return std::ranges::any_of(readings, [&](const SeenReading& r) {
        return r.condition == known.condition && r.reading.geometry == known.reading.geometry;
      });
    });
  }

  // The spectrum of the row, if it has one, as factors. It becomes a reading where no color stands beside it.
  Result<std::optional<paint::SpectrumReading>> spectrum(const std::string& name,
                                                         const color::ViewingCondition& condition,
                                                         std::vector<SeenReading>& readings) {
    const std::vector<WavelengthColumn>& columns = columns_.wavelengths;
    if (cell(columns[0].at).empty()) return std::optional<paint::SpectrumReading>();
    GONIO_ASSIGN(const auto geometry, geometry_of_row({}));
    if (!geometry) return std::optional<paint::SpectrumReading>();
    paint::SpectrumReading spectrum{*geometry, columns[0].nm, columns[1].nm - columns[0].nm, {}};
    for (const WavelengthColumn& column : columns) {
      GONIO_ASSIGN(const double value, number(column.at));
      if (!(std::abs(value) <= kMostLab))
        return error(fmt::format("the reflectance at {} nm is {}: write a factor", column.nm, value));
      spectrum.factors.push_back(value);
    }
    const auto seen = std::ranges::find(readings, *geometry, [](const SeenReading& r) { return r.reading.geometry; });
    const auto L = seen == readings.end() ? std::nullopt : std::optional(seen->reading.lab.L);
    if (judge_) {
      if (!spectral_norm_) judge_->add(name, *geometry, spectrum.factors, L);
      return std::optional<paint::SpectrumReading>();
    }
    for (double& factor : spectrum.factors) factor *= spectral_norm_ ? 1 / *spectral_norm_ : unit_;
    if (spectral_norm_) normed_.add(name, *geometry, spectrum.factors, L);
    if (const auto checked = check_not_negative(spectrum.factors); !checked.ok()) return error(checked.error().message);
    if (seen == readings.end()) {
      const auto lab = meter_.lab(spectrum, condition);
      if (!lab.ok()) return error(lab.error().message);
      note_uncovered(meter_.held_share(), name, remarks_);
      if (const auto checked = check_lab(*lab); !checked.ok()) return error(checked.error().message);
      readings.push_back({condition, {*geometry, *lab}});
    }
    return std::optional(std::move(spectrum));
  }

  // The condition that the row states, or else the header, or else the options, or else D50/2, which is the standard's
  // condition.
  Result<color::ViewingCondition> condition_of_row() {
    color::ViewingCondition condition = stated_;
    if (!cell(columns_.observer).empty()) {
      condition.observer_deg = color::observer_in(cell(columns_.observer));
      if (condition.observer_deg == 0)
        return error(fmt::format("OBSERVER is \"{}\": write 2 or 10", cell(columns_.observer)));
    }
    if (!cell(columns_.illuminant).empty()) {
      const auto own =
          stated_condition(cell(columns_.illuminant), cell(columns_.observer).empty() ? 0 : condition.observer_deg);
      if (!own.ok()) return error(own.error().message);
      condition = {own->illuminant, own->observer_deg == 0 ? condition.observer_deg : own->observer_deg};
    }
    const bool lacks_illuminant = condition.illuminant.empty() && options_.illuminant.empty(),
               lacks_observer = condition.observer_deg == 0 && options_.observer_deg == 0;
    if (lacks_illuminant || lacks_observer)
      remarks_.note(!lacks_observer ? "states no illuminant: taken as D50; give paint-convert --illuminant if not"
                    : !lacks_illuminant
                        ? "states no observer: taken as 2 deg; give paint-convert --observer if not"
                        : "states neither illuminant nor observer: taken as D50/2; give paint-convert --illuminant "
                          "and --observer if not",
                    "");
    return completed(condition, options_, {"D50", 2});
  }

  // Nothing if the header names a geometry that has no aspecular angle, such as a sphere.
  Result<std::optional<paint::Geometry>> geometry_of_row(const ColorColumns& color) {
    if (color.geometry) return color.geometry;
    if (columns_.geometry != kNone) {
      const auto geometry = paint::parse_geometry(cell(columns_.geometry));
      if (!geometry) return error(geometry.error().message);
      return std::optional(*geometry);
    }
    const paint::Geometry forty_five_zero{45, 45};
    if (stated_geometry_.empty()) {
      remarks_.note("states no geometry: taken as 45/0, that is 45as45", "");
      return std::optional(forty_five_zero);
    }
    return geometry_in_words(stated_geometry_, options_, remarks_);
  }

  void finish_paint() {
    if (open_.paint.name.empty()) return;
    const bool kept = open_.complete(options_, remarks_);
    open_.paint.name = names_.own(open_.paint.name, remarks_);
    if (kept) result_.paints.push_back(std::move(open_.paint));
    open_ = {};
  }

  std::string name_;
  std::string_view text_, current_;
  const ImportOptions& options_;
  ScaleJudge* judge_;
  double unit_;
  Scale stated_scale_ = Scale::kUnstated;  // by the fields of spectra
  ScaleJudge normed_;                      // hears of those whose norm is stated
  XyzScale xyz_scale_;
  int line_ = 0;
  std::vector<std::string> words_;

  std::optional<std::int64_t> announced_;
  std::string instrument_, stated_geometry_;
  std::optional<double> spectral_norm_;  // that stands for the perfect diffuser
  color::ViewingCondition stated_{"", 0};
  Columns columns_;
  SpectralMeter meter_;

  OpenPaint open_;         // without a name while there is none
  std::string open_date_;  // of its first row
  UniqueNames names_;
  Remarks remarks_;
  ImportedPaints result_;
};

}  // namespace

bool looks_cgats(std::string_view head) {
  return head.find("BEGIN_DATA_FORMAT") != std::string_view::npos || head.starts_with("CGATS") ||
         head.find("NUMBER_OF_FIELDS") != std::string_view::npos;
}

Result<ImportedPaints> read_cgats(InputFile input, const ImportOptions& options) {
  return import_text(std::move(input), [&](const std::string& name, std::string_view text) -> Result<ImportedPaints> {
    // Spectra are judged together before they are read. What is wrong with a row is told when it is read.
    ScaleJudge judge;
    ImportOptions all = options;
    all.keep_going = true;
    CgatsParser survey(name, text, all, &judge, 1);
    const auto surveyed = survey.parse();
    Remarks remarks;
    const auto unit = judge.unit(survey.stated_scale(), options.scale, remarks);
    if (surveyed.ok() && !unit.ok()) return input_error("{}: {}", name, unit.error().message);
    CgatsParser parser(name, text, options, nullptr, unit.ok() ? *unit : 1);
    GONIO_ASSIGN(ImportedPaints paints, parser.parse());
    for (const std::string& remark : remarks.lines()) paints.warnings.push_back(remark);
    return Result(std::move(paints));
  });
}

}  // namespace goniochrome::formats
