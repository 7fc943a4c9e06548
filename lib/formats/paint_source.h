// The paints of a file in any of the formats of this room, one after the other. Its first bytes tell the format.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/file.h"
#include "base/json.h"
#include "base/result.h"
#include "formats/imported.h"
#include "formats/reference.h"
#include "formats/xml.h"

namespace goniochrome::formats {

class PaintSource {
 public:
  virtual ~PaintSource() = default;
  // The next paint, or nothing at the end. After an error next() goes on with what can still be read.
  virtual Result<std::optional<paint::Paint>> next() = 0;
  // The place of the paint that was returned last: `file:line`.
  virtual std::string place() const = 0;
  // "paint XML", "long table", ...
  virtual std::string format() const = 0;
  // True if its paints may have a face and a flop beside their readings.
  virtual bool holds_designs() const { return false; }
  // The steps that made the file, and foreign elements; of paint XML alone. Read as far as the first paint.
  virtual std::vector<Processing> processing() { return {}; }
  virtual std::vector<std::string> foreign() { return {}; }
  virtual std::vector<std::string> warnings() const { return {}; }
  // Warnings that are complete after the last paint only.
  virtual std::vector<std::string> closing_warnings() const { return {}; }
  // Figures for a report, complete after the last paint; null where a format has none.
  virtual Json figures() const { return {}; }
};
using PaintSourcePointer = std::unique_ptr<PaintSource>;

// A format: its word for --from, what tells it, and its reader.
struct PaintFormat {
  const char* name;
  bool (*looks)(std::string_view head);
  Result<PaintSourcePointer> (*open)(InputFile input, const ImportOptions& options);
};
// In the order in which they are tried.
const std::vector<PaintFormat>& paint_formats();

// The first bytes of a file as the formats look at them: as UTF-8, without a byte order mark. Error: it is empty.
Result<std::string> head_of(InputFile& input);

// The paints of a source that have certain names. `file` is what errors call it.
PaintSourcePointer named_paints(std::string file, PaintSourcePointer all, NameChoice choice);

// Opens FILE, or FILE#NAMES for some of its paints; or goes on with an open file, from which `names` are wanted. Error:
// the file cannot be read, or has none of the formats.
Result<PaintSourcePointer> open_paints(const std::string& reference, const ImportOptions& options = {});
Result<PaintSourcePointer> open_paints(InputFile input, std::optional<std::string> names,
                                       const ImportOptions& options = {});

// All paints of a file, for tools that need them at once. `warnings`, if given, gets those of the source.
Result<std::vector<paint::Paint>> read_paints(const std::string& reference,
                                              std::vector<std::string>* warnings = nullptr);
Result<std::vector<paint::Paint>> read_paints(PaintSource& source, std::vector<std::string>* warnings = nullptr);

}  // namespace goniochrome::formats
