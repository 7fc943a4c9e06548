// The parts of `base` that ask an operating system for something, as a page in a browser has them: one thread, and
// output files that are texts in memory. CMake compiles this file in the place of base/parallel.cpp and base/file.cpp.
#include "platform.h"

#include <algorithm>
#include <cstdlib>

#include "base/file.h"
#include "base/parallel.h"

namespace goniochrome {

void set_threads(int) {}

int threads() {
  return 1;
}

void parallel_for(std::size_t n, std::size_t chunk,
                  const std::function<void(std::size_t begin, std::size_t end)>& body) {
  chunk = std::max<std::size_t>(chunk, 1);
  for (std::size_t begin = 0; begin < n; begin += chunk) body(begin, std::min(n, begin + chunk));
}

namespace studio {

std::string& written_text() {
  static auto& text = *new std::string;
  return text;
}

}  // namespace studio

Result<OutputFile> OutputFile::create(const std::string&) {
  return OutputFile("", "", nullptr);
}
OutputFile::OutputFile(OutputFile&&) noexcept = default;
OutputFile::~OutputFile() = default;

Result<void> OutputFile::write(std::string_view bytes) {
  studio::written_text() += bytes;
  return {};
}
Result<void> OutputFile::flush() {
  return {};
}
Result<void> OutputFile::commit() {
  return {};
}
std::string OutputFile::scratch_path() const {
  return "";
}

}  // namespace goniochrome

// There is one thread, which lives as long as the page: what would be destroyed at its end stays.
extern "C" int __cxa_thread_atexit(void (*)(void*), void*, void*) {
  return 0;
}

// The library is compiled without exceptions, but for one source that throws where an index on a disk is damaged. There
// is no disk here.
extern "C" {
void* __cxa_allocate_exception(std::size_t) {
  std::abort();
}
[[noreturn]] void __cxa_throw(void*, void*, void (*)(void*)) {
  std::abort();
}
}
