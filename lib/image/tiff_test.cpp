// TIFF files of many kinds, which libtiff writes here.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "base/scratch_for_test.h"
#include "image/color_space.h"
#include "image/image.h"

namespace goniochrome::image::tiff_test {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 37, kHeight = 21;  // no multiple of a byte or of a tile

// A slope of each channel, 0..1, in steps of 1/15, which every kind of whole number but a bit can hold.
double slope(int x, int y, int c) {
  return static_cast<double>((x + 2 * y + 5 * c) % 16) / 15;
}

struct Kind {
  const char* what;
  int bits, samples, format, photometric;
  bool planes_apart = false, tiled = false;
  int compression = COMPRESSION_NONE;
  int extra = -1;
};

// The samples of one row from x on, or those of one plane, packed from the highest bit on.
std::vector<unsigned char> packed(const Kind& kind, int y, int x, int width, int plane) {
  std::vector<unsigned char> bytes;
  unsigned pending = 0;
  int count = 0;
  const auto put = [&](auto value) {
    unsigned char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.insert(bytes.end(), raw, raw + sizeof value);
  };
  for (int i = x; i < x + width; ++i)
    for (int c = plane < 0 ? 0 : plane; c < (plane < 0 ? kind.samples : plane + 1); ++c) {
      const double value = slope(i, y, c);
      if (kind.format == SAMPLEFORMAT_IEEEFP && kind.bits == 64) put(value);
      if (kind.format == SAMPLEFORMAT_IEEEFP && kind.bits == 32) put(static_cast<float>(value));
      if (kind.format == SAMPLEFORMAT_INT && kind.bits == 16)
        put(static_cast<std::int16_t>(std::lround(value * 32767)));
      if (kind.format != SAMPLEFORMAT_UINT) continue;
      const auto code = static_cast<std::uint32_t>(std::llround(value * ((std::uint64_t{1} << kind.bits) - 1)));
      if (kind.bits == 32) put(code);
      if (kind.bits == 16) put(static_cast<std::uint16_t>(code));
      if (kind.bits > 12) continue;
      for (int bit = kind.bits - 1; bit >= 0; --bit) {
        pending = pending << 1 | (code >> bit & 1U);
        if (++count == 8) bytes.push_back(static_cast<unsigned char>(pending)), pending = 0, count = 0;
      }
    }
  if (count > 0) bytes.push_back(static_cast<unsigned char>(pending << (8 - count)));
  return bytes;
}

class TiffFile : public testing::Test {
 protected:
  std::string written(const Kind& kind, const std::function<void(TIFF*)>& more = {}) {
    const std::string path = folder_.path("x.tif");
    TIFF* tiff = TIFFOpen(path.c_str(), "w");
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, kWidth);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, kHeight);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind.bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, kind.samples);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, kind.format);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, kind.photometric);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, kind.compression);
    TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, kind.planes_apart ? PLANARCONFIG_SEPARATE : PLANARCONFIG_CONTIG);
    const auto extra = static_cast<std::uint16_t>(kind.extra);
    if (kind.extra >= 0) TIFFSetField(tiff, TIFFTAG_EXTRASAMPLES, 1, &extra);
    constexpr int kTile = 16, kRows = 8;
    if (kind.tiled)
      TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kTile), TIFFSetField(tiff, TIFFTAG_TILELENGTH, kTile);
    else
      TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, kRows);
    if (more) more(tiff);
    for (int plane = kind.planes_apart ? 0 : -1; plane < (kind.planes_apart ? kind.samples : 0); ++plane) {
      const auto number = static_cast<std::uint16_t>(plane < 0 ? 0 : plane);
      for (int y = 0; !kind.tiled && y < kHeight; ++y)
        TIFFWriteScanline(tiff, packed(kind, y, 0, kWidth, plane).data(), static_cast<std::uint32_t>(y), number);
      for (int y = 0; kind.tiled && y < kHeight; y += kTile)
        for (int x = 0; x < kWidth; x += kTile) {
          std::vector<unsigned char> tile;
          for (int row = y; row < y + kTile; ++row) {
            const auto bytes = packed(kind, row, x, kTile, plane);
            tile.insert(tile.end(), bytes.begin(), bytes.end());
          }
          TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, number);
        }
    }
    TIFFClose(tiff);
    return path;
  }
  ScratchFolder folder_;
};

TEST_F(TiffFile, EveryKindOfNumbersAndLayoutsIsReadAsItStands) {
  constexpr int kUint = SAMPLEFORMAT_UINT, kFloat = SAMPLEFORMAT_IEEEFP, kRgb = PHOTOMETRIC_RGB;
  for (const Kind& kind :
       {Kind{"4 bits", 4, 1, kUint, PHOTOMETRIC_MINISBLACK}, Kind{"8 bits", 8, 3, kUint, kRgb},
        Kind{"12 bits", 12, 3, kUint, kRgb}, Kind{"16 bits, LZW", 16, 3, kUint, kRgb, false, false, COMPRESSION_LZW},
        Kind{"signed", 16, 3, SAMPLEFORMAT_INT, kRgb}, Kind{"32 bits", 32, 1, kUint, PHOTOMETRIC_MINISBLACK},
        Kind{"float, tiles", 32, 3, kFloat, kRgb, false, true, COMPRESSION_ADOBE_DEFLATE},
        Kind{"double", 64, 3, kFloat, kRgb}, Kind{"planes", 8, 3, kUint, kRgb, true},
        Kind{"planes of tiles", 32, 3, kFloat, kRgb, true, true},
        Kind{"alpha", 8, 4, kUint, kRgb, false, false, COMPRESSION_NONE, EXTRASAMPLE_ASSOCALPHA}}) {
    const auto part = read_image(written(kind));
    ASSERT_TRUE(part.ok()) << kind.what << ": " << part.error().message;
    const Image& image = part->image;
    ASSERT_EQ(image.channels, kind.samples) << kind.what;
    ASSERT_EQ(image.width, kWidth);
    ASSERT_EQ(image.height, kHeight);
    EXPECT_EQ(attribute_or(part->attributes, "goniochrome:integer", 9), kind.format == kFloat ? 0 : 1) << kind.what;
    for (int y = 0; y < kHeight; ++y)
      for (int x = 0; x < kWidth; ++x)
        for (int c = 0; c < kind.samples; ++c)
          // Half a step of 16 signed bits, which hold no fifteenths.
          ASSERT_NEAR(image.pixel(x, y)[c], slope(x, y, c), 0.5 / 32767)
              << kind.what << " " << x << "," << y << "," << c;
  }
}

TEST_F(TiffFile, WhiteIsZeroWhereTheFileSaysSoAndABitIsBlackOrWhite) {
  for (const int photometric : {PHOTOMETRIC_MINISBLACK, PHOTOMETRIC_MINISWHITE}) {
    const auto part = read_image(written({"bits", 1, 1, SAMPLEFORMAT_UINT, photometric}));
    ASSERT_TRUE(part.ok()) << part.error().message;
    for (int x = 0; x < kWidth; ++x) {
      const bool set = std::lround(slope(x, 0, 0)) == 1;
      EXPECT_EQ(part->image.pixel(x, 0)[0], set == (photometric == PHOTOMETRIC_MINISBLACK) ? 1 : 0);
    }
  }
}

TEST_F(TiffFile, ColorOfAnAlphaThatIsNotAssociatedIsMultipliedByIt) {
  const auto part = read_image(written(
      {"alpha", 8, 4, SAMPLEFORMAT_UINT, PHOTOMETRIC_RGB, false, false, COMPRESSION_NONE, EXTRASAMPLE_UNASSALPHA}));
  ASSERT_TRUE(part.ok()) << part.error().message;
  EXPECT_EQ(part->image.channel_names, (std::vector<std::string>{"R", "G", "B", "A"}));
  for (int x = 0; x < kWidth; ++x)
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(part->image.pixel(x, 3)[c], slope(x, 3, c) * slope(x, 3, 3), 1e-6);
}

// A fourth channel of any kind was alpha, L*a*b* was off by 10 in b*, and a curve was that of sRGB.
TEST_F(TiffFile, WhatItsTagsSayOfColorsAndAlphaIsHeard) {
  const auto other = read_image(written(
      {"extra", 8, 4, SAMPLEFORMAT_UINT, PHOTOMETRIC_RGB, false, false, COMPRESSION_NONE, EXTRASAMPLE_UNSPECIFIED}));
  ASSERT_TRUE(other.ok()) << other.error().message;
  EXPECT_EQ(other->image.channel_names, (std::vector<std::string>{"R", "G", "B", "channel3"}));
  EXPECT_NEAR(other->image.pixel(1, 3)[0], slope(1, 3, 0), 1e-6);
  const auto lab = read_image(written({"Lab", 8, 3, SAMPLEFORMAT_UINT, PHOTOMETRIC_CIELAB}));
  ASSERT_FALSE(lab.ok());
  EXPECT_THAT(lab.error().message, HasSubstr("its pixels are L*a*b*: convert it to RGB with a profile"));
  const auto logarithms =
      read_image(written({"LogLuv", 32, 3, SAMPLEFORMAT_IEEEFP, PHOTOMETRIC_LOGLUV, false, false, COMPRESSION_SGILOG},
                         [](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_SGILOGDATAFMT, SGILOGDATAFMT_FLOAT); }));
  ASSERT_FALSE(logarithms.ok());
  EXPECT_THAT(logarithms.error().message, HasSubstr("its pixels are logarithms of light: convert it to EXR"));
  std::vector<std::uint16_t> curve(256);
  for (std::size_t i = 0; i < curve.size(); ++i) curve[i] = static_cast<std::uint16_t>(257 * i);
  const auto linear = read_image(written({"curve", 8, 3, SAMPLEFORMAT_UINT, PHOTOMETRIC_RGB}, [&](TIFF* tiff) {
    TIFFSetField(tiff, TIFFTAG_TRANSFERFUNCTION, curve.data(), curve.data(), curve.data());
  }));
  ASSERT_TRUE(linear.ok());
  EXPECT_THAT(working_space_rgb(*linear, "x.tif").error().message,
              HasSubstr("its color space is \"TransferFunction\", which is not known"));
}

TEST_F(TiffFile, InksAreKeptOrMixed) {
  const Kind kind{"inks", 8, 4, SAMPLEFORMAT_UINT, PHOTOMETRIC_SEPARATED};
  const auto inks = read_image(written(kind), Inks::kKept), rgb = read_image(written(kind));
  ASSERT_TRUE(inks.ok() && rgb.ok());
  EXPECT_EQ(inks->image.channel_names, (std::vector<std::string>{"C", "M", "Y", "K"}));
  EXPECT_EQ(rgb->image.channel_names, (std::vector<std::string>{"R", "G", "B"}));
  EXPECT_TRUE(rgb->attributes.contains("goniochrome:inks"));
  for (int x = 0; x < kWidth; ++x)
    for (int c = 0; c < 3; ++c) {
      EXPECT_NEAR(inks->image.pixel(x, 2)[c], slope(x, 2, c), 1e-6);
      EXPECT_NEAR(rgb->image.pixel(x, 2)[c], (1 - slope(x, 2, c)) * (1 - slope(x, 2, 3)), 1e-6);
    }
}

TEST_F(TiffFile, APaletteBecomesItsColors) {
  std::uint16_t red[16], green[16], blue[16];
  for (int i = 0; i < 16; ++i) red[i] = static_cast<std::uint16_t>(257 * i), green[i] = 65535, blue[i] = 0;
  const auto part = read_image(written({"palette", 4, 1, SAMPLEFORMAT_UINT, PHOTOMETRIC_PALETTE},
                                       [&](TIFF* tiff) { TIFFSetField(tiff, TIFFTAG_COLORMAP, red, green, blue); }));
  ASSERT_TRUE(part.ok()) << part.error().message;
  ASSERT_EQ(part->image.channels, 3);
  for (int x = 0; x < kWidth; ++x) {
    EXPECT_NEAR(part->image.pixel(x, 0)[0], 15 * slope(x, 0, 0) / 255, 1e-6);
    EXPECT_EQ(part->image.pixel(x, 0)[1], 1);
    EXPECT_EQ(part->image.pixel(x, 0)[2], 0);
  }
}

TEST_F(TiffFile, ItsProfileAndItsLayoutOfLightAreToldApart) {
  const std::string profile(200, 'p');
  const auto part = read_image(written({"8 bits", 8, 3, SAMPLEFORMAT_UINT, PHOTOMETRIC_RGB}, [&](TIFF* tiff) {
    TIFFSetField(tiff, TIFFTAG_ICCPROFILE, static_cast<std::uint32_t>(profile.size()), profile.data());
    TIFFSetField(tiff, TIFFTAG_PIXAR_TEXTUREFORMAT, "LatLong Environment");
  }));
  ASSERT_TRUE(part.ok()) << part.error().message;
  EXPECT_EQ(text_attribute(*part, "ICCProfile"), profile);
  EXPECT_EQ(text_attribute(*part, "envmap"), "latlong");
  EXPECT_EQ(text_attribute(*part, "oiio:ColorSpace"), "");
}

TEST_F(TiffFile, ACutFileIsAnError) {
  written({"8 bits", 8, 3, SAMPLEFORMAT_UINT, PHOTOMETRIC_RGB}, [](TIFF* tiff) { TIFFWriteCheck(tiff, 0, "x"); });
  const std::string whole = folder_.content("x.tif");
  for (const std::size_t size : {whole.size() / 2, std::size_t{8}, std::size_t{9}}) {
    const auto part = read_image(folder_.file("cut.tif", whole.substr(0, size)));
    ASSERT_FALSE(part.ok()) << size;
    EXPECT_THAT(part.error().message, HasSubstr("cut.tif: cannot be read as an image: "));
  }
}

}  // namespace
}  // namespace goniochrome::image::tiff_test
