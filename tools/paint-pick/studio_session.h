// A mood board as a session of paint-studio, with its pictures.
#pragma once

#include <string>
#include <vector>

#include "page.h"

namespace goniochrome::tool {

// Returns the session as JSON: the design begins with the first paint, whose droppers lie on the board, and the others
// stand in the palette. Pictures that a browser may not read become PNG. Error: a picture cannot be read again.
Result<std::string> studio_session(const sketch::Board& board, const std::vector<PageImage>& images,
                                   const std::vector<PageOfPaint>& paints);

}  // namespace goniochrome::tool
