// Paints from pictures: droppers for face, flop and gloss, palettes, and boards of both. [Shimizu2009] 3.5
// goniochrome-theory(7), MOOD BOARDS.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "image/image.h"
#include "paint/paint.h"

namespace goniochrome::sketch {

constexpr double kPickRadius = 5;  // pixels, where a dropper states none
constexpr double kPickTravel_deg = 60;

// Where a dropper stands: a disc about the center of a pixel.
struct Dropper {
  std::string image;  // a path, or on a board the name of one of its images
  int x = 0, y = 0;
  double radius = kPickRadius;
};

// "img.jpg@x,y[,r]"; `option` is what errors call it.
Result<Dropper> parse_dropper(const std::string& text, const std::string& option);

// What a dropper found.
struct PickSample {
  Dropper dropper;
  std::string path;
  int pixels = 0, clipped = 0, transparent = 0;
  color::Lab lab;    // of the mean light
  double gloss = 0;  // by contrast, gloss units
  std::vector<std::string> warnings;
};

// The mean in linear light of the disc's pixels, transparent ones left out, and their contrast. Error: the disc's
// center lies outside the picture, or no pixel is left.
Result<PickSample> pick(const image::ImagePart& image, const std::string& path, const Dropper& dropper);

// A paint to be picked.
struct PaintPick {
  std::string name;
  std::optional<Dropper> face, flop, gloss;
  double travel_deg = kPickTravel_deg;
  bool retro = false;  // a flop lighter than the face is meant
};

struct PickedPaint {
  paint::Paint paint;
  bool swapped = false;  // face and flop, for the flop was the lighter one
};

// One color is taken for both where only one is given.
PickedPaint picked_paint(const PaintPick& pick, const std::optional<color::Lab>& face,
                         const std::optional<color::Lab>& flop, std::optional<double> gloss);

// Face and flop of `count` colors of a picture, the largest first: pixels are grouped by hue and chroma, and each
// group's light and dark ends are its face and flop. Fewer where the picture has fewer colors.
struct PalettePair {
  color::Lab face, flop;
  double share = 0;  // of the picture's pixels
};
Result<std::vector<PalettePair>> palette(const image::ImagePart& image, const std::string& path, int count);

// A mood board, as its text file has it.
struct BoardImage {
  std::string name, path;
};
struct Board {
  std::string title;
  std::vector<BoardImage> images;
  std::vector<PaintPick> paints;
};
// Lines of `title TEXT`, `image NAME PATH`, `paint NAME`, and below a paint `face IMAGE@x,y[,r]`, `flop ...`,
// `gloss ...`, `travel DEG`, `retro`; # begins a comment. Paths are relative to the board's folder. Error: file, line,
// what stands there and what may.
Result<Board> read_board(const std::string& path);

}  // namespace goniochrome::sketch
