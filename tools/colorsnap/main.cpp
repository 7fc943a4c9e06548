// colorsnap: the paints of a library nearest to a paint.
#include "cli/tool.h"
#include "options.h"
#include "run.h"

int main(int argc, char** argv) {
  using namespace goniochrome;
  ColorsnapOptions options;
  cli::CommonOptions common;
  const cli::ToolSpec spec = colorsnap_spec(options, common);
  return cli::tool_main(argc, argv, spec, common, [&](cli::Session& session) { return run(options, session); });
}
