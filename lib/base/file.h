// Files: read whole or as their bytes come, and written so that they appear whole or not at all. In all of them "-" is
// standard input or standard output, and an error names the path and the system's reason.
#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include "base/result.h"

namespace goniochrome {

// The bytes of a file or of standard input as they come.
class InputFile {
 public:
  // Opens `path`; "" is standard input too. A folder is refused.
  static Result<InputFile> open(const std::string& path);
  InputFile(InputFile&& other) noexcept;
  InputFile& operator=(InputFile&&) = delete;
  ~InputFile();

  // The name in errors: the path, or "standard input".
  const std::string& name() const { return name_; }

  // The first bytes, as many as one read gives (none only where the input is empty); read() still returns them.
  Result<std::string_view> peek();

  // Appends to `buffer` what is there, `most` bytes or less, and returns how many; 0 at the end. It waits for the first
  // byte only, so that a pipe is passed on as it comes.
  Result<std::size_t> read(std::string& buffer, std::size_t most);

  // A second reader of all that this one has still to read, for formats that must be read twice. A pipe is first read
  // to its end, into a temporary file without a name, which both readers then read. Error: that file cannot be made.
  Result<InputFile> second_reading();

  // All that is left. Error: it is more than `most` bytes.
  Result<std::string> rest(std::size_t most);

 private:
  InputFile(std::string name, int descriptor) : name_(std::move(name)), descriptor_(descriptor) {}

  std::string name_;
  int descriptor_;
  std::string ahead_;  // peeked and not yet read
};

// The whole of a file or of standard input.
Result<std::string> file_content(const std::string& path);

// A file that is written beside `path` and put in its place by commit(). Until then the old file stays as it was,
// and a process that dies leaves nothing behind. Standard output ("-" or "") is written as it comes.
class OutputFile {
 public:
  static Result<OutputFile> create(const std::string& path);
  OutputFile(OutputFile&& other) noexcept;
  OutputFile& operator=(OutputFile&&) = delete;
  ~OutputFile();

  // Appends `bytes`. Error: the disk is full, the pipe is closed, ...
  Result<void> write(std::string_view bytes);

  // Hands buffered bytes to the system, so that the next program in a pipe sees them.
  Result<void> flush();

  // Puts the file in place (fsync is left to the system). Call it once, after everything else.
  Result<void> commit();

  // A path under which a library that wants a name can open the unfinished file for writing; "" for standard output.
  std::string scratch_path() const;

 private:
  OutputFile(std::string path, std::string scratch, std::FILE* stream)
      : path_(std::move(path)), scratch_(std::move(scratch)), stream_(stream) {}
  Error unwritable() const;

  std::string path_;     // "" for standard output
  std::string scratch_;  // "" where the unfinished file has no name in the folder
  std::FILE* stream_;
};

// Writes `bytes` to `path` whole or not at all.
Result<void> write_file(const std::string& path, std::string_view bytes);

}  // namespace goniochrome
