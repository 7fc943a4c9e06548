// MTF, a report as it is printed. A table of percent has a row for each hundred nanometers and a column for each ten:
//     nm     0     10     20     30    40     50    60     70     80    90
//     300                                           0.000  0.000  0.000 0.000
//     400    62.03563.000 63.565 63.94864.255 64.56364.573 64.204 63.50162.849
// Values have three decimals each, and may touch. The reference stands above its table as `Name :...`, and a sample as
// a row `1/1   ID   NAME` that ends in six numbers.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/text.h"
#include "formats/importers.h"
#include "formats/internal/spectral_records.h"

namespace goniochrome::formats {

namespace {

constexpr int kMtfColumns = 10, kMtfStep_nm = 10;
constexpr std::size_t kMtfDifferences = 6;  // dE dL da db dC dH behind a name

// The values of a row, and where each begins. They may touch, since each has three decimals.
struct MtfRow {
  std::vector<double> values;
  std::vector<std::size_t> at;
};
Result<MtfRow> mtf_values(std::string_view line, std::size_t from) {
  MtfRow row;
  constexpr std::size_t kDecimals = 3;
  for (std::size_t i = line.find_first_not_of(" \t", from); i < line.size(); i = line.find_first_not_of(" \t", i)) {
    const std::size_t point = line.find('.', i);
    const std::size_t end =
        point == std::string_view::npos ? line.size() : std::min(point + 1 + kDecimals, line.size());
    const std::string_view word = line.substr(i, end - i);
    const auto value = parse_number(word);
    if (!value || point == std::string_view::npos || end != point + 1 + kDecimals ||
        std::abs(*value) > kLargestReflectance)
      return input_error("\"{}\" is no percentage with three decimals: the file is damaged, or was cut off",
                         shown(word));
    row.values.push_back(*value), row.at.push_back(i);
    i = end;
  }
  return row;
}

class MtfParser {
 public:
  MtfParser(const std::string& file, std::string_view text, const ImportOptions& options)
      : text_(text), import_(file, "MTF", options) {}

  Result<ImportedPaints> parse() {
    for (; !text_.empty();) {
      const std::size_t end = std::min(text_.find('\n'), text_.size());
      std::string_view line = text_.substr(0, end);
      text_.remove_prefix(std::min(end + 1, text_.size()));
      if (line.ends_with('\r')) line.remove_suffix(1);
      ++line_;
      const Result<void> taken = take(line);
      if (!taken.ok()) {
        columns_.clear();
        GONIO_TRY(import_.refuse(line_, taken.error().message));
      }
    }
    close_table();
    if (!any_table_)
      return input_error("{}:{}: has no table of wavelengths: the file was cut off", import_.file(), line_);
    return import_.finish();
  }

 private:
  Result<void> take(std::string_view line) {
    const std::string_view text = trimmed(line);
    if (text.starts_with("nm ")) return begin_table(line);
    if (!columns_.empty() && text.size() >= 3 && parse_integer(text.substr(0, 3)) &&
        parse_integer(text.substr(0, 3)) >= 100)
      return take_row(line);
    close_table();
    if (const auto value = behind(text, "Name"); value && has_reference_) record_.name = *value;
    if (const auto value = behind(text, "Designation"); value && has_reference_) record_.name = *value;
    if (const auto value = behind(text, "Date"); value && has_reference_) record_.date = *value;
    if (const auto value = behind(text, "Status"); value && has_reference_) take_status(*value);
    if (text.starts_with("Reference")) record_ = {}, has_reference_ = true;
    const std::size_t slash = text.find('/');
    if (slash != std::string_view::npos && slash > 0 && parse_integer(text.substr(0, slash))) take_sample(text);
    return {};
  }

  // The value behind `key   :`.
  static std::optional<std::string_view> behind(std::string_view text, std::string_view key) {
    const std::size_t colon = text.find(':');
    if (!text.starts_with(key) || colon == std::string_view::npos) return std::nullopt;
    return trimmed(text.substr(colon + 1));
  }

  // `CM3700d/Reflexion/Black-White calibration/SCI/...`: the instrument, and the viewing of all spectra, which may be
  // of light that went through.
  void take_status(std::string_view status) {
    const auto words = split(status, '/');
    if (!words.front().starts_with("---")) instrument_ = trimmed(words.front());
    for (const std::string_view word : words) {
      if (trimmed(word) == "SCI" || trimmed(word) == "SCE") viewing_ = trimmed(word);
      if (lower(trimmed(word)).starts_with("transm")) unlike_reflectance_ = trimmed(word);
    }
  }

  // `1/1   ID   NAME ... 88.43 90.02 -0.17 5.02 5.02 0.01`: the name is what is left between the number and the last
  // six.
  void take_sample(std::string_view text) {
    std::vector<std::string_view> words;
    for (const std::string_view word : split(text, ' '))
      if (!word.empty()) words.push_back(word);
    const std::size_t end = words.size() > kMtfDifferences ? words.size() - kMtfDifferences : words.size();
    for (std::size_t i = end; i < words.size(); ++i)
      if (!parse_number(words[i])) return;
    record_ = {};
    has_reference_ = false;
    for (std::size_t i = 1; i < end; ++i) record_.name += (i > 1 ? " " : "") + std::string(words[i]);
  }

  Result<void> begin_table(std::string_view line) {
    close_table();
    for (int k = 0; k < kMtfColumns; ++k) {
      const std::string head = std::to_string(k * kMtfStep_nm);
      const std::size_t from = columns_.empty() ? line.find("nm") + 2 : columns_.back() + 1;
      const std::size_t at = line.find(" " + head, from);
      if (at == std::string_view::npos) {
        columns_.clear();
        return input_error("the heads of a table of wavelengths are nm, 0, 10 and so on to 90");
      }
      columns_.push_back(at + 1);
    }
    any_table_ = true;
    return {};
  }

  // Each value of a row stands under the head of its wavelength, and none is missing between two others.
  Result<void> take_row(std::string_view line) {
    const std::size_t from = line.find_first_not_of(" \t");
    const auto hundreds = static_cast<int>(*parse_integer(line.substr(from, 3)));
    GONIO_ASSIGN(const MtfRow row, mtf_values(line, from + 3));
    if (row.values.empty()) return {};
    const auto head_of = [&](std::size_t at) {
      const auto distance = [&](std::size_t column) { return column > at ? column - at : at - column; };
      return static_cast<int>(std::ranges::min_element(columns_, {}, distance) - columns_.begin());
    };
    const int first = head_of(row.at.front());
    const int nm = hundreds + first * kMtfStep_nm;
    const double next_nm = first_nm_ + kMtfStep_nm * static_cast<double>(values_.size());
    if (values_.empty()) first_nm_ = nm;
    if (first + static_cast<int>(row.values.size()) > kMtfColumns || (!values_.empty() && nm != next_nm))
      return input_error(
          "the row of {} nm has {} values from {} nm on, where that of {} nm comes next: the file is damaged", hundreds,
          row.values.size(), nm, shortest(next_nm));
    for (std::size_t i = 0; i < row.values.size(); ++i)
      if (head_of(row.at[i]) != first + static_cast<int>(i))
        return input_error("no value stands at {} nm, and {} nm has one: the file is damaged",
                           nm + static_cast<int>(i) * kMtfStep_nm, hundreds + head_of(row.at[i]) * kMtfStep_nm);
    values_.insert(values_.end(), row.values.begin(), row.values.end());
    return {};
  }

  // Programs fill the wavelengths that an instrument does not measure with zeros.
  void close_table() {
    if (columns_.empty()) return;
    columns_.clear();
    SpectralRecord record = record_;
    std::size_t begin = 0, end = values_.size();
    while (begin < end && values_[begin] == 0) ++begin;
    while (end > begin && values_[end - 1] == 0) --end;
    if (end - begin < values_.size() && end > begin)
      import_.remarks().note("zeros at the ends of spectra are taken as not measured", shown(record.name));
    record.values.assign(values_.begin() + static_cast<std::ptrdiff_t>(begin),
                         values_.begin() + static_cast<std::ptrdiff_t>(end));
    record.first_nm = first_nm_ + kMtfStep_nm * static_cast<double>(begin), record.step_nm = kMtfStep_nm;
    values_.clear();
    record.scale = Scale::kPercent, record.viewing = viewing_, record.instrument = instrument_;
    if (!unlike_reflectance_.empty())
      import_.remarks().note(
          fmt::format("values of {} are of no reflected light and were left out", shown(unlike_reflectance_)),
          shown(record.name));
    else if (record.values.size() >= 2)
      import_.add(std::move(record));
    else
      import_.remarks().note("tables without values were left out", shown(record.name));
  }

  std::string_view text_;
  int line_ = 0;
  RecordImport import_;
  SpectralRecord record_;
  bool has_reference_ = false, any_table_ = false;
  std::string viewing_, instrument_, unlike_reflectance_;
  std::vector<std::size_t> columns_;  // where the heads of the open table begin
  std::vector<double> values_;
  double first_nm_ = 0;
};

}  // namespace

bool looks_mtf(std::string_view head) {
  return head.find("QTEX Statistics") != std::string_view::npos;
}

Result<ImportedPaints> read_mtf(InputFile input, const ImportOptions& options) {
  return import_text(std::move(input), [&](const std::string& name, std::string_view text) {
    return MtfParser(name, text, options).parse();
  });
}

}  // namespace goniochrome::formats
