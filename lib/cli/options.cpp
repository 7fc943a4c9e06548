#include "cli/options.h"

namespace goniochrome::cli {

void add_common_options(ToolSpec& spec, CommonOptions& common, const std::vector<Common>& which) {
  for (const Common option : which) switch (option) {
      case Common::kExplain:
        spec.options.push_back({.name = "explain",
                                .help = "say beforehand what will be done, what is left out and why, and what it costs",
                                .target = &common.explain});
        break;
      case Common::kTolerance:
        spec.options.push_back({.name = "tolerance",
                                .value = "X",
                                .help = "largest error that is allowed",
                                .target = &common.tolerance,
                                .low = 0});
        break;
      case Common::kTimeLimit:
        spec.options.push_back(
            {.name = "time-limit",
             .value = "S",
             .help = "stop after S seconds with the best result so far, exit status 4; 0 is no limit",
             .target = &common.time_limit_s,
             .low = 0});
        break;
      case Common::kSeed:
        spec.options.push_back(
            {.name = "seed", .value = "N", .help = "start of every random choice", .target = &common.seed, .low = 0});
        break;
    }
  spec.options.push_back({.name = "report",
                          .value = "FILE",
                          .help = "write figures of the run as one JSON object",
                          .target = &common.report});
  spec.options.push_back({.name = "threads",
                          .value = "N",
                          .help = "use N threads, 0 for one a core; results do not depend on it",
                          .target = &common.threads,
                          .low = 0,
                          .high = 1024});
  spec.options.push_back({.name = "quiet", .letter = 'q', .help = "print nothing but errors", .target = &common.quiet});
}

}  // namespace goniochrome::cli
