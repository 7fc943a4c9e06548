// The main() of every tool. CMake compiles it into each of them, beside that tool's own tool.h.
#include "tool.h"

int main(int argc, char** argv) {
  using namespace goniochrome;
  tool::Options options;
  const cli::ToolSpec spec = tool::tool_spec(options);
  return cli::tool_main(argc, argv, spec, options.common,
                        [&](cli::Session& session) { return tool::run(options, session); });
}
