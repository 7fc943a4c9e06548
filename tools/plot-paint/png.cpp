#include "png.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>

extern char** environ;

namespace goniochrome::tool {

namespace {

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) == 0) read_end = ends[0], write_end = ends[1];
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    for (int* end : {&read_end, &write_end}) close_end(*end);
  }
  static void close_end(int& end) {
    if (end >= 0) close(end);
    end = -1;
  }
};

// Writes `input` to one pipe and collects what comes back from the other, whichever of them is ready.
std::string exchanged(const std::string& input, Pipe& to, Pipe& from) {
  std::string output;
  std::size_t sent = 0;
  std::array<char, 65536> buffer;
  fcntl(to.write_end, F_SETFL, O_NONBLOCK);
  while (from.read_end >= 0) {
    pollfd ends[] = {{from.read_end, POLLIN, 0}, {to.write_end, POLLOUT, 0}};
    if (poll(ends, 2, -1) < 0 && errno != EINTR) break;
    if (to.write_end >= 0 && ends[1].revents) {
      const ssize_t count = write(to.write_end, input.data() + sent, input.size() - sent);
      if (count > 0) sent += static_cast<std::size_t>(count);
      if (sent == input.size() || (count < 0 && errno != EAGAIN)) Pipe::close_end(to.write_end);
    }
    if (ends[0].revents) {
      const ssize_t count = read(from.read_end, buffer.data(), buffer.size());
      if (count <= 0) break;
      output.append(buffer.data(), static_cast<std::size_t>(count));
    }
  }
  return output;
}

}  // namespace

Result<std::string> png_of(const std::string& svg) {
  Pipe to, from;
  if (to.read_end < 0 || from.read_end < 0) return input_error("a pipe cannot be made: {}", std::strerror(errno));
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, to.read_end, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, from.write_end, STDOUT_FILENO);
  std::string name = "rsvg-convert", option = "--format=png";
  char* arguments[] = {name.data(), option.data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawnp(&child, name.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed)
    return input_error("a PNG takes rsvg-convert, which cannot be started ({}): install librsvg2-bin, or write an SVG",
                       std::strerror(failed));
  Pipe::close_end(to.read_end);
  Pipe::close_end(from.write_end);
  const auto before = std::signal(SIGPIPE, SIG_IGN);
  std::string png = exchanged(svg, to, from);
  std::signal(SIGPIPE, before);
  int status = 0;
  waitpid(child, &status, 0);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0 || png.empty())
    return input_error("rsvg-convert made no picture (status {}): write an SVG", WEXITSTATUS(status));
  return png;
}

}  // namespace goniochrome::tool
