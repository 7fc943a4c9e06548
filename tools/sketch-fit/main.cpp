#include "cli/tool.h"
#include "options.h"
#include "run.h"

int main(int argc, char** argv) {
  goniochrome::SketchFitOptions options;
  goniochrome::cli::CommonOptions common;
  const auto spec = goniochrome::sketch_fit_spec(options, common);
  return goniochrome::cli::tool_main(argc, argv, spec, common, [&](goniochrome::cli::Session& session) {
    return goniochrome::run_sketch_fit(options, session);
  });
}
