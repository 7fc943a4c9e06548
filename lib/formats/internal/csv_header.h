// The headings of tables in text (CSV), and what their columns mean.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "formats/internal/spectral_rows.h"
#include "paint/geometry.h"

namespace goniochrome::formats {

// The header of a long table.
inline constexpr const char* kLongHeader = "sample,geometry,illuminant,observer,L,a,b";

// The columns that have names of their own.
enum CsvColumn {
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
  kDate,
  kSerial,
  kColumns
};

// Lab of one geometry in a wide table: where its three columns are.
struct CsvTriple {
  paint::Geometry geometry;
  std::array<int, 3> column = {-1, -1, -1};
};

// The meaning of each column of a table.
struct CsvHeader {
  std::vector<std::string> headings;  // as written
  std::array<int, kColumns> column;
  std::vector<CsvTriple> triples;
  std::vector<WavelengthColumn> wavelengths;  // five or more, or none
  std::vector<std::string> unknown;
  std::string taken_for_sample;    // the heading of the first column, where no heading says where the names are
  Scale scale = Scale::kUnstated;  // of the reflectances, where the headings state it
  bool is_wide() const { return column[kGeometry] < 0; }
};

// The meaning of the cells of the first row. Error: a column is missing, or is there twice; without the place.
Result<CsvHeader> header_of(const std::vector<std::string>& cells);

// An angle without the degree sign that instruments add: `-15°`.
std::string without_degree_sign(std::string_view angle);

}  // namespace goniochrome::formats
