// Local regression over images of a surface: around each element, values are fitted by a function that is linear in
// place and normal. Compiled for several instruction sets, of which the best that the processor has is chosen at run
// time. goniochrome-paths(7), "RECONSTRUCTION".
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/unset_array.h"

namespace goniochrome::render {

// Two halves of three channels.
constexpr std::size_t kHalvesChannels = 6;
// 1, x, y, and the normal along two tangents.
constexpr std::size_t kSurfaceFeatures = 5;

// An image of a surface with a border of kBorder empty elements, one plane for each quantity; 0 until it is written.
struct SurfaceImage {
  static constexpr int kBorder = 5;
  static constexpr int kLanes = 16;  // Elements that a kernel may read past the end of a row.

  int width = 0, height = 0;
  std::size_t stride = 0;
  float *weight = nullptr, *part = nullptr;  // 0 where nothing is shown. Elements of different parts share nothing.
  std::array<float*, 2> shift = {};          // from the element's center, in elements
  std::array<float*, 3> normal = {}, position = {};  // unit; world
  std::vector<float*> value;                         // to be fitted

  SurfaceImage(int w, int h, std::size_t channels);
  std::size_t at(int x, int y) const {
    return (static_cast<std::size_t>(y) + kBorder) * stride + static_cast<std::size_t>(x) + kBorder;
  }

 private:
  UnsetArray<float> planes_;
};

// The elements that count in a fit around another one. Their weights fall to 0 at these distances.
struct RegressionWindow {
  int reach = SurfaceImage::kBorder;  // elements to each side, at most kBorder
  float normal = 0.1F;                // length of the difference of the normals
  float plane = 0.5F;                 // sine of the angle of the way between both with the surface
};

// The linear functions fitted to kHalvesChannels around the elements of a row: coefficients of all channels by feature,
// kSurfaceFeatures * kHalvesChannels for each element. Those of empty elements are left as they are.
void fit_row(const SurfaceImage& image, const RegressionWindow& window, int y, float* coefficients);
// The means of 2 * kHalvesChannels around them.
void mean_row(const SurfaceImage& image, const RegressionWindow& window, int y, float* means);

}  // namespace goniochrome::render
