#include "formats/internal/sections.h"

#include <algorithm>

#include "base/text.h"

namespace goniochrome::formats {

Result<bool> SectionLines::next() {
  while (!rest_.empty()) {
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    unfinished_ = end == rest_.size();
    const std::string_view text = trimmed(rest_.substr(0, end));
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    ++line_;
    if (text.empty() || text.front() == ';') continue;
    if (text.front() == '[' && text.back() == ']') {
      section_ = upper(trimmed(text.substr(1, text.size() - 2)));
      key_.clear(), value_ = {};
      return true;
    }
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos || equals == 0)
      return input_error("\"{}\" is neither [SECTION] nor KEY=VALUE: the file is damaged, or was cut off", shown(text));
    key_ = upper(trimmed(text.substr(0, equals))), value_ = trimmed(text.substr(equals + 1));
    return true;
  }
  return false;
}

}  // namespace goniochrome::formats
