// The formats that are read as a whole, in the order in which a file is tried: which there are, how their first bytes
// look, and what reads them. Each gives paints, and tells what it left out.
#pragma once

#include <string_view>

#include "base/file.h"
#include "base/result.h"
#include "formats/cgats.h"
#include "formats/imported.h"

namespace goniochrome::formats {

struct Importer {
  const char* name;   // as --from has it
  const char* title;  // as reports have it
  bool (*looks)(std::string_view head);
  Result<ImportedPaints> (*read)(InputFile input, const ImportOptions& options);
};

// The workbooks (XLSX) of multi-angle instruments and their programs. Tables of colors and of spectra are found on all
// sheets by their headings. A paint is a name and, where there is one, a date, and may stand on several sheets. Where a
// geometry has a spectrum and no Lab, the Lab is integrated from it; where it has both and they disagree, the Lab is
// taken and a remark tells by how much. Errors name file, sheet and row. goniochrome-paint(5), "WORKBOOKS".
bool looks_workbook(std::string_view head);
Result<ImportedPaints> read_workbook(InputFile input, const ImportOptions& options);

// QTX, the exchange format of color quality programs: a section for each standard and batch, whose spectrum is percent.
// The viewing is stated in words. goniochrome-paint(5), "FILES OF INSTRUMENTS"; so are those below.
bool looks_qtx(std::string_view head);
Result<ImportedPaints> read_qtx(InputFile input, const ImportOptions& options);

// MIF and XTF: a section for each standard and sample, with 31 values in percent from 400 to 700 nm at each angle.
bool looks_mif(std::string_view head);
Result<ImportedPaints> read_mif(InputFile input, const ImportOptions& options);
bool looks_xtf(std::string_view head);
Result<ImportedPaints> read_xtf(InputFile input, const ImportOptions& options);

// MTF, a printed report with tables of spectra in percent.
bool looks_mtf(std::string_view head);
Result<ImportedPaints> read_mtf(InputFile input, const ImportOptions& options);

// JCAMP-DX, the exchange format of spectrometers, as far as its spectra are of reflected light.
bool looks_jcamp(std::string_view head);
Result<ImportedPaints> read_jcamp(InputFile input, const ImportOptions& options);

inline constexpr Importer kWorkbook = {"workbook", "workbook", looks_workbook, read_workbook};
inline constexpr Importer kCgats = {"cgats", "CGATS text", looks_cgats, read_cgats};
inline constexpr Importer kQtx = {"qtx", "QTX", looks_qtx, read_qtx};
inline constexpr Importer kMif = {"mif", "MIF", looks_mif, read_mif};
inline constexpr Importer kXtf = {"xtf", "XTF", looks_xtf, read_xtf};
inline constexpr Importer kMtf = {"mtf", "MTF", looks_mtf, read_mtf};
inline constexpr Importer kJcamp = {"jcamp", "JCAMP-DX", looks_jcamp, read_jcamp};

}  // namespace goniochrome::formats
