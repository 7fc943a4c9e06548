// EXR pictures in memory.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "image/image.h"

namespace goniochrome::image {

// The parts of an EXR file to decode; decoding takes most of the time of reading one.
struct ExrWanted {
  // Selects the parts whose pixels are wanted, by name and attributes; without the function all parts are.
  std::function<bool(const std::string& name, const Attributes& attributes)> part = {};
  // The channels of one part, the first, that are wanted, in their order in a pixel, as far as it has them; empty: all.
  std::vector<std::string> channels = {};
  int channels_of = 0;
};

// All parts of an EXR file held in memory; `name` is what errors call it. A part that is not wanted has no pixels.
Result<std::vector<ImagePart>> decoded_exr(const std::string& content, const std::string& name,
                                           const ExrWanted& wanted = {});

// Decodes the part of that name, and returns false where there is none. The pixels that `part` had are room for those
// of the new one: memory that is new costs more than decoding does.
using ExrPart = std::function<Result<bool>(const std::string& name, ImagePart& part)>;
// The first part, with the channels that are wanted of it, and the others when they are asked for. Error: as
// read_exr(); each part is there as a whole.
struct OpenExr {
  ImagePart first;
  ExrPart other;
};
Result<OpenExr> open_exr(const std::string& path, const std::vector<std::string>& channels);

// The picture of an EXR file: its colors, with alpha where there is one, in its display window. `layer` names them, or
// is empty for the only ones or those without a layer.
Result<ImagePart> decoded_exr_picture(const std::string& content, const std::string& name, const std::string& layer);

}  // namespace goniochrome::image
