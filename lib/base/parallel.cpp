#include "base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

#ifdef __SANITIZE_ADDRESS__
// Leaks that the address sanitizer shall not report: Mesa keeps its window buffers and its compiled code until the
// process ends, and the C library keeps the catalogs of a locale. The check keeps silent about them, because tests
// compare what tools print. This stands here because every program uses this file.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libOSMesa.so\nleak:libLLVM\nleak:argz_add_sep";
}
extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";
}
#endif

namespace goniochrome {

namespace {
// It is never destroyed: the end of the limit would start threads while the program ends.
std::unique_ptr<tbb::global_control>& limit() {
  static auto& control = *new std::unique_ptr<tbb::global_control>;
  return control;
}
}  // namespace

void set_threads(int threads) {
  limit().reset();
  // More threads than cores are allowed: that is how tests show that results do not depend on the number.
  if (threads > 0)
    limit() = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                    static_cast<std::size_t>(threads));
}

int threads() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

void parallel_for(std::size_t n, std::size_t chunk,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
  chunk = std::max<std::size_t>(chunk, 1);
  const std::size_t chunks = (n + chunk - 1) / chunk;
  const auto run = [&](std::size_t i) { body(i * chunk, std::min(n, (i + 1) * chunk)); };
  if (chunks <= 1 || threads() == 1) {
    for (std::size_t i = 0; i < chunks; ++i) run(i);
    return;
  }
  tbb::parallel_for(std::size_t{0}, chunks, run);
}

void with_no_other_work(const std::function<void()>& work) {
  tbb::this_task_arena::isolate(work);
}

}  // namespace goniochrome
