#include "cli/thread_start.h"

#include <dlfcn.h>
#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "base/child.h"
#include "cli/process.h"

// GCC tells by macros that a sanitizer is there, and Clang by questions.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define GONIO_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer)
#define GONIO_SANITIZED 1
#endif
#endif

namespace goniochrome::cli {

namespace {

constexpr int kNoThreadStatus = 3;

// A message that is written where nothing may be allocated.
struct Message {
  void set(const std::string& text) { std::memcpy(letters, text.data(), size = std::min(text.size(), sizeof letters)); }
  void print() const {
    if (write(STDERR_FILENO, letters, size) < 0) {
      // The exit status still tells.
    }
  }

  char letters[512];
  std::size_t size = 0;
};
Message no_thread, no_memory;
std::atomic<bool> expected = false;

// Several threads may ask for others at once. The first one speaks.
[[maybe_unused]] void end_without_thread() {
  if (!expected.exchange(false)) return;
  end_child_without_thread();
  (is_short_of_memory() ? no_memory : no_thread).print();
  _exit(kNoThreadStatus);
}

}  // namespace

void expect_threads_to_run_out(const std::string& tool) {
  no_thread.set(tool + ": " + kNoThread + "; --threads 1 needs the fewest threads\n");
  no_memory.set(tool + ": out of memory: there is none for a thread; --threads 1 needs the fewest threads\n");
  expected = true;
}

}  // namespace goniochrome::cli

#if !defined(GONIO_SANITIZED)
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*),
                              void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto next = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (!next) return ENOSYS;
  const int failure = next(thread, attributes, work, argument);
  if (failure == EAGAIN) goniochrome::cli::end_without_thread();
  return failure;
}
#endif
