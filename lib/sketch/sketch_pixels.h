// The pixels of an edited picture: which of them tell of the paint, what they show, and whether the picture was moved.
// goniochrome-sketches(7), "SKETCH FITTING".
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/result.h"
#include "image/aov_file.h"
#include "sketch/sketch_picture.h"

namespace goniochrome::sketch {

enum class PixelRule { kAuto, kChanged, kAll };

struct SketchInput {
  const image::AovFile* buffers = nullptr;
  const Picture* edited = nullptr;
  const image::Image* mask = nullptr;  // where its first channel is above 0.5, or null for everywhere
  std::vector<int> parts;              // numbers from 1; empty for all
  PixelRule rule = PixelRule::kAuto;   // kAuto takes the changed pixels alone where only a part was repainted
  int shift_x = 0, shift_y = 0;        // the edited picture lies this far to the right and below (pixels)
  double gain = 1;                     // edited values times this are light as in the buffers, exposure taken out
  double least_cosine = 0;             // of the light's incidence; darker places tell nothing
  double glare_deg = 0;                // aspecular angles below this are gloss
  // The picture of the paints of the buffers in their transport (radiance), or null. The picture may have begun as that
  // and not as the buffers' own picture, from which it differs by the noise of both.
  const image::Image* shaded = nullptr;
};

// Why a pixel is left out; kUsed is not.
enum class PixelUse : std::uint8_t {
  kUsed,
  kBackground,
  kOtherPart,
  kMasked,
  kEdge,
  kTransparent,
  kClipped,
  kGrazing,
  kGlare,
  kUnchanged,
  kCount
};
const char* pixel_use_name(PixelUse use);

struct SketchPixels {
  std::vector<PixelUse> use;         // of every pixel of the buffers
  std::vector<std::uint32_t> used;   // the places of those used, ascending
  std::vector<std::uint32_t> glare;  // those left out for glare, clipped ones among them
  std::array<std::size_t, static_cast<std::size_t>(PixelUse::kCount)> count{};
  std::size_t changed = 0;  // of the pixels that could be used
  bool changed_only = false;
  bool from_shaded = false;  // whether it keeps more pixels of SketchInput::shaded than of the buffers' own picture
};

// Sorts the pixels. Error: picture, mask and buffers differ in size, or the buffers lack a channel.
Result<SketchPixels> sketch_pixels(const SketchInput& input);

// The light that the edited picture shows at a place of the buffers (working space, exposure taken out). The shifted
// place must lie in the picture, as it does for every used pixel.
color::Rgb edited_light(const SketchInput& input, std::uint32_t place);

// By how many pixels the edited picture seems to lie to the right of and below the buffers' own: the shift of up to 8
// pixels either way at which the edges of both meet best.
struct SketchShift {
  int x = 0, y = 0;
};
SketchShift sketch_shift(const SketchInput& input);

}  // namespace goniochrome::sketch
