#include "studio/packed_numbers.h"

namespace goniochrome::studio {

Json PackedNumbers::add_bytes(std::string_view bytes, std::size_t count) {
  bytes_.resize((bytes_.size() + 7) / 8 * 8, '\0');
  const std::size_t at = bytes_.size();
  bytes_ += bytes;
  return Json::array({at, count});
}

Json PackedNumbers::add_smooth(const std::vector<std::uint16_t>& numbers, std::size_t channels) {
  std::string planes(2 * numbers.size(), '\0');
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto difference = static_cast<std::uint16_t>(numbers[i] - (i >= channels ? numbers[i - channels] : 0));
    planes[i] = static_cast<char>(difference & 255);
    planes[numbers.size() + i] = static_cast<char>(difference >> 8);
  }
  return add_bytes(planes, numbers.size());
}

}  // namespace goniochrome::studio
