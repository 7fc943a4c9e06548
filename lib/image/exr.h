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
Result<std::vector<ImagePart>> read_exr(const std::string& path, const ExrWanted& wanted);

// Hands the parts over one by one, in their order. What `visit` leaves of a part's pixels is room for those of the
// next: memory that is new costs more than decoding does. An error of `visit` ends it.
using ExrVisit = std::function<Result<void>(ImagePart& part)>;
Result<void> visit_exr(const std::string& path, const ExrWanted& wanted, const ExrVisit& visit);

// The picture of an EXR file: its colors, with alpha where there is one, in its display window. `layer` names them, or
// is empty for the only ones or those without a layer.
Result<ImagePart> decoded_exr_picture(const std::string& content, const std::string& name, const std::string& layer);

}  // namespace goniochrome::image
