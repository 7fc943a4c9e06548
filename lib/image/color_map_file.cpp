#include "image/color_map_file.h"

#include <cmath>

namespace goniochrome::image {

Result<brdf::ColorMap> read_color_map(const std::string& path) {
  GONIO_ASSIGN(const std::vector<ImagePart> parts, read_exr(path));
  const Image& image = parts.front().image;
  if (image.width < 1 || image.height != 2 * image.width || image.channels < 3)
    return input_error("{}: {}x{} with {} channels is no color map: it is RGB and twice as high as wide", path,
                       image.width, image.height, image.channels);
  const auto& attributes = parts.front().attributes;
  double index = 1.5;
  if (const auto found = attributes.find("goniochrome:index"); found != attributes.end()) {
    const float* stated = std::get_if<float>(&found->second);
    if (stated == nullptr || !(*stated >= 1 && *stated <= 4))
      return input_error("{}: goniochrome:index must be a number from 1 to 4", path);
    index = std::round(*stated * 1e6) * 1e-6;  // a decimal number that went through a float
  }
  brdf::ColorMap map = brdf::color_map_of_size(image.width, index);
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      for (int c = 0; c < 3; ++c) {
        const float value = image.pixel(column, row)[c];
        if (!std::isfinite(value))
          return input_error("{}: pixel ({},{}) is {}: a reflectance factor is a finite number", path, column, row,
                             value);
        map.texel(column, row)[c] = value;
      }
    }
  }
  return map;
}

Result<void> write_color_map(const std::string& path, const brdf::ColorMap& map, const Attributes& attributes) {
  ImagePart part{"color-map", {map.size, 2 * map.size, 3, map.factors, {"R", "G", "B"}}, attributes, PixelType::kHalf};
  part.attributes["goniochrome:colorMap"] = std::string("cos(theta_i), cos(theta_o)");
  part.attributes["goniochrome:index"] = static_cast<float>(map.index);
  part.attributes["colorInteropID"] = std::string("lin_rec2020_scene");
  return write_exr(path, {part});
}

}  // namespace goniochrome::image
