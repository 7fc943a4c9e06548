#include "cli/tool.h"
#include "options.h"
#include "run.h"

int main(int argc, char** argv) {
  goniochrome::PaintPickOptions options;
  goniochrome::cli::CommonOptions common;
  const auto spec = goniochrome::paint_pick_spec(options, common);
  return goniochrome::cli::tool_main(argc, argv, spec, common, [&](goniochrome::cli::Session& session) {
    return goniochrome::run_paint_pick(options, session);
  });
}
