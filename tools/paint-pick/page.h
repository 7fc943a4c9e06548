// The page of a mood board.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "sketch/pick.h"

namespace goniochrome::tool {

// The data of one paint on the page.
struct PageOfPaint {
  sketch::PickedPaint picked;
  std::vector<std::pair<std::string, sketch::PickSample>> samples;  // "face", "flop", "gloss"
  std::string picture;                                              // PNG
};

struct PageImage {
  sketch::BoardImage image;
  image::ImagePart content;
};

// Where a page of paint-studio lies, as the page of the board sees it; empty for none. `board` is the file of the
// board.
struct StudioLink {
  std::string address, board;
};

// The picture as a display shows it, as PNG; each pixel is the mean light of `step` x `step`.
Result<std::string> shown_png(const PageImage& image, int step);

// Returns one HTML page that needs no other file. `lit_by` says how the paints were drawn.
Result<std::string> board_page(const sketch::Board& board, const std::vector<PageImage>& images,
                               const std::vector<PageOfPaint>& paints, const std::string& lit_by,
                               const StudioLink& studio);

}  // namespace goniochrome::tool
