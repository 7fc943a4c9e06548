// goniochrome-oiio.so: reads any format that OpenImageIO knows.
#include <OpenImageIO/imageio.h>

#include <exception>
#include <string>
#include <vector>

#include "image/internal/exr.h"
#include "image/internal/oiio_module.h"
#include "image/oiio/cmyk_jpeg.h"

namespace {

std::string text_attribute(const OIIO::ImageSpec& spec, const char* name) {
  return std::string(spec.get_string_attribute(name));
}

std::string envmap_kind(const OIIO::ImageSpec& spec) {
  const std::string kind = text_attribute(spec, "textureformat");
  if (kind == "LatLong Environment") return "latlong";
  if (kind == "CubeFace Environment") return "cube";
  return "";
}

// Opens the image; inks of a TIFF stay inks where they are to be kept. The inks of a JPEG are lost in any case.
std::unique_ptr<OIIO::ImageInput> open(const char* path, bool keep_inks) {
  auto input = OIIO::ImageInput::open(path);
  if (!input || !keep_inks || text_attribute(input->spec(), "tiff:ColorSpace") != "CMYK") return input;
  OIIO::ImageSpec raw;
  raw.attribute("oiio:RawColor", 1);
  return OIIO::ImageInput::open(path, &raw);
}

bool is_cmyk_jpeg(const OIIO::ImageSpec& spec) {
  const std::string space = text_attribute(spec, "jpeg:ColorSpace");
  return space == "CMYK" || space == "YCbCrK";
}

void read(const char* path, bool keep_inks, void* context, GoniochromeOiioTake take, GoniochromeOiioFail fail) {
  auto input = open(path, keep_inks);
  if (!input) return fail(context, OIIO::geterror().c_str());
  OIIO::ImageSpec spec = input->spec();
  const bool from_jpeg = keep_inks && is_cmyk_jpeg(spec);
  if (from_jpeg) spec.nchannels = 4, spec.channelnames = {"C", "M", "Y", "K"};
  if (spec.depth > 1 || spec.deep) return fail(context, "volumes and deep images are not read");
  const OIIO::imagesize_t samples = spec.image_pixels() * static_cast<OIIO::imagesize_t>(spec.nchannels);
  if (spec.image_pixels() > goniochrome::image::kMostSamples || samples > goniochrome::image::kMostSamples)
    return fail(context, "its header says more pixels than fit into 8 GB: is it damaged?");
  std::vector<float> pixels(samples);
  if (from_jpeg) {
    const std::string problem = goniochrome::image::read_cmyk_jpeg(path, spec.width, spec.height, pixels);
    if (!problem.empty()) return fail(context, problem.c_str());
  } else if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.data())) {
    return fail(context, input->geterror().c_str());
  }

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
                                      spec.format.is_floating_point() ? 0 : 1};
  take(context, &image);
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void goniochrome_oiio_read_3(const char* path, int keep_inks,
                                                                               void* context, GoniochromeOiioTake take,
                                                                               GoniochromeOiioFail fail) {
  try {
    read(path, keep_inks != 0, context, take, fail);
  } catch (const std::exception& e) {
    fail(context, e.what());
  }
}
