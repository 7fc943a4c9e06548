// The interface of goniochrome-codecs.so, which decodes PNG, JPEG and TIFF by the libraries of these formats. The
// interface is in C, so that the two may come from different compilers.
#pragma once

extern "C" {

// A decoded image: interleaved float pixels from the top, valid only during the call that hands it over.
struct GoniochromeDecoded {
  int width, height, channels;
  const float* pixels;
  const char* const* channel_names;  // one for each channel
  const char* color_space;           // "sRGB", "linear", "Gamma" and a number, or ""
  const char* interop_id;            // colorInteropID, or ""
  const char* envmap;                // "latlong", "cube" or ""
  const char* icc_profile;           // the bytes of an embedded ICC profile, or null
  unsigned long icc_size;
  int is_integer;  // whether the file holds whole numbers; they are 0..1 here
  int is_inks;     // whether the file holds CMYK, be the channels here these inks or the RGB made of them
};

// Decodes the `size` bytes of a file of the format "png", "jpeg" or "tiff", and calls take(context, image) once, or
// fail(context, reason) once. Where `keep_inks` is not 0, a CMYK JPEG or TIFF comes as four channels C, M, Y and K, of
// which 1 is full ink; else as RGB, where each ink takes all light of its channel.
using GoniochromeTake = void (*)(void* context, const GoniochromeDecoded* image);
using GoniochromeFail = void (*)(void* context, const char* reason);
using GoniochromeDecode = void (*)(const char* bytes, unsigned long size, const char* format, int keep_inks,
                                   void* context, GoniochromeTake take, GoniochromeFail fail);

}  // extern "C"

namespace goniochrome::image {

// The name under which the module exports its GoniochromeDecode.
constexpr const char* kDecodeName = "goniochrome_decode_1";

}  // namespace goniochrome::image
