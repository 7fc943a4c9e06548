#include "studio/internal/handoff.h"

#include "formats/csv.h"
#include "formats/xml.h"
#include "paint/curve.h"

namespace goniochrome::studio {

Result<void> write_xml(const std::string& file, const paint::Paint& paint, const std::string& command) {
  GONIO_ASSIGN(OutputFile output, OutputFile::create(file));
  std::vector<formats::Processing> history;
  if (!command.empty()) history.push_back({"paint-studio", "1", command});
  GONIO_ASSIGN(formats::PaintWriter writer, formats::PaintWriter::begin(std::move(output), history));
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
