// The formats of paint-convert: those that the library reads and measured BRDFs as sources, and a table of sinks in
// formats.cpp.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/file.h"
#include "base/json.h"
#include "base/result.h"
#include "formats/csv.h"
#include "formats/imported.h"
#include "formats/paint_source.h"
#include "paint_stream.h"

namespace goniochrome::tool {

// Data that a source may need.
struct SourceSetup {
  formats::ImportOptions import;
  std::vector<paint::Geometry> geometries;  // where to read a measured BRDF; none: at both sets of the industry
  double aperture_deg = 0;
};

class PaintSink {
 public:
  virtual ~PaintSink() = default;
  // `from_curve` are the geometries of the rows that come from the curve of the paint.
  virtual Result<void> write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve) = 0;
  // Puts the file in place.
  virtual Result<void> finish() = 0;
  // Warnings about data that the format did not allow.
  virtual std::vector<std::string> warnings() const { return {}; }
};

// A writer with write() and finish() as a sink.
template <class Writer>
class SinkOf : public PaintSink {
 public:
  explicit SinkOf(Writer writer) : writer_(std::move(writer)) {}
  Result<void> write(const paint::Paint& paint, const std::vector<paint::Geometry>& from_curve) override {
    if constexpr (requires { writer_.write(paint, from_curve); })
      return writer_.write(paint, from_curve);
    else
      return writer_.write(paint);
  }
  Result<void> finish() override { return writer_.finish(); }
  std::vector<std::string> warnings() const override {
    if constexpr (requires { writer_.warnings(); })
      return writer_.warnings();
    else
      return {};
  }

 private:
  Writer writer_;
};

// Data that a sink needs to begin.
struct SinkSetup {
  Prolog prolog;
  formats::CsvLayout layout;
  std::string creator, command, created;  // tool and version, command line, date and time
  bool cxf_compat = false;                // one object per angle
};

// The parts of a paint that an output format can hold.
struct OutputFormat {
  std::string name, title;
  bool only_rows;    // only geometries and Lab, under a viewing condition
  bool is_wide;      // needs its geometries before the first paint
  bool has_spectra;  // a table has them in its optional columns
  bool has_gloss;    // also gloss, class, code and instrument, whatever --columns says
  Result<std::unique_ptr<PaintSink>> (*begin)(OutputFile file, const SinkSetup& setup);
};

// The words that --from and --to take.
std::vector<std::string> input_format_names();
std::vector<std::string> output_format_names();

// Opens FILE, or FILE#NAMES for some of its paints; "auto" finds the format from the first bytes. Error: the file, and
// the formats there are.
Result<formats::PaintSourcePointer> open_source(const std::string& reference, const std::string& format,
                                                const SourceSetup& setup);

// The output format of that name; "auto" goes by the ending of `path`, and is paint XML for standard output. Error: the
// path and what to do.
Result<const OutputFormat*> output_format(const std::string& path, const std::string& format);

}  // namespace goniochrome::tool
