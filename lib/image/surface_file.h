// Surfaces that are kept as EXR files: the color map of a paint, which gives its color for two angles, and the texture
// of a surface whose reflection differs from point to point. goniochrome-paint(5), "COLOR MAPS".
#pragma once

#include <string>
#include <vector>

#include "base/file.h"
#include "base/result.h"
#include "brdf/color_map.h"
#include "brdf/sbrdf.h"
#include "image/image.h"

namespace goniochrome::image {

// Reads a map of RGB reflectance factors, twice as high as wide. Its refractive index is the one that the file states,
// or 1.5. Error: the path, and whether the shape is another one or a value is not finite.
Result<brdf::ColorMap> read_color_map(const std::string& path);

// Writes the map with `attributes` (provenance) besides its own: goniochrome:colorMap and goniochrome:index.
Result<void> write_color_map(const std::string& path, const brdf::ColorMap& map, const Attributes& attributes);

// Reads a texture (`*.sbrdf.exr`) from one part, or from several parts of one size. Its channels are diffuse.R .G
// .B; for each lobe k from 0, lobe<k>.R .G .B (albedo), .x .y .z (axes) and .n (exponent); and frame.c and frame.s
// where lobes turn, or lobe<k>.c and .s where each lobe turns by itself; and normal.x .y .z where texels have normals
// of their own. Colors are linear working space, in 1/sr, and multiplied by the channel alpha where there is one. The
// channels certainty and error, which a fitted texture has besides, are passed over. Error: a channel that is missing
// or not known, or a texel whose albedo or exponent is negative, whose alpha is not 0 to 1 or which holds a value that
// is not finite; a lobe that reflects but has axes of length 0; a normal that is not a unit vector to the front.
Result<brdf::SbrdfTexture> read_sbrdf(const std::string& path);
Result<brdf::SbrdfTexture> read_sbrdf(InputFile input);

// Writes a texture with `attributes` (provenance), and after it the parts `beside`. It is stored in half precision
// unless that would change an exponent, for which maps were filtered, or the strength of a lobe by more than 1/256,
// which is the length of p to the power of the exponent.
Result<void> write_sbrdf(const std::string& path, const brdf::SbrdfTexture& texture, const Attributes& attributes,
                         const std::vector<ImagePart>& beside = {});

}  // namespace goniochrome::image
