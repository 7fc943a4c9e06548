#include "image/shrink.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/parallel.h"

namespace goniochrome::image {

void shrink(const Image& from, int factor, Image& into) {
  into.width = from.width / factor, into.height = from.height / factor, into.channels = from.channels;
  into.channel_names = from.channel_names;
  const auto row = static_cast<std::size_t>(into.width) * static_cast<std::size_t>(into.channels);
  into.data.resize(row * static_cast<std::size_t>(into.height));
  const float share = 1.0F / static_cast<float>(factor * factor);
  parallel_for(static_cast<std::size_t>(into.height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < into.width; ++x) {
        float* pixel = into.pixel(x, y);
        for (int c = 0; c < into.channels; ++c) {
          float sum = 0;
          for (int v = 0; v < factor; ++v)
            for (int u = 0; u < factor; ++u) sum += from.pixel(factor * x + u, factor * y + v)[c];
          pixel[c] = share * sum;
        }
      }
    }
  });
}

namespace {

// Where the center of one of `count` pixels lies between the centers of `of` pixels.
struct Between {
  int first, second;
  float share;  // of the second
};
std::vector<Between> between_centers(int count, int of) {
  std::vector<Between> places;
  for (int i = 0; i < count; ++i) {
    const double at = std::clamp((i + 0.5) * of / count - 0.5, 0.0, of - 1.0);
    const int first = static_cast<int>(at);
    places.push_back({first, std::min(first + 1, of - 1), static_cast<float>(at - first)});
  }
  return places;
}

}  // namespace

Image enlarged(const Image& from, int width, int height) {
  Image large = even_image(width, height, from.channels, from.channel_names);
  const std::vector<Between> columns = between_centers(width, from.width), rows = between_centers(height, from.height);
  parallel_for(rows.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      float* to = large.pixel(0, static_cast<int>(y));
      for (const Between& x : columns) {
        for (int c = 0; c < from.channels; ++c) {
          const auto along = [&](int row) {
            return std::lerp(from.pixel(x.first, row)[c], from.pixel(x.second, row)[c], x.share);
          };
          *to++ = std::lerp(along(rows[y].first), along(rows[y].second), rows[y].share);
        }
      }
    }
  });
  return large;
}

}  // namespace goniochrome::image
