// Pictures that people made or edited, as light in the working space. They come in any file format, with the signals of
// a display or with linear light. goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "image/image.h"

namespace goniochrome::sketch {

// The way from light that the numbers of a display picture went. A view that the picture names is undone, see
// image::kViewAttribute; this is the way of a picture that names none.
enum class PictureView {
  kPaint,  // render-osmesa's default, display::paint_view(), which is undone
  kPlain,  // nothing but the display's own curve, as in a photograph or a drawing
  kShown,  // that too, and a view that the picture names is kept: what a display shows
};

struct Picture {
  image::Image rgb;  // three channels, working space; 1 is the white of the display, or as stored where scene-linear
  // A pixel that is clipped in a channel, or transparent, does not tell its light.
  enum State : std::uint8_t { kGood, kClipped, kTransparent };
  std::vector<std::uint8_t> state;
  bool scene_linear = false;  // EXR, HDR: light itself
  std::string space;          // "sRGB", "ICC profile", "linear Rec.2020": what the file was taken for
  std::vector<std::string> warnings;
  // The effects that the picture was drawn without, by render-osmesa's names; nothing where its header does not tell.
  std::optional<std::vector<std::string>> left_out;
  std::optional<int> samples;  // of each pixel, by the same header

  const float* pixel(int x, int y) const { return rgb.pixel(x, y); }
};

// Reads any image. Tagged files are what they say (ICC profile, color space, chromaticities); untagged whole numbers
// are sRGB, untagged floats linear Rec.709. Inks of a CMYK picture without a profile are converted by a rule of thumb,
// and a warning says so. Error, with the remedy: not an image, a damaged profile or one of other channels, an unknown
// color space, or a view that cannot be undone.
// `named`, where it has a name, is the view in place of the one that the picture names.
Result<Picture> read_picture(const std::string& path, PictureView view, const std::string& named = "");
// The picture of an image that was read with Inks::kKept, or of a piece of one; `name` is its name in errors.
Result<Picture> picture_of(image::ImagePart part, const std::string& name, PictureView view);

}  // namespace goniochrome::sketch
