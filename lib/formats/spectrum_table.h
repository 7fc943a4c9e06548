// Tables of spectra in text (CSV): lights or reflectances, one in each column. goniochrome-paint(5), TABLES OF SPECTRA.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"

namespace goniochrome::formats {

struct SpectrumTable {
  std::vector<std::string> names;
  std::vector<double> wavelengths_nm;        // ascending
  std::vector<std::vector<double>> columns;  // one for each name, with a value for each wavelength

  // Error: the names that there are.
  Result<std::vector<double>> column(const std::string& name) const;
};

// The first row has names, of which the first is that of the wavelengths. Rows whose first cell is no number, such as
// one with remarks on the columns, are passed over. Error: file and line, and what is wrong there.
Result<SpectrumTable> read_spectrum_table(const std::string& path);

}  // namespace goniochrome::formats
