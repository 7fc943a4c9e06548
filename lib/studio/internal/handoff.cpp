#include "studio/internal/handoff.h"

#include "formats/csv.h"
#include "paint/curve.h"

namespace goniochrome::studio {

Result<void> write_xml(const std::string& file, const paint::Paint& paint, const formats::Processing& step) {
  GONIO_ASSIGN(OutputFile output, OutputFile::create(file));
  GONIO_ASSIGN(formats::PaintWriter writer, formats::PaintWriter::begin(std::move(output), {step}));
  GONIO_TRY(writer.write(paint));
  return writer.finish();
}

Result<void> write_csv(const std::string& file, paint::Paint paint) {
  if (!paint.measurement && paint.appearance)
    paint.measurement = paint::Measurement{{}, "", paint::rows_of(*paint.appearance)};
  GONIO_ASSIGN(OutputFile output, OutputFile::create(file));
  formats::CsvLayout layout;
  layout.all_columns = true;
  GONIO_ASSIGN(formats::CsvPaintWriter writer, formats::CsvPaintWriter::begin(std::move(output), layout));
  GONIO_TRY(writer.write(paint));
  return writer.finish();
}

}  // namespace goniochrome::studio
