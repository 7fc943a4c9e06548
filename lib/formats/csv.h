// Paints as tables in text (CSV), read and written as a stream. A long table has one row for each sample and geometry,
// `sample,geometry,illuminant,observer,L,a,b`. A wide table has one row for each sample,
// `sample,illuminant,observer,L15,a15,b15,...`. A long table may also have spectra, in columns named by their
// wavelengths. goniochrome-paint(5), "TABLES".
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/result.h"
#include "formats/imported.h"
#include "paint/paint.h"

namespace goniochrome::formats {

class CsvPaintReader {
 public:
  // Opens `path` ("-" is standard input), or goes on with an open file, and reads the header. Error: file, line, and
  // what a header is. `scale` is that of spectra where the table does not state it; see ImportOptions.
  static Result<CsvPaintReader> open(const std::string& path);
  static Result<CsvPaintReader> open(InputFile input, Scale scale = Scale::kUnstated);
  CsvPaintReader(CsvPaintReader&&) noexcept;
  ~CsvPaintReader();

  // The next paint, or nothing at the end. Where a column origin marks some rows of a paint as from its curve, and
  // others not, only the latter are read: the curve is not a second measurement. An error loses one row: next() goes on
  // behind it with the other rows of the same sample. In a long table the rows of one sample must stand together, and
  // all but the first may leave its name out. A table of spectra that does not state their scale is read twice.
  Result<std::optional<paint::Paint>> next();

  // The line (from 1) of the first row of the paint last returned.
  int line() const;
  // True if the table is a wide one.
  bool is_wide() const;
  // Warnings about the header: columns that are not read, and a viewing condition that is assumed.
  const std::vector<std::string>& warnings() const;
  // Assumptions about the rows so far.
  std::vector<std::string> closing_warnings() const;

 private:
  struct State;
  explicit CsvPaintReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

struct CsvLayout {
  // The geometries of a wide table, in order. Empty: the table is long.
  std::vector<paint::Geometry> wide;
  // The table also has the columns class, code, instrument, gloss20, gloss60, gloss85, serial and date.
  bool all_columns = false;
  // The table has a last column origin, which marks rows that come from the curve of a paint.
  bool origin = false;
  // A long table also has columns of wavelengths, which are those of the first spectrum of the first paint.
  bool spectra = false;
};

class CsvPaintWriter {
 public:
  // Begins a table on `file`.
  static Result<CsvPaintWriter> begin(OutputFile file, const CsvLayout& layout);
  // Writes the rows of one paint and hands them on at once where the output is standard output or a pipe. In the column
  // origin, the rows at the geometries `from_curve` are `curve` and the others `row`; a wide table lists the former.
  // Error: a paint without rows, or with one that the layout has no column for.
  Result<void> write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve = {});
  // Puts the file in place.
  Result<void> finish();
  // Which spectra the table has no columns for.
  std::vector<std::string> warnings() const { return remarks_.lines(); }

 private:
  Result<void> write_header();
  void choose_wavelengths(const paint::Measurement& measurement);
  std::string spectrum_cells(const paint::Paint& paint, const paint::Geometry& geometry) const;
  void note_spectra_left_out(const paint::Paint& paint);
  bool has_columns_for(const paint::SpectrumReading& spectrum) const;

  CsvPaintWriter(OutputFile file, CsvLayout layout)
      : file_(std::move(file)), layout_(std::move(layout)), is_stream_(file_.scratch_path().empty()) {}
  OutputFile file_;
  CsvLayout layout_;
  bool is_stream_;
  bool has_header_ = false;
  // The wavelengths of the table, with no values; nothing where it has none.
  std::optional<paint::SpectrumReading> wavelengths_;
  std::size_t wavelength_count_ = 0;
  Remarks remarks_;
};

}  // namespace goniochrome::formats
