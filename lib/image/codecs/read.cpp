// The entry of goniochrome-codecs.so, and what its decoders share.
#include <exception>
#include <new>

#include "image/codecs/decoders.h"
#include "image/internal/codec_module.h"
#include "image/internal/exr.h"

namespace goniochrome::image {

namespace {

// The most samples that a byte of any of the formats stands for, and a number of them that no file is too short for.
// Deflate makes 1032 bytes of one, and a JPEG has one bit at least for 64 samples of one channel. A file that packs
// better has one color all over, or a forged header.
constexpr std::size_t kSamplesAByte = 1100, kFreeSamples = std::size_t{1} << 22;

std::string decode(std::string_view file, const std::string& format, bool keep_inks, Picture& picture) {
  if (format == "png") return decode_png(file, picture);
  if (format == "jpeg") return decode_jpeg(file, keep_inks, picture);
  return decode_tiff(file, keep_inks, picture);
}

void hand_over(const Picture& picture, void* context, GoniochromeTake take) {
  std::vector<const char*> names;
  for (const std::string& name : picture.names) names.push_back(name.c_str());
  const GoniochromeDecoded decoded = {picture.width,
                                      picture.height,
                                      picture.channels,
                                      picture.pixels.data(),
                                      names.data(),
                                      picture.color_space.c_str(),
                                      picture.interop_id.c_str(),
                                      picture.envmap.c_str(),
                                      picture.icc_profile.empty() ? nullptr : picture.icc_profile.data(),
                                      picture.icc_profile.size(),
                                      picture.is_integer ? 1 : 0,
                                      picture.is_inks ? 1 : 0};
  take(context, &decoded);
}

}  // namespace

std::string set_size(Picture& picture, std::size_t width, std::size_t height, std::vector<std::string> names,
                     std::size_t bytes) {
  if (width == 0 || height == 0 || names.empty()) return "it has no pixels";
  // Neither factor is larger than 32 bits, so that the first product cannot overflow.
  const std::size_t pixels = width * height;
  if (pixels > kMostSamples || pixels * names.size() > kMostSamples)
    return "its header says more pixels than fit into 8 GB: is it damaged?";
  const std::size_t samples = pixels * names.size();
  if (samples > kFreeSamples && samples / kSamplesAByte > bytes)
    return "its header says more pixels than a file of its size can hold: is it damaged?";
  picture.width = static_cast<int>(width), picture.height = static_cast<int>(height);
  picture.channels = static_cast<int>(names.size());
  picture.names = std::move(names);
  picture.pixels.resize(samples);
  return "";
}

std::vector<std::string> color_names(int channels) {
  std::vector<std::string> names =
      channels < 3 ? std::vector<std::string>{"Y"} : std::vector<std::string>{"R", "G", "B"};
  if (channels % 2 == 0) names.emplace_back("A");
  return names;
}

void associate_alpha(Picture& picture) {
  const auto channels = static_cast<std::size_t>(picture.channels);
  for (std::size_t i = 0; i < picture.pixels.size(); i += channels)
    for (std::size_t c = 0; c + 1 < channels; ++c) picture.pixels[i + c] *= picture.pixels[i + channels - 1];
}

void mix_inks(Picture& picture) {
  float* to = picture.pixels.data();
  for (std::size_t i = 0; i < picture.pixels.size(); i += 4) {
    const float* inks = &picture.pixels[i];
    const float paper = 1 - inks[3];
    const float rgb[] = {(1 - inks[0]) * paper, (1 - inks[1]) * paper, (1 - inks[2]) * paper};
    for (const float value : rgb) *to++ = value;
  }
  picture.pixels.resize(picture.pixels.size() / 4 * 3);
  picture.channels = 3, picture.names = color_names(3);
}

}  // namespace goniochrome::image

extern "C" __attribute__((visibility("default"))) void goniochrome_decode_1(const char* bytes, unsigned long size,
                                                                            const char* format, int keep_inks,
                                                                            void* context, GoniochromeTake take,
                                                                            GoniochromeFail fail) {
  using namespace goniochrome::image;
  try {
    Picture picture;
    const std::string problem = decode({bytes, size}, format, keep_inks != 0, picture);
    if (!problem.empty()) return fail(context, problem.c_str());
    hand_over(picture, context, take);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    fail(context, e.what());
  }
}
