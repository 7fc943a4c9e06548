#include "base/heap.h"

#include <cstdlib>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace goniochrome {

// The heap grows in steps and does not shrink. Large pages (MADV_HUGEPAGE) were tried as well: where the kernel has
// them at hand they take 36,000 page faults down to 600, but on a machine whose memory was in use it spent up to 0.2 s
// on making room for them, which is half of a run of prefilter-envmap.
void keep_freed_memory() {
#ifdef __GLIBC__
  constexpr int kNever = 1 << 30, kStep = 1 << 26;  // bytes
  mallopt(M_MMAP_THRESHOLD, kNever), mallopt(M_TRIM_THRESHOLD, kNever), mallopt(M_TOP_PAD, kStep);
#endif
}

}  // namespace goniochrome
