// Which names were seen, and where: finds a duplicate among millions in 24 bytes a name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace goniochrome::formats {

// Names are kept as 128-bit hashes: two different names in 10^7 are taken for one with a chance of 10^-25.
class NameLedger {
 public:
  // Notes `name` at `line`, or returns the line where it was noted before.
  std::optional<int> note(std::string_view name, int line);

 private:
  struct Entry {
    std::uint64_t hash[2] = {0, 0};
    int line = 0;  // 0 where the slot is free
  };
  Entry& slot(const Entry& wanted);

  std::vector<Entry> slots_ = std::vector<Entry>(1024);  // open addressing, a power of two, at most half full
  std::size_t used_ = 0;
};

}  // namespace goniochrome::formats
