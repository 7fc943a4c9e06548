// Pictures that people made or edited, as light: any file format, display-referred or scene-linear, into the working
// space. goniochrome-theory(7), SKETCH FITTING.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "color/color.h"
#include "image/image.h"

namespace goniochrome {

// What the numbers of a display picture went through on the way from light.
enum class PictureView {
  kPaint,  // render-osmesa's default: exact up to 80 % of white, then a shoulder that is undone here
  kPlain,  // nothing but the display's own curve: what a photograph or a drawing is taken for
};

struct Picture {
  Image rgb;  // three channels, working space; 1 is the white of the display, or as stored where scene-linear
  // Where a pixel says nothing of its light: clipped in a channel, or seen through.
  enum State : std::uint8_t { kGood, kClipped, kTransparent };
  std::vector<std::uint8_t> state;
  bool scene_linear = false;  // EXR, HDR: light itself
  std::string space;          // "sRGB", "ICC profile", "linear Rec.2020": what the file was taken for
  std::vector<std::string> warnings;

  const float* pixel(int x, int y) const { return rgb.pixel(x, y); }
};

// Reads any image. Tagged files are what they say (ICC profile, color space, chromaticities); untagged whole numbers
// are sRGB, untagged EXR is in the working space as render-osmesa writes it, other floats linear Rec.709. Inks of a
// CMYK picture without a profile are converted by a rule of thumb, and a warning says so. Error, with the remedy: not
// an image, a damaged profile or one of other channels, or an unknown color space.
Result<Picture> read_picture(const std::string& path, PictureView view);
// The same of an image that was read with Inks::kKept, or of a piece of one; `name` is what errors call it.
Result<Picture> picture_of(ImagePart part, const std::string& name, PictureView view);

// The view "Paint" undone for linear Rec.709 values below 1 in every channel.
Rgb paint_view_undone(const Rgb& shown);

// How much light five codes of an 8-bit sRGB display are about a linear value, one way through the view "Paint":
// `brightest` is the largest channel there.
double code_width(double linear, double brightest);

// What is left of a working-space color on an sRGB display: mixed with its gray until no channel is negative.
Rgb in_display_gamut(const Rgb& rgb);

}  // namespace goniochrome
