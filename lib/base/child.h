// Work that may crash, run away or ask for too much memory, done in a process of its own. The readers of other people's
// libraries run here: what a damaged file does to such a library ends the child, and becomes an error message.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace goniochrome {

struct ChildLimits {
  std::size_t memory_bytes = 0;  // of addresses, beyond those that this process has when the child begins
  int processor_s = 0;           // whole seconds of processor time
  // A child that waits for a lock uses no processor time. So many times as many seconds are far more than a busy
  // machine adds.
  int waiting_factor = 20;
};

// The result of a child process: bytes in memory that is no longer shared.
class ChildBytes {
 public:
  ChildBytes(const char* bytes, std::size_t size) : bytes_(bytes), size_(size) {}
  ChildBytes(ChildBytes&& other) noexcept;
  ChildBytes& operator=(ChildBytes&&) = delete;
  ~ChildBytes();
  std::string_view view() const { return {bytes_, size_}; }

 private:
  const char* bytes_;  // null where there are none
  std::size_t size_;
};

// Where a child process puts its bytes. It throws std::bad_alloc where there is no memory for them.
class ChildOutput {
 public:
  explicit ChildOutput(int descriptor) : descriptor_(descriptor) {}
  void write(const void* bytes, std::size_t size);

 private:
  int descriptor_;
};

// The bytes of addresses that this process may map beyond those that it has, or nothing where there is no limit or the
// system does not tell.
std::optional<std::size_t> addresses_left();

// Runs `work` in a child process and returns what it wrote. The child sees this process as it is, but nothing that it
// changes comes back except those bytes, and whatever it prints is lost. Error: the one that `work` returned, or a
// sentence about `name` (a file) where the child crashed, passed a limit or could not be started. To start and end a
// child takes 1 to 3 ms, which grow with the memory of this process. Do not trust the bytes: a library whose memory was
// damaged may have written anything.
Result<ChildBytes> made_by_child(const std::string& name, const ChildLimits& limits,
                                 const std::function<Result<void>(ChildOutput&)>& work);

// The beginning of a sentence for a thread that cannot start: the missing resource, and the remedy.
inline constexpr const char* kNoThread =
    "no thread can be started, because the system allows no more of them (`ulimit -u`, or the limit of a container): "
    "raise the limit, or end other processes";

// Ends this process if it is such a child, and its parent then tells that a library could not start a thread. Elsewhere
// it does nothing.
void end_child_without_thread();

}  // namespace goniochrome
