#include "base/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <functional>
#include <optional>
#include <utility>

#include "base/paths.h"
#include "base/text.h"

namespace goniochrome {

namespace {

constexpr std::size_t kPeek = 1 << 16, kChunk = 1 << 20;
constexpr int kMostLinks = 40;  // as the system has it

std::string reason() {
  return std::strerror(errno);
}

Error cannot_be_read(const std::string& name) {
  return input_error("{}: cannot be read: {}", name, reason());
}
Error cannot_be_written(const std::string& name) {
  return input_error("{}: cannot be written: {}", name, reason());
}
Error is_a_folder(const std::string& name) {
  return input_error("{}: is a folder: name a file", name);
}

std::string folder_of(const std::string& path) {
  const auto parent = std::filesystem::path(path).parent_path();
  return parent.empty() ? "." : parent.string();
}

// A name in the same folder for the file that is being written. It does not grow with the name of that file, which may
// be as long as names can be.
std::string scratch_name(const std::string& path) {
  static std::atomic<unsigned> count = 0;
  timespec now = {};
  clock_gettime(CLOCK_REALTIME, &now);
  return fmt::format("{}/.goniochrome-{}-{}-{}.tmp", folder_of(path), getpid(), ++count, now.tv_nsec);
}

std::string path_of_descriptor(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

// The number N where `path` leads to /proc/self/fd/N or the like, as /dev/stdout does. Such a name stands for an open
// file, which must not be replaced by another.
std::optional<int> named_descriptor(const std::string& path) {
  std::string text = path;
  for (int links = 0; links < kMostLinks; ++links) {
    for (const std::string& folder :
         {std::string("/dev/fd/"), std::string("/proc/self/fd/"), fmt::format("/proc/{}/fd/", getpid())})
      if (text.starts_with(folder)) {
        const auto number = parse_integer(std::string_view(text).substr(folder.size()));
        if (number && *number >= 0 && *number < 1 << 20) return static_cast<int>(*number);
      }
    const auto target = link_target(text);
    if (!target) return std::nullopt;
    text = target->starts_with('/') ? *target : folder_of(text) + "/" + *target;
  }
  return std::nullopt;
}

// The file that a link leads to, be it there or not. Error: the links go round in a circle.
Result<std::string> file_behind(const std::string& path) {
  std::string file = path;
  for (int links = 0; links < kMostLinks; ++links) {
    const auto target = link_target(file);
    if (!target) return file;
    file = target->starts_with('/') ? *target : folder_of(file) + "/" + *target;
  }
  errno = ELOOP;
  return cannot_be_written(path);
}

// Gives the new file the mode of the old one, and its owner where that is allowed.
void take_over(int descriptor, const struct stat& old) {
  if (fchown(descriptor, old.st_uid, old.st_gid) != 0 && fchown(descriptor, static_cast<uid_t>(-1), old.st_gid) != 0) {
    // Only the administrator may give files away.
  }
  if (fchmod(descriptor, old.st_mode & 0777) != 0) {
    // Some file systems have no modes; the file is still good.
  }
}

// The mode a newly created file would get: 0666 less the umask. It is asked for once, since asking sets it: two threads
// that ask at once can leave the process without one.
mode_t creation_mode() {
  static const mode_t mask = [] {
    const mode_t of_process = umask(0);
    umask(of_process);
    return of_process;
  }();
  return 0666 & ~mask;
}

}  // namespace

Result<InputFile> InputFile::open(const std::string& path) {
  if (path.empty() || path == "-") return InputFile("standard input", STDIN_FILENO);
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return cannot_be_read(path);
  InputFile file(path, descriptor);
  struct stat status;
  if (fstat(descriptor, &status) == 0 && S_ISDIR(status.st_mode)) return is_a_folder(path);
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
  if (count < 0) return cannot_be_read(name_);
  return static_cast<std::size_t>(count);
}

Result<InputFile> InputFile::second_reading() {
  struct stat status;
  off_t begin = 0;
  if (fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode)) {
    begin = lseek(descriptor_, 0, SEEK_CUR) - static_cast<off_t>(ahead_.size());
  } else {
    const char* folder = std::getenv("TMPDIR");
    const std::string path = folder && *folder ? folder : "/tmp";
    InputFile kept(name_, ::open(path.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
    if (kept.descriptor_ < 0)
      return input_error("{}: cannot be kept in {} to be read twice: {}", name_, path, reason());
    for (std::string chunk;; chunk.clear()) {
      GONIO_ASSIGN(const std::size_t count, read(chunk, kChunk));
      if (count == 0) break;
      for (std::string_view left = chunk; !left.empty();) {
        const ssize_t written = ::write(kept.descriptor_, left.data(), left.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return input_error("{}: cannot be kept in {} to be read twice: {}", name_, path, reason());
        left.remove_prefix(static_cast<std::size_t>(written));
      }
    }
    if (descriptor_ > STDIN_FILENO) close(descriptor_);
    descriptor_ = std::exchange(kept.descriptor_, -1);
    if (lseek(descriptor_, 0, SEEK_SET) != 0) return cannot_be_read(name_);
  }
  // Opened anew, the file has a position of its own.
  InputFile second(name_, ::open(path_of_descriptor(descriptor_).c_str(), O_RDONLY | O_CLOEXEC));
  if (second.descriptor_ < 0 || lseek(second.descriptor_, begin, SEEK_SET) != begin) return cannot_be_read(name_);
  return second;
}

Result<std::string> InputFile::rest(std::size_t most) {
  std::string content;
  struct stat status;  // the room is taken at once where the size is known
  if (fstat(descriptor_, &status) == 0 && S_ISREG(status.st_mode) && status.st_size > 0)
    content.reserve(std::min(static_cast<std::size_t>(status.st_size), most) + kChunk);
  for (;;) {
    GONIO_ASSIGN(const std::size_t count, read(content, kChunk));
    if (count == 0) return content;
    if (content.size() > most) return input_error("{}: is larger than {} bytes: split it", name_, most);
  }
}

Result<std::string> file_content(const std::string& path) {
  if (path.empty()) return input_error("the name of a file is empty: name a file");
  GONIO_ASSIGN(InputFile file, InputFile::open(path));
  return file.rest(std::string::npos);
}

namespace {

// A stream onto an open file, a device or a pipe, which is written in place.
Result<OutputFile> written_in_place(int descriptor, const std::string& path,
                                    const std::function<OutputFile(std::FILE*)>& made) {
  std::FILE* stream = descriptor < 0 ? nullptr : fdopen(descriptor, "wb");
  if (!stream) return cannot_be_written(path);
  return made(stream);
}

}  // namespace

// An unnamed file (O_TMPFILE) is gone with the process, however it ends; only commit() gives it a name. A file can take
// the place of another only under a name, so who kills the process within commit() may leave the whole new file under a
// hidden name. File systems without unnamed files get a dot file, removed by the destructor, and so do root folders
// without /proc, where an unnamed file cannot get a name.
Result<OutputFile> OutputFile::create(const std::string& path) {
  if (path.empty() || path == "-") return OutputFile("", "", stdout);
  const auto in_place = [](std::FILE* stream) { return OutputFile("", "", stream); };
  if (const auto number = named_descriptor(path))
    return written_in_place(fcntl(*number, F_DUPFD_CLOEXEC, STDERR_FILENO + 1), path, in_place);
  struct stat old;
  const bool there = stat(path.c_str(), &old) == 0;
  if (!there && errno != ENOENT) return cannot_be_written(path);
  if (there && S_ISDIR(old.st_mode)) return is_a_folder(path);
  if (there && !S_ISREG(old.st_mode)) return written_in_place(open(path.c_str(), O_WRONLY | O_CLOEXEC), path, in_place);
  // Another run may have removed the file since.
  if (there && access(path.c_str(), W_OK) != 0 && errno != ENOENT) return cannot_be_written(path);
  GONIO_ASSIGN(const std::string file, file_behind(path));
  int fd = open(folder_of(file).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  bool has_dot_file = fd < 0 && (errno == EOPNOTSUPP || errno == EISDIR);
  if (fd >= 0 && access(path_of_descriptor(fd).c_str(), F_OK) != 0) {
    close(fd);
    has_dot_file = true;
  }
  std::string scratch;
  if (has_dot_file) {
    scratch = scratch_name(file);
    fd = open(scratch.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0600);
  }
  if (fd < 0) return cannot_be_written(path);
  if (there) {
    take_over(fd, old);
  } else if (fchmod(fd, creation_mode()) != 0) {
    // Some file systems have no modes; the file is still good.
  }
  return OutputFile(file, scratch, fdopen(fd, "w+b"));
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

Error OutputFile::unwritable() const {
  return cannot_be_written(path_.empty() ? "standard output" : path_);
}

Result<void> OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) == bytes.size()) return {};
  return unwritable();
}

Result<void> OutputFile::flush() {
  if (std::fflush(stream_) == 0) return {};
  return unwritable();
}

Result<void> OutputFile::commit() {
  GONIO_TRY(flush());
  if (path_.empty()) return {};
  std::string named = scratch_;
  if (named.empty()) {
    named = scratch_name(path_);
    unlink(named.c_str());
    if (linkat(AT_FDCWD, scratch_path().c_str(), AT_FDCWD, named.c_str(), AT_SYMLINK_FOLLOW) != 0) return unwritable();
  }
  if (std::rename(named.c_str(), path_.c_str()) != 0) {
    const Error error = unwritable();  // before unlink() gives another reason
    unlink(named.c_str());
    return error;
  }
  scratch_.clear();
  return {};
}

std::string OutputFile::scratch_path() const {
  if (path_.empty()) return "";
  return scratch_.empty() ? path_of_descriptor(fileno(stream_)) : scratch_;
}

Result<void> write_file(const std::string& path, std::string_view bytes) {
  GONIO_ASSIGN(auto file, OutputFile::create(path));
  GONIO_TRY(file.write(bytes));
  return file.commit();
}

}  // namespace goniochrome
