#include "image/surface_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "image/exr.h"

namespace goniochrome::image {

namespace {

// Error: a program that converted the colors of the file has said so.
Result<void> check_working_space(const std::vector<ImagePart>& parts, const std::string& path) {
  for (const ImagePart& part : parts)
    if (const std::string id = text_attribute(part, "colorInteropID"); !id.empty() && id != "lin_rec2020_scene")
      return input_error("{}: colorInteropID is \"{}\", not \"lin_rec2020_scene\": convert its colors back", path, id);
  return {};
}

}  // namespace

Result<brdf::ColorMap> read_color_map(const std::string& path) {
  GONIO_ASSIGN(const std::vector<ImagePart> parts, read_exr(path));
  GONIO_TRY(check_working_space(parts, path));
  const Image& image = parts.front().image;
  // Channels are read in this order where they are there.
  const std::vector<std::string> rgb = {"R", "G", "B"};
  if (image.width < 1 || image.height != 2 * image.width || image.channels < 3 ||
      !std::ranges::equal(rgb, std::span(image.channel_names).first(3)))
    return input_error("{}: {}x{} with the channels {} is no color map: a color map is RGB and twice as high as wide",
                       path, image.width, image.height, goniochrome::joined(image.channel_names, ","));
  const Attributes& attributes = parts.front().attributes;
  double index = 1.5;
  if (attributes.contains("goniochrome:index")) {
    const float* stated = find_attribute<float>(attributes, "goniochrome:index");
    if (stated == nullptr || !(*stated >= 1 && *stated <= 4))
      return input_error("{}: goniochrome:index must be a number from 1 to 4", path);
    index = std::round(*stated * 1e6) * 1e-6;  // a decimal number that went through a float
  }
  brdf::ColorMap map = brdf::color_map_of_size(image.width, index);
  const auto model = attribute_or<std::string>(attributes, "goniochrome:model", "isolines");
  if (model != "isolines" && model != "aspecular")
    return input_error("{}: goniochrome:model is \"{}\": it is isolines or aspecular", path, model);
  map.aspecular = model == "aspecular";
  const auto distance = std::ranges::find(image.channel_names, "distance");
  const bool has_distance = distance != image.channel_names.end();
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (int c = 0; c < 3; ++c) {
        const float value = image.pixel(column, row)[c];
        if (!std::isfinite(value))
          return input_error("{}: pixel ({},{}) is {}: a reflectance factor is a finite number", path, column, row,
                             value);
        map.texel(column, row)[c] = value;
      }
      if (has_distance) map.distance_deg.push_back(image.pixel(column, row)[distance - image.channel_names.begin()]);
    }
  }
  return map;
}

Result<void> write_color_map(const std::string& path, const brdf::ColorMap& map, const Attributes& attributes) {
  ImagePart part{"color-map", {map.size, 2 * map.size, 3, map.factors, {"R", "G", "B"}}, attributes, PixelType::kHalf};
  if (!map.distance_deg.empty()) {
    Image& image = part.image;
    image.channels = 4, image.channel_names.push_back("distance"), image.data.clear();
    for (std::size_t i = 0; i < map.distance_deg.size(); ++i) {
      for (std::size_t c = 0; c < 3; ++c) image.data.push_back(map.factors[3 * i + c]);
      image.data.push_back(map.distance_deg[i]);
    }
  }
  part.attributes["goniochrome:model"] = std::string(map.aspecular ? "aspecular" : "isolines");
  part.attributes["goniochrome:colorMap"] = std::string("cos(theta_i), cos(theta_o)");
  part.attributes["goniochrome:index"] = static_cast<float>(map.index);
  part.attributes["colorInteropID"] = std::string("lin_rec2020_scene");
  return write_exr(path, {part});
}

namespace {

// The channels of a file with so many lobes, in the order of SbrdfTexture.
std::vector<std::string> channels_of(int lobes) {
  std::vector<std::string> names = {"diffuse.R", "diffuse.G", "diffuse.B", "frame.c", "frame.s"};
  for (int lobe = 0; lobe < lobes; ++lobe)
    for (const char* channel : {"R", "G", "B", "x", "y", "z", "n"})
      names.push_back(fmt::format("lobe{}.{}", lobe, channel));
  return names;
}

// The channels of the frames of lobes, in the order of SbrdfTexture::turns.
std::vector<std::string> turns_of(int lobes) {
  std::vector<std::string> names;
  for (int lobe = 0; lobe < lobes; ++lobe)
    for (const char* channel : {"c", "s"}) names.push_back(fmt::format("lobe{}.{}", lobe, channel));
  return names;
}

// The normal of a texel, in the order of SbrdfTexture::normals.
const std::vector<std::string> kNormal = {"normal.x", "normal.y", "normal.z"};

// Channels of a fitted texture besides the surface of its texels.
constexpr std::array<std::string_view, 3> kBeside = {"alpha", "certainty", "error"};

bool may_be_negative(const std::string& name) {
  return name.starts_with("frame.") || name.ends_with(".x") || name.ends_with(".y") || name.ends_with(".z");
}

// The channels of all parts side by side.
Result<Image> joined(const std::vector<ImagePart>& parts, const std::string& path) {
  const Image& first = parts.front().image;
  if (parts.size() == 1) return first;
  Image all{first.width, first.height, 0, {}, {}};
  for (const ImagePart& part : parts) {
    const Image& image = part.image;
    if (image.width != first.width || image.height != first.height)
      return input_error("{}: part {} is {} x {}, but part {} is {} x {}: give all of a texture the same size", path,
                         part.name, image.width, image.height, parts.front().name, first.width, first.height);
    all.channels += image.channels;
    all.channel_names.insert(all.channel_names.end(), image.channel_names.begin(), image.channel_names.end());
  }
  for (int row = 0; row < all.height; ++row) {
    for (int column = 0; column < all.width; ++column) {
      for (const ImagePart& part : parts) {
        const float* pixel = part.image.pixel(column, row);
        all.data.insert(all.data.end(), pixel, pixel + part.image.channels);
      }
    }
  }
  return all;
}

// Which channel of the file holds each value; -1 for an absent frame.
Result<std::vector<int>> sources(const std::vector<std::string>& wanted, const std::vector<std::string>& given,
                                 const std::string& path) {
  std::vector<int> result;
  for (const std::string& name : wanted) {
    const auto found = std::ranges::find(given, name);
    if (found == given.end() && !name.starts_with("frame."))
      return input_error("{}: channel {} is missing: lobes are lobe0, lobe1 ... with R G B x y z n", path, name);
    result.push_back(found == given.end() ? -1 : static_cast<int>(found - given.begin()));
  }
  if ((result[3] < 0) != (result[4] < 0)) return input_error("{}: give frame.c and frame.s, or neither", path);
  const std::vector<std::string> turns = turns_of(static_cast<int>(wanted.size() - 5) / 7);
  const auto is_among = [](const auto& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
  };
  for (const std::string& name : given)
    if (!is_among(wanted, name) && !is_among(turns, name) && !is_among(kNormal, name) && !is_among(kBeside, name))
      return input_error("{}: channel {} is not known: there are diffuse, frame and lobe0 to lobe15", path, name);
  return result;
}

// Alpha of all texels; nothing where all are 1.
Result<std::vector<float>> alpha_of(const Image& image, const std::string& path) {
  std::vector<float> alpha;
  const auto channel = std::ranges::find(image.channel_names, "alpha");
  if (channel == image.channel_names.end()) return alpha;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const float value = image.pixel(column, row)[channel - image.channel_names.begin()];
      if (!(value >= 0 && value <= 1))
        return input_error("{}: alpha of texel ({},{}) is {}: give a number from 0 to 1", path, column, row, value);
      alpha.push_back(value);
    }
  }
  if (std::ranges::all_of(alpha, [](float value) { return value == 1; })) alpha.clear();
  return alpha;
}

// The values of channels that a texture has all of, or none; `missing` says what to do where some are missing.
Result<std::vector<float>> values_of(const Image& image, const std::vector<std::string>& names, const char* missing,
                                     const std::string& path) {
  std::vector<std::ptrdiff_t> from;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(image.channel_names, name);
    if (found != image.channel_names.end()) from.push_back(found - image.channel_names.begin());
  }
  std::vector<float> values;
  if (from.empty()) return values;
  if (from.size() != names.size()) return input_error("{}: {}", path, missing);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (std::size_t k = 0; k < from.size(); ++k) {
        const float value = image.pixel(column, row)[from[k]];
        if (!std::isfinite(value))
          return input_error("{}: {} of texel ({},{}) is {}: give a finite number", path, names[k], column, row, value);
        values.push_back(value);
      }
    }
  }
  return values;
}

// Halves hold unit vectors to some 1e-3: these become unit again.
Result<void> check_normals(brdf::SbrdfTexture& texture, const std::string& path) {
  for (std::size_t i = 0; i < texture.normals.size(); i += 3) {
    float* n = &texture.normals[i];
    constexpr double kFromUnit = 0.01;
    const float size = std::hypot(n[0], n[1], n[2]);
    if (!(n[2] > 0 && std::abs(size - 1) < kFromUnit))
      return input_error("{}: the normal of texel ({},{}) is {} {} {}: give a unit vector whose z is above 0", path,
                         i / 3 % static_cast<std::size_t>(texture.width),
                         i / 3 / static_cast<std::size_t>(texture.width), n[0], n[1], n[2]);
    for (std::size_t k = 0; k < 3; ++k) n[k] /= size;
  }
  return {};
}

Result<void> check_axes(const brdf::SbrdfTexture& texture, const std::string& path) {
  for (int row = 0; row < texture.height; ++row) {
    for (int column = 0; column < texture.width; ++column) {
      const float* at = texture.texel(column, row) + 5;
      for (int lobe = 0; lobe < texture.lobes; ++lobe, at += 7) {
        if ((at[0] > 0 || at[1] > 0 || at[2] > 0) && at[3] == 0 && at[4] == 0 && at[5] == 0)
          return input_error(
              "{}: the axes of lobe{} of texel ({},{}) are 0, but its albedo is not: give x, y and z, which are -1, -1 "
              "and 1 for a lobe about the mirror direction",
              path, lobe, column, row);
      }
    }
  }
  return {};
}

// The part of a value that half floats lose: they keep every exponent, for which maps were filtered, and |p|^n of every
// lobe within 1/256, since their steps at 1 are 2^-10, of which half is rounded away.
float lost_in_half(float value) {
  return std::remainder(value, std::ldexp(1.0F, std::ilogb(value) - 10));
}

bool halves_do(const brdf::SbrdfTexture& texture) {
  const auto stride = static_cast<std::size_t>(texture.stride());
  for (std::size_t i = 0; i < texture.values.size(); i += stride) {
    for (std::size_t k = i + 5; k < i + stride; k += 7) {
      const float exponent = texture.values[k + 6];
      if (exponent != 0 && lost_in_half(exponent) != 0) return false;
      for (std::size_t axis = k + 3; axis < k + 6; ++axis) {
        const float value = texture.values[axis];
        if (value != 0 && exponent * std::abs(lost_in_half(value) / value) > 1.0F / 256) return false;
      }
    }
  }
  return true;
}

}  // namespace

Result<brdf::SbrdfTexture> read_sbrdf(const std::string& path) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  return read_sbrdf(std::move(input));
}

Result<brdf::SbrdfTexture> read_sbrdf(InputFile input) {
  const std::string path = input.name();
  GONIO_ASSIGN(const std::string content, input.rest(std::string::npos));
  GONIO_ASSIGN(const std::vector<ImagePart> parts, decoded_exr(content, path));
  GONIO_TRY(check_working_space(parts, path));
  GONIO_ASSIGN(const Image image, joined(parts, path));
  brdf::SbrdfTexture texture{image.width, image.height, 0, {}};
  const auto& given = image.channel_names;
  while (texture.lobes < 16 && std::ranges::find(given, fmt::format("lobe{}.n", texture.lobes)) != given.end())
    ++texture.lobes;
  const std::vector<std::string> wanted = channels_of(texture.lobes);
  GONIO_ASSIGN(const std::vector<int> from, sources(wanted, given, path));
  texture.values.reserve(static_cast<std::size_t>(image.width) * image.height * wanted.size());
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const float* pixel = image.pixel(column, row);
      for (std::size_t k = 0; k < wanted.size(); ++k) {
        const float value = from[k] < 0 ? (k == 3 ? 1.0F : 0.0F) : pixel[from[k]];
        if (!std::isfinite(value) || (value < 0 && !may_be_negative(wanted[k])))
          return input_error("{}: {} of texel ({},{}) is {}: give a finite number{}", path, wanted[k], column, row,
                             value, may_be_negative(wanted[k]) ? "" : " of 0 or more");
        texture.values.push_back(value);
      }
    }
  }
  GONIO_TRY(check_axes(texture, path));
  GONIO_ASSIGN(texture.alpha, alpha_of(image, path));
  GONIO_ASSIGN(
      texture.turns,
      values_of(image, turns_of(texture.lobes),
                "give c and s of every lobe, or of none: the texel's frame serves lobes that lack them", path));
  GONIO_ASSIGN(texture.normals, values_of(image, kNormal, "give normal.x, normal.y and normal.z, or none", path));
  GONIO_TRY(check_normals(texture, path));
  return texture;
}

Result<void> write_sbrdf(const std::string& path, const brdf::SbrdfTexture& texture, const Attributes& attributes,
                         const std::vector<ImagePart>& beside) {
  std::vector<std::string> names = channels_of(texture.lobes);
  const auto stride = static_cast<std::size_t>(texture.stride());
  std::vector<float> values = texture.values;
  if (!texture.alpha.empty() || !texture.turns.empty() || !texture.normals.empty()) {
    const std::vector<std::string> turns = turns_of(texture.turns.empty() ? 0 : texture.lobes);
    names.insert(names.end(), turns.begin(), turns.end());
    if (!texture.normals.empty()) names.insert(names.end(), kNormal.begin(), kNormal.end());
    if (!texture.alpha.empty()) names.emplace_back("alpha");
    values.clear();
    const auto put = [&](const std::vector<float>& of, std::size_t texel, std::size_t count) {
      const auto from = of.begin() + static_cast<std::ptrdiff_t>(texel * count);
      values.insert(values.end(), from, from + static_cast<std::ptrdiff_t>(count));
    };
    for (std::size_t i = 0; i * stride < texture.values.size(); ++i) {
      put(texture.values, i, stride), put(texture.turns, i, turns.size());
      if (!texture.normals.empty()) put(texture.normals, i, kNormal.size());
      if (!texture.alpha.empty()) values.push_back(texture.alpha[i]);
    }
  }
  const auto channels = static_cast<int>(names.size());
  const PixelType type = halves_do(texture) ? PixelType::kHalf : PixelType::kFloat;
  ImagePart part{
      "sbrdf", {texture.width, texture.height, channels, std::move(values), std::move(names)}, attributes, type};
  part.attributes["colorInteropID"] = std::string("lin_rec2020_scene");
  std::vector<ImagePart> parts = {std::move(part)};
  parts.insert(parts.end(), beside.begin(), beside.end());
  return write_exr(path, parts);
}

}  // namespace goniochrome::image
