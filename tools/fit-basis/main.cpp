#include "cli/tool.h"
#include "options.h"
#include "run.h"

int main(int argc, char** argv) {
  goniochrome::Options options;
  const auto spec = goniochrome::tool_spec(options);
  return goniochrome::cli::tool_main(argc, argv, spec, options.common, [&](goniochrome::cli::Session& session) {
    return goniochrome::run(options, session);
  });
}
