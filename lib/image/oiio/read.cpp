// goniochrome-oiio.so: reads pictures through OpenImageIO, in the format that the caller found them to be of.
#include <OpenImageIO/imageio.h>

#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "image/internal/exr.h"
#include "image/internal/oiio_module.h"
#include "image/internal/turn.h"
#include "image/oiio/cmyk_jpeg.h"

namespace {

std::string text_attribute(const OIIO::ImageSpec& spec, const char* name) {
  return std::string(spec.get_string_attribute(name));
}

struct Source {
  const char* path;
  const char* format;
  unsigned long bytes;
  bool keep_inks;
};

// The most samples that a byte of any of the formats stands for, and a number of them that no file is too short for.
// Deflate makes 1032 bytes of one, and a JPEG has one bit at least for 64 samples of one channel. What packs better
// than that is one color all over, or a forged header.
constexpr OIIO::imagesize_t kSamplesAByte = 1100, kFreeSamples = 1 << 22;

std::string envmap_kind(const OIIO::ImageSpec& spec) {
  const std::string kind = text_attribute(spec, "textureformat");
  if (kind == "LatLong Environment") return "latlong";
  if (kind == "CubeFace Environment") return "cube";
  return "";
}

bool is_cmyk_tiff(const OIIO::ImageSpec& spec) {
  return text_attribute(spec, "tiff:ColorSpace") == "CMYK";
}

// Opens the image; inks of a TIFF stay inks where they are to be kept. The inks of a JPEG are lost in any case.
std::unique_ptr<OIIO::ImageInput> open(const Source& source, std::string& problem) {
  const auto opened = [&](bool raw) -> std::unique_ptr<OIIO::ImageInput> {
    auto input = OIIO::ImageInput::create(source.format);
    OIIO::ImageSpec spec, wishes;
    if (raw) wishes.attribute("oiio:RawColor", 1);
    if (input && input->open(source.path, spec, wishes)) return input;
    problem = input ? input->geterror() : OIIO::geterror();
    return nullptr;
  };
  auto input = opened(false);
  if (!input || !source.keep_inks || !is_cmyk_tiff(input->spec())) return input;
  return opened(true);
}

bool is_cmyk_jpeg(const OIIO::ImageSpec& spec) {
  const std::string space = text_attribute(spec, "jpeg:ColorSpace");
  return space == "CMYK" || space == "YCbCrK";
}

void read(const Source& source, void* context, GoniochromeOiioTake take, GoniochromeOiioFail fail) {
  OIIO::attribute("threads", 1);  // the caller's process has to stay small, and is there for one picture
  std::string problem;
  auto input = open(source, problem);
  if (!input) return fail(context, problem.c_str());
  OIIO::ImageSpec spec = input->spec();
  const bool from_jpeg = source.keep_inks && is_cmyk_jpeg(spec);
  const bool is_inks = is_cmyk_tiff(spec) || is_cmyk_jpeg(spec);
  if (from_jpeg) spec.nchannels = 4, spec.channelnames = {"C", "M", "Y", "K"};
  if (spec.depth > 1 || spec.deep) return fail(context, "volumes and deep images are not read");
  const OIIO::imagesize_t samples = spec.image_pixels() * static_cast<OIIO::imagesize_t>(spec.nchannels);
  if (spec.image_pixels() > goniochrome::image::kMostSamples || samples > goniochrome::image::kMostSamples)
    return fail(context, "its header says more pixels than fit into 8 GB: is it damaged?");
  if (samples > kFreeSamples && samples / kSamplesAByte > source.bytes)
    return fail(context, "its header says more pixels than a file of its size can hold: is it damaged?");
  std::vector<float> pixels(samples);
  if (from_jpeg) {
    problem = goniochrome::image::read_cmyk_jpeg(source.path, spec.width, spec.height, pixels);
    if (!problem.empty()) return fail(context, problem.c_str());
  } else if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data())) {
    return fail(context, input->geterror().c_str());
  }

  if (const auto turn = goniochrome::image::exif_turn(spec.get_int_attribute("Orientation", 1)); turn.any())
    pixels = goniochrome::image::upright(pixels, spec.width, spec.height, spec.nchannels, turn);

  std::vector<const char*> names;
  for (const std::string& name : spec.channelnames) names.push_back(name.c_str());
  const std::string color_space = text_attribute(spec, "oiio:ColorSpace");
  const std::string interop_id = text_attribute(spec, "colorInteropID");
  const std::string envmap = envmap_kind(spec);
  const OIIO::ParamValue* chromaticities =
      spec.find_attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8));
  const OIIO::ParamValue* icc = spec.find_attribute("ICCProfile");
  const GoniochromeOiioImage image = {spec.width,
                                      spec.height,
                                      spec.nchannels,
                                      pixels.data(),
                                      names.data(),
                                      color_space.c_str(),
                                      interop_id.c_str(),
                                      envmap.c_str(),
                                      chromaticities ? static_cast<const float*>(chromaticities->data()) : nullptr,
                                      icc ? static_cast<const char*>(icc->data()) : nullptr,
                                      icc ? static_cast<unsigned long>(icc->datasize()) : 0,
                                      spec.format.is_floating_point() ? 0 : 1,
                                      is_inks ? 1 : 0};
  take(context, &image);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void goniochrome_oiio_read_5(const char* path, const char* format,
                                                                               unsigned long bytes, int keep_inks,
                                                                               void* context, GoniochromeOiioTake take,
                                                                               GoniochromeOiioFail fail) {
  try {
    read({path, format, bytes, keep_inks != 0}, context, take, fail);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::system_error& e) {
    // A thread that cannot be started lacks the memory for its stack.
    if (e.code() == std::errc::resource_unavailable_try_again) throw std::bad_alloc();
    fail(context, e.what());
  } catch (const std::exception& e) {
    fail(context, e.what());
  }
}
