#include "render/plan/spread_pixels.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "render/path/sequence.h"

namespace goniochrome::render {

namespace {

// Every other bit of a number, from the lowest on.
constexpr int every_other_bit(std::uint32_t bits) {
  int result = 0;
  for (int k = 0; k < 16; ++k) result |= static_cast<int>(bits >> (2 * k) & 1U) << k;
  return result;
}

// A square of a picture, and how many of its pixels show something.
struct Tile {
  static constexpr int kSide = 16;
  const Gbuffer* gbuffer = nullptr;
  int x = 0, y = 0;
  std::size_t visible = 0;

  // Calls visit(x, y) for each of these pixels, along the same curve as tiles_of().
  template <class Visit>
  void for_each_visible(Visit visit) const {
    static const std::array<std::array<int, 2>, kSide* kSide> places = [] {
      std::array<std::array<int, 2>, kSide * kSide> all{};
      for (std::uint32_t code = 0; code < all.size(); ++code)
        all[code] = {every_other_bit(code), every_other_bit(code >> 1)};
      return all;
    }();
    for (const auto& [right, down] : places) {
      const int column = x + right, row = y + down;
      if (column < gbuffer->width && row < gbuffer->height && gbuffer->at(column, row)[3] != 0) visit(column, row);
    }
  }
};

// Those that show something, along the curve of [Morton1966]: near each other in the list, near in the picture.
std::vector<Tile> tiles_of(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers) {
  std::vector<Tile> tiles;
  for (const auto& g : gbuffers) {
    const int side = (std::max(g->width, g->height) + Tile::kSide - 1) / Tile::kSide;
    const auto square = static_cast<std::uint32_t>(std::bit_ceil(static_cast<unsigned>(side)));
    for (std::uint32_t code = 0; code < square * square; ++code) {
      Tile tile{g.get(), Tile::kSide * every_other_bit(code), Tile::kSide * every_other_bit(code >> 1), 0};
      if (tile.x >= g->width || tile.y >= g->height) continue;
      tile.for_each_visible([&](int, int) { ++tile.visible; });
      if (tile.visible > 0) tiles.push_back(tile);
    }
  }
  return tiles;
}

}  // namespace

// One at random of each of `count` equal parts of the visible pixels: even steps would meet the same columns of the
// picture, or the same side of what repeats in it.
std::vector<ProbePixel> spread_pixels(const std::vector<std::shared_ptr<const Gbuffer>>& gbuffers, std::size_t count) {
  const std::vector<Tile> tiles = tiles_of(gbuffers);
  std::size_t visible = 0;
  for (const Tile& tile : tiles) visible += tile.visible;
  count = std::min(count, visible);
  if (count == 0) return {};
  std::vector<ProbePixel> pixels;
  const auto next = [&] {
    const std::size_t k = pixels.size(), first = k * visible / count, last = (k + 1) * visible / count;
    return k == count ? visible : first + static_cast<std::size_t>(mixed(count, k) % (last - first));
  };
  std::size_t met = 0, wanted = next();
  for (const Tile& tile : tiles) {
    if (wanted >= met + tile.visible) {
      met += tile.visible;
      continue;
    }
    tile.for_each_visible([&](int x, int y) {
      if (met++ != wanted) return;
      pixels.push_back({tile.gbuffer, x, y});
      wanted = next();
    });
  }
  return pixels;
}

}  // namespace goniochrome::render
