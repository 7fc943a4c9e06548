// Which rows of a paint are written, and what an output format loses.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "formats.h"
#include "formats/imported.h"
#include "tool.h"

namespace goniochrome::tool {

class Selection {
 public:
  // Error (usage): a geometry that is not understood or given twice.
  static Result<Selection> make(const Options& options, const OutputFormat& format);

  // The columns of a table.
  formats::CsvLayout layout() const;

  // The geometries of --geometry; none where it was not given.
  std::vector<paint::Geometry> requested() const;

  // Fits, selects and adds rows. `from_curve` gets the geometries of the rows that were added, `remarks` what is lost
  // on the way. Error: the paint has nothing to write.
  Result<void> apply(paint::Paint& paint, std::vector<paint::Geometry>& from_curve, formats::Remarks& remarks) const;

  // For --explain.
  std::string explanation() const;

 private:
  Selection(const Options& options, const OutputFormat& format) : options_(options), format_(format) {}
  std::vector<paint::Geometry> wanted(const paint::Paint& paint) const;
  void add_missing(paint::Paint& paint, std::vector<paint::Geometry>& from_curve, formats::Remarks& remarks) const;
  void keep_chosen(paint::Paint& paint, formats::Remarks& remarks) const;
  void note_losses(const paint::Paint& paint, bool designed, formats::Remarks& remarks) const;

  const Options& options_;
  const OutputFormat& format_;
  std::vector<paint::Geometry> chosen_;  // of --geometry, or of a wide table's usual columns
};

}  // namespace goniochrome::tool
