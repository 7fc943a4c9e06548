// Measured BRDFs as sources of paint-convert, and the formats of other programs as its sinks.
#pragma once

#include <memory>
#include <string_view>

#include "formats.h"

namespace goniochrome::tool {

Result<formats::PaintSourcePointer> open_measured(InputFile input, const SourceSetup& setup);

Result<std::unique_ptr<PaintSink>> begin_cxf(OutputFile file, const SinkSetup& setup);
Result<std::unique_ptr<PaintSink>> begin_cgats(OutputFile file, const SinkSetup& setup);

}  // namespace goniochrome::tool
