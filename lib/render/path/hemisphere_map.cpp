#include "render/path/hemisphere_map.h"

#include <algorithm>
#include <cmath>

namespace goniochrome::render {

namespace {

using rays::Float3;

constexpr int kCoarsest = 2;  // texels across

}  // namespace

HemisphereMap::Place HemisphereMap::place(float column, float row, int size) {
  constexpr float kEdge = 1 - 1e-4F;
  const float step = 2.0F / static_cast<float>(size), x = step * column - 1, z = step * row - 1;
  const float r = std::sqrt(x * x + z * z), kept = std::min(r, kEdge), scale = std::sqrt(2 - kept * kept);
  const float back = r > kEdge ? kEdge / r : 1;
  return {{scale * back * x, kept * kept - 1, scale * back * z}, r < 1};
}

HemisphereMap::HemisphereMap(int size, const std::vector<Float3>& light) {
  levels_.push_back({size, light});
  while (levels_.back().size > kCoarsest) {
    const Level& fine = levels_.back();
    Level coarse{fine.size / 2, {}};
    for (int row = 0; row < coarse.size; ++row) {
      for (int column = 0; column < coarse.size; ++column) {
        const Float3* a = &fine.texels[static_cast<std::size_t>(2 * row) * static_cast<std::size_t>(fine.size) +
                                       static_cast<std::size_t>(2 * column)];
        const Float3* b = a + fine.size;
        coarse.texels.push_back(0.25F * (a[0] + a[1] + b[0] + b[1]));
      }
    }
    levels_.push_back(std::move(coarse));
  }
}

Float3 HemisphereMap::at(const Float3& direction, float extent_sr, float number) const {
  const float texels = extent_sr / texel_sr(levels_.front().size);
  const float level = 0.5F * std::log2(std::max(texels, 1e-6F)) + number;
  const auto coarsest = static_cast<float>(levels_.size() - 1);
  const Level& image = levels_[level > 0 ? static_cast<std::size_t>(std::min(level, coarsest)) : 0];
  const float half = 0.5F * static_cast<float>(image.size), scale = half / std::sqrt(1 - direction.y);
  const float last = static_cast<float>(image.size) - 1.001F;
  const float x = std::clamp(scale * direction.x + half - 0.5F, 0.0F, last),
              z = std::clamp(scale * direction.z + half - 0.5F, 0.0F, last);
  const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(z);
  const float right = x - static_cast<float>(column), down = z - static_cast<float>(row);
  const Float3* a = &image.texels[row * static_cast<std::size_t>(image.size) + column];
  const Float3* b = a + image.size;
  return (1 - down) * ((1 - right) * a[0] + right * a[1]) + down * ((1 - right) * b[0] + right * b[1]);
}

}  // namespace goniochrome::render
