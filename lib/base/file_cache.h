// Files that later runs use again. The folder is bounded in size, and many runs may share it: each file appears whole
// or not at all, and whoever misses one makes it again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/result.h"

namespace goniochrome {

// $XDG_CACHE_HOME/goniochrome, or ~/.cache/goniochrome where that is not set to an absolute path; "" where $HOME is not
// either. https://specifications.freedesktop.org/basedir-spec
std::string user_cache_folder();

class FileCache {
 public:
  // `ending` is that of all names, as in ".env.exr". The folder is made when the first file is kept.
  FileCache(std::string folder, std::string ending, std::uint64_t most_bytes)
      : folder_(std::move(folder)), ending_(std::move(ending)), most_bytes_(most_bytes) {}

  const std::string& folder() const { return folder_; }

  // The content that was kept under a key, or nothing. The name of each file holds a digest of its content, and a
  // file that does not fit its digest is removed. Finding a file makes it the one that was used last.
  std::optional<std::string> find(const std::string& key) const;

  // Keeps content under a key of hexadecimal digits, and removes the files that were used longest ago until all fit the
  // bound. Error: the content alone is larger, or the file cannot be written, with the system's reason.
  Result<void> keep(const std::string& key, std::string_view content) const;

 private:
  void make_room(std::uint64_t bytes, const std::string& but) const;

  std::string folder_, ending_;
  std::uint64_t most_bytes_;
};

}  // namespace goniochrome
