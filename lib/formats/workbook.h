// Paints in the workbooks (XLSX) that multi-angle instruments and their programs export. Tables of colors and of
// spectra are found on all sheets by their headings and by what stands below them. goniochrome-paint(5), WORKBOOKS.
#pragma once

#include <string_view>

#include "base/file.h"
#include "base/result.h"
#include "formats/imported.h"

namespace goniochrome::formats {

// Whether a file that begins with `head` is a workbook, a ZIP archive, or an old workbook.
bool looks_workbook(std::string_view head);

// Reads every paint, which is a name and, where there is one, a date. Readings of one paint may stand on several
// sheets. Where a geometry has a spectrum and no Lab, the Lab is integrated from it. Values of texture are kept as they
// stand. Where it has both and they disagree, the Lab is taken and a remark tells by how much. Errors name file, sheet
// and row.
Result<ImportedPaints> read_workbook(InputFile input, const ImportOptions& options);

}  // namespace goniochrome::formats
