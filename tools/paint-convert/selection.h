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

  // Fits, selects and adds rows. `remarks` gets what is lost on the way. Error: the paint has nothing to write.
  Result<void> apply(paint::Paint& paint, formats::Remarks& remarks) const;

  // For --explain.
  std::string explanation() const;

 private:
  Selection(const Options& options, const OutputFormat& format) : options_(options), format_(format) {}
  void keep_chosen(paint::Paint& paint, formats::Remarks& remarks) const;
  void note_losses(const paint::Paint& paint, bool designed, formats::Remarks& remarks) const;

  const Options& options_;
  const OutputFormat& format_;
  std::vector<paint::Geometry> chosen_;  // of --geometry, or of a wide table's usual columns
};

}  // namespace goniochrome::tool
