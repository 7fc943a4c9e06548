#include "matching_table.h"

#include <cmath>

#include "base/file.h"
#include "base/text.h"

namespace goniochrome::tool {

Result<std::vector<color::Rgb>> read_matching_table(const std::string& path) {
  GONIO_ASSIGN(const std::string text, file_content(path));
  std::vector<color::Rgb> table;
  std::vector<double> wavelengths;
  int number = 0;
  for (const std::string_view raw : split(text, '\n')) {
    ++number;
    const std::string_view line = trimmed(raw);
    if (line.empty() || line.front() == '#') continue;
    const auto words = split(line, ',');
    if (table.empty() && !parse_number(trimmed(words.front()))) continue;  // the names of the columns
    if (words.size() != 4)
      return input_error("{}:{}: {} columns: give a wavelength and three values", path, number, words.size());
    double values[4];
    for (std::size_t k = 0; k < 4; ++k) {
      const auto value = parse_number(trimmed(words[k]));
      if (!value) return input_error("{}:{}: \"{}\" is not a number", path, number, words[k]);
      values[k] = *value;
    }
    const std::size_t n = wavelengths.size();
    wavelengths.push_back(values[0]);
    table.push_back({values[1], values[2], values[3]});
    if (n < 1) continue;
    const double step = wavelengths[1] - wavelengths[0];
    if (!(step > 0) || std::abs(wavelengths[n] - wavelengths[n - 1] - step) > 1e-6 * step)
      return input_error("{}:{}: wavelength {} breaks the equal steps of {}", path, number, values[0], step);
  }
  return table;
}

}  // namespace goniochrome::tool
