// Transports in the EXR of a picture, beside its buffers. goniochrome-paint(5), "TRANSPORTS".
#pragma once

#include <memory>
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

// Reads the transport of a file part by part. Errors: the part or the number that is missing or wrong.
class TransportReader {
 public:
  TransportReader();
  ~TransportReader();
  // The next part of the transport; the file has its picture, the buffer `part` and its header.
  Result<void> add(const image::AovFile& file, const image::ImagePart& layer);
  // The transport once all parts were added, or nothing where the file has none.
  Result<std::optional<LobeTransport>> finish(const image::AovFile& file);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// The transport of a file that was read with its layers.
Result<std::optional<LobeTransport>> transport_of(const image::AovFile& file);

}  // namespace goniochrome::render
