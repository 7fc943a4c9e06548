#include "envmap/internal/mip_read.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledInputFile.h>

#include <algorithm>
#include <cmath>
#include <exception>

#include "base/text.h"

namespace goniochrome::envmap {

namespace {

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
  env.mirror.exponent = kMirrorExponent;
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

Result<PrefilteredEnvironment> read_mip(const std::string& path) {
  try {
    Imf::TiledInputFile file(path.c_str());
    return levels_of(file, path);
  } catch (const std::exception& e) {
    return input_error("{}: cannot be read as a mip-mapped cube: {}", path, e.what());
  }
}

}  // namespace goniochrome::envmap
