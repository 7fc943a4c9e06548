// Local regression over images of a surface: around each element, values are fitted by a function that is linear in
// place and normal. Compiled for several instruction sets, of which the best that the processor has is chosen at run
// time. goniochrome-paths(7), "RECONSTRUCTION".
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace goniochrome::render {

// Two halves of three channels.
constexpr std::size_t kHalvesChannels = 6;
// 1, x, y, and the normal along two tangents.
constexpr std::size_t kSurfaceFeatures = 5;

// An image of a surface with a border of kBorder empty elements, one plane for each quantity.
struct SurfaceImage {
  static constexpr int kBorder = 5;
  static constexpr int kLanes = 16;  // Elements that a kernel may read past the end of a row.

  int width = 0, height = 0;
  std::size_t stride = 0;
  std::vector<float> weight;                              // 0 where nothing is shown
  std::vector<float> part;                                // Elements of different parts share nothing.
  std::array<std::vector<float>, 2> shift;                // from the element's center, in elements
  std::array<std::vector<float>, 3> normal, position;     // unit; world
  std::array<std::vector<float>, kHalvesChannels> value;  // to be fitted

  SurfaceImage() = default;
  SurfaceImage(int w, int h);
  std::size_t at(int x, int y) const {
    return (static_cast<std::size_t>(y) + kBorder) * stride + static_cast<std::size_t>(x) + kBorder;
  }
};

// The elements that count in a fit around another one. Their weights fall to 0 at these distances.
struct RegressionWindow {
  int reach = SurfaceImage::kBorder;  // elements to each side, at most kBorder
  float normal = 0.1F;                // length of the difference of the normals
  float plane = 0.5F;                 // sine of the angle of the way between both with the surface
  // The part of the weight that is added to the square of each slope: where a window tells nothing of a slope, it is 0.
  // With much of it, fits are means.
  float ridge = 2e-3F;
};
constexpr float kNoSlopes = 1e6F;

// The linear functions fitted around the elements of a row: coefficients[feature * kHalvesChannels + channel] has one
// value for each element of the row.
void fit_row(const SurfaceImage& image, const RegressionWindow& window, int y, float* const* coefficients);

}  // namespace goniochrome::render
