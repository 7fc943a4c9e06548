// The decoders of goniochrome-codecs.so, one for each library.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace goniochrome::image {

// A picture on its way from a decoder to the caller of the module.
struct Picture {
  int width = 0, height = 0, channels = 0;
  std::vector<float> pixels;  // interleaved, from the top
  std::vector<std::string> names;
  std::string color_space, interop_id, envmap, icc_profile;
  bool is_integer = true, is_inks = false;
};

// Gives the picture its size, names and memory. Returns "", or why a file of `bytes` bytes cannot hold that many pixels.
std::string set_size(Picture& picture, std::size_t width, std::size_t height, std::vector<std::string> names,
                     std::size_t bytes);

// The names of the channels of gray or color, with or without alpha: 1 to 4 of them.
std::vector<std::string> color_names(int channels);

// Multiplies color by alpha, which is the last channel.
void associate_alpha(Picture& picture);

// C, M, Y and K become RGB.
void mix_inks(Picture& picture);

// Each returns "", or why the file cannot be read.
std::string decode_png(std::string_view file, Picture& picture);
std::string decode_jpeg(std::string_view file, bool keep_inks, Picture& picture);
std::string decode_tiff(std::string_view file, bool keep_inks, Picture& picture);

}  // namespace goniochrome::image
