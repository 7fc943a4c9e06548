#include "envmap/prefiltered.h"

#include <Imath/half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>

#include "base/file.h"
#include "base/parallel.h"
#include "base/text.h"
#include "envmap/env_content.h"
#include "envmap/mip.h"
#include "envmap/open_maps.h"
#include "image/exr.h"

namespace goniochrome::envmap {

namespace {

constexpr float kMostHalf = 65504.0F;
constexpr double kHalfError = 0x1p-11;      // relative, of a normal half
constexpr double kHalfSubnormal = 0x1p-25;  // absolute, below 2^-14
constexpr double kFloor = 1e-3;             // errors are relative to the local value, but no less than this of the mean
constexpr const char* kTexels = "goniochrome:texels";
constexpr const char* kColorSpace = "lin_rec2020_scene";
constexpr const char* kExponent = "goniochrome:exponent";
constexpr const char* kSpots = "goniochrome:brightSpots";
// An attribute of parts with maps that follow from others. A reader that knows another version makes them itself.
constexpr const char* kVersion = "goniochrome:version";
constexpr int kKnownVersion = 1;
constexpr const char* kOpen = "open-";  // before the name of the part that the spots are taken out of
constexpr const char* kRms = "rms-";    // before the name of the lobe
constexpr const char* kCoat = "coat-diffuse";

double mean_value(const CubeMap& map) {
  double sum = 0;
  for (const float value : map.texels) sum += value;
  return map.texels.empty() ? 0 : sum / static_cast<double>(map.texels.size());
}

// The fewest bits of a fraction that keep the rounding error 2^-(bits+1) below 1/64 of the tolerance.
int fraction_bits(double tolerance) {
  if (!(tolerance > 0)) return 23;
  return std::clamp(static_cast<int>(std::ceil(std::log2(64 / tolerance))) - 1, 8, 23);
}

float rounded_to_bits(float value, int bits) {
  const std::uint32_t drop = 23 - static_cast<std::uint32_t>(bits);
  if (drop == 0) return value;
  const std::uint32_t word = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t half_step = (1U << (drop - 1)) - 1 + ((word >> drop) & 1);  // ties to even
  const float rounded = std::bit_cast<float>((word + half_step) & ~((1U << drop) - 1));
  return std::isfinite(rounded) ? rounded : value;
}

// OpenEXR's faces are OpenGL's seen from the other side: X and Z mirrored left to right, Y top to bottom.
std::vector<float> openexr_faces(const CubeMap& map) {
  const int n = map.size;
  CubeMap turned(n);
  for (int face = 0; face < 6; ++face)
    for (int row = 0; row < n; ++row)
      for (int column = 0; column < n; ++column) {
        const bool pole = face / 2 == 1;
        std::copy_n(map.at(face, pole ? n - 1 - row : row, pole ? column : n - 1 - column), 3,
                    turned.at(face, row, column));
      }
  return std::move(turned.texels);
}

image::ImagePart part_of(const std::string& name, const PrefilteredLobe& lobe, const std::string& source,
                         const std::string& command) {
  image::ImagePart part;
  part.name = name;
  part.type = storage_type(lobe);
  using Layout = SphereGrid::Layout;
  const SphereGrid grid = map_grid(lobe.layout, lobe.map.size);
  const bool edges = lobe.layout == Layout::kCubeEdges;
  part.image = {grid.width(), grid.height(), 3, edges ? openexr_faces(lobe.map) : lobe.map.texels, {}};
  part.attributes = {
      {kTexels, std::string(edges ? "edge" : "center")},
      {kExponent, static_cast<float>(lobe.exponent)},
      {"goniochrome:tolerance", static_cast<float>(lobe.tolerance)},
      {"goniochrome:maxError", static_cast<float>(lobe.max_error)},
      {"goniochrome:meanError", static_cast<float>(lobe.mean_error)},
      {"goniochrome:verifiedTexels", lobe.verified_texels},
      {"goniochrome:predictedError", static_cast<float>(lobe.predicted_error)},
      {"goniochrome:lookupError", static_cast<float>(lobe.lookup_error)},
      {"goniochrome:method", lobe.method},
      {"goniochrome:source", source},
      {"goniochrome:command", command},
      {"colorInteropID", std::string(kColorSpace)},
  };
  if (edges) part.attributes["envmap"] = std::string("cube");
  if (lobe.layout == Layout::kLatLong) part.attributes["envmap"] = std::string("latlong");
  return part;
}

// A map that follows from that of `lobe`, and has its size.
image::ImagePart part_of_map(const std::string& name, const CubeMap& map, const PrefilteredLobe& lobe) {
  image::ImagePart part;
  part.name = name;
  part.type = storage_type(lobe);
  part.image = {map.size, 6 * map.size, 3, map.texels, {}};
  part.attributes = {{kTexels, std::string("center")},
                     {kExponent, static_cast<float>(lobe.exponent)},
                     {kVersion, kKnownVersion},
                     {"colorInteropID", std::string(kColorSpace)}};
  return part;
}

double number_attribute(const image::Attributes& attributes, const std::string& name) {
  const auto found = attributes.find(name);
  if (found == attributes.end()) return 0;
  if (const auto* number = std::get_if<float>(&found->second)) return *number;
  const auto* whole = std::get_if<int>(&found->second);
  return whole ? *whole : 0;
}

double number_attribute(const image::ImagePart& part, const std::string& name) {
  return number_attribute(part.attributes, name);
}

Result<PrefilteredLobe> lobe_of(image::ImagePart part, const std::string& path) {
  const auto refused = [&](const std::string& why) {
    return input_error("{}: part {}: {}: write it with prefilter-envmap, in its own layout", path, part.name, why);
  };
  const image::Image& image = part.image;
  if (image.height != 6 * image.width)
    return refused(fmt::format("is {} x {}, not a strip of six faces", image.width, image.height));
  if (image.channel_names != std::vector<std::string>{"R", "G", "B"})
    return refused(fmt::format("has the channels {}, not R, G and B", joined(image.channel_names, ", ")));
  if (const std::string space = text_attribute(part, "colorInteropID"); !space.empty() && space != kColorSpace)
    return refused(fmt::format("attribute colorInteropID is \"{}\", not \"{}\"", space, kColorSpace));
  if (text_attribute(part, kTexels) != "center")
    return refused(fmt::format("attribute {} is \"{}\", not \"center\"", kTexels, text_attribute(part, kTexels)));
  if (!part.attributes.count(kExponent)) return refused(fmt::format("attribute {} is missing", kExponent));
  PrefilteredLobe lobe;
  lobe.exponent = number_attribute(part, kExponent);
  if (!(lobe.exponent >= 0)) return refused(fmt::format("attribute {} is {}", kExponent, lobe.exponent));
  lobe.tolerance = number_attribute(part, "goniochrome:tolerance");
  lobe.max_error = number_attribute(part, "goniochrome:maxError");
  lobe.mean_error = number_attribute(part, "goniochrome:meanError");
  lobe.verified_texels = static_cast<int>(number_attribute(part, "goniochrome:verifiedTexels"));
  lobe.predicted_error = number_attribute(part, "goniochrome:predictedError");
  lobe.lookup_error = number_attribute(part, "goniochrome:lookupError");
  lobe.method = text_attribute(part, "goniochrome:method");
  lobe.map.size = image.width;
  lobe.map.texels = std::move(part.image.data);
  return lobe;
}

// The parts with maps that follow from others, by their names.
using OtherMaps = std::map<std::string, MapPointer>;

// Takes the map of the part of that name, which must be as large as that of the lobe. Null where there is none.
Result<MapPointer> other_map(const OtherMaps& maps, const std::string& name, const PrefilteredLobe& lobe,
                             const std::string& path) {
  const auto found = maps.find(name);
  if (found == maps.end()) return MapPointer();
  if (found->second->size != lobe.map.size)
    return input_error(
        "{}: part {}: has {} texels along a face, and the map that it follows from has {}: write it with "
        "prefilter-envmap",
        path, name, found->second->size, lobe.map.size);
  return found->second;
}

// Gives the maps that follow from others to those which they follow from.
Result<void> join(const OtherMaps& maps, const std::map<double, std::string>& names, const std::string& path,
                  PrefilteredEnvironment& env) {
  GONIO_ASSIGN(env.coat_diffuse, other_map(maps, kCoat, env.diffuse, path));
  for (PrefilteredLobe& lobe : env.lobes) {
    const auto name = names.find(lobe.exponent);
    const auto found = name != names.end() ? maps.find(kRms + name->second) : maps.end();
    if (found != maps.end()) lobe.rms = found->second;
  }
  if (env.spots.empty()) return {};
  GONIO_ASSIGN(env.open_coat_diffuse, other_map(maps, std::string(kOpen) + kCoat, env.diffuse, path));
  GONIO_ASSIGN(env.diffuse.open, other_map(maps, std::string(kOpen) + "diffuse", env.diffuse, path));
  for (PrefilteredLobe& lobe : env.lobes) {
    const auto name = names.find(lobe.exponent);
    if (name == names.end()) continue;
    GONIO_ASSIGN(lobe.open, other_map(maps, kOpen + name->second, lobe, path));
  }
  return {};
}

}  // namespace

SphereGrid map_grid(SphereGrid::Layout layout, int n) {
  if (layout == SphereGrid::Layout::kLatLong) return {layout, 2 * n, n};
  return {layout, n, 6 * n};
}

image::PixelType storage_type(const PrefilteredLobe& lobe) {
  if (lobe.tolerance < 2 * kHalfError * 0.999) return image::PixelType::kFloat;
  const double floor = kFloor * mean_value(lobe.map);
  for (const float value : lobe.map.texels) {
    const double size = std::fabs(value);
    if (size > kMostHalf) return image::PixelType::kFloat;
    if (size < 0x1p-14 && kHalfSubnormal > kHalfError * std::max(size, floor) && size > 0)
      return image::PixelType::kFloat;
  }
  return image::PixelType::kHalf;
}

void round_to_storage(PrefilteredLobe& lobe) {
  const bool as_half = storage_type(lobe) == image::PixelType::kHalf;
  const int bits = fraction_bits(lobe.tolerance);
  std::vector<float>& texels = lobe.map.texels;
  parallel_for(texels.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      texels[i] = as_half ? static_cast<float>(Imath::half(texels[i])) : rounded_to_bits(texels[i], bits);
  });
}

const PrefilteredLobe* PrefilteredEnvironment::lobe(double exponent) const {
  const auto same = [exponent](const PrefilteredLobe& l) {
    return l.exponent == exponent || std::fabs(l.exponent - exponent) <= 1e-6 * std::fabs(exponent);
  };
  if (paint::is_mirror(exponent)) return mirror.map.size > 0 ? &mirror : nullptr;
  for (const PrefilteredLobe& l : lobes)
    if (same(l)) return &l;
  return same(diffuse) && diffuse.map.size > 0 ? &diffuse : nullptr;
}

Result<PrefilteredEnvironment> read_env(const std::string& path, const std::function<bool(double)>& is_wanted) {
  GONIO_ASSIGN(InputFile input, InputFile::open(path));
  GONIO_ASSIGN(const std::string content, input.rest(std::string::npos));
  return env_of_content(content, input.name(), is_wanted);
}

bool is_prefiltered(const std::string& content) {
  constexpr std::string_view kExrMagic = "\x76\x2f\x31\x01";
  if (!content.starts_with(kExrMagic)) return false;
  const auto parts = image::decoded_exr(content, "", {.part = [](const auto&, const auto&) { return false; }});
  return parts.ok() && std::ranges::any_of(*parts, [](const image::ImagePart& part) {
           return part.attributes.contains(kExponent) || part.attributes.contains("goniochrome:exponents");
         });
}

Result<PrefilteredEnvironment> env_of_content(const std::string& content, const std::string& path,
                                              const std::function<bool(double)>& is_wanted) {
  if (content.empty()) return input_error("{}: is empty: name an EXR file", path);
  image::ExrWanted wanted;
  if (is_wanted) {
    wanted.part = [&](const std::string& name, const image::Attributes& attributes) {
      if (name == "mirror") return is_wanted(paint::kMirrorExponent);
      const bool of_lobe = name.starts_with("lobe-") || name.starts_with(std::string(kOpen) + "lobe-") ||
                           name.starts_with(std::string(kRms) + "lobe-");
      return !of_lobe || is_wanted(number_attribute(attributes, kExponent));
    };
  }
  GONIO_ASSIGN(std::vector<image::ImagePart> parts, image::decoded_exr(content, path, wanted));
  if (!text_attribute(parts.front(), "goniochrome:exponents").empty()) return read_mip(content, path);
  PrefilteredEnvironment env;
  env.mirror.exponent = paint::kMirrorExponent;
  OtherMaps others;
  std::map<double, std::string> names;
  for (image::ImagePart& part : parts) {
    const std::string name = part.name;
    const bool is_other = name == kCoat || name.starts_with(kOpen) || name.starts_with(kRms);
    if (name != "diffuse" && name != "mirror" && !name.starts_with("lobe-") && !is_other) continue;
    if (part.image.data.empty()) continue;  // not wanted
    if (is_other) {
      if (number_attribute(part.attributes, kVersion) != kKnownVersion) continue;
      GONIO_ASSIGN(PrefilteredLobe lobe, lobe_of(std::move(part), path));
      others[name] = std::make_shared<const CubeMap>(std::move(lobe.map));
      continue;
    }
    if (env.source.empty()) env.source = text_attribute(part, "goniochrome:source");
    if (name == "diffuse") {
      auto spots = spots_of_text(text_attribute(part, kSpots));
      if (!spots.ok())
        return input_error("{}: part diffuse: attribute {}: {}: write it with prefilter-envmap", path, kSpots,
                           spots.error().message);
      env.spots = *std::move(spots);
    }
    GONIO_ASSIGN(PrefilteredLobe lobe, lobe_of(std::move(part), path));
    if (name == "diffuse")
      env.diffuse = std::move(lobe);
    else if (name == "mirror")
      env.mirror = std::move(lobe);
    else
      names[lobe.exponent] = name, env.lobes.push_back(std::move(lobe));
  }
  if (env.diffuse.map.size == 0)
    return input_error("{}: has no part `diffuse`: it is not a prefiltered environment; make one with prefilter-envmap",
                       path);
  std::ranges::sort(env.lobes, {}, &PrefilteredLobe::exponent);
  GONIO_TRY(join(others, names, path, env));
  return env;
}

Result<std::string> env_content(const std::string& path, const PrefilteredEnvironment& env,
                                const std::string& command) {
  std::vector<std::function<image::ImagePart()>> made;
  const auto add_lobe = [&](const std::string& name, const PrefilteredLobe& lobe) {
    made.emplace_back([&, name] { return part_of(name, lobe, env.source, command); });
  };
  const auto add_map = [&](const std::string& name, const MapPointer& map, const PrefilteredLobe& lobe) {
    if (map != nullptr && lobe.layout == SphereGrid::Layout::kCube)
      made.emplace_back([&, name] { return part_of_map(name, *map, lobe); });
  };
  add_lobe("diffuse", env.diffuse);
  for (std::size_t i = 0; i < env.lobes.size(); ++i) add_lobe(fmt::format("lobe-{:03}", i), env.lobes[i]);
  if (env.mirror.map.size > 0) add_lobe("mirror", env.mirror);
  add_map(kCoat, env.coat_diffuse, env.diffuse);
  add_map(std::string(kOpen) + kCoat, env.open_coat_diffuse, env.diffuse);
  add_map(std::string(kOpen) + "diffuse", env.diffuse.open, env.diffuse);
  for (std::size_t i = 0; i < env.lobes.size(); ++i)
    add_map(fmt::format("{}lobe-{:03}", kOpen, i), env.lobes[i].open, env.lobes[i]);
  for (std::size_t i = 0; i < env.lobes.size(); ++i)
    add_map(fmt::format("{}lobe-{:03}", kRms, i), env.lobes[i].rms, env.lobes[i]);
  std::vector<image::ImagePart> parts(made.size());  // each a copy of a map
  parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) parts[i] = made[i]();
  });
  if (!env.spots.empty()) parts.front().attributes[kSpots] = text_of_spots(env.spots);
  // A start that draws one picture spent a tenth of its time on unpacking; packed by Zip, the file has half the size.
  return image::exr_content(path, parts, image::ExrStorage::kPlain);
}

Result<void> write_env(const std::string& path, const PrefilteredEnvironment& env, const std::string& command) {
  const std::string name = path.empty() || path == "-" ? "standard output" : path;
  GONIO_ASSIGN(const std::string content, env_content(name, env, command));
  return write_file(path, content);
}

}  // namespace goniochrome::envmap
