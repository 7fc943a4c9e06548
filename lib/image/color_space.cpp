#include "image/color_space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "base/text.h"
#include "color/color.h"
#include "image/icc.h"

namespace goniochrome::image {

namespace {

using Primaries = std::array<double, 8>;  // x y of red, green, blue and white

constexpr Primaries kRec709 = {.64, .33, .3, .6, .15, .06, .3127, .329};
constexpr Primaries kRec2020 = {.708, .292, .17, .797, .131, .046, .3127, .329};
constexpr Primaries kP3D65 = {.68, .32, .265, .69, .15, .06, .3127, .329};
constexpr Primaries kAp0 = {.7347, .2653, 0, 1, .0001, -.077, .32168, .33767};
constexpr Primaries kAp1 = {.713, .293, .165, .83, .128, .044, .32168, .33767};
constexpr Primaries kAdobeRgb = {.64, .33, .21, .71, .15, .06, .3127, .329};

enum class Curve { kLinear, kSrgb, kGamma };
struct Space {
  Primaries primaries = kRec709;
  Curve curve = Curve::kLinear;
  double gamma = 1;
  std::optional<std::array<double, 2>> neutral = {};  // x and y of what is shown as white, where it is another
};

// Linear light from a value in sRGB (IEC 61966-2-1).
double linear_from_srgb(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// Names as the Color Interop Forum and OpenImageIO spell them, in lower case.
std::optional<Space> named_space(std::string name) {
  name = lower(name);
  if (name == "lin_rec709_scene" || name == "lin_srgb" || name == "linear" || name == "scene_linear" ||
      name == "lin_rec709" || name == "rec709" || name == "linear rec.709 (srgb)")
    return Space{};
  if (name == "lin_rec2020_scene" || name == "lin_rec2020") return Space{kRec2020};
  if (name == "lin_p3d65_scene" || name == "lin_p3d65") return Space{kP3D65};
  if (name == "lin_ap0_scene" || name == "lin_ap0" || name == "aces2065-1") return Space{kAp0};
  if (name == "lin_ap1_scene" || name == "lin_ap1" || name == "acescg") return Space{kAp1};
  if (name == "lin_adobergb_scene") return Space{kAdobeRgb};
  if (name == "srgb" || name == "srgb_rec709_scene" || name == "srgb_rec709_display")
    return Space{kRec709, Curve::kSrgb};
  for (const std::string_view word : {"gammacorrected", "gamma"}) {
    if (!name.starts_with(word)) continue;
    if (const auto gamma = parse_number(std::string_view(name).substr(word.size())); gamma && *gamma > 0)
      return Space{kRec709, Curve::kGamma, *gamma};
  }
  return std::nullopt;
}

// True where a name says that the values are logarithms.
bool is_logarithmic(const std::string& name) {
  return lower(name).find("log") != std::string::npos || lower(name).find("acescc") != std::string::npos;
}

Result<Space> space_of(const ImagePart& part, const std::string& file) {
  const auto text = [&](const char* name) { return attribute_or<std::string>(part.attributes, name, ""); };
  const auto unknown = [&](const char* attribute, const std::string& value) {
    return input_error("{}: {} is \"{}\", which is not known: convert it to linear Rec.709 and tag it lin_rec709_scene",
                       file, attribute, value);
  };
  const auto* neutral = find_attribute<std::vector<float>>(part.attributes, "adoptedNeutral");
  const auto with_neutral = [&](Space space) {
    if (neutral && neutral->size() == 2) space.neutral = {(*neutral)[0], (*neutral)[1]};
    return space;
  };
  if (const std::string id = text("colorInteropID"); !id.empty()) {
    if (const auto space = named_space(id)) return with_neutral(*space);
    return unknown("colorInteropID", id);
  }
  const bool whole_numbers = attribute_or(part.attributes, "goniochrome:integer", 0) != 0;
  const std::string name = text("oiio:ColorSpace");
  // OpenImageIO says Rec709 of PNM and DPX files, and programs that use it pass this on to PNG. Of whole numbers it
  // means the curve of a display with these primaries, as PNM defines it, and in practice that of sRGB.
  // Whole numbers are for a display, which takes them as sRGB; floats are linear.
  const auto named = name.empty() ? Space{kRec709, whole_numbers ? Curve::kSrgb : Curve::kLinear}
                     : whole_numbers && lower(name) == "rec709" ? Space{kRec709, Curve::kSrgb}
                                                                : named_space(name);
  const auto* xy = find_attribute<std::vector<float>>(part.attributes, "chromaticities");
  const bool stated = xy && xy->size() == 8;
  if (!named && (whole_numbers || !stated || is_logarithmic(name))) return unknown("its color space", name);
  if (!stated) return with_neutral(*named);
  // Chromaticities tell the primaries and nothing of the curve, which is linear for floats unless their space has one.
  Space space = named.value_or(Space{});
  std::copy(xy->begin(), xy->end(), space.primaries.begin());
  return with_neutral(space);
}

bool same(const Primaries& a, const Primaries& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::fabs(a[i] - b[i]) > 2e-4) return false;
  return true;
}

using Columns = std::array<Vec3, 3>;

// The columns of the matrix from RGB of a space to the working space. They are the primaries, scaled so that they add
// up to the white, and adapted from what is shown as white to D65.
Result<Columns> to_working_space(const Space& space, const std::string& file) {
  const Primaries& p = space.primaries;
  const auto xyz = [&](int i) { return Vec3{p[i], p[i + 1], 1 - p[i] - p[i + 1]}; };
  const Vec3 r = xyz(0), g = xyz(2), b = xyz(4), w = xyz(6);
  const double det = dot(r, cross(g, b));
  if (!(std::fabs(det) > 1e-6) || !(w.y > 0))
    return input_error("{}: its chromaticities span no color space: retag the file", file);
  const Vec3 white = (1 / w.y) * w;
  const auto [x, y] = space.neutral.value_or(std::array{w.x, w.y});
  if (!(x >= 0 && y > 0 && x + y <= 1))
    return input_error("{}: its adoptedNeutral is {},{}, which is no chromaticity: retag the file", file, x, y);
  const Vec3 neutral = {x / y, 1, (1 - x - y) / y};
  const Vec3 scale = {dot(white, cross(g, b)) / det, dot(white, cross(b, r)) / det, dot(white, cross(r, g)) / det};
  const Vec3 d65 = {.3127 / .329, 1, (1 - .3127 - .329) / .329};
  const auto column = [&](double s, const Vec3& c) {
    const color::Xyz there =
        color::adapted({s * c.x, s * c.y, s * c.z}, {neutral.x, neutral.y, neutral.z}, {d65.x, d65.y, d65.z});
    return color::rgb_from_xyz_d65(there);
  };
  return Columns{column(scale.x, r), column(scale.y, g), column(scale.z, b)};
}

double decoded(double value, const Space& space) {
  switch (space.curve) {
    case Curve::kLinear:
      return value;
    case Curve::kSrgb:
      return linear_from_srgb(value);
    case Curve::kGamma:
      return value > 0 ? std::pow(value, space.gamma) : value;
  }
  return value;
}

// The ICC profile that tells the colors of the channels. Where inks have become RGB, that of the inks does not.
std::string profile_of(const ImagePart& part) {
  const bool was_inks = part.attributes.contains("goniochrome:inks") && color_channels(part.image) != 4;
  const bool has_id = !text_attribute(part, "colorInteropID").empty();
  return was_inks || has_id ? "" : text_attribute(part, "ICCProfile");
}

// Divides the signals of whole numbers by their alpha, by which files and readers have multiplied them: curves and
// profiles take them without it. Returns what each pixel was divided by; nothing where no pixel is half transparent. A
// pixel that is brighter than its alpha adds light of its own and stays.
std::vector<float> taken_alpha(ImagePart& part) {
  Image& image = part.image;
  const auto channels = static_cast<std::size_t>(image.channels);
  const bool has_alpha =
      channels == 2 || (image.channel_names.empty() ? channels == 4 : image.channel_names.back() == "A");
  if (!has_alpha || attribute_or(part.attributes, "goniochrome:integer", 0) == 0) return {};
  std::vector<float> taken(image.data.size() / channels, 1.0F);
  bool any = false;
  for (std::size_t i = 0; i < taken.size(); ++i) {
    float* signals = &image.data[i * channels];
    const float alpha = signals[channels - 1];
    if (!(alpha > 0 && alpha < 1) || *std::max_element(signals, signals + channels - 1) > alpha) continue;
    std::for_each(signals, signals + channels - 1, [&](float& signal) { signal /= alpha; });
    taken[i] = alpha, any = true;
  }
  return any ? taken : std::vector<float>();
}

Result<Image> opaque_working_space_rgb(ImagePart part, const std::string& name) {
  if (const std::string profile = profile_of(part); !profile.empty())
    return image_through_icc(part.image, profile, name, attribute_or(part.attributes, "goniochrome:integer", 0) != 0);
  GONIO_ASSIGN(const Space space, space_of(part, name));
  GONIO_ASSIGN(const Columns columns, to_working_space(space, name));
  const bool convert = space.neutral || !same(space.primaries, kRec2020);
  Image& from = part.image;
  const int green = from.channels < 3 ? 0 : 1, blue = from.channels < 3 ? 0 : 2;
  Image to = {from.width, from.height, 3, {}, {}};
  // Three channels are converted where they are.
  if (from.channels == 3)
    to.data.swap(from.data);
  else
    to.data.resize(static_cast<std::size_t>(from.width) * from.height * 3);
  const float* source = from.channels == 3 ? to.data.data() : from.data.data();
  parallel_for(static_cast<std::size_t>(from.height), 16, [&](std::size_t begin, std::size_t end) {
    const std::size_t width = static_cast<std::size_t>(from.width);
    for (std::size_t i = begin * width; i < end * width; ++i) {
      const float* in = &source[i * from.channels];
      Vec3 rgb = {decoded(in[0], space), decoded(in[green], space), decoded(in[blue], space)};
      if (convert) rgb = rgb.x * columns[0] + rgb.y * columns[1] + rgb.z * columns[2];
      for (int c = 0; c < 3; ++c) to.data[3 * i + c] = static_cast<float>(rgb[c]);
    }
  });
  return to;
}

}  // namespace

std::string text_attribute(const ImagePart& part, const std::string& name) {
  const auto found = part.attributes.find(name);
  const auto* text = found == part.attributes.end() ? nullptr : std::get_if<std::string>(&found->second);
  return text ? *text : "";
}

Result<Image> working_space_rgb(ImagePart part, const std::string& name) {
  const std::vector<float> alpha = taken_alpha(part);
  GONIO_ASSIGN(Image rgb, opaque_working_space_rgb(std::move(part), name));
  for (std::size_t i = 0; i < alpha.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) rgb.data[3 * i + c] *= alpha[i];
  return rgb;
}

std::string inks_problem(const ImagePart& part, const std::string& name) {
  if (!part.attributes.contains("goniochrome:inks")) return "";
  return fmt::format("{} is CMYK, and its inks were taken for RGB without regard to its profile: convert it to RGB",
                     name);
}

}  // namespace goniochrome::image
