// The angle of the viewer from the normal at each pixel of buffers.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/angles.h"
#include "image/aov_file.h"

namespace goniochrome::sketch {

class ViewAngles {
 public:
  // The buffers must outlive it.
  explicit ViewAngles(const image::AovFile& buffers) : buffers_(buffers) {
    const auto normal = buffers.channel("normal.X");
    if (normal.ok() && buffers.has_rays) normal_ = *normal;
  }

  // True if the buffers have normals and the rays of the camera.
  bool are_known() const { return normal_ >= 0; }

  // In degrees, 0 to 90. Only where they are known.
  double at(std::uint32_t place) const {
    const int width = buffers_.image.width;
    const int x = static_cast<int>(place) % width, y = static_cast<int>(place) / width;
    const float* n = buffers_.image.pixel(x, y) + normal_;
    const Vec3 viewer = buffers_.to_viewer(x, y), normal{n[0], n[1], n[2]};
    return std::min(90.0, std::atan2(length(cross(normal, viewer)), dot(normal, viewer)) / kDegree);
  }

 private:
  const image::AovFile& buffers_;
  int normal_ = -1;  // the first of three channels
};

}  // namespace goniochrome::sketch
