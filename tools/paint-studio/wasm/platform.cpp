// The parts of `base` that ask an operating system for something, as a page in a browser has them: one thread, no other
// processes, and files that are texts in memory. CMake compiles this file in the place of parallel.cpp, file.cpp,
// paths.cpp and child.cpp of `base`.
#include "platform.h"

#include <algorithm>
#include <cstdlib>

#include "base/child.h"
#include "base/clock.h"
#include "base/file.h"
#include "base/large_pages.h"
#include "base/parallel.h"
#include "base/paths.h"

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

void prefer_large_pages(void*, std::size_t) {}

namespace studio {

std::string& written_text() {
  static auto& text = *new std::string;
  return text;
}

std::map<std::string, std::string>& given_files() {
  static auto& files = *new std::map<std::string, std::string>;
  return files;
}

}  // namespace studio

namespace {

const std::string* given_file(std::string_view path) {
  if (path.starts_with("./")) path.remove_prefix(2);
  const auto found = studio::given_files().find(std::string(path));
  return found == studio::given_files().end() ? nullptr : &found->second;
}

}  // namespace

bool is_there(const std::string& path) {
  return given_file(path) != nullptr;
}
bool is_plain_file(const std::string& path) {
  return is_there(path);
}

Result<std::string> file_content(const std::string& path) {
  const std::string* content = given_file(path);
  if (!content) return input_error("{}: was not opened: open it together with the file that names it", path);
  return *content;
}

// All bytes are ahead, and the descriptor counts those that were read.
Result<InputFile> InputFile::open(const std::string& path) {
  GONIO_ASSIGN(std::string content, file_content(path));
  InputFile file(path, 0);
  file.ahead_ = std::move(content);
  return Result(std::move(file));
}
InputFile::InputFile(InputFile&&) noexcept = default;
InputFile::~InputFile() = default;

Result<std::string_view> InputFile::peek() {
  return std::string_view(ahead_).substr(static_cast<std::size_t>(descriptor_));
}
Result<std::size_t> InputFile::read(std::string& buffer, std::size_t most) {
  const std::string_view bytes = std::string_view(ahead_).substr(static_cast<std::size_t>(descriptor_), most);
  buffer += bytes;
  descriptor_ += static_cast<int>(bytes.size());
  return bytes.size();
}
Result<InputFile> InputFile::second_reading() {
  InputFile file(name_, descriptor_);
  file.ahead_ = ahead_;
  return Result(std::move(file));
}
Result<std::string> InputFile::rest(std::size_t most) {
  std::string bytes = ahead_.substr(static_cast<std::size_t>(descriptor_));
  if (bytes.size() > most) return input_error("{}: is larger than {} bytes: split it", name_, most);
  return bytes;
}

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

// The work is done here: what a damaged file does to a library ends the module alone.
Result<ChildBytes> made_by_child(const std::string&, const ChildLimits&,
                                 const std::function<Result<void>(ChildOutput&)>& work) {
  studio::written_text().clear();
  ChildOutput output(0);
  GONIO_TRY(work(output));
  const std::string& text = studio::written_text();
  char* bytes = static_cast<char*>(std::malloc(std::max<std::size_t>(text.size(), 1)));
  std::copy(text.begin(), text.end(), bytes);
  ChildBytes made(bytes, text.size());
  studio::written_text().clear();
  return Result(std::move(made));
}
void ChildOutput::write(const void* bytes, std::size_t size) {
  studio::written_text().append(static_cast<const char*>(bytes), size);
}
ChildBytes::ChildBytes(ChildBytes&& other) noexcept
    : bytes_(std::exchange(other.bytes_, nullptr)), size_(other.size_) {}
ChildBytes::~ChildBytes() {
  std::free(const_cast<char*>(bytes_));
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
