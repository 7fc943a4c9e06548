#include "cli/tool.h"
#include "options.h"
#include "run.h"

int main(int argc, char** argv) {
  using namespace goniochrome;
  RenderOptions options;
  cli::CommonOptions common;
  const cli::ToolSpec spec = render_spec(options, common);
  return cli::tool_main(argc, argv, spec, common, [&](cli::Session& session) { return run(options, session); });
}
