#include "envmap/mip.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <new>

#include "base/file.h"
#include "base/text.h"

namespace goniochrome::envmap {

namespace {

// One line of numbers, level by level.
template <class Number>
Imf::StringAttribute listed(const std::vector<PrefilteredLobe>& levels, const Number& number) {
  std::string text;
  for (const PrefilteredLobe& level : levels) text += (text.empty() ? "" : " ") + shortest(number(level));
  return Imf::StringAttribute(text);
}

Imf::Header header_of(const std::vector<PrefilteredLobe>& levels, Imf::PixelType type, const std::string& source,
                      const std::string& command) {
  const int n = levels.front().map.size;
  Imf::Header header(n, 6 * n);
  for (const char* name : {"R", "G", "B"}) header.channels().insert(name, Imf::Channel(type));
  header.compression() = Imf::ZIP_COMPRESSION;
  header.setTileDescription(Imf::TileDescription(64, 64, Imf::MIPMAP_LEVELS, Imf::ROUND_DOWN));
  header.insert("goniochrome:texels", Imf::StringAttribute("center"));
  header.insert("goniochrome:exponents", listed(levels, [](const PrefilteredLobe& l) { return l.exponent; }));
  header.insert("goniochrome:maxErrors", listed(levels, [](const PrefilteredLobe& l) { return l.max_error; }));
  header.insert("goniochrome:lookupErrors", listed(levels, [](const PrefilteredLobe& l) { return l.lookup_error; }));
  header.insert("goniochrome:tolerance", Imf::StringAttribute(shortest(levels.front().tolerance)));
  header.insert("goniochrome:source", Imf::StringAttribute(source));
  header.insert("goniochrome:command", Imf::StringAttribute(command));
  header.insert("colorInteropID", Imf::StringAttribute("lin_rec2020_scene"));
  return header;
}

// The values of a level; the two that the format wants below one texel a face (1 x 3 and 1 x 1) hold the mean.
std::vector<float> level_values(const std::vector<PrefilteredLobe>& levels, std::size_t level) {
  if (level < levels.size()) return levels[level].map.texels;
  const std::vector<float>& last = levels.back().map.texels;
  std::vector<float> mean(3 * 6, 0.0F);
  for (std::size_t i = 0; i < mean.size(); ++i)
    for (std::size_t face = 0; face < 6; ++face) mean[i] += last[3 * face + i % 3] / 6;
  return mean;
}

std::string encoded(const std::vector<PrefilteredLobe>& levels, const std::string& source, const std::string& command) {
  const bool as_float = std::ranges::any_of(
      levels, [](const PrefilteredLobe& level) { return storage_type(level) == image::PixelType::kFloat; });
  const Imf::PixelType type = as_float ? Imf::FLOAT : Imf::HALF;
  Imf::StdOSStream stream;
  {
    Imf::TiledOutputFile file(stream, header_of(levels, type, source, command));
    for (int level = 0; level < file.numLevels(); ++level) {
      std::vector<float> values = level_values(levels, static_cast<std::size_t>(level));
      const std::vector<half> halves(values.begin(), values.end());
      const std::size_t size = as_float ? sizeof(float) : sizeof(half);
      char* base = as_float ? reinterpret_cast<char*>(values.data())
                            : const_cast<char*>(reinterpret_cast<const char*>(halves.data()));
      Imf::FrameBuffer buffer;
      for (std::size_t c = 0; c < 3; ++c)
        buffer.insert(
            std::string(1, "RGB"[c]),
            Imf::Slice(type, base + c * size, 3 * size, 3 * size * static_cast<std::size_t>(file.levelWidth(level))));
      file.setFrameBuffer(buffer);
      file.writeTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
    }
  }
  return stream.str();
}

std::string text_of(const Imf::Header& header, const char* name) {
  const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
  return attribute != nullptr ? attribute->value() : "";
}

// The numbers of an attribute, one for each level.
std::vector<double> numbers_of(const Imf::Header& header, const char* name) {
  std::vector<double> numbers;
  const std::string text = text_of(header, name);
  for (const std::string_view word : split(text, ' ')) {
    if (const auto number = parse_number(word)) numbers.push_back(*number);
  }
  return numbers;
}

CubeMap level_of(Imf::TiledInputFile& file, int level) {
  CubeMap map(file.levelWidth(level));
  Imf::FrameBuffer buffer;
  char* base = reinterpret_cast<char*>(map.texels.data());
  const auto row = 3 * sizeof(float) * static_cast<std::size_t>(map.size);
  for (std::size_t c = 0; c < 3; ++c)
    buffer.insert(std::string(1, "RGB"[c]), Imf::Slice(Imf::FLOAT, base + c * sizeof(float), 3 * sizeof(float), row));
  file.setFrameBuffer(buffer);
  file.readTiles(0, file.numXTiles(level) - 1, 0, file.numYTiles(level) - 1, level);
  return map;
}

Result<PrefilteredEnvironment> levels_of(Imf::TiledInputFile& file, const std::string& path) {
  const Imf::Header& header = file.header();
  const std::vector<double> exponents = numbers_of(header, "goniochrome:exponents");
  const std::vector<double> errors = numbers_of(header, "goniochrome:maxErrors");
  const int size = file.levelWidth(0);
  if (header.tileDescription().mode != Imf::MIPMAP_LEVELS || file.levelHeight(0) != 6 * size || exponents.empty() ||
      static_cast<int>(exponents.size()) > file.numLevels() || size >> (exponents.size() - 1) < 1)
    return input_error("{}: goniochrome:exponents names {} levels, which its {} levels of {} x {} texels are not", path,
                       exponents.size(), file.numLevels(), size, file.levelHeight(0));
  PrefilteredEnvironment env;
  env.mirror.exponent = paint::kMirrorExponent;
  env.source = text_of(header, "goniochrome:source");
  for (std::size_t i = 0; i < exponents.size() && exponents[i] > 0; ++i) {
    PrefilteredLobe lobe;
    lobe.exponent = exponents[i];
    lobe.map = level_of(file, static_cast<int>(i));
    lobe.tolerance = parse_number(text_of(header, "goniochrome:tolerance")).value_or(0);
    if (i < errors.size()) lobe.max_error = errors[i];
    if (std::abs(lobe.exponent - 1) < 1e-6) env.diffuse = lobe;
    env.lobes.push_back(std::move(lobe));
  }
  if (env.diffuse.map.size == 0)
    return input_error(
        "{}: no level has the exponent 1, which the diffuse light needs: prefilter with a power of four as the "
        "sharpest, such as --exponents 256 --layout mip",
        path);
  std::reverse(env.lobes.begin(), env.lobes.end());
  return env;
}

}  // namespace

Result<std::vector<double>> mip_exponents(std::vector<double> given, int size) {
  if (size < 1 || (size & (size - 1)) != 0)
    return usage_error("a mip-mapped cube of {} texels a face: give a power of two", size);
  std::size_t levels = 1;
  for (int n = size; n > 1; n /= 2) ++levels;
  if (given.size() > levels)
    return usage_error("{} exponents but a cube of {} has {} levels: give fewer, or a larger --size", given.size(),
                       size, levels);
  std::sort(given.begin(), given.end(), std::greater<>());
  while (given.size() < levels) {
    const double next = given.back() / 4;
    given.push_back(next < 0.25 ? 0 : next);
  }
  return given;
}

Result<void> write_mip(const std::string& path, const std::vector<PrefilteredLobe>& levels, const std::string& source,
                       const std::string& command) {
  const std::string shown = path.empty() || path == "-" ? "standard output" : path;
  try {
    return write_file(path, encoded(levels, source, command));
  } catch (const std::bad_alloc&) {
    return input_error("{}: cannot be written as EXR: there is too little memory for it", shown);
  } catch (const std::exception& e) {
    return input_error("{}: cannot be written as EXR: {}", shown, e.what());
  }
}

Result<PrefilteredEnvironment> read_mip(const std::string& content, const std::string& name) {
  try {
    Imf::StdISStream stream;
    stream.str(content);
    Imf::TiledInputFile file(stream);
    return levels_of(file, name);
  } catch (const std::bad_alloc&) {
    return input_error("{}: is too large for the memory there is", name);
  } catch (const std::exception& e) {
    return input_error("{}: cannot be read as a mip-mapped cube: {}", name, e.what());
  }
}

}  // namespace goniochrome::envmap
