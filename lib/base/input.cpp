#include "base/input.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace goniochrome {

namespace {

constexpr std::size_t kPeek = 1 << 16;

}  // namespace

Result<InputFile> InputFile::open(const std::string& path) {
  if (path.empty() || path == "-") return InputFile("standard input", STDIN_FILENO);
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return input_error("{}: cannot be read: {}", path, std::strerror(errno));
  InputFile file(path, descriptor);
  struct stat status;
  if (fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode))
    return input_error("{}: is a folder: name a file", path);
  return file;
}

InputFile::InputFile(InputFile&& other) noexcept
    : name_(std::move(other.name_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      ahead_(std::move(other.ahead_)) {}

InputFile::~InputFile() {
  if (descriptor_ > STDIN_FILENO) close(descriptor_);
}

Result<std::string_view> InputFile::peek() {
  if (ahead_.empty()) {
    std::string first;
    GONIO_ASSIGN([[maybe_unused]] const auto count, read(first, kPeek));
    ahead_ = std::move(first);
  }
  return std::string_view(ahead_);
}

Result<std::size_t> InputFile::read(std::string& buffer, std::size_t most) {
  if (!ahead_.empty()) {
    const std::size_t count = std::min(most, ahead_.size());
    buffer.append(ahead_, 0, count);
    ahead_.erase(0, count);
    return count;
  }
  const std::size_t size = buffer.size();
  buffer.resize(size + most);
  ssize_t count = 0;
  do count = ::read(descriptor_, buffer.data() + size, most);
  while (count < 0 && errno == EINTR);
  buffer.resize(size + static_cast<std::size_t>(count < 0 ? 0 : count));
  if (count < 0) return input_error("{}: cannot be read: {}", name_, std::strerror(errno));
  return static_cast<std::size_t>(count);
}

}  // namespace goniochrome
