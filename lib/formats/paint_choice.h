// How a command line names one paint of a file.
#pragma once

#include <optional>
#include <string>

namespace goniochrome::formats {

struct PaintReference {
  std::string file;
  std::optional<std::string> name;  // of the one paint that is meant
};

// FILE or FILE#NAME taken apart at the last #; a file that is there and has a # in its own name is meant as it stands.
PaintReference paint_reference(const std::string& text);

}  // namespace goniochrome::formats
