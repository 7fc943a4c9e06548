#include "studio/internal/handoff.h"

#include "formats/csv.h"
#include "formats/cxf.h"
#include "paint/curve.h"

namespace goniochrome::studio {

Result<void> write_xml(const std::string& file, const paint::Paint& paint, const formats::Processing& step) {
  GONIO_ASSIGN(OutputFile output, OutputFile::create(file));
  GONIO_ASSIGN(formats::PaintWriter writer, formats::PaintWriter::begin(std::move(output), {step}));
  GONIO_TRY(writer.write(paint));
  return writer.finish();
}

namespace {

// The rows of the curve, for a paint that has no others. Returns their geometries.
std::vector<paint::Geometry> state_rows(paint::Paint& paint) {
  std::vector<paint::Geometry> geometries;
  if (paint.measurement || !paint.appearance) return geometries;
  paint.measurement = paint::Measurement{{}, "", paint::rows_of(*paint.appearance)};
  for (const paint::LabReading& row : paint.measurement->rows) geometries.push_back(row.geometry);
  return geometries;
}

}  // namespace

Result<void> write_csv(const std::string& file, paint::Paint paint) {
  state_rows(paint);
  GONIO_ASSIGN(OutputFile output, OutputFile::create(file));
  formats::CsvLayout layout;
  layout.all_columns = true;
  GONIO_ASSIGN(formats::CsvPaintWriter writer, formats::CsvPaintWriter::begin(std::move(output), layout));
  GONIO_TRY(writer.write(paint));
  return writer.finish();
}

Result<void> write_cxf(const std::string& file, paint::Paint paint, const formats::Processing& step,
                       const std::string& created) {
  const std::vector<paint::Geometry> from_curve = state_rows(paint);
  GONIO_ASSIGN(OutputFile output, OutputFile::create(file));
  const formats::CxfWriter::Info info = {step.tool + " " + step.version, step.command, created};
  GONIO_ASSIGN(formats::CxfWriter writer, formats::CxfWriter::begin(std::move(output), info));
  GONIO_TRY(writer.write(paint, from_curve));
  return writer.finish();
}

}  // namespace goniochrome::studio
