// Tables of spectra in text (CSV): lights or reflectances, one in each column.
// goniochrome-paint(5), "TABLES OF SPECTRA".
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "formats/imported.h"

namespace goniochrome::formats {

struct SpectrumTable {
  std::vector<std::string> names;            // without a unit in brackets
  std::vector<Scale> scales;                 // as headings (`cyan [%]`) or a row of units state them
  std::vector<double> wavelengths_nm;        // ascending
  std::vector<std::vector<double>> columns;  // one for each name, with a value for each wavelength

  // A column as it stands. Error: the names that there are.
  Result<std::vector<double>> column(const std::string& name) const;
  // A column as factors: those of percent where the table states it. Error: the names; or a value that no filter and
  // no surface has as a factor, in a column of no stated scale.
  Result<std::vector<double>> factors(const std::string& name) const;
};

// The first row has names, of which the first is that of the wavelengths. Rows whose first cell is no number, such as
// one with the units of the columns, are passed over. Error: file and line, and what is wrong there.
Result<SpectrumTable> read_spectrum_table(const std::string& path);

}  // namespace goniochrome::formats
