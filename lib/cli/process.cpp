#include "cli/process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>

namespace goniochrome::cli {

namespace {

constexpr std::size_t kLargeBlock = std::size_t{512} << 20;
constexpr int kInputStatus = 3;

// Written by a signal handler, which may not allocate.
char out_of_memory[256];
std::size_t out_of_memory_size = 0;

[[maybe_unused]] void explain_crash(int number) {
  if (is_short_of_memory()) {
    if (write(STDERR_FILENO, out_of_memory, out_of_memory_size) < 0) {
      // The exit status still tells.
    }
    _exit(kInputStatus);
  }
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

void open_closed_descriptors() {
  for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (fcntl(descriptor, F_GETFD) >= 0 || errno != EBADF) continue;
    // The lowest free number is this one. The wrong direction makes every read or write of it an error.
    if (open("/dev/null", descriptor == STDOUT_FILENO ? O_RDONLY : O_WRONLY) < 0) return;
  }
}

bool is_short_of_memory() {
  void* block = mmap(nullptr, kLargeBlock, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (block == MAP_FAILED) return true;
  munmap(block, kLargeBlock);
  return false;
}

void expect_memory_to_run_out(const std::string& tool) {
  const std::string text = tool + ": out of memory: a library that it uses could not go on\n";
  out_of_memory_size = std::min(text.size(), sizeof out_of_memory);
  std::memcpy(out_of_memory, text.data(), out_of_memory_size);
#if !defined(__SANITIZE_ADDRESS__)
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGILL, SIGFPE, SIGTRAP}) std::signal(number, explain_crash);
#endif
}

}  // namespace goniochrome::cli
