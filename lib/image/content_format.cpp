#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <optional>

#include "image/internal/content_format.h"

// OpenImageIO 2.4 reads some thirty formats, and tries all of them on a file that the one of its name's ending refuses.
// Of 40 damaged IFF files 12 corrupted the memory of the program, also when they were called x.png. So the format is
// found here, and OpenImageIO is told to read that one alone.

namespace goniochrome::image {

namespace {

struct Signature {
  std::size_t offset;
  std::string_view bytes;
  const char* format;
};

using std::string_view_literals::operator""sv;

constexpr std::array kWanted = {
    Signature{0, "\x76\x2f\x31\x01"sv, "openexr"},
    Signature{0, "#?"sv, "hdr"},
    Signature{0, "\x89PNG\r\n\x1a\n"sv, "png"},
    Signature{0, "\xff\xd8\xff"sv, "jpeg"},
    Signature{0, "II\x2a\0"sv, "tiff"},
    Signature{0, "MM\0\x2a"sv, "tiff"},
    Signature{0, "II\x2b\0"sv, "tiff"},
    Signature{0, "MM\0\x2b"sv, "tiff"},
    Signature{0, "SDPX"sv, "dpx"},
    Signature{0, "XPDS"sv, "dpx"},
    Signature{8, "WEBPVP8"sv, "webp"},
    Signature{0, "BM"sv, "bmp"},
};

// Kinds of files that people also have, to name them in errors.
constexpr std::array kUnwanted = {
    Signature{0, "FOR4"sv, "an IFF picture"},
    Signature{0, "FORM"sv, "an IFF picture"},
    Signature{0, "GIF8"sv, "a GIF picture"},
    Signature{0, "8BPS"sv, "a Photoshop document"},
    Signature{0, "\0\0\0\x0cjP  "sv, "a JPEG 2000 picture"},
    Signature{0, "\xff\x4f\xff\x51"sv, "a JPEG 2000 picture"},
    Signature{4, "ftyp"sv, "a HEIF, AVIF or film file"},
    Signature{0, "SIMPLE  ="sv, "a FITS picture"},
    Signature{0, "\0\0\x01\0"sv, "an icon"},
    Signature{0, "DDS "sv, "a DDS texture"},
    Signature{0, "\x80\x2a\x5f\xd7"sv, "a Cineon picture"},
    Signature{0, "\xd7\x5f\x2a\x80"sv, "a Cineon picture"},
    Signature{0, "\x01\xda"sv, "an SGI picture"},
    Signature{128, "DICM"sv, "a DICOM picture"},
    Signature{0, "%PDF"sv, "a PDF document"},
    Signature{0, "<svg"sv, "an SVG drawing"},
    Signature{0, "<?xml"sv, "an XML document"},
    Signature{0, "FUJIFILM"sv, "a camera's raw file"},
    Signature{0, "IIRO"sv, "a camera's raw file"},
    Signature{0, "IIU\0"sv, "a camera's raw file"},
};

bool shows(std::string_view content, const Signature& signature) {
  return content.size() >= signature.offset && content.substr(signature.offset).starts_with(signature.bytes);
}

// A Radiance picture need not begin with "#?": a line of its header tells what it is.
bool is_radiance_header(std::string_view content) {
  constexpr std::size_t kMostHeader = 1 << 16;
  content = content.substr(0, kMostHeader);
  content = content.substr(0, content.find("\n\n"));
  return content.starts_with("FORMAT=32-bit_rle_") || content.find("\nFORMAT=32-bit_rle_") != std::string_view::npos;
}

bool is_pnm(std::string_view content) {
  return content.size() > 2 && content[0] == 'P' && std::strchr("123456fF", content[1]) && content[1] != '\0' &&
         std::strchr(" \t\r\n#", content[2]) && content[2] != '\0';
}

// TGA files have no signature, so their header is checked: a color map where the type wants one, a type and a depth
// that exist, and a size. No text passes, because its bytes are larger than a type.
bool is_targa(std::string_view content) {
  if (content.size() < 18) return false;
  const auto byte = [&](std::size_t at) { return static_cast<unsigned char>(content[at]); };
  const int type = byte(2) & ~8, depth = byte(16);  // bit 3 tells that the pixels come in runs
  if ((byte(2) & ~11) != 0 || type < 1 || byte(1) > 1 || (type == 1) != (byte(1) == 1)) return false;
  if (type != 1 && (byte(5) != 0 || byte(6) != 0)) return false;
  if (depth != 8 && depth != 15 && depth != 16 && depth != 24 && depth != 32) return false;
  return (byte(12) | byte(13)) != 0 && (byte(14) | byte(15)) != 0;
}

// The numbers of a TIFF file, in its own byte order; 0 beyond its end.
class TiffNumbers {
 public:
  explicit TiffNumbers(std::string_view content) : content_(content), little_(content[0] == 'I') {}
  std::uint32_t at(std::size_t offset, int bytes) const {
    if (offset > content_.size() || content_.size() - offset < static_cast<std::size_t>(bytes)) return 0;
    std::uint32_t value = 0;
    for (int i = 0; i < bytes; ++i) {
      const auto byte = static_cast<unsigned char>(content_[offset + static_cast<std::size_t>(i)]);
      value |= std::uint32_t{byte} << 8 * (little_ ? i : bytes - 1 - i);
    }
    return value;
  }

 private:
  std::string_view content_;
  bool little_;
};

// True if the first picture of a TIFF file is a thumbnail, as in the raw files of most cameras: NewSubfileType (254)
// says "reduced", there is a DNGVersion (50706), or Canon's mark stands behind the header. A BigTIFF has none of these.
bool is_camera_raw(std::string_view content) {
  if (shows(content, {8, "CR"sv, ""})) return true;
  const TiffNumbers number(content);
  if (number.at(2, 2) != 42) return false;
  const std::size_t directory = number.at(4, 4);
  const std::uint32_t entries = number.at(directory, 2);
  for (std::uint32_t i = 0; i < entries; ++i) {
    const std::size_t entry = directory + 2 + 12 * std::size_t{i};
    if (entry + 12 > content.size()) return false;
    const std::uint32_t tag = number.at(entry, 2);
    if (tag == 50706 || (tag == 254 && (number.at(entry + 8, 4) & 1) != 0)) return true;
  }
  return false;
}

constexpr const char* kAdvice = "convert it to EXR, or to a TIFF or PNG of 16 bits";

bool is_tiff_header(std::string_view header) {
  return header.starts_with("II\x2a") || header.starts_with("MM");
}

// Where the value of a tag stands in a directory of a TIFF header, or its place where it takes more than 4 bytes.
std::optional<std::size_t> tiff_entry(std::string_view header, std::size_t directory, std::uint32_t tag) {
  const TiffNumbers number(header);
  for (std::uint32_t i = 0; directory != 0 && i < number.at(directory, 2); ++i) {
    const std::size_t entry = directory + 2 + 12 * std::size_t{i};
    if (entry + 12 > header.size()) return std::nullopt;
    if (number.at(entry, 2) == tag) return entry + 8;
  }
  return std::nullopt;
}

// The EXIF tag Orientation in the first directory of a TIFF header; 1 where there is none.
int tiff_orientation(std::string_view header) {
  if (!is_tiff_header(header)) return 1;
  const TiffNumbers number(header);
  const auto entry = tiff_entry(header, number.at(4, 4), 0x112);
  return entry ? static_cast<int>(number.at(*entry, 2)) : 1;
}

// True where the interoperability index, behind the pointers of two directories, is R03, which cameras write beside
// values in Adobe RGB. [DCF 2.0, optional color space]
bool is_adobe_rgb(std::string_view header) {
  constexpr std::uint32_t kExif = 0x8769, kInteroperability = 0xa005, kIndex = 1;
  if (!is_tiff_header(header)) return false;
  const TiffNumbers number(header);
  const auto place = [&](std::size_t directory, std::uint32_t tag) -> std::size_t {
    const auto entry = tiff_entry(header, directory, tag);
    return entry ? number.at(*entry, 4) : 0;
  };
  const std::size_t first = number.at(4, 4), exif = place(first, kExif);
  for (const std::size_t directory : {exif, first})
    if (const auto index = tiff_entry(header, place(directory, kInteroperability), kIndex))
      return header.substr(*index, 3) == "R03";
  return false;
}

// Red, green, blue and white by PrimaryChromaticities and WhitePoint of a TIFF; none where one is missing or is 0/0.
std::vector<float> tiff_chromaticities(std::string_view header) {
  constexpr std::uint32_t kPrimaries = 319, kWhite = 318;
  if (!is_tiff_header(header)) return {};
  const TiffNumbers number(header);
  std::vector<float> xy;
  for (const auto& [tag, count] : {std::pair{kPrimaries, std::size_t{6}}, {kWhite, std::size_t{2}}}) {
    const auto entry = tiff_entry(header, number.at(4, 4), tag);
    if (!entry || number.at(*entry - 4, 4) != count) return {};
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = number.at(*entry, 4) + 8 * i;
      const std::uint32_t below = number.at(at + 4, 4);
      if (below == 0) return {};
      xy.push_back(static_cast<float>(number.at(at, 4)) / static_cast<float>(below));
    }
  }
  return xy;
}

// The number of so many bytes, the first of which is the highest.
std::size_t big_endian(std::string_view bytes) {
  std::size_t value = 0;
  for (const char byte : bytes) value = value << 8 | static_cast<unsigned char>(byte);
  return value;
}

// A chunk of a WebP file; empty where there is none. Behind "RIFF", a size and "WEBP" come chunks of a type, a size and
// bytes, of which there are an even number.
std::string_view chunk_of_webp(std::string_view content, std::string_view type) {
  for (std::size_t at = 12; at + 8 <= content.size();) {
    std::size_t size = 0;
    for (std::size_t i = 8; i-- > 4;) size = size << 8 | static_cast<unsigned char>(content[at + i]);
    if (size > content.size() - at - 8) break;
    if (content.substr(at, 4) == type) return content.substr(at + 8, size);
    at += 8 + size + size % 2;
  }
  return {};
}
// Behind a mark of 8 bytes come chunks of a size, a type, bytes and a sum of 4.
std::string_view exif_of_png(std::string_view content) {
  for (std::size_t at = 8; at + 12 <= content.size();) {
    const std::size_t size = big_endian(content.substr(at, 4));
    if (size > content.size() - at - 12) break;
    if (content.substr(at + 4, 4) == "eXIf") return content.substr(at + 8, size);
    at += 12 + size;
  }
  return {};
}
// Segments begin with 0xFF, a kind, and a size that counts its own two bytes; the kind 0xDA begins the pixels.
std::string_view exif_of_jpeg(std::string_view content) {
  for (std::size_t at = 2; at + 4 <= content.size() && content[at] == '\xFF' && content[at + 1] != '\xDA';) {
    if (content[at + 1] == '\xFF') {  // bytes that fill
      ++at;
      continue;
    }
    const std::size_t size = big_endian(content.substr(at + 2, 2));
    if (size < 2 || size > content.size() - at - 2) break;
    const std::string_view bytes = content.substr(at + 4, size - 2);
    if (content[at + 1] == '\xE1' && bytes.starts_with("Exif"sv)) return bytes;
    at += 2 + size;
  }
  return {};
}

// The TIFF header and directories of the EXIF data of a PNG, JPEG or WebP file; empty where there are none.
std::string_view exif_of(std::string_view content, std::string_view format) {
  std::string_view exif = format == "webp"   ? chunk_of_webp(content, "EXIF")
                          : format == "png"  ? exif_of_png(content)
                          : format == "jpeg" ? exif_of_jpeg(content)
                                             : std::string_view();
  if (exif.starts_with("Exif")) exif.remove_prefix(std::min<std::size_t>(6, exif.size()));
  return exif;
}

// The number of 4 bytes in a TGA or BMP, lowest byte first; 0 beyond the end.
std::uint32_t little_endian(std::string_view content, std::size_t at, std::size_t bytes = 4) {
  std::uint32_t value = 0;
  for (std::size_t i = bytes; i-- > 0 && at + bytes <= content.size();)
    value = value << 8 | static_cast<unsigned char>(content[at + i]);
  return value;
}

// The number that tells the kind of alpha in the extension of a TGA, to which the 26 bytes at its end point; none
// without an extension. [Truevision TGA 2.0, fields 24 and 28]
std::optional<int> alpha_type_of_targa(std::string_view content) {
  constexpr std::size_t kFooter = 26, kType = 494;
  if (content.size() < kFooter || !content.substr(content.size() - 18).starts_with("TRUEVISION-XFILE."))
    return std::nullopt;
  const std::size_t extension = little_endian(content, content.size() - kFooter);
  if (extension == 0 || extension + kType >= content.size()) return std::nullopt;
  return static_cast<unsigned char>(content[extension + kType]);
}

// The header of a BMP behind the 14 bytes of the file: a size, and by it the fields there are.
struct BmpHeader {
  static constexpr std::size_t kAt = 14;
  static constexpr std::uint32_t kCalibrated = 0, kEmbedded = 0x4d424544;  // bV5CSType
  std::string_view content;
  std::uint32_t size() const { return field(0); }
  std::uint32_t depth() const { return little_endian(content, kAt + 14, 2); }
  std::uint32_t field(std::size_t at) const { return little_endian(content, kAt + at); }
  bool has_masks() const { return field(16) == 3 || field(16) == 6; }
  std::uint32_t alpha_mask() const { return has_masks() && (size() >= 56 || field(16) == 6) ? field(52) : 0; }
};

std::string_view profile_of_bmp(std::string_view content) {
  const BmpHeader header{content};
  if (header.size() < 124 || header.field(56) != BmpHeader::kEmbedded) return {};
  const std::size_t at = BmpHeader::kAt + std::size_t{header.field(112)};
  return at < content.size() ? content.substr(at, header.field(116)) : std::string_view();
}

// Endpoints of 0 are those of programs that fill in a header without colors to state.
bool states_primaries(const BmpHeader& header) {
  return header.size() >= 108 && header.field(56) == BmpHeader::kCalibrated && header.field(60) != 0;
}

}  // namespace

bool has_alpha(std::string_view content, std::string_view format) {
  if (format == "bmp") return BmpHeader{content}.alpha_mask() != 0;
  if (format != "targa") return true;
  constexpr int kStraight = 3, kMultiplied = 4, kBits = 15;
  if (const auto type = alpha_type_of_targa(content)) return *type == kStraight || *type == kMultiplied;
  return (content[17] & kBits) != 0;
}

std::string misread_colors(std::string_view content, std::string_view format) {
  if (format == "targa" && (content[2] & ~8) == 3 && content[16] != 8)
    return fmt::format("is a gray TGA of {} bits a pixel, and 8 are read: {}", int{content[16]}, kAdvice);
  if (format != "bmp") return "";
  const BmpHeader header{content};
  if (header.depth() == 32 && header.has_masks() &&
      (header.field(40) != 0xff0000 || header.field(44) != 0xff00 || header.field(48) != 0xff))
    return fmt::format(
        "is a BMP whose masks of red, green and blue are {:x}, {:x} and {:x}, and only ff0000, ff00 and "
        "ff are read: {}",
        header.field(40), header.field(44), header.field(48), kAdvice);
  if (states_primaries(header))
    return fmt::format("is a BMP that states primaries and curves of its own, which are not read: {}", kAdvice);
  return "";
}

int exif_orientation(std::string_view content, std::string_view format) {
  return tiff_orientation(exif_of(content, format));
}

Attributes stated_colors(std::string_view content, std::string_view format) {
  Attributes attributes;
  if (const auto profile = format == "webp"  ? chunk_of_webp(content, "ICCP")
                           : format == "bmp" ? profile_of_bmp(content)
                                             : std::string_view();
      !profile.empty()) {
    attributes["ICCProfile"] = std::string(profile);
    return attributes;
  }
  const std::string_view header = format == "tiff" ? content : exif_of(content, format);
  if (is_adobe_rgb(header)) {
    attributes["oiio:ColorSpace"] = std::string("Gamma2.19921875");
    attributes["chromaticities"] = std::vector<float>{.64F, .33F, .21F, .71F, .15F, .06F, .3127F, .329F};
  } else if (const auto xy = tiff_chromaticities(header); format == "tiff" && !xy.empty()) {
    attributes["chromaticities"] = xy;
  }
  return attributes;
}

Result<std::string> content_format(std::string_view content, const std::string& name) {
  for (const Signature& signature : kWanted) {
    if (!shows(content, signature)) continue;
    const std::string format = signature.format;
    if (format == "webp" && !content.starts_with("RIFF")) continue;
    if (format == "tiff" && is_camera_raw(content))
      return input_error("{}: is a camera's raw file, whose first picture is a thumbnail: {}", name, kAdvice);
    return format;
  }
  if (is_pnm(content)) return std::string("pnm");
  if (is_radiance_header(content)) return std::string("hdr");
  for (const Signature& signature : kUnwanted)
    if (shows(content, signature))
      return input_error("{}: is {}, which is not read here: {}", name, signature.format, kAdvice);
  if (is_targa(content)) return std::string("targa");
  return input_error(
      "{}: is none of the image formats that are read here (EXR, HDR, PNG, JPEG, TIFF, PNM, DPX, WebP, BMP, TGA): {}",
      name, kAdvice);
}

}  // namespace goniochrome::image
