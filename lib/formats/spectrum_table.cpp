#include "formats/spectrum_table.h"

#include <algorithm>

#include "base/csv_records.h"
#include "base/text.h"
#include "formats/internal/spectral_rows.h"

namespace goniochrome::formats {

namespace {

constexpr std::size_t kMostNames = 40;  // in a message
// A surface or filter passes no more than all light, but for fluorescence, and twice that in no case.
constexpr double kMostFactor = 2;

// A name without a unit behind it: `cyan [%]` is cyan.
std::string without_unit(std::string_view name) {
  const auto bracket = name.find_last_of("[(");
  const bool has_unit =
      bracket != std::string_view::npos && bracket > 0 && scale_in(name.substr(bracket)) != Scale::kUnstated;
  return std::string(trimmed(has_unit ? name.substr(0, bracket) : name));
}

}  // namespace

Result<std::vector<double>> SpectrumTable::column(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  if (std::ranges::count(names, name) > 1)
    return input_error("{} columns are named \"{}\": rename all but one", std::ranges::count(names, name), shown(name));
  if (found != names.end()) return columns[static_cast<std::size_t>(found - names.begin())];
  std::string all;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) all += (i == 0 ? "" : ", ") + shown(names[i]);
  return input_error("there is no spectrum \"{}\": there are {}{}", shown(name), all,
                     names.size() > kMostNames ? ", ..." : "");
}

Result<std::vector<double>> SpectrumTable::factors(const std::string& name) const {
  GONIO_ASSIGN(std::vector<double> values, column(name));
  const Scale scale = scales[static_cast<std::size_t>(std::ranges::find(names, name) - names.begin())];
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (scale == Scale::kPercent) values[i] /= 100;
    if (!(values[i] <= kMostFactor))
      return input_error("\"{}\" is {} at {} nm, which no filter is as a factor: head it \"{} [%]\" if it is percent",
                         shown(name), shortest(values[i]), shortest(wavelengths_nm[i]), shown(name));
  }
  return values;
}

Result<SpectrumTable> read_spectrum_table(const std::string& path) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::vector<TableRow> rows, table_rows(CsvRecords(std::move(input))));
  SpectrumTable table;
  for (const auto& [line, cells] : rows) {
    if (table.names.empty()) {
      for (std::size_t i = 1; i < cells.size(); ++i) {
        table.names.push_back(without_unit(cells[i]));
        table.scales.push_back(scale_in(cells[i]));
      }
      if (table.names.empty())
        return input_error("{}:{}: a table of spectra has the names of its columns here, separated by commas", path,
                           line);
      table.columns.resize(table.names.size());
      continue;
    }
    const auto nm = number_in_cell(cells.front());
    if (!nm && table.wavelengths_nm.empty()) {
      for (std::size_t i = 1; i < std::min(cells.size(), table.scales.size() + 1); ++i)
        if (const Scale stated = scale_in(cells[i]); stated != Scale::kUnstated) table.scales[i - 1] = stated;
      continue;
    }
    if (cells.size() != table.names.size() + 1)
      return input_error("{}:{}: {} cells where the first row has {}", path, line, cells.size(),
                         table.names.size() + 1);
    if (!nm || (!table.wavelengths_nm.empty() && !(*nm > table.wavelengths_nm.back())))
      return input_error("{}:{}: the wavelength is \"{}\": wavelengths in nanometers ascend", path, line,
                         shown(cells.front()));
    table.wavelengths_nm.push_back(*nm);
    for (std::size_t i = 1; i < cells.size(); ++i) {
      const auto value = number_in_cell(cells[i]);
      if (!value)
        return input_error("{}:{}: {} is \"{}\": write a number", path, line, shown(table.names[i - 1]),
                           shown(cells[i]));
      table.columns[i - 1].push_back(*value);
    }
  }
  if (table.wavelengths_nm.size() < 2)
    return input_error("{}: a table of spectra has a row for each of at least two wavelengths", path);
  return table;
}

}  // namespace goniochrome::formats
