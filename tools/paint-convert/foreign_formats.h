// The formats of other programs as sources and sinks of paint-convert: CxF3, CGATS.17,
// workbooks and measured BRDFs.
#pragma once

#include <memory>
#include <string_view>

#include "formats.h"

namespace goniochrome::tool {

Result<std::unique_ptr<PaintSource>> open_cxf(InputFile input, const SourceSetup& setup);
Result<std::unique_ptr<PaintSource>> open_cgats(InputFile input, const SourceSetup& setup);
Result<std::unique_ptr<PaintSource>> open_workbook(InputFile input, const SourceSetup& setup);
Result<std::unique_ptr<PaintSource>> open_measured(InputFile input, const SourceSetup& setup);

Result<std::unique_ptr<PaintSink>> begin_cxf(OutputFile file, const SinkSetup& setup);
Result<std::unique_ptr<PaintSink>> begin_cgats(OutputFile file, const SinkSetup& setup);

}  // namespace goniochrome::tool
