// paint-stats: what can be said of a paint in one number each, and the paints of which it holds.
#include "cli/tool.h"
#include "options.h"
#include "run.h"

int main(int argc, char** argv) {
  using namespace goniochrome;
  PaintStatsOptions options;
  cli::CommonOptions common;
  const cli::ToolSpec spec = paint_stats_spec(options, common);
  return cli::tool_main(argc, argv, spec, common, [&](cli::Session& session) { return run(options, session); });
}
