// Transports in the EXR of a picture, beside its buffers. goniochrome-paint(5), "TRANSPORTS".
#pragma once

#include <optional>
#include <vector>

#include "base/result.h"
#include "image/aov_file.h"
#include "render/path/lobe_transport.h"

namespace goniochrome::render {

// Light in halves errs by up to 1/2048 of itself. A part of the file whose halves change the gray paint of its column
// (nominal_weight()) by more than this (CIEDE2000, 95th percentile over every seventh point) is written as floats.
constexpr double kHalfError_de00 = 0.05;

struct TransportParts {
  std::vector<image::ImagePart> parts;  // to follow the picture
  std::string header;                   // the picture's attribute kTransportAttribute
  double bytes_per_point = 0;           // of light in memory
  int float_parts = 0;
  double half_error_de00 = 0;  // the largest of the parts in halves
};
inline constexpr const char* kTransportAttribute = "goniochrome:transport";

// Light is kept relative to the diffuse white of the scene.
TransportParts transport_parts(const LobeTransport& transport);

// The points of a transport and all that the header tells, without light; nothing where the file has none. The file has
// its buffer `part`. Error: the number that is missing or wrong.
Result<std::optional<LobeTransport>> transport_points(const image::AovFile& file);
// Reads the light of these points in the diffuse column and those wanted; without a list, in all. Error: the part that
// is missing or wrong.
Result<void> read_light(const image::AovFile& file, const std::vector<bool>& wanted, LobeTransport& points);
// Both, with all columns.
Result<std::optional<LobeTransport>> transport_of(const image::AovFile& file);

}  // namespace goniochrome::render
