// Which rows of a paint are written, and what an output format loses.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "formats.h"
#include "options.h"
#include "paint/imported.h"

namespace goniochrome {

class Selection {
 public:
  // Error (usage): a geometry that is not understood or given twice.
  static Result<Selection> make(const Options& options, const OutputFormat& format);

  // The columns of a table.
  CsvLayout layout() const;

  // The geometries of --geometry; none where it was not given.
  std::vector<Geometry> requested() const;

  // Fits, selects and adds rows. What is lost on the way goes to `remarks`. Error: the paint has nothing to write.
  Result<void> apply(Paint& paint, Remarks& remarks) const;

  // For --explain.
  std::string explanation() const;

 private:
  Selection(const Options& options, const OutputFormat& format) : options_(options), format_(format) {}
  void keep_chosen(Paint& paint, Remarks& remarks) const;
  void note_losses(const Paint& paint, bool designed, Remarks& remarks) const;

  const Options& options_;
  const OutputFormat& format_;
  std::vector<Geometry> chosen_;  // of --geometry, or of a wide table's usual columns
};

}  // namespace goniochrome
