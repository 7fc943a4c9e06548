#include "base/heap.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>
#include <memory>
#include <string>

namespace goniochrome::heap_test {
namespace {

constexpr std::size_t kBytes = std::size_t{40} << 20;  // more than glibc ever keeps by itself

// How many pages the kernel had to provide while an array was made, filled and freed.
long faults_of_an_array() {
  const auto faults = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_minflt;
  };
  const long before = faults();
  const auto array = std::make_unique_for_overwrite<char[]>(kBytes);
  for (std::size_t i = 0; i < kBytes; i += 4096) const_cast<volatile char*>(array.get())[i] = 1;
  return faults() - before;
}

bool kernel_takes_large_pages_anyway() {
  std::ifstream file("/sys/kernel/mm/transparent_hugepage/enabled");
  std::string modes;
  std::getline(file, modes);
  return modes.find("[always]") != std::string::npos;
}

TEST(Heap, KeepsTheMemoryOfAnArrayForTheNext) {
#if defined(__SANITIZE_ADDRESS__) || !defined(__GLIBC__)
  GTEST_SKIP() << "this allocator is not glibc's";
#endif
  faults_of_an_array();
  if (!kernel_takes_large_pages_anyway()) {
    EXPECT_GT(faults_of_an_array(), 5000);  // the control: 10240 pages of 4 KB
  }
  keep_freed_memory();
  faults_of_an_array();
  EXPECT_LT(faults_of_an_array(), 100);
}

}  // namespace
}  // namespace goniochrome::heap_test
