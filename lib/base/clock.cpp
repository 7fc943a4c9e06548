#include "base/clock.h"

#include <sys/resource.h>

namespace goniochrome {

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace goniochrome
