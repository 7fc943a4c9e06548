// Which texts can go into a file that others read.
#pragma once

#include <string>
#include <string_view>

namespace goniochrome {

// Whether `text` is valid UTF-8 without control characters but tab and line ends: what XML can hold.
bool is_plain_utf8(std::string_view text);

// `text` with "?" in place of every byte that is in the way of that.
std::string plain_utf8(std::string_view text);

// `text` as a message can quote it: on one line, cut after 60 bytes.
std::string shown(std::string_view text);

}  // namespace goniochrome
