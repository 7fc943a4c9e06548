// The targets of fuzzing: every reader of files that come from elsewhere, by name.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace goniochrome::fuzz {

struct FuzzTarget {
  std::string_view name;       // also the folder of its corpus
  std::string_view file_name;  // under which the reader gets the bytes
  // Reads the file at a path and visits everything that comes of it. A reader may refuse the file; it may not crash,
  // hang, or return a number that is not finite.
  std::function<void(const std::string& path)> read;
};

const std::vector<FuzzTarget>& fuzz_targets();

// One input: writes it into a scratch folder of this process, and has it read.
class FuzzRun {
 public:
  explicit FuzzRun(const FuzzTarget& target);
  FuzzRun(const FuzzRun&) = delete;
  ~FuzzRun();
  void operator()(std::string_view bytes) const;
  const std::string& path() const { return path_; }

 private:
  const FuzzTarget& target_;
  std::string folder_, path_;
};

}  // namespace goniochrome::fuzz
