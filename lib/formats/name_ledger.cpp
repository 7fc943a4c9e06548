#include "formats/name_ledger.h"

namespace goniochrome::formats {

namespace {

// FNV-1a from a given start, with the bits stirred at the end (the finalizer of MurmurHash3), since FNV's high bits are
// weak for short names.
std::uint64_t hash_of(std::string_view text, std::uint64_t start) {
  std::uint64_t h = start;
  for (const char c : text) h = (h ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccd;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53;
  return h ^ (h >> 33);
}

}  // namespace

NameLedger::Entry& NameLedger::slot(const Entry& wanted) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t i = wanted.hash[0] & mask;
  while (slots_[i].line != 0 && (slots_[i].hash[0] != wanted.hash[0] || slots_[i].hash[1] != wanted.hash[1]))
    i = (i + 1) & mask;
  return slots_[i];
}

std::optional<int> NameLedger::note(std::string_view name, int line) {
  const Entry entry{{hash_of(name, 0xcbf29ce484222325), hash_of(name, 0x9e3779b97f4a7c15)}, line};
  Entry& found = slot(entry);
  if (found.line != 0) return found.line;
  found = entry;
  if (2 * ++used_ > slots_.size()) {
    std::vector<Entry> old(2 * slots_.size());
    old.swap(slots_);
    for (const Entry& kept : old)
      if (kept.line != 0) slot(kept) = kept;
  }
  return std::nullopt;
}

}  // namespace goniochrome::formats
