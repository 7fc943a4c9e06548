#include "render/path/pixel_pieces.h"

#include <algorithm>

#include "base/parallel.h"

namespace goniochrome::render {

namespace {

template <class Flag>
PixelFlags flags_of(const Gbuffer& gbuffer, const Flag& flag) {
  PixelFlags flags(gbuffer.data.size() / 4, 0);
  for_pixels(gbuffer.width, gbuffer.height, [&](int x, int y) { flags[gbuffer.index(x, y)] = flag(x, y) ? 1 : 0; });
  return flags;
}

}  // namespace

Coverage coverage(PixelSamples samples) {
  const std::size_t pixels = samples.front()->triangles.size();
  Coverage result{std::vector<std::uint16_t>(pixels, 0), std::vector<std::uint16_t>(pixels, 0)};
  for (std::size_t sample = 0; sample < samples.size(); ++sample) {
    const auto bit = static_cast<std::uint16_t>(1U << sample);
    for (std::size_t i = 0; i < pixels; ++i) {
      const std::uint32_t triangle = samples[sample]->triangles[i];
      if (triangle != kNoTriangle) result.any[i] |= bit;
      if (triangle == rays::kFloor) result.floor[i] |= bit;
    }
  }
  return result;
}

PixelFlags even_pixels(PixelSamples samples, float cosine) {
  const Gbuffer& first = *samples.front();
  return flags_of(first, [&](int x, int y) {
    return std::ranges::all_of(
        samples, [&](const Gbuffer* sample) { return are_one_piece(sample->at(x, y), first.at(x, y), cosine); });
  });
}

int first_spacing(std::size_t points, std::size_t least) {
  std::size_t spacing = 1;
  while (points > 4 * least * spacing * spacing) spacing *= 2;
  return static_cast<int>(spacing);
}

PixelFlags told_by_corners(const Gbuffer& gbuffer, const PixelFlags& even, int spacing) {
  return flags_of(gbuffer, [&](int x, int y) {
    const int left = x - x % spacing, top = y - y % spacing;
    return (left != x || top != y) && even[gbuffer.index(x, y)] != 0 && even[gbuffer.index(left, top)] != 0 &&
           are_one_piece(gbuffer.at(x, y), gbuffer.at(left, top), kFlatPiece);
  });
}

}  // namespace goniochrome::render
