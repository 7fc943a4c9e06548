#include "formats/paint_choice.h"

#include <filesystem>

namespace goniochrome::formats {

PaintReference paint_reference(const std::string& text) {
  std::error_code unknown;
  const auto hash = text.rfind('#');
  if (hash == std::string::npos || std::filesystem::exists(text, unknown)) return {text, std::nullopt};
  return {text.substr(0, hash), text.substr(hash + 1)};
}

}  // namespace goniochrome::formats
