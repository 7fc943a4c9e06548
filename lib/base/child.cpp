#include "base/child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <optional>
#include <utility>

// GCC tells by a macro that the address sanitizer is there, and Clang by a question.
#if defined(__SANITIZE_ADDRESS__)
#define GONIO_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define GONIO_SANITIZED 1
#endif
#endif
#if defined(GONIO_SANITIZED)
#include <sanitizer/common_interface_defs.h>
#include <tbb/global_control.h>
#endif

namespace goniochrome {

namespace {

// The exit statuses of a child. A sanitizer ends with 1, and a library may call exit() with another small number.
constexpr int kDone = 0, kRefused = 40, kNoMemory = 41, kThreadless = 42;

// The bytes of addresses that this process has mapped, where the system tells them. A child asks for itself: other
// threads of its parent go on mapping until the very fork, and the allocator takes 64 MB of addresses for each of them.
std::optional<std::size_t> mapped_bytes() {
  const int file = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  char pages[32] = {};
  const bool told = read(file, pages, sizeof pages - 1) > 0;
  close(file);
  if (!told) return std::nullopt;
  return std::strtoul(pages, nullptr, 10) * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// Lowers a limit of this process; a limit that is lower already stays. `grace` lies between the soft limit and the hard
// one: at its soft limit of time a process gets SIGXCPU, and at the hard one SIGKILL, which tells nothing.
void limit(int resource, rlim_t most, rlim_t grace = 0) {
  rlimit now;
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &now) != 0) return;
  now.rlim_cur = std::min(now.rlim_cur, most);
  now.rlim_max = std::min(now.rlim_max, most + grace);
  setrlimit(static_cast<__rlimit_resource_t>(resource), &now);
}

// A quarter of the memory that this child may take, for a signal handler; 0 in a process that is no child.
std::size_t quarter = 0;

// True if a quarter of what the child may take is not to be had any more. Want of memory is then taken for the cause of
// whatever went wrong.
bool child_is_short_of_memory() {
  return mmap(nullptr, quarter, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED;
}

// A library that gets no memory may abort or write to address 0.
[[maybe_unused]] void explain_crash(int number) {
  if (child_is_short_of_memory()) _exit(kNoMemory);
  signal(number, SIG_DFL);
  raise(number);
}

// A child begins so: it dies of any signal and with its parent, keeps within the limits, and prints nothing.
void confine(const ChildLimits& limits, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) _exit(kRefused);
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGQUIT, SIGXCPU, SIGALRM}) signal(number, SIG_DFL);
  quarter = std::max<std::size_t>(limits.memory_bytes / 4, 1);
  for (const int number : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGTRAP})
#if defined(GONIO_SANITIZED)
    signal(number, SIG_DFL);
#else
    signal(number, explain_crash);
#endif
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, static_cast<rlim_t>(limits.processor_s), 2);
  alarm(static_cast<unsigned>(limits.waiting_factor * limits.processor_s));
  // A sanitizer has taken its terabytes of addresses by now, so that they are among those that are mapped.
  if (const auto mapped = mapped_bytes()) limit(RLIMIT_AS, *mapped + limits.memory_bytes);
#if defined(GONIO_SANITIZED)
  // It says on standard error what it found. A fuzzer must not take that for a finding in its own process.
  __sanitizer_set_death_callback([] {});
#else
  if (const int nowhere = open("/dev/null", O_WRONLY); nowhere >= 0)
    dup2(nowhere, STDOUT_FILENO), dup2(nowhere, STDERR_FILENO);
#endif
}

// The child's life. It never returns, and runs no destructor of the parent's objects.
[[noreturn]] void live(int descriptor, const std::string& name, const std::function<Result<void>(ChildOutput&)>& work) {
  ChildOutput output(descriptor);
  const auto refuse = [&](ErrorKind kind, const std::string& message) {
    if (ftruncate(descriptor, 0) != 0 || lseek(descriptor, 0, SEEK_SET) != 0) _exit(kNoMemory);
    const char letter = static_cast<char>(kind);
    output.write(&letter, 1);
    output.write(message.data(), message.size());
    _exit(kRefused);
  };
  try {
    const auto done = work(output);
    if (!done.ok()) refuse(done.error().kind, done.error().message);
    _exit(kDone);
  } catch (const std::bad_alloc&) {
    _exit(kNoMemory);
  } catch (const std::exception& e) {
    refuse(ErrorKind::kInput, fmt::format("{}: the library that reads it gave up: {}", name, e.what()));
  } catch (...) {
    refuse(ErrorKind::kInput, fmt::format("{}: the library that reads it gave up", name));
  }
  _exit(kRefused);
}

// Waits until the threads of parallel_for() have ended, which takes well under a millisecond; the next loop starts new
// ones. Only sanitizers need this. A child has the locks of all threads of its parent, but only one thread. The C
// library frees the locks of its own allocator in the child. The allocator of a sanitizer does not (GCC 12), and where
// another thread held its lock, the child waited for ever.
void end_threads() {
#if defined(GONIO_SANITIZED)
  tbb::task_scheduler_handle handle{tbb::attach{}};
  tbb::finalize(handle, std::nothrow);
#endif
}

Error needs_memory(const std::string& name, const ChildLimits& limits) {
  return input_error(
      "{}: cannot be read within the memory there is, or within the {} MB that a file of its size is allowed: is it "
      "damaged?",
      name, limits.memory_bytes >> 20);
}

// The sentence about a child that was ended by a signal.
Error ended_by(int number, const std::string& name, const ChildLimits& limits) {
  if (number == SIGXCPU || number == SIGALRM)
    return input_error("{}: reading it took more than {} s: is it damaged?", name, limits.processor_s);
  if (number == SIGKILL) return needs_memory(name, limits);  // as the system does to processes when memory runs out
  return input_error("{}: the library that reads it crashed on it ({}): the file is damaged: export it again", name,
                     strsignal(number));
}

// Ends the child when its time is up, also where a library has blocked every signal that can be blocked: one does so
// while it starts its threads, and waits for ever where there is no memory for them. Returns whether it was ended.
bool end_in_time(pid_t child, const ChildLimits& limits) {
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  if (handle < 0) return false;
  // A second more than the alarm of the child's own.
  const auto until =
      std::chrono::steady_clock::now() + std::chrono::seconds(limits.waiting_factor * limits.processor_s + 1);
  bool late = false;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - std::chrono::steady_clock::now());
    late = left.count() <= 0;
    pollfd ended{handle, POLLIN, 0};
    const int told = late ? 0 : poll(&ended, 1, static_cast<int>(std::min<long long>(left.count() + 1, 1 << 30)));
    if (late || told > 0 || (told < 0 && errno != EINTR)) break;
  }
  close(handle);
  if (late) kill(child, SIGKILL);
  return late;
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(const Descriptor&) = delete;
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  int number() const { return number_; }

 private:
  int number_;
};

Result<ChildBytes> content_of(const Descriptor& shared, const std::string& name) {
  struct stat status;
  if (fstat(shared.number(), &status) != 0) return input_error("{}: cannot be read: {}", name, std::strerror(errno));
  const auto size = static_cast<std::size_t>(status.st_size);
  if (size == 0) return ChildBytes(nullptr, 0);
  void* bytes = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, shared.number(), 0);
  if (bytes == MAP_FAILED) return input_error("{}: is too large for the memory there is", name);
  return ChildBytes(static_cast<const char*>(bytes), size);
}

}  // namespace

std::optional<std::size_t> addresses_left() {
  rlimit limit;
  const auto mapped = mapped_bytes();
  if (!mapped || getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur > *mapped ? static_cast<std::size_t>(limit.rlim_cur) - *mapped : 0;
}

void end_child_without_thread() {
  if (quarter > 0) _exit(child_is_short_of_memory() ? kNoMemory : kThreadless);
}

ChildBytes::ChildBytes(ChildBytes&& other) noexcept
    : bytes_(std::exchange(other.bytes_, nullptr)), size_(std::exchange(other.size_, 0)) {}

ChildBytes::~ChildBytes() {
  if (bytes_) munmap(const_cast<char*>(bytes_), size_);
}

void ChildOutput::write(const void* bytes, std::size_t size) {
  const char* from = static_cast<const char*>(bytes);
  while (size > 0) {
    const ssize_t count = ::write(descriptor_, from, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw std::bad_alloc();
    from += count, size -= static_cast<std::size_t>(count);
  }
}

Result<ChildBytes> made_by_child(const std::string& name, const ChildLimits& limits,
                                 const std::function<Result<void>(ChildOutput&)>& work) {
  const Descriptor shared(memfd_create("goniochrome", MFD_CLOEXEC));
  if (shared.number() < 0) return input_error("{}: cannot be read: {}", name, std::strerror(errno));
  const pid_t parent = getpid();
  end_threads();
  const pid_t child = fork();
  if (child < 0) return input_error("{}: no process can be started to read it: {}", name, std::strerror(errno));
  if (child == 0) {
    confine(limits, parent);
    live(shared.number(), name, work);
  }
  const bool late = end_in_time(child, limits);
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return input_error("{}: the process that reads it is lost: {}", name, std::strerror(errno));
  if (WIFSIGNALED(status)) return ended_by(late ? SIGALRM : WTERMSIG(status), name, limits);
  if (WEXITSTATUS(status) == kNoMemory) return needs_memory(name, limits);
  if (WEXITSTATUS(status) == kThreadless) return input_error("{}: cannot be read: {}", name, kNoThread);
  GONIO_ASSIGN(ChildBytes bytes, content_of(shared, name));
  if (WEXITSTATUS(status) == kDone) return bytes;
  if (WEXITSTATUS(status) == kRefused && !bytes.view().empty())
    return Error{static_cast<ErrorKind>(bytes.view()[0]), std::string(bytes.view().substr(1))};
  return input_error("{}: the library that reads it ended with status {}: the file is damaged: export it again", name,
                     WEXITSTATUS(status));
}

}  // namespace goniochrome
