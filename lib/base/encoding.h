// Texts that other programs save in UTF-16, with a byte order mark, as UTF-8.
#pragma once

#include <string>
#include <string_view>

namespace goniochrome {

// Turns a text into UTF-8, piece by piece. A text that does not begin with a mark of UTF-16 passes as it is; the mark
// becomes that of UTF-8. Half of a pair of surrogates becomes bytes that are not valid UTF-8.
class Utf8Decoder {
 public:
  // Appends to `text` what the next `bytes` mean.
  void append(std::string_view bytes, std::string& text);

 private:
  enum class Encoding { kUnknown, kPlain, kLittleEndian, kBigEndian };
  Encoding encoding_ = Encoding::kUnknown;
  std::string rest_;  // bytes of a character that is not complete yet
};

// A whole text, or its first bytes.
std::string as_utf8(std::string_view bytes);

// A whole text in UTF-8, UTF-16 or, where it is neither, Windows-1252, without the mark at its beginning and without
// control characters but tabs and ends of lines. `is_windows_1252` hears of the last.
std::string decoded_text(std::string_view bytes, bool& is_windows_1252);

}  // namespace goniochrome
