// Bytes from a file or from standard input, as they come.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "base/result.h"

namespace goniochrome {

class InputFile {
 public:
  // Opens `path`; "-" or "" is standard input. Error: the path and the system's reason.
  static Result<InputFile> open(const std::string& path);
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  // What errors call it: the path, or "standard input".
  const std::string& name() const { return name_; }

  // The first bytes, as many as one read gives (none only where the input is empty); read() still returns them.
  Result<std::string_view> peek();

  // Appends to `buffer` what is there, at most `most` bytes, and returns how many; 0 at the end. Waits for the first
  // byte only, so that a pipe is passed on as it comes.
  Result<std::size_t> read(std::string& buffer, std::size_t most);

 private:
  InputFile(std::string name, int descriptor) : name_(std::move(name)), descriptor_(descriptor) {}

  std::string name_;
  int descriptor_;
  std::string ahead_;  // peeked and not yet read
};

}  // namespace goniochrome
