// Bytes as text that files and addresses can hold.
#pragma once

#include <string>
#include <string_view>

namespace goniochrome {

// Encodes bytes as base64 with padding.
std::string base64(std::string_view bytes);

// Encodes bytes as a part of an address: letters, digits and -._~ stay, and each other byte becomes % and its two
// hexadecimal digits. `kept` are more that stay.
std::string percent_encoded(std::string_view bytes, std::string_view kept = "");

}  // namespace goniochrome
