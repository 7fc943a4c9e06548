// The parts of a ZIP archive in memory.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"

namespace goniochrome::formats {

class ZipArchive {
 public:
  // Nothing where the bytes of the file `name` are no archive.
  static std::optional<ZipArchive> open(const std::string& name, std::string bytes);
  ZipArchive(ZipArchive&&) noexcept;
  ZipArchive& operator=(ZipArchive&&) noexcept;
  ~ZipArchive();

  struct Part {
    std::size_t packed_bytes = 0;
    bool is_encrypted = false;
  };
  // Nothing where the archive has no part of that name.
  std::optional<Part> part(const std::string& name) const;

  // Appends unpacked bytes to the first argument, as many as the second or fewer, and returns how many; 0 at the end.
  using Unpacking = std::function<Result<std::size_t>(std::string&, std::size_t)>;
  // Unpacks a part; the archive must outlive it. Error: the reason, without a place.
  Result<Unpacking> unpacking(const std::string& name) const;

 private:
  struct State;
  explicit ZipArchive(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace goniochrome::formats
