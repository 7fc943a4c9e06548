// Spectra as the files of instruments state them, and the paints that become of them: what all formats share that have
// a spectrum, a name and some words on how it was measured.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/encoding.h"
#include "base/file.h"
#include "base/result.h"
#include "color/color.h"
#include "formats/imported.h"
#include "formats/internal/spectral_rows.h"

namespace goniochrome::formats {

struct SpectralRecord {
  std::string name, code, instrument, date;
  std::string viewing;                       // the file's words on light and detector
  std::optional<paint::Geometry> geometry;   // where the file names it otherwise
  bool joins = false;                        // is of the paint of the record before
  color::ViewingCondition condition{"", 0};  // as far as it is stated
  double first_nm = 0, step_nm = 0;          // of values in equal steps
  std::vector<double> nm;                    // of others
  std::vector<double> values;                // none: `xyz` alone
  Scale scale = Scale::kUnstated;            // as the file or its format states it
  std::optional<color::Xyz> xyz;             // Y = 100 for the perfect diffuser, under `condition`
};

// Gathers the records of a file, judges their scale together, and makes paints of them.
class RecordImport {
 public:
  // `format` is what messages call the format.
  RecordImport(std::string file, std::string format, const ImportOptions& options)
      : file_(std::move(file)), format_(std::move(format)), options_(options) {}

  void add(SpectralRecord record) { records_.push_back(std::move(record)); }
  // Passes over what is wrong at a line where the options say so; otherwise returns the error.
  Result<void> refuse(int line, const std::string& why);
  Remarks& remarks() { return remarks_; }
  const std::string& file() const { return file_; }

  // The paints. Error: nothing states the scale, or two statements of it differ.
  Result<ImportedPaints> finish();

 private:
  Result<void> find_units();
  void make_paint(SpectralRecord& record);
  std::optional<color::Lab> color_of(const SpectralRecord& record, const paint::Geometry& geometry,
                                     const color::ViewingCondition& condition);
  void close_paint();

  std::string file_, format_;
  const ImportOptions& options_;
  Remarks remarks_;
  std::vector<SpectralRecord> records_;
  std::array<double, 3> units_ = {1, 1, 0.01};  // by Scale
  XyzScale xyz_scale_;
  SpectralMeter meter_;
  UniqueNames names_;
  std::optional<OpenPaint> open_;
  ImportedPaints result_;
};

// The paints that `parse` makes of the name and the whole text of a file, in UTF-8, UTF-16 or Windows-1252.
template <class Parse>
Result<ImportedPaints> import_text(InputFile input, Parse&& parse) {
  constexpr std::size_t kLargestFile = std::size_t{1} << 30;
  bool is_windows_1252 = false;
  std::string text;
  {
    GONIO_ASSIGN(const std::string bytes, input.rest(kLargestFile));
    text = decoded_text(bytes, is_windows_1252);
  }
  GONIO_ASSIGN(ImportedPaints paints, parse(input.name(), std::string_view(text)));
  if (is_windows_1252) paints.warnings.emplace_back("is not UTF-8: read as Windows-1252");
  return Result(std::move(paints));
}

// The values that `text` lists between separators, of which the last may stand behind the last value. The error lacks
// the place, and names the number of the value.
Result<std::vector<double>> listed_values(std::string_view text, char separator);

}  // namespace goniochrome::formats
