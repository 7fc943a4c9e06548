// Pictures of many paints: files of their own, contact sheets, or frames on standard output.
#pragma once

#include <optional>

#include "display/display.h"
#include "request.h"
#include "stage.h"
#include "tool.h"

namespace goniochrome::tool {

// The meaning of "auto" in --effects of a stream: nothing is left out for a paint, and no rays are traced.
inline render::EffectWords stream_effects() {
  return {render::Start::kAll, {{"rays", false}}};
}

// True if a picture of each paint is asked for: braces in --output, --sheet, or --to.
bool is_stream(const Options& options);

// The options as a stream takes them. Error (usage): what makes no sense for several paints.
Result<Options> stream_options(const Options& options);

// Draws all paints of --paint. `stage` was set by stream_options(). A paint that fails is told, and the others are
// drawn: the verdict is then negative. Error: none could be drawn; a file that cannot be written.
Result<cli::Verdict> draw_stream(const Options& options, const Request& request, Stage& stage,
                                 const std::optional<display::Display>& display, cli::Session& session);

}  // namespace goniochrome::tool
