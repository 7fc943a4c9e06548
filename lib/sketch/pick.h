// Paints picked from pictures: by droppers for face, flop and gloss, by palettes of a whole picture, and by mood
// boards, text files that name pictures and droppers. [Shimizu2009] 3.5, goniochrome-sketches(7), "MOOD BOARDS".
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "image/image.h"
#include "paint/paint.h"
#include "sketch/traced_light.h"

namespace goniochrome::sketch {

constexpr double kPickRadius = 5;  // pixels, where a dropper states none
constexpr double kPickTravel_deg = 60;

// Where a dropper stands: a disc about the center of a pixel.
struct Dropper {
  std::string image;  // a path, or on a board the name of one of its images
  int x = 0, y = 0;
  double radius = kPickRadius;
};

// Reads "img.jpg@x,y[,r]". Errors call the text by the name `option`.
Result<Dropper> parse_dropper(const std::string& text, const std::string& option);

// The result of a dropper.
struct PickSample {
  Dropper dropper;
  std::string path;
  int pixels = 0, clipped = 0, transparent = 0;
  color::Lab lab;    // of the mean light, or of the reflectance that explains it
  bool lit = false;  // whether it is the latter
  double gloss = 0;  // by contrast, gloss units
  std::vector<std::string> warnings;
};

// The light that a picture was drawn in, and what its numbers times a gain are: linear light of a picture that is
// scene-linear, and that of a picture for a display, which went through render-osmesa's default view.
struct PickLight {
  const TracedLight* traced = nullptr;
  double gain_linear = 1, gain_display = 1;
};

// The mean light of the disc's pixels without the transparent ones, and their contrast. With `light`, its color is
// that of the matt surface which would show this in the light that was traced for these pixels; without it, the light
// is taken for white and even. Error: the center of the disc lies outside the picture, no pixel is left, or the light
// is that of a picture of another size.
Result<PickSample> pick(const image::ImagePart& image, const std::string& path, const Dropper& dropper,
                        const PickLight* light = nullptr);

// A paint to be picked.
struct PaintPick {
  std::string name;
  std::optional<Dropper> face, flop, gloss;
  double travel_deg = kPickTravel_deg;
  bool retro = false;  // the flop may be lighter than the face; else the lighter color becomes the face
};

struct PickedPaint {
  paint::Paint paint;
  bool swapped = false;  // whether face and flop traded places because the flop was the lighter one
};

// The paint of these colors, of which one is enough: it is then both face and flop.
PickedPaint picked_paint(const PaintPick& pick, const std::optional<color::Lab>& face,
                         const std::optional<color::Lab>& flop, std::optional<double> gloss);

// Face and flop of `count` colors of a picture, the largest first. Pixels are grouped by hue and chroma, and the light
// and dark ends of each group are its face and flop. There are fewer where the picture has fewer colors.
struct PalettePair {
  color::Lab face, flop;
  double share = 0;  // of the picture's pixels
};
Result<std::vector<PalettePair>> palette(const image::ImagePart& image, const std::string& path, int count);

// A mood board as it stands in its text file.
struct BoardImage {
  std::string name, path;
};
struct Board {
  std::string title;
  std::vector<BoardImage> images;
  std::vector<PaintPick> paints;
};
// Lines of `title TEXT`, `image NAME PATH`, `paint NAME`, and below a paint `face IMAGE@x,y[,r]`, `flop ...`,
// `gloss ...`, `travel DEG`, `retro`; # begins a comment. Paths are relative to the board's folder. Errors name the
// file, the line, what stands there and what may stand there.
Result<Board> read_board(const std::string& path);

}  // namespace goniochrome::sketch
