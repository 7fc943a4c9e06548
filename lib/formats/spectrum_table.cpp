#include "formats/spectrum_table.h"

#include <algorithm>

#include "base/file.h"
#include "base/text.h"
#include "formats/encoding.h"

namespace goniochrome::formats {

namespace {

constexpr std::size_t kMostNames = 40;  // in a message

std::string_view without_return(std::string_view line) {
  return line.ends_with('\r') ? line.substr(0, line.size() - 1) : line;
}

}  // namespace

Result<std::vector<double>> SpectrumTable::column(const std::string& name) const {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return columns[static_cast<std::size_t>(found - names.begin())];
  std::string all;
  for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) all += (i == 0 ? "" : ", ") + shown(names[i]);
  return input_error("there is no spectrum \"{}\": there are {}{}", shown(name), all,
                     names.size() > kMostNames ? ", ..." : "");
}

Result<SpectrumTable> read_spectrum_table(const std::string& path) {
  GONIO_ASSIGN(const std::string bytes, file_content(path));
  const std::string text = as_utf8(bytes);
  std::string_view rest = text;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  SpectrumTable table;
  int line = 0;
  for (const std::string_view raw : split(rest, '\n')) {
    ++line;
    const std::string_view row = without_return(raw);
    if (trimmed(row).empty()) continue;
    const auto words = split(row, ',');
    if (table.names.empty()) {
      for (std::size_t i = 1; i < words.size(); ++i) table.names.emplace_back(trimmed(words[i]));
      if (table.names.empty())
        return input_error("{}:{}: a table of spectra has the names of its columns here, separated by commas", path,
                           line);
      table.columns.resize(table.names.size());
      continue;
    }
    const auto nm = parse_number(trimmed(words.front()));
    if (!nm && table.wavelengths_nm.empty()) continue;
    if (words.size() != table.names.size() + 1)
      return input_error("{}:{}: {} cells where the first row has {}", path, line, words.size(),
                         table.names.size() + 1);
    if (!nm || (!table.wavelengths_nm.empty() && !(*nm > table.wavelengths_nm.back())))
      return input_error("{}:{}: the wavelength is \"{}\": wavelengths in nanometers ascend", path, line,
                         shown(words.front()));
    table.wavelengths_nm.push_back(*nm);
    for (std::size_t i = 1; i < words.size(); ++i) {
      const auto value = parse_number(trimmed(words[i]));
      if (!value)
        return input_error("{}:{}: {} is \"{}\": write a number", path, line, shown(table.names[i - 1]),
                           shown(words[i]));
      table.columns[i - 1].push_back(*value);
    }
  }
  if (table.wavelengths_nm.size() < 2)
    return input_error("{}: a table of spectra has a row for each of at least two wavelengths", path);
  return table;
}

}  // namespace goniochrome::formats
