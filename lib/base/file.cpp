#include "base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

namespace goniochrome {

namespace {

std::string reason() {
  return std::strerror(errno);
}

std::string folder_of(const std::string& path) {
  const auto parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

// The mode a newly created file would get: 0666 less the umask.
mode_t creation_mode() {
  const mode_t mask = umask(0);
  umask(mask);
  return 0666 & ~mask;
}

}  // namespace

Result<std::string> file_content(const std::string& path) {
  std::FILE* stream = path == "-" ? stdin : std::fopen(path.c_str(), "rb");
  if (!stream) return input_error("{}: cannot be read: {}", path, reason());
  std::string content;
  char buffer[1 << 16];
  std::size_t count = 0;
  while ((count = std::fread(buffer, 1, sizeof buffer, stream)) > 0) content.append(buffer, count);
  const bool failed = std::ferror(stream) != 0;
  const std::string why = failed ? reason() : "";
  if (stream != stdin) std::fclose(stream);
  if (failed) return input_error("{}: cannot be read: {}", path, why);
  return content;
}

// An unnamed file (O_TMPFILE) is gone with the process, however it ends; only commit() gives it a name. File systems
// without unnamed files get a dot file, removed by the destructor.
Result<OutputFile> OutputFile::create(const std::string& path) {
  if (path.empty() || path == "-") return OutputFile("", "", stdout);
  if (std::filesystem::is_directory(path)) return input_error("{}: is a folder: name a file", path);
  const std::string folder = folder_of(path);
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path)) {
    // A device or a named pipe is written in place.
    std::FILE* stream = std::fopen(path.c_str(), "wb");
    if (!stream) return input_error("{}: cannot be written: {}", path, reason());
    return OutputFile("", "", stream);
  }
  int fd = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  std::string scratch;
  if (fd < 0 && (errno == EOPNOTSUPP || errno == EISDIR)) {
    scratch = fmt::format("{}/.{}.{}.tmp", folder, std::filesystem::path(path).filename().string(), getpid());
    fd = open(scratch.c_str(), O_CREAT | O_TRUNC | O_RDWR | O_CLOEXEC, 0600);
  }
  if (fd < 0) return input_error("{}: cannot be written: {}", path, reason());
  if (fchmod(fd, creation_mode()) != 0) {
    // Some file systems have no modes; the file is still good.
  }
  return OutputFile(path, scratch, fdopen(fd, "w+b"));
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      scratch_(std::move(other.scratch_)),
      stream_(std::exchange(other.stream_, nullptr)) {}

OutputFile::~OutputFile() {
  if (!stream_ || stream_ == stdout) return;
  std::fclose(stream_);
  if (!scratch_.empty()) unlink(scratch_.c_str());
}

Result<void> OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) == bytes.size()) return {};
  return input_error("{}: cannot be written: {}", path_.empty() ? "standard output" : path_, reason());
}

Result<void> OutputFile::flush() {
  if (std::fflush(stream_) == 0) return {};
  return input_error("{}: cannot be written: {}", path_.empty() ? "standard output" : path_, reason());
}

Result<void> OutputFile::commit() {
  GONIO_TRY(flush());
  if (path_.empty()) return {};
  std::string named = scratch_;
  if (named.empty()) {
    named = fmt::format("{}/.{}.{}.tmp", folder_of(path_), std::filesystem::path(path_).filename().string(), getpid());
    unlink(named.c_str());
    if (linkat(AT_FDCWD, scratch_path().c_str(), AT_FDCWD, named.c_str(), AT_SYMLINK_FOLLOW) != 0)
      return input_error("{}: cannot be written: {}", path_, reason());
  }
  if (std::rename(named.c_str(), path_.c_str()) != 0) {
    const std::string why = reason();
    unlink(named.c_str());
    return input_error("{}: cannot be written: {}", path_, why);
  }
  scratch_.clear();
  return {};
}

std::string OutputFile::scratch_path() const {
  if (path_.empty()) return "";
  return scratch_.empty() ? fmt::format("/proc/self/fd/{}", fileno(stream_)) : scratch_;
}

Result<void> write_file(const std::string& path, std::string_view bytes) {
  GONIO_ASSIGN(auto file, OutputFile::create(path));
  GONIO_TRY(file.write(bytes));
  return file.commit();
}

}  // namespace goniochrome
