// sketch-fit: from an edited picture of a painted mesh back to the paint.
#include "cli/tool.h"
#include "options.h"
#include "run.h"

int main(int argc, char** argv) {
  using namespace goniochrome;
  using namespace goniochrome::tool;
  Options options;
  const cli::ToolSpec spec = tool_spec(options);
  return cli::tool_main(argc, argv, spec, options.common, [&](cli::Session& s) { return run(options, s); });
}
