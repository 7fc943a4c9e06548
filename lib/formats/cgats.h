// Paints in CGATS.17 text, which is a header of keywords and then a table. We write one row for each reading, and
// announce the columns that the standard does not have by KEYWORD, as it asks. goniochrome-paint(5).
#pragma once

#include <set>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/result.h"
#include "formats/imported.h"
#include "paint/paint.h"

namespace goniochrome::formats {

// True if a file that begins with `head` is CGATS text.
bool looks_cgats(std::string_view head);

// Reads LAB_ or XYZ_ columns, and spectra (SPECTRAL_NM_400, nm400, SPEC_400), from which it integrates colors where
// there are none. Names come from SAMPLE_NAME or SAMPLE_ID; the geometry comes from GEOMETRY, from the endings of
// columns (LAB_L_45as15) or from MEASUREMENT_GEOMETRY; the viewing condition comes from columns or from any of the
// keywords in use. What the file does not say is assumed and remarked: D50/2 and 45/0, as in ISO 13655. Errors name
// file, line and cell.
Result<ImportedPaints> read_cgats(InputFile input, const ImportOptions& options);

// Writes paints as one table. The header counts the rows, so the paints are held in memory until finish().
class CgatsWriter {
 public:
  // `creator` and `created` (a date) go into the header.
  static Result<CgatsWriter> begin(OutputFile file, const std::string& creator, const std::string& created);
  // The readings at the geometries `from_curve` are marked in a column ORIGIN. Error: a paint without readings.
  Result<void> write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve = {});
  Result<void> finish();

 private:
  CgatsWriter(OutputFile file, std::string head) : file_(std::move(file)), head_(std::move(head)) {}
  OutputFile file_;
  std::string head_;
  std::vector<paint::Paint> paints_;
  std::vector<std::vector<paint::Geometry>> from_curve_;  // of each paint
  std::set<std::string> names_;                           // as they are written
};

}  // namespace goniochrome::formats
