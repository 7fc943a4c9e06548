// Float images in memory, and the files they come from: OpenEXR and Radiance HDR directly, everything else through
// OpenImageIO, which is loaded only when such a file is met (it costs 300 ms to start).
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/result.h"

namespace goniochrome::image {

// Interleaved float pixels, row 0 at the top.
struct Image {
  int width = 0, height = 0, channels = 0;
  std::vector<float> data;
  std::vector<std::string> channel_names;  // R G B ...; empty means R,G,B,A by count

  float* pixel(int x, int y) { return &data[(static_cast<std::size_t>(y) * width + x) * channels]; }
  const float* pixel(int x, int y) const { return &data[(static_cast<std::size_t>(y) * width + x) * channels]; }
};

// A vector is `chromaticities`: x y of red, green, blue and white.
using AttributeValue = std::variant<std::string, float, int, std::vector<float>>;
using Attributes = std::map<std::string, AttributeValue>;

enum class PixelType { kHalf, kFloat };

// One part of a (multi-part) EXR file.
struct ImagePart {
  std::string name;
  Image image;
  Attributes attributes;
  PixelType type = PixelType::kHalf;
};

// All parts of an EXR file, scan lines or tiles ("-" is standard input); channels in the order R G B A, then the others
// as stored. Error: path and reason; a cut file, deep data and subsampled channels are refused.
Result<std::vector<ImagePart>> read_exr(const std::string& path);

// Writes parts as one EXR (ZIP), beside the target and renamed; "-" is standard output. Halves are rounded to nearest;
// a value that a half cannot hold makes its part float. NaN and Inf are refused. Unnamed parts are named by number.
Result<void> write_exr(const std::string& path, const std::vector<ImagePart>& parts);

// What a CMYK JPEG or TIFF becomes: RGB without regard to its profile, or four channels C, M, Y and K, 1 being full
// ink.
enum class Inks { kAsRgb, kKept };

// An image of any format (EXR and Radiance HDR here, others through OpenImageIO), first part, as stored ("-" is
// standard input); `attributes` has `oiio:ColorSpace`, `chromaticities`, `colorInteropID`, `ICCProfile` and `envmap`
// ("latlong" or "cube"), as the file has them, and `goniochrome:integer`: 1 where it held whole numbers, now 0..1.
Result<ImagePart> read_image(const std::string& path, Inks inks = Inks::kAsRgb);

// 8-bit RGB PNG of display-referred values 0..1 (rounded, clamped), with text entries for provenance; "-" is standard
// output. One channel is gray; channels after the third are left out.
Result<void> write_png(const std::string& path, const Image& image, const Attributes& text = {});

// The bytes of that PNG; `name` is what errors call it.
Result<std::string> png_content(const std::string& name, const Image& image, const Attributes& text = {});

}  // namespace goniochrome::image
