#include <Imath/half.h>
#include <tiffio.h>

#include <algorithm>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include "image/codecs/decoders.h"
#include "image/internal/turn.h"

namespace goniochrome::image {

namespace {

// The last words of libtiff, which has one handler for all files.
std::string last_words;

void take_words(const char*, const char* format, std::va_list values) {
  char text[512];
  std::vsnprintf(text, sizeof text, format, values);
  last_words = text;
}

// A file in memory, as libtiff reads it.
struct Source {
  std::string_view file;
  std::uint64_t at = 0;
};

tmsize_t read_some(thandle_t handle, void* to, tmsize_t size) {
  auto& source = *static_cast<Source*>(handle);
  if (source.at >= source.file.size()) return 0;
  const std::size_t count = std::min(static_cast<std::size_t>(size), source.file.size() - source.at);
  std::memcpy(to, source.file.data() + source.at, count);
  source.at += count;
  return static_cast<tmsize_t>(count);
}
tmsize_t write_none(thandle_t, void*, tmsize_t) {
  return 0;
}
toff_t seek(thandle_t handle, toff_t offset, int whence) {
  auto& source = *static_cast<Source*>(handle);
  const std::uint64_t from = whence == SEEK_CUR ? source.at : whence == SEEK_END ? source.file.size() : 0;
  return source.at = from + offset;
}
int close_none(thandle_t) {
  return 0;
}
toff_t size_of(thandle_t handle) {
  return static_cast<Source*>(handle)->file.size();
}

using Tiff = std::unique_ptr<TIFF, void (*)(TIFF*)>;

struct Layout {
  std::uint32_t width = 0, height = 0, depth = 1;
  std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, photometric = PHOTOMETRIC_MINISBLACK,
                planes = PLANARCONFIG_CONTIG, compression = COMPRESSION_NONE, extra = 0, ink_set = INKSET_CMYK,
                orientation = ORIENTATION_TOPLEFT;
  std::uint16_t extra_kind = EXTRASAMPLE_UNSPECIFIED;  // of the first extra sample
  std::size_t colors() const { return samples > extra ? static_cast<std::size_t>(samples - extra) : 0; }
  bool apart() const { return planes == PLANARCONFIG_SEPARATE; }
};

Layout layout_of(TIFF* tiff) {
  Layout layout;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &layout.width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &layout.height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_IMAGEDEPTH, &layout.depth);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &layout.bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &layout.samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &layout.format);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &layout.planes);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_COMPRESSION, &layout.compression);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_INKSET, &layout.ink_set);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_ORIENTATION, &layout.orientation);
  if (!TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &layout.photometric))
    layout.photometric = layout.samples < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB;
  std::uint16_t* kinds = nullptr;
  if (TIFFGetFieldDefaulted(tiff, TIFFTAG_EXTRASAMPLES, &layout.extra, &kinds) && layout.extra > 0 && kinds)
    layout.extra_kind = kinds[0];
  if (layout.format == SAMPLEFORMAT_VOID) layout.format = SAMPLEFORMAT_UINT;
  // Compressed luma and chroma come as RGB from the library of the compression.
  if (layout.photometric == PHOTOMETRIC_YCBCR && layout.compression == COMPRESSION_JPEG &&
      TIFFSetField(tiff, TIFFTAG_JPEGCOLORMODE, JPEGCOLORMODE_RGB))
    layout.photometric = PHOTOMETRIC_RGB;
  return layout;
}

// True where the samples are color or inks as they stand. libtiff itself makes 8-bit RGBA of palettes and others.
bool is_plain(const Layout& layout) {
  switch (layout.photometric) {
    case PHOTOMETRIC_MINISBLACK:
    case PHOTOMETRIC_MINISWHITE:
      if (layout.colors() != 1 && layout.extra > 0) return false;
      break;
    case PHOTOMETRIC_RGB:
      if (layout.colors() != 3 && layout.extra > 0) return false;
      break;
    case PHOTOMETRIC_SEPARATED:
      if (layout.samples < 4 || layout.ink_set != INKSET_CMYK) return false;
      break;
    default:
      return false;
  }
  if (layout.format == SAMPLEFORMAT_IEEEFP) return layout.bits == 16 || layout.bits == 32 || layout.bits == 64;
  if (layout.format == SAMPLEFORMAT_INT) return layout.bits == 8 || layout.bits == 16 || layout.bits == 32;
  return layout.format == SAMPLEFORMAT_UINT && ((layout.bits >= 1 && layout.bits <= 16) || layout.bits == 32);
}

template <class T>
T value_at(const unsigned char* bytes, std::size_t index) {
  T value;
  std::memcpy(&value, bytes + index * sizeof(T), sizeof(T));
  return value;
}

template <class T>
float share(T value) {
  return static_cast<float>(std::max(static_cast<double>(value) / std::numeric_limits<T>::max(), -1.0));
}

// Sample `index` of a row: whole numbers become 0..1.
float sample(const Layout& layout, const unsigned char* row, std::size_t index) {
  if (layout.format == SAMPLEFORMAT_IEEEFP) {
    if (layout.bits == 64) return static_cast<float>(value_at<double>(row, index));
    if (layout.bits == 32) return value_at<float>(row, index);
    half value;
    value.setBits(value_at<std::uint16_t>(row, index));
    return value;
  }
  const bool is_signed = layout.format == SAMPLEFORMAT_INT;
  if (layout.bits == 8) return is_signed ? share(value_at<std::int8_t>(row, index)) : share(row[index]);
  if (layout.bits == 16)
    return is_signed ? share(value_at<std::int16_t>(row, index)) : share(value_at<std::uint16_t>(row, index));
  if (layout.bits == 32)
    return is_signed ? share(value_at<std::int32_t>(row, index)) : share(value_at<std::uint32_t>(row, index));
  std::uint32_t value = 0;
  for (std::size_t bit = index * layout.bits, end = bit + layout.bits; bit < end; ++bit)
    value = value << 1 | (row[bit / 8] >> (7 - bit % 8) & 1U);
  return static_cast<float>(value) / static_cast<float>((1U << layout.bits) - 1);
}

// A rectangle of decoded rows: all samples of its pixels, or those of one plane.
struct Block {
  std::size_t x, y, width, height, row_bytes;
  std::uint16_t plane;
};

void put_block(const Layout& layout, const Block& block, const unsigned char* bytes, Picture& picture) {
  const auto channels = static_cast<std::size_t>(picture.channels);
  const std::size_t stored = layout.apart() ? 1 : layout.samples;
  if (block.plane >= channels) return;
  const std::size_t width = std::min<std::size_t>(block.width, layout.width - block.x);
  const std::size_t height = std::min<std::size_t>(block.height, layout.height - block.y);
  for (std::size_t y = 0; y < height; ++y) {
    const unsigned char* row = bytes + y * block.row_bytes;
    float* to = &picture.pixels[((block.y + y) * layout.width + block.x) * channels];
    for (std::size_t x = 0; x < width; ++x, to += channels)
      if (layout.apart())
        to[block.plane] = sample(layout, row, x);
      else
        for (std::size_t c = 0; c < channels; ++c) to[c] = sample(layout, row, x * stored + c);
  }
}

// Rows of a strip are as wide as the picture; those of a tile are padded to its width.
std::string read_blocks(TIFF* tiff, const Layout& layout, Picture& picture) {
  const bool tiled = TIFFIsTiled(tiff) != 0;
  std::uint32_t wide = layout.width, tall = layout.height;
  if (tiled)
    TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &wide), TIFFGetField(tiff, TIFFTAG_TILELENGTH, &tall);
  else
    TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &tall);
  tall = std::min(tall, tiled ? tall : layout.height);
  const tmsize_t size = tiled ? TIFFTileSize(tiff) : TIFFStripSize(tiff);
  const tmsize_t row_bytes = tiled ? TIFFTileRowSize(tiff) : TIFFScanlineSize(tiff);
  const std::size_t samples = std::size_t{wide} * (layout.apart() ? 1U : layout.samples);
  if (wide == 0 || tall == 0 || size <= 0 || static_cast<std::size_t>(row_bytes) < (samples * layout.bits + 7) / 8)
    return "its strips or tiles have no size that makes sense";
  const std::unique_ptr<unsigned char, void (*)(void*)> bytes(static_cast<unsigned char*>(_TIFFmalloc(size)),
                                                              _TIFFfree);
  if (!bytes) throw std::bad_alloc();
  const std::uint16_t planes = layout.apart() ? layout.samples : 1;
  for (std::uint16_t plane = 0; plane < planes; ++plane)
    for (std::uint32_t y = 0; y < layout.height; y += tall)
      for (std::uint32_t x = 0; x < layout.width; x += wide) {
        const std::uint32_t rows = tiled ? tall : std::min(tall, layout.height - y);
        const tmsize_t wanted = row_bytes * static_cast<tmsize_t>(rows);
        if (wanted > size) return "its strips or tiles have no size that makes sense";
        const tmsize_t got = tiled ? TIFFReadEncodedTile(tiff, TIFFComputeTile(tiff, x, y, 0, plane), bytes.get(), size)
                                   : TIFFReadEncodedStrip(tiff, TIFFComputeStrip(tiff, y, plane), bytes.get(), wanted);
        if (got < wanted) return last_words.empty() ? "it is cut short" : last_words;
        put_block(layout, {x, y, wide, rows, static_cast<std::size_t>(row_bytes), plane}, bytes.get(), picture);
        if (y > std::numeric_limits<std::uint32_t>::max() - tall) return "";
      }
  return "";
}

std::vector<std::string> names_of(const Layout& layout) {
  if (layout.photometric == PHOTOMETRIC_SEPARATED) return {"C", "M", "Y", "K"};
  const int colors = layout.photometric == PHOTOMETRIC_RGB && layout.samples >= 3 ? 3 : 1;
  std::vector<std::string> names = color_names(colors);
  const bool has_alpha = layout.extra_kind == EXTRASAMPLE_ASSOCALPHA || layout.extra_kind == EXTRASAMPLE_UNASSALPHA;
  for (int c = colors; c < layout.samples; ++c)
    names.push_back(c == colors && has_alpha ? "A" : "channel" + std::to_string(c));
  return names;
}

std::string read_plain(TIFF* tiff, const Layout& layout, std::size_t bytes, bool keep_inks, Picture& picture) {
  picture.is_integer = layout.format != SAMPLEFORMAT_IEEEFP;
  picture.is_inks = layout.photometric == PHOTOMETRIC_SEPARATED;
  if (std::string problem = set_size(picture, layout.width, layout.height, names_of(layout), bytes); !problem.empty())
    return problem;
  if (std::string problem = read_blocks(tiff, layout, picture); !problem.empty()) return problem;
  if (layout.photometric == PHOTOMETRIC_MINISWHITE)
    for (std::size_t i = 0; i < picture.pixels.size(); i += static_cast<std::size_t>(picture.channels))
      picture.pixels[i] = 1 - picture.pixels[i];
  const bool alpha_is_last = picture.channels == layout.samples && layout.extra == 1;
  if (!picture.is_inks && alpha_is_last && layout.extra_kind == EXTRASAMPLE_UNASSALPHA) associate_alpha(picture);
  if (picture.is_inks && !keep_inks) mix_inks(picture);
  return "";
}

// The reason why libtiff's own way to RGB would change the colors; "" where it does not. It takes L*a*b* under D50 for
// that of a display under D65, and cuts the logarithms of light to those of a display.
std::string changed_colors(const Layout& layout) {
  switch (layout.photometric) {
    case PHOTOMETRIC_CIELAB:
    case PHOTOMETRIC_ICCLAB:
    case PHOTOMETRIC_ITULAB:
      return "its pixels are L*a*b*: convert it to RGB with a profile";
    case PHOTOMETRIC_LOGL:
    case PHOTOMETRIC_LOGLUV:
      return "its pixels are logarithms of light: convert it to EXR";
    default:
      return "";
  }
}

std::string read_as_rgba(TIFF* tiff, const Layout& layout, std::size_t bytes, Picture& picture) {
  if (std::string changed = changed_colors(layout); !changed.empty()) return changed;
  char reason[1024] = "";
  if (!TIFFRGBAImageOK(tiff, reason)) return *reason ? reason : "its samples are of a kind that is not read";
  const int channels = layout.extra > 0 ? 4 : 3;
  if (std::string problem = set_size(picture, layout.width, layout.height, color_names(channels), bytes);
      !problem.empty())
    return problem;
  std::vector<std::uint32_t> raster(std::size_t{layout.width} * layout.height);
  // Rows stay as they are stored: decode_tiff() turns them.
  if (!TIFFReadRGBAImageOriented(tiff, layout.width, layout.height, raster.data(), layout.orientation, 1))
    return last_words;
  float* to = picture.pixels.data();
  for (const std::uint32_t pixel : raster)
    for (int c = 0; c < channels; ++c) *to++ = static_cast<float>(pixel >> 8 * c & 0xFF) / 255.0F;
  return "";
}

void keep_words(TIFF* tiff, Picture& picture) {
  std::uint32_t size = 0;
  const void* profile = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_ICCPROFILE, &size, &profile) && profile)
    picture.icc_profile.assign(static_cast<const char*>(profile), size);
  // A table of the curve of each channel, which is not read; the color space of that name is not known.
  const std::uint16_t* curves[3] = {};
  if (picture.icc_profile.empty() && TIFFGetField(tiff, TIFFTAG_TRANSFERFUNCTION, &curves[0], &curves[1], &curves[2]) &&
      curves[0])
    picture.color_space = "TransferFunction";
  const char* texture = nullptr;
  if (TIFFGetField(tiff, TIFFTAG_PIXAR_TEXTUREFORMAT, &texture) && texture) {
    if (std::strcmp(texture, "LatLong Environment") == 0) picture.envmap = "latlong";
    if (std::strcmp(texture, "CubeFace Environment") == 0) picture.envmap = "cube";
  }
  // This moves on to another folder of the file, so it comes last.
  toff_t exif = 0;
  std::uint16_t space = 0;
  if (TIFFGetField(tiff, TIFFTAG_EXIFIFD, &exif) && TIFFReadEXIFDirectory(tiff, exif) &&
      TIFFGetField(tiff, EXIFTAG_COLORSPACE, &space) && space == 1 && picture.color_space.empty())
    picture.color_space = "sRGB";
}

}  // namespace

std::string decode_tiff(std::string_view file, bool keep_inks, Picture& picture) {
  TIFFSetErrorHandler(take_words);
  TIFFSetWarningHandler(nullptr);
  last_words.clear();
  Source source{file};
  const Tiff tiff(
      TIFFClientOpen("image", "rm", &source, read_some, write_none, seek, close_none, size_of, nullptr, nullptr),
      TIFFClose);
  if (!tiff) return last_words;
  const Layout layout = layout_of(tiff.get());
  if (layout.depth > 1) return "volumes are not read";
  if (layout.samples == 0 || layout.samples > 1024) return "its header says no number of channels that makes sense";
  std::string problem = is_plain(layout) ? read_plain(tiff.get(), layout, file.size(), keep_inks, picture)
                                         : read_as_rgba(tiff.get(), layout, file.size(), picture);
  if (const Turn turn = exif_turn(layout.orientation); problem.empty() && turn.any())
    picture.pixels = upright(picture.pixels, picture.width, picture.height, picture.channels, turn);
  if (problem.empty()) keep_words(tiff.get(), picture);
  return problem;
}

}  // namespace goniochrome::image
