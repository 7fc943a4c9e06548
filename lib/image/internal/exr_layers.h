// The picture in an EXR file: which of its channels are colors, and where they lie in the picture that is shown.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "image/image.h"

namespace goniochrome::image {

// The names of one part of a file and of its channels.
struct ExrPartNames {
  std::string part;
  std::vector<std::string> channels;
};

// The channels of a picture, by their names in the file and by those of a picture: R, G, B and A, or Y and A.
struct ExrLayer {
  std::size_t part = 0;
  std::vector<std::string> channels;
  std::vector<std::string> as;
};

// The layer that `wanted` names: PART, LAYER or PART.LAYER, or a single channel, which is gray. An empty name takes R G
// B or Y of the first part without a layer; else the only layer of all parts that has them. Upper and lower case are
// the same, and Red, Green, Blue and Alpha are R, G, B and A. A layer with X, Y and Z holds vectors and no gray. Error:
// there is none or more than one, and the message lists what there is.
Result<ExrLayer> color_layer(const std::vector<ExrPartNames>& parts, const std::string& wanted,
                             const std::string& file);

// A window of pixels: the place of its upper left one, and its size.
struct ExrWindow {
  int x = 0, y = 0, width = 0, height = 0;
};

// The picture that `display` shows of the pixels in `data`: 0 where there are none; what lies outside is cut off.
Image shown_in(const ExrWindow& display, const ExrWindow& data, Image image);

}  // namespace goniochrome::image
