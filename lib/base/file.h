// Files that appear whole or not at all.
#pragma once

#include <cstdio>
#include <string>
#include <string_view>

#include "base/result.h"

namespace goniochrome {

// The whole of a file ("-" is standard input). Error: the path and the system's reason.
Result<std::string> file_content(const std::string& path);

// An output that is written beside `path` and put in its place by commit(). Until then the old file stays as it was,
// and a process that dies leaves nothing behind. "-" or "" is standard output, written as it comes.
class OutputFile {
 public:
  static Result<OutputFile> create(const std::string& path);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  // Appends `bytes`. Error: disk full, closed pipe, ...
  Result<void> write(std::string_view bytes);

  // Hands buffered bytes to the system, so that the next program in a pipe sees them.
  Result<void> flush();

  // Puts the file in place (fsync is left to the system). Call once, last.
  Result<void> commit();

  // A path under which the unfinished file can be opened for writing by a library that wants a name; "" for standard
  // output.
  std::string scratch_path() const;

 private:
  OutputFile(std::string path, std::string scratch, std::FILE* stream)
      : path_(std::move(path)), scratch_(std::move(scratch)), stream_(stream) {}

  std::string path_;     // "" for standard output
  std::string scratch_;  // "" where the unfinished file has no name in the folder
  std::FILE* stream_;
};

// Writes `bytes` to `path` whole or not at all.
Result<void> write_file(const std::string& path, std::string_view bytes);

}  // namespace goniochrome
