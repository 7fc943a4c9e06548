#include "cli/process.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdio>
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

void catch_crashes() {
#if !defined(__SANITIZE_ADDRESS__)
  for (const int number : {SIGSEGV, SIGBUS, SIGABRT, SIGILL, SIGFPE, SIGTRAP}) std::signal(number, explain_crash);
#endif
}

// Runs before the constructors of the program's own global objects. With very little memory one of them is the first to
// get none, and then there is none for the exception either, so that the C++ library aborts.
[[gnu::constructor(101)]] void expect_no_memory_at_start() {
  const int size = std::snprintf(out_of_memory, sizeof out_of_memory,
                                 "%s: out of memory: there is too little to start\n", program_invocation_short_name);
  out_of_memory_size = std::min(sizeof out_of_memory - 1, static_cast<std::size_t>(std::max(size, 0)));
  catch_crashes();
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
  catch_crashes();
}

}  // namespace goniochrome::cli
