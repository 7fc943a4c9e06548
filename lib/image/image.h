// Float images in memory, and the files they come from and go to. OpenEXR, Radiance HDR and PNM are read here; PNG,
// JPEG and TIFF by their own libraries, in a child process; DPX, WebP, BMP and TGA by the program oiiotool of
// OpenImageIO, where it is installed. The path "-" is standard input or standard output everywhere.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
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

// A picture with this value everywhere.
inline Image even_image(int width, int height, int channels, std::vector<std::string> channel_names = {},
                        float value = 0) {
  return {width, height, channels, std::vector<float>(static_cast<std::size_t>(width) * height * channels, value),
          std::move(channel_names)};
}

// A vector is `chromaticities`: x y of red, green, blue and white.
using AttributeValue = std::variant<std::string, float, int, std::vector<float>>;
using Attributes = std::map<std::string, AttributeValue>;

// The value of an attribute, or null where there is none of that name and type.
template <class T>
const T* find_attribute(const Attributes& attributes, const std::string& name) {
  const auto found = attributes.find(name);
  return found == attributes.end() ? nullptr : std::get_if<T>(&found->second);
}

// The value of an attribute, or `otherwise`.
template <class T>
T attribute_or(const Attributes& attributes, const std::string& name, const T& otherwise) {
  const T* value = find_attribute<T>(attributes, name);
  return value ? *value : otherwise;
}

enum class PixelType { kHalf, kFloat };

// One part of a (multi-part) EXR file.
struct ImagePart {
  std::string name;
  Image image;
  Attributes attributes;
  PixelType type = PixelType::kHalf;
  int left = 0, top = 0;  // where its pixels begin in the picture that the parts show
};

// The text of an attribute; "" where there is none, or no text.
std::string text_attribute(const ImagePart& part, const std::string& name);

// All parts of an EXR file, stored as scan lines or tiles. Channels come in the order R G B A, then the others as they
// are stored. Pixels are those of the display window, but those of the part's own window where a file has several parts
// that begin at the same corner. Error: the path and the reason; a file that is cut off, deep data and subsampled
// channels are refused.
Result<std::vector<ImagePart>> read_exr(const std::string& path);

// Writes parts as one EXR file (ZIP), which appears whole or not at all. Halves are rounded to the nearest; a part with
// a value that a half cannot hold is written as floats. NaN and infinity are refused. A part without a name is named by
// its number.
Result<void> write_exr(const std::string& path, const std::vector<ImagePart>& parts);

// The bytes of that file, or of one that is not compressed; `name` is what errors call it. Without compression,
// pictures of one size whose attributes have the same lengths take the same number of bytes.
enum class ExrStorage { kZip, kPlain };
Result<std::string> exr_content(const std::string& name, const std::vector<ImagePart>& parts,
                                ExrStorage storage = ExrStorage::kZip);

// The result for a CMYK JPEG or TIFF: RGB without regard to its profile, or four channels C, M, Y and K, where 1 is
// full ink.
enum class Inks { kAsRgb, kKept };

// The picture in a file, upright, with channels R G B, R G B A, Y or Y A where it is an EXR. Its content tells the
// format, not its name; others are refused. FILE[LAYER] names the colors of an EXR file that has several layers of
// them, or one channel that is gray; without it they are those without a layer, or the only ones. An EXR is read in its
// display window: 0 where it has no pixels, and without those outside.
// `attributes` has `oiio:ColorSpace`, `chromaticities`, `colorInteropID`, `ICCProfile` and `envmap` ("latlong" or
// "cube") where the file has them, and `goniochrome:integer`, which is 1 where it holds whole numbers; these are 0..1.
// `goniochrome:inks` is there where the file is CMYK. `radiance:VIEW` has the options of rpict(1) that tell the
// projection of a Radiance picture.
Result<ImagePart> read_image(const std::string& path, Inks inks = Inks::kAsRgb);

// The file that a path of read_image() names, without its layer.
std::string image_file(const std::string& path);

// Error: the first value that is not finite, by pixel and channel.
Result<void> check_finite(const Image& image);

// Writes sRGB signals 0..1, rounded and clamped, as a PNG of 8 bits and RGB that says so, with text entries for
// provenance. One channel is gray; channels after the third are left out. NaN and infinity are refused.
Result<void> write_png(const std::string& path, const Image& image, const Attributes& text = {});

// The bytes of that PNG; `name` is what errors call it.
Result<std::string> png_content(const std::string& name, const Image& image, const Attributes& text = {});

}  // namespace goniochrome::image
