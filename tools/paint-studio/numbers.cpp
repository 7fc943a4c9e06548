#include "numbers.h"

#include <zlib.h>

#include "base/encode.h"

namespace goniochrome::tool {

std::string compressed_text(std::string_view bytes) {
  constexpr int kGzip = 15 + 16, kMemory = 8;
  z_stream stream{};
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzip, kMemory, Z_DEFAULT_STRATEGY);
  std::string member(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(member.data());
  stream.avail_out = static_cast<uInt>(member.size());
  deflate(&stream, Z_FINISH);  // the bound leaves room for all of it
  member.resize(stream.total_out);
  deflateEnd(&stream);
  return base64(member);
}

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

}  // namespace goniochrome::tool
