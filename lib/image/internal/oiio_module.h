// How the tools call goniochrome-oiio.so, which reads images through OpenImageIO. The interface is in C, so that the
// two may come from different compilers.
#pragma once

extern "C" {

// A decoded image: interleaved float pixels from the top, valid only during the call that hands it over.
struct GoniochromeOiioImage {
  int width, height, channels;
  const float* pixels;
  const char* const* channel_names;  // one for each channel
  const char* color_space;           // oiio:ColorSpace, or ""
  const char* interop_id;            // colorInteropID, or ""
  const char* envmap;                // "latlong", "cube" or ""
  const float* chromaticities;       // 8 values, or null
  const char* icc_profile;           // the bytes of an embedded ICC profile, or null
  unsigned long icc_size;
  int is_integer;  // whether the file holds whole numbers; they are 0..1 here
  int is_inks;     // whether the file holds CMYK, be the channels here these inks or the RGB made of them
};

// Decodes `path`, which holds `bytes` bytes of the format that OpenImageIO calls `format` whatever its name says, and
// calls take(context, image) once, or fail(context, reason) once. Where `keep_inks` is not 0, a CMYK
// JPEG or TIFF comes as four channels C, M, Y and K, of which 1 is full ink; else as the RGB that OpenImageIO makes of
// it.
using GoniochromeOiioTake = void (*)(void* context, const GoniochromeOiioImage* image);
using GoniochromeOiioFail = void (*)(void* context, const char* reason);
using GoniochromeOiioRead = void (*)(const char* path, const char* format, unsigned long bytes, int keep_inks,
                                     void* context, GoniochromeOiioTake take, GoniochromeOiioFail fail);

}  // extern "C"

namespace goniochrome::image {

// The name under which the module exports its GoniochromeOiioRead.
constexpr const char* kOiioReadName = "goniochrome_oiio_read_5";

}  // namespace goniochrome::image
