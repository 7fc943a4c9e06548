// The formats of other programs as sources and sinks of paint-convert.
#pragma once

#include <memory>
#include <string_view>

#include "formats.h"
#include "formats/importers.h"

namespace goniochrome::tool {

Result<std::unique_ptr<PaintSource>> open_cxf(InputFile input, const SourceSetup& setup);
Result<std::unique_ptr<PaintSource>> open_imported(InputFile input, const SourceSetup& setup,
                                                   const formats::Importer& importer);
Result<std::unique_ptr<PaintSource>> open_measured(InputFile input, const SourceSetup& setup);

Result<std::unique_ptr<PaintSink>> begin_cxf(OutputFile file, const SinkSetup& setup);
Result<std::unique_ptr<PaintSink>> begin_cgats(OutputFile file, const SinkSetup& setup);

}  // namespace goniochrome::tool
