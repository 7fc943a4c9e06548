#include "base/large_pages.h"

#include <sys/mman.h>

#include <cstdint>

namespace goniochrome {

void prefer_large_pages([[maybe_unused]] void* begin, std::size_t bytes) {
  constexpr std::size_t kPage = std::size_t{1} << 21, kFewest = 2 * kPage;
  if (bytes < kFewest) return;
#ifdef MADV_HUGEPAGE
  // The whole pages in the array; its ends, which may share theirs with others, stay as they are.
  const auto address = reinterpret_cast<std::uintptr_t>(begin);
  const std::uintptr_t first = (address + kPage - 1) / kPage * kPage, last = (address + bytes) / kPage * kPage;
  if (first < last) madvise(static_cast<char*>(begin) + (first - address), last - first, MADV_HUGEPAGE);
#endif
}

}  // namespace goniochrome
